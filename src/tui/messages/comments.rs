//! Work on the comments of a fitting.

use std::path::PathBuf;

use store::comments::{Comment, Edit, Remark};

/// A garment on a subject, of a study, by their names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FittingOf {
    /// Name of the study.
    pub study: String,
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the subject in the study.
    pub subject: String,
}

/// A change of the comments of a fitting.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommentDeed {
    /// Add a fitter's comment to the last round.
    Add(Remark),
    /// Change the comment of a number.
    Set(Box<Change>),
    /// Sign the last round off, with a name.
    Sign(String),
}

/// A change of a comment, and the change that takes it back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// Number of the comment.
    pub number: i64,
    /// New values.
    pub edit: Edit,
    /// Values as they were; `None` for a change that takes another one back.
    pub before: Option<Edit>,
}

impl Change {
    /// A change of a comment that can be taken back.
    pub fn of(comment: &Comment, edit: Edit) -> Self {
        Self { number: comment.number, before: Some(edit.before(comment)), edit }
    }
}

/// A fitting whose next round is to begin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoundRequest {
    /// Path of the study file.
    pub study: PathBuf,
    /// Fitting.
    pub of: FittingOf,
}
