//! Work on the comments of a fitting.

use std::path::PathBuf;

use store::comments::{Comment, Edit, Remark};

/// A garment on a subject, of a study, by their names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FittingOf {
    pub study: String,
    pub garment: String,
    pub subject: String,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommentDeed {
    /// Add a fitter's comment to the last round.
    Add(Remark),
    Set(Box<Change>),
    /// Sign the last round off, with a name.
    Sign(String),
}

/// A change of a comment, and the change that takes it back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    pub number: i64,
    pub edit: Edit,
    /// Values as they were; `None` for a change that takes another one back.
    pub before: Option<Edit>,
}

impl Change {
    pub fn of(comment: &Comment, edit: Edit) -> Self {
        Self { number: comment.number, before: Some(edit.before(comment)), edit }
    }
}

/// A fitting whose next round is to begin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoundRequest {
    pub study: PathBuf,
    pub of: FittingOf,
}
