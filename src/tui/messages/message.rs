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

#[derive(Debug)]
pub enum Message {
    Key(KeyEvent),
    /// Columns by rows.
    Resize(u16, u16),
    Data(Box<Snapshot>),
    Failed(String),
    /// An action on the queue is done, in words.
    Done(String),
    /// Outcome for the entry of a form.
    Saved(Result<String, String>),
    /// Comment of a fitting is changed, with a line about it.
    Commented(FittingOf, Box<Change>, String),
    Measured(SubjectId, Result<Box<Girths>, String>),
    LaidOut(Box<LayoutRequest>, Result<Box<SizeLayout>, String>),
    /// Seam file of a size after a step of work.
    Sewn(Box<SeamWork>, Result<SourceFile, String>),
    Previewed(Box<PreviewRequest>, Result<Previewed, String>),
    /// Outcome of saving seams; begins with the name of the style.
    SeamsSaved(String, SourceFile, Result<String, String>),
    Picture(PictureRequest, Result<Drawn, String>),
    /// Cross sections of results at all levels.
    Cut(Vec<JobId>, Result<Vec<CrossSection>, String>),
    Altered(Box<AlterRequest>, Result<Box<Alteration>, String>),
    Names(Vec<Relation>, Vec<SavedQuery>),
    /// Rows of a query; begins with the time it took, ms.
    Answered(u64, Result<Box<ResultTable>, String>),
    Reports(Vec<ReportRow>),
    /// Part of the report that is being built, in words.
    ReportPart(String),
    /// Path of the report's page; then all reports.
    ReportBuilt(Result<PathBuf, String>, Vec<ReportRow>),
    /// Name of the new study, and path of its file.
    StudyCreated(String, Result<PathBuf, String>),
    Live(LiveFrame),
    Written(Box<Writing>, Result<String, String>),
    Mouse(MouseEvent),
    RunEnded(Result<String, String>),
    /// Place to which a text was copied, in words.
    Copied(Result<String, String>),
    /// The message in the status line was there for long enough.
    Faded,
    Hangup,
    Terminate,
}
