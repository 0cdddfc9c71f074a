//! SQL, comparisons, reports, new studies, and the session that is restored.

use std::sync::mpsc;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use insta::assert_snapshot;

use super::{Bench, fixture};
use crate::app::App;
use crate::app::session::Session;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::requests::{FileTask, QueryRequest};
use crate::overlays::Overlay;
use crate::overlays::study_form::StudyForm;
use crate::threads::queries::{self, Canceller};
use crate::widgets::result_table::ResultTable;
use results::ReportRow;
use store::{JobId, LiveFrame, Relation, SqlAnswer, Table, Value, saved_queries};
use wardrobe::catalogue;

/// An answer whose rows have a name, two numbers and a long text.
fn answer(rows: i64) -> SqlAnswer {
    let row = |k: i64| {
        let reason = format!("row {k} because of reasons that take some room to tell");
        vec![
            Value::Text(format!("tshirt {k}")),
            Value::Integer(100 - k),
            Value::Real(0.0117 / k as f64),
            Value::Text(reason),
        ]
    };
    let columns = ["garment", "n", "ei", "why"].map(str::to_owned).to_vec();
    SqlAnswer { table: Table { columns, rows: (1..=rows).map(row).collect() }, is_cut: false }
}

/// Answer of the thread that asks the database.
fn ask(bench: &mut Bench) {
    for effect in bench.asked() {
        match effect {
            Effect::Query(QueryRequest::Names) => {
                let columns = ["study", "garment", "ei"].map(str::to_owned).to_vec();
                let relation = |name: &str| Relation { name: name.into(), columns: columns.clone() };
                let relations = vec![relation("v_metrics"), relation("v_pair"), relation("job")];
                let queries = saved_queries(None).expect("those of the program");
                bench.send(Message::Names(relations, queries));
            }
            Effect::Query(QueryRequest::Rows(text)) => {
                let outcome = if text.contains("wrong") {
                    Err("no such column: wrong in SELECT wrong".to_owned())
                } else {
                    Ok(Box::new(ResultTable::of(answer(30))))
                };
                bench.send(Message::Answered(3, outcome));
            }
            other => panic!("{other:?}"),
        }
    }
}

fn ctrl(bench: &mut Bench, letter: char) {
    bench.send(Message::Key(KeyEvent::new(KeyCode::Char(letter), KeyModifiers::CONTROL)));
}

#[test]
fn a_query_is_typed_completed_run_and_its_rows_sorted() {
    for (width, height) in [(80, 24), (160, 50)] {
        let mut bench = Bench::example(width, height);
        bench.press("7");
        ask(&mut bench);
        assert_snapshot!(format!("sql_{width}x{height}"), bench.screen());
        bench.press("eselect * from v_<Tab>");
        assert_snapshot!(format!("sql_completion_{width}x{height}"), bench.screen());
        bench.press("<F5>");
        assert!(bench.screen().contains("asking… C-c cancels"));
        ask(&mut bench);
        bench.press("<Esc><Right>s");
        assert_snapshot!(format!("sql_rows_{width}x{height}"), bench.screen());
        bench.press("/tshirt 7<Enter>");
        assert_eq!(bench.app.screens.sql.table.as_ref().map(ResultTable::len), Some(1));
        assert_eq!(bench.press("y").asked(), [Effect::Copy("garment\tn\tei\twhy\ntshirt 7\t93\t0.0016714285714285715\trow 7 because of reasons that take some room to tell\n".into())]);
        bench.press("<Esc>");
        assert_eq!(bench.app.screens.sql.table.as_ref().map(ResultTable::len), Some(30));
    }
}

#[test]
fn the_reason_of_a_refusal_goes_with_the_query() {
    let mut bench = Bench::example(80, 24);
    bench.press("7eselect wrong<F5>");
    ask(&mut bench);
    ctrl(&mut bench, 'u');
    assert!(bench.screen().contains("✗ no such column: wrong"), "it stays while a query is written");
    bench.press("<F5>");
    assert!(!bench.screen().contains("no such column"), "{}", bench.screen());
    assert!(bench.screen().contains("no query is typed yet"), "{}", bench.screen());
}

