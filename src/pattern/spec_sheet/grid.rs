//! Cells of a sheet by row and column, with those that are merged.

use crate::table::{self, Row};
use crate::workbook::{Merged, Sheet};
use encoding_rs::WINDOWS_1252;

/// Cells of a sheet. Rows are numbered as in the file, columns from 0.
pub struct Grid {
    /// Empty for CSV.
    pub name: String,
    /// Only rows with cells, in order.
    pub rows: Vec<Row>,
    merged: Vec<Merged>,
}

impl From<Sheet> for Grid {
    fn from(Sheet { name, rows, merged }: Sheet) -> Self {
        Self { name, rows, merged }
    }
}

impl Grid {
    /// Reads UTF-8 or, as spreadsheets also write it, Windows-1252.
    pub fn csv(bytes: &[u8]) -> Self {
        let rows = match table::text(bytes) {
            Ok(text) => table::rows(text),
            Err(_) => table::rows(&WINDOWS_1252.decode(bytes).0),
        };
        Self { name: String::new(), rows, merged: Vec::new() }
    }

    /// Empty for a cell that is not there.
    pub fn at(&self, line: usize, column: usize) -> &str {
        let row = self.rows.binary_search_by_key(&line, |row| row.line).ok().map(|k| &self.rows[k]);
        row.and_then(|row| row.cells.get(column)).map_or("", |cell| cell.trim())
    }

    /// Text of a cell, or that of the merged cells which it is part of.
    pub fn spread(&self, line: usize, column: usize) -> &str {
        let own = self.at(line, column);
        let holds = |merged: &&Merged| {
            let ([top, bottom], [left, right]) = (merged.rows, merged.columns);
            (top..=bottom).contains(&line) && (left..=right).contains(&column)
        };
        match self.merged.iter().find(holds) {
            Some(merged) if own.is_empty() => self.at(merged.rows[0], merged.columns[0]),
            _ => own,
        }
    }

    pub fn width(&self) -> usize {
        self.rows.iter().map(|row| row.cells.len()).max().unwrap_or_default()
    }
}
