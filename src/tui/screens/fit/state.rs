//! State of the Fit screen.

use crate::messages::alterations::AlterRequest;
use crate::messages::answered::Answered;
use crate::messages::comments::{Change, FittingOf};
use advice::Alteration;
use results::CrossSection;
use store::JobId;

/// A part of the screen; in a small terminal only one is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// The fit card.
    #[default]
    Card,
    /// The cross section.
    Section,
    /// The sizes side by side.
    Sizes,
    /// The comments of the fitting.
    Comments,
}

impl View {
    /// All parts, in the order in which Tab goes through them.
    pub const ALL: [Self; 4] = [Self::Card, Self::Section, Self::Sizes, Self::Comments];
}

/// Cross sections of results at all levels, or the reason why there are none.
pub type Sections = Result<Vec<CrossSection>, String>;

/// State of draping an altered pattern.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Draping {
    /// No drape is being made.
    #[default]
    No,
    /// The drape is being made.
    GoesOn,
    /// The drape failed, for this reason.
    Failed(String),
}

/// The alteration of a size: as requested, and as found.
#[derive(Debug, Default)]
pub struct Alter {
    /// True if the alteration is shown, on top of the part with the focus.
    pub is_open: bool,
    /// Request, without a drape.
    pub asked: Option<AlterRequest>,
    /// Alteration, or the reason why none was found; `None` while it is sought.
    pub answer: Option<Result<Box<Alteration>, String>>,
    /// State of its drape.
    pub draping: Draping,
    /// Number of lines scrolled down.
    pub down: usize,
}

/// The comments of fittings.
#[derive(Debug, Default)]
pub struct Comments {
    /// True to list those of all fittings of the study.
    pub is_whole: bool,
    /// Garment, subject and number of the selected comment; `None` for the first one.
    pub chosen: Option<(String, String, i64)>,
    /// Changes that can be taken back, the latest last.
    pub changes: Vec<(FittingOf, Change)>,
}

/// The Fit screen.
#[derive(Default)]
pub struct FitScreen {
    /// Part that has the focus.
    pub view: View,
    /// Chosen level; `None` for the worst one.
    pub level: Option<String>,
    /// Index of the selected row in the comparison of sizes.
    pub row: usize,
    /// Results whose sections were requested.
    pub asked: Vec<JobId>,
    /// Latest sections, with the results that were cut.
    pub cut: Option<Answered<Vec<JobId>, Vec<CrossSection>>>,
    /// Alteration of a size.
    pub alter: Alter,
    /// Comments of fittings.
    pub comments: Comments,
}
