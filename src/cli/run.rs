//! `toile run`: queues the jobs of a study, runs them, prints the results and writes the report.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};

use super::args::{Engine, Run as Arguments, StudyPart};
use super::context::Context;
use super::progress::{self, Progress, label};
use super::{CliError, End, Outcome, detached, output, pictures, runs};
use engine::{Ending, Planned, RunOptions, SlurmOptions, enqueue, run, slurm};
use sim::Stage;
use spec::{Limits, Selection, Study};
use store::{JobFilter, JobId, JobRow, Status, Store, StudyError, Table, Value, files, read, sql};

const LOOK: Duration = Duration::from_millis(150);
/// Jobs in a printed table of a plan.
const TOGETHER: usize = 10_000;
const SLURM_LOOK: Duration = Duration::from_secs(1);

pub fn run(context: &Context, arguments: &Arguments) -> Outcome {
    let path = match (&arguments.command, &arguments.study) {
        (Some(command), _) => return runs::run(context, command),
        (None, Some(path)) => path,
        (None, None) => return Err(CliError::Usage("no study; give its folder".into())),
    };
    let mut store = context.store()?;
    if arguments.attach {
        let name = context.study_name(&store, path)?;
        return detached::follow(context, &store, &name);
    }
    let mut study = context.study(&store, path)?;
    study.limit(Limits { time_s: arguments.limits.time_limit, memory_mb: arguments.limits.memory_limit });
    let selection = selection(&arguments.part);
    if arguments.moved {
        enqueue::move_home(&mut store, &study)?;
    }
    if arguments.dry_run {
        let planned = run::plan(&mut store, &study, &selection)?;
        // A table is laid out as a whole, and of a million jobs it would not fit the memory.
        let part = if context.json { planned.len().max(1) } else { TOGETHER };
        for planned in planned.chunks(part) {
            context.print(&plan_table(&study, planned))?;
        }
        return Ok(End::Done);
    }
    if !arguments.no_report {
        files::make_folder(&pictures::default_folder(context, &study.name))?;
    }
    let workers = arguments.workers.map(usize::from);
    if arguments.detach {
        // Queues the jobs before the detached run does, so that `--attach` finds them at once.
        enqueue::queue(&mut store, &study, &selection)?;
        return detached::start(context, &study.name);
    }
    let interrupted = match arguments.engine {
        Engine::Local => {
            let options = RunOptions { selection, workers, ..RunOptions::default() };
            work(context, &mut store, &study, &options, arguments.why)?
        }
        Engine::Slurm => {
            let beside = || context.db.parent().map(Path::to_owned).unwrap_or_default();
            let folder = arguments
                .slurm_dir
                .clone()
                .unwrap_or_else(|| beside().join("slurm").join(files::study_folder(&study.name)));
            let options = SlurmOptions { folder, tasks: workers, sbatch: arguments.sbatch.clone() };
            slurm(context, &mut store, &study, &selection, &options, arguments.why)?
        }
    };
    let jobs = read::jobs(&store, &JobFilter { study: Some(study.name.clone()), ..JobFilter::default() })?;
    summarise(context, &store, &jobs)?;
    if interrupted {
        context.say("interrupted; `toile run` goes on where this stopped");
        return Ok(End::Interrupted);
    }
    if !arguments.no_report && jobs.iter().any(|job| job.status.has_result()) {
        let since = jobs.iter().filter_map(|job| job.finished_at_ms).max().unwrap_or_default();
        pictures::bring_report(context, &mut store, &study, since)?;
    }
    let failed: Vec<&JobRow> = jobs.iter().filter(|job| job.status == Status::Failed).collect();
    for job in &failed {
        output::note(&format!("job {} failed: {}", job.id, job.error.as_deref().unwrap_or("no reason given")));
    }
    Ok(if failed.is_empty() { End::Done } else { End::JobFailed })
}

