//! The wardrobe: the catalogue of subjects, styles, sizes and fabrics with their revisions, and work on the seams of
//! patterns. Seams are checked, proposed, edited, and confirmed question by question.

pub mod catalogue;
mod cross;
mod error;
pub mod evaluate;
pub mod seams;
#[cfg(test)]
mod tests;

pub use catalogue::{
    Deed, FabricRow, Imported, Mode, Part, Removed, Saved, ScanGiven, SizeRow, Strictness, StyleGiven, SubjectRow,
    doubts, is_doubtful, percentile, percentile_text, with_bending,
};
pub use cross::{Opened, Wardrobe};
pub use error::{TableProblem, WardrobeError};
