//! Typing a query, running it, going on in its rows.

use crossterm::event::{KeyCode, KeyEvent};

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::QueryRequest;
use crate::overlays::Overlay;
use crate::overlays::explanation::Selected;
use crate::overlays::path_prompt::PathPrompt;
use crate::overlays::saved_queries::QueryList;
use crate::screens::state::State;
use crate::widgets::editor::Mode;
use crate::widgets::result_table::{ResultTable, cell_text};

/// Queries that the history keeps.
const MOST_KEPT: usize = 200;

impl State {
    /// Whether what is typed goes into the editor.
    #[must_use]
    pub fn is_editing(&self) -> bool {
        self.nav.screen == Screen::Sql && !self.in_second_pane()
    }

    /// Hands a key to the editor; returns whether it took it. In an empty editor, keys that no query begins with mean what
    /// they mean elsewhere.
    pub fn edit_query(&mut self, event: &KeyEvent) -> bool {
        let mode = self.sql.editor.mode();
        if event.code == KeyCode::Esc && mode != Some(Mode::Insert) {
            self.nav.second_pane[Screen::Sql as usize] = true;
            return true;
        }
        let is_command = matches!(event.code, KeyCode::Char('?' | ':' | '0'..='9'));
        if is_command && self.sql.editor.text().is_empty() {
            return false;
        }
        self.sql.editor.key(event, self.sql.relations.as_deref().unwrap_or_default())
    }

    /// Has names and saved queries read when the screen is first shown.
    pub fn ask_for_names(&mut self) -> Option<Effect> {
        if self.sql.relations.is_some() {
            return None;
        }
        self.sql.relations = Some(vec![]);
        Some(Effect::Query(QueryRequest::Names))
    }

    /// Runs the query.
    pub fn run_query(&mut self) -> Vec<Effect> {
        let text = self.sql.editor.text().trim().to_owned();
        if text.is_empty() {
            // What was refused is gone from the editor, and with it why.
            self.sql.outcome = self.sql.outcome.take().filter(Result::is_ok);
            self.say("no query is typed yet; o offers saved ones");
            return vec![];
        }
        if self.sql.running.is_some() {
            self.say("a query is being answered; C-c cancels it");
            return vec![];
        }
        self.sql.history.retain(|known| *known != text);
        self.sql.history.push(text.clone());
        let surplus = self.sql.history.len().saturating_sub(MOST_KEPT);
        self.sql.history.drain(..surplus);
        self.sql.recalled = None;
        self.sql.editor.decline();
        self.sql.running = Some(text.clone());
        self.sql.outcome = None;
        vec![Effect::Query(QueryRequest::Rows(text))]
    }

    /// Takes in an answer.
    pub fn answered(&mut self, ms: u64, outcome: Result<Box<ResultTable>, String>) {
        let Some(text) = self.sql.running.take() else { return };
        match outcome {
            Ok(table) => {
                let more = if table.is_cut() { "the first " } else { "" };
                let rows = if table.total() == 1 { "row" } else { "rows" };
                self.sql.outcome = Some(Ok(format!("{more}{} {rows} in {ms} ms", table.total())));
                self.nav.filters[Screen::Sql as usize].clear();
                (self.sql.table, self.sql.answered) = (Some(*table), text);
            }
            Err(error) => self.sql.outcome = Some(Err(error)),
        }
    }

    /// Puts an older or newer query of the history into the editor.
    pub fn recall(&mut self, step: isize) {
        let last = self.sql.history.len();
        let at = self.sql.recalled.as_ref().map_or(last, |(at, _)| *at);
        let Some(next) = at.checked_add_signed(step).filter(|next| *next <= last) else {
            self.say(if step < 0 { "no older query" } else { "no newer query" });
            return;
        };
        self.nav.second_pane[Screen::Sql as usize] = false;
        let typed = self.sql.recalled.take().map_or_else(|| self.sql.editor.text().to_owned(), |(_, typed)| typed);
        if next == last {
            self.sql.editor.set(&typed);
        } else {
            self.sql.editor.set(&self.sql.history[next].clone());
            self.sql.recalled = Some((next, typed));
        }
    }

    /// Offers the saved queries.
    pub fn offer_queries(&mut self) {
        self.overlay =
            Some(Overlay::Queries(QueryList { queries: self.sql.saved.clone(), text: String::new(), row: 0 }));
    }

    /// Puts a chosen query into the editor.
    pub fn take_query(&mut self, text: &str) {
        self.show(Screen::Sql);
        self.nav.second_pane[Screen::Sql as usize] = false;
        self.sql.editor.set(text.trim_end());
    }

    /// Asks for the name under which the query is saved: at first that of the saved one it was made from.
    pub fn save_query(&mut self) {
        let text = self.sql.editor.text().trim().to_owned();
        if text.is_empty() {
            self.say("no query is typed yet; o offers saved ones");
            return;
        }
        let name = self.sql.saved.iter().find(|saved| saved.sql.trim() == text).map(|saved| saved.name.clone());
        self.overlay = Some(Overlay::Path(PathPrompt::save_query(text, name.unwrap_or_default())));
    }

    /// Asks for the file that the rows go into.
    pub fn export_query(&mut self) {
        if self.sql.table.is_none() {
            self.say("nothing to export yet: F5 runs the query");
            return;
        }
        self.overlay = Some(Overlay::Path(PathPrompt::export(self.sql.answered.clone())));
    }

    /// Goes on in the rows of the answer.
    pub fn arrange_rows(&mut self) {
        let filter = self.nav.filters[Screen::Sql as usize].clone();
        if let Some(table) = &mut self.sql.table {
            table.arrange(&filter);
        }
    }
}

/// The selected row, tab-separated.
pub fn selected_row(state: &State) -> Option<String> {
    let table = state.sql.table.as_ref().filter(|table| table.len() > 0)?;
    Some(table.copied(std::iter::once(table.row)))
}

/// The selected value, and the other columns of the answer.
pub fn explained(state: &State) -> Selected {
    let Some(table) = &state.sql.table else { return Selected::default() };
    let names: Vec<&str> = table.names().iter().map(String::as_str).collect();
    let Some(column) = names.get(table.column) else { return Selected::default() };
    let value = table.values(table.row).map_or(String::new(), |values| cell_text(&values[table.column]));
    Selected::new(format!("{column}: {value}"), &[column], &names)
}
