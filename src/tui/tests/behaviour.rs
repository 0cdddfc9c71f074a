//! Keys and their effects.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

use super::{Bench, fixture};
use crate::app::App;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::requests::{Command, Target};
use crate::messages::snapshot::Snapshot;
use crate::overlays::Overlay;
use crate::screens::measurements;
use crate::widgets::picture::{self, FRONT, PictureRequest, Pictured};
use results::Map;
use store::owner::Runner;
use store::{JobId, Status};

fn selected(bench: &Bench) -> i64 {
    bench.app.state.focus.job.map_or(0, |id| id.0)
}

#[test]
fn keys_move_in_the_grid() {
    let check = |keys: &str, expect: i64| assert_eq!(selected(Bench::example(80, 24).press(keys)), expect, "{keys}");
    check("", 1);
    check("j", 2);
    check("l", 3);
    check("ll", 5);
    check("lll", 5);
    check("jj", 7);
    check("G", 8);
    check("Gg", 1);
    check("h", 1);
    check("f", 2);
    check("ff", 1);
}

#[test]
fn the_selected_job_is_one_on_all_screens() {
    let mut bench = Bench::example(80, 24);
    bench.press("lj4j1");
    assert_eq!(selected(&bench), 5);
    assert_eq!((bench.app.state.place.subject, bench.app.state.place.simulator), (2, 0));
    bench.press("5");
    assert!(bench.screen().contains("tshirt S · iii · FEM"));
}

#[test]
fn screens_are_gone_back_to_and_q_quits_at_the_top_only() {
    let mut bench = Bench::example(80, 24);
    bench.press("4<Enter>");
    assert_eq!(bench.app.state.nav.screen, Screen::Results);
    bench.press("q");
    assert_eq!(bench.app.state.nav.screen, Screen::Jobs);
    bench.press("<Esc>");
    assert_eq!(bench.app.state.nav.screen, Screen::Study);
    bench.press("<Esc>");
    assert_eq!(bench.asked(), [], "Escape never quits");
    bench.press("q");
    assert_eq!(bench.asked(), [Effect::Quit]);
    assert_eq!(Bench::example(80, 24).press("4:q<Enter>").asked(), [Effect::Quit]);
}

#[test]
fn destructive_actions_ask_and_others_act() {
    let mut bench = Bench::example(80, 24);
    bench.press("4jjjjjjx");
    assert_eq!(bench.asked(), []);
    assert!(bench.screen().contains("Cancel job 7, tshirt M on i by FEM?"));
    bench.press("n");
    assert_eq!(bench.asked(), []);
    bench.press("xy");
    assert_eq!(bench.asked(), [Effect::Do(Command::Cancel(vec![JobId(7)]))]);
    bench.press("p");
    assert_eq!(bench.asked(), [Effect::Do(Command::Pause("men-tops".into()))]);
    bench.press("kkr");
    assert_eq!(bench.asked(), [Effect::Do(Command::Retry(vec![JobId(5)]))]);
    bench.press("+");
    assert_eq!(bench.asked(), [Effect::Do(Command::Prioritise(JobId(5), 1))]);
}

#[test]
fn what_cannot_be_done_says_why() {
    let check = |keys: &str, expect: &str| {
        let mut bench = Bench::example(120, 24);
        bench.press(keys);
        assert_eq!(bench.asked(), [], "{keys}");
        assert!(bench.status().contains(expect), "{keys}: {}", bench.status());
    };
    check("x", "job 1 has ended (done): nothing to cancel");
    check("r", "job 1 is not run again: it has a result");
    check("lr", "the same inputs give the same result");
    check("n", "no filter is set");
    check("X", "no run goes on here; no job of it runs anywhere");
    check("}", "there is one study only");
    check("5t", "one stage only");
}

