//! Jumps: letters on places of the screen, and where they lead.

use super::{Bench, fixture};
use crate::overlays::Overlay;
use crate::screens::fit::state::View;
use crate::screens::study::actions::places;
use crate::widgets::jump::{Goal, label};

fn letters(bench: &mut Bench, goal: impl Fn(Goal) -> bool) -> String {
    bench.press("'");
    let Some(Overlay::Jump(jump)) = &bench.app.state.overlay else { panic!("{}", bench.screen()) };
    let at = jump.targets.iter().position(|target| goal(target.goal)).expect("it is to be seen");
    label(at, jump.targets.len())
}

#[test]
fn every_label_stands_on_the_row_that_it_leads_to() {
    let check = |keys: &str, row: usize, expect: &str| {
        let mut bench = Bench::example(80, 24);
        bench.press(keys);
        let plain = bench.screen();
        let goal = letters(&mut bench, |goal| matches!(goal, Goal::Row(0 | 2, step) if step == row as isize));
        let Some(Overlay::Jump(jump)) = &bench.app.state.overlay else { panic!("open") };
        let at = jump
            .targets
            .iter()
            .find(|t| matches!(t.goal, Goal::Row(_, step) if step == row as isize))
            .expect("seen")
            .at;
        let line = plain.lines().nth(usize::from(at.y)).expect("on the screen").to_owned();
        assert!(line.contains(expect), "{keys}: {expect} in {line}");
        bench.press(&goal);
        assert!(bench.app.state.overlay.is_none(), "{keys}");
    };
    check("2", 2, "male-ii");
    check("4", 5, " iii");
    check("5", 4, "Neck Opening");
    check("c", 3, "Armhole Circumference");
    check("9", 1, "jersey");
    check("3", 1, "tshirt");
    check("0<Tab><Tab>", 1, "hem");
}

#[test]
fn letters_go_to_cells_rows_panes_and_edges() {
    let mut bench = Bench::example(80, 24);
    let last = places(&bench.app.state).len() - 1;
    let keys = letters(&mut bench, |goal| goal == Goal::Item(last));
    bench.press(&keys);
    assert_eq!(bench.app.state.focus.job.map(|id| id.0), Some(12));

    bench.press("4");
    let keys = letters(&mut bench, |goal| matches!(goal, Goal::Row(0, -3)));
    bench.press(&keys);
    assert_eq!(bench.app.state.focus.job.map(|id| id.0), Some(9));
    let keys = letters(&mut bench, |goal| goal == Goal::Pane(1));
    assert!(bench.press(&keys).app.state.in_second_pane(), "the log has the focus");

    bench.press("3");
    let keys = letters(&mut bench, |goal| goal == Goal::Item(6));
    bench.press(&keys);
    let layout = bench.layout();
    assert_eq!(Some(&bench.app.screens.styles.edge), layout.edges().get(6));
    assert!(bench.app.state.in_second_pane());

    let mut wide = Bench::example(160, 50);
    wide.press("0");
    let keys = letters(&mut wide, |goal| goal == Goal::Pane(View::Section as usize));
    assert_eq!(wide.press(&keys).app.screens.fit.view, View::Section);
}

#[test]
fn any_other_key_closes_the_letters_and_does_nothing() {
    for key in ["<Esc>", "<Enter>", "1", "!"] {
        let mut bench = Bench::example(80, 24);
        bench.press("4'").press(key);
        assert!(bench.app.state.overlay.is_none() && bench.app.state.focus.job.map(|id| id.0) == Some(1), "{key}");
    }
    assert!(Bench::example(80, 24).press("8'").status().contains("nothing to go to"));
    assert!(Bench::new(80, 24, fixture::empty()).press("'").status().contains("nothing to go to"));
}
