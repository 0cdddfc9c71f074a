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
    Import(Part, PathBuf),
    Remove(Part, String),
    /// Add a style or sizes of it, or the styles of a study file.
    ImportStyle(String, StyleGiven),
    /// Save the seams of the style of a name.
    SaveSeams(String, SourceFile),
    /// Write seams to a file whose contents are still those given first.
    WriteSeams(PathBuf, SourceFile, SourceFile),
    Comment(FittingOf, CommentDeed),
    Cancel(Vec<JobId>),
    Retry(Vec<JobId>),
    /// Change the priority of a job by a step.
    Prioritise(JobId, i64),
    Pause(String),
    Resume(String),
}

impl Command {
    /// True if a form waits for the outcome.
    pub fn is_from_form(&self) -> bool {
        matches!(self, Self::Save(..) | Self::Import(..) | Self::ImportStyle(..) | Self::Comment(..))
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    Quickstart,
    Study(PathBuf),
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum QueryRequest {
    Names,
    Rows(String),
    /// Save a query under a name.
    Save(String, String),
    /// Rename a query: old name, new name.
    Rename(String, String),
    Export(String, PathBuf),
}

#[derive(Clone, Debug, PartialEq)]
pub enum FileTask {
    ListReports,
    BuildReport(String),
    CreateStudy(NewStudy),
    /// Write files, by name, into a folder that has none of them.
    Write(PathBuf, Vec<(String, Vec<u8>)>),
}
