//! What the event loop has others do.

use crate::messages::requests::{Act, Errand, Question, Target};
use crate::messages::seams::Task;
use crate::messages::snapshot::Focus;
use crate::widgets::picture::Shot;
use study::JobId;

/// Something the event loop has others do.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Read what the screens show.
    Read(Focus),
    /// Draw pictures.
    Paint(Vec<Shot>),
    /// Ask the database.
    Ask(Question),
    /// Stop what it is asked.
    StopAsking,
    /// Do what takes long and writes files.
    Errand(Errand),
    /// Watch a job of the run, or none.
    Watch(Option<JobId>),
    /// Take the mouse or give it back.
    Mouse(bool),
    /// Work on seams.
    Desk(Task),
    /// Act on the queue or the catalogue.
    Do(Act),
    /// Run a study in the background.
    Run(Target),
    /// Ask the run to stop.
    StopRun,
    /// Put a text on the clipboard.
    Copy(String),
    /// Draw the whole screen anew.
    Clear,
    /// Leave.
    Quit,
}
