//! The queue and its workers from outside: runs with a small executor, crashes, take-overs, cancelling, explanations.

mod sits;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use crate::{actions, enqueue, run, *};
use body::{Dimension, Measurements, Sex};
use fit::measure::{Chi, metrics};
use fit::{Cuts, Ease, FitClass, Simulator};
use pattern::MeasurementKind;
use sim::hybrid::Closure;
use sim::{Fabric, Monitor, Progress, Stage, Step};
use spec::file::{GarmentEntry, SizeFile, Subject};
use spec::{JobSpec, Parameters, Schedule, Selection, Study};
use store::files::SourceFile;
use store::queue::{self, Event};
use store::{Access, JobFilter, JobId, Origin, Result, Status, Store, StudyError, Value, read, sql};
use wardrobe::catalogue;

struct Bench {
    _folder: tempfile::TempDir,
    path: PathBuf,
    store: Store,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("toile.sqlite");
        let store = catalogue::open(&path, false).expect("a new database");
        Self { _folder: folder, path, store }
    }

    fn run(&mut self, study: &Study, workers: usize, executor: impl Executor + Send + 'static) -> Vec<Planned> {
        let options = RunOptions { workers: Some(workers), ..RunOptions::default() };
        let run = run::start_with(&mut self.store, study, &options, Arc::new(executor)).expect("queued");
        let planned = run.planned.to_vec();
        run.join().expect("the database works");
        planned
    }

    fn statuses(&self) -> BTreeMap<i64, Status> {
        let filter = JobFilter { superseded: true, ..JobFilter::default() };
        read::jobs(&self.store, &filter).expect("readable").into_iter().map(|job| (job.id.0, job.status)).collect()
    }
}

fn source(name: &str, text: &str) -> SourceFile {
    SourceFile { name: name.to_owned(), bytes: text.as_bytes().into() }
}

/// Two sizes on two subjects.
fn study(density_kg_m2: f64) -> Study {
    let subject = |id: &str, stature_m: f64| Subject {
        id: id.to_owned(),
        person: Measurements::of(Sex::Male, stature_m).with(Dimension::ChestGirth, 0.9).into(),
        carried_from: None,
    };
    let size = |name: &str| SizeFile { name: name.to_owned(), pattern: source(&format!("tee-{name}.dxf"), name) };
    let fabric = Fabric {
        name: "voile".into(),
        density_kg_m2,
        thickness_m: 2e-4,
        membrane_warp_n_m: 3000.0,
        membrane_weft_n_m: 2000.0,
        membrane_coupling_n_m: 0.0,
        shear_n_m: 90.0,
        bending_warp_nm: 5e-6,
        bending_weft_nm: 4e-6,
        friction_body: 0.3,
        friction_self: 0.5,
        source: "test".into(),
        stretched: None,
    };
    Study {
        name: "tops".into(),
        path: PathBuf::from("study.toml"),
        subjects: vec![subject("ii", 1.69), subject("v", 1.82)],
        garments: vec![GarmentEntry {
            name: "tee".into(),
            subjects: vec!["ii".into(), "v".into()],
            seams: Some(source("tee.seams.toml", "seams")),
            unit: None,
            fabric,
            sizes: vec![size("s"), size("m")],
            style: "tee".into(),
            edge_length_m: 0.015,
            parameters: Parameters::default(),
            target: fit::target::Target::default(),
            swept: vec![],
            schedule: Schedule::default(),
            outfit: None,
        }],
        layers: vec![],
        simulators: vec![Simulator::Fem],
        repeats: 1,
        cuts: Cuts::default(),
    }
}

