//! The specification of a study: its file, one [`JobSpec`] for every simulation, and the named [`Inputs`] that key each
//! result. Bodies and patterns are built here from their files, since a study file is checked against both.

pub mod bodies;
pub mod entry;
mod error;
pub mod export;
pub mod fields;
pub mod file;
mod inputs;
mod job;
pub mod new_study;
mod parameters;
pub mod patterns;
mod schedule;
mod sheets;
pub mod versions;

pub use entry::{Field, Given, decimal};
pub use error::SpecError;
pub use export::export_study;
pub use fields::{FABRIC_NUMBERS, MEASUREMENTS, sex};
pub use file::{Person, Study, read_measurements, study_file};
pub use inputs::{Change, Inputs};
pub use job::{
    CARRIED_FROM, Cell, JobSpec, Outfit, PATTERN_SIZE, Selection, cells, fabric_inputs, jobs, jobs_of, subject_inputs,
};
pub use new_study::{QUICKSTART, new_study, write_quickstart};
pub use parameters::{Parameters, SIMULATORS};
pub use schedule::{Limits, Schedule};
