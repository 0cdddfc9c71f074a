//! Errors of advice.

use std::ops::RangeInclusive;

use store::{Origin, StudyError};

#[derive(Debug, thiserror::Error)]
pub(crate) enum AdviceError {
    #[error("{pattern}: holds its own seams; accepted for a nest: DXF with a seam file")]
    NestWithoutSeams { pattern: String },
    #[error("the garment has no size")]
    NoSize,
    #[error("no such size")]
    UnknownSize,
    #[error("a thread ended early")]
    LostThread,
    #[error("{pattern}: holds its own seams; accepted: DXF with a seam file")]
    GradeWithoutSeams { pattern: String },
    #[error("{garment}: nobody wears it; accepted: a garment with subjects and sizes")]
    NotWorn { garment: String },
    #[error("{count} {of}; accepted: {} to {}", accepted.start(), accepted.end())]
    Count { count: usize, of: &'static str, accepted: RangeInclusive<usize> },
    /// A share outside of 0 to 1.
    #[error("a share of {share} draped; accepted: 0 to 1")]
    Share { share: f64 },
    /// A first person whose body cannot be built.
    #[error("the first of the people cannot be built")]
    NoFirstPerson,
    #[error("{garment}: no level has a target; accepted: target_ease_mm of a level")]
    NoTarget { garment: String },
    /// A style whose handles widen no level that has a target.
    #[error("{style}: no handle widens a level that has a target; there is: {handles}")]
    NoHandle { style: String, handles: String },
    #[error("piece `{piece}` of size {size}: the rules make it {apart_mm:.2} mm off; accepted: {accepted_mm} mm")]
    OtherPiece { piece: String, size: String, apart_mm: f64, accepted_mm: f64 },
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
