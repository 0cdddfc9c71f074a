//! Specification sheets: the points of measure of a pattern, in all its sizes.

use std::path::Path;

use serde::Serialize;

use crate::error::WardrobeError;
use crate::seams::desk::{Asking, proposal};
use geom::units::mm;
use pattern::Style;
use pattern::pom::Point;
use pattern::progression::{Leap, leaps};
use spec::patterns::{self, Nest};
use store::files::SourceFile;
use store::{Result, Table, Value};

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpecifiedPoint {
    /// Name of the point in tables and SQL.
    pub point: &'static str,
    pub size: String,
    pub length_mm: f64,
    /// Length minus that of the size before; `None` for the first size.
    pub step_mm: Option<f64>,
    pub definition: &'static str,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Specification {
    /// Name of the pattern.
    pub garment: String,
    /// Smallest first.
    pub sizes: Vec<String>,
    /// Every point of every size, by point.
    pub points: Vec<SpecifiedPoint>,
    pub notes: Vec<String>,
    /// SVG of the first size's pieces with numbered points.
    #[serde(skip)]
    pub drawing: String,
}

/// Sizes of a pattern, sewn.
pub struct Sized {
    pub garment: String,
    /// Smallest first.
    pub sizes: Vec<String>,
    /// One for each size.
    pub styles: Vec<Style>,
    pub notes: Vec<String>,
}

/// Reads every size of a pattern. Without a seam file the pattern is sewn as proposed. A size that cannot be sewn is left
/// out with a note.
pub fn sized(pattern: &Path, seams: Option<&Path>, how: &Asking<'_>) -> Result<Sized> {
    let source = SourceFile::read_pattern(pattern)?;
    let garment = pattern.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut notes = Vec::new();
    let seams = match seams {
        Some(path) => Some(SourceFile::read(path)?),
        None if source.holds_seams() => None,
        None => {
            let proposal = proposal(&source, how)?.proposal;
            notes.push("sewn as proposed: no seam file was given".to_owned());
            notes.extend(proposal.notes.iter().cloned());
            Some(SourceFile { name: "the proposal".to_owned(), bytes: proposal.toml(&garment).into_bytes().into() })
        }
    };
    let sizes: Vec<String> = match (source.holds_seams(), how.size) {
        (_, Some(size)) => vec![size.to_owned()],
        (true, None) => vec![String::new()],
        (false, None) => Nest::read(&source, how.unit)?.sizes().into_iter().map(str::to_owned).collect(),
    };
    let (mut read, mut styles) = (Vec::new(), Vec::new());
    for size in &sizes {
        match patterns::read_style(&source, seams.as_ref(), Some(size), how.unit) {
            Ok(style) => {
                read.push(size.clone());
                styles.push(style);
            }
            Err(error) if size == &sizes[sizes.len() - 1] && styles.is_empty() => return Err(error),
            Err(error) => notes.push(format!("size {size} is left out: {error}")),
        }
    }
    Ok(Sized { garment, sizes: read, styles, notes })
}

/// Without a seam file the pattern is sewn as proposed.
pub fn specification(pattern: &Path, seams: Option<&Path>, how: &Asking<'_>) -> Result<Specification> {
    let Sized { garment, sizes, styles, notes } = sized(pattern, seams, how)?;
    let mut found = Specification::of(garment, sizes, &styles);
    found.notes.splice(0..0, notes);
    if found.points.is_empty() {
        return Err(WardrobeError::NoPoint { pattern: pattern.to_owned() }.into());
    }
    Ok(found)
}

fn points(sizes: &[String], styles: &[Style]) -> Vec<SpecifiedPoint> {
    let measured: Vec<Vec<_>> = styles.iter().map(Style::points_of_measure).collect();
    let mut found = Vec::new();
    for point in Point::ALL {
        let mut before: Option<f64> = None;
        for (size, points) in sizes.iter().zip(&measured) {
            let length_mm =
                points.iter().find(|measured| measured.point == point).map(|measured| mm(measured.length_m));
            found.extend(length_mm.map(|length_mm| SpecifiedPoint {
                point: point.as_str(),
                size: size.clone(),
                length_mm,
                step_mm: before.map(|before| length_mm - before),
                definition: point.definition(),
            }));
            before = length_mm;
        }
    }
    found
}

