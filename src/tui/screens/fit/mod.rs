//! Screen 0: the fit of a garment on a subject. It has a fit card, a cross section of all sizes, the sizes side by
//! side, the comments of the fitting, and the alteration that makes a size fit.

pub mod actions;
mod alteration;
mod altering;
mod card;
mod comment_list;
pub mod comments;
mod draw;
mod quantities;
mod section;
mod sizes;
pub mod state;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::fit::state::{FitScreen, View};
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::state::State;

/// Keys with their meanings; `next` is the part that Tab leads to.
const fn hints(next: &'static str) -> [(&'static str, &'static str); 7] {
    [
        ("Tab", next),
        ("v", "level"),
        ("a", "alter"),
        ("m", "comments"),
        ("h l", "subject"),
        ("?", "help"),
        (":", "command"),
    ]
}

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

const COMMENT_HINTS: [(&str, &str); 9] = [
    ("↵", "edit"),
    ("i", "add"),
    ("x", "close"),
    ("u", "undo"),
    ("b", "round"),
    ("S", "sign"),
    ("z", "all"),
    ("?", "help"),
    (":", "command"),
];

impl Page for FitScreen {
    fn go(&mut self, state: &mut State, movement: Movement) {
        if self.alter.is_open {
            self.alter.scroll(movement, self.hidden_lines(state));
        } else {
            self.go_in_view(state, movement);
        }
    }

    fn sideways(&mut self, state: &mut State, step: isize) {
        state.step_subject(step);
    }

    /// Does nothing: levels and quantities have a fixed order.
    fn sort(&mut self, _state: &mut State) {}

    fn copied(&self, state: &State) -> Option<Copied> {
        match self.view {
            _ if self.alter.is_open => self.alter.command(state).map(|text| Copied { name: "the command", text }),
            View::Sizes => actions::size_table(state).map(|text| Copied { name: "the comparison of sizes", text }),
            View::Comments => self.comments.table(state).map(|text| Copied { name: "the comments", text }),
            View::Card | View::Section => actions::card_table(state).map(|text| Copied { name: "the fit card", text }),
        }
    }

    fn focus(&mut self, _state: &mut State, pane: usize) {
        self.view = View::ALL[pane];
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        let is_shown = state.nav.screen == Screen::Fit;
        match action {
            Action::NextLevel => self.step_level(state, 1),
            Action::PreviousLevel => self.step_level(state, -1),
            Action::NextPane if is_shown => self.step_view(1),
            Action::PreviousPane if is_shown => self.step_view(-1),
            Action::Alter => return Some(self.alter.open(state)),
            Action::DrapeChange => return Some(self.alter.drape(state)),
            Action::WriteChange => self.alter.write(state),
            Action::LargerSize => return Some(self.alter.step_size(state, 1)),
            Action::SmallerSize => return Some(self.alter.step_size(state, -1)),
            _ => return self.act_on_comments(state, action),
        }
        Some(vec![])
    }

    fn shrink(&mut self, _state: &mut State) -> bool {
        std::mem::take(&mut self.alter.is_open)
    }

    fn wanted(&mut self, state: &State) -> Vec<Effect> {
        self.ask_for_sections(state).into_iter().chain(self.alter.ask_if_wanted(state)).collect()
    }

    fn hints(&self, state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        let hints: &[_] = match self.view {
            _ if self.alter.is_open => &ALTER_HINTS,
            View::Card => const { &hints("section") },
            View::Section => const { &hints("sizes") },
            View::Sizes => const { &hints("comments") },
            View::Comments => &COMMENT_HINTS,
        };
        (state.filter().is_empty() && !state.is_first_start()).then_some(hints)
    }

    fn needs_study(&self) -> bool {
        true
    }
}
