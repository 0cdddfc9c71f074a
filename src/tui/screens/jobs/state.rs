//! State of the Jobs screen.

use std::collections::BTreeMap;

use crate::screens::order::Order;
use crate::widgets::text;
use crate::widgets::theme::sign;
use sim::Step;
use store::{JobId, JobRow, Status};

/// Most steps of a running job that are kept for its curves.
const MAX_TRACE: usize = 4096;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum JobOrder {
    /// By number, as they were queued.
    #[default]
    Number,
    /// By state: running, failed, waiting, done.
    Status,
    /// By EI, the worst first.
    Ei,
    /// By duration, the longest first.
    Time,
}

impl JobOrder {
    pub fn next(self) -> Self {
        match self {
            Self::Number => Self::Status,
            Self::Status => Self::Ei,
            Self::Ei => Self::Time,
            Self::Time => Self::Number,
        }
    }
}

/// Jobs that are shown, with the reading, filter and order that they were computed for.
#[derive(Clone, Debug, Default)]
struct Arranged {
    reads: u64,
    filter: String,
    order: Order<JobOrder>,
    rows: Vec<usize>,
}

#[derive(Default)]
pub struct JobsScreen {
    arranged: Arranged,
    pub order: Order<JobOrder>,
    /// Lines by which the log is scrolled up from its end.
    pub log_up: usize,
    /// Steps of running jobs, in the order of arrival.
    pub traces: BTreeMap<JobId, Vec<Step>>,
    /// Number of times that the database was read.
    reads: u64,
}

impl JobsScreen {
    /// Adds the latest step of each running job.
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

    /// Filters and sorts jobs, if data, filter or order have changed since: with ten thousand jobs this takes too long
    /// for every frame.
    pub fn arrange_rows(&mut self, jobs: &[JobRow], filter: String, is_paused: bool) {
        let Arranged { reads, filter: arranged, order, .. } = &self.arranged;
        if (*reads, arranged, *order) == (self.reads, &filter, self.order) {
            return;
        }
        let passes = |row: &usize| filter.is_empty() || words(&jobs[*row], is_paused).contains(&filter);
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

    /// Jobs that are shown, as indices into the data.
    pub fn rows(&self) -> &[usize] {
        &self.arranged.rows
    }
}

/// Rank of a state: the sooner a user wants to see its jobs, the lower.
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

/// Text of a job to which the filter applies: what its line shows, in words and signs, and the name of its state.
fn words(job: &JobRow, is_paused: bool) -> String {
    let progress = job.progress.as_ref().map_or(String::new(), text::progress);
    format!(
        "{} {} {} {} {} {} {} {progress} {} {} {}",
        job.id,
        sign(job.status, job.inside().is_some()),
        text::status(job.status),
        job.garment,
        job.size,
        job.subject,
        text::sim(job.simulator),
        job.wall_ms.map_or(String::new(), text::duration),
        job.ei.map_or(String::new(), text::ei),
        text::why(job, is_paused)
    )
    .to_lowercase()
}
