//! Alterations of the example's T-shirt, as threads answer them and the Fit screen shows them.

use std::path::{Path, PathBuf};

use insta::assert_snapshot;

use super::Bench;
use crate::keys::screen::Screen;
use crate::messages::alterations::AlterRequest;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::requests::FileTask;
use crate::screens::fit::state::View;
use crate::threads::alterations::alteration;
use crate::threads::files;
use crate::widgets::theme::Colours;
use advice::{Alteration, AlteredLevel, MovedHandle, Redraped};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use pattern::Handle;
use wardrobe::catalogue;

/// Level, target, ease before and after, mm.
type LevelMm = (&'static str, Option<[f64; 2]>, [f64; 2]);

const TIGHT: [LevelMm; 6] = [
    ("across_shoulder", Some([0.0, 50.0]), [-3.5, 2.1]),
    ("chest", Some([50.0, 120.0]), [38.1, 52.1]),
    ("hip", Some([40.0, 120.0]), [-29.8, 31.0]),
    ("neck", None, [179.4, 179.4]),
    ("upper_arm", Some([40.0, 180.0]), [145.8, 154.2]),
    ("waist", Some([50.0, 230.0]), [107.1, 159.4]),
];

fn moved(handle: Handle, amount_mm: f64) -> MovedHandle {
    let is_half_girth = handle.is_half_girth();
    let (pieces, serves) = (vec!["front".to_owned()], vec!["hip".to_owned()]);
    MovedHandle { handle: handle.as_str(), amount_mm, does: handle.definition(), is_half_girth, pieces, serves }
}

/// An alteration: of M on subject ii nothing moves; of other sizes four handles move and do not reach the hip.
pub fn found(request: &AlterRequest) -> Alteration {
    let is_right = request.size == "M" && request.subject == "ii";
    let level = |(level, target_mm, [before_mm, after_mm]): LevelMm| AlteredLevel {
        level: level.into(),
        target_mm,
        before_mm: if is_right { after_mm.max(45.0) } else { before_mm },
        promised_mm: if is_right { after_mm.max(45.0) } else { after_mm },
        achieved_mm: if is_right { after_mm.max(45.0) } else { after_mm },
    };
    let moves = [
        moved(Handle::Chest, 7.0),
        moved(Handle::Waist, 27.0),
        moved(Handle::Hem, 60.0),
        moved(Handle::ShoulderLength, -3.5),
    ];
    let remarks = [
        "`cap_height`: the sleeve has no cap that could be higher: its upper edge lies between the underarm points",
        "hip is missed: at the limit of 60 mm: `hem` (--limit-mm allows more; another size may be nearer)",
    ];
    Alteration {
        garment: request.garment.clone(),
        subject: request.subject.clone(),
        size: request.size.clone(),
        moves: if is_right { vec![] } else { moves.to_vec() },
        levels: TIGHT.into_iter().map(level).collect(),
        readings: vec![],
        drapes: usize::from(request.is_draped),
        remarks: if is_right { vec![] } else { remarks.map(str::to_owned).to_vec() },
        drape: request.is_draped.then_some(Redraped {
            converged: true,
            ei: 0.0022,
            penetration_max_mm: 0.0,
            hem_front_over_back_mm: Some(23.0),
            most_kpa: Some(0.12),
            drag_lines: 2,
        }),
        figures: vec![],
        signs: vec![],
        keeps_source: true,
        files: vec![("tshirt-S-i.dxf".into(), b"dxf".to_vec()), ("tshirt-S-i.svg".into(), b"svg".to_vec())],
    }
}

/// Presses keys without answering the effects. Returns these.
fn unanswered(bench: &mut Bench, letters: &str) -> Vec<Effect> {
    let press = |letter| Message::Key(KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE));
    letters.chars().flat_map(|letter| bench.app.update(press(letter))).collect()
}

fn request(subject: &str, size: &str, is_draped: bool) -> AlterRequest {
    AlterRequest {
        study: "studies/men-tops/study.toml".into(),
        garment: "tshirt".into(),
        subject: subject.into(),
        size: size.into(),
        is_draped,
    }
}

fn answer(bench: &mut Bench, request: AlterRequest, found: Result<Alteration, &str>) {
    let found = found.map(Box::new).map_err(str::to_owned);
    bench.send(Message::Altered(Box::new(request), found));
}

