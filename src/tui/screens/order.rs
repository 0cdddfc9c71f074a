//! Order of rows.

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Order<T> {
    pub by: T,
    pub reversed: bool,
}

impl<T: PartialEq> Order<T> {
    /// Title of a column, with a mark if rows are ordered by it.
    pub fn titled(&self, title: &str, by: T) -> String {
        match (self.by == by, self.reversed) {
            (false, _) => title.to_owned(),
            (true, false) => format!("{title}▲"),
            (true, true) => format!("{title}▼"),
        }
    }

    pub fn reverse(&mut self) {
        self.reversed = !self.reversed;
    }
}
