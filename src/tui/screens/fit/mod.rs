//! Screen 0: how a garment sits on a subject: its fit card, a cross section of all sizes, the sizes side by side.

mod actions;
mod card;
mod draw;
mod quantities;
mod section;
mod sizes;
pub mod state;

use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::fit::state::View;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::state::State;

/// Keys and what they do; Tab leads to the next part.
const fn hints(next: &'static str) -> [(&'static str, &'static str); 8] {
    [
        ("Tab", next),
        ("v", "level"),
        ("h l", "subject"),
        ("]", "garment"),
        ("y", "copy"),
        ("R", "run"),
        ("?", "help"),
        (":", "command"),
    ]
}

/// The screen of fit.
pub struct FitPage;

impl Page for FitPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        state.go_in_fit(movement);
    }

    fn sideways(&self, state: &mut State, step: isize) {
        state.go_to_subject(step);
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        state.go_in_fit(Movement::Round(step));
    }

    /// Levels and quantities have one order.
    fn sort(&self, _state: &mut State) {}

    fn reverse(&self, _state: &mut State) {}

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        match state.fit.view {
            View::Sizes => actions::size_table(state).map(|table| (table, "the comparison of sizes")),
            View::Card | View::Section => actions::card_table(state).map(|table| (table, "the fit card")),
        }
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        let is_shown = state.nav.screen == Screen::Fit;
        match action {
            Action::NextLevel => state.step_level(1),
            Action::PreviousLevel => state.step_level(-1),
            Action::NextPane if is_shown => state.step_view(1),
            Action::PreviousPane if is_shown => state.step_view(-1),
            _ => return None,
        }
        Some(vec![])
    }

    fn wanted(&self, state: &mut State) -> Option<Effect> {
        state.ask_for_sections()
    }

    fn hints(&self, state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        let hints = match state.fit.view {
            View::Card => const { &hints("section") },
            View::Section => const { &hints("sizes") },
            View::Sizes => const { &hints("card") },
        };
        (state.filter().is_empty() && !state.is_first_start()).then_some(hints)
    }

    fn needs_study(&self) -> bool {
        true
    }
}
