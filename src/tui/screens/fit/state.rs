//! State of the screen of fit.

use crate::messages::alterations::AlterRequest;
use crate::messages::answered::Answered;
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

/// Progress of the drape of a changed pattern.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Draping {
    /// None goes on.
    #[default]
    No,
    /// It goes on.
    GoesOn,
    /// It failed, and why.
    Failed(String),
}

/// The change of a size so that it fits, as it is asked for and found.
#[derive(Debug, Default)]
pub struct Alter {
    /// True where it is shown, over the part that has the focus.
    pub is_open: bool,
    /// The request, without a drape.
    pub asked: Option<AlterRequest>,
    /// The change that was found, or why none was; `None` while it is sought.
    pub answer: Option<Result<Box<Alteration>, String>>,
    /// Progress of its drape.
    pub draping: Draping,
    /// Lines that it is scrolled down.
    pub down: usize,
}

/// The screen of fit.
#[derive(Default)]
pub struct FitScreen {
    /// Part that has the focus.
    pub view: View,
    /// Level chosen; before that it is the one that is worst.
    pub level: Option<String>,
    /// Quantity selected, a row of the comparison shown.
    pub row: usize,
    /// Results whose sections are asked for.
    pub asked: Vec<JobId>,
    /// The sections that came last, and the results that they are of.
    pub cut: Option<Answered<Vec<JobId>, Vec<CrossSection>>>,
    /// The change of a size.
    pub alter: Alter,
}
