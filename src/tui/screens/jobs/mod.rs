//! Screen 4: the queue as a table, and below it the log and the course of the selected job.

mod actions;
mod draw;
mod runs;
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

/// The screen of jobs.
pub struct JobsPage;

impl Page for JobsPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            state.go_in_log(movement);
        } else {
            state.go_in_jobs(movement);
        }
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        state.go_in_jobs(Movement::Round(step));
    }

    fn sort(&self, state: &mut State) {
        state.jobs.order.by = state.jobs.order.by.next();
    }

    fn reverse(&self, state: &mut State) {
        state.jobs.order.reverse();
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        state.job_line().map(|line| (line, "the job"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn explained(&self, state: &State) -> Selected {
        draw::explained(state)
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        Some(match action {
            Action::Pause => state.pause(),
            Action::Cancel => state.cancel(),
            Action::Retry => state.retry(),
            Action::Raise => state.prioritise(1),
            Action::Lower => state.prioritise(-1),
            Action::Run => state.start_run(),
            Action::Stop => {
                state.stop_run();
                vec![]
            }
            _ => return None,
        })
    }

    fn needs_study(&self) -> bool {
        true
    }
}
