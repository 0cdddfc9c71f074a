//! Keys on the Fabrics screen.

use super::Bench;
use crate::app::App;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::requests::Command;
use crate::overlays::Overlay;
use wardrobe::{Mode, Part};

fn selected(bench: &Bench) -> &str {
    bench.app.screens.fabrics.selected(&bench.app.state).map_or("", |row| row.fabric.name.as_str())
}

#[test]
fn fabrics_are_chosen_sorted_and_filtered() {
    let check = |keys: &str, expect: &str| {
        let mut bench = Bench::example(80, 24);
        assert_eq!(selected(bench.press(keys)), expect, "{keys}");
    };
    check("9", "cotton_shirting_light");
    check("9j", "jersey");
    check("9Gg", "cotton_shirting_light");
    check("9/MEDIAN<Enter>n", "jersey");
    check("9/stiff<Enter>", "stiff");
    let first = |keys: &str| {
        let mut bench = Bench::example(80, 24);
        let App { state, screens } = &bench.press(keys).app;
        screens.fabrics.shown(state)[0].fabric.name.clone()
    };
    assert_eq!(first("9sss"), "jersey", "the least modulus along the grain");
    assert_eq!(first("9S"), "stiff", "by name, the other way round");
    assert_eq!(first("9ssssssss"), "cotton_shirting_light", "by name again");
}

#[test]
fn a_new_fabric_starts_as_the_selected_one_and_is_checked() {
    let mut bench = Bench::example(80, 24);
    bench.press("9a<F5>");
    assert!(bench.screen().contains("new fabric, like cotton_shirting_light"), "{}", bench.screen());
    assert!(bench.screen().contains("a fabric needs a name") && bench.asked().is_empty());
    // A mass per area in g is out of range; three times the known values is only doubtful.
    bench.press("poplin<Tab><Tab><C-u>120<F5>");
    assert!(bench.screen().contains("`density_kg_m2` is 120; accepted: 0.005 to 5"), "{}", bench.screen());
    bench.press("<C-u>1.2");
    assert!(bench.screen().contains("! known 0.1 to 0.1"), "{}", bench.screen());
    bench.press("<C-u>0.12<F5>");
    let asked = bench.asked();
    let [Effect::Do(Command::Save(Part::Fabric, Mode::Add, name, given))] = &asked[..] else { panic!("{asked:?}") };
    let value = |key: &str| given.iter().find(|(name, _)| name == key).map(|(_, text)| text.as_str());
    assert_eq!(name, "poplin");
    assert_eq!(
        ["source", "density_kg_m2", "thickness_mm", "bending_warp_nm", "stretch_pct"].map(value),
        [Some("like cotton_shirting_light"), Some("0.12"), Some("0.18"), Some("7.204e-6"), Some("")]
    );
    bench.send(Message::Saved(Err("fabric poplin: `stretch_pct` is missing".into())));
    assert!(bench.screen().contains("✗ fabric poplin: `stretch_pct` is missing"), "{}", bench.screen());
    bench.press("<F5>").asked();
    bench.send(Message::Saved(Ok("fabric poplin is added".into())));
    assert!(bench.app.state.overlay.is_none() && bench.app.screens.fabrics.chosen.as_deref() == Some("poplin"));
}

#[test]
fn fabrics_are_edited_imported_and_removed() {
    let mut bench = Bench::example(80, 24);
    bench.press("9G<Enter><S-Tab><C-u>a test of ours<F5>");
    let asked = bench.asked();
    let [Effect::Do(Command::Save(Part::Fabric, Mode::Edit, name, given))] = &asked[..] else { panic!("{asked:?}") };
    assert_eq!((name.as_str(), given[0].1.as_str()), ("stiff", "a test of ours"));
    bench.press("<Esc>i~x<Enter>");
    assert_eq!(bench.asked(), [Effect::Do(Command::Import(Part::Fabric, "~x".into()))]);
    bench.press("<Esc>dy");
    assert_eq!(bench.asked(), [Effect::Do(Command::Remove(Part::Fabric, "stiff".into()))]);
    bench.press("4:delete-fabric<Enter>");
    assert!(
        bench.app.state.nav.screen == Screen::Fabrics
            && matches!(bench.app.state.overlay, Some(Overlay::Question { .. }))
    );
    bench.press("<Esc>").app.state.setup.abilities.run = false;
    for keys in ["a", "e", "i", "d"] {
        assert!(bench.press(keys).status().contains("read-only") && bench.app.state.overlay.is_none(), "{keys}");
    }
}

#[test]
fn numbers_that_have_no_room_are_scrolled_to() {
    let mut bench = Bench::example(80, 24);
    bench.press("9j");
    assert!(!bench.screen().contains("bending length across"), "{}", bench.screen());
    bench.press("<Tab>G");
    assert!(bench.screen().contains("bending length across"), "{}", bench.screen());
    bench.press("kg");
    assert!(bench.screen().contains("areal density"), "{}", bench.screen());
    bench.press("2G");
    assert!(!bench.screen().contains("foot length"), "the list has the focus there: {}", bench.screen());
    bench.press("<Tab>G");
    assert!(bench.screen().contains("foot length"), "{}", bench.screen());
}
