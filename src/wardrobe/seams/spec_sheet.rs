//! Specification sheets of buyers beside the sizes of a pattern.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::error::WardrobeError;
use crate::seams::desk::Asking;
use crate::seams::specification::{Sized, sized};
use geom::units::mm;
use pattern::Style;
use pattern::pom::{Measure, Point};
use pattern::size_order;
use pattern::spec_sheet::compared::lines;
use pattern::spec_sheet::matching::{self, Matching, RowMatch};
use pattern::spec_sheet::{self, SpecSheet};
use store::files::SourceFile;
use store::{InOrigin, Origin, Result, Table, Value};

pub use pattern::spec_sheet::SheetAsked;
pub use pattern::spec_sheet::compared::SpecLine;
pub use pattern::spec_sheet::matching::Answer;

/// A row of a sheet that is asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AskedRow {
    pub code: String,
    pub description: String,
    /// Reason, as the end of a sentence.
    pub why: String,
    /// Points that it may be, as `--match` takes them.
    pub candidates: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpecReport {
    /// Name of the pattern or style.
    pub garment: String,
    pub file: String,
    /// Name in the workbook; empty for CSV.
    pub sheet: String,
    /// `in`, `cm` or `mm`.
    pub unit: String,
    /// Reason for the unit, such as `cell B3 says cm`.
    pub unit_from: String,
    /// Number of rows with lengths.
    pub rows: u32,
    /// Number of those rows that are a point of measure.
    pub matched: u32,
    /// Order is that of the sheet.
    pub sizes: Vec<String>,
    /// Every row in every size, in the order of the sheet.
    pub lines: Vec<SpecLine>,
    pub asked: Vec<AskedRow>,
    pub notes: Vec<String>,
}

/// A sheet whose sizes have the names of the pattern's, with the point of each row.
pub struct Compared {
    pub sheet: SpecSheet,
    pub matching: Matching,
    /// Lengths of the pattern at those points in each size of the sheet, mm, by the names of the points.
    pub flats: BTreeMap<String, Vec<Option<f64>>>,
    pub report: SpecReport,
}

/// Without a seam file the pattern is sewn as proposed.
pub fn spec_report(
    pattern: &Path,
    seams: Option<&Path>,
    how: &Asking<'_>,
    sheet: &Path,
    asked: SheetAsked<'_>,
    answers: &[Answer],
) -> Result<SpecReport> {
    let sheet = SourceFile::read(sheet)?;
    let Sized { garment, sizes, styles, notes } = sized(pattern, seams, how)?;
    let mut report = compared(&garment, &sheet, asked, answers, &sizes, &styles)?.report;
    report.notes.splice(0..0, notes);
    Ok(report)
}

/// `sizes` and `styles` go together.
pub fn compared(
    garment: &str,
    file: &SourceFile,
    asked: SheetAsked<'_>,
    answers: &[Answer],
    sizes: &[String],
    styles: &[Style],
) -> Result<Compared> {
    let mut sheet = spec_sheet::read(&file.bytes, &file.name, sizes, asked).origin(Origin::Pattern)?;
    let of_pattern = same_sizes(&sheet, sizes)?;
    for (name, size) in sheet.sizes.iter_mut().zip(&of_pattern) {
        if let Some(known) = size.map(|k| &sizes[k]).filter(|known| !known.is_empty()) {
            name.clone_from(known);
        }
    }
    // The points of a style are found together; one of one's own when a row names it.
    let known: Vec<Measure> = Point::ALL.map(Measure::Point).to_vec();
    let mut lengths = of_pattern.iter().map(|size| size.map(|k| styles[k].lengths_of(&known))).collect::<Vec<_>>();
    let columns = known.iter().enumerate().map(|(point, measure)| {
        let each = lengths.iter_mut().map(|size| size.as_mut().and_then(|all| all[point].take()).map(mm));
        (measure.to_string(), each.collect::<Vec<_>>())
    });
    let measured: RefCell<BTreeMap<String, Vec<Option<f64>>>> = RefCell::new(columns.collect());
    let flat = |measure: Measure| -> Vec<Option<f64>> {
        let all = || of_pattern.iter().map(|size| size.and_then(|k| styles[k].lengths_of(&[measure])[0]).map(mm));
        measured.borrow_mut().entry(measure.to_string()).or_insert_with(|| all().collect()).clone()
    };
    let matching = matching::matched(&sheet, &flat, answers).origin(Origin::Pattern)?;
    let report = report(garment, &sheet, &matching, &of_pattern, lines(&sheet, &matching, &flat));
    Ok(Compared { sheet, matching, flats: measured.into_inner(), report })
}

/// Index of the pattern's size for each size of a sheet. A single size is that of a pattern with one.
fn same_sizes(sheet: &SpecSheet, sizes: &[String]) -> Result<Vec<Option<usize>>> {
    if let ([_], [_]) = (&sheet.sizes[..], sizes) {
        return Ok(vec![Some(0)]);
    }
    let place = |name: &String| sizes.iter().position(|size| size_order::is_same(size, name));
    let found: Vec<Option<usize>> = sheet.sizes.iter().map(place).collect();
    if found.iter().all(Option::is_none) {
        let (found, accepted) = (sheet.sizes.join(", "), sizes.join(", "));
        return Err(WardrobeError::NoSizeOfSheet { file: sheet.file.clone(), found, accepted }.into());
    }
    Ok(found)
}

