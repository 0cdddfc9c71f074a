//! Order of rows.

/// An order and whether it is reversed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Order<T> {
    /// Quantity that rows are ordered by.
    pub by: T,
    /// True where it is reversed.
    pub reversed: bool,
}

impl<T: PartialEq> Order<T> {
    /// The title of a column, with a mark where rows are ordered by it.
    #[must_use]
    pub fn titled(&self, title: &str, by: T) -> String {
        match (self.by == by, self.reversed) {
            (false, _) => title.to_owned(),
            (true, false) => format!("{title}▲"),
            (true, true) => format!("{title}▼"),
        }
    }

    /// Turns the order round.
    pub fn reverse(&mut self) {
        self.reversed = !self.reversed;
    }
}
