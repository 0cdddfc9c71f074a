//! Screen 8: the reports that were built, and where they are.

mod actions;
mod draw;
pub mod state;

use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::state::State;
use crate::widgets::jump::Target;

/// The screen of reports.
pub struct ReportsPage;

impl Page for ReportsPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        state.reports.row = movement.from(state.reports.row, state.reports().len());
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        self.go(state, Movement::Round(step));
    }

    fn sort(&self, state: &mut State) {
        state.reports.by_time = !state.reports.by_time;
    }

    fn reverse(&self, state: &mut State) {
        self.sort(state);
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        state.report().map(|row| (row.page.display().to_string(), "the path"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        Some(match action {
            Action::BuildReport => state.build_report(),
            Action::OpenReport => state.open_report(),
            _ => return None,
        })
    }

    fn wanted(&self, state: &mut State) -> Vec<Effect> {
        state.ask_for_reports().into_iter().collect()
    }
}
