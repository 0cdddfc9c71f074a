//! Keys on the Styles screen.

use super::{Bench, fixture};
use crate::keys::screen::Screen;
use crate::messages::effect::{Effect, Writing};
use crate::messages::message::Message;
use crate::messages::requests::Command;
use crate::messages::seams::{PreviewRequest, Previewed};
use crate::overlays::Overlay;
use crate::screens::styles::asking::named;
use crate::screens::styles::state::{EdgeAt, TableLine};
use crate::widgets::theme::Colours;
use results::preview::Hung;
use store::files::SourceFile;
use wardrobe::seams::{Choice, DeskSeam, SeamStep, Undecided};
use wardrobe::{Part, StyleGiven};

fn seams(bench: &Bench) -> Vec<DeskSeam> {
    bench.layout().out.desk.seams.clone()
}

fn seam(bench: &Bench) -> String {
    let layout = bench.layout();
    layout.seam_at(bench.app.screens.styles.edge).map_or("none".into(), |k| layout.out.desk.seams[k].name.clone())
}

fn saved(bench: &mut Bench) -> SourceFile {
    match bench.press("w").asked().pop() {
        Some(Effect::Do(Command::SaveSeams(style, seams))) if style == "tshirt" => seams,
        other => panic!("{other:?}"),
    }
}

#[test]
fn sizes_are_chosen_and_filtered_and_each_is_laid_out_once() {
    let mut bench = Bench::example(80, 24);
    let size = |bench: &Bench| {
        bench.app.screens.styles.size_row(&bench.app.state).map_or("", |row| row.size.as_str()).to_owned()
    };
    bench.press("3");
    assert_eq!((size(&bench).as_str(), seams(&bench).len()), ("S", 8));
    assert_eq!(size(bench.press("j")), "M");
    let layings = bench.effects.iter().filter(|effect| matches!(effect, Effect::Seams(_))).count();
    assert_eq!(layings, 2);
    assert_eq!(size(bench.press("g/-M.dxf<Enter>")), "M");
    assert!(bench.press("/zz<Enter>").screen().contains("no size matches the filter"));
    assert_eq!(bench.press("<Esc>jy").asked().len(), 1, "the table of seams is copied");
}

#[test]
fn lines_and_edges_are_walked_together() {
    let mut bench = Bench::example(160, 50);
    bench.press("3<Enter>");
    let first = seams(&bench)[0].clone();
    assert_eq!((seam(&bench), bench.app.screens.styles.edge), (first.name.clone(), first.a[0]));
    bench.press("j");
    assert_eq!(seam(&bench), seams(&bench)[1].name);
    bench.press("g");
    let pieces = bench.layout().out.desk.pieces.clone();
    let edges: usize = pieces.iter().map(|piece| piece.edges.len()).sum();
    let start = bench.app.screens.styles.edge;
    for _ in 0..edges {
        bench.press("l");
        let line = bench.app.screens.styles.table_line(&bench.app.state).expect("a line");
        let name = seam(&bench);
        assert!(name == "none" || line == TableLine::Seam(bench.app.screens.styles.line));
        assert!(bench.screen().contains(&format!(
            "{}.{}",
            pieces[bench.app.screens.styles.edge.0].id,
            bench.app.screens.styles.edge.1 + 1
        )));
    }
    assert_eq!(bench.app.screens.styles.edge, start, "all the way round");
    bench.press("G");
    assert!(matches!(bench.app.screens.styles.table_line(&bench.app.state), Some(TableLine::Length(_))));
    assert!(bench.screen().contains("Hem Circumference"));
}

