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
    #[default]
    Card,
    Section,
    Sizes,
    Comments,
}

impl View {
    /// Parts in the order in which Tab goes through them.
    pub const ALL: [Self; 4] = [Self::Card, Self::Section, Self::Sizes, Self::Comments];
}

/// Cross sections of results at all levels, or the reason why there are none.
pub type Sections = Result<Vec<CrossSection>, String>;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Draping {
    #[default]
    No,
    GoesOn,
    Failed(String),
}

#[derive(Debug, Default)]
pub struct Alter {
    /// True if the alteration is shown, on top of the part with the focus.
    pub is_open: bool,
    /// Request, without a drape.
    pub asked: Option<AlterRequest>,
    /// Alteration, or the reason why none was found; `None` while it is sought.
    pub answer: Option<Result<Box<Alteration>, String>>,
    pub draping: Draping,
    /// Lines scrolled down.
    pub down: usize,
}

#[derive(Debug, Default)]
pub struct Comments {
    /// True to list those of all fittings of the study.
    pub is_whole: bool,
    /// Garment, subject and number of the selected comment; `None` for the first one.
    pub chosen: Option<(String, String, i64)>,
    /// Changes that can be taken back, the latest last.
    pub changes: Vec<(FittingOf, Change)>,
}

#[derive(Default)]
pub struct FitScreen {
    pub view: View,
    /// Chosen level; `None` for the worst one.
    pub level: Option<String>,
    pub row: usize,
    /// Results whose sections were requested.
    pub asked: Vec<JobId>,
    /// Latest sections, with the results that were cut.
    pub cut: Option<Answered<Vec<JobId>, Vec<CrossSection>>>,
    pub alter: Alter,
    pub comments: Comments,
}
