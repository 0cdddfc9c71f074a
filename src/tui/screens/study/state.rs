//! Where the user is in the grid.

/// Place in the grid: indices of size, simulator and subject.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Row of the size, from 0.
    pub size: usize,
    /// Index among the simulators that have jobs.
    pub simulator: usize,
    /// Column of the subject, from 0.
    pub subject: usize,
}

/// Where the user is in the grid.
#[derive(Debug, Default)]
pub struct Study {
    /// Place in the grid.
    pub place: Place,
}
