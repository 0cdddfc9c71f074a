//! Questions of fit: ease, the size to wear, how a garment sits, sections, which simulator.

use super::Workspace;
use crate::answers::fit_card::{self, FitCard};
use crate::answers::section::{self, CrossSection, CutAt};
use crate::answers::worn::{self, GarmentWorn};
use crate::error::Result;
use crate::rows::{EaseRow, JobId, RecommendationRow};
use crate::store::read;
use fit::Simulator;
use report::Chart;

impl Workspace {
    /// Ease and fit class of every size on every subject of a study.
    pub fn ease(&self, study: &str) -> Result<Vec<EaseRow>> {
        read::ease(&self.store, study)
    }

    /// How the garments of a study sit on its subjects, and in which size; only a garment or a subject where one is asked for.
    ///
    /// # Errors
    /// [`StudyError::NotFound`](crate::StudyError::NotFound) when the study has no ease of what is asked for.
    pub fn fit_cards(&self, study: &str, garment: Option<&str>, subject: Option<&str>) -> Result<Vec<FitCard>> {
        fit_card::asked(fit_card::fit_cards(&self.store, study)?, garment, subject)
    }

    /// Which simulator to use, for every garment and fit class of a study.
    pub fn recommendations(&self, study: &str) -> Result<Vec<RecommendationRow>> {
        read::recommendations(&self.store, study)
    }

    /// How the garments of a study sit on its subjects: their fit cards beside what is measured on their drapes.
    ///
    /// # Errors
    /// As [`Workspace::fit_cards`].
    pub fn worn(&self, study: &str, garment: Option<&str>, subject: Option<&str>) -> Result<Vec<GarmentWorn>> {
        worn::worn(&self.store, study, self.fit_cards(study, garment, subject)?)
    }

    /// The sizes of a fit card that a simulator has draped, in order, each with its result.
    pub fn worn_by(&self, study: &str, card: &FitCard, simulator: Simulator) -> Result<Vec<(String, JobId)>> {
        worn::drapes(&self.store, study, card, simulator)
    }

    /// Cross sections of results on one body, drawn level by level, with the gaps of one size written beside it.
    ///
    /// # Errors
    /// As [`Workspace::sections`], and where a chart cannot be drawn.
    pub fn section_charts(&self, jobs: &[JobId], at: &CutAt, written: Option<&str>) -> Result<Vec<(String, Chart)>> {
        section::drawn(&self.store, jobs, at, written)
    }

    /// Cross sections of results on one body, the cloth of all over each other.
    ///
    /// # Errors
    /// [`StudyError::NotFound`](crate::StudyError::NotFound) while there is no result, or for a level that bodies do not have;
    /// [`StudyError::Refused`](crate::StudyError::Refused) for a height at which there is no body, or results on different bodies.
    pub fn sections(&self, jobs: &[JobId], at: &CutAt) -> Result<Vec<CrossSection>> {
        section::sections(&self.store, jobs, at)
    }
}
