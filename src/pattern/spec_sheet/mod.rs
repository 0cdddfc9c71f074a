//! Specification sheets as buyers write them: a table in CSV or XLSX, among notes and merged cells, with a row for each
//! length, columns for code, description and tolerance, and a column for each size.
//!
//! [`read`] finds the table (`header`, `rows`) and reads its lengths (`number`). [`matching::matched`] tells the point of
//! measure of each row by its words (`words`, `rules`), by the place that they name, and by its lengths beside those of
//! the pattern. What is unsure becomes a question.

pub mod compared;
mod grid;
mod header;
pub mod matching;
pub mod number;
mod rows;
mod rules;
#[cfg(test)]
mod tests;
mod unit;
mod words;

use crate::dxf::Unit;
use crate::workbook::{Workbook, cell_name};
use grid::Grid;

pub const UNIT_SAID: &str = "as was said";
const MOST_BYTES: usize = 16 << 20;

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}{}: found {found}; accepted: {accepted}",
    if sheet.is_empty() { String::new() } else { format!(", sheet `{sheet}`") },
    cell.as_ref().map(|cell| format!(", cell {cell}")).unwrap_or_default())]
pub struct SheetError {
    pub file: String,
    /// Empty for CSV, and if the error is in no sheet.
    pub sheet: String,
    /// Name such as `C12`. `None` if the error is in no cell.
    pub cell: Option<String>,
    pub found: String,
    pub accepted: String,
}

/// Lengths are in the unit of the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetRow {
    /// Unique in the sheet: as written, or else `r` with the number of the row.
    pub code: String,
    /// As written.
    pub description: String,
    /// Number of the row in the sheet.
    pub line: usize,
    /// Greatest excess over the specification. `None` where no tolerance is written.
    pub plus: Option<f64>,
    /// Greatest shortfall, not negative. `None` as of `plus`.
    pub minus: Option<f64>,
    /// One for each size of the sheet. `None` for an empty cell.
    pub lengths: Vec<Option<f64>>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SaidUnit {
    pub unit: Unit,
    /// Reason, such as `cell B3 says cm`.
    pub why: String,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SpecSheet {
    pub file: String,
    /// Name in the workbook. Empty for CSV.
    pub sheet: String,
    /// `None` if the sheet says none, or several.
    pub unit: Option<SaidUnit>,
    pub sizes: Vec<String>,
    pub rows: Vec<SheetRow>,
    /// Sentences for the reader.
    pub notes: Vec<String>,
}

/// Sheet and unit of a file that it does not say itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SheetAsked<'a> {
    /// `None` for the first sheet with a table.
    pub sheet: Option<&'a str>,
    /// `None` for the unit of the sheet.
    pub unit: Option<Unit>,
}

/// Reads CSV or XLSX. `file` is its name for messages; columns are known by the pattern's `sizes`.
pub fn read(bytes: &[u8], file: &str, sizes: &[String], asked: SheetAsked<'_>) -> Result<SpecSheet, SheetError> {
    let fail = |found: String, accepted: &str| SheetError {
        file: file.to_owned(),
        sheet: String::new(),
        cell: None,
        found,
        accepted: accepted.to_owned(),
    };
    if bytes.len() > MOST_BYTES {
        return Err(fail(format!("{} MB", bytes.len() >> 20), "a sheet of at most 16 MB"));
    }
    if bytes.starts_with(&[0xd0, 0xcf, 0x11, 0xe0]) {
        return Err(fail("a workbook of before 2007 (XLS)".to_owned(), "XLSX or CSV, as the spreadsheet saves it"));
    }
    let grids = if bytes.starts_with(b"PK") {
        workbook(bytes, asked.sheet).map_err(|found| fail(found, "an XLSX workbook"))?
    } else {
        vec![Grid::csv(bytes)]
    };
    if let (Some(asked), true) = (asked.sheet, grids.is_empty()) {
        let names = Workbook::open(bytes).map(|book| book.names().collect::<Vec<_>>().join(", ")).unwrap_or_default();
        return Err(fail(format!("no sheet `{asked}`"), &format!("one of {names}")));
    }
    let mut tables = grids.iter().filter_map(|grid| Some((grid, header::columns(grid, sizes)?)));
    let Some((grid, columns)) = tables.next() else {
        let accepted = "a row of heads with one called description (or point of measure) and one for each size, and a row \
                        for each length below it";
        return Err(fail("no table of lengths".to_owned(), accepted));
    };
    let others: Vec<String> = tables.map(|(grid, _)| format!("`{}`", grid.name)).collect();
    let place = |line: usize, column: usize| cell_name(column, line);
    let error = |line: usize, column: usize, found: String, accepted: &str| SheetError {
        file: file.to_owned(),
        sheet: grid.name.clone(),
        cell: Some(place(line, column)),
        found,
        accepted: accepted.to_owned(),
    };
    let cells =
        rows::cells(grid, &columns).map_err(|fault| error(fault.line, fault.column, fault.found, fault.accepted))?;
    let said = match asked.unit {
        Some(unit) => Some(SaidUnit { unit, why: UNIT_SAID.to_owned() }),
        None => unit::said(grid, &columns, &cells.rows),
    };
    let mut notes = cells.notes;
    if !others.is_empty() {
        notes.push(format!("sheet `{}` is read; there are tables in {} too", grid.name, others.join(", ")));
    }
    Ok(SpecSheet {
        file: file.to_owned(),
        sheet: grid.name.clone(),
        rows: rows::in_unit(cells.rows, said.as_ref().map(|said| said.unit)),
        unit: said,
        sizes: columns.sizes.into_iter().map(|(_, name)| name).collect(),
        notes,
    })
}

/// Sheets of a workbook: all, or the one that is asked for. A sheet that cannot be read, such as a chart, is left out.
fn workbook(bytes: &[u8], asked: Option<&str>) -> Result<Vec<Grid>, String> {
    let book = Workbook::open(bytes)?;
    let names = book.names().enumerate();
    let meant: Vec<usize> =
        names.filter(|(_, name)| asked.is_none_or(|asked| name.eq_ignore_ascii_case(asked))).map(|(k, _)| k).collect();
    let sheets: Vec<_> = meant.into_iter().map(|k| book.sheet(k)).collect();
    // If none can be read, the first fault is told.
    if sheets.iter().all(Result::is_err) {
        return sheets.into_iter().next().map_or(Ok(Vec::new()), |first| first.map(|sheet| vec![sheet.into()]));
    }
    Ok(sheets.into_iter().flatten().map(Grid::from).collect())
}
