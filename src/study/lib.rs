//! The study: study files, the SQLite store, the queue and its workers, and everything the two faces may ask for.
//!
//! The only owner of SQL, worker threads, the clock and study files. [`Workspace`] is the door: it reads plain rows
//! (`read`), acts on the queue and starts runs. SI units in rows, millimetres in SQL.

mod alteration;
mod answers;
mod attempt;
pub mod bodies;
mod catalogue;
mod chance;
mod error;
pub mod evaluate;
mod faults;
pub mod files;
mod grading;
pub mod patterns;
mod reach;
mod rows;
mod run;
pub mod seams;
mod spec;
mod store;
#[cfg(test)]
mod tests;
mod workspace;

pub use alteration::{
    ALTER_LIMIT_MM, Alteration, AlteredLevel, AlteredReading, MovedHandle, Redraped, Standing, Wish, alter, standing,
};
pub use answers::audit::{Audit, Finding};
pub use answers::doctor::{Check, checks};
pub use answers::dressed::{Dressed, Tally, tally};
pub use answers::figure::Figure;
pub use answers::fit_card::{FitCard, LevelSits, Sits, SizeSits};
pub use answers::laboratory::laboratory;
pub use answers::picture::{Cloth, Look, Map, Order, Shot, Zoom};
pub use answers::population::{Nearest, PopulationOptions, Representative, representatives, subjects_text};
pub use answers::record::{ChiPair, Comparison, ProvenanceRow, Record, Rerun};
pub use answers::reports::{ReportRow, reports};
pub use answers::section::{CrossSection, CutAt, CutCloth, CutLine};
pub use answers::worn::{Balance, DrawnOpening, FoldLine, GarmentWorn, LevelGap, RegionPressure, SizeWorn, WornPoint};
pub use attempt::{
    Attempt, AttemptLayer, Tried, TriedChi, TriedCloth, TriedEase, TriedErrors, TriedGap, attempt,
    fabric as fabric_named,
};
pub use catalogue::{
    Deed, FabricRow, Imported, Mode, Part, Removed, Saved, ScanGiven, SizeRow, Strictness, StyleGiven, SubjectRow,
    doubts, is_doubtful, percentile, percentile_text, with_bending,
};
pub use chance::{
    Chance, DrapedChance, LevelChance, LikelyDimension, PlantedLevel, PlantedTally, Question, Reliability, SizeChance,
    chance, planted,
};
pub use error::{Problem, Result, StudyError};
pub use grading::{DrapedAgain, GradeWish, Grading, LevelShare, PartShare, Range, SizeSet, SizeShare, Turn, grade};
pub use reach::{Reached, ReachedAt, ReachedOpening};
pub use rows::{
    Cell, ChiRow, EaseRow, FitCell, Grid, JobId, JobProgress, JobRow, LogLine, MetricsRow, RecommendationRow, SizeKey,
    StageKind, StageRow, Status, StudyRow, SubjectId, Table, Value,
};
pub use run::actions::why_no_retry;
pub use run::compose::{NewStudy, PatternSource, Wearable, wearables};
pub use run::enqueue::{Planned, Why};
pub use run::handout::{HandedOut, Merged, Ran, run_job};
pub use run::outcome::{Executor, Measured, MeasuredPoint, Outcome};
pub use run::pipeline::Pipeline;
pub use run::slurm::{SlurmOptions, SlurmRun};
pub use run::wardrobe::{Opened, Wardrobe};
pub use run::worn::{Level, Pressing, WornOn};
pub use run::{Run, RunOptions};
pub use spec::export::export_study;
pub use spec::fields::{FABRIC_NUMBERS, Field, Given, MEASUREMENTS, sex};
pub use spec::file::{Person, Study, read_measurements, study_file};
pub use spec::inputs::{Change, Inputs};
pub use spec::new_study::{QUICKSTART, new_study, write_quickstart};
pub use spec::parameters::Parameters;
pub use spec::versions::SIMULATORS;
pub use spec::{JobSpec, Limits, Schedule, Selection};
pub use store::browse::{Relation, SqlAnswer};
pub use store::evidence::PUBLISHED;
pub use store::live::{Live, LiveFrame};
pub use store::now_ms;
pub use store::read::JobFilter;
pub use store::sql::{Interrupter, SavedQuery, save_query, saved_queries, saved_query};
pub use workspace::Workspace;

pub use fit::target::Intended;
pub use fit::{Analysis, Answer, Estimate, Evidence, Finding as Verdict, FitClass, Simulator, Without};
pub use pattern::Handle;
pub use render::export::MeshFormat;
pub use render::{Rgb, View};
pub use report::{Chart, Purpose, file_part};
pub use sim::fabric::{Stretched, USUAL as USUAL_FABRIC};
pub use sim::laboratory::bench as lab;
pub use sim::{Fabric, Monitor, Stage, Step};
