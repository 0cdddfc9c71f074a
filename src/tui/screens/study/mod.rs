//! Screen 1: the study as a grid of sizes and simulators by subjects, with the numbers of the selected cell.

pub mod actions;
mod draw;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::compare::actions::{mark_all, mark_range};
use crate::screens::jobs::actions::job_line;
use crate::screens::measurements;
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::state::State;

#[derive(Default)]
pub struct StudyScreen;

impl Page for StudyScreen {
    fn go(&mut self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            measurements::go(state, movement);
        } else {
            actions::go_in_grid(state, movement);
        }
    }

    fn sideways(&mut self, state: &mut State, step: isize) {
        state.step_subject(step);
    }

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        actions::go_to_matching_cell(state, step);
    }

    fn sort(&mut self, state: &mut State) {
        state.measurements.sort();
    }

    fn reverse(&mut self, state: &mut State) {
        state.measurements.order.reverse();
    }

    fn copied(&self, state: &State) -> Option<Copied> {
        job_line(state).map(|text| Copied { name: "the job", text })
    }

    fn go_to_item(&mut self, state: &mut State, item: usize) {
        actions::go_to_cell(state, item);
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::Open => return Some(actions::open(state)),
            Action::NextGarment => actions::step_garment(state, 1),
            Action::PreviousGarment => actions::step_garment(state, -1),
            Action::NextStudy => actions::next_study(state),
            Action::NewStudy => actions::new_study(state),
            Action::MarkRange if state.nav.screen == Screen::Study => {
                mark_range(state, &actions::matching_jobs(state));
            }
            Action::MarkAll if state.nav.screen == Screen::Study => mark_all(state, &actions::matching_jobs(state)),
            _ => return None,
        }
        Some(vec![])
    }

    fn needs_study(&self) -> bool {
        true
    }
}
