//! Messages that arrive at the event loop.

use std::path::PathBuf;

use crossterm::event::{KeyEvent, MouseEvent};

use crate::messages::alterations::AlterRequest;
use crate::messages::effect::Writing;
use crate::messages::seams::{LayoutRequest, PreviewRequest, Previewed, SeamWork, SizeLayout};
use crate::messages::snapshot::Snapshot;
use crate::widgets::picture::{Drawn, PictureRequest};
use crate::widgets::result_table::ResultTable;
use advice::Alteration;
use results::{CrossSection, ReportRow};
use spec::bodies::Girths;
use store::files::SourceFile;
use store::{JobId, LiveFrame, Relation, SavedQuery, SubjectId};

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
    Done(String),
    /// A form is saved, or why not.
    Saved(Result<String, String>),
    /// A subject's body is built and measured, or could not be.
    Measured(SubjectId, Result<Box<Girths>, String>),
    /// A size is laid out, or could not be.
    LaidOut(Box<LayoutRequest>, Result<Box<SizeLayout>, String>),
    /// The seam file of a size after a step of work, or why there is none.
    Sewn(Box<SeamWork>, Result<SourceFile, String>),
    /// A size is sewn and draped coarsely, or could not be.
    Previewed(Box<PreviewRequest>, Result<Previewed, String>),
    /// The seams of a style are saved, or why not.
    SeamsSaved(String, SourceFile, Result<String, String>),
    /// A picture is drawn, or could not be.
    Picture(PictureRequest, Result<Drawn, String>),
    /// Body and cloth of some results are cut at all levels, or could not be.
    Cut(Vec<JobId>, Result<Vec<CrossSection>, String>),
    /// The change of a size is found, or could not be.
    Altered(Box<AlterRequest>, Result<Box<Alteration>, String>),
    /// Tables and views that a query may name, and the saved queries.
    Names(Vec<Relation>, Vec<SavedQuery>),
    /// A query is answered after so many ms, or refused.
    Answered(u64, Result<Box<ResultTable>, String>),
    /// The reports there are.
    Reports(Vec<ReportRow>),
    /// A report is built, its page here, or could not be; and the reports there are now.
    ReportBuilt(Result<PathBuf, String>, Vec<ReportRow>),
    /// A new study of a name is written, its file here, or could not be.
    StudyCreated(String, Result<PathBuf, String>),
    /// The garment of the watched job as it is now.
    Live(LiveFrame),
    /// The text that the user has written in an editor of their own, or why it was not taken.
    Written(Box<Writing>, Result<String, String>),
    /// The mouse did something.
    Mouse(MouseEvent),
    /// The run started here has ended.
    RunEnded(Result<String, String>),
    /// The terminal is gone.
    Hangup,
    /// The process is asked to end.
    Terminate,
}
