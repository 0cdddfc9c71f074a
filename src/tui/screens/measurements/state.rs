//! Stage, order and selected row of the table of measurements.

use crate::messages::snapshot::Detail;
use crate::screens::order::Order;
use store::ChiRow;

/// Order of measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum ChiOrder {
    /// By number in the style.
    #[default]
    Number,
    /// By distance from 1, the greatest first.
    Error,
}

/// Stage, order and selected row of the table of measurements.
#[derive(Debug, Default)]
pub struct Measurements {
    /// Order of measurements.
    pub order: Order<ChiOrder>,
    /// Measurement selected, a row of the table shown.
    pub row: usize,
    /// Stage whose measurements are wanted.
    pub stage: Option<String>,
}

impl Measurements {
    /// Sorts by the next column.
    pub fn sort(&mut self) {
        self.order.by = match self.order.by {
            ChiOrder::Number => ChiOrder::Error,
            ChiOrder::Error => ChiOrder::Number,
        };
    }

    /// The stage whose measurements are shown: the one wanted, or the last there is.
    #[must_use]
    pub fn stage<'a>(&self, detail: &'a Detail) -> Option<&'a str> {
        let stages = stages(detail);
        stages.iter().copied().find(|stage| Some(*stage) == self.stage.as_deref()).or(stages.last().copied())
    }

    /// Measurements of a result that contain a filter in lower case, in order.
    #[must_use]
    pub fn rows<'a>(&self, detail: &'a Detail, filter: &str) -> Vec<&'a ChiRow> {
        let Some(stage) = self.stage(detail) else { return vec![] };
        let matches = |row: &ChiRow| format!("#{} {}", row.no, row.name).to_lowercase().contains(filter);
        let mut rows: Vec<&ChiRow> = detail.chi.iter().filter(|row| row.stage == stage && matches(row)).collect();
        if self.order.by == ChiOrder::Error {
            let error = |row: &ChiRow| (row.chi() - 1.0).abs();
            rows.sort_by(|a, b| error(b).total_cmp(&error(a)));
        }
        if self.order.reversed {
            rows.reverse();
        }
        rows
    }
}

/// Stages of a result, in the order they are made.
#[must_use]
pub fn stages(detail: &Detail) -> Vec<&str> {
    ["sewn", "popup", "drape"].into_iter().filter(|stage| detail.chi.iter().any(|row| row.stage == *stage)).collect()
}
