//! A database of 10,000 jobs and 1,000,000 measurements, made through the real queue, and how long it takes to work with.
//!
//! `cargo run --release -p examples --bin scale [STUDIES [SUBJECTS]]` prints the table of docs/studies.md: queue operations, and a
//! typical question to each view. One study of 1680 subjects has as many jobs as 20 of 84. `... scale queue [JOBS]` queues one study
//! of as many jobs (10^6), works on a few of them, and prints what that takes.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use toile::engine::{Assessment, Measured, Outcome, RunOptions, actions, run};
use toile::fit::{Ease, FitClass, Simulator};
use toile::measure::{Chi, metrics};
use toile::pattern::MeasurementKind;
use toile::sim::{Monitor, Stage, Step};
use toile::spec::{JobSpec, Selection, Study, new_study, patterns};
use toile::store::{JobFilter, JobId, Result, Status, Store, StudyError, files, read, sql};
use toile::wardrobe::catalogue;

/// Measurements of a result.
const LENGTHS: u32 = 100;
/// Subjects of one study where nothing else is said; with three sizes and two simulators 504 jobs.
const SUBJECTS: usize = 84;

/// Questions that users ask of a study, and of all.
const QUESTIONS: [(&str, &str); 14] = [
    ("v_jobs: how far is a study", "SELECT status, count(*) FROM v_jobs WHERE study = 'study0' GROUP BY status"),
    ("v_jobs: what failed, anywhere", "SELECT * FROM v_jobs WHERE status IN ('failed', 'cancelled')"),
    ("v_jobs: the slowest of all", "SELECT study, size, subject, wall_ms FROM v_jobs ORDER BY wall_ms DESC LIMIT 20"),
    ("v_chi: one result", "SELECT * FROM v_chi WHERE study = 'study0' AND size = 'M' AND subject = 's3'"),
    (
        "v_chi: each measurement of a study",
        "SELECT measurement_no, count(*), avg(chi), stddev(chi) FROM v_chi WHERE study = 'study0' GROUP BY 1",
    ),
    (
        "v_chi: one measurement over all studies",
        "SELECT study, simulator, avg(chi) FROM v_chi WHERE measurement_no = 6 GROUP BY 1, 2",
    ),
    ("v_chi: the worst of a study", "SELECT * FROM v_chi WHERE study = 'study0' ORDER BY abs(chi - 1) DESC LIMIT 10"),
    (
        "v_metrics: EI of all studies",
        "SELECT study, simulator, median(ei), quantile(ei, 0.9) FROM v_metrics GROUP BY 1, 2",
    ),
    (
        "v_ease: fits of a study",
        "SELECT size, fit_class, count(*) FROM v_ease WHERE study = 'study0' AND decides GROUP BY 1, 2",
    ),
    ("v_pair: pairs of a study", "SELECT * FROM v_pair WHERE study = 'study0'"),
    ("v_recommendation: of a study", "SELECT * FROM v_recommendation WHERE study = 'study0'"),
    (
        "v_provenance: programs and machines",
        "SELECT program_version, machine, count(*) FROM v_provenance GROUP BY 1, 2",
    ),
    (
        "v_inputs: jobs of a cloth",
        "SELECT study, count(*) FROM v_inputs WHERE input = 'fabric.cotton_shirting_light.shear_n_m' GROUP BY 1",
    ),
    ("v_published: one table", "SELECT * FROM v_published WHERE garment = 'male_tshirt' AND size = 'm'"),
];

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    if std::env::args().nth(1).is_some_and(|word| word == "queue") {
        return queue(std::env::args().nth(2).map_or(Ok(1_000_000), |text| text.parse())?);
    }
    let given = |place: usize, usual: usize| std::env::args().nth(place).map_or(Ok(usual), |text| text.parse());
    let (studies, subjects) = (given(1, 20)?, given(2, SUBJECTS)?);
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("toile.sqlite");
    let mut store = catalogue::open(&path, false)?;
    write_study(folder.path(), subjects)?;
    let mut spent = 0.0;
    for number in 0..studies {
        let mut study = run::load_study(&store, folder.path())?;
        study.name = format!("study{number}");
        let options = RunOptions { workers: Some(2), ..RunOptions::default() };
        let start = Instant::now();
        run::start_with(&mut store, &study, &options, Arc::new(quick))?.join()?;
        spent += start.elapsed().as_secs_f64();
    }
    let count = |sql: &str| -> Result<String> { Ok(sql::query(&store, sql)?.rows[0][0].to_string()) };
    let (jobs, rows) = (count("SELECT count(*) FROM v_jobs")?, count("SELECT count(*) FROM v_chi")?);
    let made: f64 = jobs.parse()?;
    let megabytes = std::fs::metadata(&path)?.len() as f64 / 1e6;
    println!("{jobs} jobs, {rows} rows of v_chi, {megabytes:.0} MB");
    println!("{:8.2} ms  queue, claim and finish a job, on average", spent * 1e3 / made);

    let mut study = run::load_study(&store, folder.path())?;
    study.name = "study0".to_owned();
    let id = JobId(made as i64 / 2);
    let filter = JobFilter { study: Some(study.name.clone()), status: Some(Status::Done), ..JobFilter::default() };
    time("list the jobs of a study", || read::jobs(&store, &filter).map(drop))?;
    time("one job, its log and measurements", || {
        read::job(&store, id)?;
        read::log(&store, id)?;
        read::chi(&store, id).map(drop)
    })?;
    time("the counts of all studies", || read::studies(&store).map(drop))?;
    time("pause and resume a study", || {
        actions::pause(&mut store, &study.name)?;
        actions::resume(&mut store, &study.name)
    })?;
    time("cancel a job", || actions::cancel(&mut store, &[id]).map(drop))?;
    time("plan a study again", || run::plan(&mut store, &study, &Selection::default()).map(drop))?;
    for (question, sql) in QUESTIONS {
        let rows = sql::query(&store, sql)?.rows.len();
        time(&format!("{question}, {rows} rows"), || sql::query(&store, sql).map(drop))?;
    }
    Ok(())
}

