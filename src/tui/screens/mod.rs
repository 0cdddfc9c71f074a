//! The screens, a folder for each: state, actions, drawing.
//!
//! A new screen is a folder here, with an entry in [`Screen`] and in [`Screens`]. The compiler asks for the latter.

pub mod catalogue;
pub mod compare;
pub mod fabrics;
pub mod fit;
pub mod jobs;
pub mod marks;
pub mod measurements;
pub mod movement;
pub mod order;
pub mod page;
pub mod picture_pane;
pub mod reports;
pub mod results;
pub mod sql;
pub mod start;
pub mod state;
pub mod study;
pub mod styles;
pub mod subjects;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::compare::state::CompareScreen;
use crate::screens::fabrics::state::FabricsScreen;
use crate::screens::fit::state::FitScreen;
use crate::screens::jobs::state::JobsScreen;
use crate::screens::page::Page;
use crate::screens::reports::state::ReportsScreen;
use crate::screens::results::ResultsScreen;
use crate::screens::sql::state::SqlScreen;
use crate::screens::state::State;
use crate::screens::study::StudyScreen;
use crate::screens::styles::state::StylesScreen;
use crate::screens::subjects::state::SubjectsScreen;

#[derive(Default)]
pub struct Screens {
    pub study: StudyScreen,
    pub subjects: SubjectsScreen,
    pub styles: StylesScreen,
    pub jobs: JobsScreen,
    pub results: ResultsScreen,
    pub compare: CompareScreen,
    pub sql: SqlScreen,
    pub reports: ReportsScreen,
    pub fabrics: FabricsScreen,
    pub fit: FitScreen,
}

impl Screens {
    pub fn page(&self, screen: Screen) -> &dyn Page {
        match screen {
            Screen::Study => &self.study,
            Screen::Subjects => &self.subjects,
            Screen::Styles => &self.styles,
            Screen::Jobs => &self.jobs,
            Screen::Results => &self.results,
            Screen::Compare => &self.compare,
            Screen::Sql => &self.sql,
            Screen::Reports => &self.reports,
            Screen::Fabrics => &self.fabrics,
            Screen::Fit => &self.fit,
        }
    }

    pub fn page_mut(&mut self, screen: Screen) -> &mut dyn Page {
        match screen {
            Screen::Study => &mut self.study,
            Screen::Subjects => &mut self.subjects,
            Screen::Styles => &mut self.styles,
            Screen::Jobs => &mut self.jobs,
            Screen::Results => &mut self.results,
            Screen::Compare => &mut self.compare,
            Screen::Sql => &mut self.sql,
            Screen::Reports => &mut self.reports,
            Screen::Fabrics => &mut self.fabrics,
            Screen::Fit => &mut self.fit,
        }
    }

    /// Tells all screens that the database was read.
    pub fn receive(&mut self, state: &State) {
        Screen::ALL.into_iter().for_each(|screen| self.page_mut(screen).receive(state));
    }

    /// Carries out an action of a screen, the shown one first. `None` if it is the action of no screen.
    pub fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        let shown = state.nav.screen;
        std::iter::once(shown).chain(Screen::ALL).find_map(|screen| self.page_mut(screen).act(state, action))
    }
}
