//! Errors of patterns that are read without a study.

use std::path::PathBuf;

use store::{Origin, StudyError};

#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SpecError {
    #[error(
        "{}: found {others} files, none of them a pattern; accepted: DXF, GarmentCode JSON, features as JSON",
        folder.display()
    )]
    NoPattern { folder: PathBuf, others: usize },
    #[error("{pattern}: no size `{size}`; accepted: one of {sizes}")]
    NoSize { pattern: String, size: String, sizes: String },
    #[error("{pattern}: holds no seams; give its seam file (`seams`, or --seams FILE)")]
    NoSeams { pattern: String },
    #[error(
        "{pattern}: found no piece to sew; accepted: at least one piece (`toile pattern propose` proposes what it recognises)"
    )]
    NoPiece { pattern: String },
    #[error(
        "{pattern}: found a longest piece of {longest_m:.2} m; accepted: 0.08 to 6 m for a person; the unit of the file is wrong"
    )]
    Scale {
        pattern: String,
        /// Greatest extent of a piece.
        longest_m: f64,
    },
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
