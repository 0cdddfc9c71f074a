//! Errors of queries on results.

use std::path::PathBuf;

use store::{JobId, Origin, StudyError};

#[derive(Debug, thiserror::Error)]
pub(crate) enum ResultsError {
    #[error("the body has no vertices")]
    EmptyBody,
    #[error("{}: {reason}; accepted: PNG and JPEG", file.display())]
    NoImage { file: PathBuf, reason: image::ImageError },
    #[error("the mesh of job {0} does not fit its drape")]
    OtherMesh(JobId),
    /// A job without an input that is needed to repeat it.
    #[error("job {0} has no mesh.edge_length_mm")]
    NoEdgeLength(JobId),
    #[error("{0}")]
    Parameters(String),
    #[error("its body is a scan, of which an older program kept nothing; run its study again")]
    ScanNotKept,
    #[error("it is a layer of an outfit, which is draped as a whole; run its study again")]
    Layer,
    /// A drape that was carried from another pose, which the job does not store.
    #[error("its body carried it from another pose; run its study again")]
    Carried,
}

impl From<ResultsError> for StudyError {
    fn from(error: ResultsError) -> Self {
        let origin = match error {
            ResultsError::EmptyBody | ResultsError::NoImage { .. } => Origin::Render,
            ResultsError::OtherMesh(_) => Origin::Store,
            ResultsError::NoEdgeLength(_)
            | ResultsError::Parameters(_)
            | ResultsError::ScanNotKept
            | ResultsError::Layer
            | ResultsError::Carried => Origin::Rerun,
        };
        Self::refused(origin, error)
    }
}
