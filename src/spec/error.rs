//! Errors of patterns that are read without a study.

use std::path::PathBuf;

use store::{Origin, StudyError};

/// Reason why a pattern is refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SpecError {
    /// A folder without a pattern.
    #[error(
        "{}: found {others} files, none of them a pattern; accepted: DXF, GarmentCode JSON, features as JSON",
        folder.display()
    )]
    NoPattern {
        /// Path of the folder.
        folder: PathBuf,
        /// Number of files in the folder.
        others: usize,
    },
    /// A size that a pattern does not hold.
    #[error("{pattern}: no size `{size}`; accepted: one of {sizes}")]
    NoSize {
        /// Name of the file.
        pattern: String,
        /// Size that was asked for.
        size: String,
        /// Sizes of the file.
        sizes: String,
    },
    /// A pattern without seams, and no seam file.
    #[error("{pattern}: holds no seams; give its seam file (`seams`, or --seams FILE)")]
    NoSeams {
        /// Name of the pattern.
        pattern: String,
    },
    /// A style without pieces.
    #[error(
        "{pattern}: found no piece to sew; accepted: at least one piece (`toile pattern propose` proposes what it recognises)"
    )]
    NoPiece {
        /// Name of the pattern.
        pattern: String,
    },
    /// Pieces that are too small or too large for a person.
    #[error(
        "{pattern}: found a longest piece of {longest_m:.2} m; accepted: 0.08 to 6 m for a person; the unit of the file is wrong"
    )]
    Scale {
        /// Name of the pattern.
        pattern: String,
        /// Greatest extent of a piece, m.
        longest_m: f64,
    },
    /// A mesh without triangles.
    #[error("no triangles")]
    NoTriangles,
}

impl From<SpecError> for StudyError {
    fn from(error: SpecError) -> Self {
        let origin = match error {
            SpecError::NoTriangles => Origin::Mesh,
            _ => Origin::Pattern,
        };
        Self::refused(origin, error)
    }
}
