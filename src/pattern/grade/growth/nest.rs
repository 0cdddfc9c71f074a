//! Sizes of a grown pattern as a sample size with rules, and the ease of each size.

use super::{DIGIT_M, Growth, GrowthError, lengths_m};
use crate::grade::GradeTable;
use crate::handle::{self, Handle};
use crate::piece::Piece;
use crate::seams::{SAME_EASE, StyleError};
use crate::style::Style;
use geom::V2;
use geom::units::mm;
use toml_edit::{DocumentMut, InlineTable, Value, value};

/// Sizes of a pattern as the sample size and its rules.
#[derive(Clone, Debug, PartialEq)]
pub struct Graded {
    pub pieces: Vec<Piece>,
    pub table: GradeTable,
    /// Bytes of the seam file, with the ease of each size.
    pub seams: Vec<u8>,
    pub styles: Vec<Style>,
}

impl Growth {
    /// `sizes` are names with amounts, m, by which they differ from the pattern at hand; `sample` is an index.
    pub fn graded(&self, sizes: &[(String, Vec<(Handle, f64)>)], sample: usize) -> Result<Graded, GrowthError> {
        let own = &sizes[sample].1;
        let at = self.at(&self.steps(own)?.0)?;
        let mut all = Vec::new();
        for (_, amounts) in sizes {
            let beyond = |(handle, amount_m): &(Handle, f64)| {
                let own_m = own.iter().find(|(known, _)| known == handle).map_or(0.0, |(_, own_m)| *own_m);
                (*handle, amount_m - own_m)
            };
            all.push(at.steps(&amounts.iter().map(beyond).collect::<Vec<_>>())?);
        }
        let mut rules: Vec<Vec<V2>> = Vec::new();
        let number: Vec<u32> = (0..self.points.len())
            .map(|point| {
                let rule: Vec<V2> = all.iter().map(|(steps, _)| steps[point]).collect();
                let is_same = |other: &Vec<V2>| other.iter().zip(&rule).all(|(a, b)| (a - b).amax() < 0.5 * DIGIT_M);
                let known = rules.iter().position(is_same).unwrap_or(rules.len());
                if known == rules.len() {
                    rules.push(rule);
                }
                known as u32 + 1
            })
            .collect();
        let rules = rules.into_iter().enumerate().map(|(k, rule)| (k as u32 + 1, rule)).collect();
        let seams = at.with_corners(&sizes[sample].0)?;
        let mut pieces = at.pieces;
        for piece in &mut pieces {
            piece.size = Some(sizes[sample].0.clone());
            piece.grade_points.iter_mut().for_each(|point| point.rule = number[point.rule as usize - 1]);
        }
        let table =
            GradeTable { sizes: sizes.iter().map(|(name, _)| name.clone()).collect(), ..self.table(rules, sample) };
        let styles: Vec<Style> = all.into_iter().map(|(_, style)| style).collect();
        let named: Vec<(&str, &Style)> = sizes.iter().map(|(name, _)| name.as_str()).zip(&styles).collect();
        let seams = self.with_eases(&seams, &named)?;
        Ok(Graded { pieces, table, seams, styles })
    }

    /// Pattern displaced by some steps. A curve that follows is divided by its length, which is another there, so that
    /// seams are kept anew.
    fn at(&self, steps: &[V2]) -> Result<Self, GrowthError> {
        let mut at = Self { pieces: self.displaced(steps, None)?, style: self.loosely(steps, None)?, ..self.clone() };
        for (piece, before) in at.pieces.iter_mut().zip(&self.pieces) {
            piece.grade_points.clone_from(&before.grade_points);
            piece.grade_points.iter_mut().for_each(|point| point.at += steps[point.rule as usize - 1]);
        }
        at.points.iter_mut().zip(steps).for_each(|(point, step)| point.at += step);
        for number in 0..at.fields.len() {
            at.keep_seams(number)?;
        }
        Ok(at)
    }

    /// Seam file with the places of corners in the sample size. Sizes of a nest have the same vertices, so that the
    /// corners of all sizes are found from there.
    fn with_corners(&self, sample: &str) -> Result<Vec<u8>, GrowthError> {
        let seams = handle::with_corners(&self.seams, &self.file, &self.places(&self.pieces))?;
        let mut document = self.document(&seams)?;
        if document.get("size").is_some() {
            document["size"] = value(sample);
        }
        Ok(document.to_string().into_bytes())
    }

    /// Keeps the form of the text.
    fn document(&self, seams: &[u8]) -> Result<DocumentMut, GrowthError> {
        let syntax = |reason: String| StyleError::Syntax { file: self.file.clone(), reason };
        let text = std::str::from_utf8(seams).map_err(|error| syntax(error.to_string()))?;
        Ok(text.parse().map_err(|error: toml_edit::TomlError| syntax(error.to_string()))?)
    }

    /// Adds the ease of each size for seams whose sides differ.
    fn with_eases(&self, seams: &[u8], styles: &[(&str, &Style)]) -> Result<Vec<u8>, GrowthError> {
        let mut document = self.document(seams)?;
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
