//! Requests to the threads.

use std::path::PathBuf;

use crate::messages::comments::{CommentDeed, FittingOf};
use engine::NewStudy;
use spec::Given;
use store::JobId;
use store::files::SourceFile;
use wardrobe::{Mode, Part, StyleGiven};

/// A change of the queue or the catalogue.
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
    /// Save the seams of a style, with its name.
    SaveSeams(String, SourceFile),
    /// Write seams to a file whose contents are still those given first.
    WriteSeams(PathBuf, SourceFile, SourceFile),
    /// Change the comments of a fitting.
    Comment(FittingOf, CommentDeed),
    /// Cancel jobs.
    Cancel(Vec<JobId>),
    /// Queue jobs again.
    Retry(Vec<JobId>),
    /// Change the priority of a job by a step.
    Prioritise(JobId, i64),
    /// Pause a study.
    Pause(String),
    /// Resume a study.
    Resume(String),
}

impl Command {
    /// True if a form waits for the outcome.
    pub fn is_from_form(&self) -> bool {
        matches!(self, Self::Save(..) | Self::Import(..) | Self::ImportStyle(..) | Self::Comment(..))
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

/// A request to the thread that answers queries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum QueryRequest {
    /// Names of tables and views, and the saved queries.
    Names,
    /// Rows of a query.
    Rows(String),
    /// Save a query under a name.
    Save(String, String),
    /// Rename a saved query: old name, new name.
    Rename(String, String),
    /// Write the rows of a query to a file.
    Export(String, PathBuf),
}

/// A task for the thread that writes files.
#[derive(Clone, Debug, PartialEq)]
pub enum FileTask {
    /// List the reports.
    ListReports,
    /// Build the report of a study.
    BuildReport(String),
    /// Write a new study.
    CreateStudy(NewStudy),
    /// Write files, by name, into a folder that has none of them.
    Write(PathBuf, Vec<(String, Vec<u8>)>),
}
