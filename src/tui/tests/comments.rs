//! Comments of fittings: listed, added, changed, taken back.

use insta::assert_snapshot;

use super::{Bench, fixture};
use crate::messages::comments::{Change, CommentDeed, FittingOf, RoundRequest};
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::requests::Command;
use crate::messages::taught;
use crate::overlays::Overlay;
use crate::threads::{database, reading, rounds};
use crate::widgets::ascii::stand_in;
use store::comments::{Edit, Remark, Severity, Side, State};

fn fitting(subject: &str) -> FittingOf {
    FittingOf { study: "men-tops".into(), garment: "tshirt".into(), subject: subject.into() }
}

fn change(bench: &mut Bench, keys: &str) -> (FittingOf, Change) {
    match bench.press(keys).asked().as_slice() {
        [Effect::Do(Command::Comment(of, CommentDeed::Set(change)))] => (of.clone(), (**change).clone()),
        other => panic!("{keys}: {other:?}"),
    }
}

#[test]
fn looks() {
    let check = |name: &str, width: u16, height: u16, keys: &str| {
        let mut bench = Bench::example(width, height);
        assert_snapshot!(format!("{name}_{width}x{height}"), bench.press(keys).screen());
    };
    for (width, height) in [(80, 24), (160, 50)] {
        check("comments", width, height, "0m");
        check("comments_of_the_study", width, height, "0mzG");
        check("comment_form", width, height, "0mj<Enter><Tab>");
        check("new_comment", width, height, "0mi<Right><Tab><Enter><F5>");
    }
    check("no_comment", 80, 24, "0llm");
}

#[test]
fn every_sign_has_a_stand_in_and_no_terminal_is_too_small() {
    for keys in ["0m", "0mz", "0mi", "0m<Enter>", "0mb", "0mS", "0llm"] {
        let screen = Bench::example(160, 50).press(keys).screen();
        let odd: String = screen.chars().filter(|sign| !sign.is_ascii() && stand_in(*sign) == '?').collect();
        assert!(odd.is_empty(), "{keys}: {odd}");
        for (width, height) in [(1, 1), (12, 4), (59, 15), (119, 20), (80, 3)] {
            assert!(!Bench::example(width, height).press(keys).screen().is_empty(), "{width}x{height} {keys}");
        }
    }
}

#[test]
fn comments_of_the_last_round_are_listed_and_filtered() {
    let check = |keys: &str, expect: &[(&str, i64)]| {
        let mut bench = Bench::example(80, 24);
        let app = &bench.press(keys).app;
        let shown = app.screens.fit.comments.shown(&app.state);
        let shown: Vec<(&str, i64)> = shown.iter().map(|one| (one.subject.as_str(), one.number)).collect();
        assert_eq!(shown, expect, "{keys}");
    };
    check("0m", &[("i", 1), ("i", 2), ("i", 3)]);
    check("0ml", &[("ii", 1)]);
    check("0mz", &[("i", 1), ("i", 2), ("i", 3), ("ii", 1)]);
    check("0mz/closed<Enter>", &[("ii", 1)]);
    check("0m/critical<Enter>", &[("i", 3)]);
    // What an earlier round met is not of the last one.
    let mut bench = Bench::example(80, 24);
    let mut data = bench.app.state.data.clone().expect("read");
    data.rounds[0].round = 3;
    bench.send(Message::Data(data));
    bench.press("0m");
    assert_eq!(bench.app.screens.fit.comments.shown(&bench.app.state).len(), 2);
}

#[test]
fn a_comment_is_changed_in_a_form_and_the_change_taken_back() {
    let mut bench = Bench::example(80, 24);
    let (of, changed) = change(&mut bench, "0m<Enter><Right><Tab>!<Tab><C-u>darts<Tab><C-u>ann<Tab> <Enter>");
    let edit = Edit {
        severity: Some(Severity::Critical),
        said: Some("chest tight by 44 mm!".into()),
        action: Some("darts".into()),
        owner: Some("ann".into()),
        status: Some(State::Closed),
        is_worded: None,
    };
    let before = Edit {
        severity: Some(Severity::Major),
        said: Some("chest tight by 44 mm".into()),
        action: Some("chest +44.0 mm (widens front and back under the arm) on front, back".into()),
        owner: Some("ben".into()),
        status: Some(State::Open),
        is_worded: Some(false),
    };
    assert_eq!((of.clone(), changed.clone()), (fitting("i"), Change { number: 1, edit, before: Some(before.clone()) }));
    assert!(matches!(bench.app.state.overlay, Some(Overlay::CommentForm(_))), "until it is saved");
    bench.send(Message::Commented(of, Box::new(changed), "comment 1 is changed".into()));
    assert!(bench.app.state.overlay.is_none() && bench.status().contains("comment 1 is changed"));
    let log = bench.app.state.told.commands.last().cloned().expect("told as a command");
    let command = "toile comment set men-tops --garment tshirt --subject i 1 --status closed --severity critical \
                   --text 'chest tight by 44 mm!' --action darts --owner ann";
    assert_eq!(log, command);
    assert_eq!(change(&mut bench, "u"), (fitting("i"), Change { number: 1, edit: before, before: None }));
    assert_eq!(bench.press("u").asked(), [], "{}", bench.status());
    assert!(bench.status().contains("no comment was changed here"), "{}", bench.status());
    // A form without a change writes nothing.
    assert_eq!(bench.press("<Enter><F5>").asked(), []);
    assert!(bench.app.state.overlay.is_none());
}

