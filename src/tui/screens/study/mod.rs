//! Screen 1: the study as a grid, sizes and simulators down, subjects across, and what is known of the selected cell.

mod actions;
mod draw;
pub mod state;

use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::results::measurements;
use crate::screens::state::State;
use crate::widgets::jump::Target;
use crate::widgets::picture::Pictured;

/// The screen of the study.
pub struct StudyPage;

impl Page for StudyPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            state.go_in_measurements(movement);
        } else {
            state.go_in_grid(movement);
        }
    }

    fn sideways(&self, state: &mut State, step: isize) {
        state.go_to_subject(step);
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        state.go_to_matching_cell(step);
    }

    fn sort(&self, state: &mut State) {
        state.results.sort();
    }

    fn reverse(&self, state: &mut State) {
        state.results.order.reverse();
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        state.job_line().map(|line| (line, "the job"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn go_to_item(&self, state: &mut State, item: usize) {
        state.go_to_cell(item);
    }

    fn explained(&self, state: &State) -> Selected {
        if state.in_second_pane() { measurements::explained(state) } else { actions::explained(state) }
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::Open => return Some(state.open()),
            Action::NextGarment => state.step_garment(1),
            Action::PreviousGarment => state.step_garment(-1),
            Action::NextStudy => state.next_study(),
            Action::NewStudy => state.new_study(),
            _ => return None,
        }
        Some(vec![])
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<(Pictured, Rect)> {
        state.drape_in(draw::picture_pane(area, state))
    }

    fn needs_study(&self) -> bool {
        true
    }
}