#[test]
fn queries_are_refused_cancelled_recalled_and_saved_ones_offered() {
    let mut bench = Bench::example(80, 24);
    bench.press("7eselect wrong<F5>");
    ask(&mut bench);
    assert!(bench.screen().contains("✗ no such column: wrong"), "{}", bench.screen());
    bench.press("<Esc>e; select 2<F5>");
    bench.asked();
    ctrl(&mut bench, 'c');
    assert_eq!(bench.asked(), [Effect::StopQuery], "a query is cancelled before anything is left");
    bench.send(Message::Answered(9, Err("cancelled".into())));
    ctrl(&mut bench, 'p');
    ctrl(&mut bench, 'p');
    assert_eq!(bench.app.screens.sql.editor.text(), "select wrong");
    ctrl(&mut bench, 'n');
    assert_eq!(bench.app.screens.sql.editor.text(), "select wrong; select 2");
    bench.press("<Esc>o");
    assert!(bench.screen().contains("saved queries") && bench.screen().contains("attention"));
    bench.press("times<Enter>");
    assert!(bench.app.screens.sql.editor.text().contains("median_s"), "{}", bench.app.screens.sql.editor.text());
    bench.press("<F5>");
    ask(&mut bench);
    bench.press("<Esc>w");
    ctrl(&mut bench, 'u');
    bench.press("rows.json<Enter>");
    let query = bench.app.screens.sql.answered.clone();
    assert_eq!(bench.asked(), [Effect::Query(QueryRequest::Export(query, "rows.json".into()))]);
    bench.send(Message::Saved(Ok("30 rows are in rows.json".into())));
    assert!(bench.app.state.overlay.is_none() && bench.status().contains("30 rows"));
}

#[test]
fn an_empty_editor_lets_commands_through() {
    let mut bench = Bench::example(80, 24);
    bench.press("7");
    assert_eq!(bench.press("4").app.state.nav.screen, Screen::Jobs, "keys are commands until e");
    assert!(bench.press("7e?").screen().contains("keys:"));
    assert_eq!(bench.press("<Esc>4").app.state.nav.screen, Screen::Jobs);
    assert_eq!(bench.press("7ex4").app.state.nav.screen, Screen::Sql, "now it is text");
    assert_eq!(bench.press("<Esc>:run<Enter>").asked().last(), Some(&Effect::Query(QueryRequest::Rows("x4".into()))));
}

#[test]
fn fem_and_hybrid_are_compared_unless_runs_are_selected() {
    for (width, height) in [(80, 24), (160, 50)] {
        let mut bench = Bench::example(width, height);
        bench.press("c");
        assert_eq!(bench.app.state.focus.compare, [JobId(1), JobId(2)]);
        assert_snapshot!(format!("compare_{width}x{height}"), bench.screen());
    }
    let mut bench = Bench::example(80, 24);
    bench.press(" l ");
    assert_eq!(bench.status(), "2 runs are selected; c compares, x cancels, r retries, u takes all back");
    bench.press("cd");
    assert_eq!(bench.app.state.focus.compare, [JobId(1), JobId(3)]);
    assert!(bench.screen().contains("no measurement differs"), "the fixture's results by FEM are all the same");
    assert!(bench.screen().contains("FEM") || bench.screen().contains(" ii "), "{}", bench.screen());
    bench.press("du<Esc>c");
    let copied = bench.press("y").asked();
    assert!(
        matches!(&copied[..], [Effect::Copy(text)] if text.starts_with("no\tmeasurement\tl2d_mm\tFEM\tHYB\n1\tHem")),
        "{copied:?}"
    );
}

#[test]
fn compared_drapes_stand_side_by_side_where_there_is_room() {
    let mut bench = Bench::example(160, 50);
    bench.press("c");
    assert_eq!(bench.app.state.pictures.requests.len(), 2);
    let before = bench.app.state.pictures.requests.clone();
    bench.press("v");
    assert!(
        bench
            .app
            .state
            .pictures
            .requests
            .iter()
            .zip(&before)
            .all(|(now, then)| now.of == then.of && now.look != then.look)
    );
    let mut bench = Bench::example(80, 24);
    bench.press("c");
    assert!(bench.app.state.pictures.requests.is_empty());
    bench.press("z");
    assert_eq!(bench.app.state.pictures.requests.len(), 2);
}

