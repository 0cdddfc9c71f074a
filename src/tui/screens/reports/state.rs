//! State of the Reports screen.

use results::ReportRow;

#[derive(Default)]
pub struct ReportsScreen {
    /// All reports; `None` until they are listed.
    pub rows: Option<Vec<ReportRow>>,
    pub row: usize,
    /// True to sort by time, the latest first.
    pub by_time: bool,
    pub building: Option<String>,
    /// Part of that report that is being made, in words; empty before the first.
    pub part: String,
}