pub fn selection(part: &StudyPart) -> Selection {
    Selection {
        simulators: part.sim.clone(),
        sizes: part.size.clone(),
        subjects: part.subject.clone(),
        garments: part.garment.clone(),
    }
}

/// Flag that the first Ctrl-C or request to end sets.
fn interruption() -> Result<Arc<AtomicBool>, CliError> {
    let interrupted = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // A second signal ends the program at once, which does not harm the database.
        signal_hook::flag::register_conditional_shutdown(signal, End::Interrupted as i32, interrupted.clone())?;
        signal_hook::flag::register(signal, interrupted.clone())?;
    }
    Ok(interrupted)
}

/// Prints the number of jobs to run, and with `why` the reason for each job. Returns the jobs that will run.
fn tell_plan(context: &Context, study: &Study, planned: &[Planned], why: bool) -> BTreeSet<JobId> {
    if why || context.verbose {
        for job in planned {
            let cell = job.cell;
            let (garment, size, subject) = (&cell.garment(study).name, &cell.size(study).name, &cell.subject(study).id);
            context.say(format_args!("{}: {}", label(garment, size, subject, cell.simulator), job.why));
        }
    }
    let todo: BTreeSet<JobId> = planned.iter().filter(|job| job.why.will_run()).map(|job| job.id).collect();
    let (all, to_run) = (planned.len(), todo.len());
    context.say(format_args!("{}: {all} jobs, {to_run} to run, {} up to date", study.name, all - to_run));
    todo
}

/// Hands the study to Slurm and shows its progress until it ends. Returns true if interrupted: Slurm's jobs then go on,
/// and the next run collects their results.
fn slurm(
    context: &Context,
    store: &mut Store,
    study: &Study,
    selection: &Selection,
    options: &SlurmOptions,
    why: bool,
) -> Result<bool, CliError> {
    let interrupted = interruption()?;
    let mut run = slurm::start_slurm(store, study, selection, options)?;
    let todo = tell_plan(context, study, &run.planned, why);
    let mut progress = Progress::new(context, &study.name, todo);
    let mut told = Vec::new();
    while !run.step(store)? {
        if interrupted.load(Ordering::Relaxed) {
            break;
        }
        if run.arrays() != told {
            told = run.arrays().to_vec();
            context.say(format_args!("Slurm job {}", told.join(", ")));
        }
        progress.show(store)?;
        std::thread::sleep(SLURM_LOOK);
    }
    progress.show(store)?;
    progress.finish();
    Ok(interrupted.load(Ordering::Relaxed))
}

/// Shows the progress until the run ends. Returns true if interrupted.
pub fn work(
    context: &Context,
    store: &mut Store,
    study: &Study,
    options: &RunOptions,
    why: bool,
) -> Result<bool, CliError> {
    let interrupted = interruption()?;
    let run = run::start(store, study, options)?;
    let planned = run.planned.clone();
    let todo = tell_plan(context, study, &planned, why);
    if read::study(store, &study.name)?.paused && !todo.is_empty() {
        // Without a word, a quiet run would wait for ever.
        let (name, word) = (&study.name, files::word(&study.name));
        output::note(&format!("{name} is paused: its jobs wait until `toile queue resume {word}`"));
    }
    let mut progress = Progress::new(context, &study.name, todo);
    while !run.is_finished() {
        if interrupted.load(Ordering::Relaxed) {
            run.stop();
        }
        progress.show(store)?;
        std::thread::sleep(LOOK);
    }
    run.join()?;
    progress.show(store)?;
    progress.finish();
    progress::tell_end(context, &Ending::of(store, &study.name, &planned)?);
    Ok(interrupted.load(Ordering::Relaxed))
}