#[test]
fn a_seam_is_opened_sewn_again_turned_taken_back_and_saved() {
    let mut bench = Bench::example(80, 24);
    bench.press("3<Enter>");
    let before = seams(&bench);
    let [a, b] = [before[0].a[0], before[0].b[0]];
    bench.press("x");
    assert_eq!(seams(&bench).len(), before.len() - 1);
    assert_eq!(seam(&bench), "none");
    assert!(undecided(&bench) >= 1 && bench.screen().contains("? What is"), "{}", bench.screen());
    assert!(bench.press("x").status().contains("no seam holds"));
    assert!(bench.press("a").status().contains("m marks an edge"));

    bench.press(" ");
    assert_eq!(bench.app.screens.styles.marks, [a]);
    bench.app.screens.styles.edge = b;
    bench.press("a");
    assert_eq!(seams(&bench).len(), before.len(), "{}", bench.status());
    assert!(bench.app.screens.styles.marks.is_empty());
    assert_eq!(seam(&bench), seams(&bench)[before.len() - 1].name);
    let was_turned = seams(&bench)[before.len() - 1].same_direction;
    bench.press("f");
    assert_eq!(seams(&bench)[before.len() - 1].same_direction, !was_turned);
    bench.press("u");
    assert_eq!(seams(&bench)[before.len() - 1].same_direction, was_turned);
    assert!(bench.screen().contains("*tshirt"), "not saved yet");
    assert!(bench.press("1q").screen().contains("Seams of tshirt are not saved"));
    assert!(bench.press("n3").asked().is_empty());

    let file = saved(&mut bench);
    assert!(String::from_utf8_lossy(&file.bytes).contains("# +u is the wearer's right"), "comments stay");
    bench.send(Message::SeamsSaved("tshirt".into(), file.clone(), Err("size M: too long".into())));
    assert!(bench.status().contains("too long") && bench.screen().contains("*tshirt"));
    bench.send(Message::SeamsSaved("tshirt".into(), file.clone(), Ok("style tshirt has revision 2".into())));
    assert!(bench.screen().contains("tshirt.seams.toml of the study too?"), "{}", bench.screen());
    match bench.press("y").asked().pop() {
        Some(Effect::Do(Command::WriteSeams(path, old, new))) => {
            assert!(path.ends_with("studies/men-tops/tshirt.seams.toml") && old != new && new == file);
        }
        other => panic!("{other:?}"),
    }
    assert!(bench.press("w").status().contains("nothing to save") && bench.press("u").status().contains("nothing"));
}

#[test]
fn sides_of_unlike_length_are_sewn_with_ease_only_after_asking() {
    let mut bench = Bench::example(80, 24);
    bench.press("3<Enter>");
    let before = seams(&bench);
    bench.press("xjx");
    let [one, other] = [before[0].a[0], before[2].a[0]];
    let layout = bench.layout();
    let mm = |(piece, edge): (usize, usize)| layout.out.desk.pieces[piece].edges[edge].length_mm;
    assert!((mm(one) - mm(other)).abs() > 1.0, "the example needs unlike edges");
    bench.app.screens.styles.marks = vec![one, other];
    bench.press("a");
    assert!(bench.screen().contains("mm of ease (ratio"), "{}", bench.screen());
    bench.press("n");
    assert_eq!(seams(&bench).len(), before.len() - 2);
    bench.press("ay");
    let sewn = seams(&bench).pop().expect("there are seams");
    assert!((sewn.a_mm - sewn.b_mm).abs() > 1.0 && seams(&bench).len() == before.len() - 1, "{}", bench.status());
}

fn undecided(bench: &Bench) -> usize {
    bench.layout().out.undecided.len()
}

