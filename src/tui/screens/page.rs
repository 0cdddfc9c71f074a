//! The face of a screen to the workbench.

use crossterm::event::KeyEvent;
use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::messages::effect::{Effect, Writing};
use crate::overlays::explanation::Selected;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::widgets::jump::Target;
use crate::widgets::picture::PictureRequest;

/// A text for the clipboard.
pub struct Copied {
    /// Its name in the message about it.
    pub name: &'static str,
    /// The text; values of a row or table are separated by tabs.
    pub text: String,
}

/// Drawing of a screen.
pub trait Draw {
    /// Draws the screen.
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State);

    /// Rows, panes and other things that can be gone to.
    fn targets(&self, _state: &State, _area: Rect) -> Vec<Target> {
        vec![]
    }

    /// The selected thing, and the names of its numbers and of the columns here, as the glossary has them.
    fn explained(&self, _state: &State) -> Selected {
        Selected::default()
    }

    /// Requests for the pictures that there is room for.
    fn pictures(&self, _state: &State, _area: Rect) -> Vec<PictureRequest> {
        vec![]
    }
}

/// Keys and actions of a screen. What it shares with others is in the state that its methods take.
pub trait Page: Draw {
    /// Moves up or down in the pane that has the focus.
    fn go(&mut self, state: &mut State, movement: Movement);

    /// Goes to the next match of the filter, or back.
    fn go_to_match(&mut self, state: &mut State, step: isize) {
        self.go(state, Movement::Round(step));
    }

    /// Sorts by the next column.
    fn sort(&mut self, state: &mut State);

    /// Reverses the order; where it has two values, as sorting does.
    fn reverse(&mut self, state: &mut State) {
        self.sort(state);
    }

    /// The text that stands for the selection.
    fn copied(&self, state: &State) -> Option<Copied>;

    /// Gives a pane the focus.
    fn focus(&mut self, state: &mut State, pane: usize) {
        state.nav.second_pane[state.nav.screen as usize] = pane == 1;
    }

    /// Goes to something that the screen counts itself.
    fn go_to_item(&mut self, _state: &mut State, _item: usize) {}

    /// Moves left or right.
    fn sideways(&mut self, _state: &mut State, _step: isize) {}

    /// Does an action of its own; `None` where the action is another's.
    fn act(&mut self, _state: &mut State, _action: Action) -> Option<Vec<Effect>> {
        None
    }

    /// Takes a key before it becomes an action; `None` where it does not.
    fn take_key(&mut self, _state: &mut State, _event: &KeyEvent) -> Option<Vec<Effect>> {
        None
    }

    /// Gives a pane that has all the room less again; returns true if there was any.
    fn shrink(&mut self, _state: &mut State) -> bool {
        false
    }

    /// Takes in that the database was read.
    fn receive(&mut self, _state: &State) {}

    /// Asks for what is read while the screen is shown, where that was not asked for yet.
    fn wanted(&mut self, _state: &State) -> Vec<Effect> {
        vec![]
    }

    /// Opens an editor on what the screen shows: the file of the study.
    fn write(&mut self, state: &mut State) -> Vec<Effect> {
        let file = state.study().map(|study| Writing::File(study.path.clone()));
        open_editor(state, file)
    }

    /// Keys and what they do, where other keys than those of the table matter.
    fn hints(&self, _state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        None
    }

    /// True if it shows nothing before there is a study.
    fn needs_study(&self) -> bool {
        false
    }
}

/// Opens an editor, or says that there is nothing to edit.
pub fn open_editor(state: &mut State, writing: Option<Writing>) -> Vec<Effect> {
    if writing.is_none() {
        state.say("nothing to edit here: E edits the query, the seams of a DXF pattern, the file of the study");
    }
    writing.map(Effect::Write).into_iter().collect()
}
