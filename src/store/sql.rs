//! Queries in SQL, on a connection that cannot write.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use rusqlite::ErrorCode;
use rusqlite::fallible_iterator::FallibleIterator;
use rusqlite::types::ValueRef;

use crate::database::Store;
use crate::error::{InOrigin, Origin, Result, StudyError, nearest};
use crate::files::kind_of;
use crate::rows::{Table, Value, csv_head, csv_row, distinct};

/// Handle by which another thread stops a query.
pub struct Interrupter(rusqlite::InterruptHandle);

impl Interrupter {
    /// Does nothing where no query runs.
    pub fn interrupt(&self) {
        self.0.interrupt();
    }
}

pub fn interrupter(store: &Store) -> Interrupter {
    Interrupter(store.reader.get_interrupt_handle())
}

/// Returns the rows of a query; of several statements separated by `;`, those of the last. No statement can write.
/// Fails with [`StudyError::Interrupted`] where an [`Interrupter`] stopped it.
///
/// Besides SQLite's own functions there are `median(x)`, `stddev(x)` (sample, n-1) and `quantile(x, p)` (p in 0 to 1,
/// linear between order statistics).
pub fn query(store: &Store, sql: &str) -> Result<Table> {
    Ok(answer(store, sql, usize::MAX, &AtomicBool::new(false), &mut |_| {})?.table)
}

pub(crate) fn value(value: ValueRef<'_>) -> Value {
    match value {
        ValueRef::Null => Value::Null,
        ValueRef::Integer(number) => Value::Integer(number),
        ValueRef::Real(number) => Value::Real(number),
        ValueRef::Text(text) => Value::Text(String::from_utf8_lossy(text).into_owned()),
        ValueRef::Blob(bytes) => Value::Blob(bytes.len()),
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct SqlAnswer {
    pub table: Table,
    /// True where the query has more rows than the limit.
    pub is_cut: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Relation {
    pub name: String,
    pub columns: Vec<String>,
}

/// Returns at most `most` rows of a query, as [`query`] does; `stop` ends it early, `so_far` is told the number of rows
/// after each.
pub fn answer(
    store: &Store,
    text: &str,
    most: usize,
    stop: &AtomicBool,
    so_far: &mut dyn FnMut(usize),
) -> Result<SqlAnswer> {
    let mut answer = SqlAnswer::default();
    each_row(store, text, stop, |columns, row| {
        if answer.table.columns != columns {
            answer.table.columns = columns.to_vec();
        }
        if let Some(row) = row {
            answer.is_cut = answer.table.rows.len() == most;
            if !answer.is_cut {
                answer.table.rows.push(row);
                so_far(answer.table.rows.len());
            }
        } else {
            answer.table.rows.clear();
        }
        Ok(!answer.is_cut)
    })?;
    Ok(answer)
}

/// Writes all rows of a query into a new file, CSV or JSON by its ending, and returns their number. `stop` ends it
/// early, `so_far` is told the number of rows after each.
pub fn export_query(
    store: &Store,
    text: &str,
    path: &Path,
    stop: &AtomicBool,
    so_far: &mut dyn FnMut(usize),
) -> Result<usize> {
    let is_json = kind_of(path, &[("csv", false), ("json", true)]).origin(Origin::Sql)?;
    let file = new_file(path)?;
    let mut out = BufWriter::new(file);
    let (mut rows, mut names) = (0, Vec::new());
    let written = each_row(store, text, stop, |columns, row| {
        let line = match (&row, is_json) {
            (None, true) => {
                names = distinct(columns);
                String::new()
            }
            (None, false) => csv_head(columns),
            (Some(row), true) => format!("{}{}", if rows == 0 { "[\n" } else { ",\n" }, json_line(&names, row)),
            (Some(row), false) => csv_row(row),
        };
        rows += usize::from(row.is_some());
        out.write_all(line.as_bytes()).map_err(StudyError::io(path))?;
        so_far(rows);
        Ok(true)
    });
    let end = match (is_json, rows) {
        (false, _) => "",
        (true, 0) => "[]\n",
        (true, _) => "\n]\n",
    };
    let written =
        written.and_then(|()| out.write_all(end.as_bytes()).and_then(|()| out.flush()).map_err(StudyError::io(path)));
    if written.is_err() {
        // Half a file would pass for a whole one. Failing to remove it is the lesser error.
        let _ = fs::remove_file(path);
    }
    written.map(|()| rows)
}

/// Fails with [`StudyError::Exists`] where there is one of that name.
pub fn new_file(path: &Path) -> Result<File> {
    File::create_new(path).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => StudyError::Exists { what: "file", name: path.display().to_string() },
        _ => StudyError::io(path)(error),
    })
}

/// Calls `take` for the last statement of a text: with its columns and no row, then with each row, until it returns
/// false.
fn each_row(
    store: &Store,
    text: &str,
    stop: &AtomicBool,
    take: impl FnMut(&[String], Option<Vec<Value>>) -> Result<bool>,
) -> Result<()> {
    walk_rows(store, text, stop, take).map_err(|error| match error {
        StudyError::Database(error) if error.sqlite_error_code() == Some(ErrorCode::OperationInterrupted) => {
            StudyError::Interrupted
        }
        StudyError::Database(error) => refusal(store, text, error),
        error => error,
    })
}

#[derive(Debug, thiserror::Error)]
#[error("{said}{hint}")]
struct QueryError {
    said: String,
    hint: String,
}

/// Error of a query, with the name that was meant where one is near to a name that is not there.
fn refusal(store: &Store, text: &str, error: rusqlite::Error) -> StudyError {
    let said = match &error {
        // SQLite repeats the whole query, which its author knows.
        rusqlite::Error::SqlInputError { msg, .. } => msg.clone(),
        other => other.to_string(),
    };
    let unknown = |kind: &str| said.strip_prefix(kind).map(|name| name.rsplit('.').next().unwrap_or(name).to_owned());
    let known = relations(store).unwrap_or_default();
    let hint = match (unknown("no such column: "), unknown("no such table: ")) {
        (Some(column), _) => {
            let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
            let is_named = |relation: &&Relation| words.iter().any(|word| word.eq_ignore_ascii_case(&relation.name));
            let named: Vec<&Relation> = known.iter().filter(is_named).collect();
            let columns = named.iter().flat_map(|relation| &relation.columns).map(String::as_str);
            did_you_mean(&column, columns)
        }
        (_, Some(table)) => did_you_mean(&table, known.iter().map(|relation| relation.name.as_str())),
        _ if error.sqlite_error_code() == Some(ErrorCode::ReadOnly) => {
            "; a query only reads: `toile subject`, `style`, `fabric` and `queue` change what is here".to_owned()
        }
        _ => String::new(),
    };
    StudyError::refused(Origin::Sql, QueryError { said, hint })
}

/// Empty where none is near.
fn did_you_mean<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    nearest(name, known).map_or(String::new(), |near| format!("; did you mean `{near}`?"))
}