/// Jobs of the great queue that are worked on.
const WORKED: usize = 200;

/// One study of so many jobs: queued, a few of them done, and asked about.
fn queue(jobs: usize) -> std::result::Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("toile.sqlite");
    let mut store = catalogue::open(&path, false)?;
    write_study(folder.path(), jobs / 6)?;
    let mut start = Instant::now();
    let mut lap = |what: &str| {
        println!("{:8.2} s   {what}", start.elapsed().as_secs_f64());
        start = Instant::now();
    };
    let study = run::load_study(&store, folder.path())?;
    lap("read the study file");
    let done = Arc::new(AtomicUsize::new(0));
    let counted = done.clone();
    let work = move |spec: &JobSpec, monitor: &mut dyn Monitor| {
        let outcome = quick(spec, monitor);
        counted.fetch_add(1, Ordering::Relaxed);
        outcome
    };
    let until = |count: usize| {
        while done.load(Ordering::Relaxed) < count {
            std::thread::sleep(Duration::from_millis(1));
        }
    };
    let options = RunOptions { workers: Some(1), ..RunOptions::default() };
    let run = run::start_with(&mut store, &study, &options, Arc::new(work))?;
    lap(&format!("queue {} jobs", run.planned.len()));
    until(1);
    lap("claim and do the first");
    let before = Instant::now();
    until(WORKED);
    let each = before.elapsed().as_secs_f64() * 1e3 / (WORKED - 1) as f64;
    run.stop();
    run.join()?;
    lap("do some more, stop, and judge");
    println!("{each:8.2} ms  claim and do one of the {WORKED} thereafter");
    time("the counts of all studies", || read::studies(&store).map(drop))?;
    let filter = JobFilter { study: Some(study.name.clone()), status: Some(Status::Done), ..JobFilter::default() };
    time(&format!("list the {WORKED} jobs that are done"), || read::jobs(&store, &filter).map(drop))?;
    time("one job, its log and measurements", || {
        read::log(&store, JobId(7))?;
        read::chi(&store, JobId(7)).map(drop)
    })?;
    time("cancel a job", || actions::cancel(&mut store, &[JobId(jobs as i64 / 2)]).map(drop))?;
    start_again(&mut store, &study)?;
    let megabytes = std::fs::metadata(&path)?.len() as f64 / 1e6;
    println!("{megabytes:8.0} MB  database, {:.0} MB most memory", peak_megabytes());
    Ok(())
}

