//! Specifications as XLSX workbooks, in the unit of the buyer's sheet.

use std::io;

use rust_xlsxwriter::{Color, Format, Workbook, Worksheet, XlsxError};

use wardrobe::seams::SpecReport;
use wardrobe::seams::spec_sheet::SpecLine;

/// Fill of a deviation outside its tolerance.
const OUT: Color = Color::RGB(0x00F4_B6B0);
/// Text of a row without a point.
const PALE: Color = Color::RGB(0x0070_7070);
const HEAD: Color = Color::RGB(0x00E4_E7EC);
/// Columns before those of the sizes.
const HEADS: [&str; 5] = ["Code", "Description", "Point", "Tol -", "Tol +"];
/// Widths in characters.
const WIDTHS: [f64; 5] = [8.0, 42.0, 26.0, 8.0, 8.0];

/// Makes a workbook of a specification: the rows with specification, flat and worn lengths and deviations, the steps
/// between sizes, and the rows that are asked for.
pub fn bytes(report: &SpecReport) -> io::Result<Vec<u8>> {
    written(report).map_err(io::Error::other)
}

struct Formats {
    mm_per_unit: f64,
    head: Format,
    text: Format,
    pale: Format,
    /// Specifications and tolerances.
    given: Format,
    measured: Format,
    /// Deviations and steps.
    signed: Format,
    out: Format,
}

impl Formats {
    fn of(unit: &str) -> Self {
        let (mm_per_unit, given, measured) = match unit {
            "in" => (25.4, "# ??/??", "0.00"),
            "cm" => (10.0, "0.0#", "0.00"),
            _ => (1.0, "0.0", "0.0"),
        };
        let signed = Format::new().set_num_format(format!("+{measured};-{measured};{measured}"));
        Self {
            mm_per_unit,
            head: Format::new().set_bold().set_background_color(HEAD).set_text_wrap(),
            text: Format::new(),
            pale: Format::new().set_font_color(PALE).set_italic(),
            given: Format::new().set_num_format(given),
            measured: Format::new().set_num_format(measured),
            out: signed.clone().set_background_color(OUT).set_bold(),
            signed,
        }
    }

    /// Nothing is written for `None`.
    fn length(
        &self,
        sheet: &mut Worksheet,
        (row, column): (u32, u16),
        mm: Option<f64>,
        format: &Format,
    ) -> Result<(), XlsxError> {
        if let Some(mm) = mm {
            // Conversions leave noise behind the digits that are shown.
            let length = (mm / self.mm_per_unit * 1e6).round() / 1e6;
            sheet.write_number_with_format(row, column, length, format)?;
        }
        Ok(())
    }
}

fn written(report: &SpecReport) -> Result<Vec<u8>, XlsxError> {
    let mut workbook = Workbook::new();
    let formats = Formats::of(&report.unit);
    let rows = report.by_row();
    lengths(workbook.add_worksheet().set_name("Specification")?, report, &rows, &formats)?;
    steps(workbook.add_worksheet().set_name("Grading")?, report, &rows, &formats)?;
    if !report.asked.is_empty() {
        asked(workbook.add_worksheet().set_name("Asked")?, report, &formats)?;
    }
    workbook.save_to_buffer()
}

/// Heads of a sheet with the columns of the rows and some of each size. They stay in view.
fn heads(sheet: &mut Worksheet, report: &SpecReport, each: &[&str], formats: &Formats) -> Result<(), XlsxError> {
    let of_sizes = report.sizes.iter().flat_map(|size| each.iter().map(move |what| format!("{size} {what}")));
    let unit = &report.unit;
    let all =
        HEADS.iter().map(|head| (*head).to_owned()).chain(of_sizes.map(|head| format!("{} ({unit})", head.trim())));
    for (column, head) in (0..).zip(all) {
        sheet.write_string_with_format(0, column, head, &formats.head)?;
    }
    for (column, width) in (0..).zip(WIDTHS) {
        sheet.set_column_width(column, width)?;
    }
    sheet.set_freeze_panes(1, 2)?;
    sheet.set_landscape().set_repeat_rows(0, 0)?;
    Ok(())
}

fn head_of_row(sheet: &mut Worksheet, row: u32, line: &SpecLine, formats: &Formats) -> Result<(), XlsxError> {
    let style = if line.point.is_some() { &formats.text } else { &formats.pale };
    sheet.write_string_with_format(row, 0, &line.code, style)?;
    sheet.write_string_with_format(row, 1, &line.description, style)?;
    sheet.write_string_with_format(row, 2, line.point.as_deref().unwrap_or("not measured"), style)?;
    formats.length(sheet, (row, 3), line.minus_mm, &formats.given)?;
    formats.length(sheet, (row, 4), line.plus_mm, &formats.given)
}

