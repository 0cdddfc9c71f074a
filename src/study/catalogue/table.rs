//! Entries of the catalogue from a CSV table: a column a key, a row an entry.

use std::collections::BTreeSet;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::catalogue::format::text_of;
use crate::catalogue::{Part, check_name};
use crate::error::{Problem, nearest};
use crate::spec::fields::{Entry, Given, filled, keys};
use crate::spec::file::Placed;

/// Columns that hold the name of an entry, besides that of its part (`subject`).
const NAMES: [&str; 2] = ["name", "id"];
/// Columns that views have besides the values of an entry.
const IGNORED: [&str; 4] = ["revision", "hash", "is_latest", "is_retired"];

/// Reads a table; columns may be divided by commas, semicolons or tabs, empty cells are no values.
///
/// # Errors
/// Everything that is wrong with it.
pub(super) fn read<T: Entry>(path: &Path, part: Part, bytes: &[u8]) -> Result<Vec<Placed<T>>, Vec<Problem>> {
    let text = text_of(path, bytes)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let head = text.lines().next().unwrap_or_default();
    let delimiter = [b',', b';', b'\t'].into_iter().max_by_key(|mark| head.bytes().filter(|byte| byte == mark).count());
    let mut reader = ReaderBuilder::new()
        .delimiter(delimiter.unwrap_or(b','))
        .flexible(true)
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let unreadable = |error: csv::Error| {
        let line = error.position().map(|position| position.line() as usize);
        vec![Problem { line, ..Problem::of(path, error.to_string()) }]
    };
    let header = reader.headers().map_err(unreadable)?.clone();
    let mut problems = header_problems::<T>(path, part, &header);
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut entries = Vec::new();
    let mut names = BTreeSet::new();
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, |position| position.line() as usize);
        match row(part, &header, &record) {
            Ok((name, _)) if !names.insert(name.clone()) => {
                problems.push(Problem::at(path, line, format!("{part} `{name}` is there twice; names must differ")));
            }
            Ok((name, entry)) => entries.push(Placed { file: path.to_owned(), line, name, entry }),
            Err(found) => problems.extend(found.into_iter().map(|message| Problem::at(path, line, message))),
        }
    }
    if problems.is_empty() { Ok(entries) } else { Err(problems) }
}

/// Whether a column holds the name.
fn is_name(part: Part, column: &str) -> bool {
    column == part.as_str() || NAMES.contains(&column)
}

fn header_problems<T: Entry>(path: &Path, part: Part, header: &StringRecord) -> Vec<Problem> {
    let accepted = keys::<T>();
    let mut problems = Vec::new();
    if !header.iter().any(|column| is_name(part, column)) {
        problems.push(format!("no column `name`; accepted: name, {}", accepted.join(", ")));
    }
    for (k, column) in header.iter().enumerate() {
        let place = format!("column {}", k + 1);
        if header.iter().take(k).any(|before| before == column) {
            problems.push(format!("{place}: `{column}` is there twice"));
        } else if !(accepted.contains(&column) || is_name(part, column) || IGNORED.contains(&column)) {
            let hint = match nearest(column, accepted.iter().copied().chain(["name"])) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("accepted: name, {}", accepted.join(", ")),
            };
            problems.push(format!("{place}: unknown column `{column}`; {hint}"));
        }
    }
    problems.into_iter().map(|message| Problem::at(path, 1, message)).collect()
}

/// Name and entry of a row.
fn row<T: Entry>(part: Part, header: &StringRecord, record: &StringRecord) -> Result<(String, T), Vec<String>> {
    if record.len() != header.len() {
        return Err(vec![format!("{} cells; accepted: {}, as in the first line", record.len(), header.len())]);
    }
    let cells = || header.iter().zip(record.iter());
    let name = cells().find(|(column, _)| is_name(part, column)).map_or("", |(_, cell)| cell);
    let given: Vec<Given> = cells()
        .filter(|(column, cell)| !cell.is_empty() && !is_name(part, column) && !IGNORED.contains(column))
        .map(|(column, cell)| (column.to_owned(), cell.to_owned()))
        .collect();
    let placed = |(key, problem): Given| match header.iter().position(|column| column == key) {
        Some(k) => format!("column {}: {problem}", k + 1),
        None => problem,
    };
    check_name(name).map_err(|problem| vec![problem])?;
    filled(None, name, &given)
        .map(|entry| (name.to_owned(), entry))
        .map_err(|problems| problems.into_iter().map(placed).collect())
}
