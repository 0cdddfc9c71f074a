//! The store: one SQLite database with its studies, jobs and results. It also has the values that all crates above it
//! share: errors, files with their bytes, plain rows.
//!
//! Only this crate opens SQL connections. Rows are in SI units; columns of SQL are in millimetres.

pub mod cache;
pub mod columns;
pub mod comments;
mod connection;
mod database;
mod error;
pub mod evidence;
pub mod files;
mod functions;
mod live;
pub mod owner;
pub mod queue;
pub mod read;
mod rows;
mod saved;
mod schema;
pub mod sql;
mod transaction;

pub use connection::{Access, open, still_there};
pub use database::Store;
pub use error::{FileError, InFile, InOrigin, Origin, Problem, Result, StudyError, hidden_hint, nearest};
pub use evidence::PUBLISHED;
pub use live::{Live, LiveFrame};
pub use read::JobFilter;
pub use rows::{
    Cell, ChiRow, EaseRow, Encoder, FitCell, Grid, INSIDE_M, JobId, JobProgress, JobRow, LogLine, MetricsRow,
    OutfitRow, RecommendationRow, SizeKey, StageKind, StageRow, Status, StudyRow, SubjectId, Table, Value, distinct,
    inside_words,
};
pub use saved::{SavedQuery, save_query, saved_queries, saved_query};
pub use sql::{Interrupter, Relation, SqlAnswer};
pub use transaction::{lightly, now_ms, write};