#[test]
fn looks() {
    let check = |name: &str, width: u16, height: u16, keys: &str| {
        let mut bench = Bench::example(width, height);
        assert_snapshot!(format!("{name}_{width}x{height}"), bench.press(keys).screen());
    };
    check("change", 80, 24, "0a-");
    check("change", 160, 50, "0a-");
    check("nothing", 80, 24, "0la");
    check("nothing", 160, 50, "0la");
    check("draped", 80, 24, "0a-d");
    check("draped", 160, 50, "0a-d");
    check("draped_end", 80, 18, "0a-dG");
    check("write", 80, 24, "0a-w");
}

#[test]
fn looks_while_it_is_sought_and_where_nothing_is_found() {
    for (width, height) in [(80, 24), (160, 50)] {
        let mut bench = Bench::example(width, height);
        bench.press("0");
        unanswered(&mut bench, "a");
        assert_snapshot!(format!("sought_{width}x{height}"), bench.screen());
        let error = "studies/men-tops/patterns/of/a/folder/that/has/a/long/name/and/is/gone/tshirt-m.dxf: no such file; \
            the study cannot be read as it is";
        answer(&mut bench, request("i", "M", false), Err(error));
        assert_snapshot!(format!("refused_{width}x{height}"), bench.screen());
        bench.press("d");
        assert!(bench.status().contains("there is no change to drape"), "{}", bench.status());
        assert_eq!(bench.press("wy").asked(), [], "{}", bench.status());
    }
}

#[test]
fn the_size_to_wear_is_changed_first_and_keys_step_through_sizes_and_subjects() {
    let mut bench = Bench::example(80, 24);
    let mut asked = |keys: &str| -> Vec<AlterRequest> {
        bench.effects.clear();
        bench.press(keys);
        let asked =
            bench.effects.iter().filter_map(|e| if let Effect::Alter(one) = e { Some(one.clone()) } else { None });
        asked.collect()
    };
    assert_eq!(asked("0a"), [request("i", "M", false)]);
    assert_eq!(asked("jG"), [], "what is shown is asked for once");
    assert_eq!(asked("+"), [], "there is no larger one");
    assert_eq!(asked("-"), [request("i", "S", false)]);
    assert_eq!(asked("a"), [request("i", "S", false)], "found anew");
    assert_eq!(asked("<Esc>-d"), []);
    assert_eq!(asked("a"), [request("i", "S", false)], "the chosen size stays");
    assert_eq!(asked("l"), [request("ii", "M", false)]);
    assert_eq!(asked("d"), [request("ii", "M", true)]);
    assert_eq!(asked("d<Esc>a"), [], "what was draped is kept");
    assert_eq!(asked("a"), [request("ii", "M", false)], "and found anew where it is shown");
    assert_eq!(asked("50"), [], "it is there again");
}

#[test]
fn it_closes_to_where_one_was() {
    for (keys, view) in
        [("0", View::Card), ("0<Tab>", View::Section), ("0<Tab><Tab>", View::Sizes), ("0<S-Tab>", View::Comments)]
    {
        for back in ["<Esc>", "q", "<Tab>"] {
            let mut bench = Bench::example(80, 24);
            bench.press(keys).press("a").press(back);
            assert_eq!((bench.app.state.nav.screen, bench.app.screens.fit.view), (Screen::Fit, view), "{keys} {back}");
            assert!(!bench.screen().contains("what to change"), "{}", bench.screen());
        }
    }
    let screen = Bench::example(80, 24).press(":alter<Enter>").screen();
    assert!(screen.contains("what to change · tshirt M for i"), "from any screen: {screen}");
}

#[test]
fn late_answers_are_dropped() {
    let mut bench = Bench::example(80, 24);
    bench.press("0a-");
    let before = bench.screen();
    for late in [request("ii", "S", false), request("i", "M", false), request("ii", "M", true)] {
        answer(&mut bench, late, Err("late"));
        assert_eq!(bench.screen(), before);
    }
    unanswered(&mut bench, "d");
    assert!(bench.screen().contains("the study's drape took 8.5s"), "{}", bench.screen());
    bench.press("l");
    let other = bench.screen();
    answer(&mut bench, request("i", "S", true), Ok(found(&request("i", "S", true))));
    assert_eq!(bench.screen(), other, "a drape of another subject");
    assert!(!other.contains("draping"), "{other}");
}

#[test]
fn a_drape_that_fails_says_why_and_leaves_the_change() {
    let mut bench = Bench::example(80, 24);
    bench.press("0a-");
    assert_eq!(unanswered(&mut bench, "d"), [Effect::Alter(request("i", "S", true))]);
    unanswered(&mut bench, "d");
    assert!(bench.status().contains("it is being draped"), "{}", bench.status());
    answer(&mut bench, request("i", "S", true), Err("sim: diverged at level 2"));
    let screen = bench.screen();
    assert!(screen.contains("not draped: sim: diverged at level 2") && screen.contains("+27.0"), "{screen}");
    bench.press("d");
    assert!(bench.screen().contains("draped again: at rest, EI 0.0022"), "{}", bench.screen());
}

