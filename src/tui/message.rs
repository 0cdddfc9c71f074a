//! What arrives at the event loop and what it asks for: two closed sets, so that all of the workbench is
//! `(state, message) -> (state, effects)`.

use std::path::PathBuf;

use crossterm::event::{KeyEvent, MouseEvent};

use super::asker::Question;
use super::clerk::Errand;
use super::feed::{Focus, Snapshot};
use super::picture::{Drawn, Shot};
use super::sheet::Sheet;
use super::tailor::{Laid, Laying, Task};
use study::bodies::Girths;
use study::files::SourceFile;
use study::{Given, JobId, LiveFrame, Mode, Part, Relation, ReportRow, SavedQuery, StyleGiven, SubjectId};

/// Something that happened.
#[derive(Debug)]
pub enum Message {
    /// A key was pressed.
    Key(KeyEvent),
    /// The terminal has a new size, columns by rows.
    Resize(u16, u16),
    /// The database was read.
    Data(Box<Snapshot>),
    /// Something could not be read or done.
    Failed(String),
    /// An action on the queue is done.
    Acted(String),
    /// What was filled in is saved, or why not.
    Saved(Result<String, String>),
    /// A subject's body is built and measured, or could not be.
    Measured(SubjectId, Result<Box<Girths>, String>),
    /// A size is laid out, or could not be.
    LaidOut(Box<Laying>, Result<Box<Laid>, String>),
    /// The seam file of a style after a step of work, or why there is none.
    Sewn(String, Result<SourceFile, String>),
    /// The seams of a style are saved, or why not.
    SeamsSaved(String, SourceFile, Result<String, String>),
    /// A picture is drawn, or could not be.
    Picture(Shot, Result<Drawn, String>),
    /// What a query may name, and the saved queries.
    Names(Vec<Relation>, Vec<SavedQuery>),
    /// A query is answered after so many ms, or refused.
    Answered(u64, Result<Box<Sheet>, String>),
    /// The reports there are.
    Reports(Vec<ReportRow>),
    /// A report is built, its page here, or could not be; and the reports there are now.
    ReportBuilt(Result<PathBuf, String>, Vec<ReportRow>),
    /// A new study of a name is written, its file here, or could not be.
    StudyCreated(String, Result<PathBuf, String>),
    /// The garment of the watched job as it is now.
    Live(LiveFrame),
    /// The mouse did something.
    Mouse(MouseEvent),
    /// The run started here has ended.
    RunEnded(Result<String, String>),
    /// The terminal is gone.
    Hangup,
    /// The process is asked to end.
    Terminate,
}

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

/// An action on the queue or the catalogue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Act {
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

impl Act {
    /// Whether a form waits for the answer.
    #[must_use]
    pub fn is_filled_in(&self) -> bool {
        matches!(self, Self::Save(..) | Self::Import(..) | Self::ImportStyle(..))
    }
}

/// What to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// The study that comes with the program.
    Quickstart,
    /// A study file.
    Study(PathBuf),
}
