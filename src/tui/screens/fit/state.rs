//! Where the user is in the fit of a garment, and its cross sections.

use study::{CrossSection, JobId};

/// A part of the screen; with little room it alone is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// The fit card.
    #[default]
    Card,
    /// The cross section.
    Section,
    /// The sizes side by side.
    Sizes,
}

impl View {
    /// All of them, in the order in which they are gone through.
    pub const ALL: [Self; 3] = [Self::Card, Self::Section, Self::Sizes];
}

/// Cross sections of results at all levels, or why there are none.
pub type Sections = Result<Vec<CrossSection>, String>;

/// Where the user is in the fit of a garment, and its cross sections.
#[derive(Debug, Default)]
pub struct Fit {
    /// Part that has the focus.
    pub view: View,
    /// Level chosen; before that it is the one that is worst.
    pub level: Option<String>,
    /// Quantity selected, a row of the comparison shown.
    pub row: usize,
    /// Results whose sections are asked for.
    pub asked: Vec<JobId>,
    /// The sections that came last, with their results.
    pub cut: Option<(Vec<JobId>, Sections)>,
}
