//! Typing a query, running it, moving in its rows.

use crossterm::event::{KeyCode, KeyEvent};

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::QueryRequest;
use crate::overlays::Overlay;
use crate::overlays::path_prompt::{PathPrompt, Purpose};
use crate::overlays::saved_queries::QueryList;
use crate::screens::movement::stepped;
use crate::screens::sql::state::{Queries, Recalled, SqlScreen};
use crate::screens::state::State;
use crate::widgets::editor::Mode;
use crate::widgets::result_table::ResultTable;
use store::Relation;

/// Most queries in the history.
const MOST_KEPT: usize = 200;

pub fn is_editing(state: &State) -> bool {
    state.nav.screen == Screen::Sql && !state.in_second_pane()
}

impl SqlScreen {
    /// Hands a key to the editor. Returns false if the editor does not want it: in an empty editor, keys with which no
    /// query begins keep their usual meaning.
    pub fn edit_query(&mut self, state: &mut State, event: &KeyEvent) -> bool {
        let mode = self.editor.mode();
        if event.code == KeyCode::Esc && mode != Some(Mode::Insert) {
            state.nav.second_pane[Screen::Sql as usize] = true;
            return true;
        }
        let is_command = matches!(event.code, KeyCode::Char('?' | ':' | '0'..='9'));
        if is_command && self.editor.text().is_empty() {
            return false;
        }
        self.editor.key(event, self.relations.as_deref().unwrap_or_default())
    }

    /// Queries that are being written, with the present text in its place.
    pub fn queries(&self) -> Queries {
        let mut queries = self.queries.clone();
        queries.texts.resize(queries.texts.len().max(queries.at + 1), String::new());
        self.editor.text().clone_into(&mut queries.texts[queries.at]);
        queries
    }

    /// Takes queries that were written before, the present one into the editor.
    pub fn take_queries(&mut self, mut queries: Queries) {
        queries.at = queries.at.min(queries.texts.len().saturating_sub(1));
        self.editor.set(queries.texts.get(queries.at).map_or("", String::as_str));
        self.queries = queries;
    }

    pub fn new_query(&mut self, state: &mut State) {
        state.show(Screen::Sql);
        state.nav.second_pane[Screen::Sql as usize] = false;
        let mut queries = self.queries();
        queries.texts.retain(|text| !text.trim().is_empty());
        queries.at = queries.texts.len();
        queries.texts.push(String::new());
        self.take_queries(queries);
    }

    pub fn step_query(&mut self, state: &mut State, step: isize) {
        let mut queries = self.queries();
        match stepped(queries.at, step, queries.texts.len()).filter(|next| *next != queries.at) {
            Some(next) => {
                queries.at = next;
                self.take_queries(queries);
            }
            None => state.say("there is one query only; a begins another"),
        }
    }

    /// Relations that the query names, as far as they are known.
    pub fn named(&self) -> Vec<&Relation> {
        let text = self.editor.text().to_lowercase();
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        let known = self.relations.iter().flatten();
        known.filter(|relation| words.contains(&relation.name.to_lowercase().as_str())).collect()
    }

    /// Requests names and saved queries when the screen is first shown.
    pub fn ask_for_names(&mut self) -> Option<Effect> {
        if self.relations.is_some() {
            return None;
        }
        self.relations = Some(vec![]);
        Some(Effect::Query(QueryRequest::Names))
    }

    pub fn run_query(&mut self, state: &mut State) -> Vec<Effect> {
        let text = self.editor.text().trim().to_owned();
        if text.is_empty() {
            // The refused query is no longer in the editor, so its error goes too.
            self.outcome = self.outcome.take().filter(Result::is_ok);
            return state.reply("no query is typed yet; o offers saved ones");
        }
        if self.running.is_some() {
            return state.reply("a query is being answered; C-c cancels it");
        }
        self.history.retain(|known| *known != text);
        self.history.push(text.clone());
        let surplus = self.history.len().saturating_sub(MOST_KEPT);
        self.history.drain(..surplus);
        self.recalled = None;
        self.editor.decline();
        self.running = Some(text.clone());
        self.outcome = None;
        vec![Effect::Query(QueryRequest::Rows(text))]
    }

    pub fn answered(&mut self, state: &mut State, ms: u64, outcome: Result<Box<ResultTable>, String>) {
        let Some(text) = self.running.take() else { return };
        match outcome {
            Ok(table) => {
                let more = if table.is_cut() { "the first " } else { "" };
                let rows = if table.total() == 1 { "row" } else { "rows" };
                self.outcome = Some(Ok(format!("{more}{} {rows} in {ms} ms", table.total())));
                state.nav.filters[Screen::Sql as usize].clear();
                (self.table, self.answered) = (Some(*table), text);
            }
            Err(error) => self.outcome = Some(Err(error)),
        }
    }

    pub fn recall(&mut self, state: &mut State, step: isize) {
        let last = self.history.len();
        let at = self.recalled.as_ref().map_or(last, |recalled| recalled.index);
        let Some(next) = at.checked_add_signed(step).filter(|next| *next <= last) else {
            state.say(if step < 0 { "no older query" } else { "no newer query" });
            return;
        };
        state.nav.second_pane[Screen::Sql as usize] = false;
        let typed = self.recalled.take().map_or_else(|| self.editor.text().to_owned(), |recalled| recalled.typed);
        if next == last {
            self.editor.set(&typed);
        } else {
            self.editor.set(&self.history[next].clone());
            self.recalled = Some(Recalled { index: next, typed });
        }
    }

    pub fn offer_queries(&self, state: &mut State) {
        let list = QueryList { queries: self.saved.clone(), text: String::new(), row: 0 };
        state.overlay = Some(Overlay::Queries(list));
    }

    pub fn take_query(&mut self, state: &mut State, text: &str) {
        state.show(Screen::Sql);
        state.nav.second_pane[Screen::Sql as usize] = false;
        self.editor.set(text.trim_end());
    }

    /// Asks for a name for the query, beginning with that of the saved query that it was made from.
    pub fn save_query(&self, state: &mut State) {
        let text = self.editor.text().trim().to_owned();
        if text.is_empty() {
            state.say("no query is typed yet; o offers saved ones");
            return;
        }
        let name = self.saved.iter().find(|saved| saved.sql.trim() == text).map(|saved| saved.name.clone());
        state.overlay = Some(Overlay::Path(PathPrompt::new(Purpose::SaveQuery(text), name.unwrap_or_default())));
    }

    pub fn export_query(&self, state: &mut State) {
        if self.table.is_none() {
            state.say("nothing to export yet: F5 runs the query");
            return;
        }
        state.overlay = Some(Overlay::Path(PathPrompt::new(Purpose::Export(self.answered.clone()), "query.csv")));
    }

    pub fn arrange_rows(&mut self, state: &State) {
        if let Some(table) = &mut self.table {
            table.arrange(&state.nav.filters[Screen::Sql as usize]);
        }
    }

    /// Selected row as text, separated by tabs.
    pub fn selected_row(&self) -> Option<String> {
        let table = self.table.as_ref().filter(|table| table.len() > 0)?;
        Some(table.copied(std::iter::once(table.row)))
    }
}
