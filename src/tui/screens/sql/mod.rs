//! Screen 7: a query in SQL and its answer.

mod actions;
pub mod draw;
pub mod state;

use crossterm::event::KeyEvent;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::{Effect, Writing};
use crate::screens::movement::Movement;
use crate::screens::page::{Copied, Page};
use crate::screens::sql::actions::is_editing;
use crate::screens::sql::state::SqlScreen;
use crate::screens::state::State;

const EDITOR_HINTS: [(&str, &str); 5] =
    [("F5", "run"), ("Tab", "complete, or rows"), ("C-p", "history"), ("Esc", "rows and commands"), ("C-c", "cancel")];

impl Page for SqlScreen {
    fn go(&mut self, _state: &mut State, movement: Movement) {
        if let Some(table) = &mut self.table {
            table.row = movement.from(table.row, table.len());
        }
    }

    fn sideways(&mut self, _state: &mut State, step: isize) {
        self.table.iter_mut().for_each(|table| table.sideways(step));
    }

    fn sort(&mut self, state: &mut State) {
        self.table.iter_mut().for_each(|table| table.sort(state.filter()));
    }

    fn reverse(&mut self, state: &mut State) {
        self.table.iter_mut().for_each(|table| table.reverse(state.filter()));
    }

    fn copied(&self, _state: &State) -> Option<Copied> {
        self.selected_row().map(|text| Copied { name: "the row", text })
    }

    fn act(&mut self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::Run if state.nav.screen == Screen::Sql => return Some(self.run_query(state)),
            Action::Quit if self.running.is_some() => return Some(vec![Effect::StopQuery]),
            Action::SaveQuery => self.save_query(state),
            Action::NewQuery => self.new_query(state),
            Action::NextGarment if state.nav.screen == Screen::Sql => self.step_query(state, 1),
            Action::PreviousGarment if state.nav.screen == Screen::Sql => self.step_query(state, -1),
            Action::EditQuery => state.nav.second_pane[Screen::Sql as usize] = false,
            Action::SavedQueries => self.offer_queries(state),
            Action::OlderQuery => self.recall(state, -1),
            Action::NewerQuery => self.recall(state, 1),
            Action::ExportQuery => self.export_query(state),
            _ => return None,
        }
        Some(vec![])
    }

    fn take_key(&mut self, state: &mut State, event: &KeyEvent) -> Option<Vec<Effect>> {
        (is_editing(state) && self.edit_query(state, event)).then(Vec::new)
    }

    fn wanted(&mut self, _state: &State) -> Vec<Effect> {
        self.ask_for_names().into_iter().collect()
    }

    fn write(&mut self, _state: &mut State) -> Vec<Effect> {
        vec![Effect::Write(Writing::Query(self.editor.text().to_owned()))]
    }

    fn hints(&self, state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        is_editing(state).then_some(&EDITOR_HINTS)
    }
}
