//! Where the user is among jobs.

use std::collections::BTreeMap;

use crate::screens::order::Order;
use crate::widgets::text;
use sim::Step;
use store::{JobId, JobRow, Status};

/// Steps of a running job that are kept for its curves.
const MAX_TRACE: usize = 4096;

/// How jobs are ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum JobOrder {
    /// By number, as they were queued.
    #[default]
    Number,
    /// By state: what runs, what went wrong, what waits, what is done.
    Status,
    /// By EI, the worst first.
    Ei,
    /// By time taken, the longest first.
    Time,
}

impl JobOrder {
    /// The order that `sort` comes to next.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Number => Self::Status,
            Self::Status => Self::Ei,
            Self::Ei => Self::Time,
            Self::Time => Self::Number,
        }
    }
}

/// The jobs shown, and of what they were found: data, filter, order.
#[derive(Clone, Debug, Default)]
struct Arranged {
    of: Option<(u64, String, Order<JobOrder>)>,
    rows: Vec<usize>,
}

/// Where the user is among jobs.
#[derive(Debug, Default)]
pub struct Jobs {
    /// The jobs shown, in order.
    arranged: Arranged,
    /// Order of jobs.
    pub order: Order<JobOrder>,
    /// Lines the log is scrolled up from its end.
    pub log_up: usize,
    /// Steps of running jobs, as they came.
    pub traces: BTreeMap<JobId, Vec<Step>>,
    /// How often data came.
    reads: u64,
}

impl Jobs {
    /// Takes in jobs that were read: those that run have come on by a step.
    pub fn receive(&mut self, jobs: &[JobRow]) {
        self.reads += 1;
        for job in jobs.iter().filter(|job| job.status == Status::Running) {
            let Some(progress) = &job.progress else { continue };
            let trace = self.traces.entry(job.id).or_default();
            if trace.last().is_some_and(|last| last.iteration > progress.step.iteration) {
                trace.clear();
            }
            if trace.last() != Some(&progress.step) && trace.len() < MAX_TRACE {
                trace.push(progress.step);
            }
        }
    }

    /// Finds which jobs contain a filter and in which order, where data, filter or order have changed since: with ten
    /// thousand jobs that takes too long for every frame.
    pub fn arrange(&mut self, jobs: &[JobRow], filter: String) {
        let wanted = (self.reads, filter, self.order);
        if self.arranged.of.as_ref() == Some(&wanted) {
            return;
        }
        let passes = |row: &usize| wanted.1.is_empty() || words(&jobs[*row]).contains(&wanted.1);
        let mut rows: Vec<usize> = (0..jobs.len()).filter(passes).collect();
        let falling = |value: Option<f64>| value.map_or(f64::INFINITY, |v| -v);
        match self.order.by {
            JobOrder::Number => {}
            JobOrder::Status => rows.sort_by_key(|row| attention(jobs[*row].status)),
            JobOrder::Ei => rows.sort_by(|a, b| falling(jobs[*a].ei).total_cmp(&falling(jobs[*b].ei))),
            JobOrder::Time => rows.sort_by_key(|row| -jobs[*row].wall_ms.unwrap_or(i64::MIN + 1)),
        }
        if self.order.reversed {
            rows.reverse();
        }
        self.arranged = Arranged { of: Some(wanted), rows };
    }

    /// The jobs shown, as rows of the data.
    #[must_use]
    pub fn rows(&self) -> &[usize] {
        &self.arranged.rows
    }
}

/// How soon a user wants to see jobs in a state; the least first.
fn attention(status: Status) -> u8 {
    match status {
        Status::Running => 0,
        Status::Failed => 1,
        Status::NotConverged => 2,
        Status::Queued => 3,
        Status::Done => 4,
        Status::Cancelled => 5,
    }
}

/// What a filter looks at in a job.
fn words(job: &JobRow) -> String {
    let error = job.error.as_deref().unwrap_or_default();
    format!(
        "{} {} {} {} {} {} {error}",
        job.id,
        text::status(job.status),
        job.garment,
        job.size,
        job.subject,
        text::sim(job.simulator)
    )
    .to_lowercase()
}
