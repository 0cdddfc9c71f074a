//! How rows are ordered.

/// An order and whether it is reversed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Order<T> {
    /// What rows are ordered by.
    pub by: T,
    /// Whether it is reversed.
    pub reversed: bool,
}

impl<T> Order<T> {
    /// Turns the order round.
    pub fn reverse(&mut self) {
        self.reversed = !self.reversed;
    }
}
