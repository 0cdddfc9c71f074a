//! The screens, a folder each: its state, what it does, how it is drawn.
//!
//! A new screen is a folder here. It is entered in [`Screen`], in [`page()`] and in [`State`]: the compiler asks for the
//! last two.

mod catalogue;
mod compare;
pub mod fabrics;
pub mod fit;
pub mod jobs;
pub mod movement;
pub mod order;
pub mod page;
pub mod picture_pane;
mod reports;
pub mod results;
pub mod sql;
pub mod start;
pub mod state;
mod study;
pub mod styles;
pub mod subjects;
mod writing;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::page::Page;
use crate::screens::state::State;

/// What a screen does.
#[must_use]
pub fn page(screen: Screen) -> &'static dyn Page {
    match screen {
        Screen::Study => &study::StudyPage,
        Screen::Subjects => &subjects::SubjectsPage,
        Screen::Styles => &styles::StylesPage,
        Screen::Jobs => &jobs::JobsPage,
        Screen::Results => &results::ResultsPage,
        Screen::Compare => &compare::ComparePage,
        Screen::Sql => &sql::SqlPage,
        Screen::Reports => &reports::ReportsPage,
        Screen::Fabrics => &fabrics::FabricsPage,
        Screen::Fit => &fit::FitPage,
    }
}

/// Does an action that is a screen's own; the one shown has the first say. `None` where it is no screen's.
pub fn act(state: &mut State, action: Action) -> Option<Vec<Effect>> {
    let shown = state.nav.screen;
    std::iter::once(shown).chain(Screen::ALL).find_map(|screen| page(screen).act(state, action))
}