#[test]
fn a_run_is_started_once_and_asked_about_when_leaving() {
    let mut bench = Bench::example(80, 24);
    bench.press("R");
    assert_eq!(bench.asked(), [Effect::Run(Target::Study("studies/men-tops/study.toml".into()))]);
    bench.press("R");
    assert_eq!(bench.asked(), []);
    bench.press("q");
    assert!(matches!(bench.app.state.overlay, Some(Overlay::Question { .. })));
    bench.press("n:quit<Enter>s");
    assert_eq!(bench.asked(), [Effect::StopRun, Effect::Quit]);
    bench.press("q");
    assert!(bench.screen().contains("l leave it running    s stop it"), "{}", bench.screen());
    bench.press("l");
    assert_eq!(bench.asked(), [Effect::LeaveRunning(Target::Study("studies/men-tops/study.toml".into()))]);
    bench.send(Message::RunEnded(Ok("men-tops: 5 done".into())));
    assert_eq!(bench.press("q").asked(), [Effect::Notify("men-tops: 5 done".into()), Effect::Quit]);
}

#[test]
fn the_end_of_a_run_is_told_and_kept() {
    let mut bench = Bench::example(80, 24);
    bench.press("R").asked();
    bench.send(Message::RunEnded(Ok("men-tops: 5 done, 2 failed".into())));
    assert_eq!(bench.asked(), [Effect::Notify("men-tops: 5 done, 2 failed".into())]);
    assert!(bench.status().contains("the run has ended: men-tops: 5 done, 2 failed"));
    bench.send(Message::Faded);
    assert!(bench.status().contains("? help"), "the keys are back: {}", bench.status());
    assert!(bench.press("L").screen().contains("# the run has ended: men-tops: 5 done, 2 failed"));
}

#[test]
fn the_end_of_a_run_elsewhere_is_told_once() {
    let mut ended = fixture::snapshot();
    let counts = [(Status::Done, 9), (Status::Failed, 3)];
    ended.studies[0].counts = Status::ALL.map(|status| counts.iter().find(|(of, _)| *of == status).map_or(0, |c| c.1));
    let mut bench = Bench::example(120, 24);
    bench.send(Message::Data(Box::new(fixture::snapshot())));
    assert_eq!(bench.asked(), [], "jobs still run");
    bench.send(Message::Data(Box::new(ended.clone())));
    assert_eq!(bench.asked(), [Effect::Notify("men-tops: 9 done, 3 failed, 1 more than 5 mm inside the body".into())]);
    assert!(bench.status().contains("a run elsewhere has ended: men-tops: 9 done, 3 failed, 1 more than 5 mm"));
    bench.send(Message::Data(Box::new(ended.clone())));
    assert_eq!(bench.asked(), []);

    let mut here = Bench::example(120, 24);
    here.press("R");
    here.send(Message::RunEnded(Ok("men-tops: 9 done".into())));
    here.asked();
    here.send(Message::Data(Box::new(ended)));
    assert_eq!(here.asked(), [], "its own end was told already");
}

#[test]
fn a_run_of_a_paused_study_says_that_it_waits() {
    let mut data = fixture::snapshot();
    data.studies[0].paused = true;
    let mut bench = Bench::new(120, 24, data);
    assert!(bench.press("R").status().contains("men-tops is paused: its jobs wait until p resumes it"));
}

#[test]
fn a_run_elsewhere_is_named() {
    let check = |runner: Option<Runner>, expect: &str| {
        let data = Snapshot { runners: runner.into_iter().collect(), ..fixture::snapshot() };
        let mut bench = Bench::new(120, 24, data);
        bench.press("X");
        assert!(bench.status().contains(expect), "{}", bench.status());
        assert_eq!(bench.asked(), []);
    };
    let runner = |pid| Runner { name: "process 71 on loom".into(), pid, jobs: 2 };
    check(Some(runner(Some(71))), "no run goes on here; process 71 on loom runs 2 jobs: `kill 71` stops it");
    check(Some(runner(None)), "process 71 on loom runs 2 jobs: it is stopped there");
    check(None, "no run goes on here; no job of it runs anywhere");
}

