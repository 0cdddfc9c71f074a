//! Screen 6: runs side by side: chi of each measurement, what that says, and the drapes where there is room.

pub mod actions;
mod comparison;
mod draw;
pub mod state;

use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::compare::state::CompareScreen;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::picture_pane::actions::requests;
use crate::screens::state::State;
use crate::widgets::jump::Target;
use crate::widgets::picture::PictureRequest;

impl Page for CompareScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        self.draw_panes(frame, area, state);
    }

    fn go(&mut self, state: &mut State, movement: Movement) {
        if !(state.in_second_pane() && state.pictures.raise(movement)) {
            self.row = movement.from(self.row, self.rows(state).len());
        }
    }

    fn sideways(&mut self, state: &mut State, step: isize) {
        if state.in_second_pane() {
            state.pictures.turn(step);
        }
    }

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        self.row = Movement::Round(step).from(self.row, self.rows(state).len());
    }

    fn sort(&mut self, _state: &mut State) {
        self.sorts_by_difference = !self.sorts_by_difference;
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        self.table(state).map(|table| (table, "the comparison"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        self.jump_targets(state, area)
    }

    fn explained(&self, state: &State) -> Selected {
        self.explanation(state)
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

    fn pictures(&self, state: &State, area: Rect) -> Vec<PictureRequest> {
        requests(state, draw::picture_panes(area, state))
    }

    fn needs_study(&self) -> bool {
        true
    }
}
