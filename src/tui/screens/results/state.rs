//! Where the user is in the table of measurements, which Study shows too.

use crate::screens::order::Order;

/// How measurements are ordered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum ChiOrder {
    /// By number in the style.
    #[default]
    Number,
    /// By distance from 1, the greatest first.
    Error,
}

/// Where the user is in the table of measurements.
#[derive(Debug, Default)]
pub struct Results {
    /// Order of measurements.
    pub order: Order<ChiOrder>,
    /// Measurement selected, a row of the table shown.
    pub row: usize,
    /// Stage whose measurements are wanted.
    pub stage: Option<String>,
}

impl Results {
    /// Sorts by the next column.
    pub fn sort(&mut self) {
        self.order.by = match self.order.by {
            ChiOrder::Number => ChiOrder::Error,
            ChiOrder::Error => ChiOrder::Number,
        };
    }
}