fn plan_table(study: &Study, planned: &[Planned]) -> Table {
    let columns = ["garment", "size", "subject", "sim", "repeat", "runs", "why"];
    let rows = planned.iter().map(|job| {
        let text = |text: &str| Value::Text(text.to_owned());
        vec![
            text(&job.cell.garment(study).name),
            text(&job.cell.size(study).name),
            text(&job.cell.subject(study).id),
            text(job.cell.simulator.as_str()),
            Value::Integer(i64::from(job.cell.repeat)),
            text(if job.why.will_run() { "yes" } else { "no" }),
            Value::Text(job.why.to_string()),
        ]
    });
    Table::new(columns, rows)
}

/// Prints the results: chi of every measurement, in a table for each garment, size and simulator as in the thesis. As
/// JSON, prints the rows of `v_metrics` with their `chi`.
fn summarise(context: &Context, store: &Store, jobs: &[JobRow]) -> Result<(), CliError> {
    let done: Vec<&JobRow> = jobs.iter().filter(|job| job.status.has_result()).collect();
    if context.json {
        let mut results = Vec::new();
        for job in done {
            results.push(result_json(store, job)?);
        }
        return Ok(output::json(&results)?);
    }
    if context.quiet {
        return Ok(());
    }
    let mut groups: Vec<Vec<&JobRow>> = Vec::new();
    for job in done {
        let same = |other: &&JobRow| {
            (&other.garment, &other.size, other.simulator) == (&job.garment, &job.size, job.simulator)
        };
        match groups.iter_mut().find(|group| group.iter().all(same)) {
            Some(group) => group.push(job),
            None => groups.push(vec![job]),
        }
    }
    for group in groups {
        let first = group[0];
        let title = format!("{} {}, {}: chi = L3D / L2D\n", first.garment, first.size, first.simulator.as_str());
        output::text(&title)?;
        output::text(&output::pretty(&chi_table(store, &group)?))?;
    }
    Ok(())
}

/// Table with a row for each measurement, and a summary. Columns are the pattern length and chi of each subject.
fn chi_table(store: &Store, jobs: &[&JobRow]) -> Result<Table, StudyError> {
    let mut columns = vec!["#".to_owned(), "measurement".to_owned(), "L2D mm".to_owned()];
    let mut rows: Vec<Vec<Value>> = Vec::new();
    let mut summary = ["E", "SD", "EI"].map(|name| vec![Value::Null, Value::Text(name.to_owned()), Value::Null]);
    for job in jobs {
        let repeat = if job.repeat > 1 { format!(" /{}", job.repeat) } else { String::new() };
        let mark = if job.status == Status::NotConverged { " *" } else { "" };
        columns.push(format!("{}{repeat}{mark}", job.subject));
        let drape = Stage::Drape.as_str();
        for (index, chi) in read::chi(store, job.id)?.iter().filter(|chi| chi.stage == drape).enumerate() {
            if rows.len() == index {
                let length = Value::Text(format!("{:.2}", geom::units::mm(chi.l2d_m)));
                rows.push(vec![Value::Integer(i64::from(chi.no)), Value::Text(chi.name.clone()), length]);
            }
            rows[index].push(Value::Text(format!("{:.3}", chi.chi())));
        }
        if let Some(metrics) = read::metrics(store, job.id)? {
            for (row, value) in summary.iter_mut().zip([metrics.e_chi, metrics.sd_chi, metrics.ei]) {
                row.push(Value::Text(format!("{value:.4}")));
            }
        }
    }
    rows.extend(summary);
    Ok(Table { columns, rows })
}

/// Columns of `v_metrics`, and an array `chi` with the columns of `v_chi`.
fn result_json(store: &Store, job: &JobRow) -> Result<serde_json::Value, StudyError> {
    let rows = |view: &str| -> Result<Vec<serde_json::Map<String, serde_json::Value>>, StudyError> {
        Ok(output::rows(&sql::query(store, &format!("SELECT * FROM {view} WHERE job_id = {}", job.id))?))
    };
    let mut result = rows("v_metrics")?.into_iter().next().unwrap_or_default();
    result.insert("chi".to_owned(), rows("v_chi")?.into());
    Ok(result.into())
}
