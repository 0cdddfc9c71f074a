//! Movements in lists.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Movement {
    /// Some rows down, or up if negative.
    By(isize),
    /// Some rows down, or up if negative; from the last row on to the first.
    Round(isize),
    First,
    Last,
}

impl Movement {
    /// Row that the movement leads to, from `row` of `rows`.
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

/// Index some steps on, from the last on to the first; `None` in an empty list.
pub fn stepped(index: usize, step: isize, len: usize) -> Option<usize> {
    (len > 0).then(|| (index as isize + step).rem_euclid(len as isize) as usize)
}
