//! Requests to the threads that find changes of a pattern.

use std::path::PathBuf;

/// A size that is to fit a subject.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AlterRequest {
    /// File of the study.
    pub study: PathBuf,
    /// Name of the garment in the study.
    pub garment: String,
    /// The subject that is to wear it.
    pub subject: String,
    /// Size that is changed.
    pub size: String,
    /// True where the changed pattern is draped.
    pub is_draped: bool,
}

impl AlterRequest {
    /// True if it asks for the same garment on the same subject, whatever the size.
    #[must_use]
    pub fn is_for_same(&self, other: &Self) -> bool {
        (&self.study, &self.garment, &self.subject) == (&other.study, &other.garment, &other.subject)
    }
}