#[test]
fn proposed_seams_are_confirmed_one_by_one() {
    let mut bench = Bench::example(80, 24);
    bench.press("3p");
    assert!(bench.screen().contains("Propose all seams of tshirt anew?"));
    bench.press("y");
    let unsure = |bench: &Bench| seams(bench).iter().filter(|seam| seam.confidence.is_some()).count();
    let all = seams(&bench).len();
    assert!(all >= 8 && unsure(&bench) == all);
    assert!(bench.screen().contains("A? ") && bench.screen().contains('%'), "{}", bench.screen());
    bench.press("<Enter>");
    assert!(bench.screen().contains(&format!("question 1 of {all}")) && bench.screen().contains("●1 yes"));
    bench.press("y");
    assert_eq!(unsure(&bench), all - 1);
    assert!(bench.screen().contains(&format!("question 1 of {}", all - 1)), "{}", bench.screen());
    assert!(bench.press("jk9").status().contains("no such answer"));
    // The third answer removes the seam, which leaves two edges to decide on.
    bench.press("3");
    assert_eq!((seams(&bench).len(), unsure(&bench)), (all - 1, all - 2));
    bench.press("uU");
    assert_eq!(seams(&bench).len(), all - 1);
    bench.press("u");
    assert_eq!(seams(&bench).len(), all);
    bench.press("A");
    let left = unsure(&bench);
    assert!(left < all - 1);
    for _ in 0..left {
        bench.press("y");
    }
    assert_eq!((unsure(&bench), undecided(&bench)), (0, 0), "nothing is left to ask");
    assert!(
        bench.app.screens.styles.asking.is_none() && bench.screen().contains("no question is left. In no seam:"),
        "{}",
        bench.screen()
    );
    assert!(!String::from_utf8_lossy(&saved(&mut bench).bytes).contains("[[seam]]  # confidence"));
}

#[test]
fn an_edge_is_sewn_and_a_piece_said_by_what_is_offered() {
    let mut bench = Bench::example(80, 24);
    bench.press("3<Enter>");
    let before = seams(&bench);
    bench.press("xe");
    assert!(bench.screen().contains("What is") && bench.screen().contains("1 sewn to"), "{}", bench.screen());
    bench.press("1");
    assert_eq!((seams(&bench).len(), undecided(&bench)), (before.len(), 0), "{}", bench.status());
    bench.press("o");
    assert!(bench.screen().contains("1 not at all: leave it out"), "{}", bench.screen());
    assert!(bench.press("<Esc>").app.screens.styles.asking.is_none() && bench.app.state.nav.screen == Screen::Styles);
    assert!(bench.press("<Enter>").screen().contains("no question is left."));
}

#[test]
fn a_garment_is_sewn_coarsely_while_its_seams_are_edited() {
    let mut bench = Bench::example(160, 50);
    let sewn = |bench: &Bench| -> Vec<PreviewRequest> {
        let preview =
            |effect: &Effect| if let Effect::Preview(request) = effect { Some(request.clone()) } else { None };
        bench.effects.iter().filter_map(preview).collect()
    };
    bench.press("3");
    let first = sewn(&bench).pop().expect("it is asked for");
    assert!(bench.screen().contains("sewing it…"), "{}", bench.screen());
    let seen = |hung: Hung, remark: &str| {
        let remarks = vec![remark.to_owned()];
        Ok(Previewed { subject: "male-i".into(), fabric: "poplin".into(), hung, remarks, took_ms: 400 })
    };
    bench.send(Message::Previewed(Box::new(first.clone()), seen(Hung::Draped, "red edges are in no seam")));
    assert!(
        bench.screen().contains("✓ sewn and draped coarsely; red") && bench.screen().contains("on male-i in poplin")
    );
    bench.press("<Enter>x");
    let next = sewn(&bench).pop().expect("it is asked for again");
    assert!(next.number > first.number && next.size.seams.is_some());
    assert!(bench.screen().contains("again…"), "{}", bench.screen());
    bench.send(Message::Previewed(Box::new(next), seen(Hung::Undone, "a seam stays open")));
    assert!(bench.screen().contains("✗ not sewn up; a seam stays"), "{}", bench.screen());
    // Where only one fits, the preview takes the place of the pieces.
    let mut bench = Bench::example(80, 24);
    bench.press("3");
    assert!(sewn(&bench).is_empty() && bench.screen().contains("fronts up"));
    bench.press("v");
    assert!(sewn(&bench).len() == 1 && !bench.screen().contains("fronts up"), "{}", bench.screen());
    assert!(bench.press("vvvv").screen().contains("fronts up"));
}

