//! Steps of work on a seam file.

use pattern::seam_edit::Edit;
use store::files::SourceFile;

/// One step of work on a seam file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamStep {
    /// Edit a seam, an edge or a piece.
    Edit(Edit),
    /// Confirm the proposed seam with this name.
    Confirm(String),
    /// Confirm all proposed seams that count as sure.
    ConfirmSure,
    /// Answer a question of a proposal. Seams are proposed again with the answer. Confirmed seams that come back stay
    /// confirmed.
    Answer {
        /// Text of the question.
        question: String,
        /// Index of the answer.
        choice: usize,
    },
    /// Replace the file by one that was written by hand.
    Written(SourceFile),
    /// Settle the question with this text: the file is right as it is.
    Decide(String),
    /// Propose all seams again, for the style with this name.
    Propose(String),
}