#[test]
fn comments_are_closed_and_opened_again_by_one_key() {
    let status = |keys: &str| change(&mut Bench::example(80, 24), keys).1.edit;
    let to = |status| Edit { status: Some(status), ..Edit::default() };
    assert_eq!(status("0mx"), to(State::Closed));
    assert_eq!(status("0mjx"), to(State::Open));
    assert_eq!(status("0mlx"), to(State::Open));
    assert_eq!(change(&mut Bench::example(80, 24), "0mzGx").0, fitting("ii"), "the fitting of the selected comment");
}

#[test]
fn comments_are_added_to_a_round_and_rounds_begun_and_signed() {
    let mut bench = Bench::example(80, 24);
    bench.press("0mi<F5>");
    assert!(bench.screen().contains("a comment needs a place"), "{}", bench.screen());
    bench.press("waist<Tab><Tab><F5>");
    assert!(bench.screen().contains("a comment needs words"), "{}", bench.screen());
    let remark = Remark {
        side: Side::Back,
        place: "waist".into(),
        said: "rides up".into(),
        severity: Severity::Minor,
        cause: String::new(),
        action: String::new(),
        quantity: None,
    };
    let added = bench.press("rides up<Up><Up><Up><Left><F5>").asked();
    assert_eq!(added, [Effect::Do(Command::Comment(fitting("i"), CommentDeed::Add(remark)))]);
    let command = taught::command(&added[0]);
    let expect =
        "toile comment add men-tops --garment tshirt --subject i --at 'back:waist' 'rides up' --severity minor";
    assert_eq!(command.as_deref(), Some(expect));
    bench.send(Message::Saved(Ok("added".into())));
    assert!(bench.app.state.overlay.is_none());

    let signed = bench.press("Sann<Enter>").asked();
    assert_eq!(signed, [Effect::Do(Command::Comment(fitting("i"), CommentDeed::Sign("ann".into())))]);
    bench.send(Message::Saved(Ok("signed".into())));
    assert_eq!(bench.press("b").asked(), [], "it asks");
    assert!(bench.screen().contains("Begin round 3 of tshirt on i?"), "{}", bench.screen());
    let request = RoundRequest { study: "studies/men-tops/study.toml".into(), of: fitting("i") };
    assert_eq!(bench.press("y").asked(), [Effect::Round(request)]);
    // Without a round there is none to add to or to sign.
    for (keys, told) in [("lli", "no round yet: b begins one"), ("S", "no round to sign yet"), ("x", "no comment is")] {
        assert!(bench.press(keys).status().contains(told), "{keys}: {}", bench.status());
    }
    bench.press("b");
    assert!(bench.screen().contains("Begin round 1 of tshirt on iii?"), "{}", bench.screen());
}

#[test]
fn nothing_changes_unseen_or_where_nothing_may() {
    let mut bench = Bench::example(80, 24);
    for keys in ["0i", "0x", "0aS", "1:close-comment<Enter>"] {
        assert_eq!(bench.press(keys).asked(), [], "{keys}");
        assert!(bench.status().contains("m on screen 0 shows them"), "{keys}: {}", bench.status());
        bench.press("<Esc>");
    }
    bench.app.state.setup.abilities.run = false;
    for keys in ["0mi", "<Enter>", "x", "u", "b", "S"] {
        assert_eq!(bench.press(keys).asked(), [], "{keys}");
        assert!(bench.status().contains("read-only"), "{keys}: {}", bench.status());
    }
    assert!(!bench.press("z").status().contains("read-only"));
    assert!(Bench::new(80, 24, fixture::empty()).press("0mzixbSu").screen().contains("no study yet"));
}

#[test]
fn the_threads_begin_a_round_and_change_its_comments() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("quickstart");
    spec::write_quickstart(&path).expect("written");
    let mut store = wardrobe::catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
    let study = engine::run::load_study(&store, &path).expect("good");
    engine::enqueue::queue(&mut store, &study, &spec::Selection::default()).expect("queued");
    let of = FittingOf { study: "quickstart".into(), garment: "tshirt".into(), subject: "v".into() };
    let request = RoundRequest { study: study.path.clone(), of: of.clone() };
    let told = rounds::begin(&mut store, &request).expect("a round");
    assert!(told.starts_with("tshirt on v: round 1, size L"), "{told}");
    let again = rounds::begin(&mut store, &request).expect("no round");
    assert!(again.ends_with("nothing has changed since the last round"), "{again}");

    let read = |store: &store::Store| reading::snapshot(store, &Default::default()).expect("readable");
    let first = read(&store).comments[0].clone();
    let edit = Edit { said: Some("mine".into()), owner: Some("ann".into()), ..Edit::default() };
    let change = Change::of(&first, edit);
    let back = change.before.clone().expect("it can be taken back");
    let mut set = |change: Change| {
        let deed = CommentDeed::Set(Box::new(change));
        database::carry_out(&mut store, &Command::Comment(of.clone(), deed)).expect("changed");
        read(&store).comments[0].clone()
    };
    let changed = set(change);
    assert_eq!((changed.remark.said.as_str(), changed.owner.as_str(), changed.is_worded), ("mine", "ann", true));
    assert_eq!(set(Change { number: first.number, edit: back, before: None }), first, "as it was, words too");
    let sign = CommentDeed::Sign("ann".into());
    database::carry_out(&mut store, &Command::Comment(of.clone(), sign)).expect("signed");
    let rounds = read(&store).rounds;
    assert_eq!((rounds.len(), rounds[0].signed_by.as_deref(), rounds[0].round), (1, Some("ann"), 1));
}
