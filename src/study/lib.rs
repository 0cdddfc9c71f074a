//! The study: study files, the SQLite store, the queue and its workers, and everything the two faces may ask for.
//!
//! The only owner of SQL, worker threads, the clock and study files. [`Workspace`] is the door: it reads plain rows
//! (`read`), acts on the queue and starts runs. SI units in rows, millimetres in SQL.

mod actions;
mod advice;
mod attempt;
mod audit;
mod cache;
mod catalogue;
mod desk_report;
mod desk_sql;
mod desk_study;
mod doctor;
mod engine;
mod enqueue;
mod error;
mod evidence;
mod export;
mod figure;
mod file;
mod handout;
mod inputs;
mod isolated;
mod live;
mod new_study;
mod outcome;
mod owner;
mod parameters;
pub mod pattern_files;
mod picture;
mod pipeline;
mod population;
mod queue;
mod read;
mod record;
mod reporting;
mod run;
mod seam_desk;
mod sewing;
mod size_map;
mod slurm;
mod spec;
mod sql;
mod store;
#[cfg(test)]
mod tests;
pub mod tools;
mod types;
mod workpiece;
mod workspace;

pub use actions::why_no_retry;
pub use advice::{LevelFit, SizeAnswer, SizeOn};
pub use attempt::{Attempt, Tried, TriedChi, TriedEase, TriedGap, attempt};
pub use audit::{Audit, Finding};
pub use catalogue::{
    Deed, FABRIC_NUMBERS, FabricRow, Field, Given, MEASUREMENTS, Mode, Part, Removed, Saved, SizeRow, StyleGiven,
    SubjectRow, doubts, is_doubtful, percentile, percentile_text, sex,
};
pub use desk_report::{ReportRow, reports};
pub use desk_sql::{Relation, SqlAnswer};
pub use desk_study::{NewStudy, PatternSource, Wearable, wearables};
pub use doctor::{Check, checks};
pub use enqueue::{Planned, Why};
pub use error::{Result, StudyError};
pub use evidence::PUBLISHED;
pub use export::export_study;
pub use figure::Figure;
pub use file::{Problem, Study, study_file};
pub use handout::{HandedOut, Merged, Ran, run_job};
pub use inputs::{Change, Inputs, StageKind};
pub use live::{Live, LiveFrame};
pub use new_study::new_study;
pub use outcome::{Executor, Measured, Outcome};
pub use parameters::Parameters;
pub use picture::{Cloth, Look, Map, Order, Shot, Zoom};
pub use pipeline::{Pipeline, SIMULATORS};
pub use population::{Nearest, PopulationOptions, Representative, representatives, subjects_text};
pub use read::JobFilter;
pub use record::{ChiPair, Comparison, ProvenanceRow, Record, Rerun};
pub use run::{Run, RunOptions};
pub use slurm::{SlurmOptions, SlurmRun};
pub use spec::{JobSpec, Limits, Schedule, Selection};
pub use sql::{Interrupter, SavedQuery, saved_queries, saved_query};
pub use store::now_ms;
pub use types::{
    Cell, ChiRow, EaseRow, FitCell, Grid, JobId, JobProgress, JobRow, LogLine, MetricsRow, RecommendationRow, SizeKey,
    StageRow, Status, StudyRow, SubjectId, Table, Value,
};
pub use workspace::Workspace;

pub use fit::FitClass;
pub use fit::Simulator;
pub use fit::{Analysis, Answer, Estimate, Evidence, Finding as Verdict, SizeAdvice, SizeFit, Without};
pub use render::export::MeshFormat;
pub use render::{Rgb, View};
pub use sim::{Monitor, Stage, Step};
