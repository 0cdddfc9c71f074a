//! State of the Compare screen.

/// The Compare screen.
#[derive(Default)]
pub struct CompareScreen {
    /// True to show only measurements in which the runs differ.
    pub differences_only: bool,
    /// True to sort by difference, the greatest first.
    pub sorts_by_difference: bool,
    /// Index of the selected row.
    pub row: usize,
    /// Number of runs that are scrolled away to the left, where not all fit.
    pub left_of: usize,
}
