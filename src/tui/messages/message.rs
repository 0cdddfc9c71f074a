//! Messages that the event loop receives.

use std::path::PathBuf;

use crossterm::event::{KeyEvent, MouseEvent};

use crate::messages::alterations::AlterRequest;
use crate::messages::comments::{Change, FittingOf};
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

/// An event or an answer.
#[derive(Debug)]
pub enum Message {
    /// A key was pressed.
    Key(KeyEvent),
    /// The terminal has a new size, columns by rows.
    Resize(u16, u16),
    /// The database was read.
    Data(Box<Snapshot>),
    /// Reading or work failed, with the reason.
    Failed(String),
    /// An action on the queue is done, in words.
    Done(String),
    /// Entry of a form is saved, or the reason why not.
    Saved(Result<String, String>),
    /// Comment of a fitting is changed, with a line about it.
    Commented(FittingOf, Box<Change>, String),
    /// Subject's body is built and measured, or the reason why not.
    Measured(SubjectId, Result<Box<Girths>, String>),
    /// Size is laid out, or the reason why not.
    LaidOut(Box<LayoutRequest>, Result<Box<SizeLayout>, String>),
    /// Seam file of a size after a step of work, or the reason why there is none.
    Sewn(Box<SeamWork>, Result<SourceFile, String>),
    /// Size is sewn and draped coarsely, or the reason why not.
    Previewed(Box<PreviewRequest>, Result<Previewed, String>),
    /// Seams of a style are saved, or the reason why not.
    SeamsSaved(String, SourceFile, Result<String, String>),
    /// Picture is drawn, or the reason why not.
    Picture(PictureRequest, Result<Drawn, String>),
    /// Cross sections of results at all levels, or the reason why there are none.
    Cut(Vec<JobId>, Result<Vec<CrossSection>, String>),
    /// Alteration of a size, or the reason why there is none.
    Altered(Box<AlterRequest>, Result<Box<Alteration>, String>),
    /// Tables and views that a query may name, and saved queries.
    Names(Vec<Relation>, Vec<SavedQuery>),
    /// Query is answered, or refused for a reason, after a time in ms.
    Answered(u64, Result<Box<ResultTable>, String>),
    /// All reports.
    Reports(Vec<ReportRow>),
    /// Part of the report that is being built, in words.
    ReportPart(String),
    /// Report is built, with the path of its page, or the reason why not; then all reports.
    ReportBuilt(Result<PathBuf, String>, Vec<ReportRow>),
    /// New study is written, with its name and the path of its file, or the reason why not.
    StudyCreated(String, Result<PathBuf, String>),
    /// Present shape of the watched job's garment.
    Live(LiveFrame),
    /// Text from the user's editor, or the reason why there is none.
    Written(Box<Writing>, Result<String, String>),
    /// Mouse event.
    Mouse(MouseEvent),
    /// Run that was started here has ended.
    RunEnded(Result<String, String>),
    /// A text was copied, with its place in words, or the reason why not.
    Copied(Result<String, String>),
    /// The message in the status line was there for long enough.
    Faded,
    /// The terminal is gone.
    Hangup,
    /// The process is asked to end.
    Terminate,
}