#[test]
fn reports_are_listed_built_and_opened() {
    let mut bench = Bench::example(80, 24);
    bench.press("8");
    assert_eq!(bench.asked(), [Effect::Files(FileTask::ListReports)]);
    assert_eq!(bench.press("b").asked(), [Effect::Files(FileTask::BuildReport("men-tops".into()))]);
    assert_eq!(bench.press("b").asked(), [], "one at a time");
    bench.send(Message::ReportPart("pictures, 3 of 12".into()));
    assert!(bench.screen().contains("building that of men-tops: pictures, 3 of 12"), "{}", bench.screen());
    let row = |name: &str, written_ms| ReportRow {
        name: name.into(),
        page: format!("/srv/reports/{name}/index.html").into(),
        bytes: 1_234_567,
        written_ms,
        files: 42,
    };
    let rows = vec![row("dresses", 0), row("men-tops", 1_700_000_000_000)];
    bench.send(Message::ReportBuilt(Ok("/srv/reports/men-tops/index.html".into()), rows));
    assert_eq!(bench.app.screens.reports.selected(&bench.app.state).map(|row| row.name.as_str()), Some("men-tops"));
    assert_snapshot!("reports_80x24", bench.screen());
    bench.app.state.setup.login = "mia@mill".into();
    assert_eq!(bench.press("y").asked(), [Effect::Copy("scp -r mia@mill:/srv/reports/men-tops .".into())]);
    let App { state, screens } = &bench.press("gs").app;
    assert_eq!(screens.reports.selected(state).map(|row| row.name.as_str()), Some("men-tops"), "the latest first");
}

#[test]
fn a_new_study_is_chosen_from_the_catalogue() {
    for (width, height) in [(80, 24), (160, 50)] {
        let mut bench = Bench::new(
            width,
            height,
            crate::messages::snapshot::Snapshot {
                subjects: fixture::snapshot().subjects,
                fabrics: fixture::snapshot().fabrics,
                ..fixture::empty()
            },
        );
        assert!(bench.press("a<F5>").asked().is_empty());
        assert!(bench.screen().contains("✗ choose a size of a style"), "{}", bench.screen());
        bench.press("lj <Tab>a");
        assert_snapshot!(format!("new_study_{width}x{height}"), bench.screen());
        let asked = bench.press("<F5>").asked();
        let [Effect::Files(FileTask::CreateStudy(new))] = &asked[..] else { panic!("{asked:?}") };
        assert_eq!(
            (new.name.as_str(), new.subjects.len(), new.sizes.len(), new.simulators.len()),
            ("study-1", 3, 1, 2)
        );
        assert_eq!(new.fabric, "cotton_shirting_light");
        bench.send(Message::StudyCreated("study-1".into(), Err("the folder is there".into())));
        assert!(bench.screen().contains("✗ the folder is there"));
        bench.app.update(Message::StudyCreated("study-1".into(), Ok("studies/study-1/study.toml".into())));
        assert!(bench.app.state.overlay.is_none() && bench.app.state.focus.study.as_deref() == Some("study-1"));
    }
}

#[test]
fn runs_that_do_not_fit_are_told_and_gone_to() {
    let mut bench = Bench::example(80, 24);
    bench.press("4*c");
    assert_eq!(bench.app.state.focus.compare.len(), 6);
    assert!(bench.screen().contains(", 1 to 4 shown, h l others"), "{}", bench.screen());
    assert!(bench.press("lll").screen().contains(", 3 to 6 shown"), "{}", bench.screen());
    assert!(bench.press("h").screen().contains(", 2 to 5 shown"), "{}", bench.screen());
    let mut bench = Bench::example(160, 50);
    assert!(!bench.press("c").screen().contains("shown, h l"), "all fit");
}

#[test]
fn several_queries_are_kept_beside_each_other() {
    let mut bench = Bench::example(80, 24);
    bench.press("7eselect 1<Esc>aselect 2<Esc>");
    let text = |bench: &Bench| bench.app.screens.sql.editor.text().to_owned();
    assert_eq!(text(&bench), "select 2");
    assert!(bench.screen().contains("query 2 of 2"), "{}", bench.screen());
    assert_eq!(text(bench.press("]")), "select 1");
    assert_eq!(text(bench.press("[")), "select 2");
    let memory = Session::of(&bench.app);
    let mut again = Bench::example(80, 24);
    memory.restore(&mut again.app);
    assert_eq!((text(&again), text(again.press("["))), ("select 2".into(), "select 1".into()));
    assert!(Bench::example(80, 24).press("7]").status().contains("a begins another"));
    assert_eq!(bench.press("aa").app.screens.sql.queries().texts.len(), 3, "a letter, since the query is typed");
}

