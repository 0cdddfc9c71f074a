//! Screen 2: the subjects of the catalogue, and of the selected one its measurements and its body.

mod actions;
pub mod draw;
pub mod state;

use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::catalogue;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::state::State;
use crate::widgets::jump::Target;
use crate::widgets::picture::Pictured;
use spec::MEASUREMENTS;
use wardrobe::Part;

/// The screen of subjects.
pub struct SubjectsPage;

impl Page for SubjectsPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            state.scroll_table(movement, MEASUREMENTS.len().saturating_sub(draw::table_rows(state.body())));
        } else {
            state.go_in_subjects(movement);
        }
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        state.go_in_subjects(Movement::Round(step));
    }

    fn sort(&self, state: &mut State) {
        state.subjects.order.by = state.subjects.order.by.next(state::SHOWN);
    }

    fn reverse(&self, state: &mut State) {
        state.subjects.order.reverse();
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        actions::subject_line(state).map(|line| (line, "the subject"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn explained(&self, state: &State) -> Selected {
        draw::explained(state)
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        catalogue::act(state, Part::Subject, action)
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<(Pictured, Rect)> {
        let body = state.subject().map(|row| Pictured::Body(row.id));
        body.zip(draw::picture_pane(area)).into_iter().collect()
    }
}