/// A result that depends on the inputs alone.
fn outcome(spec: &JobSpec) -> Outcome {
    let stretch = 1.0 + spec.person.measurements.stature_m() / 100.0;
    let chis = vec![Chi { no: 1, l2d_m: 1.0, l3d_m: stretch }, Chi { no: 2, l2d_m: 0.5, l3d_m: 0.5 }];
    let measured = |chi: &Chi| Measured {
        stage: Stage::Drape,
        name: format!("length {}", chi.no),
        kind: MeasurementKind::OpenLength,
        is_free_edge: false,
        is_controlled: false,
        chi: chi.clone(),
    };
    let step = Step { iteration: 1, level: 0, residual: 0.5, seam_gap_m: 0.001, e_chi: 1.01 };
    let ease = Ease {
        level: "chest".into(),
        pattern_girth_m: 0.94,
        body_girth_m: 0.9,
        class: FitClass::Tight,
        borderline: true,
        is_held: true,
    };
    Outcome {
        converged: spec.size != "m",
        measured: chis.iter().map(measured).collect(),
        metrics: metrics(&chis).expect("two"),
        vertices: 10,
        faces: 12,
        iterations: 1,
        residual: 0.01,
        penetration_max_m: 0.0,
        self_crossings: 0,
        seam_gap_max_m: 0.0,
        history: vec![step],
        eases: vec![ease],
        too_small: Vec::new(),
        points: Vec::new(),
        worn: Assessment::default(),
        closures: (spec.size == "m").then(gap).into_iter().collect(),
        distortion: None,
        warnings: vec![],
        used: vec![],
    }
}

/// A garment that lacks 12 mm at the chest.
fn gap() -> Closure {
    Closure { level: "chest".into(), height_m: 1.2, body_girth_m: 0.952, garment_girth_m: 0.94 }
}

