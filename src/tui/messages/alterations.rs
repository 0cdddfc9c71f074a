//! Requests to the threads that find alterations of a pattern.

use std::path::PathBuf;

/// Request for the alteration of a size so that it fits a subject.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AlterRequest {
    pub study: PathBuf,
    pub garment: String,
    pub subject: String,
    pub size: String,
    /// True if the altered pattern is to be draped.
    pub is_draped: bool,
}

impl AlterRequest {
    /// True if another request is for the same garment on the same subject, in any size.
    pub fn is_for_same(&self, other: &Self) -> bool {
        (&self.study, &self.garment, &self.subject) == (&other.study, &other.garment, &other.subject)
    }
}
