//! Screen 4: the queue as a table, above the log and the curves of the selected job.

pub mod actions;
mod draw;
pub mod state;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::screens::compare::actions::{mark_all, mark_range};
use crate::screens::jobs::state::JobsScreen;
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::state::State;

impl Page for JobsScreen {
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

    fn copied(&self, state: &State) -> Option<Copied> {
        actions::job_line(state).map(|text| Copied { name: "the job", text })
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        Some(match action {
            Action::Pause => actions::pause(state),
            Action::Cancel => self.cancel(state),
            Action::Retry => self.retry(state),
            Action::RetryFailed => actions::retry_failed(state),
            Action::Raise => self.prioritise(state, 1),
            Action::Lower => self.prioritise(state, -1),
            Action::Run => actions::start_run(state),
            Action::Stop => actions::stop_run(state),
            Action::MarkRange if state.nav.screen == Screen::Jobs => {
                mark_range(state, &self.shown_ids(state));
                vec![]
            }
            Action::MarkAll if state.nav.screen == Screen::Jobs => {
                mark_all(state, &self.shown_ids(state));
                vec![]
            }
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
