//! Screen 6: runs side by side, with chi of each measurement, conclusions, and drapes where they fit.

pub mod actions;
mod comparison;
mod draw;
pub mod state;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::screens::compare::state::CompareScreen;
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::state::State;

impl Page for CompareScreen {
    fn go(&mut self, state: &mut State, movement: Movement) {
        if !(state.in_second_pane() && state.pictures.raise(movement)) {
            self.row = movement.from(self.row, self.rows(state).len());
        }
    }

    fn sideways(&mut self, state: &mut State, step: isize) {
        if state.in_second_pane() {
            state.pictures.turn(step);
        } else {
            let last = actions::compared(state).len().saturating_sub(draw::runs_shown(state.body(), state));
            self.left_of = self.left_of.min(last).saturating_add_signed(step).min(last);
        }
    }

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        self.row = Movement::Round(step).from(self.row, self.rows(state).len());
    }

    fn sort(&mut self, _state: &mut State) {
        self.sorts_by_difference = !self.sorts_by_difference;
    }

    fn copied(&self, state: &State) -> Option<Copied> {
        self.table(state).map(|text| Copied { name: "the comparison", text })
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::Mark => actions::mark_run(state),
            Action::Unmark => actions::unmark_runs(state),
            Action::Differences => (self.differences_only, self.row) = (!self.differences_only, 0),
            _ => return None,
        }
        Some(vec![])
    }

    fn shrink(&mut self, state: &mut State) -> bool {
        std::mem::take(&mut state.pictures.enlarged)
    }

    fn needs_study(&self) -> bool {
        true
    }
}
