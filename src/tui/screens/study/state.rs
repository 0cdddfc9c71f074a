//! Where the user is in the grid.

/// Place in the grid: indices of size, simulator and subject.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Size.
    pub size: usize,
    /// Simulator.
    pub simulator: usize,
    /// Subject.
    pub subject: usize,
}

/// Where the user is in the grid.
#[derive(Debug, Default)]
pub struct Study {
    /// Place in the grid.
    pub place: Place,
}
