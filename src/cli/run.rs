//! `toile run`: queue, work, summarise, report.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};

use super::args::Run as Arguments;
use super::context::Context;
use super::progress::Progress;
use super::{End, Outcome, detached, output, pictures};
use crate::study::{
    JobFilter, JobId, JobRow, Planned, RunOptions, Selection, Status, Study, StudyError, Table, Value, Workspace,
};

/// Time between two looks at the running jobs.
const LOOK: Duration = Duration::from_millis(150);

/// `toile run`.
pub fn run(context: &Context, arguments: &Arguments) -> Outcome {
    let mut workspace = context.workspace()?;
    if arguments.attach {
        let name = context.study_name(&workspace, &arguments.study)?;
        return detached::follow(context, &workspace, &name);
    }
    let study = context.study(&workspace, &arguments.study)?;
    let selection = Selection {
        simulators: arguments.sim.clone(),
        sizes: arguments.size.clone(),
        subjects: arguments.subject.clone(),
        garments: arguments.garment.clone(),
    };
    if arguments.dry_run {
        let planned = workspace.plan(&study, &selection)?;
        context.print(&plan_table(&planned))?;
        return Ok(End::Done);
    }
    let workers = arguments.workers.map(usize::from);
    if arguments.detach {
        // So that whoever follows it at once finds its jobs.
        workspace.queue(&study, &selection)?;
        return detached::start(context, &study.name);
    }
    let options = RunOptions { selection, workers, ..RunOptions::default() };
    let interrupted = work(context, &mut workspace, &study, &options, arguments.why)?;
    let jobs = workspace.jobs(&JobFilter { study: Some(study.name.clone()), ..JobFilter::default() })?;
    summarise(context, &workspace, &jobs)?;
    if interrupted {
        context.say("interrupted; `toile run` goes on where this stopped");
        return Ok(End::Interrupted);
    }
    if !arguments.no_report && jobs.iter().any(|job| job.status.has_result()) {
        pictures::write_report(context, &workspace, &study.name, None)?;
    }
    let failed: Vec<&JobRow> = jobs.iter().filter(|job| job.status == Status::Failed).collect();
    for job in &failed {
        eprintln!("job {} failed: {}", job.id, job.error.as_deref().unwrap_or("no reason given"));
    }
    Ok(if failed.is_empty() { End::Done } else { End::JobFailed })
}

/// Starts the run and shows how it fares until it ends; says whether it was interrupted.
fn work(
    context: &Context,
    workspace: &mut Workspace,
    study: &Study,
    options: &RunOptions,
    why: bool,
) -> Result<bool, super::CliError> {
    let interrupted = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // A second signal ends at once: the database does not mind.
        signal_hook::flag::register_conditional_shutdown(signal, End::Interrupted as i32, interrupted.clone())?;
        signal_hook::flag::register(signal, interrupted.clone())?;
    }
    let run = workspace.start(study, options)?;
    if why || context.verbose {
        for job in &run.planned {
            context.say(format_args!("{}: {}", label(&job.spec.garment, &job.spec.size, &job.spec.subject), job.why));
        }
    }
    let todo: BTreeSet<JobId> = run.planned.iter().filter(|job| job.why.will_run()).map(|job| job.id).collect();
    context.say(format_args!(
        "{}: {} jobs, {} to run, {} up to date",
        study.name,
        run.planned.len(),
        todo.len(),
        run.planned.len() - todo.len()
    ));
    if workspace.study(&study.name)?.paused {
        context.say(format_args!("{0} is paused: jobs wait until `toile queue resume {0}`", study.name));
    }
    let mut progress = Progress::new(context, &study.name, todo);
    while !run.is_finished() {
        if interrupted.load(Ordering::Relaxed) {
            run.stop();
        }
        progress.show(workspace)?;
        std::thread::sleep(LOOK);
    }
    run.join()?;
    progress.show(workspace)?;
    progress.finish();
    Ok(interrupted.load(Ordering::Relaxed))
}

/// `tshirt S ii`.
pub fn label(garment: &str, size: &str, subject: &str) -> String {
    format!("{garment} {size} {subject}")
}

/// What would run, and why.
fn plan_table(planned: &[Planned]) -> Table {
    let columns = ["garment", "size", "subject", "sim", "repeat", "runs", "why"];
    let rows = planned.iter().map(|job| {
        let text = |text: &str| Value::Text(text.to_owned());
        vec![
            text(&job.spec.garment),
            text(&job.spec.size),
            text(&job.spec.subject),
            text(job.spec.simulator.as_str()),
            Value::Integer(i64::from(job.spec.repeat)),
            text(if job.why.will_run() { "yes" } else { "no" }),
            Value::Text(job.why.to_string()),
        ]
    });
    Table { columns: columns.map(str::to_owned).to_vec(), rows: rows.collect() }
}

/// Prints the results: chi of every measurement as the thesis lays it out, one table a garment, size and simulator; as
/// JSON the rows of `v_metrics` with their `chi`.
fn summarise(context: &Context, workspace: &Workspace, jobs: &[JobRow]) -> Result<(), super::CliError> {
    let done: Vec<&JobRow> = jobs.iter().filter(|job| job.status.has_result()).collect();
    if context.json {
        let mut results = Vec::new();
        for job in done {
            results.push(result_json(workspace, job)?);
        }
        return Ok(output::json(&results)?);
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
        output::text(&output::pretty(&chi_table(workspace, &group)?))?;
    }
    Ok(())
}

/// Rows: measurements and summary; columns: pattern length and one chi a subject.
fn chi_table(workspace: &Workspace, jobs: &[&JobRow]) -> Result<Table, StudyError> {
    let mut columns = vec!["#".to_owned(), "measurement".to_owned(), "L2D mm".to_owned()];
    let mut rows: Vec<Vec<Value>> = Vec::new();
    let mut summary = ["E", "SD", "EI"].map(|name| vec![Value::Null, Value::Text(name.to_owned()), Value::Null]);
    for job in jobs {
        let repeat = if job.repeat > 1 { format!(" /{}", job.repeat) } else { String::new() };
        let mark = if job.status == Status::NotConverged { " *" } else { "" };
        columns.push(format!("{}{repeat}{mark}", job.subject));
        for (index, chi) in workspace.chi(job.id)?.iter().enumerate() {
            if rows.len() == index {
                let length = Value::Text(format!("{:.2}", crate::units::mm(chi.l2d_m)));
                rows.push(vec![Value::Integer(i64::from(chi.no)), Value::Text(chi.name.clone()), length]);
            }
            rows[index].push(Value::Text(format!("{:.3}", chi.chi())));
        }
        if let Some(metrics) = workspace.metrics(job.id)? {
            for (row, value) in summary.iter_mut().zip([metrics.e_chi, metrics.sd_chi, metrics.ei]) {
                row.push(Value::Text(format!("{value:.4}")));
            }
        }
    }
    rows.extend(summary);
    Ok(Table { columns, rows })
}

/// The columns of `v_metrics` and an array `chi` with those of `v_chi`.
fn result_json(workspace: &Workspace, job: &JobRow) -> Result<serde_json::Value, StudyError> {
    let rows = |view: &str| -> Result<Vec<serde_json::Map<String, serde_json::Value>>, StudyError> {
        Ok(output::rows(&workspace.query(&format!("SELECT * FROM {view} WHERE job_id = {}", job.id))?))
    };
    let mut result = rows("v_metrics")?.into_iter().next().unwrap_or_default();
    result.insert("chi".to_owned(), rows("v_chi")?.into());
    Ok(result.into())
}
