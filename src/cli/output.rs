//! Output: data on standard output as a table, CSV, JSON or Parquet; everything else on standard error.

use std::io::{self, Write};
use std::path::Path;

use comfy_table::{CellAlignment, ContentArrangement, Table as Grid, TableComponent, presets};
use serde_json::{Map, Value as Json};

use super::CliError;
use super::args::Format;
use geom::units::significant;
use store::{Table, Value, distinct, files};

pub fn tell(message: &impl std::fmt::Display) {
    note(&format!("toile: {message}"));
}

/// Prints a message on standard error. Escapes control characters in names and file contents, which could steer the
/// terminal.
pub fn note(text: &impl std::fmt::Display) {
    eprintln!("{}", printable(&text.to_string()));
}

/// Text with escaped control characters, except line feeds and tabs.
pub fn printable(text: &str) -> String {
    let is_plain = |c: char| !c.is_control() || matches!(c, '\n' | '\t');
    text.chars().map(|c| if is_plain(c) { c.to_string() } else { c.escape_default().to_string() }).collect()
}

/// Format of a file to be written: that of the accepted endings which its name has.
pub fn kind<T: Copy>(path: &Path, accepted: &[(&str, T)]) -> Result<T, CliError> {
    files::kind_of(path, accepted).map_err(|error| CliError::Usage(error.to_string()))
}

/// Format of a file to be written: that of its ending, or `asked` for a name without ending.
pub fn kind_or<T: Copy + PartialEq>(path: &Path, asked: Option<T>, accepted: &[(&str, T)]) -> Result<T, CliError> {
    let Some(asked) = asked else { return kind(path, accepted) };
    if path.extension().is_none() {
        return Ok(asked);
    }
    let endings: Vec<(&str, T)> = accepted.iter().copied().filter(|(_, format)| *format == asked).collect();
    kind(path, &endings).map_err(|error| CliError::Usage(format!("--format contradicts the file's name: {error}")))
}

/// Refuses a folder whose name ends like the files for it: it is probably meant as a file.
pub fn folder(path: &Path, endings: &[&str]) -> Result<(), CliError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    if path.is_dir() || !endings.iter().any(|ending| extension.eq_ignore_ascii_case(ending)) {
        return Ok(());
    }
    Err(CliError::Usage(format!(
        "{}: found a name of a file; accepted: a folder, into which files are written",
        path.display()
    )))
}

/// Closed pipe (`| head`) is no error.
pub fn text(text: &str) -> io::Result<()> {
    bytes(text.as_bytes())
}

/// Writes as [`text`] does.
pub fn bytes(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

pub fn json(value: &impl serde::Serialize) -> io::Result<()> {
    text(&document(value)?)
}

fn document(value: &impl serde::Serialize) -> io::Result<String> {
    let mut document = serde_json::to_string_pretty(value)?;
    document.push('\n');
    Ok(document)
}

pub fn table(table: &Table, format: Format) -> io::Result<()> {
    bytes(&encoded(table, format)?)
}

pub fn encoded(table: &Table, format: Format) -> io::Result<Vec<u8>> {
    Ok(match format {
        Format::Table => pretty(table).into_bytes(),
        Format::Csv => table.csv().into_bytes(),
        Format::Json => document(&rows(table))?.into_bytes(),
        Format::Parquet => super::parquet::bytes(table),
        Format::Xlsx => super::xlsx::bytes(&[("rows", table)])?,
    })
}

/// `None` where standard output is no terminal, or the terminal does not say.
pub fn terminal_width() -> Option<usize> {
    let is_terminal = io::IsTerminal::is_terminal(&io::stdout());
    Grid::new().width().filter(|columns| is_terminal && *columns > 0).map(usize::from)
}

const GAP: usize = 3;

/// Columns of a table that fit into a width side by side without a broken line, from the left, and the number of those
/// left out.
pub fn fitting(table: Table, width: usize) -> (Table, usize) {
    let widest = |k: usize| {
        let cells = table.rows.iter().map(|row| short(&row[k]).chars().count());
        cells.chain([table.columns[k].chars().count()]).max().unwrap_or(0) + GAP
    };
    let mut left = width;
    let fits = |k: &usize| {
        let taken = widest(*k);
        let is_fit = taken <= left;
        left = left.saturating_sub(taken);
        is_fit
    };
    let kept = (0..table.columns.len()).take_while(fits).count().max(1).min(table.columns.len());
    let out = table.columns.len() - kept;
    let Table { mut columns, mut rows } = table;
    columns.truncate(kept);
    rows.iter_mut().for_each(|row| row.truncate(kept));
    (Table { columns, rows }, out)
}

/// Table as text. Numbers are right-aligned and have at most six significant digits.
pub fn pretty(table: &Table) -> String {
    let mut grid = Grid::new();
    grid.load_preset(presets::NOTHING);
    for line in [TableComponent::HeaderLines, TableComponent::MiddleHeaderIntersections] {
        grid.set_style(line, '─');
    }
    // A terminal wraps wide tables to its width; a file or a pipe gets whole lines.
    let is_wrapped = terminal_width().is_some();
    grid.set_content_arrangement(if is_wrapped { ContentArrangement::Dynamic } else { ContentArrangement::Disabled });
    grid.set_header(&table.columns);
    for row in &table.rows {
        grid.add_row(row.iter().map(short));
    }
    for (index, column) in grid.column_iter_mut().enumerate() {
        let is_text = |row: &Vec<Value>| matches!(row.get(index), Some(Value::Text(_)));
        if !table.rows.iter().any(is_text) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    if table.columns.is_empty() {
        return String::new();
    }
    grid.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

pub fn tenths(number: f64) -> Value {
    Value::Real((number * 10.0).round() / 10.0)
}

fn short(value: &Value) -> String {
    match value {
        Value::Real(number) => significant(*number, 6),
        other => other.to_string(),
    }
}

/// Keys are in the order of the columns.
pub fn rows(table: &Table) -> Vec<Map<String, Json>> {
    let names = distinct(&table.columns);
    table.rows.iter().map(|row| names.iter().cloned().zip(row.iter().map(Json::from)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Table {
        Table {
            columns: vec!["size".into(), "ei".into(), "note".into()],
            rows: vec![
                vec![Value::Text("S".into()), Value::Real(0.012_345_678), Value::Null],
                vec![Value::Text("M".into()), Value::Real(974.1), Value::Text("a, \"b\"".into())],
            ],
        }
    }

    #[test]
    fn a_narrow_terminal_gets_whole_columns() {
        let check = |width: usize, kept: usize, out: usize| {
            let (table, left_out) = fitting(sample(), width);
            assert_eq!((table.columns.len(), table.rows[0].len(), left_out), (kept, kept, out), "{width}");
        };
        check(80, 3, 0);
        check(7 + 12 + 9, 3, 0);
        check(7 + 12 + 8, 2, 1);
        check(7, 1, 2);
        check(0, 1, 2);
    }

    #[test]
    fn formats_hold_the_same_rows() {
        insta::assert_snapshot!(pretty(&sample()));
        insta::assert_snapshot!(sample().csv());
        insta::assert_snapshot!(serde_json::to_string(&rows(&sample())).expect("plain values"));
    }
}
