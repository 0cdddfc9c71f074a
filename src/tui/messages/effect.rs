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
    /// Query of the SQL screen.
    Query(String),
    /// Seam file of a size.
    Seams(LayoutRequest, SourceFile),
    /// File at a path, edited in place.
    File(PathBuf),
}

/// Work that the event loop hands on.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Read the data that the screens show.
    Read(Focus),
    /// Draw drapes and bodies as pictures.
    Draw(Vec<PictureRequest>),
    /// Cut body and cloth of results into cross sections.
    Cut(Vec<JobId>),
    /// Find the alteration of a size.
    Alter(AlterRequest),
    /// Begin the next round of a fitting.
    Round(RoundRequest),
    /// Answer a query.
    Query(QueryRequest),
    /// Stop the query that runs.
    StopQuery,
    /// Do slow work that writes files.
    Files(FileTask),
    /// Watch a job of the run; `None` watches none.
    Watch(Option<JobId>),
    /// Capture the mouse, or release it.
    Mouse(bool),
    /// Work on the seams of a size.
    Seams(SeamTask),
    /// Sew and drape a size coarsely.
    Preview(PreviewRequest),
    /// Change the queue or the catalogue.
    Do(Command),
    /// Run a study in the background.
    Run(Target),
    /// Ask the run to stop.
    StopRun,
    /// Leave the workbench, and let a process of its own go on with the run.
    LeaveRunning(Target),
    /// Ring, and notify a user who looks elsewhere.
    Notify(String),
    /// Give the terminal back until the shell continues the program.
    Suspend,
    /// Open a text in the user's editor.
    Write(Writing),
    /// Copy a text to the clipboard.
    Copy(String),
    /// Draw the whole screen again.
    Clear,
    /// Leave the workbench.
    Quit,
}
