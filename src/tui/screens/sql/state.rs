//! Where the user is among queries.

use crate::widgets::editor::Editor;
use crate::widgets::result_table::ResultTable;
use store::{Relation, SavedQuery};

/// Where the user is among questions.
#[derive(Debug, Default)]
pub struct Sql {
    /// The query as it is typed.
    pub editor: Editor,
    /// Queries that were run, the oldest first.
    pub history: Vec<String>,
    /// The one of the history that is shown, and what was typed before it.
    pub recalled: Option<(usize, String)>,
    /// What a query may name; `None` until it was read.
    pub relations: Option<Vec<Relation>>,
    /// Queries kept in files.
    pub saved: Vec<SavedQuery>,
    /// The query that is being answered.
    pub running: Option<String>,
    /// The query that was answered last: that of the table.
    pub answered: String,
    /// Rows of the last answer, as they are looked at.
    pub table: Option<ResultTable>,
    /// How it went: rows and time, or what was wrong.
    pub outcome: Option<Result<String, String>>,
}
