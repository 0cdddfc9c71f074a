//! Steps of work on a seam file.

use pattern::seam_edit::Edit;
use store::files::SourceFile;

/// One step of work on a seam file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeamStep {
    /// Edit a seam, an edge or a piece.
    Edit(Edit),
    /// Confirm the proposed seam of a name.
    Confirm(String),
    /// Confirm all proposed seams that are sure.
    ConfirmSure,
    /// Answer a question of a proposal. Seams are proposed anew, and those that were confirmed and are proposed again
    /// stay so.
    Answer {
        /// The question, as it is asked.
        question: String,
        /// Index of the choice.
        choice: usize,
    },
    /// Take a seam file that was written by hand.
    Written(SourceFile),
    /// Settle a question of a proposal, since the file is as it should be.
    Decide(String),
    /// Propose all seams anew, for the style of a name.
    Propose(String),
}
