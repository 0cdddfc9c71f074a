//! Where the user is among jobs.

use std::collections::BTreeMap;

use crate::screens::order::Order;
use study::{JobId, Step};

/// How jobs are ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum JobOrder {
    /// As queued.
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
    /// The next one.
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
pub struct Arranged {
    /// Of what they were found.
    pub of: Option<(u64, String, Order<JobOrder>)>,
    /// The jobs, as rows of the data.
    pub rows: Vec<usize>,
}

/// Where the user is among jobs.
#[derive(Debug, Default)]
pub struct Jobs {
    /// The jobs shown, in order.
    pub arranged: Arranged,
    /// Order of jobs.
    pub order: Order<JobOrder>,
    /// Lines the log is scrolled up from its end.
    pub log_up: usize,
    /// Steps of running jobs, as they came.
    pub traces: BTreeMap<JobId, Vec<Step>>,
    /// How often data came.
    pub reads: u64,
}
