//! Screen 5: one result, with its measurements, metrics and drape.

mod actions;
mod draw;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::screens::measurements;
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::state::State;

#[derive(Default)]
pub struct ResultsScreen;

impl Page for ResultsScreen {
    fn go(&mut self, state: &mut State, movement: Movement) {
        if !(state.in_second_pane() && state.pictures.raise(movement)) {
            measurements::go(state, movement);
        }
    }

    fn sideways(&mut self, state: &mut State, step: isize) {
        if state.in_second_pane() {
            state.pictures.turn(step);
        } else {
            actions::step_result(state, step);
        }
    }

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        measurements::go(state, Movement::Round(step));
    }

    fn sort(&mut self, state: &mut State) {
        state.measurements.sort();
    }

    fn reverse(&mut self, state: &mut State) {
        state.measurements.order.reverse();
    }

    fn copied(&self, state: &State) -> Option<Copied> {
        actions::chi_table(state).map(|text| Copied { name: "the table of measurements", text })
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::OtherSimulator => actions::other_simulator(state),
            Action::NextStage => actions::next_stage(state),
            _ => return state.pictures.act(action).then(Vec::new),
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
