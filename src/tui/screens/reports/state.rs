//! State of the screen of reports.

use results::ReportRow;

/// The screen of reports.
#[derive(Default)]
pub struct ReportsScreen {
    /// All reports; `None` until they were listed.
    pub rows: Option<Vec<ReportRow>>,
    /// The one selected.
    pub row: usize,
    /// True where the latest comes first.
    pub by_time: bool,
    /// The study whose report is being built.
    pub building: Option<String>,
}
