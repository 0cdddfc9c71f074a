//! Screen 7: a query and its answer.

mod actions;
pub mod draw;
pub mod state;

use crossterm::event::KeyEvent;
use ratatui::Frame;
use ratatui::layout::Rect;

use crate::keys::action::Action;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::overlays::explanation::Selected;
use crate::screens::movement::Movement;
use crate::screens::page::Page;
use crate::screens::state::State;
use crate::widgets::jump::Target;

/// The screen of queries.
pub struct SqlPage;

/// The keys that matter while a query is typed.
const EDITOR_HINTS: [(&str, &str); 5] =
    [("F5", "run"), ("Tab", "complete, or rows"), ("C-p", "history"), ("Esc", "rows and commands"), ("C-c", "cancel")];

impl Page for SqlPage {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        draw::draw(frame, area, state);
    }

    fn go(&self, state: &mut State, movement: Movement) {
        if let Some(table) = &mut state.sql.table {
            table.row = movement.from(table.row, table.len());
        }
    }

    fn sideways(&self, state: &mut State, step: isize) {
        state.sql.table.iter_mut().for_each(|table| table.sideways(step));
    }

    fn go_to_match(&self, state: &mut State, step: isize) {
        self.go(state, Movement::Round(step));
    }

    fn sort(&self, state: &mut State) {
        let filter = state.filter().to_owned();
        state.sql.table.iter_mut().for_each(|table| table.sort(&filter));
    }

    fn reverse(&self, state: &mut State) {
        let filter = state.filter().to_owned();
        state.sql.table.iter_mut().for_each(|table| table.reverse(&filter));
    }

    fn copied(&self, state: &State) -> Option<(String, &'static str)> {
        actions::selected_row(state).map(|rows| (rows, "the row"))
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        draw::targets(state, area)
    }

    fn explained(&self, state: &State) -> Selected {
        actions::explained(state)
    }

    fn act(&self, state: &mut State, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::Run if state.nav.screen == Screen::Sql => return Some(state.run_query()),
            Action::Quit if state.sql.running.is_some() => return Some(vec![Effect::StopQuery]),
            Action::SaveQuery => state.save_query(),
            Action::EditQuery => state.nav.second_pane[Screen::Sql as usize] = false,
            Action::SavedQueries => state.offer_queries(),
            Action::OlderQuery => state.recall(-1),
            Action::NewerQuery => state.recall(1),
            Action::ExportQuery => state.export_query(),
            _ => return None,
        }
        Some(vec![])
    }

    fn take_key(&self, state: &mut State, event: &KeyEvent) -> Option<Vec<Effect>> {
        (state.is_editing() && state.edit_query(event)).then(Vec::new)
    }

    fn wanted(&self, state: &mut State) -> Vec<Effect> {
        state.ask_for_names().into_iter().collect()
    }

    fn hints(&self, state: &State) -> Option<&'static [(&'static str, &'static str)]> {
        state.is_editing().then_some(&EDITOR_HINTS)
    }
}
