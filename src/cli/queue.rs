//! `toile queue`: lists and controls jobs.

use super::args::{Jobs, Queue};
use super::context::Context;
use super::run::selection;
use super::{CliError, End, Outcome};
use engine::{actions, why_no_retry};
use spec::Selection;
use store::{JobFilter, JobId, Store, StudyError, Table, Value, queue, read};

pub fn run(context: &Context, command: &Queue) -> Outcome {
    let mut store = context.store()?;
    match command {
        Queue::Ls { study, all } => context.print(&list(&store, study.as_deref(), *all)?)?,
        Queue::Pause { study } => actions::pause(&mut store, study)?,
        Queue::Resume { study } => actions::resume(&mut store, study)?,
        Queue::Cancel(jobs) => {
            let ids = ids(&store, jobs)?;
            let changed = actions::cancel(&mut store, &ids)?;
            context.say(format_args!("cancelled {changed} of {} jobs", ids.len()));
        }
        Queue::Retry(jobs) => return retry(context, &mut store, jobs),
        Queue::Priority { to, jobs } => {
            let ids = ids(&store, jobs)?;
            actions::set_priority(&mut store, &ids, *to)?;
            context.say(format_args!("{} jobs have priority {to}", ids.len()));
        }
        Queue::Log { job } => context.print(&log(&store, JobId(*job))?)?,
    }
    Ok(End::Done)
}

fn retry(context: &Context, store: &mut Store, jobs: &Jobs) -> Outcome {
    let ids = ids(store, jobs)?;
    for &id in &ids {
        let why = why_no_retry(read::job(store, id)?.status);
        if let Some(why) = why.filter(|_| !jobs.jobs.is_empty()) {
            context.say(format_args!("job {id} is left as it is: {why}"));
        }
    }
    let changed = actions::retry(store, &ids)?;
    context.say(format_args!("queued {changed} of {} jobs again; `toile run` works on them", ids.len()));
    Ok(End::Done)
}

/// Jobs that are named, and the current jobs of a study or a part of it.
fn ids(store: &Store, jobs: &Jobs) -> Result<Vec<JobId>, CliError> {
    let part = selection(&jobs.part);
    if jobs.study.is_none() && part != Selection::default() {
        return Err(CliError::Usage("a part of which study? give --study NAME".into()));
    }
    let mut ids: Vec<JobId> = jobs.jobs.iter().copied().map(JobId).collect();
    for &id in &ids {
        read::job(store, id)?;
    }
    if let Some(study) = &jobs.study {
        read::study(store, study)?;
        let filter = JobFilter { study: Some(study.clone()), ..JobFilter::default() };
        ids.extend(read::jobs(store, &filter)?.iter().filter(|job| part.takes_row(job)).map(|job| job.id));
    }
    Ok(ids)
}

fn list(store: &Store, study: Option<&str>, all: bool) -> Result<Table, StudyError> {
    if let Some(study) = study {
        read::study(store, study)?;
    }
    let filter = JobFilter { study: study.map(str::to_owned), superseded: all, ..JobFilter::default() };
    let columns = [
        "job", "study", "garment", "size", "subject", "sim", "status", "prio", "done", "ei", "inside", "wall_s",
        "tries", "error",
    ];
    // Where nothing may be written, they are not back in the queue.
    let interrupted = queue::interrupted(store)?;
    let rows = read::jobs(store, &filter)?.into_iter().map(|job| {
        let lost = interrupted.iter().find(|lost| lost.job == job.id);
        let status = if lost.is_some() { "interrupted" } else { job.status.as_str() };
        let real = |number: Option<f64>| number.map_or(Value::Null, Value::Real);
        let percent =
            job.progress.as_ref().map(|progress| format!("{:.0} % {}", progress.fraction * 100.0, progress.phase));
        let inside = job.inside();
        vec![
            Value::Integer(job.id.0),
            Value::Text(job.study),
            Value::Text(job.garment),
            Value::Text(job.size),
            Value::Text(job.subject),
            Value::Text(job.simulator.as_str().to_owned()),
            Value::Text(status.to_owned()),
            Value::Integer(job.priority),
            percent.map_or(Value::Null, Value::Text),
            real(job.ei),
            inside.map_or(Value::Null, Value::Text),
            real(job.wall_ms.map(|ms| ms as f64 / 1e3)),
            Value::Integer(i64::from(job.attempts)),
            lost.map(ToString::to_string).or(job.error).map_or(Value::Null, Value::Text),
        ]
    });
    Ok(Table::new(columns, rows))
}

/// Table of a job's log, with times in seconds since the job last started: below 0 before, empty for one that has not.
fn log(store: &Store, id: JobId) -> Result<Table, StudyError> {
    let started = read::job(store, id)?.started_at_ms;
    let rows = read::log(store, id)?.into_iter().map(|line| {
        let seconds = started.map_or(Value::Null, |started| Value::Real((line.at_ms - started) as f64 / 1e3));
        vec![seconds, Value::Text(line.level), Value::Text(line.text)]
    });
    Ok(Table::new(["seconds", "level", "message"], rows))
}
