//! What each screen does.

use crossterm::event::KeyEvent;
use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::widgets::jump::Target;
use crate::widgets::picture::Pictured;

/// What a screen does with the state, and how it shows it.
pub trait Page {
    /// Draws the screen from the state.
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State);

    /// Moves up or down in the pane that has the focus.
    fn go(&self, state: &mut State, movement: Movement);

    /// Goes to the next match of the filter, or back.
    fn go_to_match(&self, state: &mut State, step: isize);

    /// Sorts by the next column.
    fn sort(&self, state: &mut State);

    /// Reverses the order.
    fn reverse(&self, state: &mut State);

    /// The text that stands for what is selected, tab-separated, and what it is.
    fn copied(&self, state: &State) -> Option<(String, &'static str)>;

    /// What is to be seen that can be gone to: rows, panes and what the screen counts itself.
    fn targets(&self, _state: &State, _area: Rect) -> Vec<Target> {
        vec![]
    }

    /// Gives a pane the focus.
    fn focus(&self, state: &mut State, pane: usize) {
        state.nav.second_pane[state.nav.screen as usize] = pane == 1;
    }

    /// Goes to something that the screen counts itself.
    fn go_to_item(&self, _state: &mut State, _item: usize) {}

    /// What is selected, and the names of its numbers and of the columns here, as the glossary has them.
    fn explained(&self, _state: &State) -> Selected {
        Selected::default()
    }

    /// Moves left or right.
    fn sideways(&self, _state: &mut State, _step: isize) {}

    /// Does an action of its own; `None` where the action is another's.
    fn act(&self, _state: &mut State, _action: Action) -> Option<Vec<Effect>> {
        None
    }

    /// Takes a key before it becomes an action; `None` where it does not.
    fn take_key(&self, _state: &mut State, _event: &KeyEvent) -> Option<Vec<Effect>> {
        None
    }

    /// Gives a pane that has all the room less again; returns whether there was any.
    fn shrink(&self, _state: &mut State) -> bool {
        false
    }

    /// What it has read while it is shown, where that was not asked for yet.
    fn wanted(&self, _state: &mut State) -> Vec<Effect> {
        vec![]
    }

    /// The pictures that there is room for, each with its pane.
    fn pictures(&self, _state: &State, _area: Rect) -> Vec<(Pictured, Rect)> {
        vec![]
    }

    /// Keys and what they do, where other keys than those of the table matter.
    fn hints(&self, _state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        None
    }

    /// Whether it shows nothing before there is a study.
    fn needs_study(&self) -> bool {
        false
    }
}