#[test]
fn the_changed_pattern_is_written_into_a_folder_that_is_asked_for() {
    let mut bench = Bench::example(80, 24);
    // An alteration does not change the database, so it is allowed where nothing may be changed.
    bench.app.state.setup.abilities.run = false;
    let asked = bench.press("0a-w<Enter>").asked();
    let files = found(&request("i", "S", false)).files;
    assert_eq!(asked, [Effect::Files(FileTask::Write(PathBuf::from("altered/tshirt_S_i"), files.clone()))]);

    let place = tempfile::tempdir().expect("a folder");
    let folder = place.path().join("altered/tshirt_S_i");
    let told = files::write(&folder, &files).expect("writable");
    assert_eq!(told, format!("{} has tshirt-S-i.dxf, tshirt-S-i.svg", folder.display()));
    assert_eq!(std::fs::read(folder.join("tshirt-S-i.dxf")).expect("written"), b"dxf");
    bench.send(Message::Saved(Ok("altered/tshirt_S_i has tshirt-S-i.dxf".into())));
    assert!(bench.status().contains("altered/tshirt_S_i has"), "{}", bench.status());
    assert!(bench.app.state.overlay.is_none() && bench.screen().contains("what to change"));

    let refused = files::write(&folder, &files).expect_err("nothing is written over");
    assert!(refused.contains("tshirt-S-i.dxf is there already"), "{refused}");
    bench.press("w<Enter>").send(Message::Saved(Err(refused)));
    assert!(bench.screen().contains("is there already"), "{}", bench.screen());
}

#[test]
fn the_command_is_copied() {
    let copied = |bench: &mut Bench, keys: &str| match bench.press(keys).asked().as_slice() {
        [Effect::Copy(text)] => text.clone(),
        other => panic!("{other:?}"),
    };
    let mut bench = Bench::example(80, 24);
    let start = "alter studies/men-tops/study.toml --subject i --size S --garment tshirt";
    assert_eq!(copied(&mut bench, "0a-y"), format!("toile {start} -o altered/tshirt_S_i"));
    bench.send(Message::Copied(Ok("in the buffer of tmux".into())));
    assert_eq!(bench.status(), "copied the command: in the buffer of tmux");
    bench.app.state.setup.database = Some("/data/my own.sqlite".into());
    let draped = format!("toile --db '/data/my own.sqlite' {start} --drape -o altered/tshirt_S_i");
    assert_eq!(copied(&mut bench, "dy"), draped);
}

#[test]
fn signs_tell_what_colours_do() {
    let mut bench = Bench::example(80, 24);
    bench.app.state.theme.colours = Colours::None;
    bench.press("0a-");
    let screen = bench.screen();
    let line =
        |level: &str| screen.lines().rfind(|line| line.contains(&format!("│{level}"))).expect("a row").to_owned();
    assert!(line("hip").contains("−29.8 ▼!") && line("hip").contains("+31.0 ▼ missed"), "{screen}");
    assert!(line("chest").contains("+38.1 ▼ ") && line("chest").contains("+52.1 · met"), "{screen}");
    assert!(!line("neck").contains("met"), "{screen}");
    bench.app.state.theme.ascii = true;
    assert!(bench.screen().contains("50..120   +38.1 v "), "{}", bench.screen());
    bench.app.state.theme.ascii = false;
    let told = bench.press("/hip<Enter>").screen();
    assert!(told.contains("│hip") && !told.contains("│chest             50…"), "the filter holds for levels: {told}");
}

#[test]
fn the_quickstart_is_altered_as_its_file_has_it() {
    let place = tempfile::tempdir().expect("a folder");
    let store = catalogue::open(&place.path().join("toile.sqlite"), false).expect("a new database");
    let quickstart = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/quickstart");
    let asked = |garment: &str| AlterRequest {
        study: quickstart.join("study.toml"),
        garment: garment.into(),
        ..request("v", "M", false)
    };
    let found = alteration(&store, &asked("tshirt")).expect("it has this size and subject");
    assert!(!found.moves.is_empty() && found.is_met() && found.drape.is_none());
    assert_eq!(found.files.len(), 3);
    let error = alteration(&store, &asked("cloak")).expect_err("no such garment").to_string();
    assert!(error.contains("cloak") && error.contains("tshirt"), "{error}");
}
