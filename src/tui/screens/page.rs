//! Interface between a screen and the workbench.

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

pub struct Copied {
    pub name: &'static str,
    /// Values of a row or table are separated by tabs.
    pub text: String,
}

pub trait Draw {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State);

    /// Places to which a jump can lead: rows, panes and others.
    fn targets(&self, _state: &State, _area: Rect) -> Vec<Target> {
        vec![]
    }

    /// Selection, with the names of its numbers and of the columns, as in the glossary.
    fn explained(&self, _state: &State) -> Selected {
        Selected::default()
    }

    /// Requests for the pictures that fit.
    fn pictures(&self, _state: &State, _area: Rect) -> Vec<PictureRequest> {
        vec![]
    }
}

/// Keys and actions of a screen; `state` is what it shares with others.
pub trait Page: Draw {
    /// Moves up or down in the pane that has the focus.
    fn go(&mut self, state: &mut State, movement: Movement);

    fn go_to_match(&mut self, state: &mut State, step: isize) {
        self.go(state, Movement::Round(step));
    }

    fn sort(&mut self, state: &mut State);

    /// Reverses the order; an order with two values sorts instead.
    fn reverse(&mut self, state: &mut State) {
        self.sort(state);
    }

    fn copied(&self, state: &State) -> Option<Copied>;

    fn focus(&mut self, state: &mut State, pane: usize) {
        state.nav.second_pane[state.nav.screen as usize] = pane == 1;
    }

    /// Moves to an item by the screen's own numbering.
    fn go_to_item(&mut self, _state: &mut State, _item: usize) {}

    fn sideways(&mut self, _state: &mut State, _step: isize) {}

    /// Returns `None` for an action of another screen.
    fn act(&mut self, _state: &mut State, _action: Action) -> Option<Vec<Effect>> {
        None
    }

    /// Handles a key before it becomes an action; `None` if the screen does not want it.
    fn take_key(&mut self, _state: &mut State, _event: &KeyEvent) -> Option<Vec<Effect>> {
        None
    }

    /// Makes an enlarged pane small again. Returns false where none is enlarged.
    fn shrink(&mut self, _state: &mut State) -> bool {
        false
    }

    /// Takes the marks of its list away, as another screen is shown.
    fn left(&mut self) {}

    fn receive(&mut self, _state: &State) {}

    /// Requests what the screen shows and has not requested before.
    fn wanted(&mut self, _state: &State) -> Vec<Effect> {
        vec![]
    }

    /// Opens what the screen shows in the user's editor, by default the study file.
    fn write(&mut self, state: &mut State) -> Vec<Effect> {
        let file = state.study().map(|study| Writing::File(study.path.clone()));
        open_editor(state, file)
    }

    /// Keys for the status line, where they differ from those of the table.
    fn hints(&self, _state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        None
    }

    /// True if the screen shows nothing before there is a study.
    fn needs_study(&self) -> bool {
        false
    }
}

/// Opens the user's editor on a text; without one says that there is nothing to edit.
pub fn open_editor(state: &mut State, writing: Option<Writing>) -> Vec<Effect> {
    if writing.is_none() {
        state.say("nothing to edit here: E edits the query, the seams of a DXF pattern, the file of the study");
    }
    writing.map(Effect::Write).into_iter().collect()
}