/// Plans a study again, once.
fn start_again(store: &mut Store, study: &Study) -> Result<()> {
    let start = Instant::now();
    run::plan(store, study, &Selection::default())?;
    println!("{:8.2} s   plan the study again", start.elapsed().as_secs_f64());
    Ok(())
}

/// The most memory that this process had, where the system tells.
fn peak_megabytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()).and_then(|number| number.parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| kilobytes * 1024.0 / 1e6)
}

/// Prints the least of five times.
fn time(what: &str, mut act: impl FnMut() -> Result<()>) -> Result<()> {
    let mut least = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        act()?;
        least = least.min(start.elapsed().as_secs_f64());
    }
    println!("{:8.2} ms  {what}", least * 1e3);
    Ok(())
}

/// A study of the drafted T-shirt on many men.
fn write_study(folder: &Path, people: usize) -> Result<()> {
    let mut files = new_study(folder, patterns::Model::Tshirt, None)?;
    let text = String::from_utf8_lossy(&files[0].1).into_owned();
    let subjects = text.find("# Of the catalogue").unwrap_or_default();
    let garments = text.find("# A style of").unwrap_or(text.len());
    let mut many = text[..subjects].to_owned();
    for number in 0..people {
        let stature_mm = 1500.0 + 500.0 * number as f64 / people as f64;
        // Writing into a text does not fail.
        let _ = writeln!(many, "[[subject]]\nid = \"s{number}\"\nsex = \"male\"\nstature_mm = {stature_mm}");
    }
    many.push_str(&text[garments..]);
    files[0].1 = many.into_bytes();
    files::write_files(folder, &files).map(drop)
}

/// A result that costs nothing: lengths that spread a little with everything.
fn quick(spec: &JobSpec, _: &mut dyn Monitor) -> Result<Outcome> {
    let off = if spec.simulator == Simulator::Fem { 0.02 } else { 0.005 };
    let chi = |no: u32| {
        let spread = (spec.person.measurements.stature_m() * 1000.0 + f64::from(no) * 7.0).sin();
        Chi { no, l2d_m: 0.3, l3d_m: 0.3 * (1.0 + off * (1.0 + spread)) }
    };
    let chis: Vec<Chi> = (1..=LENGTHS).map(chi).collect();
    let found = metrics(&chis);
    let measured = chis.into_iter().map(|chi| Measured {
        stage: Stage::Drape,
        name: format!("length {}", chi.no),
        kind: MeasurementKind::OpenLength,
        is_free_edge: false,
        is_controlled: spec.simulator == Simulator::Hybrid,
        chi,
    });
    let history = (1..40).map(|iteration| Step {
        iteration,
        level: 0,
        residual: 1.0 / f64::from(iteration),
        seam_gap_m: 0.0,
        e_chi: 1.0,
    });
    let ease = Ease {
        level: "chest".into(),
        pattern_girth_m: 0.94,
        body_girth_m: spec.person.measurements.stature_m() * 0.52,
        class: FitClass::Just,
        borderline: false,
        is_held: true,
    };
    Ok(Outcome {
        converged: true,
        measured: measured.collect(),
        metrics: found.ok_or(StudyError::Interrupted)?,
        vertices: 5000,
        faces: 9000,
        iterations: 40,
        residual: 0.01,
        penetration_max_m: 0.0,
        seam_gap_max_m: 0.0,
        self_crossings: 0,
        history: history.collect(),
        points: Vec::new(),
        worn: Assessment::default(),
        closures: Vec::new(),
        too_small: Vec::new(),
        eases: vec![ease],
        distortion: None,
        warnings: vec![],
        used: vec![],
    })
}