fn report(
    garment: &str,
    sheet: &SpecSheet,
    matching: &Matching,
    of_pattern: &[Option<usize>],
    lines: Vec<SpecLine>,
) -> SpecReport {
    let rows = || sheet.rows.iter().zip(&matching.rows);
    let asked = rows().filter_map(|(row, found)| {
        let RowMatch::Asked { why, candidates } = found else { return None };
        Some(AskedRow {
            code: row.code.clone(),
            description: row.description.clone(),
            why: why.clone(),
            candidates: candidates.iter().map(ToString::to_string).collect(),
        })
    });
    let mut notes: Vec<String> = sheet.notes.iter().chain(&matching.notes).cloned().collect();
    let others: Vec<&str> =
        sheet.sizes.iter().zip(of_pattern).filter(|(_, size)| size.is_none()).map(|(name, _)| &**name).collect();
    if !others.is_empty() {
        notes.push(format!("the pattern does not have size {}", others.join(", ")));
    }
    SpecReport {
        garment: garment.to_owned(),
        file: sheet.file.clone(),
        sheet: sheet.sheet.clone(),
        unit: matching.unit.unit.as_str().to_owned(),
        unit_from: matching.unit.why.clone(),
        rows: sheet.rows.len() as u32,
        matched: matching.rows.iter().filter(|found| matches!(found, RowMatch::Is(..))).count() as u32,
        sizes: sheet.sizes.clone(),
        asked: asked.collect(),
        lines,
        notes,
    }
}

impl SpecReport {
    /// Table with a row for each row of the sheet in each size. Its columns are those of `v_spec`, lengths in mm.
    pub fn table(&self) -> Table {
        let columns = [
            "code",
            "description",
            "point",
            "size",
            "spec_mm",
            "minus_mm",
            "plus_mm",
            "flat_mm",
            "deviation_mm",
            "verdict",
            "step_mm",
            "flat_step_mm",
            "worn_mm",
        ];
        let row = |line: &SpecLine| {
            let text = |text: &str| Value::Text(text.to_owned());
            vec![
                text(&line.code),
                text(&line.description),
                line.point.as_deref().map_or(Value::Null, text),
                text(&line.size),
                hundredths(Some(line.spec_mm)),
                hundredths(line.minus_mm),
                hundredths(line.plus_mm),
                hundredths(line.flat_mm),
                hundredths(line.deviation_mm),
                line.verdict.map_or(Value::Null, |verdict| text(verdict.as_str())),
                hundredths(line.step_mm),
                hundredths(line.flat_step_mm),
                hundredths(line.worn_mm),
            ]
        };
        Table::new(columns, self.lines.iter().map(row))
    }

    /// Table for people: a row for each row of the sheet, with the specification and the deviation in each size, mm. A
    /// deviation outside its tolerance has an exclamation mark.
    pub fn overview(&self) -> Table {
        let mut columns: Vec<String> = ["code", "description", "point", "tolerance"].map(str::to_owned).to_vec();
        columns.extend(self.sizes.iter().flat_map(|size| [size.clone(), format!("{size} off")]));
        let rows = self.by_row().into_iter().map(|lines| {
            let first = lines[0];
            let mut row = vec![
                Value::Text(first.code.clone()),
                Value::Text(first.description.clone()),
                Value::Text(first.point.clone().unwrap_or_default()),
                Value::Text(tolerance(first)),
            ];
            for size in &self.sizes {
                let line = lines.iter().find(|line| line.size == *size);
                row.push(line.map_or(Value::Null, |line| tenths(line.spec_mm)));
                row.push(line.map_or(Value::Null, |line| off(line)));
            }
            row
        });
        Table { rows: rows.collect(), columns }
    }

    pub fn by_row(&self) -> Vec<Vec<&SpecLine>> {
        let mut rows: Vec<Vec<&SpecLine>> = Vec::new();
        for line in &self.lines {
            match rows.last_mut().filter(|row| row[0].code == line.code) {
                Some(row) => row.push(line),
                None => rows.push(vec![line]),
            }
        }
        rows
    }

    pub fn is_out(&self) -> bool {
        self.lines.iter().any(SpecLine::is_out)
    }

    pub fn summary(&self) -> String {
        let judged = self.lines.iter().filter(|line| line.verdict.is_some()).count();
        let out = self.lines.iter().filter(|line| line.is_out()).count();
        let unit = if self.unit == "in" { "inches" } else { &self.unit };
        format!(
            "{} of {} rows are points of measure, in {unit} ({}); {out} of {judged} lengths are out of tolerance",
            self.matched, self.rows, self.unit_from
        )
    }
}

/// Adding zero removes the sign of a zero.
fn hundredths(number: Option<f64>) -> Value {
    number.map_or(Value::Null, |number| Value::Real((number * 100.0).round() / 100.0 + 0.0))
}

fn tenths(number: f64) -> Value {
    Value::Real((number * 10.0).round() / 10.0 + 0.0)
}

/// Tolerance of a row in words, mm.
fn tolerance(line: &SpecLine) -> String {
    match (line.minus_mm, line.plus_mm) {
        (Some(minus), Some(plus)) if (minus - plus).abs() < 1e-9 => format!("±{plus:.1}"),
        (Some(minus), Some(plus)) => format!("+{plus:.1} -{minus:.1}"),
        _ => String::new(),
    }
}

/// Deviation of a line, mm, with its mark.
fn off(line: &SpecLine) -> Value {
    let mark = if line.is_out() { " !" } else { "" };
    line.deviation_mm.map_or(Value::Null, |off| Value::Text(format!("{:+.1}{mark}", (off * 10.0).round() / 10.0 + 0.0)))
}
