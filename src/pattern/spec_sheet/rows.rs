//! Rows of the table of a specification sheet.

use std::collections::BTreeSet;

use super::SheetRow;
use super::grid::Grid;
use super::header::Columns;
use super::number::{self, Written, WrittenTolerance};
use crate::dxf::Unit;

/// Texts of cells without a length.
const NONE: [&str; 12] = ["", "-", "\u{2013}", "\u{2014}", "/", "x", "n/a", "na", "#n/a", "tbd", "tbc", "none"];
/// Days that a spreadsheet makes of fractions such as 1/2: 2000 to 2099, counted from 1900.
const DAYS: std::ops::Range<f64> = 36_526.0..73_051.0;

pub struct Fault {
    pub line: usize,
    /// From 0.
    pub column: usize,
    pub found: String,
    pub accepted: &'static str,
}

pub struct WrittenRow {
    /// Unique in the sheet.
    pub code: String,
    pub description: String,
    /// Number of the row in the sheet.
    pub line: usize,
    /// `None` for an empty cell.
    pub tolerance: Option<WrittenTolerance>,
    /// By size. `None` for an empty cell.
    pub lengths: Vec<Option<Written>>,
}

pub struct Cells {
    pub rows: Vec<WrittenRow>,
    /// Sentences on rows that are left out.
    pub notes: Vec<String>,
}

/// Leaves out rows without lengths, such as titles and notes.
pub fn cells(grid: &Grid, columns: &Columns) -> Result<Cells, Fault> {
    let mut found = Cells { rows: Vec::new(), notes: Vec::new() };
    let mut codes = BTreeSet::new();
    for line in grid.rows.iter().map(|row| row.line).filter(|line| *line > columns.heads[1]) {
        let texts: Vec<&str> = columns.sizes.iter().map(|(column, _)| grid.at(line, *column)).collect();
        let lengths: Vec<Option<Written>> = texts.iter().map(|text| number::length(text)).collect();
        let description = grid.spread(line, columns.description);
        let head = grid.at(columns.heads[1], columns.description);
        // A text without digits is part of a title or note. Other texts may be lengths that are written wrong.
        let is_told = texts.iter().any(|text| text.contains(|c: char| c.is_ascii_digit()));
        if !is_told && lengths.iter().all(Option::is_none) || (description == head && !head.is_empty()) {
            continue;
        }
        for ((text, length), (column, _)) in texts.iter().zip(&lengths).zip(&columns.sizes) {
            check(text, *length).map_err(|(found, accepted)| Fault { line, column: *column, found, accepted })?;
        }
        if description.is_empty() {
            found.notes.push(format!("row {line} has lengths and no description; it is left out"));
            continue;
        }
        let written = columns.code.map_or("", |column| grid.at(line, column));
        let code = if written.is_empty() || codes.contains(written) { format!("r{line}") } else { written.to_owned() };
        if !written.is_empty() && code != written {
            found.notes.push(format!("code {written} is there twice; row {line} is called {code}"));
        }
        codes.insert(code.clone());
        let tolerance = tolerance(grid, columns, line)?;
        found.rows.push(WrittenRow { code, description: description.to_owned(), line, tolerance, lengths });
    }
    Ok(found)
}

/// The error is what was found, and what is accepted.
fn check(text: &str, length: Option<Written>) -> Result<(), (String, &'static str)> {
    match length {
        Some(Written { value, unit: None, .. }) if DAYS.contains(&value) => {
            let accepted = "a length; format the cell as text before 1/2 is written into it";
            Err((format!("{text}, a date that a spreadsheet made"), accepted))
        }
        None if !NONE.contains(&text.to_lowercase().as_str()) => {
            Err((format!("`{text}`"), "a length such as 57.2, 22 1/2, 22-1/2\" or 57 cm, or an empty cell"))
        }
        _ => Ok(()),
    }
}

/// Merged cells hold for all their rows.
fn tolerance(grid: &Grid, columns: &Columns, line: usize) -> Result<Option<WrittenTolerance>, Fault> {
    let Some([plus, minus]) = columns.tolerance else { return Ok(None) };
    let read = |column: usize| {
        let text = grid.spread(line, column);
        if NONE.contains(&text.to_lowercase().as_str()) {
            return Ok(None);
        }
        let accepted = "a tolerance such as 0.5, 1/4, +/- 1/4 or +1/2 -1/4";
        let fault = |found: String| Fault { line, column, found, accepted };
        match number::tolerance(text) {
            Some(found) if DAYS.contains(&found.plus.value) => {
                Err(fault(format!("{text}, a date that a spreadsheet made")))
            }
            Some(found) => Ok(Some(found)),
            None => Err(fault(format!("`{text}`"))),
        }
    };
    let both = read(plus)?;
    if plus == minus {
        return Ok(both);
    }
    let down = read(minus)?;
    Ok(both.or(down).map(|found| WrittenTolerance { minus: down.unwrap_or(found).minus, ..found }))
}

/// Converts a length that has another unit by its own words.
pub fn in_unit(rows: Vec<WrittenRow>, unit: Option<Unit>) -> Vec<SheetRow> {
    let value = |written: Written| match (written.unit, unit) {
        (Some(own), Some(unit)) => written.value * own.mm_per_unit() / unit.mm_per_unit(),
        _ => written.value,
    };
    let row = |row: WrittenRow| SheetRow {
        code: row.code,
        description: row.description,
        line: row.line,
        plus: row.tolerance.map(|tolerance| value(tolerance.plus)),
        minus: row.tolerance.map(|tolerance| value(tolerance.minus)),
        lengths: row.lengths.into_iter().map(|length| length.map(value)).collect(),
    };
    rows.into_iter().map(row).collect()
}
