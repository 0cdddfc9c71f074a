//! Specified lengths beside those of the pattern.

use super::matching::{Matching, RowMatch, Target};
use super::{SheetRow, SpecSheet};

/// Arithmetic noise of a deviation: far below what a tape tells.
const NOISE_MM: f64 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    In,
    Out,
}

impl Verdict {
    /// Name in tables and SQL.
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
    pub code: String,
    /// As written.
    pub description: String,
    /// Such as `half_chest`, `2*half_chest` or `half_below_armhole@100`. `None` for a row without a point.
    pub point: Option<String>,
    pub size: String,
    pub spec_mm: f64,
    /// Greatest shortfall. `None` where no tolerance is written.
    pub minus_mm: Option<f64>,
    /// Greatest excess. `None` as of `minus_mm`.
    pub plus_mm: Option<f64>,
    /// `None` where it is not known.
    pub flat_mm: Option<f64>,
    /// `None` without a drape, and across no cloth.
    pub worn_mm: Option<f64>,
    /// Flat length less the specification.
    pub deviation_mm: Option<f64>,
    /// `None` where length or tolerance is not known.
    pub verdict: Option<Verdict>,
    /// Specification less that of the size before. `None` for the first size.
    pub step_mm: Option<f64>,
    /// Flat length less that of the size before. `None` as of `step_mm`.
    pub flat_step_mm: Option<f64>,
}

impl SpecLine {
    pub fn is_out(&self) -> bool {
        self.verdict == Some(Verdict::Out)
    }

    pub fn judged(self) -> Self {
        let deviation_mm = self.flat_mm.map(|flat_mm| flat_mm - self.spec_mm);
        let verdict = deviation_mm.zip(self.minus_mm.zip(self.plus_mm)).map(|(off, (minus, plus))| {
            if off <= plus + NOISE_MM && off >= -minus - NOISE_MM { Verdict::In } else { Verdict::Out }
        });
        Self { deviation_mm, verdict, ..self }
    }
}

fn target(found: &RowMatch) -> Option<Target> {
    match found {
        RowMatch::Is(target, _) => Some(*target),
        _ => None,
    }
}

/// In the order of the sheet. `flat` gives the pattern's lengths in its sizes, mm.
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
