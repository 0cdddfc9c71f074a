//! Screen 9: the fabrics of the catalogue, and of the selected one its numbers, where they are from, and how it stretches.

mod actions;
mod draw;
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
use wardrobe::Part;

/// The screen of fabrics.
pub struct FabricsPage;

impl Page for FabricsPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            state.scroll_table(movement, draw::table_lines().saturating_sub(draw::table_rows(state.body())));
        } else {
            state.go_in_fabrics(movement);
        }
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        state.go_in_fabrics(Movement::Round(step));
    }

    fn sort(&self, state: &mut State) {
        state.fabrics.order.by = state.fabrics.order.by.next();
    }

    fn reverse(&self, state: &mut State) {
        state.fabrics.order.reverse();
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        actions::fabric_line(state).map(|line| (line, "the fabric"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn explained(&self, state: &State) -> Selected {
        draw::explained(state)
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        catalogue::act(state, Part::Fabric, action)
    }
}
