//! The study: study files, the SQLite store, the queue and its workers, and everything the two faces may ask for.
//!
//! The only owner of SQL, worker threads, the clock and study files. [`Workspace`] is the door: it reads plain rows
//! (`read`), acts on the queue and starts runs. SI units in rows, millimetres in SQL.

mod actions;
mod error;
mod file;
mod owner;
mod queue;
mod read;
mod store;
mod types;
mod workspace;

pub use actions::why_no_retry;
pub use error::{Result, StudyError};
pub use file::Problem;
pub use read::JobFilter;
pub use store::now_ms;
pub use types::{
    Cell, ChiRow, EaseRow, FitCell, Grid, JobId, JobProgress, JobRow, LogLine, MetricsRow, RecommendationRow, StageRow,
    Status, StudyRow, Table, Value,
};
pub use workspace::Workspace;

pub use crate::fit::FitClass;
pub use crate::sim::{Simulator, Step};