#[test]
fn what_is_seen_is_what_is_searched() {
    let check = |keys: &str, expect: &[i64]| {
        let mut bench = Bench::example(160, 50);
        bench.press(keys);
        let App { state, screens } = &bench.app;
        let shown: Vec<i64> = screens.jobs.shown(state).iter().map(|job| job.id.0).collect();
        assert_eq!(shown, expect, "{keys}");
    };
    check("4/not at", &[3]);
    check("4/≈", &[3]);
    check("4/✓!", &[2]);
    check("4/37 mm inside", &[2]);
    check("4/conv", &[1, 4, 5]);
    check("4/in work", &[7, 8]);
    check("4/58%", &[7, 8]);
    check("4/0.0117", &[1]);
    check("4/queued", &[9, 10, 11, 12]);
    check("4/diverged", &[5]);

    let rows = |keys: &str| {
        let mut bench = Bench::example(160, 50);
        bench.press(keys);
        let state = &bench.app.state;
        let measured: Vec<String> = measurements::rows(state).iter().map(|row| row.name.clone()).collect();
        measured
    };
    assert_eq!(rows("5/1.061"), ["Neck Opening"]);
    assert_eq!(rows("5/356.5"), ["Sleeve Opening"]);
    assert_eq!(rows("5/="), ["Armhole Circumference"]);

    let mut bench = Bench::example(80, 24);
    bench.press("/≈<Enter>n");
    assert_eq!(selected(&bench), 3);
    bench.press("<Esc>/58%<Enter>n");
    assert_eq!(selected(&bench), 7);
}

#[test]
fn ctrl_z_suspends_from_everywhere() {
    for keys in ["<C-z>", "7eSELECT<C-z>", "?<C-z>", "R:q<C-z>"] {
        let effects = Bench::example(80, 24).press(keys).asked();
        assert_eq!(effects.last(), Some(&Effect::Suspend), "{keys}");
    }
}

#[test]
fn a_click_goes_where_it_hits() {
    let click = |bench: &mut Bench, column: u16, row: u16| {
        let kind = MouseEventKind::Down(MouseButton::Left);
        bench.send(Message::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE }));
    };
    let mut bench = Bench::example(80, 24);
    // A cell of the grid: the fourth line of the screen is size S by Hybrid.
    click(&mut bench, 20, 4);
    assert_eq!(selected(&bench), 4);
    bench.press("4");
    click(&mut bench, 30, 6);
    assert_eq!(selected(&bench), 4);
    click(&mut bench, 30, 3);
    assert_eq!(selected(&bench), 1);
    click(&mut bench, 30, 20);
    assert!(bench.app.state.in_second_pane(), "the log");
}

#[test]
fn a_lost_terminal_ends_the_workbench_but_not_its_run() {
    let mut bench = Bench::example(80, 24);
    bench.send(Message::Hangup);
    assert_eq!(bench.asked(), [Effect::Quit]);

    let mut bench = Bench::example(80, 24);
    bench.press("R").asked();
    bench.send(Message::Hangup);
    assert!(bench.asked().is_empty() && bench.app.state.terminal.detached);
    bench.send(Message::RunEnded(Err("the disk is full".into())));
    assert_eq!(bench.asked(), [Effect::Quit]);

    bench.send(Message::Terminate);
    assert_eq!(bench.asked(), [Effect::StopRun, Effect::Quit]);
}

#[test]
fn enter_runs_the_quickstart_where_there_is_no_study() {
    let mut bench = Bench::new(80, 24, fixture::empty());
    assert_eq!(bench.press("<Enter>").asked(), [Effect::Run(Target::Quickstart)]);
    assert!(bench.screen().contains("is being made ready"));
}

#[test]
fn filters_narrow_jobs_and_measurements_and_find_cells() {
    let mut bench = Bench::example(80, 24);
    bench.press("4/queued<Enter>");
    assert_eq!(bench.app.screens.jobs.shown(&bench.app.state).len(), 4);
    assert_eq!(selected(&bench), 9, "the selection stays among what is shown");
    bench.press("nN");
    assert_eq!(selected(&bench), 9);
    bench.press("<Esc>");
    assert_eq!(bench.app.screens.jobs.shown(&bench.app.state).len(), 12);

    bench.press("g5/neck<Enter>");
    assert_eq!(measurements::rows(&bench.app.state).len(), 1);
    bench.press("/x<Esc>");
    assert_eq!(measurements::rows(&bench.app.state).len(), 1, "Escape undoes what was typed");

    let mut bench = Bench::example(80, 24);
    bench.press("/failed<Enter>n");
    assert_eq!(bench.app.state.job().map(|job| job.status), Some(Status::Failed));
}

