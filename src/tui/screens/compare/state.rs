//! Which runs are compared, and how.

use std::collections::BTreeSet;

use store::JobId;

/// Which runs are compared, and how.
#[derive(Debug, Default)]
pub struct Compare {
    /// Runs selected for a comparison.
    pub marks: BTreeSet<JobId>,
    /// Whether only the measurements are shown in which compared runs differ.
    pub differences_only: bool,
    /// Whether those that differ most come first.
    pub sorts_by_difference: bool,
    /// Measurement selected, a row of the table shown.
    pub row: usize,
}
