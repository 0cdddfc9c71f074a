//! Requests to the threads.

use std::path::PathBuf;

use engine::NewStudy;
use spec::Given;
use store::JobId;
use store::files::SourceFile;
use wardrobe::{Mode, Part, StyleGiven};

/// An action on the queue or the catalogue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Command {
    /// Add or edit a subject or a fabric.
    Save(Part, Mode, String, Vec<Given>),
    /// Import the subjects or fabrics of a file.
    Import(Part, PathBuf),
    /// Remove an entry.
    Remove(Part, String),
    /// Add a style or sizes of it, or the styles of a study file.
    ImportStyle(String, StyleGiven),
    /// Save the seams of a style.
    SaveSeams(String, SourceFile),
    /// Write seams over a file that still says what it said before.
    WriteSeams(PathBuf, SourceFile, SourceFile),
    /// Cancel a job.
    Cancel(JobId),
    /// Queue a job again.
    Retry(JobId),
    /// Change a job's priority by a step.
    Prioritise(JobId, i64),
    /// Pause a study.
    Pause(String),
    /// Resume a study.
    Resume(String),
}

impl Command {
    /// True if a form waits for the answer.
    #[must_use]
    pub fn is_from_form(&self) -> bool {
        matches!(self, Self::Save(..) | Self::Import(..) | Self::ImportStyle(..))
    }
}

/// A study to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// The study that comes with the program.
    Quickstart,
    /// A study file.
    Study(PathBuf),
}

/// A request to the thread of queries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum QueryRequest {
    /// Tables and views that a query may name, and the saved queries.
    Names,
    /// The rows of a query.
    Rows(String),
    /// A query under a name, for good.
    Save(String, String),
    /// Another name of a saved query: the one it has, and the one it gets.
    Rename(String, String),
    /// The rows of a query in a file.
    Export(String, PathBuf),
}

/// A task for the thread of files.
#[derive(Clone, Debug, PartialEq)]
pub enum FileTask {
    /// List the reports there are.
    ListReports,
    /// Build the report of a study.
    BuildReport(String),
    /// Write a new study.
    CreateStudy(NewStudy),
    /// Write files, by their names, into a folder that has none of them.
    Write(PathBuf, Vec<(String, Vec<u8>)>),
}
