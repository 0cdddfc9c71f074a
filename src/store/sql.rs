//! Questions in SQL: a read-only connection with a few statistics SQLite does not have.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use rusqlite::functions::{Aggregate, Context, FunctionFlags};
use rusqlite::types::ValueRef;
use rusqlite::{Connection, Error};

use crate::browse;
use crate::database::Store;
use crate::error::{Result, StudyError};
use crate::files::write_files;
use crate::rows::{Table, Value};

/// Queries that come with the program.
const SAVED: [(&str, &str); 8] = [
    ("against_thesis", include_str!("../../db/queries/against_thesis.sql")),
    ("attention", include_str!("../../db/queries/attention.sql")),
    ("ease_and_error", include_str!("../../db/queries/ease_and_error.sql")),
    ("measurements", include_str!("../../db/queries/measurements.sql")),
    ("preposition", include_str!("../../db/queries/preposition.sql")),
    ("sizes", include_str!("../../db/queries/sizes.sql")),
    ("thesis_table", include_str!("../../db/queries/thesis_table.sql")),
    ("times", include_str!("../../db/queries/times.sql")),
];

/// A query that has a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedQuery {
    /// Name by which it is asked for.
    pub name: String,
    /// What it asks: its first line, where that is a comment.
    pub about: String,
    /// Text of the query.
    pub sql: String,
}

/// The saved queries by name: those of the program, and of a folder with a file NAME.sql each, which win.
///
/// # Errors
/// When the folder has a file that cannot be read.
pub fn saved_queries(folder: Option<&Path>) -> Result<Vec<SavedQuery>> {
    let mut found: BTreeMap<String, String> = BTreeMap::new();
    found.extend(SAVED.iter().map(|(name, sql)| ((*name).to_owned(), (*sql).to_owned())));
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
    for path in entries.into_iter().flatten().flatten().map(|entry| entry.path()) {
        if path.extension().is_some_and(|extension| extension == "sql") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            found.insert(name, std::fs::read_to_string(&path).map_err(StudyError::io(&path))?);
        }
    }
    let about = |sql: &str| sql.lines().next().and_then(|line| line.strip_prefix("-- ")).unwrap_or_default().to_owned();
    Ok(found.into_iter().map(|(name, sql)| SavedQuery { about: about(&sql), name, sql }).collect())
}

/// Saves a query under a name in a folder, over one of that name.
///
/// # Errors
/// When the name is none of a file, or it cannot be written.
pub fn save_query(folder: &Path, name: &str, sql: &str) -> Result<()> {
    let is_plain = |c: char| c.is_alphanumeric() || "-_ .".contains(c);
    if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
        let problem = format!("`{name}` is no name of a query; accepted: letters, digits, - _ . and blanks");
        return Err(StudyError::stage("sql")(problem));
    }
    write_files(folder, &[(format!("{name}.sql"), format!("{}\n", sql.trim_end()).into_bytes())]).map(drop)
}

/// The text of a saved query.
///
/// # Errors
/// When there is none of that name.
pub fn saved_query(folder: Option<&Path>, name: &str) -> Result<String> {
    let saved = saved_queries(folder)?;
    let known = saved.iter().map(|saved| saved.name.clone()).collect();
    let found = saved.into_iter().find(|saved| saved.name == name);
    found.map(|saved| saved.sql).ok_or_else(|| StudyError::NotFound {
        what: "saved query",
        name: name.to_owned(),
        known,
    })
}

/// Stops a query that another thread waits for.
pub struct Interrupter(rusqlite::InterruptHandle);

impl Interrupter {
    /// Makes the query that runs now end with an error; does nothing when none runs.
    pub fn interrupt(&self) {
        self.0.interrupt();
    }
}

/// A handle that stops a running [`query`] from another thread.
#[must_use]
pub fn interrupter(store: &Store) -> Interrupter {
    Interrupter(store.reader.get_interrupt_handle())
}

