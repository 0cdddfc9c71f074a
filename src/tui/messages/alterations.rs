//! Requests to the threads that find alterations of a pattern.

use std::path::PathBuf;

/// Request for the alteration of a size so that it fits a subject.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AlterRequest {
    /// Path of the study file.
    pub study: PathBuf,
    /// Name of the garment in the study.
    pub garment: String,
    /// Name of the subject in the study.
    pub subject: String,
    /// Name of the size to alter.
    pub size: String,
    /// True if the altered pattern is draped.
    pub is_draped: bool,
}

impl AlterRequest {
    /// True if another request is for the same garment on the same subject, in any size.
    #[must_use]
    pub fn is_for_same(&self, other: &Self) -> bool {
        (&self.study, &self.garment, &self.subject) == (&other.study, &other.garment, &other.subject)
    }
}
