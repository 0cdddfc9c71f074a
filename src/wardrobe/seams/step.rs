//! Steps of work on a seam file.

use pattern::seam_edit::Edit;
use store::files::SourceFile;

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamStep {
    Edit(Edit),
    /// Name of a proposed seam.
    Confirm(String),
    ConfirmSure,
    /// Answer a question of a proposal. Seams are proposed again with the answer. Confirmed seams that come back stay
    /// confirmed.
    Answer {
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