#[test]
fn files_are_imported_and_what_they_do_not_say_is_asked_for() {
    let mut bench = Bench::example(80, 24);
    bench.press("3ititan.dxf<Tab>");
    assert!(bench.screen().contains("empty = titan"), "{}", bench.screen());
    bench.press("<F5>");
    let given = StyleGiven { is_proposed: true, patterns: vec![(None, "titan.dxf".into())], ..Default::default() };
    assert_eq!(bench.asked(), [Effect::Do(Command::ImportStyle("titan".into(), given.clone()))]);
    bench.send(Message::Saved(Err("pattern: titan.dxf: no unit; accepted: a file that names its unit".into())));
    let Some(Overlay::StyleForm(form)) = &bench.app.state.overlay else { panic!("the form stays") };
    assert_eq!(form.at, 3, "the unit is asked for");
    bench.press("yard<F5>");
    assert!(bench.asked().is_empty() && bench.screen().contains("unit `yard`; accepted: mm, cm, in, m"));
    bench.press("<Backspace><Backspace><Backspace><Backspace>mm<F5>");
    let given = StyleGiven { unit: Some("mm".into()), ..given };
    assert_eq!(bench.asked(), [Effect::Do(Command::ImportStyle("titan".into(), given))]);
    bench.send(Message::Saved(Ok("style titan is added".into())));
    assert!(bench.app.state.overlay.is_none() && bench.status().contains("titan is added"));
    assert!(bench.press("i<F5>").asked().is_empty() && bench.app.state.overlay.is_none(), "no path, no import");
}

#[test]
fn removing_asks_and_readonly_changes_nothing() {
    let mut bench = Bench::example(80, 24);
    bench.press("3d");
    assert!(bench.screen().contains("Remove size tshirt/S?"));
    assert_eq!(bench.press("y").asked(), [Effect::Do(Command::Remove(Part::Size, "tshirt/S".into()))]);
    let mut data = fixture::snapshot();
    data.sizes.truncate(1);
    bench.send(Message::Data(Box::new(data)));
    assert!(bench.press("d").screen().contains("Remove style tshirt?"));

    let mut bench = Bench::new(80, 24, fixture::empty());
    assert!(bench.press("3").screen().contains("no styles yet: i imports one"), "{}", bench.screen());
    assert!(bench.press("x").status().contains("no size is selected"));
    bench.app.state.setup.abilities.run = false;
    for keys in ["a", "x", "f", "p", "w", "i", "d", " ", "e", "o"] {
        assert!(bench.press(keys).status().contains("read-only") && bench.app.state.overlay.is_none(), "{keys}");
    }
}

#[test]
fn the_palette_reaches_seams_from_anywhere_and_glyphs_need_no_colour() {
    let mut bench = Bench::example(80, 24);
    bench.press("4:save-seams<Enter>");
    assert!(bench.app.state.nav.screen == Screen::Styles && bench.status().contains("nothing to save"));
    bench.app.state.theme.colours = Colours::None;
    bench.press("<Enter> l");
    let screen = bench.screen();
    for glyph in ["●", "◆", "A  ", "✓"] {
        assert!(screen.contains(glyph), "{glyph} in\n{screen}");
    }
    let wide = bench.press("z").screen();
    assert!(wide.contains("front") && wide.matches('●').count() > screen.matches('●').count() / 2);
    assert!(!bench.press("<Esc>").app.screens.styles.enlarged);
}

