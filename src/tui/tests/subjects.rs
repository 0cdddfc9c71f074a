//! Keys on the Subjects screen.

use super::{Bench, fixture};
use crate::app::App;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::requests::Command;
use crate::overlays::Overlay;
use crate::widgets::picture::{PictureRequest, Pictured};
use spec::MEASUREMENTS;
use store::SubjectId;
use wardrobe::{Mode, Part};

fn selected(bench: &Bench) -> &str {
    bench.app.screens.subjects.selected(&bench.app.state).map_or("", |row| row.name.as_str())
}

fn saved(bench: &mut Bench) -> (Mode, String, Vec<(String, String)>) {
    match bench.asked().pop() {
        Some(Effect::Do(Command::Save(Part::Subject, mode, name, given))) => (mode, name, given),
        other => panic!("{other:?}"),
    }
}

#[test]
fn subjects_are_chosen_sorted_and_filtered() {
    let check = |keys: &str, expect: &str| {
        let mut bench = Bench::example(80, 24);
        assert_eq!(selected(bench.press(keys)), expect, "{keys}");
    };
    check("2", "anna");
    check("2j", "male-i");
    check("2jjjj", "male-ii");
    check("2Gg", "anna");
    check("2sssS", "anna");
    check("2/MALE-<Enter>n", "male-ii");
    check("2/female<Enter>", "anna");
    let first = |keys: &str| {
        let mut bench = Bench::example(80, 24);
        let App { state, screens } = &bench.press(keys).app;
        screens.subjects.shown(state)[0].name.clone()
    };
    assert_eq!(first("2s"), "anna", "female before male");
    assert_eq!(first("2sss"), "male-ii", "the lightest");
    assert_eq!(first("2sssS"), "anna", "whose weight is not known is last, here first");
    assert_eq!(first("2sssssss"), "anna", "by name again");
}

#[test]
fn a_new_subject_is_filled_in_checked_and_saved() {
    let mut bench = Bench::example(80, 24);
    bench.press("2a<F5>");
    assert!(bench.screen().contains("a subject needs a name") && bench.asked().is_empty());
    bench.press("eva<Tab><Right><Tab>16<F5>");
    assert!(bench.screen().contains("`stature_mm` is 16; accepted: 1300 to 2200"), "{}", bench.screen());
    assert!(bench.asked().is_empty());
    bench.press("50<Tab><Tab><Tab>700<F5>");
    assert!(bench.screen().contains("building the body"));
    let (mode, name, given) = saved(&mut bench);
    assert_eq!((mode, name.as_str()), (Mode::Add, "eva"));
    let value = |key: &str| given.iter().find(|(name, _)| name == key).map(|(_, text)| text.as_str());
    assert_eq!(
        ["sex", "stature_mm", "weight_kg", "waist_girth_mm"].map(value),
        [Some("male"), Some("1650"), Some(""), Some("700")]
    );
    assert!(bench.press("x<F5>").asked().is_empty(), "it is saved once");

    bench.send(Message::Saved(Err("subject eva: no such body".into())));
    assert!(bench.screen().contains("✗ subject eva: no such body"));
    bench.press("<Backspace>5<F5>");
    saved(&mut bench);
    let mut data = fixture::snapshot();
    data.subjects[1].name = "eva".into();
    bench.send(Message::Saved(Ok("subject eva is added".into())));
    bench.send(Message::Data(Box::new(data)));
    assert!(bench.app.state.overlay.is_none());
    assert_eq!((selected(&bench), bench.status().as_str()), ("eva", "subject eva is added"));
}

#[test]
fn an_edit_starts_from_what_is_known_and_keeps_the_name() {
    let mut bench = Bench::example(80, 24);
    bench.press("2je");
    assert!(bench.screen().contains("edit male-i: a new revision"));
    bench.press("<S-Tab><S-Tab>");
    let Some(Overlay::Form(form)) = &bench.app.state.overlay else { panic!("a form") };
    assert_eq!(form.at, form.texts.len() - 1, "the name is passed by");
    bench.press("<Tab><Tab><Tab><Backspace><Backspace>60<F5>");
    let (mode, name, given) = saved(&mut bench);
    assert_eq!((mode, name.as_str()), (Mode::Edit, "male-i"));
    assert!(
        given.contains(&("weight_kg".into(), "60".into())) && given.contains(&("chest_girth_mm".into(), "931".into()))
    );
    bench.press("<Esc>");
    bench.send(Message::Saved(Err("too late to see in the form".into())));
    assert!(bench.status().contains("too late to see"));
}

