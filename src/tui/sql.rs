//! Questions in SQL: the editor with its history, what was asked, and the answer.

use crossterm::event::{KeyCode, KeyEvent};

use super::action::Screen;
use super::asker::Question;
use super::editor::Editor;
use super::form::PathPrompt;
use super::message::Effect;
use super::overlay::{Overlay, edit};
use super::sheet::Sheet;
use super::state::State;
use study::{Relation, SavedQuery};

/// Queries that the history keeps.
const MOST_KEPT: usize = 200;

/// Where the user is among questions.
#[derive(Debug, Default)]
pub struct Sql {
    /// The query as it is typed.
    pub editor: Editor,
    /// Queries that were run, the oldest first.
    pub history: Vec<String>,
    /// The one of the history that is shown, and what was typed before it.
    recalled: Option<(usize, String)>,
    /// What a query may name; `None` until it was read.
    pub relations: Option<Vec<Relation>>,
    /// Queries kept in files.
    pub saved: Vec<SavedQuery>,
    /// The query that is being answered.
    pub asked: Option<String>,
    /// The query that was answered last: that of the sheet.
    pub answered: String,
    /// The answer.
    pub sheet: Option<Sheet>,
    /// How it went: rows and time, or what was wrong.
    pub told: Option<Result<String, String>>,
}

/// A list of queries that what is typed narrows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QueryList {
    /// All of them.
    pub queries: Vec<SavedQuery>,
    /// What is typed.
    pub text: String,
    /// Row selected.
    pub row: usize,
}

impl QueryList {
    /// Those that contain what is typed.
    #[must_use]
    pub fn rows(&self) -> Vec<&SavedQuery> {
        let text = self.text.to_lowercase();
        self.queries
            .iter()
            .filter(|query| format!("{} {}", query.name, query.sql).to_lowercase().contains(&text))
            .collect()
    }

    /// Handles a key; returns the query that was chosen.
    pub fn key(&mut self, event: &KeyEvent) -> Option<String> {
        match event.code {
            KeyCode::Enter => return self.rows().get(self.row).map(|query| query.sql.clone()),
            KeyCode::Up => self.row = self.row.saturating_sub(1),
            KeyCode::Down => self.row += 1,
            _ => {
                if edit(&mut self.text, event) {
                    self.row = 0;
                }
            }
        }
        self.row = self.row.min(self.rows().len().saturating_sub(1));
        None
    }
}

impl State {
    /// Whether what is typed goes into the editor.
    #[must_use]
    pub fn is_editing(&self) -> bool {
        self.nav.screen == Screen::Sql && !self.in_second_pane()
    }

    /// Hands a key to the editor; returns whether it took it. In an empty editor, keys that no query begins with mean what
    /// they mean elsewhere.
    pub(super) fn edit_query(&mut self, event: &KeyEvent) -> bool {
        if event.code == KeyCode::Esc {
            self.nav.second_pane[Screen::Sql as usize] = true;
            return true;
        }
        let is_command = matches!(event.code, KeyCode::Char('?' | ':' | '1'..='9'));
        if is_command && self.sql.editor.text().is_empty() {
            return false;
        }
        self.sql.editor.key(event, self.sql.relations.as_deref().unwrap_or_default())
    }

    /// Has names and saved queries read when the screen is first shown.
    pub(super) fn ask_for_names(&mut self) -> Option<Effect> {
        if self.nav.screen != Screen::Sql || self.sql.relations.is_some() {
            return None;
        }
        self.sql.relations = Some(vec![]);
        Some(Effect::Ask(Question::Names))
    }

    /// Runs the query.
    pub(super) fn run_query(&mut self) -> Vec<Effect> {
        let text = self.sql.editor.text().trim().to_owned();
        if text.is_empty() {
            self.say("no query is typed yet; o offers saved ones");
            return vec![];
        }
        if self.sql.asked.is_some() {
            self.say("a query is being answered; C-c cancels it");
            return vec![];
        }
        self.sql.history.retain(|known| *known != text);
        self.sql.history.push(text.clone());
        let surplus = self.sql.history.len().saturating_sub(MOST_KEPT);
        self.sql.history.drain(..surplus);
        self.sql.recalled = None;
        self.sql.editor.decline();
        self.sql.asked = Some(text.clone());
        self.sql.told = None;
        vec![Effect::Ask(Question::Rows(text))]
    }

    /// Takes in an answer.
    pub(super) fn answered(&mut self, ms: u64, outcome: Result<Box<Sheet>, String>) {
        let Some(text) = self.sql.asked.take() else { return };
        match outcome {
            Ok(sheet) => {
                let more = if sheet.is_cut() { "the first " } else { "" };
                let rows = if sheet.total() == 1 { "row" } else { "rows" };
                self.sql.told = Some(Ok(format!("{more}{} {rows} in {ms} ms", sheet.total())));
                self.nav.filters[Screen::Sql as usize].clear();
                (self.sql.sheet, self.sql.answered) = (Some(*sheet), text);
            }
            Err(error) => self.sql.told = Some(Err(error)),
        }
    }

    /// Puts an older or newer query of the history into the editor.
    pub(super) fn recall(&mut self, step: isize) {
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
    pub(super) fn offer_queries(&mut self) {
        self.overlay =
            Some(Overlay::Queries(QueryList { queries: self.sql.saved.clone(), text: String::new(), row: 0 }));
    }

    /// Puts a chosen query into the editor.
    pub(super) fn take_query(&mut self, text: &str) {
        self.show(Screen::Sql);
        self.nav.second_pane[Screen::Sql as usize] = false;
        self.sql.editor.set(text.trim_end());
    }

    /// Asks for the file that the rows go into.
    pub(super) fn export_query(&mut self) {
        if self.sql.sheet.is_none() {
            self.say("nothing to export yet: F5 runs the query");
            return;
        }
        self.overlay = Some(Overlay::Path(PathPrompt::export(self.sql.answered.clone())));
    }

    /// Goes on in the rows of the answer.
    pub(super) fn arrange_sheet(&mut self) {
        let filter = self.nav.filters[Screen::Sql as usize].clone();
        if let Some(sheet) = &mut self.sql.sheet {
            sheet.arrange(&filter);
        }
    }
}
