//! Moving about in lists.

/// A movement in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Movement {
    /// So many rows down, or up where it is negative.
    By(isize),
    /// So many rows down, or up where it is negative, round about.
    Round(isize),
    /// To the first row.
    First,
    /// To the last row.
    Last,
}

impl Movement {
    /// The row that it leads to from a row of so many.
    #[must_use]
    pub fn from(self, row: usize, rows: usize) -> usize {
        let last = rows.saturating_sub(1);
        match self {
            Self::By(step) => row.saturating_add_signed(step).min(last),
            Self::Round(step) => stepped(row, step, rows).unwrap_or(0),
            Self::First => 0,
            Self::Last => last,
        }
    }
}

/// An index some steps on, round about; `None` where there is nothing.
#[must_use]
pub fn stepped(index: usize, step: isize, len: usize) -> Option<usize> {
    (len > 0).then(|| (index as isize + step).rem_euclid(len as isize) as usize)
}
