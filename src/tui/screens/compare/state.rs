//! State of the screen of comparisons.

/// The screen of comparisons.
#[derive(Default)]
pub struct CompareScreen {
    /// True where only the measurements are shown in which compared runs differ.
    pub differences_only: bool,
    /// True where those that differ most come first.
    pub sorts_by_difference: bool,
    /// Measurement selected, a row of the table shown.
    pub row: usize,
}