#[test]
fn what_was_done_is_told_as_commands() {
    let mut bench = Bench::example(80, 24);
    bench.press("3<Enter>xuxe1w");
    let file = match bench.asked().pop() {
        Some(Effect::Do(Command::SaveSeams(_, seams))) => seams,
        other => panic!("{other:?}"),
    };
    assert!(bench.press("L").screen().contains("nothing yet"), "{}", bench.screen());
    bench.press("<Esc>").send(Message::SeamsSaved("tshirt".into(), file, Ok("saved".into())));
    bench.press("nitee.dxf<F5>").send(Message::Saved(Err("pattern: tee.dxf: no such file".into())));
    bench.press("<Esc>L");
    let screen = bench.screen();
    assert!(!screen.contains("tee.dxf"), "what was refused was not done: {screen}");
    // Undone edits are not among the commands.
    assert_eq!(screen.matches("toile style sew tshirt/S rm").count(), 1, "{screen}");
    assert!(screen.contains("toile style sew tshirt/S add"), "{screen}");
    match bench.press("Y").asked().pop() {
        Some(Effect::Copy(text)) => assert_eq!(text.lines().count(), 2, "{text}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn seams_are_written_by_hand_in_an_editor() {
    let mut bench = Bench::example(80, 24);
    bench.press("3<Enter>E");
    let what = match bench.asked().pop() {
        Some(Effect::Write(what @ Writing::Seams(..))) => what,
        other => panic!("{other:?}"),
    };
    let Writing::Seams(_, file) = &what else { return };
    let text = String::from_utf8_lossy(&file.bytes).into_owned();
    bench.send(Message::Written(Box::new(what.clone()), Ok(text.clone())));
    assert!(bench.status().contains("as they were") && bench.app.screens.styles.edits.is_empty());
    bench.send(Message::Written(Box::new(what.clone()), Ok(format!("# mine\n{text}"))));
    assert!(saved(&mut bench).bytes.starts_with(b"# mine\n"), "{}", bench.status());
    bench.send(Message::Written(Box::new(what.clone()), Ok("name = 1".into())));
    assert!(
        bench.app.screens.styles.edits["tshirt"].len() == 1 && !bench.status().contains("done"),
        "{}",
        bench.status()
    );
    bench.send(Message::Written(Box::new(what), Err("vi: not found".into())));
    assert!(bench.status().contains("not found"));
    bench.press("7E");
    assert!(bench.asked().iter().any(|effect| matches!(effect, Effect::Write(Writing::Query(_)))));
}

#[test]
fn a_question_points_at_its_edges() {
    let bench = Bench::example(160, 50).press("3<Enter>").layout().clone();
    let desk = &bench.out.desk;
    let [one, two] = [desk.edge_name((0, 0)), desk.edge_name((1, 1))];
    let id = &desk.pieces[1].id;
    let check = |text: String, expect: &[EdgeAt]| assert_eq!(named(&text, &bench), expect, "{text}");
    check(format!("Is {one} sewn to {two}."), &[(0, 0), (1, 1)]);
    let all: Vec<EdgeAt> = (0..desk.pieces[1].edges.len()).map(|edge| (1, edge)).collect();
    check(format!("What is {id} worn as?"), &all);
    check("It has no name".to_owned(), &[]);

    let mut bench = Bench::example(160, 50);
    let marked = |bench: &Bench| bench.screen().matches('●').count();
    bench.press("3<Enter>");
    let before = marked(&bench);
    bench.press("o");
    assert!(marked(&bench) > before + 10, "the whole piece is marked: {}", bench.screen());
}

#[test]
fn the_preview_is_cut_from_the_fabric_of_the_study() {
    let fabric = |keys: &str| {
        let mut bench = Bench::example(160, 50);
        bench.press(keys);
        let asked = bench.effects.iter().rev().find_map(|effect| match effect {
            Effect::Preview(request) => Some(request.fabric.clone()),
            _ => None,
        });
        asked.expect("it is asked for").unwrap_or_default()
    };
    assert_eq!(fabric("3"), "jersey");
    assert_eq!(fabric("9jj3"), "stiff", "what was gone to counts more");
}

fn asked(width: u16, edges: &[EdgeAt]) -> Bench {
    let mut bench = Bench::example(width, if width < 100 { 24 } else { 50 });
    bench.press("3<Enter>");
    let mut layout = bench.layout().clone();
    let choices = vec![Choice { label: "nothing".into(), step: SeamStep::ConfirmSure, edges: vec![] }];
    let text = "underarm: its sides look as if they do not belong together; what is sewn there?".into();
    layout.out.desk.left_out = vec!["POCKET".into(), "LOOP".into()];
    layout.out.undecided =
        vec![Undecided { text, edges: edges.to_vec(), choices, stands: Some(0), seam: None, is_sure: false }];
    let request = bench.app.screens.styles.requested.clone().expect("laid out");
    bench.send(Message::LaidOut(Box::new(request), Ok(Box::new(layout))));
    bench.press("<Enter>");
    bench
}

#[test]
fn a_question_names_its_edges_as_the_picture_does_and_marks_no_others() {
    let dots = |bench: &Bench| bench.screen().matches('●').count();
    for width in [80, 160] {
        let bench = asked(width, &[(2, 1), (3, 0)]);
        let [one, other] = [(2, 1), (3, 0)].map(|edge| {
            let layout = bench.layout();
            format!("{} {}", layout.out.desk.pieces[edge.0].id, layout.label(edge))
        });
        let screen = bench.screen().replace("│\n", "").replace('│', " ");
        let words: String = screen.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(&one), "{one}: {screen}");
        assert!(words.contains(&other), "{other}: {screen}");
        assert!(words.contains("question 1 of 1 · 2 pieces left out"), "{screen}");
        // Three dots are in legends, and one is the answer that stands.
        let without = asked(width, &[]);
        assert_eq!(dots(&without), 4, "nothing is marked: {}", without.screen());
        assert!(dots(&bench) > 7, "{}", bench.screen());
    }
    insta::assert_snapshot!("question_80x24", asked(80, &[(2, 1), (3, 0)]).screen());
}

#[test]
fn most_edges_have_a_label_at_every_size() {
    for (width, height) in [(80, 24), (120, 40), (160, 50)] {
        let bench = {
            let mut bench = Bench::example(width, height);
            bench.press("3<Enter>z");
            bench
        };
        let pieces = bench.layout().out.desk.pieces.len();
        let screen = bench.screen();
        let labelled = (0..pieces).flat_map(|piece| {
            let edges = bench.layout().out.desk.pieces[piece].edges.len();
            (0..edges).map(move |edge| (piece, edge))
        });
        let seen = labelled.filter(|edge| screen.contains(&bench.layout().label(*edge))).count();
        assert!(seen > 15, "{seen} labels at {width} columns: {screen}");
    }
}

#[test]
fn what_stays_open_is_told_before_it_is_saved() {
    let mut bench = Bench::example(160, 50);
    bench.press("3<Enter>xe");
    let mut layout = bench.layout().clone();
    (layout.out.undecided, layout.out.desk.left_out) = (vec![], vec!["POCKET".into()]);
    let told = layout.left_open();
    assert!(told.contains("In no seam: ") && told.contains(" more. Left out: 1 piece, POCKET."), "{told}");
    let request = bench.app.screens.styles.requested.clone().expect("laid out");
    bench.send(Message::LaidOut(Box::new(request), Ok(Box::new(layout))));
    let screen = bench.screen();
    assert!(screen.contains("no question is left. In no seam:") && screen.contains("POCKET"), "{screen}");
}

#[test]
fn answers_are_not_thrown_away_without_a_question() {
    let propose = |answered: usize| {
        let mut bench = Bench::example(80, 24);
        bench.press("3<Enter>");
        let mut layout = bench.layout().clone();
        layout.out.desk.seams.iter_mut().for_each(|seam| seam.confidence = Some(0.9));
        (layout.out.lengths, layout.out.answered) = (vec![], answered);
        let request = bench.app.screens.styles.requested.clone().expect("laid out");
        bench.send(Message::LaidOut(Box::new(request), Ok(Box::new(layout))));
        bench.press("p").screen().contains("Propose all seams of tshirt anew? Its answers")
    };
    assert!(propose(1) && !propose(0));
}
