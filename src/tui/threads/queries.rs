//! The thread that asks the database what users ask in SQL. It has a connection of its own, so that the screens go on
//! while a long query runs.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

use crate::messages::message::Message;
use crate::messages::requests::QueryRequest;
use crate::widgets::result_table::ResultTable;
use study::{Interrupter, StudyError, Workspace, save_query, saved_queries};

/// Rows that are shown of an answer; a file gets all.
const MOST_ROWS: usize = 20_000;

/// Stops what the thread works on.
#[derive(Clone, Default)]
pub struct Canceller {
    is_on: Arc<AtomicBool>,
    interrupter: Arc<OnceLock<Interrupter>>,
}

impl Canceller {
    /// Ends the query that runs now.
    pub fn cancel(&self) {
        self.is_on.store(true, Ordering::Relaxed);
        if let Some(interrupter) = self.interrupter.get() {
            interrupter.interrupt();
        }
    }

    /// Lets the next query run.
    pub fn reset(&self) {
        self.is_on.store(false, Ordering::Relaxed);
    }
}

/// Answers until nobody asks or listens any more.
pub fn serve(database: &Path, canceller: &Canceller, wanted: &Receiver<QueryRequest>, sender: &Sender<Message>) {
    // Whatever a query says, it cannot write.
    let workspace = Workspace::open(database, true).map_err(|error| error.to_string());
    if let Ok(workspace) = &workspace {
        // The thread is started once, and so is its interrupter set.
        let _ = canceller.interrupter.set(workspace.interrupter());
    }
    let folder = database.parent().unwrap_or(Path::new("")).join("queries");
    while let Ok(request) = wanted.recv() {
        let workspace = workspace.as_ref().map_err(Clone::clone);
        let start = Instant::now();
        let message = match request {
            QueryRequest::Names => names(workspace, &folder),
            QueryRequest::Save(sql, name) => {
                let saved = save_query(&folder, &name, &sql).map_err(|error| error.to_string());
                let told = saved.map(|()| format!("saved: o offers {name}, `toile sql {name}` asks it"));
                if sender.send(Message::Saved(told)).is_err() {
                    return;
                }
                names(workspace, &folder)
            }
            QueryRequest::Rows(text) => {
                let answer = workspace
                    .and_then(|it| it.answer(&text, MOST_ROWS, &canceller.is_on).map_err(|error| said(&error)));
                let table = answer.map(|answer| Box::new(ResultTable::of(answer)));
                Message::Answered(start.elapsed().as_millis() as u64, table)
            }
            QueryRequest::Export(text, path) => {
                let rows = workspace
                    .and_then(|it| it.export_query(&text, &path, &canceller.is_on).map_err(|error| said(&error)));
                Message::Saved(rows.map(|rows| format!("{rows} rows are in {}", path.display())))
            }
        };
        if sender.send(message).is_err() {
            return;
        }
    }
}

/// What a query may name, and the saved ones.
fn names(workspace: Result<&Workspace, String>, folder: &Path) -> Message {
    let names = workspace.and_then(|it| {
        let names = it.relations().and_then(|known| Ok((known, saved_queries(Some(folder))?)));
        names.map_err(|error| error.to_string())
    });
    names.map_or_else(Message::Failed, |(relations, queries)| Message::Names(relations, queries))
}

/// An error of a query; one that was stopped says so.
fn said(error: &StudyError) -> String {
    match error {
        StudyError::Interrupted => "cancelled".to_owned(),
        StudyError::Database(inner) if inner.to_string().contains("interrupted") => "cancelled".to_owned(),
        StudyError::Database(inner) => inner.to_string(),
        other => other.to_string(),
    }
}
