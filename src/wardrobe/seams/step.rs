//! Steps of work on a seam file.

use pattern::seam_edit::Edit;
use store::files::SourceFile;

/// One step of work on a seam file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamStep {
    /// Add, remove or turn a seam; leave an edge open or a piece out; say what a piece is.
    Edit(Edit),
    /// Take a proposed seam, by its name, for right.
    Confirm(String),
    /// Take all proposed seams that are sure for right.
    ConfirmSure,
    /// Answer a question of a proposal: propose anew, and keep what was confirmed of what is proposed again.
    Answer {
        /// The question, as it is asked.
        question: String,
        /// The place of the choice.
        choice: usize,
    },
    /// Take a seam file that was written by hand.
    Written(SourceFile),
    /// Strike a question of a proposal out, its answer being in the file.
    Decide(String),
    /// Propose all seams anew; the text is the name of the style.
    Propose(String),
}