#[test]
fn the_catalogue_stands_beside_the_query() {
    let check = |width: u16, keys: &str, seen: &[&str], unseen: &str| {
        let mut bench = Bench::example(width, 30);
        bench.press("7");
        ask(&mut bench);
        bench.press(keys);
        let screen = bench.screen();
        assert!(seen.iter().all(|text| screen.contains(text)) && !screen.contains(unseen), "{keys}: {screen}");
    };
    check(80, "eselect ", &["v_pair     study, garment, ei"], " columns ");
    check(80, "eselect * from V_PAIR p", &[" columns ", "garment"], " views ");
    check(80, "eselect * from v_pair<Esc>", &["v_pair"], " columns ");
    check(160, "eselect * from v_pair<Esc>", &[" columns ", "garment"], " views ");
}

#[test]
fn a_run_here_is_watched_and_one_elsewhere_is_not() {
    let mut bench = Bench::example(80, 24);
    bench.press("4jjjjjj5");
    assert!(bench.screen().contains("another process"), "{}", bench.screen());
    bench.press("R");
    assert!(bench.asked().contains(&Effect::Watch(Some(JobId(7)))));
    let vertex = |k: usize| geom::V3::new(0.2 * (k as f64).cos(), 0.1, 1.0 + 0.3 * (k as f64 * 0.37).sin());
    let positions: Vec<_> = (0..400).map(vertex).collect();
    bench.send(Message::Live(LiveFrame { job: JobId(7), positions }));
    let screen = bench.screen();
    assert!(screen.contains("residual 5.5e-2") && screen.chars().any(|c| ('⠁'..='⣿').contains(&c)), "{screen}");
    bench.press("7");
    assert!(bench.asked().contains(&Effect::Watch(None)), "nobody looks");
}

#[test]
fn what_was_looked_at_is_remembered() {
    let mut bench = Bench::example(80, 24);
    bench.press("7eselect 1<Esc>4/hyb<Enter>sjj ");
    let memory = Session::of(&bench.app);
    let abilities = bench.app.state.setup.abilities;
    let mut app = App::new(bench.app.state.theme, abilities, bench.app.state.terminal.size);
    let focus = bench.app.state.focus.clone();
    memory.clone().restore(&mut app);
    assert_eq!(
        (app.state.nav.screen, &app.state.focus.job, &app.state.nav.filters),
        (Screen::Jobs, &focus.job, &bench.app.state.nav.filters)
    );
    assert_eq!(
        (app.screens.jobs.order, app.state.marks.len(), app.screens.sql.editor.text()),
        (bench.app.screens.jobs.order, 1, "select 1")
    );
    app.update(Message::Data(Box::new(fixture::snapshot())));
    assert_eq!(Session::of(&app), memory, "and still is once the database was read");
}

#[test]
fn ascii_has_a_stand_in_for_every_sign() {
    for keys in ["", "2", "3", "4jjjj", "5", "c", "7", "8", "?", "5<Tab>", "4x"] {
        let mut bench = Bench::example(160, 50);
        bench.press("<F2>").press(keys);
        let screen = bench.screen();
        let inside: String = screen.lines().map(|line| line.trim_matches('"')).collect();
        assert!(inside.is_ascii(), "{keys}: {:?}", inside.chars().filter(|c| !c.is_ascii()).collect::<Vec<_>>());
        let unknown = inside.matches('?').count();
        assert!(unknown <= 3, "{keys}: {screen}");
    }
}

#[test]
fn the_brake_stops_a_query_that_would_never_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("toile.sqlite");
    catalogue::open(&path, false).expect("a new database");
    let (questions, wanted) = mpsc::channel();
    let (sender, answers) = mpsc::channel();
    let canceller = Canceller::default();
    std::thread::scope(|scope| {
        let (path, own_canceller) = (path.clone(), canceller.clone());
        scope.spawn(move || queries::serve(&path, &own_canceller, &[], &wanted, &sender));
        let endless = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT count(*) FROM n";
        let ask = |sql: &str| questions.send(QueryRequest::Rows(sql.into())).expect("it listens");
        ask(endless);
        let told = loop {
            canceller.cancel();
            if let Ok(message) = answers.recv_timeout(Duration::from_millis(10)) {
                break message;
            }
        };
        assert!(matches!(&told, Message::Answered(_, Err(error)) if error == "cancelled"), "{told:?}");
        canceller.reset();
        ask("SELECT 7");
        let told = answers.recv().expect("it goes on");
        assert!(matches!(&told, Message::Answered(_, Ok(table)) if table.total() == 1), "{told:?}");
        drop(questions);
    });
}

#[test]
fn escape_closes_the_form_of_a_study() {
    let mut bench = Bench::example(80, 24);
    bench.press("a");
    assert!(matches!(bench.app.state.overlay, Some(Overlay::StudyForm(_))));
    assert!(bench.press("<Esc>").app.state.overlay.is_none());
}

