//! Screen 5: one result: its measurements, its numbers, and the picture of its drape.

mod actions;
mod draw;
pub mod measurements;
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

/// The screen of a result.
pub struct ResultsPage;

impl Page for ResultsPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if !state.raise_picture(movement) {
            state.go_in_measurements(movement);
        }
    }

    fn sideways(&self, state: &mut State, step: isize) {
        if state.in_second_pane() {
            state.pictures.turn(step);
        } else {
            state.step_result(step);
        }
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        state.go_in_measurements(Movement::Round(step));
    }

    fn sort(&self, state: &mut State) {
        state.results.sort();
    }

    fn reverse(&self, state: &mut State) {
        state.results.order.reverse();
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        actions::chi_table(state).map(|table| (table, "the table of measurements"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn explained(&self, state: &State) -> Selected {
        measurements::explained(state)
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::OtherSimulator => state.other_simulator(),
            Action::NextStage => state.next_stage(),
            _ => return state.pictures.act(action).then(Vec::new),
        }
        Some(vec![])
    }

    fn shrink(&self, state: &mut State) -> bool {
        std::mem::take(&mut state.pictures.enlarged)
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<(Pictured, Rect)> {
        state.drape_in(draw::picture_pane(area, state))
    }

    fn needs_study(&self) -> bool {
        true
    }
}
