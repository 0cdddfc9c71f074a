//! Screen 4: the queue as a table, and below it the log and the course of the selected job.

pub mod actions;
mod draw;
pub mod state;

use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::jobs::state::JobsScreen;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::state::State;
use crate::widgets::jump::Target;

impl Page for JobsScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        self.draw_panes(frame, area, state);
    }

    fn go(&mut self, state: &mut State, movement: Movement) {
        if state.in_second_pane() {
            self.go_in_log(state, movement);
        } else {
            self.go_in_list(state, movement);
        }
    }

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        self.go_in_list(state, Movement::Round(step));
    }

    fn sort(&mut self, _state: &mut State) {
        self.order.by = self.order.by.next();
    }

    fn reverse(&mut self, _state: &mut State) {
        self.order.reverse();
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        actions::job_line(state).map(|line| (line, "the job"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        self.jump_targets(state, area)
    }

    fn explained(&self, state: &State) -> Selected {
        draw::explanation(state)
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        Some(match action {
            Action::Pause => actions::pause(state),
            Action::Cancel => actions::cancel(state),
            Action::Retry => actions::retry(state),
            Action::Raise => actions::prioritise(state, 1),
            Action::Lower => actions::prioritise(state, -1),
            Action::Run => actions::start_run(state),
            Action::Stop => actions::stop_run(state),
            _ => return None,
        })
    }

    fn receive(&mut self, state: &State) {
        self.trace(state.data.as_ref().map_or(&[], |data| &data.jobs));
        self.arrange(state);
    }

    fn needs_study(&self) -> bool {
        true
    }
}
