//! Piece information from a table beside the pattern (CSV or XLSX): quantity, material, grain, role and any other
//! columns of a tech pack.
//!
//! The first row names the columns. `piece` (or `name`, `piece name`, `block`) names the piece of a row, and `size`, if
//! there is such a column, its size. `quantity` replaces the quantity of the piece. `grain_deg` gives a grain line to a
//! piece without one. Every other column becomes a text of the piece. An empty cell changes nothing.

use super::dxf::PatternFile;
use super::garment::Role;
use super::piece::Piece;
use super::table;
use super::workbook::{Workbook, is_error};
use geom::V2;

/// Names of the column that identifies the piece of a row.
const PIECE: [&str; 4] = ["piece", "name", "piece name", "block"];
const MOST_BYTES: usize = 16 << 20;
/// Length of a grain line from a table, over the extent of the piece along it.
const GRAIN_SHARE: f64 = 0.5;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}{}{}: found {found}; accepted: {accepted}",
    row.map(|row| format!(", row {row}")).unwrap_or_default(),
    column.as_ref().map(|column| format!(", column `{column}`")).unwrap_or_default())]
pub struct InfoError {
    pub file: String,
    /// The row of column names is 1.
    pub row: Option<usize>,
    /// Heading. `None` if the error is in no column.
    pub column: Option<String>,
    pub found: String,
    pub accepted: String,
}

/// Number in the file, and cells.
type Row = (usize, Vec<String>);

#[derive(Clone, Debug, PartialEq)]
pub struct PieceTable {
    file: String,
    columns: Vec<String>,
    rows: Vec<Row>,
}

/// Reads the first sheet of an XLSX file, or CSV in UTF-8 with commas, semicolons or tabs.
pub fn read(bytes: &[u8], file: &str) -> Result<PieceTable, InfoError> {
    let fail = |row: Option<usize>, found: String, accepted: &str| InfoError {
        file: file.to_owned(),
        row,
        column: None,
        found,
        accepted: accepted.to_owned(),
    };
    if bytes.len() > MOST_BYTES {
        return Err(fail(None, format!("{} MB", bytes.len() >> 20), "a table of at most 16 MB"));
    }
    let mut rows = if bytes.starts_with(b"PK") {
        workbook_rows(bytes).map_err(|found| fail(None, found, "an XLSX workbook whose first sheet is the table"))?
    } else {
        csv_rows(bytes)
            .map_err(|(row, found)| fail(Some(row), found, "CSV in UTF-8, with as many cells in every row"))?
    };
    rows.retain(|(_, cells)| cells.iter().any(|cell| !cell.is_empty()));
    if rows.is_empty() {
        return Err(fail(None, "an empty table".to_owned(), "a row of column names, and one row a piece"));
    }
    let (head, columns) = rows.remove(0);
    let table = PieceTable { file: file.to_owned(), columns, rows };
    if table.column(&PIECE).is_none() {
        let found = format!("columns {}", table.columns.join(", "));
        return Err(fail(Some(head), found, "one called piece, name, piece name or block"));
    }
    for (k, column) in table.columns.iter().enumerate().filter(|(_, column)| !column.is_empty()) {
        if table.columns[..k].iter().any(|other| other.eq_ignore_ascii_case(column)) {
            return Err(fail(Some(head), format!("column `{column}` twice"), "each column once"));
        }
    }
    Ok(table)
}

fn workbook_rows(bytes: &[u8]) -> Result<Vec<Row>, String> {
    let sheet = Workbook::open(bytes)?.sheet(0)?;
    let mut faults = sheet.rows.iter().flat_map(|row| row.cells.iter().map(move |cell| (row.line, cell)));
    if let Some((line, cell)) = faults.find(|(_, cell)| is_error(cell)) {
        return Err(format!("the error value {cell} in row {line}"));
    }
    Ok(sheet.rows.into_iter().map(|row| (row.line, row.cells)).collect())
}

/// The error is the number of a malformed row and its fault.
fn csv_rows(bytes: &[u8]) -> Result<Vec<Row>, (usize, String)> {
    let text = table::text(bytes).map_err(|line| (line, "a byte that is no UTF-8".to_owned()))?;
    let rows = table::rows(text);
    let count = rows.first().map_or(0, |head| head.cells.len());
    if let Some(odd) = rows.iter().find(|row| row.cells.len() != count) {
        return Err((odd.line, format!("{} cells, where the row of column names has {count}", odd.cells.len())));
    }
    Ok(rows.into_iter().map(|row| (row.line, row.cells)).collect())
}

impl PieceTable {
    fn column(&self, names: &[&str]) -> Option<usize> {
        self.columns.iter().position(|column| names.iter().any(|name| column.eq_ignore_ascii_case(name)))
    }

