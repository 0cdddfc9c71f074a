//! Where the user is among reports.

use results::ReportRow;

/// Where the user is among reports.
#[derive(Debug, Default)]
pub struct Reports {
    /// Those there are; `None` until they were listed.
    pub rows: Option<Vec<ReportRow>>,
    /// The one selected.
    pub row: usize,
    /// Whether the latest comes first.
    pub by_time: bool,
    /// The study whose report is being built.
    pub building: Option<String>,
}
