//! Specified lengths beside those of the pattern.

use super::matching::{Matching, RowMatch, Target};
use super::{SheetRow, SpecSheet};

/// Arithmetic noise of a deviation, mm: far below what a tape tells.
const NOISE_MM: f64 = 1e-3;

/// Verdict on a length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Within the tolerance.
    In,
    /// Outside the tolerance.
    Out,
}

impl Verdict {
    /// Name in tables and SQL.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::In => "in",
            Self::Out => "out",
        }
    }
}

/// A specified length of a size, beside the pattern's. Lengths are those of the sheet's row: of a whole girth where that
/// is specified.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct SpecLine {
    /// Code of the row.
    pub code: String,
    /// Description of the row, as written.
    pub description: String,
    /// Point of measure, as `half_chest`, `2*half_chest` or `half_below_armhole@100`. `None` for a row without one.
    pub point: Option<String>,
    /// Name of the size.
    pub size: String,
    /// Specification, mm.
    pub spec_mm: f64,
    /// Greatest shortfall, mm. `None` where no tolerance is written.
    pub minus_mm: Option<f64>,
    /// Greatest excess, mm. `None` as of `minus_mm`.
    pub plus_mm: Option<f64>,
    /// Length of the flat pattern, mm. `None` where it is not known.
    pub flat_mm: Option<f64>,
    /// Length on the drape, mm. `None` without a drape, and across no cloth.
    pub worn_mm: Option<f64>,
    /// Flat length less the specification, mm.
    pub deviation_mm: Option<f64>,
    /// Verdict of the tolerance. `None` where length or tolerance is not known.
    pub verdict: Option<Verdict>,
    /// Specification less that of the size before, mm. `None` for the first size.
    pub step_mm: Option<f64>,
    /// Flat length less that of the size before, mm. `None` as of `step_mm`.
    pub flat_step_mm: Option<f64>,
}

impl SpecLine {
    /// True outside the tolerance.
    #[must_use]
    pub fn is_out(&self) -> bool {
        self.verdict == Some(Verdict::Out)
    }

    /// Line of a row in a size, with deviation and verdict.
    #[must_use]
    pub fn judged(self) -> Self {
        let deviation_mm = self.flat_mm.map(|flat_mm| flat_mm - self.spec_mm);
        let verdict = deviation_mm.zip(self.minus_mm.zip(self.plus_mm)).map(|(off, (minus, plus))| {
            if off <= plus + NOISE_MM && off >= -minus - NOISE_MM { Verdict::In } else { Verdict::Out }
        });
        Self { deviation_mm, verdict, ..self }
    }
}

/// Point of each row, with its share. `None` for a row without a point.
fn target(found: &RowMatch) -> Option<Target> {
    match found {
        RowMatch::Is(target, _) => Some(*target),
        _ => None,
    }
}

/// Lines of a sheet: every row in every size, in the order of the sheet. `flat` gives the pattern's lengths of a point in
/// the sizes of the sheet, mm.
#[must_use]
pub fn lines(sheet: &SpecSheet, matching: &Matching, flat: &super::matching::Lengths<'_>) -> Vec<SpecLine> {
    let unit = matching.unit.unit.mm_per_unit();
    let mut all = Vec::new();
    for (row, found) in sheet.rows.iter().zip(&matching.rows) {
        let SheetRow { code, description, plus, minus, lengths, .. } = row;
        let target = target(found);
        let flats = target.map_or_else(
            || vec![None; lengths.len()],
            |target| flat(target.measure).into_iter().map(|mm| mm.map(|mm| target.times * mm)).collect(),
        );
        let mut before: Option<(f64, Option<f64>)> = None;
        for ((size, length), flat_mm) in sheet.sizes.iter().zip(lengths).zip(flats) {
            let Some(length) = length else {
                before = None;
                continue;
            };
            let line = SpecLine {
                code: code.clone(),
                description: description.clone(),
                point: target.map(|target| target.to_string()),
                size: size.clone(),
                spec_mm: length * unit,
                minus_mm: minus.map(|minus| minus * unit),
                plus_mm: plus.map(|plus| plus * unit),
                flat_mm,
                ..SpecLine::default()
            };
            let step_mm = before.map(|(spec_mm, _)| line.spec_mm - spec_mm);
            let flat_step_mm = before.and_then(|(_, flat)| Some(line.flat_mm? - flat?));
            before = Some((line.spec_mm, line.flat_mm));
            all.push(SpecLine { step_mm, flat_step_mm, ..line }.judged());
        }
    }
    all
}
