//! Effects that the event loop has others carry out.

use crate::messages::alterations::AlterRequest;
use crate::messages::requests::{Command, FileTask, QueryRequest, Target};
use std::path::PathBuf;

use crate::messages::seams::{LayoutRequest, PreviewRequest, SeamTask};
use crate::messages::snapshot::Focus;
use crate::widgets::picture::PictureRequest;
use store::JobId;
use store::files::SourceFile;

/// A text that is written in an editor of the user's own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Writing {
    /// The query of the SQL screen.
    Query(String),
    /// The seam file of a size.
    Seams(LayoutRequest, SourceFile),
    /// A file as it lies.
    File(PathBuf),
}

/// Something the event loop has others do.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Read what the screens show.
    Read(Focus),
    /// Draw drapes and bodies as pictures.
    Draw(Vec<PictureRequest>),
    /// Cut the bodies and the cloth of results.
    Cut(Vec<JobId>),
    /// Find what to change of a size.
    Alter(AlterRequest),
    /// Ask the database.
    Query(QueryRequest),
    /// Stop the query that it is asked.
    StopQuery,
    /// Do what takes long and writes files.
    Files(FileTask),
    /// Watch a job of the run, or none.
    Watch(Option<JobId>),
    /// Take the mouse or give it back.
    Mouse(bool),
    /// Work on seams.
    Seams(SeamTask),
    /// Sew and drape a size coarsely.
    Preview(PreviewRequest),
    /// Act on the queue or the catalogue.
    Do(Command),
    /// Run a study in the background.
    Run(Target),
    /// Ask the run to stop.
    StopRun,
    /// Have the user write in an editor of their own.
    Write(Writing),
    /// Put a text on the clipboard.
    Copy(String),
    /// Draw the whole screen anew.
    Clear,
    /// Leave the workbench.
    Quit,
}
