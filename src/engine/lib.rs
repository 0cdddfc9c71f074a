//! The engine: jobs are queued, claimed and worked on. `pipeline` turns one job into one result; `workers` claim jobs;
//! `isolated` runs a job with limits in a process of its own; [`handout`] and [`slurm`] let other machines work.
//!
//! # Examples
//! ```
//! use spec::{Selection, new_study::write_quickstart};
//! use wardrobe::catalogue;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = tempfile::tempdir()?;
//! write_quickstart(folder.path())?;
//! let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false)?;
//! let study = engine::run::load_study(&store, folder.path())?;
//!
//! // Nothing is simulated yet: `run::start` does that.
//! let fem = Selection { simulators: vec!["fem".into()], ..Selection::default() };
//! let planned = engine::run::plan(&mut store, &study, &fem)?;
//! assert_eq!(planned.len(), 6);
//! # Ok(())
//! # }
//! ```

pub mod actions;
pub mod assessment;
pub mod attempt;
mod carry;
pub mod compose;
pub mod ease;
mod ending;
pub mod enqueue;
mod error;
pub mod faults;
pub mod fitting;
pub mod handout;
mod isolated;
mod job_files;
mod layers;
pub mod outcome;
mod outfits;
mod own_process;
mod pipeline;
mod reach;
pub mod run;
pub mod slurm;
pub mod stages;
#[cfg(test)]
mod tests;
pub mod tight;
mod workers;

pub use actions::why_no_retry;
pub use assessment::{Assessment, Level, Pressing};
pub use attempt::{
    Attempt, AttemptLayer, Tried, TriedChi, TriedCloth, TriedEase, TriedErrors, TriedGap, attempt,
    fabric as fabric_named,
};
pub use compose::{NewStudy, PatternSource, Wearable, wearables};
pub use ending::{Ending, notification};
pub use enqueue::{Planned, Why};
pub use handout::{HandedOut, Merged, Ran, run_job};
pub use outcome::{Executor, Measured, MeasuredPoint, Outcome};
pub use outfits::NewOutfit;
pub use pipeline::Pipeline;
pub use reach::{Reached, ReachedAt, ReachedOpening};
pub use run::{Run, RunOptions};
pub use slurm::{SlurmOptions, SlurmRun};
