//! Screen 0: how a garment sits on a subject: its fit card, a cross section of all sizes, the sizes side by side, and what
//! to change of a size so that it fits.

mod actions;
mod alteration;
mod altering;
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
use crate::overlays::explanation::Selected;
use crate::screens::fit::state::View;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::state::State;
use crate::widgets::jump::Target;

/// Keys and what they do; Tab leads to the next part.
const fn hints(next: &'static str) -> [(&'static str, &'static str); 8] {
    [
        ("Tab", next),
        ("v", "level"),
        ("a", "alter"),
        ("h l", "subject"),
        ("y", "copy"),
        ("R", "run"),
        ("?", "help"),
        (":", "command"),
    ]
}

/// The same where it is shown what to change.
const ALTER_HINTS: [(&str, &str); 8] = [
    ("d", "drape"),
    ("w", "write"),
    ("+-", "size"),
    ("h l", "subject"),
    ("y", "copy"),
    ("Esc", "back"),
    ("?", "help"),
    (":", "command"),
];

/// The screen of fit.
pub struct FitPage;

impl Page for FitPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if state.fit.alter.is_open {
            state.scroll_alteration(movement, draw::hidden_lines(state));
        } else {
            state.go_in_fit(movement);
        }
    }

    fn sideways(&self, state: &mut State, step: isize) {
        state.go_to_subject(step);
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        self.go(state, Movement::Round(step));
    }

    /// Levels and quantities have one order.
    fn sort(&self, _state: &mut State) {}

    fn reverse(&self, _state: &mut State) {}

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        match state.fit.view {
            _ if state.fit.alter.is_open => altering::command(state).map(|command| (command, "the command")),
            View::Sizes => actions::size_table(state).map(|table| (table, "the comparison of sizes")),
            View::Card | View::Section => actions::card_table(state).map(|table| (table, "the fit card")),
        }
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn focus(&self, state: &mut State, pane: usize) {
        state.fit.view = View::ALL[pane];
    }

    fn explained(&self, state: &State) -> Selected {
        actions::explained(state)
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        let is_shown = state.nav.screen == Screen::Fit;
        match action {
            Action::NextLevel => state.step_level(1),
            Action::PreviousLevel => state.step_level(-1),
            Action::NextPane if is_shown => state.step_view(1),
            Action::PreviousPane if is_shown => state.step_view(-1),
            Action::Alter => return Some(state.open_alteration()),
            Action::DrapeChange => return Some(state.drape_alteration()),
            Action::WriteChange => state.write_alteration(),
            Action::LargerSize => return Some(state.step_altered_size(1)),
            Action::SmallerSize => return Some(state.step_altered_size(-1)),
            _ => return None,
        }
        Some(vec![])
    }

    fn shrink(&self, state: &mut State) -> bool {
        std::mem::take(&mut state.fit.alter.is_open)
    }

    fn wanted(&self, state: &mut State) -> Vec<Effect> {
        state.ask_for_sections().into_iter().chain(state.ask_for_alteration()).collect()
    }

    fn hints(&self, state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        let hints = match state.fit.view {
            _ if state.fit.alter.is_open => &ALTER_HINTS,
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