fn form(keys: &str) -> Option<StudyForm> {
    match Bench::example(80, 24).press("a").press(keys).app.state.overlay.take() {
        Some(Overlay::StudyForm(form)) => Some(*form),
        _ => None,
    }
}

#[test]
fn lists_of_forms_are_gone_through_and_narrowed_as_on_screens() {
    let chosen = |form: &StudyForm| -> Vec<String> {
        form.subjects.iter().filter(|(_, is_chosen)| *is_chosen).map(|(name, _)| name.clone()).collect()
    };
    let check = |keys: &str, expect: &[&str]| {
        assert_eq!(chosen(&form(keys).unwrap_or_else(|| panic!("{keys}"))), expect, "{keys}");
    };
    check("<Enter><Enter> ", &["anna"]);
    check("<Enter><Enter>j ", &["male-i"]);
    check("<Enter><Enter>jjk ", &["male-i"]);
    check("<Enter><Enter>/MALE-II<Enter> ", &["male-ii"]);
    check("<Enter><Enter>/male<Enter>a", &["male-i", "male-ii"]);
    check("<Enter><Enter>/male<Enter>a<Esc>k ", &["anna", "male-i", "male-ii"]);
    check("<Enter><Enter>/xyz<Esc> ", &["anna"]);
    check("jk", &[]);
    assert_eq!(form("jk").expect("open").name.chars().rev().take(2).collect::<String>(), "kj", "the name is typed");
}

#[test]
fn escape_leaves_the_part_before_the_form_and_enter_makes_it_at_the_last() {
    let check = |keys: &str, expect: bool| assert_eq!(form(keys).is_some(), expect, "{keys}");
    check("<Enter><Esc>", true);
    check("<Enter><Esc><Esc>", false);
    check("<Enter>/t<Esc><Esc>", true);
    check("<Enter>/t<Enter><Esc><Esc><Esc>", false);
    check("<Enter><C-c>", false);
    let made = |keys: &str| form(keys).expect("open").sending.is_busy;
    assert!(!made("<Enter> <Enter> <Enter><Enter>"), "at the last part, not made yet");
    assert!(made("<Enter> <Enter> <Enter><Enter><Enter>"));
    assert!(made("<Enter> <Enter> <F5>"));
    assert!(form("<F5>").expect("open").sending.problem.is_some_and(|problem| problem.contains("choose a size")));
}

#[test]
fn the_sizes_of_a_style_are_one_line_until_it_is_opened() {
    let check = |keys: &str, expect: &[&str]| {
        let form = form(keys).unwrap_or_else(|| panic!("{keys}"));
        let chosen = form.sizes.iter().filter(|(_, is_chosen)| *is_chosen);
        let chosen: Vec<String> = chosen.map(|(size, _)| format!("{} {}", size.style, size.size)).collect();
        assert_eq!(chosen, expect, "{keys}");
    };
    check("<Enter> ", &["tshirt S", "tshirt M"]);
    check("<Enter>  ", &[]);
    check("<Enter>lj ", &["tshirt S"]);
    check("<Enter>lj h ", &["tshirt S", "tshirt M"]);
    check("<Enter>j ", &["trousers S", "trousers M", "trousers L"]);
    check("<Enter>/trou<Enter> ", &["trousers S", "trousers M", "trousers L"]);
    check("<Enter>/trousers l<Enter>j ", &["trousers L"]);
    check("<Enter>/trousers l<Enter> ", &["trousers L"]);
}

#[test]
fn every_part_of_the_form_can_be_filtered_and_what_does_not_fit_is_told() {
    let simulators = form("<Enter><Enter><Enter>/hyb<Enter> ").expect("open").simulators;
    assert_eq!(simulators.iter().map(|(_, is_chosen)| *is_chosen).collect::<Vec<_>>(), [true, false]);
    let fabric = |keys: &str| {
        let form = form(keys).expect("open");
        form.fabrics[form.fabric].clone()
    };
    assert_eq!(fabric("<Enter><Enter><Enter><Enter>/jers<Enter>"), "jersey");
    assert_eq!(fabric("<Enter><Enter><Enter><Enter>/jers<Enter>ll"), "jersey", "the only one");
    let seen = |keys: &str| Bench::example(80, 14).press(keys).screen();
    assert!(seen("a").contains("more below") && !seen("a").contains("more above"), "{}", seen("a"));
    assert!(seen("a<Tab><Tab>G").contains("more above"), "{}", seen("a<Tab><Tab>G"));
}
