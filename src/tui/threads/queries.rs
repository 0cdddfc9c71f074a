//! The thread that answers SQL queries, on a connection of its own, so that screens are updated during a long query.

use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use crate::messages::message::Message;
use crate::messages::requests::QueryRequest;
use crate::widgets::result_table::ResultTable;
use store::files::kind_of;
use store::{Encoder, InOrigin, Interrupter, Origin, Store, StudyError, save_query, saved_queries, sql};
use wardrobe::catalogue;

/// Most rows of an answer on the screen; a file gets all rows.
const MOST_ROWS: usize = 20_000;

/// Time before the first number of rows of an export is told, and between two of them.
const SOON: Duration = Duration::from_secs(1);

#[derive(Clone, Default)]
pub struct Canceller {
    is_on: Arc<AtomicBool>,
    interrupter: Arc<OnceLock<Interrupter>>,
}

impl Canceller {
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

pub fn serve(
    database: &Path,
    canceller: &Canceller,
    encoders: &[Encoder],
    wanted: &Receiver<QueryRequest>,
    sender: &Sender<Message>,
) {
    // Opened read-only, so no query can write.
    let store = catalogue::open(database, true).map_err(|error| error.to_string());
    if let Ok(store) = &store {
        // Set only once, since the thread starts only once.
        let _ = canceller.interrupter.set(sql::interrupter(store));
    }
    let folder = database.parent().unwrap_or(Path::new("")).join("queries");
    while let Ok(request) = wanted.recv() {
        let store = store.as_ref().map_err(Clone::clone);
        let start = Instant::now();
        let message = match request {
            QueryRequest::Names => names(store, &folder),
            QueryRequest::Save(sql, name) => {
                let saved = save_query(&folder, &name, &sql).map_err(|error| error.to_string());
                let told = saved.map(|()| format!("saved: o offers {name}, `toile sql {name}` asks it"));
                if sender.send(Message::Saved(told)).is_err() {
                    return;
                }
                names(store, &folder)
            }
            QueryRequest::Rename(from, to) => {
                if sender.send(Message::Saved(rename(&folder, &from, &to))).is_err() {
                    return;
                }
                names(store, &folder)
            }
            QueryRequest::Rows(text) => {
                let answer = store.and_then(|store| {
                    sql::answer(store, &text, MOST_ROWS, &canceller.is_on, &mut |_| {}).map_err(|error| said(&error))
                });
                let table = answer.map(|answer| Box::new(ResultTable::of(answer)));
                Message::Answered(start.elapsed().as_millis() as u64, table)
            }
            QueryRequest::Export(text, path) => {
                let mut told = start;
                let mut so_far = |rows: usize| {
                    if told.elapsed() >= SOON {
                        told = Instant::now();
                        // Fails if the workbench is ending, which the export notices at its end.
                        let _ = sender.send(Message::Done(format!("{rows} rows so far for {}", path.display())));
                    }
                };
                let rows = store.and_then(|store| {
                    export(store, &text, &path, canceller, encoders, &mut so_far).map_err(|error| said(&error))
                });
                Message::Saved(rows.map(|rows| format!("{rows} rows are in {}", path.display())))
            }
        };
        if sender.send(message).is_err() {
            return;
        }
    }
}

/// Writes all rows of a query into a new file, as its ending says. Returns their number.
fn export(
    store: &Store,
    text: &str,
    path: &Path,
    canceller: &Canceller,
    encoders: &[Encoder],
    so_far: &mut dyn FnMut(usize),
) -> Result<usize, StudyError> {
    let mut kinds = vec![("csv", None), ("json", None)];
    kinds.extend(encoders.iter().map(|(ending, encode)| (*ending, Some(*encode))));
    let Some(encode) = kind_of(path, &kinds).origin(Origin::Sql)? else {
        return sql::export_query(store, text, path, &canceller.is_on, so_far);
    };
    let table = sql::answer(store, text, usize::MAX, &canceller.is_on, so_far)?.table;
    let bytes = encode(&table).map_err(StudyError::io(path))?;
    let mut file = sql::new_file(path)?;
    file.write_all(&bytes).map_err(StudyError::io(path))?;
    Ok(table.rows.len())
}

/// Renames a saved query; queries of the program keep their names.
fn rename(folder: &Path, from: &str, to: &str) -> Result<String, String> {
    let said = |error: StudyError| error.to_string();
    let file = folder.join(format!("{from}.sql"));
    if !file.exists() {
        return Err(format!("{from} comes with the program and keeps its name; W saves a copy under another one"));
    }
    let saved = saved_queries(Some(folder)).map_err(said)?;
    if saved.iter().any(|query| query.name == to) {
        return Err(format!("there is a saved query {to} already; accepted: a name that none has"));
    }
    let sql = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    save_query(folder, to, &sql).map_err(said)?;
    std::fs::remove_file(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok(format!("{from} is {to} now"))
}

fn names(store: Result<&Store, String>, folder: &Path) -> Message {
    let names = store.and_then(|store| {
        let names = sql::relations(store).and_then(|known| Ok((known, saved_queries(Some(folder))?)));
        names.map_err(|error| error.to_string())
    });
    names.map_or_else(Message::Failed, |(relations, queries)| Message::Names(relations, queries))
}

fn said(error: &StudyError) -> String {
    match error {
        StudyError::Interrupted => "cancelled".to_owned(),
        StudyError::Database(inner) if inner.to_string().contains("interrupted") => "cancelled".to_owned(),
        StudyError::Database(inner) => inner.to_string(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_written_once_and_by_its_ending() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        let write = |name: &str| {
            let rows: [Encoder; 1] = [("parquet", |table| Ok(table.rows.len().to_string().into_bytes()))];
            let (path, canceller) = (folder.path().join(name), Canceller::default());
            let (mut told, text) = (0, "SELECT 1 AS n UNION SELECT 2");
            let written = export(&store, text, &path, &canceller, &rows, &mut |rows| told = rows);
            assert!(written.is_err() || told == 2, "{name}: {told} rows were told");
            written
        };
        let check = |name: &str, expect: &str| {
            assert_eq!(write(name).expect("written"), 2, "{name}");
            assert_eq!(std::fs::read_to_string(folder.path().join(name)).expect("there"), expect, "{name}");
        };
        check("rows.parquet", "2");
        check("rows.csv", "n\n1\n2\n");
        assert!(write("rows.parquet").is_err(), "it is there already");
        let told = write("rows.txt").expect_err("no such format").to_string();
        assert!(told.contains("accepted: X.csv, X.json or X.parquet"), "{told}");
    }

    #[test]
    fn saved_queries_get_other_names_that_none_has() {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        save_query(folder, "mine", "SELECT 1").expect("saved");
        save_query(folder, "yours", "SELECT 2").expect("saved");
        let builtin = saved_queries(None).expect("those of the program")[0].name.clone();
        let check = |from: &str, to: &str, expect: &str| {
            let told = rename(folder, from, to).unwrap_or_else(|error| error);
            assert!(told.contains(expect), "{from} to {to}: {told}");
        };
        check("mine", "yours", "there is a saved query yours already; accepted: a name that none has");
        check("mine", &builtin, "already");
        check("mine", "a/b", "`a/b` is no name of a query; accepted: letters");
        check(&builtin, "other", "comes with the program and keeps its name");
        check("mine", "ours", "mine is ours now");
        let names: Vec<String> =
            saved_queries(Some(folder)).expect("read").into_iter().map(|query| query.name).collect();
        assert!(names.contains(&"ours".to_owned()) && !names.contains(&"mine".to_owned()), "{names:?}");
        assert_eq!(store::saved_query(Some(folder), "ours").expect("there").trim(), "SELECT 1");
    }
}
