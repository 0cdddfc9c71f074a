//! State of the Subjects screen.

use std::collections::BTreeMap;

use crate::screens::marks::Marks;
use crate::screens::order::Order;
use spec::bodies::Girths;
use store::SubjectId;

/// Number of measurements in the list: stature, weight, chest, waist, hip.
pub const SHOWN: usize = 5;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SubjectOrder {
    #[default]
    Name,
    /// By sex, then by name.
    Sex,
    /// By the measurement at an index of [`spec::MEASUREMENTS`], the smallest first.
    Measurement(usize),
}

impl SubjectOrder {
    /// Order after this one; `measurements` is the number of measurements.
    pub fn next(self, measurements: usize) -> Self {
        match self {
            Self::Name => Self::Sex,
            Self::Sex => Self::Measurement(0),
            Self::Measurement(k) if k + 1 < measurements => Self::Measurement(k + 1),
            Self::Measurement(_) => Self::Name,
        }
    }
}

#[derive(Default)]
pub struct SubjectsScreen {
    pub chosen: Option<String>,
    pub marks: Marks<String>,
    pub order: Order<SubjectOrder>,
    /// Tape measurements of bodies, or the reason why a body could not be built.
    pub measured: BTreeMap<SubjectId, Result<Box<Girths>, String>>,
}
