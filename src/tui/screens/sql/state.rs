//! State of the SQL screen.

use crate::widgets::editor::Editor;
use crate::widgets::result_table::ResultTable;
use store::{Relation, SavedQuery};

#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Queries {
    /// Texts before and after the present query, and in its place what it was when it came into the editor.
    pub texts: Vec<String>,
    pub at: usize,
}

pub struct Recalled {
    /// Index in the history.
    pub index: usize,
    /// Text of the editor before the query was shown.
    pub typed: String,
}

#[derive(Default)]
pub struct SqlScreen {
    pub editor: Editor,
    /// Queries that are being written; the text of the present one is in the editor.
    pub queries: Queries,
    /// Queries that were run, the oldest first.
    pub history: Vec<String>,
    /// Query of the history that is shown; `None` while the text is another.
    pub recalled: Option<Recalled>,
    /// Tables and views that a query may name; `None` until they are read.
    pub relations: Option<Vec<Relation>>,
    pub saved: Vec<SavedQuery>,
    pub running: Option<String>,
    /// Query whose answer is in `table`.
    pub answered: String,
    pub table: Option<ResultTable>,
    /// Number of rows and duration of the last answer, or the error.
    pub outcome: Option<Result<String, String>>,
}