fn walk_rows(
    store: &Store,
    text: &str,
    stop: &AtomicBool,
    mut take: impl FnMut(&[String], Option<Vec<Value>>) -> Result<bool>,
) -> Result<()> {
    let mut batch = rusqlite::Batch::new(&store.reader, text);
    let mut next = batch.next()?;
    while let Some(mut statement) = next {
        next = batch.next()?;
        let columns: Vec<String> = statement.column_names().map(str::to_owned).collect();
        let is_last = next.is_none();
        if is_last {
            take(&columns, None)?;
        }
        let mut found = statement.raw_query();
        while let Some(row) = found.next()? {
            if stop.load(Ordering::Relaxed) {
                return Err(StudyError::Interrupted);
            }
            let values = || (0..columns.len()).map(|k| row.get_ref(k).map(value)).collect::<rusqlite::Result<_>>();
            if is_last && !take(&columns, Some(values()?))? {
                return Ok(());
            }
        }
    }
    Ok(())
}

/// Views and tables that a query may name, views first.
pub fn relations(store: &Store) -> Result<Vec<Relation>> {
    let table = query(
        store,
        "SELECT m.name, p.name FROM sqlite_schema AS m JOIN pragma_table_info(m.name) AS p
        WHERE m.type IN ('view', 'table') AND m.name NOT GLOB 'sqlite_*' ORDER BY m.type DESC, m.name, p.cid",
    )?;
    let mut found: Vec<Relation> = Vec::new();
    for row in &table.rows {
        let (name, column) = (row[0].to_string(), row[1].to_string());
        match found.last_mut().filter(|last| last.name == name) {
            Some(last) => last.columns.push(column),
            None => found.push(Relation { name, columns: vec![column] }),
        }
    }
    Ok(found)
}