#[test]
fn files_are_imported_and_their_errors_read() {
    let mut bench = Bench::example(80, 24);
    bench.press("2ipeople.csv<Enter>");
    assert_eq!(bench.asked(), [Effect::Do(Command::Import(Part::Subject, "people.csv".into()))]);
    bench.send(Message::Saved(Err("people.csv:3: no name\npeople.csv:4: no sex".into())));
    let screen = bench.screen();
    assert!(screen.contains("✗ people.csv:3: no name") && screen.contains("  people.csv:4: no sex"), "{screen}");
    bench.press("<Enter>").asked();
    bench.send(Message::Saved(Ok("2 subjects: 2 added".into())));
    assert!(bench.app.state.overlay.is_none() && bench.status().contains("2 added"));
    assert!(bench.press("i<Enter>").asked().is_empty() && bench.app.state.overlay.is_none(), "no path, no import");
}

#[test]
fn removing_asks() {
    let mut bench = Bench::example(80, 24);
    bench.press("2d");
    assert!(bench.screen().contains("Remove subject anna?") && bench.asked().is_empty());
    bench.press("y");
    assert_eq!(bench.asked(), [Effect::Do(Command::Remove(Part::Subject, "anna".into()))]);
}

#[test]
fn the_palette_reaches_subjects_from_anywhere_and_jobs_are_left_alone() {
    let mut bench = Bench::example(80, 24);
    bench.press("4:add-subject<Enter>");
    assert!(
        bench.app.state.nav.screen == Screen::Subjects && matches!(bench.app.state.overlay, Some(Overlay::Form(_)))
    );
    bench.press("<Esc>xr");
    assert!(bench.asked().is_empty() && bench.app.state.overlay.is_none(), "no job is cancelled from here");

    let mut bench = Bench::new(80, 24, fixture::empty());
    assert!(bench.press("2").screen().contains("no subjects yet: a adds one"), "{}", bench.screen());
    assert!(bench.press("e").status().contains("no subject is selected"));
    bench.app.state.setup.abilities.run = false;
    for keys in ["a", "e", "i", "d"] {
        assert!(bench.press(keys).status().contains("read-only") && bench.app.state.overlay.is_none(), "{keys}");
    }
}

#[test]
fn bodies_are_built_when_seen_and_measured_without_pictures_too() {
    let requests = |bench: &mut Bench| -> Vec<PictureRequest> {
        let effects = std::mem::take(&mut bench.effects);
        effects
            .into_iter()
            .filter_map(|e| if let Effect::Draw(requests) = e { Some(requests) } else { None })
            .flatten()
            .collect()
    };
    let mut bench = Bench::example(80, 24);
    bench.press("2j");
    let asked = requests(&mut bench);
    assert_eq!(
        asked.iter().map(|request| request.of).collect::<Vec<_>>(),
        [3, 1].map(|id| Pictured::Body(SubjectId(id)))
    );
    assert!(asked[0].columns >= 24 && asked[0].rows >= 18);
    assert!(bench.screen().contains("931.3"));
    bench.app.state.setup.abilities.pictures = false;
    bench.press("j");
    assert_eq!(requests(&mut bench)[0].columns, 0);
    assert!(bench.screen().contains("pictures are off"));
    bench.send(Message::Measured(SubjectId(2), Err("body: no such person".into())));
    assert!(bench.screen().contains("body: no such person"));
}

#[test]
fn enter_goes_on_and_saves_on_the_last_line() {
    let lines = 2 + MEASUREMENTS.len();
    let check = |times: usize, expect: bool| {
        let mut bench = Bench::example(80, 24);
        bench.press("2aeva<Enter><Enter>1650").press(&"<Enter>".repeat(times));
        assert_eq!(!bench.asked().is_empty(), expect, "{times} times");
    };
    check(lines - 3, false);
    check(lines - 2, true);
}