impl Specification {
    pub fn of(garment: String, sizes: Vec<String>, styles: &[Style]) -> Self {
        let points = points(&sizes, styles);
        let drawing = styles.first().map_or_else(String::new, patterns::points_sheet);
        let told = |leap: Leap| {
            let [before, after] = leap.sizes.map(|size| &sizes[size]);
            format!("doubtful from size {before} to {after}: {}", leap.told())
        };
        let notes = leaps(&styles.iter().collect::<Vec<_>>()).into_iter().map(told).collect();
        Self { garment, sizes, points, notes, drawing }
    }

    /// Returns the sheet: a row for each point; columns with the length in each size and the step from the size before,
    /// mm.
    pub fn table(&self) -> Table {
        let name = |size: &String| if size.is_empty() { "mm".to_owned() } else { format!("{size}_mm") };
        let mut columns = vec!["point".to_owned()];
        columns.extend(self.sizes.iter().map(name));
        columns.extend(self.sizes.iter().skip(1).map(|size| format!("{size}_step_mm")));
        columns.push("definition".to_owned());
        let row = |point: Point| -> Option<Vec<Value>> {
            let is_at = |found: &SpecifiedPoint, size: &str| found.point == point.as_str() && found.size == size;
            let found_in = |size: &String| self.points.iter().find(|found| is_at(found, size));
            let all: Vec<Option<&SpecifiedPoint>> = self.sizes.iter().map(found_in).collect();
            all.iter().any(Option::is_some).then_some(())?;
            // Adding zero removes the sign of a zero step.
            let rounded = |mm: f64| Value::Real((mm * 10.0).round() / 10.0 + 0.0);
            let step = |found: &Option<&SpecifiedPoint>| found.and_then(|at| at.step_mm).map_or(Value::Null, rounded);
            let mut row = vec![Value::Text(point.as_str().to_owned())];
            row.extend(all.iter().map(|found| found.map_or(Value::Null, |at| rounded(at.length_mm))));
            row.extend(all.iter().skip(1).map(step));
            row.push(Value::Text(point.definition().to_owned()));
            Some(row)
        };
        Table { columns, rows: Point::ALL.into_iter().filter_map(row).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spec::patterns::Model;

    #[test]
    fn a_sheet_has_a_column_of_numbers_for_each_step() {
        let files = patterns::drafted(Model::Tshirt);
        let file = |name: &str| {
            let (name, bytes) = files.iter().find(|(known, _)| known == name).expect("drafted");
            SourceFile { name: name.clone(), bytes: bytes.clone().into() }
        };
        let seams = file("tshirt.seams.toml");
        let style = |size: &&str| {
            let pattern = file(&format!("tshirt-{size}.dxf"));
            patterns::read_style(&pattern, Some(&seams), None, None).expect("it is sewn")
        };
        let check = |sizes: &[&str], columns: &[&str]| {
            let styles: Vec<Style> = sizes.iter().map(style).collect();
            let names = sizes.iter().map(|size| size.to_uppercase()).collect();
            let table = Specification::of("tee".to_owned(), names, &styles).table();
            assert_eq!(table.columns, columns);
            let chest = table.rows.iter().find(|row| row[0] == Value::Text("half_chest".into())).expect("a chest");
            let number = |name: &str| {
                let column = columns.iter().position(|column| *column == name)?;
                if let Value::Real(number) = chest[column] { Some(number) } else { None }
            };
            for (before, size) in columns.iter().zip(&columns[1..]).skip(1) {
                let Some(step) = number(&size.replace("_mm", "_step_mm")) else { continue };
                let grown = number(size).expect("a length") - number(before).expect("a length");
                assert!((step - grown).abs() < 0.11 && step != 0.0, "{before} to {size}: {step}, not {grown}");
            }
            for line in table.csv().lines().skip(1) {
                assert!(!line.split(',').any(|cell| cell.starts_with(['+', '='])), "{line}");
            }
        };
        check(&["m"], &["point", "M_mm", "definition"]);
        let three = ["point", "S_mm", "M_mm", "L_mm", "M_step_mm", "L_step_mm", "definition"];
        check(&["s", "m", "l"], &three);
        let falling = ["point", "L_mm", "M_mm", "S_mm", "M_step_mm", "S_step_mm", "definition"];
        check(&["l", "m", "s"], &falling);
    }
}