/// Keys follow the order of the columns.
fn json_line(columns: &[String], row: &[Value]) -> String {
    let cells = row.iter().map(serde_json::Value::from);
    let object: serde_json::Map<_, _> = columns.iter().cloned().zip(cells).collect();
    serde_json::Value::Object(object).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open() -> (tempfile::TempDir, Store) {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        (folder, store)
    }

    fn counted(to: u32) -> String {
        format!(
            "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n WHERE x < {to}) SELECT x, 'a,\"b' AS t FROM n"
        )
    }

    #[test]
    fn answers_end_at_the_bound_and_say_so() {
        let (_folder, store) = open();
        let go = AtomicBool::new(false);
        let check = |sql: &str, rows: usize, is_cut: bool| {
            let answer = answer(&store, sql, 3, &go, &mut |_| {}).expect("a right query");
            assert_eq!((answer.table.rows.len(), answer.is_cut), (rows, is_cut), "{sql}");
        };
        check(&counted(2), 2, false);
        check(&counted(3), 3, false);
        check(&counted(4), 3, true);
        check("SELECT 1; SELECT 2 UNION SELECT 3", 2, false);
        check("-- nothing", 0, false);
        let mut none = |_| {};
        assert_eq!(answer(&store, "SELECT 1 AS a WHERE 0", 3, &go, &mut none).expect("right").table.columns, ["a"]);
        let stopped = answer(&store, &counted(9), 9, &AtomicBool::new(true), &mut none);
        assert!(matches!(stopped, Err(StudyError::Interrupted)));
        let mut told = vec![];
        answer(&store, &counted(3), 9, &go, &mut |rows| told.push(rows)).expect("right");
        assert_eq!(told, [1, 2, 3]);
        for wrong in ["DELETE FROM job", "SELECT nothing", "SELECT ("] {
            assert!(answer(&store, wrong, 3, &go, &mut none).is_err(), "{wrong}");
        }
    }

    #[test]
    fn files_hold_all_rows_and_none_is_overwritten() {
        let (folder, store) = open();
        let go = AtomicBool::new(false);
        let mut most = 0;
        let mut write = |name: &str, sql: &str| {
            export_query(&store, sql, &folder.path().join(name), &go, &mut |rows| most = rows.max(most))
        };
        let text = |name: &str| fs::read_to_string(folder.path().join(name)).expect("written");
        assert_eq!(write("a.csv", &counted(2)).expect("written"), 2);
        assert_eq!(text("a.csv"), "x,t\n1,\"a,\"\"b\"\n2,\"a,\"\"b\"\n");
        assert_eq!(write("a.json", &counted(2)).expect("written"), 2);
        let rows: serde_json::Value = serde_json::from_str(&text("a.json")).expect("JSON");
        assert_eq!(rows, serde_json::json!([{"x": 1, "t": "a,\"b"}, {"x": 2, "t": "a,\"b"}]));
        write("none.json", "SELECT 1 AS a WHERE 0").expect("written");
        assert_eq!(text("none.json"), "[]\n");
        write("twice.json", "SELECT 1 AS a, 2 AS a").expect("written");
        assert_eq!(text("twice.json"), "[\n{\"a\":1,\"a_2\":2}\n]\n");
        write("c.CSV", "SELECT '=1+2' AS '-x', -5 AS y, '-5' AS z, '@a' AS w").expect("written");
        assert_eq!(text("c.CSV"), "'-x,y,z,w\n'=1+2,-5,-5,'@a\n");
        assert!(write("a.csv", "SELECT 1").is_err(), "it is there already");
        for other in ["a.parquet", "a.txt", "a"] {
            let told = write(other, "SELECT 1").expect_err(other).to_string();
            assert!(told.contains("accepted: X.csv or X.json") && !folder.path().join(other).exists(), "{told}");
        }
        assert!(write("b.csv", "SELECT nothing").is_err() && !folder.path().join("b.csv").exists());
        assert_eq!(most, 2, "rows are told while they are written");
    }

    #[test]
    fn a_refused_query_is_told_what_helps() {
        let (_folder, store) = open();
        let check = |text: &str, expect: &str| {
            let told = query(&store, text).expect_err(text).to_string();
            assert_eq!(told, expect, "{text}");
        };
        check("SELECT subjct FROM v_metrics", "sql: no such column: subjct; did you mean `subject`?");
        check("SELECT m.subjct FROM v_metrics AS m", "sql: no such column: m.subjct; did you mean `subject`?");
        check("SELECT qqqqqq FROM v_metrics", "sql: no such column: qqqqqq");
        check("SELECT ei FROM v_metric", "sql: no such table: v_metric; did you mean `v_metrics`?");
        check(
            "DELETE FROM job",
            "sql: attempt to write a readonly database; a query only reads: `toile subject`, `style`, `fabric` and `queue` \
             change what is here",
        );
    }

    #[test]
    fn views_come_first_with_their_columns() {
        let (_folder, store) = open();
        let relations = relations(&store).expect("readable");
        assert!(relations[0].name.starts_with("v_"), "{}", relations[0].name);
        let chi = relations.iter().find(|relation| relation.name == "v_chi").expect("a contract view");
        assert!(chi.columns.iter().any(|column| column == "l2d_mm"));
    }
}
