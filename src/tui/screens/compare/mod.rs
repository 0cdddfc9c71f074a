//! Screen 6: runs side by side: chi of each measurement, what that says, and the drapes where there is room.

mod actions;
mod comparison;
mod draw;
pub mod state;

use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::state::State;
use crate::widgets::jump::Target;
use crate::widgets::picture::Pictured;

/// The screen of a comparison.
pub struct ComparePage;

impl Page for ComparePage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if !state.raise_picture(movement) {
            state.go_in_comparison(movement);
        }
    }

    fn sideways(&self, state: &mut State, step: isize) {
        if state.in_second_pane() {
            state.pictures.turn(step);
        }
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        state.go_in_comparison(Movement::Round(step));
    }

    fn sort(&self, state: &mut State) {
        state.compare.sorts_by_difference = !state.compare.sorts_by_difference;
    }

    fn reverse(&self, state: &mut State) {
        self.sort(state);
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        actions::comparison_table(state).map(|table| (table, "the comparison"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn explained(&self, state: &State) -> Selected {
        draw::explained(state)
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::Mark => state.mark_run(),
            Action::Unmark => state.unmark_runs(),
            Action::Differences => {
                (state.compare.differences_only, state.compare.row) = (!state.compare.differences_only, 0);
            }
            _ => return None,
        }
        Some(vec![])
    }

    fn shrink(&self, state: &mut State) -> bool {
        std::mem::take(&mut state.pictures.enlarged)
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<(Pictured, Rect)> {
        draw::picture_panes(area, state)
    }

    fn needs_study(&self) -> bool {
        true
    }
}
