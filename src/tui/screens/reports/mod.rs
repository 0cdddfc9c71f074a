//! Screen 8: the reports of the project, with their paths.

mod actions;
mod draw;
pub mod state;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::reports::actions::fetching;
use crate::screens::reports::state::ReportsScreen;
use crate::screens::state::State;

impl Page for ReportsScreen {
    fn go(&mut self, state: &mut State, movement: Movement) {
        self.row = movement.from(self.row, self.shown(state).len());
    }

    fn sort(&mut self, _state: &mut State) {
        self.by_time = !self.by_time;
    }

    fn copied(&self, state: &State) -> Option<Copied> {
        self.selected(state)
            .map(|row| Copied { name: "the command for your own machine", text: fetching(state, &row.page) })
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        Some(match action {
            Action::BuildReport => self.build(state),
            Action::OpenReport => self.open(state),
            _ => return None,
        })
    }

    fn wanted(&mut self, _state: &State) -> Vec<Effect> {
        self.ask_for_reports().into_iter().collect()
    }
}