fn quick(spec: &JobSpec, _monitor: &mut dyn Monitor) -> Result<Outcome> {
    Ok(outcome(spec))
}

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let end = Instant::now() + Duration::from_secs(20);
    while !holds() {
        assert!(Instant::now() < end, "waited too long until {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// An executor that reports progress until told to stop, or until `open` lets it finish.
fn patient(open: Arc<AtomicBool>) -> impl Executor + Send {
    move |spec: &JobSpec, monitor: &mut dyn Monitor| {
        let step = Step { iteration: 7, level: 0, residual: 0.3, seam_gap_m: 0.002, e_chi: 1.02 };
        while !open.load(Ordering::Relaxed) {
            monitor.progress(&Progress { phase: "sew", fraction: 0.25, step });
            if monitor.cancelled() {
                return Err(StudyError::Interrupted);
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        Ok(outcome(spec))
    }
}

#[test]
fn a_study_of_the_same_name_in_another_folder_is_refused_until_it_is_said_to_have_moved() {
    let mut bench = Bench::new();
    let folders = [tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder")];
    let study_in = |k: usize| {
        let path = folders[k].path().join("study.toml");
        std::fs::write(&path, "").expect("writable");
        Study { path, ..study(0.1) }
    };
    let all = Selection::default();
    enqueue::queue(&mut bench.store, &study_in(0), &all).expect("the first of its name");
    enqueue::queue(&mut bench.store, &study_in(0), &all).expect("the same again");
    let told = enqueue::queue(&mut bench.store, &study_in(1), &all).expect_err("another folder").to_string();
    assert!(told.contains("study `tops`") && told.contains("--moved"), "{told}");
    enqueue::move_home(&mut bench.store, &study_in(1)).expect("writable");
    enqueue::queue(&mut bench.store, &study_in(1), &all).expect("it has moved");
    // A folder that is gone counts as moved.
    std::fs::remove_file(folders[1].path().join("study.toml")).expect("writable");
    enqueue::queue(&mut bench.store, &study_in(0), &all).expect("nothing is there any more");
}

#[test]
fn a_run_finishes_every_job_once_whatever_the_number_of_workers() {
    let results = [1, 3].map(|workers| {
        let mut bench = Bench::new();
        let runs = Arc::new(Mutex::new(Vec::new()));
        let counted = runs.clone();
        let planned = bench.run(&study(0.1), workers, move |spec: &JobSpec, _: &mut dyn Monitor| {
            counted.lock().expect("no panic").push((spec.size.clone(), spec.subject.clone()));
            Ok(outcome(spec))
        });
        assert_eq!(planned.len(), 4);
        let mut runs = runs.lock().expect("no panic").clone();
        runs.sort();
        runs.dedup();
        assert_eq!(runs.len(), 4, "each once");
        let grid = read::grid(&bench.store, "tops", "tee").expect("there");
        assert_eq!(
            (grid.sizes.as_slice(), grid.subjects.as_slice()),
            (&["s".into(), "m".into()][..], &["ii".into(), "v".into()][..])
        );
        assert_eq!(grid.cells[1][0][0].status, Some(Status::NotConverged));
        assert_eq!(grid.fits[0][0].map(|fit| (fit.class, fit.borderline)), Some((FitClass::Tight, true)));
        let chi: Vec<_> = planned.iter().map(|job| read::chi(&bench.store, job.id).expect("readable")).collect();
        assert_eq!(read::history(&bench.store, planned[0].id).expect("readable").len(), 1);
        chi
    });
    assert_eq!(results[0], results[1]);
}

#[test]
fn a_second_run_has_nothing_to_do_and_a_change_is_named() {
    let mut bench = Bench::new();
    bench.run(&study(0.1), 2, quick);
    let again = bench.run(&study(0.1), 2, |_: &JobSpec, _: &mut dyn Monitor| panic!("nothing may run"));
    assert!(again.iter().all(|job| !job.why.will_run()));
    assert_eq!(again[2].why.to_string(), "up to date (not converged)");

    let heavier = bench.run(&study(0.2), 2, quick);
    assert_eq!(heavier[0].why.to_string(), "changed since job 1: fabric.voile.density_kg_m2: 0.1 -> 0.2");
    assert_eq!(enqueue::why(&bench.store, heavier[0].id).expect("there"), heavier[0].why);
    assert_eq!(enqueue::why(&bench.store, again[0].id).expect("there"), Why::New);
    let count = |sql| match sql::query(&bench.store, sql).expect("valid").rows[0][0] {
        Value::Integer(n) => n,
        ref other => panic!("a count, not {other}"),
    };
    assert_eq!(count("SELECT count(*) FROM v_metrics"), 4, "current results only");
    assert_eq!(count("SELECT count(*) FROM metrics"), 8, "old results are kept");
    assert_eq!(count("SELECT count(*) FROM v_fabrics WHERE fabric = 'voile'"), 2);

    let back = bench.run(&study(0.1), 2, |_: &JobSpec, _: &mut dyn Monitor| panic!("nothing may run"));
    assert_eq!(back[0].id, again[0].id, "the old result is current again");
}

#[test]
fn what_a_study_no_longer_has_leaves_its_tables_but_not_the_database() {
    let mut bench = Bench::new();
    bench.run(&study(0.1), 2, quick);
    let mut smaller = study(0.1);
    smaller.subjects.pop();
    bench.run(&smaller, 2, quick);
    assert_eq!(sql::query(&bench.store, "SELECT * FROM v_metrics").expect("valid").rows.len(), 2);
    assert_eq!(sql::query(&bench.store, "SELECT * FROM v_ease").expect("valid").rows.len(), 2);
    assert_eq!(sql::query(&bench.store, "SELECT * FROM metrics").expect("valid").rows.len(), 4);
    bench.run(&study(0.1), 2, |_: &JobSpec, _: &mut dyn Monitor| panic!("nothing may run"));
    assert_eq!(sql::query(&bench.store, "SELECT * FROM v_metrics").expect("valid").rows.len(), 4);
}

#[test]
fn planning_writes_nothing() {
    let mut bench = Bench::new();
    let planned = run::plan(&mut bench.store, &study(0.1), &Selection::default()).expect("valid");
    assert!(planned.iter().all(|job| job.why == Why::New));
    assert!(bench.statuses().is_empty());
    let wrong = Selection { sizes: vec!["xl".into()], ..Selection::default() };
    let error = run::plan(&mut bench.store, &study(0.1), &wrong).expect_err("no such size").to_string();
    assert_eq!(error, "no size `xl`; there are: s, m");
}

#[test]
fn a_failing_job_and_a_panic_are_told_and_can_be_retried() {
    let mut bench = Bench::new();
    let planned =
        bench.run(&study(0.1), 2, |spec: &JobSpec, _: &mut dyn Monitor| match (&*spec.size, &*spec.subject) {
            ("s", "ii") => Err(StudyError::refused(Origin::Sim, "diverged")),
            ("s", "v") => panic!("index out of range"),
            _ => Ok(outcome(spec)),
        });
    let error = |bench: &Bench, job: &Planned| read::job(&bench.store, job.id).expect("there").error;
    assert_eq!(error(&bench, &planned[0]).as_deref(), Some("sim: diverged"));
    assert_eq!(error(&bench, &planned[1]).as_deref(), Some("panic: index out of range"));
    let ids: Vec<JobId> = planned.iter().map(|job| job.id).collect();
    assert_eq!(actions::retry(&mut bench.store, &ids).expect("writable"), 2, "results are kept");
    bench.run(&study(0.1), 2, quick);
    assert_eq!(error(&bench, &planned[0]), None);
    assert!(bench.statuses().values().all(|status| status.has_result()));
}

#[test]
fn a_result_that_is_no_number_fails_its_job_and_leaves_nothing_behind() {
    let mut bench = Bench::new();
    bench.run(&study(0.1), 2, |spec: &JobSpec, _: &mut dyn Monitor| {
        let mut result = outcome(spec);
        if spec.size == "s" {
            result.residual = f64::NAN;
        }
        Ok(result)
    });
    let job = read::job(&bench.store, JobId(1)).expect("there");
    assert_eq!(job.status, Status::Failed);
    assert!(job.error.is_some_and(|error| error.contains("metrics.residual")));
    assert!(read::chi(&bench.store, JobId(1)).expect("readable").is_empty());
    assert!(read::job(&bench.store, JobId(3)).expect("there").status.has_result());
}

#[test]
fn jobs_of_a_dead_process_are_taken_over_at_once_and_nothing_runs_twice() {
    let mut bench = Bench::new();
    let options = RunOptions { workers: Some(1), ..RunOptions::default() };
    let idle = run::start_with(&mut bench.store, &study(0.1), &options, Arc::new(quick)).expect("queued");
    idle.join().expect("works");
    let mut connection = store::open(&bench.path, Access::Write).expect("there");
    connection
        .execute_batch(
            "UPDATE job SET status = 'queued', is_current = 1; DELETE FROM chi; DELETE FROM metrics;
        DELETE FROM history; DELETE FROM provenance; DELETE FROM job_artefact",
        )
        .expect("valid");
    // The owner is a dead process of this machine: same boot, a number that no process has.
    let dead = store::owner::Owner::new().as_str().replace(&format!("/{}/", std::process::id()), "/4194305/");
    let transaction = store::write(&mut connection).expect("idle");
    queue::apply(&transaction, JobId(1), &Event::Claim(&dead), None).expect("queued").expect("queued");
    transaction.commit().expect("idle");

    let runs = Arc::new(AtomicUsize::new(0));
    let counted = runs.clone();
    bench.run(&study(0.1), 2, move |spec: &JobSpec, _: &mut dyn Monitor| {
        counted.fetch_add(1, Ordering::Relaxed);
        Ok(outcome(spec))
    });
    assert_eq!(runs.load(Ordering::Relaxed), 4);
    let job = read::job(&bench.store, JobId(1)).expect("there");
    assert_eq!((job.status, job.attempts), (Status::Done, 3));
    let log = read::log(&bench.store, JobId(1)).expect("readable");
    assert!(log.iter().any(|line| line.level == "warn" && line.text.ends_with("queued again")), "{log:?}");

    let transaction = store::write(&mut connection).expect("idle");
    let late = Event::Finish { owner: &dead, converged: true };
    assert_eq!(queue::apply(&transaction, JobId(1), &late, None).expect("there"), None, "too late");
}

#[test]
fn progress_is_seen_by_others_and_cancelling_reaches_a_running_job() {
    let mut bench = Bench::new();
    let open = Arc::new(AtomicBool::new(false));
    let options = RunOptions { workers: Some(1), ..RunOptions::default() };
    let run =
        run::start_with(&mut bench.store, &study(0.1), &options, Arc::new(patient(open.clone()))).expect("queued");
    let id = run.planned[0].id;
    let mut other = catalogue::open(&bench.path, false).expect("shared");
    let version = other.version().expect("readable");
    until("progress shows", || read::job(&other, id).expect("there").progress.is_some_and(|p| p.fraction == 0.25));
    assert_ne!(other.version().expect("readable"), version);
    assert_eq!(actions::cancel(&mut other, &[id]).expect("writable"), 1);
    until("the next job runs", || read::job(&other, run.planned[1].id).expect("there").status == Status::Running);
    open.store(true, Ordering::Relaxed);
    run.join().expect("works");
    let statuses: Vec<Status> = bench.statuses().into_values().collect();
    assert_eq!(statuses, [Status::Cancelled, Status::Done, Status::NotConverged, Status::NotConverged]);
}

#[test]
fn stopping_puts_running_jobs_back_and_a_pause_holds_new_ones() {
    let mut bench = Bench::new();
    let options = RunOptions { workers: Some(2), ..RunOptions::default() };
    let closed = Arc::new(AtomicBool::new(false));
    let run = run::start_with(&mut bench.store, &study(0.1), &options, Arc::new(patient(closed))).expect("queued");
    until("both work", || bench.statuses().values().filter(|&&s| s == Status::Running).count() == 2);
    run.stop();
    run.join().expect("works");
    assert!(bench.statuses().values().all(|&status| status == Status::Queued));

    actions::pause(&mut bench.store, "tops").expect("there");
    let run = run::start_with(&mut bench.store, &study(0.1), &options, Arc::new(quick)).expect("queued");
    std::thread::sleep(Duration::from_millis(300));
    assert!(!run.is_finished());
    assert!(bench.statuses().values().all(|&status| status == Status::Queued));
    actions::resume(&mut bench.store, "tops").expect("there");
    run.join().expect("works");
    assert!(bench.statuses().values().all(|status| status.has_result()));
}

/// The study with a second garment, which has priority but comes after the first.
fn chained() -> Study {
    let mut both = study(0.1);
    let mut over = both.garments[0].clone();
    over.name = "over".into();
    over.schedule = Schedule { priority: 5, after: vec!["tee".into()], ..Schedule::default() };
    both.garments.push(over);
    both
}

#[test]
fn a_garment_waits_for_another_whatever_its_priority() {
    let mut bench = Bench::new();
    let order = Arc::new(Mutex::new(Vec::new()));
    let noted = order.clone();
    bench.run(&chained(), 2, move |spec: &JobSpec, _: &mut dyn Monitor| {
        noted.lock().expect("no panic").push((spec.subject.clone(), spec.garment.clone()));
        Ok(outcome(spec))
    });
    let order = order.lock().expect("no panic").clone();
    for subject in ["ii", "v"] {
        let garments: Vec<&str> =
            order.iter().filter(|(who, _)| who == subject).map(|(_, what)| what.as_str()).collect();
        assert_eq!(garments, ["tee", "tee", "over", "over"], "{order:?}");
    }
    let waits =
        sql::query(&bench.store, "SELECT priority, waits_for, count(*) FROM v_jobs GROUP BY 1, 2").expect("valid");
    let number = Value::Integer;
    assert_eq!(waits.rows, [vec![number(0), number(0), number(4)], vec![number(5), number(0), number(4)]]);
}

#[test]
fn what_waits_for_a_failed_job_is_cancelled_and_retried_with_it() {
    let mut bench = Bench::new();
    let planned =
        bench.run(&chained(), 2, |spec: &JobSpec, _: &mut dyn Monitor| match (&*spec.garment, &*spec.subject) {
            ("tee", "v") => Err(StudyError::refused(Origin::Sim, "diverged")),
            _ => Ok(outcome(spec)),
        });
    let status = |bench: &Bench, garment: &str, subject: &str| -> Vec<Status> {
        let cells = planned.iter().filter(|job| {
            let study = chained();
            (&*job.cell.garment(&study).name, &*job.cell.subject(&study).id) == (garment, subject)
        });
        cells.map(|job| read::job(&bench.store, job.id).expect("there").status).collect()
    };
    assert!(status(&bench, "over", "ii").iter().all(|status| status.has_result()));
    assert_eq!(status(&bench, "tee", "v"), [Status::Failed; 2]);
    assert_eq!(status(&bench, "over", "v"), [Status::Cancelled; 2]);
    let over = planned.last().expect("eight").id;
    let error = read::job(&bench.store, over).expect("there").error.unwrap_or_default();
    assert!(error.starts_with("job ") && error.ends_with(", which it waits for, is failed"), "{error}");
    assert_eq!(actions::retry(&mut bench.store, &[over]).expect("writable"), 3, "with the two it needs");
    bench.run(&chained(), 2, quick);
    assert!(bench.statuses().values().all(|status| status.has_result()));
}

#[test]
fn what_waits_for_a_cancelled_job_is_cancelled_with_it() {
    let mut bench = Bench::new();
    let study = chained();
    let planned = enqueue::queue(&mut bench.store, &study, &Selection::default()).expect("queued");
    let of = |garment: &str, subject: &str| -> Vec<JobId> {
        let is_it =
            |job: &&Planned| (&*job.cell.garment(&study).name, &*job.cell.subject(&study).id) == (garment, subject);
        planned.iter().filter(is_it).map(|job| job.id).collect()
    };
    let awaited = of("tee", "v");
    assert_eq!(actions::cancel(&mut bench.store, &awaited).expect("writable"), 2);
    let check = |garment: &str, subject: &str, expect: (Status, &str)| {
        for id in of(garment, subject) {
            let job = read::job(&bench.store, id).expect("there");
            let error = job.error.unwrap_or_default();
            let why = error.split_once(", ").map_or("", |(_, why)| why);
            assert_eq!((job.status, why), expect, "{garment} on {subject}: {error}");
        }
    };
    check("tee", "v", (Status::Cancelled, ""));
    check("over", "v", (Status::Cancelled, "which it waits for, is cancelled"));
    check("tee", "ii", (Status::Queued, ""));
    check("over", "ii", (Status::Queued, ""));
}

#[test]
fn a_readonly_workspace_reads_and_refuses_to_write() {
    let mut bench = Bench::new();
    bench.run(&study(0.1), 1, quick);
    let mut reader = catalogue::open(&bench.path, true).expect("there");
    assert_eq!(read::studies(&reader).expect("readable")[0].count(Status::Done), 2);
    assert!(matches!(actions::cancel(&mut reader, &[JobId(1)]), Err(StudyError::Readonly)));
    assert!(sql::query(&reader, "DELETE FROM job").is_err());
    assert!(catalogue::open(Path::new("/nowhere/toile.sqlite"), true).is_err());
}

#[test]
fn saved_queries_run() {
    let mut bench = Bench::new();
    bench.run(&study(0.1), 1, quick);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../db/queries");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).expect("db/queries").flatten() {
        let sql = std::fs::read_to_string(entry.path()).expect("text");
        let answer = sql::query(&bench.store, &sql);
        assert!(answer.is_ok_and(|table| !table.columns.is_empty()), "{}", entry.path().display());
        seen += 1;
    }
    assert!(seen > 0);
}

#[test]
fn a_query_can_be_stopped() {
    let bench = Bench::new();
    let endless = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT sum(x) FROM n";
    let interrupter = sql::interrupter(&bench.store);
    let over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !over.load(Ordering::Relaxed) {
                interrupter.interrupt();
                std::thread::sleep(Duration::from_millis(2));
            }
        });
        assert!(sql::query(&bench.store, endless).is_err());
        over.store(true, Ordering::Relaxed);
    });
}

#[test]
fn every_contract_view_answers() {
    let mut bench = Bench::new();
    bench.run(&study(0.1), 1, quick);
    let check = |view: &str, rows: usize| {
        let table = sql::query(&bench.store, &format!("SELECT * FROM {view}")).expect("valid");
        assert_eq!(table.rows.len(), rows, "{view}");
    };
    check("v_jobs", 4);
    check("v_chi", 8);
    check("v_metrics", 4);
    check("v_ease", 4);
    check("v_gap", 2);
    let lacks = sql::query(&bench.store, "SELECT round(shortfall_mm, 6) FROM v_gap").expect("valid");
    assert!(lacks.rows.iter().all(|row| row[0] == Value::Real(12.0)), "{:?}", lacks.rows);
    check("v_pair", 0);
    check("v_recommendation", 1);
    check("v_published", 888);
    check("v_provenance", 4);
    check("v_subjects", 14);
    check("v_styles", 1);
    check("v_sizes", 2);
    let advice = read::recommendations(&bench.store, "tops").expect("readable");
    assert_eq!(advice[0].recommended, Simulator::Hybrid);
    assert_eq!((advice[0].basis.as_str(), advice[0].verdict.as_str()), ("rule", "insufficient_evidence"));
}
