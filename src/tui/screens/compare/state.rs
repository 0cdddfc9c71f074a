//! State of the Compare screen.

#[derive(Default)]
pub struct CompareScreen {
    pub differences_only: bool,
    /// Greatest difference first.
    pub sorts_by_difference: bool,
    pub row: usize,
    /// Number of runs that are scrolled away to the left, where not all fit.
    pub left_of: usize,
}
