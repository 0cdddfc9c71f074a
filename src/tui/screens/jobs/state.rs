//! State of the screen of jobs.

use std::collections::BTreeMap;

use crate::screens::order::Order;
use crate::widgets::text;
use sim::Step;
use store::{JobId, JobRow, Status};

/// Steps of a running job that are kept for its curves.
const MAX_TRACE: usize = 4096;

/// Order of jobs.
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

/// The jobs shown, and the number of the reading, the filter and the order that they were found for.
#[derive(Clone, Debug, Default)]
struct Arranged {
    reads: u64,
    filter: String,
    order: Order<JobOrder>,
    rows: Vec<usize>,
}

/// The screen of jobs.
#[derive(Default)]
pub struct JobsScreen {
    /// The jobs shown, in order.
    arranged: Arranged,
    /// Order of jobs.
    pub order: Order<JobOrder>,
    /// Lines the log is scrolled up from its end.
    pub log_up: usize,
    /// Steps of running jobs, as they came.
    pub traces: BTreeMap<JobId, Vec<Step>>,
    /// Number of readings of the database.
    reads: u64,
}

impl JobsScreen {
    /// Takes in jobs that were read: those that run have come on by a step.
    pub fn trace(&mut self, jobs: &[JobRow]) {
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
    pub fn arrange_rows(&mut self, jobs: &[JobRow], filter: String) {
        let Arranged { reads, filter: arranged, order, .. } = &self.arranged;
        if (*reads, arranged, *order) == (self.reads, &filter, self.order) {
            return;
        }
        let passes = |row: &usize| filter.is_empty() || words(&jobs[*row]).contains(&filter);
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
        self.arranged = Arranged { reads: self.reads, filter, order: self.order, rows };
    }

    /// The jobs shown, as rows of the data.
    #[must_use]
    pub fn rows(&self) -> &[usize] {
        &self.arranged.rows
    }
}

/// Rank of jobs in a state by how soon a user wants to see them; the least first.
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

/// Text of a job that a filter looks at.
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