fn lengths(
    sheet: &mut Worksheet,
    report: &SpecReport,
    rows: &[Vec<&SpecLine>],
    formats: &Formats,
) -> Result<(), XlsxError> {
    let is_worn = report.lines.iter().any(|line| line.worn_mm.is_some());
    let each: &[&str] = if is_worn { &["spec", "flat", "off", "worn"] } else { &["spec", "flat", "off"] };
    heads(sheet, report, each, formats)?;
    for (row, lines) in (1..).zip(rows) {
        head_of_row(sheet, row, lines[0], formats)?;
        for (size, first) in report.sizes.iter().zip((HEADS.len() as u16..).step_by(each.len())) {
            let Some(line) = lines.iter().find(|line| line.size == *size) else { continue };
            let is_out = line.is_out();
            formats.length(sheet, (row, first), Some(line.spec_mm), &formats.given)?;
            formats.length(sheet, (row, first + 1), line.flat_mm, &formats.measured)?;
            let format = if is_out { &formats.out } else { &formats.signed };
            formats.length(sheet, (row, first + 2), line.deviation_mm, format)?;
            if is_worn {
                formats.length(sheet, (row, first + 3), line.worn_mm, &formats.measured)?;
            }
        }
    }
    Ok(())
}

fn steps(
    sheet: &mut Worksheet,
    report: &SpecReport,
    rows: &[Vec<&SpecLine>],
    formats: &Formats,
) -> Result<(), XlsxError> {
    let each = ["step", "step of the pattern"];
    heads(sheet, report, &each, formats)?;
    for (row, lines) in (1..).zip(rows) {
        head_of_row(sheet, row, lines[0], formats)?;
        for (size, first) in report.sizes.iter().zip((HEADS.len() as u16..).step_by(each.len())) {
            let Some(line) = lines.iter().find(|line| line.size == *size) else { continue };
            formats.length(sheet, (row, first), line.step_mm, &formats.signed)?;
            formats.length(sheet, (row, first + 1), line.flat_step_mm, &formats.signed)?;
        }
    }
    Ok(())
}

fn asked(sheet: &mut Worksheet, report: &SpecReport, formats: &Formats) -> Result<(), XlsxError> {
    for (column, head) in (0..).zip(["Code", "Description", "Why it is asked", "It may be"]) {
        sheet.write_string_with_format(0, column, head, &formats.head)?;
    }
    for (row, asked) in (1..).zip(&report.asked) {
        let cells = [&asked.code, &asked.description, &asked.why, &asked.candidates.join(", ")];
        for (column, text) in (0..).zip(cells) {
            sheet.write_string(row, column, text)?;
        }
    }
    sheet.set_freeze_panes(1, 0)?;
    sheet.autofit();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::workbook;
    use spec::patterns::{self, Model};
    use wardrobe::seams::{Asking, spec_report};

    #[test]
    fn a_workbook_has_the_numbers_of_the_comparison() {
        let folder = tempfile::tempdir().expect("a folder");
        store::files::write_files(folder.path(), &patterns::drafted(Model::Tshirt)).expect("writable");
        let text = "Measurements in inches,,,\ncode,description,tol,S\nA,1/2 chest,1/8,19 1/2\nB,Bottom sweep,1/2,19 1/8\n\
            C,Logo height,,3\n";
        let sheet = folder.path().join("sheet.csv");
        std::fs::write(&sheet, text).expect("writable");
        let [pattern, seams] = ["tshirt-s.dxf", "tshirt.seams.toml"].map(|name| folder.path().join(name));
        let how = Asking { size: Some("S"), ..Asking::default() };
        let report = spec_report(&pattern, Some(&seams), &how, &sheet, Default::default(), &[]).expect("compared");
        let bytes = bytes(&report).expect("written");
        let book = workbook::Workbook::open(&bytes).expect("a workbook");
        assert_eq!(book.names().collect::<Vec<_>>(), ["Specification", "Grading", "Asked"]);
        let rows = book.sheet(0).expect("a sheet").rows;
        let heads = ["Code", "Description", "Point", "Tol -", "Tol +", "S spec (in)", "S flat (in)", "S off (in)"];
        assert_eq!(rows[0].cells, heads);
        for (row, line) in rows[1..].iter().zip(&report.lines) {
            let point = line.point.as_deref().unwrap_or("not measured");
            assert_eq!(row.cells[..3], [&*line.code, &*line.description, point]);
            let numbers = [line.minus_mm, line.plus_mm, Some(line.spec_mm), line.flat_mm, line.deviation_mm];
            for (k, number) in numbers.into_iter().enumerate() {
                let cell = row.cells.get(3 + k).map_or("", String::as_str);
                let found = cell.parse::<f64>().ok().map(|inches| inches * 25.4);
                let is_same = found.zip(number).is_some_and(|(found, number)| (found - number).abs() < 1e-4);
                assert!(is_same || (cell.is_empty() && number.is_none()), "{line:?}: {cell}");
            }
        }
        assert!(report.lines[0].is_out() && !report.lines[1].is_out(), "{:?}", report.lines);
    }
}