    fn error(&self, row: usize, column: usize, found: String, accepted: &str) -> InfoError {
        InfoError {
            file: self.file.clone(),
            row: Some(row),
            column: Some(self.columns[column].clone()),
            found,
            accepted: accepted.to_owned(),
        }
    }

    /// Overrides the information of the pattern, except for grain lines. Fails where a row matches no piece, or two
    /// rows one.
    pub fn merge(&self, pattern: &mut PatternFile) -> Result<(), InfoError> {
        let Some(by) = self.column(&PIECE) else { return Ok(()) };
        let size_by = self.column(&["size"]);
        let mut told: Vec<Option<usize>> = vec![None; pattern.pieces.len()];
        for (row, cells) in &self.rows {
            let cell = |column: usize| cells.get(column).map_or("", String::as_str);
            for index in self.meant(*row, by, cell(by), size_by.map_or("", cell), &pattern.pieces)? {
                if let Some(first) = told[index].replace(*row) {
                    let found = format!("piece `{}` again, first in row {first}", cell(by));
                    return Err(self.error(*row, by, found, "each piece once"));
                }
                for column in (0..self.columns.len()).filter(|&column| column != by && Some(column) != size_by) {
                    self.tell(&mut pattern.pieces[index], *row, column, cell(column))?;
                }
            }
        }
        Ok(())
    }

    /// Pieces of the row's size, or of all sizes if it names none.
    fn meant(&self, row: usize, by: usize, name: &str, size: &str, pieces: &[Piece]) -> Result<Vec<usize>, InfoError> {
        let is_of =
            |piece: &Piece| size.is_empty() || piece.size.as_deref().is_some_and(|s| s.eq_ignore_ascii_case(size));
        let is_called = |piece: &Piece| piece.block.eq_ignore_ascii_case(name) || piece.name.eq_ignore_ascii_case(name);
        let meant: Vec<usize> = (0..pieces.len()).filter(|&k| is_called(&pieces[k]) && is_of(&pieces[k])).collect();
        if meant.is_empty() {
            let of_size = if size.is_empty() { String::new() } else { format!(" of size `{size}`") };
            let mut names: Vec<&str> = pieces.iter().map(|piece| piece.name.as_str()).collect();
            names.dedup();
            let accepted = format!("one of {}", names.join(", "));
            return Err(self.error(row, by, format!("piece `{name}`{of_size}"), &accepted));
        }
        Ok(meant)
    }

    fn tell(&self, piece: &mut Piece, row: usize, column: usize, value: &str) -> Result<(), InfoError> {
        let key = self.columns[column].trim();
        if value.is_empty() || key.is_empty() {
            return Ok(());
        }
        match key.to_ascii_lowercase().as_str() {
            "quantity" | "qty" => {
                let is_count = |part: &str| part.trim().parse::<u32>().is_ok();
                if !value.split(',').all(is_count) {
                    return Err(self.error(
                        row,
                        column,
                        format!("`{value}`"),
                        "a number, or left and right such as 1,1",
                    ));
                }
                piece.quantity = Some(value.to_owned());
            }
            "grain_deg" => {
                let angle = value.parse::<f64>().ok().filter(|angle| angle.abs() <= 360.0);
                let Some(angle) = angle else {
                    return Err(self.error(row, column, format!("`{value}`"), "degrees from +x, such as 90"));
                };
                piece.grain = piece.grain.or_else(|| Some(grain(&piece.outline, angle)));
            }
            "role" => {
                let role = serde_json::from_value::<Role>(serde_json::Value::from(value.to_ascii_lowercase()));
                if let Err(error) = role {
                    return Err(self.error(row, column, format!("`{value}`"), &accepted_roles(&error)));
                }
                set_text(piece, key, value);
            }
            _ => set_text(piece, key, value),
        }
        Ok(())
    }
}

fn accepted_roles(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split_once("expected one of ").map_or(text.clone(), |(_, names)| names.replace('`', ""))
}

fn set_text(piece: &mut Piece, key: &str, value: &str) {
    piece.texts.retain(|(other, _)| !other.eq_ignore_ascii_case(key));
    piece.texts.push((key.to_owned(), value.to_owned()));
}

/// Goes through the centre of the outline.
fn grain(outline: &[V2], angle_deg: f64) -> [V2; 2] {
    let (sine, cosine) = angle_deg.to_radians().sin_cos();
    let along = V2::new(cosine, sine);
    let low = outline.iter().fold(outline[0], |low, p| low.inf(p));
    let high = outline.iter().fold(outline[0], |high, p| high.sup(p));
    let middle = (low + high) * 0.5;
    let reach = outline.iter().map(|p| (p - middle).dot(&along).abs()).fold(0.0, f64::max);
    [middle - along * (GRAIN_SHARE * reach), middle + along * (GRAIN_SHARE * reach)]
}

#[cfg(test)]
mod tests;
