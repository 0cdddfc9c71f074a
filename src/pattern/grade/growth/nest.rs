//! Sizes of a grown pattern as a sample size with rules, and the ease of each size.

use super::{DIGIT_M, Growth, GrowthError, lengths_m};
use crate::grade::GradeTable;
use crate::handle::Handle;
use crate::piece::Piece;
use crate::seams::{SAME_EASE, StyleError};
use crate::style::Style;
use geom::V2;
use geom::units::mm;
use toml_edit::{DocumentMut, InlineTable, Value, value};

/// Sizes of a pattern as the sample size and its rules.
#[derive(Clone, Debug, PartialEq)]
pub struct Graded {
    /// Pieces of the sample size with grade points.
    pub pieces: Vec<Piece>,
    /// Rules of all sizes.
    pub table: GradeTable,
    /// Bytes of the seam file, with the ease of each size.
    pub seams: Vec<u8>,
}

impl Growth {
    /// Sizes as rules of the sample size. `sizes` are names with amounts of handles, m, by which they differ from the
    /// pattern at hand; `sample` is the index of the sample size.
    ///
    /// # Errors
    /// [`GrowthError`] if a piece cannot be graded so far or a seam comes apart.
    pub fn graded(&self, sizes: &[(String, Vec<(Handle, f64)>)], sample: usize) -> Result<Graded, GrowthError> {
        let mut all = Vec::new();
        for (_, amounts) in sizes {
            all.push(self.steps(amounts)?);
        }
        let mut rules: Vec<Vec<V2>> = Vec::new();
        let number: Vec<u32> = (0..self.points.len())
            .map(|point| {
                let rule: Vec<V2> = all.iter().map(|(steps, _)| steps[point] - all[sample].0[point]).collect();
                let is_same = |other: &Vec<V2>| other.iter().zip(&rule).all(|(a, b)| (a - b).amax() < 0.5 * DIGIT_M);
                let known = rules.iter().position(is_same).unwrap_or(rules.len());
                if known == rules.len() {
                    rules.push(rule);
                }
                known as u32 + 1
            })
            .collect();
        let rules = rules.into_iter().enumerate().map(|(k, rule)| (k as u32 + 1, rule)).collect();
        let mut pieces = self.displaced(&all[sample].0, None)?;
        for (piece, before) in pieces.iter_mut().zip(&self.pieces) {
            piece.size = Some(sizes[sample].0.clone());
            piece.grade_points.clone_from(&before.grade_points);
            piece.grade_points.iter_mut().for_each(|point| point.at += all[sample].0[point.rule as usize - 1]);
            piece.grade_points.iter_mut().for_each(|point| point.rule = number[point.rule as usize - 1]);
        }
        let table =
            GradeTable { sizes: sizes.iter().map(|(name, _)| name.clone()).collect(), ..self.table(rules, sample) };
        let styles: Vec<(&str, &Style)> =
            sizes.iter().zip(&all).map(|((name, _), (_, style))| (name.as_str(), style)).collect();
        Ok(Graded { pieces, table, seams: self.with_eases(&styles)? })
    }

    /// Bytes of the seam file with the ease of each size, for seams whose sides differ.
    fn with_eases(&self, styles: &[(&str, &Style)]) -> Result<Vec<u8>, GrowthError> {
        let syntax = |reason: String| StyleError::Syntax { file: self.file.clone(), reason };
        let text = std::str::from_utf8(&self.seams).map_err(|error| syntax(error.to_string()))?;
        let mut document: DocumentMut =
            text.parse().map_err(|error: toml_edit::TomlError| syntax(error.to_string()))?;
        let lengths: Vec<(&str, Vec<[f64; 2]>)> =
            styles.iter().map(|(name, style)| (*name, lengths_m(style))).collect();
        for (number, [a, b]) in self.lengths_m.iter().enumerate() {
            let entry = &mut document["seam"][number];
            if (a - b).abs() < SAME_EASE * self.tolerance_m && entry.get("ease_mm").is_none() {
                continue;
            }
            let mut eases = InlineTable::new();
            for (name, lengths) in &lengths {
                let [a, b] = lengths[number];
                eases.insert(*name, Value::from((mm(a - b) * 100.0).round() / 100.0));
            }
            entry["ease_mm"] = value(eases);
        }
        Ok(document.to_string().into_bytes())
    }
}