#[test]
fn sorting_puts_what_needs_attention_first() {
    let first = |keys: &str| {
        let mut bench = Bench::example(80, 24);
        let App { state, screens } = &bench.press(keys).app;
        screens.jobs.shown(state)[0].id.0
    };
    assert_eq!(first("4"), 1);
    assert_eq!(first("4S"), 12);
    assert_eq!(first("4s"), 7, "running");
    assert_eq!(first("4ss"), 1, "greatest EI");
    assert_eq!(first("4sss"), 6, "longest");
    let worst = |keys: &str| measurements::rows(&Bench::example(80, 24).press(keys).app.state)[0].name.clone();
    assert_eq!(worst("5s"), "Neck Opening");
    assert_eq!(worst("5sS"), "Front Center Length");
}

#[test]
fn pictures_are_asked_for_when_seen_and_only_then() {
    let mut bench = Bench::example(80, 24);
    let requests = |bench: &mut Bench| -> Vec<PictureRequest> {
        let effects = std::mem::take(&mut bench.effects);
        effects
            .into_iter()
            .filter_map(|e| if let Effect::Draw(requests) = e { Some(requests) } else { None })
            .flatten()
            .collect()
    };
    assert_eq!(requests(&mut bench), []);
    bench.press("5");
    let first = requests(&mut bench);
    let expect = PictureRequest { of: Pictured::Drape(JobId(1)), look: FRONT, map: Map::Plain, columns: 28, rows: 19 };
    assert_eq!(first, [expect]);
    bench.press("j");
    assert_eq!(requests(&mut bench), []);
    bench.press("v");
    assert_eq!(requests(&mut bench), [PictureRequest { look: picture::next_view(FRONT), ..expect }]);
    bench.press("<Tab>hhhhhhm");
    let turned = requests(&mut bench);
    assert_eq!(turned.last(), Some(&PictureRequest { map: Map::Check, ..expect }));
    bench.press("<Enter>");
    assert_eq!(requests(&mut bench)[0].columns, 78);
    bench.send(Message::Resize(100, 30));
    assert_eq!(requests(&mut bench)[0].columns, 98);
    bench.press("<Enter><Tab>1GG5");
    assert!(
        requests(&mut bench).iter().all(|request| request.of != Pictured::Drape(JobId(8))),
        "a running job has no drape yet"
    );
}

#[test]
fn late_pictures_of_something_else_are_dropped() {
    let mut bench = Bench::example(80, 24);
    bench.press("5");
    let wanted = *bench.app.state.pictures.requests.first().expect("asked for");
    bench.send(Message::Picture(PictureRequest { map: Map::Gap, ..wanted }, Err("late".into())));
    assert!(bench.app.state.pictures.drawn.is_empty());
    bench.send(Message::Picture(wanted, Err("artefact is gone".into())));
    assert!(bench.screen().contains("no picture: artefact"));
}

#[test]
fn copies_are_tables() {
    let copied = |keys: &str| match Bench::example(80, 24).press(keys).asked().as_slice() {
        [Effect::Copy(text)] => text.clone(),
        other => panic!("{other:?}"),
    };
    assert!(copied("y").starts_with("1\tmen-tops\ttshirt\tS\ti\tfem\tdone\t0.011700\t"));
    let table = copied("5y");
    assert_eq!(table.lines().count(), 7);
    assert_eq!(table.lines().nth(1), Some("1\tHem Circumference\t974.0\t973.5\t0.999500"));
}

#[test]
fn running_jobs_leave_a_trace() {
    let mut bench = Bench::example(80, 24);
    bench.press("4jjjjjj");
    assert_eq!(bench.app.screens.jobs.steps(&bench.app.state).len(), 1);
    let mut next = fixture::snapshot();
    for job in &mut next.jobs {
        if let Some(progress) = &mut job.progress {
            progress.step.iteration += 1;
        }
    }
    next.detail = Some(fixture::detail(JobId(7)));
    bench.send(Message::Data(Box::new(next.clone())));
    bench.send(Message::Data(Box::new(next)));
    assert_eq!(bench.app.screens.jobs.steps(&bench.app.state).len(), 2, "the same step twice is one");
}

