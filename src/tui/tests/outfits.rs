//! Outfits in the list of styles and in the form of a new study.

use insta::assert_snapshot;

use super::{Bench, fixture};
use crate::messages::effect::Effect;
use crate::messages::requests::FileTask;
use crate::messages::snapshot::Snapshot;
use crate::messages::taught;
use crate::threads::reading::tell_interrupted;
use store::queue::Interrupted;
use store::{JobId, OutfitRow, Status};

/// The example with an outfit of two styles, of which one is in its list.
fn dressed() -> Snapshot {
    let mut data = fixture::snapshot();
    let layer = |style: &str| (format!("office {style}"), style.to_owned());
    let layers = vec![layer("tshirt"), layer("trousers")];
    let mut trousers = data.sizes[1].clone();
    (trousers.style, trousers.pattern_file, trousers.key.style) = ("trousers".into(), "trousers-m.dxf".into(), 2);
    data.sizes.push(trousers);
    data.outfits = vec![OutfitRow { study: "men-tops".into(), name: "office".into(), layers }];
    data
}

#[test]
fn looks() {
    for (width, height) in [(80, 24), (160, 50)] {
        let check = |name: &str, keys: &str| {
            let screen = Bench::new(width, height, dressed()).press(keys).screen();
            assert_snapshot!(format!("{name}_{width}x{height}"), screen);
        };
        check("styles_of_an_outfit", "3");
        check("outfit_in_a_new_study", "a<Tab><Tab><Tab> ");
    }
}

#[test]
fn an_outfit_is_found_by_its_name_in_the_list() {
    let mut bench = Bench::new(160, 50, dressed());
    bench.press("3/office<Enter>");
    let sizes: Vec<&str> =
        bench.app.screens.styles.sizes(&bench.app.state).iter().map(|row| row.style.as_str()).collect();
    assert_eq!(sizes, ["tshirt", "tshirt", "trousers"]);
    for expect in ["layer 1 of 2 of office", "layer 2 of 2 of office", "tshirt under trousers"] {
        assert!(bench.screen().contains(expect), "{expect}: {}", bench.screen());
    }
}

#[test]
fn outfits_are_chosen_or_typed_for_a_new_study() {
    let made = |keys: &str| {
        let mut bench = Bench::new(80, 24, dressed());
        let asked = bench.press(keys).asked();
        match &asked[..] {
            [Effect::Files(FileTask::CreateStudy(new))] => {
                let outfits: Vec<String> = new.outfits.iter().map(ToString::to_string).collect();
                let command = taught::command(&asked[0]).unwrap_or_default();
                outfits.iter().for_each(|one| assert!(command.contains(&format!(" --outfit '{one}'")), "{command}"));
                (new.sizes.len(), outfits.join(" "))
            }
            _ => (0, bench.screen()),
        }
    };
    let check = |keys: &str, sizes: usize, expect: &str| {
        let (found, outfits) = made(keys);
        assert_eq!(found, sizes, "{keys}: {outfits}");
        assert!(outfits.contains(expect), "{keys}: {outfits}");
    };
    // The outfit brings the sizes of its layers; sizes that are chosen stay.
    check("a<Tab><Tab>a<Tab> <F5>", 3, "office=tshirt,trousers");
    check("a<Tab>ljj <Tab>a<Tab> <F5>", 2, "office=tshirt,trousers");
    check("a<Tab>a<Tab>a<Tab><Down>look=tshirt,trousers<F5>", 6, "look=tshirt,trousers");
    check("a<Tab>a<Tab>a<F5>", 6, "");
    // Refused before anything is written.
    check("a<Tab> <Tab>a<Tab><Down>look=tshirt,trousers<F5>", 0, "no size of trousers is chosen");
    check("a<Tab>a<Tab>a<Tab><Down>tshirt,trousers<F5>", 0, "accepted: NAME=STYLE,STYLE");
    let mut bench = Bench::new(80, 24, dressed());
    bench.press("a<Tab><Tab>a<Tab> ");
    assert!(bench.screen().contains("+ 6 of outfits"), "two layers in size M on three: {}", bench.screen());
}

#[test]
fn jobs_of_a_process_that_ended_are_told_as_interrupted() {
    let mut data = fixture::snapshot();
    let lost = Interrupted { job: JobId(7), process: "process 12 on mill".into() };
    tell_interrupted(&mut data, &[lost]);
    let study = &data.studies[0];
    assert_eq!((study.count(Status::Running), study.count(Status::Queued)), (1, 5));
    let screen = Bench::new(160, 50, data).press("4jjjjjj").screen();
    assert!(screen.contains("interrupted: process 12 on mill ended before the job did"), "{screen}");
}
