//! State of the screen of queries.

use crate::widgets::editor::Editor;
use crate::widgets::result_table::ResultTable;
use store::{Relation, SavedQuery};

/// A query of the history that is shown in the editor.
pub struct Recalled {
    /// Its index in the history.
    pub index: usize,
    /// The text that was typed before it was shown.
    pub typed: String,
}

/// The screen of queries.
#[derive(Default)]
pub struct SqlScreen {
    /// The query as it is typed.
    pub editor: Editor,
    /// Queries that were run, the oldest first.
    pub history: Vec<String>,
    /// The query of the history that is shown.
    pub recalled: Option<Recalled>,
    /// Tables and views that a query may name; `None` until they were read.
    pub relations: Option<Vec<Relation>>,
    /// Queries kept in files.
    pub saved: Vec<SavedQuery>,
    /// The query that is being answered.
    pub running: Option<String>,
    /// The query that was answered last: that of the table.
    pub answered: String,
    /// Rows of the last answer, as they are looked at.
    pub table: Option<ResultTable>,
    /// Number of rows and time of the last answer, or the error.
    pub outcome: Option<Result<String, String>>,
}