#[test]
fn data_that_shrinks_leaves_nothing_selected_that_is_gone() {
    let mut bench = Bench::example(80, 24);
    bench.press("Gll4");
    bench.send(Message::Data(Box::new(fixture::empty())));
    assert!(bench.app.state.job().is_none());
    assert!(bench.press("jkGg145q").screen().contains("no study yet"));
}

#[test]
fn the_palette_goes_to_what_has_a_name() {
    let mut bench = Bench::example(80, 24);
    let name = bench.app.state.data.as_ref().expect("read").subjects[1].name.clone();
    bench.press(&format!(":subject {name}"));
    assert!(bench.screen().contains(&name), "{}", bench.screen());
    bench.press("<Enter>");
    assert!(
        bench.app.state.nav.screen == Screen::Subjects
            && bench.app.screens.subjects.selected(&bench.app.state).is_some_and(|row| row.name == name)
    );
    bench.press(":tshirtM<Enter>");
    assert!(
        bench.app.state.nav.screen == Screen::Styles
            && bench.app.screens.styles.size_row(&bench.app.state).is_some_and(|row| row.size == "M")
    );
}

#[test]
fn the_tour_shows_six_screens_and_ends() {
    let mut bench = Bench::example(80, 24);
    bench.press("T");
    let mut seen = vec![];
    for step in 1..=6 {
        assert!(bench.screen().contains(&format!("tour, {step} of 6")), "{}", bench.screen());
        seen.push(bench.app.state.nav.screen);
        bench.press("<Enter>");
    }
    assert!(bench.app.state.overlay.is_none() && bench.status().contains("that was the tour"));
    assert_eq!(seen, [Screen::Study, Screen::Fit, Screen::Results, Screen::Compare, Screen::Sql, Screen::Reports]);
    assert!(bench.press("T<Enter><Left>").screen().contains("tour, 1 of 6"));
    assert!(bench.press("<Esc>").app.state.overlay.is_none());
    let mut first = Bench::new(80, 24, fixture::empty());
    assert!(first.press("T").status().contains("needs results"));
}

#[test]
fn an_action_acts_on_all_selected_jobs() {
    let check = |keys: &str, question: &str, expect: &[Effect]| {
        let mut bench = Bench::example(120, 30);
        bench.press(keys);
        assert!(bench.screen().contains(question), "{keys}: {}", bench.screen());
        assert_eq!(bench.press("y").asked(), expect, "{keys}");
    };
    let jobs = |ids: &[i64]| ids.iter().copied().map(JobId).collect::<Vec<_>>();
    check("4jjjjjj jjVx", "Cancel the 3 selected jobs?", &[Effect::Do(Command::Cancel(jobs(&[7, 8, 9])))]);
    check("4/queued<Enter>*x", "Cancel the 4 selected jobs?", &[Effect::Do(Command::Cancel(jobs(&[9, 10, 11, 12])))]);
    check("4*x", "Cancel 6 of the 12", &[Effect::Do(Command::Cancel(jobs(&[7, 8, 9, 10, 11, 12])))]);
    check("4**jjjjjjx", "Cancel job 7,", &[Effect::Do(Command::Cancel(jobs(&[7])))]);

    let mut bench = Bench::example(120, 30);
    assert_eq!(bench.press("4*r").asked(), [Effect::Do(Command::Retry(jobs(&[5, 6])))]);
    assert_eq!(bench.press("u r").asked(), [], "job 1 has a result");
    let mut bench = Bench::example(120, 30);
    bench.press("/failed<Enter>*r");
    assert_eq!(bench.asked(), [Effect::Do(Command::Retry(jobs(&[5])))], "cells of the grid too");
    assert!(Bench::example(120, 30).press("4 jVr").status().contains("none of the 2 selected jobs failed"));
}

