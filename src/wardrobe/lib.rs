//! The wardrobe: the catalogue of subjects, styles, sizes and fabrics with their revisions, and patterns with their seams:
//! checked, proposed, edited, decided question by question.

pub mod catalogue;
pub mod cross;
pub mod evaluate;
pub mod seams;
#[cfg(test)]
mod tests;

pub use catalogue::{
    Deed, FabricRow, Imported, Mode, Part, Removed, Saved, ScanGiven, SizeRow, Strictness, StyleGiven, SubjectRow,
    doubts, is_doubtful, percentile, percentile_text, with_bending,
};
pub use cross::{Opened, Wardrobe};
