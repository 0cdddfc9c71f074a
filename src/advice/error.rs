//! Errors of advice.

use std::ops::RangeInclusive;

use store::{Origin, StudyError};

/// An error of advice.
#[derive(Debug, thiserror::Error)]
pub(crate) enum AdviceError {
    /// A nest of a pattern that holds its own seams.
    #[error("{pattern}: holds its own seams; accepted for a nest: DXF with a seam file")]
    NestWithoutSeams { pattern: String },
    /// A garment without a size.
    #[error("the garment has no size")]
    NoSize,
    /// A size that the question does not cover.
    #[error("no such size")]
    UnknownSize,
    /// A thread that ended without an answer.
    #[error("a thread ended early")]
    LostThread,
    /// A graded pattern that holds its own seams.
    #[error("{pattern}: holds its own seams; accepted: DXF with a seam file")]
    GradeWithoutSeams { pattern: String },
    /// A garment without subjects or sizes.
    #[error("{garment}: nobody wears it; accepted: a garment with subjects and sizes")]
    NotWorn { garment: String },
    /// A count out of its range.
    #[error("{count} {of}; accepted: {} to {}", accepted.start(), accepted.end())]
    Count { count: usize, of: &'static str, accepted: RangeInclusive<usize> },
    /// A share outside of 0 to 1.
    #[error("a share of {share} draped; accepted: 0 to 1")]
    Share { share: f64 },
    /// A first person whose body cannot be built.
    #[error("the first of the people cannot be built")]
    NoFirstPerson,
    /// A garment without a target for its ease.
    #[error("{garment}: no level has a target; accepted: target_ease_mm of a level")]
    NoTarget { garment: String },
    /// A style whose handles widen no level that has a target.
    #[error("{style}: no handle widens a level that has a target; there is: {handles}")]
    NoHandle { style: String, handles: String },
    /// A piece that the grade rules make different from its drawing.
    #[error("piece `{piece}` of size {size}: the rules make it {apart_mm:.2} mm off; accepted: {accepted_mm} mm")]
    OtherPiece { piece: String, size: String, apart_mm: f64, accepted_mm: f64 },
    /// A grading without a size.
    #[error("no size")]
    EmptyNest,
}

impl From<AdviceError> for StudyError {
    fn from(error: AdviceError) -> Self {
        let origin = match error {
            AdviceError::NestWithoutSeams { .. } => Origin::Alter,
            AdviceError::NoSize | AdviceError::UnknownSize | AdviceError::LostThread => Origin::Chance,
            _ => Origin::Grade,
        };
        Self::refused(origin, error)
    }
}