#[test]
fn several_entries_are_removed_together() {
    let check = |keys: &str, question: &str, expect: &[&str]| {
        let mut bench = Bench::example(120, 30);
        bench.press(keys);
        assert!(bench.screen().contains(question), "{keys}: {}", bench.screen());
        let effects = bench.press("y").asked();
        let removed: Vec<&str> = effects
            .iter()
            .filter_map(|effect| match effect {
                Effect::Do(Command::Remove(_, name)) => Some(name.as_str()),
                _ => None,
            })
            .collect();
        assert_eq!(removed, expect, "{keys}");
    };
    check("9 jjVd", "Remove 3 fabrics", &["cotton_shirting_light", "jersey", "stiff"]);
    check("9jd", "Remove fabric jersey?", &["jersey"]);
    check("9/stretch<Esc>*ujd", "Remove fabric jersey?", &["jersey"]);
}

#[test]
fn actions_touch_only_what_is_seen() {
    let check = |keys: &str, question: &str, expect: &[i64]| {
        let mut bench = Bench::example(120, 30);
        bench.press(keys);
        let asked = match &bench.app.state.overlay {
            Some(Overlay::Question { text, .. }) => text.clone(),
            _ => bench.screen(),
        };
        assert!(asked.contains(question), "{keys}: {asked}");
        let jobs = expect.iter().copied().map(JobId).collect();
        assert_eq!(bench.press("y").asked(), [Effect::Do(Command::Cancel(jobs))], "{keys}");
    };
    check(
        "4*/queued<Enter>x",
        "Cancel the 4 selected jobs? 8 more are selected that are not seen here",
        &[9, 10, 11, 12],
    );
    check("4jjjjjj j <Enter>x", "Cancel job 8, tshirt M on i by HYB? 1 more is selected that is not seen here", &[8]);
    let mut bench = Bench::example(120, 30);
    bench.press("4*/failed<Enter>r");
    assert!(bench.screen().contains("Queue 1 selected jobs again? 11 more"), "{}", bench.screen());
    assert_eq!(bench.press("y").asked(), [Effect::Do(Command::Retry(vec![JobId(5)]))]);
    assert!(Bench::example(120, 30).press("4 /failed<Enter>r").status().contains("no job is selected here. 1 more"));
    let mut bench = Bench::example(120, 30);
    bench.press("9*/jersey<Enter>d");
    assert!(bench.screen().contains("Remove fabric jersey?") && bench.screen().contains("2 more are"));
}

#[test]
fn marks_stay_behind_with_their_list() {
    let marked = |keys: &str| Bench::example(80, 24).press(keys).app.state.marks.len();
    let check = |keys: &str, expect: usize| assert_eq!(marked(keys), expect, "{keys}");
    check("4*", 12);
    check("4*c", 12);
    check("4*c<Esc>", 12);
    check("4*<Enter>", 12);
    check("4*1", 0);
    check("4*7", 0);
    check("4*c7", 0);
    check(" 4", 0);
    let entries = |keys: &str| Bench::example(80, 24).press(keys).app.screens.fabrics.marks.len();
    assert_eq!((entries("9*"), entries("9*1")), (3, 0));
}

#[test]
fn all_that_failed_is_queued_again_by_one_key() {
    for keys in ["4A", "A", ":fail<Enter>", "4/queued<Enter>A"] {
        let asked = Bench::example(80, 24).press(keys).asked();
        assert_eq!(asked, [Effect::Do(Command::Retry(vec![JobId(5)]))], "{keys}");
    }
    assert!(Bench::example(80, 24).press("4").screen().contains(" A all failed "));
}

#[test]
fn the_study_is_in_the_header_of_every_screen() {
    let check = |name: &str, width: u16, screen: char, expect: &str| {
        let mut data = fixture::snapshot();
        data.studies[0].name = name.into();
        let mut bench = Bench::new(width, 24, data);
        bench.press(&screen.to_string());
        let header = bench.screen().lines().next().unwrap_or_default().to_owned();
        assert!(header.contains(expect), "{name} at {width} on {screen}: {header}");
    };
    for screen in "1234567890".chars() {
        check("men-tops", 80, screen, " men-tops ");
        check("a-study-of-trousers", 80, screen, " a-study");
        check("a-study-of-trousers", 160, screen, " a-study-of-trousers ");
        check("men-tops", 66, screen, " ");
    }
    check("men-tops", 80, '4', "✗1");
}
