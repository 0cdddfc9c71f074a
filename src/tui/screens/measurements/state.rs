//! Stage, order and selected row of the table of measurements.

use crate::messages::snapshot::Detail;
use crate::screens::order::Order;
use crate::widgets::text::mm;
use store::ChiRow;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum ChiOrder {
    /// By number in the style.
    #[default]
    Number,
    /// By |chi - 1|, the greatest first.
    Error,
}

#[derive(Debug, Default)]
pub struct Measurements {
    pub order: Order<ChiOrder>,
    pub row: usize,
    pub stage: Option<String>,
}

impl Measurements {
    pub fn sort(&mut self) {
        self.order.by = match self.order.by {
            ChiOrder::Number => ChiOrder::Error,
            ChiOrder::Error => ChiOrder::Number,
        };
    }

    /// Stage that is shown: the chosen one, else the last.
    pub fn stage<'a>(&self, detail: &'a Detail) -> Option<&'a str> {
        let stages = stages(detail);
        stages.iter().copied().find(|stage| Some(*stage) == self.stage.as_deref()).or(stages.last().copied())
    }

    /// Measurements of a result that contain `filter`, which is in lower case, in order.
    pub fn rows<'a>(&self, detail: &'a Detail, filter: &str) -> Vec<&'a ChiRow> {
        let Some(stage) = self.stage(detail) else { return vec![] };
        let matches = |row: &ChiRow| words(row).to_lowercase().contains(filter);
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

/// Marks of a measurement: girth, free edge, controlled.
pub fn marks(row: &ChiRow) -> String {
    let marks = [(row.is_girth, '○'), (row.is_free_edge, '~'), (row.is_controlled, '=')];
    marks.iter().filter(|(is_set, _)| *is_set).map(|(_, mark)| *mark).collect()
}

/// Text of a measurement to which the filter applies: what its line shows.
fn words(row: &ChiRow) -> String {
    format!("#{} {} {} {} {} {:.3}", row.no, row.name, marks(row), mm(row.l2d_m), mm(row.l3d_m), row.chi())
}

/// Stages of a result, in the order of the simulation.
pub fn stages(detail: &Detail) -> Vec<&str> {
    ["sewn", "popup", "drape"].into_iter().filter(|stage| detail.chi.iter().any(|row| row.stage == *stage)).collect()
}
