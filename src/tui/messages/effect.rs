//! Effects: work that the event loop hands to threads and the terminal.

use crate::messages::alterations::AlterRequest;
use crate::messages::comments::RoundRequest;
use crate::messages::requests::{Command, FileTask, QueryRequest, Target};
use std::path::PathBuf;

use crate::messages::seams::{LayoutRequest, PreviewRequest, SeamTask};
use crate::messages::snapshot::Focus;
use crate::widgets::picture::PictureRequest;
use store::JobId;
use store::files::SourceFile;

/// A text to be written in the user's editor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Writing {
    Query(String),
    Seams(LayoutRequest, SourceFile),
    /// File at a path, edited in place.
    File(PathBuf),
}

/// Work that the event loop hands on.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    Read(Focus),
    Draw(Vec<PictureRequest>),
    /// Cut body and cloth of results into cross sections.
    Cut(Vec<JobId>),
    Alter(AlterRequest),
    Round(RoundRequest),
    Query(QueryRequest),
    StopQuery,
    Files(FileTask),
    /// Watch a job of the run; `None` watches none.
    Watch(Option<JobId>),
    /// Capture the mouse, or release it.
    Mouse(bool),
    Seams(SeamTask),
    /// Sew and drape a size coarsely.
    Preview(PreviewRequest),
    Do(Command),
    Run(Target),
    StopRun,
    /// Leave the workbench, and let a process of its own go on with the run.
    LeaveRunning(Target),
    /// Ring, and notify a user who looks elsewhere.
    Notify(String),
    Suspend,
    Write(Writing),
    Copy(String),
    /// Draw the whole screen again.
    Clear,
    Quit,
}
