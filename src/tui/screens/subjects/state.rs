//! State of the screen of subjects.

use std::collections::BTreeMap;

use crate::screens::order::Order;
use spec::bodies::Girths;
use store::SubjectId;

/// Measurements in the list of subjects: stature, weight, chest, waist, hip.
pub const SHOWN: usize = 5;

/// Order of subjects: by name, or by the measurement of a number in [`spec::MEASUREMENTS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SubjectOrder {
    /// By name, alphabetically.
    #[default]
    Name,
    /// By sex, then by name.
    Sex,
    /// By a measurement, the smallest first.
    Measurement(usize),
}

impl SubjectOrder {
    /// The next one, of so many measurements.
    #[must_use]
    pub fn next(self, measurements: usize) -> Self {
        match self {
            Self::Name => Self::Sex,
            Self::Sex => Self::Measurement(0),
            Self::Measurement(k) if k + 1 < measurements => Self::Measurement(k + 1),
            Self::Measurement(_) => Self::Name,
        }
    }
}

/// The screen of subjects.
#[derive(Default)]
pub struct SubjectsScreen {
    /// Name of the subject chosen.
    pub chosen: Option<String>,
    /// Order of subjects.
    pub order: Order<SubjectOrder>,
    /// Measurements read on bodies that were built.
    pub measured: BTreeMap<SubjectId, Result<Box<Girths>, String>>,
}
