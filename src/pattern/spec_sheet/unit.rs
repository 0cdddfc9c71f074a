//! Unit of a specification sheet, by its own words.

use super::SaidUnit;
use super::grid::Grid;
use super::header::Columns;
use super::number::{Written, unit_of_word};
use super::rows::WrittenRow;
use crate::dxf::Unit;
use crate::workbook::cell_name;

/// Unit in a cell above the rows, beside a length, or of fractions, which only inches have. `None` for none or several.
pub fn said(grid: &Grid, columns: &Columns, rows: &[WrittenRow]) -> Option<SaidUnit> {
    let above = grid.rows.iter().filter(|row| row.line <= columns.heads[1]);
    let cells = above.flat_map(|row| row.cells.iter().enumerate().map(|(column, text)| (row.line, column, text)));
    let named = cells.flat_map(|(line, column, text)| units(text).into_iter().map(move |unit| (unit, line, column)));
    let named: Vec<(Unit, usize, usize)> = named.collect();
    let lengths = || {
        let tolerances = rows.iter().filter_map(|row| row.tolerance).flat_map(|both| [both.plus, both.minus]);
        rows.iter().flat_map(|row| &row.lengths).flatten().copied().chain(tolerances)
    };
    let marked: Vec<Unit> = lengths().filter_map(|written: Written| written.unit).collect();
    let one = |mut units: Vec<Unit>| {
        units.dedup();
        (units.len() == 1).then(|| units[0])
    };
    if let Some(unit) = one(named.iter().map(|(unit, ..)| *unit).collect()) {
        let (_, line, column) = named[0];
        let why = format!("cell {} says {}", cell_name(column, line), unit.as_str());
        return Some(SaidUnit { unit, why });
    }
    if let Some(unit) = one(marked) {
        return Some(SaidUnit { unit, why: format!("lengths are marked {}", unit.as_str()) });
    }
    let has_fractions = lengths().any(|written| written.is_fraction);
    has_fractions.then(|| SaidUnit { unit: Unit::In, why: "lengths are written in fractions".to_owned() })
}

/// The word `in` is a unit where it stands alone, in brackets or at the end after a colon.
fn units(text: &str) -> Vec<Unit> {
    let words: Vec<&str> = text.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty()).collect();
    let lower = text.trim().trim_end_matches('.').to_lowercase();
    let is_alone = lower == "in" || lower.contains("(in)") || lower.contains("(in.)") || lower.ends_with(": in");
    let unit = |word: &&str| match word.to_lowercase().as_str() {
        "in" => is_alone.then_some(Unit::In),
        "ins" => None,
        word => unit_of_word(word),
    };
    words.iter().filter_map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_names_its_units() {
        let check = |text: &str, expect: &[Unit]| assert_eq!(units(text), expect, "{text}");
        check("All measurements in cm", &[Unit::Cm]);
        check("Measurements in inches", &[Unit::In]);
        check("UOM: IN", &[Unit::In]);
        check("Tol (in)", &[Unit::In]);
        check("IN", &[Unit::In]);
        check("made in Portugal", &[]);
        check("cm / inch", &[Unit::Cm, Unit::In]);
    }
}
