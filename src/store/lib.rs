//! The store: one SQLite database with its studies, jobs and results, and what every crate above it shares: errors, files
//! as read, plain rows.
//!
//! The only owner of SQL connections. SI units in rows, millimetres in SQL.

pub mod browse;
pub mod cache;
mod database;
mod error;
pub mod evidence;
pub mod files;
pub mod live;
pub mod owner;
pub mod queue;
pub mod read;
mod rows;
pub mod sql;

pub use browse::{Relation, SqlAnswer};
pub use database::{Access, Store, lightly, now_ms, open, still_there, write};
pub use error::{InFile, Problem, Result, StudyError, hidden_hint, nearest};
pub use evidence::PUBLISHED;
pub use live::{Live, LiveFrame};
pub use read::JobFilter;
pub use rows::{
    Cell, ChiRow, EaseRow, FitCell, Grid, JobId, JobProgress, JobRow, LogLine, MetricsRow, RecommendationRow, SizeKey,
    StageKind, StageRow, Status, StudyRow, SubjectId, Table, Value,
};
pub use sql::{Interrupter, SavedQuery, save_query, saved_queries, saved_query};
