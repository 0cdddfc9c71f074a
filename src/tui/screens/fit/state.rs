//! Where the user is in the fit of a garment, its cross sections, and what to change of it.

use crate::messages::alterations::AlterRequest;
use advice::Alteration;
use results::CrossSection;
use store::JobId;

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

/// Whether a changed pattern is draped.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Draping {
    /// Not, or that is over.
    #[default]
    No,
    /// It goes on.
    GoesOn,
    /// It failed, and why.
    Failed(String),
}

/// What to change of a size.
#[derive(Debug, Default)]
pub struct Alter {
    /// Whether it is shown, over the part that has the focus.
    pub is_open: bool,
    /// What is asked for, without a drape.
    pub asked: Option<AlterRequest>,
    /// What was found, or why nothing was; `None` while it is sought.
    pub answer: Option<Result<Box<Alteration>, String>>,
    /// Whether it is draped.
    pub draping: Draping,
    /// Lines that it is scrolled down.
    pub down: usize,
}

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
    /// What to change of a size.
    pub alter: Alter,
}