/// Answers a query, or several separated by `;` (the last one's rows). Nothing can be written this way.
///
/// Besides SQLite's own functions there are `median(x)`, `stddev(x)` (sample, n-1) and `quantile(x, p)` (p in 0 to
/// 1, linear between order statistics).
///
/// # Errors
/// What SQLite says of the query; [`StudyError::Interrupted`] when an [`Interrupter`] stopped it.
pub fn query(store: &Store, sql: &str) -> Result<Table> {
    Ok(browse::answer(store, sql, usize::MAX, &AtomicBool::new(false))?.table)
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

/// Adds the statistics to a connection.
pub(crate) fn add_functions(connection: &Connection) -> rusqlite::Result<()> {
    let flags = FunctionFlags::SQLITE_UTF8 | FunctionFlags::SQLITE_DETERMINISTIC;
    connection.create_aggregate_function("median", 1, flags, Quantile)?;
    connection.create_aggregate_function("quantile", 2, flags, Quantile)?;
    connection.create_aggregate_function("stddev", 1, flags, Deviation)
}

/// `quantile(x, p)`, and `median(x)` with p = 1/2.
struct Quantile;

/// Numbers of a group and the share asked for.
struct Sample {
    values: Vec<f64>,
    share: f64,
}

impl Aggregate<Sample, Option<f64>> for Quantile {
    fn init(&self, _: &mut Context<'_>) -> rusqlite::Result<Sample> {
        Ok(Sample { values: Vec::new(), share: 0.5 })
    }

    fn step(&self, context: &mut Context<'_>, sample: &mut Sample) -> rusqlite::Result<()> {
        if context.len() > 1 {
            sample.share = context.get(1)?;
            if !(0.0..=1.0).contains(&sample.share) {
                let message = format!("quantile: share {} is not between 0 and 1", sample.share);
                return Err(Error::UserFunctionError(message.into()));
            }
        }
        sample.values.extend(context.get::<Option<f64>>(0)?);
        Ok(())
    }

    fn finalize(&self, _: &mut Context<'_>, sample: Option<Sample>) -> rusqlite::Result<Option<f64>> {
        Ok(sample.and_then(|mut sample| {
            sample.values.sort_by(f64::total_cmp);
            let last = sample.values.len().checked_sub(1)?;
            let place = sample.share * last as f64;
            let (low, high) = (sample.values[place.floor() as usize], sample.values[place.ceil() as usize]);
            Some(low + (high - low) * place.fract())
        }))
    }
}

/// `stddev(x)`: sample standard deviation by Welford's update [Welford 1962]; NULL for fewer than two numbers.
struct Deviation;

/// Running mean and sum of squared deviations.
#[derive(Default)]
struct Moments {
    n: f64,
    mean: f64,
    squares: f64,
}

impl Aggregate<Moments, Option<f64>> for Deviation {
    fn init(&self, _: &mut Context<'_>) -> rusqlite::Result<Moments> {
        Ok(Moments::default())
    }

    fn step(&self, context: &mut Context<'_>, moments: &mut Moments) -> rusqlite::Result<()> {
        if let Some(x) = context.get::<Option<f64>>(0)? {
            moments.n += 1.0;
            let off = x - moments.mean;
            moments.mean += off / moments.n;
            moments.squares += off * (x - moments.mean);
        }
        Ok(())
    }

    fn finalize(&self, _: &mut Context<'_>, moments: Option<Moments>) -> rusqlite::Result<Option<f64>> {
        Ok(moments.filter(|m| m.n > 1.0).map(|m| (m.squares / (m.n - 1.0)).sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_those_of_the_textbook() {
        let connection = Connection::open_in_memory().expect("memory");
        add_functions(&connection).expect("new names");
        let check = |expression: &str, values: &str, expected: Option<f64>| {
            let sql = format!("SELECT {expression} FROM (SELECT value AS x FROM json_each('{values}'))");
            let found: Option<f64> = connection.query_row(&sql, [], |row| row.get(0)).expect("valid");
            match (found, expected) {
                (Some(found), Some(expected)) => {
                    assert!((found - expected).abs() < 1e-12, "{expression} {values}: {found}")
                }
                _ => assert_eq!(found, expected, "{expression} {values}"),
            }
        };
        check("median(x)", "[3, 1, 2]", Some(2.0));
        check("median(x)", "[4, 1, 2, 3]", Some(2.5));
        check("median(x)", "[]", None);
        check("median(x)", "[1, null]", Some(1.0));
        check("quantile(x, 0.25)", "[0, 1, 2, 3, 4]", Some(1.0));
        check("stddev(x)", "[2, 4, 4, 4, 5, 5, 7, 9]", Some((32.0f64 / 7.0).sqrt()));
        check("stddev(x)", "[1]", None);
        assert!(connection.query_row("SELECT quantile(1, 2)", [], |_| Ok(())).is_err());
    }
}
