//! Table of measurements and metrics of a result, for the screens Study and Results.

pub mod draw;
pub mod state;

use crate::keys::screen::Screen;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use store::ChiRow;

/// Measurements of the selected result that pass the filter of the Results screen, in the order of the table.
pub fn rows(state: &State) -> Vec<&ChiRow> {
    let filter = state.filter_of(Screen::Results);
    state.detail().map_or(vec![], |detail| state.measurements.rows(detail, &filter))
}

pub fn go(state: &mut State, movement: Movement) {
    state.measurements.row = movement.from(state.measurements.row, rows(state).len());
}

pub fn clamp(state: &mut State) {
    state.measurements.row = state.measurements.row.min(rows(state).len().saturating_sub(1));
}
