//! By how much the body must be smaller for the garment to close on it, ring by ring.
//!
//! A bust stretches the front and leaves the back slack; only where the body inside a ring is wider than its cloth is the
//! pattern too small. There the body counts as smaller all round, by as much as the ring needs.

use std::f64::consts::TAU;

use super::elastic::Elastic;
use super::rows::Rows;
use crate::geom::hull::tape_girth;
use crate::geom::section::{Plane, section};
use crate::geom::{TriMesh, V3};

/// Share of what the stretch of a ring says that its inset is corrected by at once.
const GAIN: f64 = 0.3;
/// Inset that a ring may come to need besides four times the judged one, m: rings are not quite level, and the cloth beside a ring
/// pulls at it.
const DOUBT_M: f64 = 6e-3;
/// Inset that a ring keeps that was too small once, m: it may become so again.
const LEAST_INSET_M: f64 = 1e-6;
/// By how much an inset is less per length of the cloth away from its ring.
const FADE: f64 = 0.05;
/// By how much an inset may be greater from one row to the next, m.
const STEEPEST_M: f64 = 6e-3;
/// A ring is not too small by more than this share: what it is compared with is another part of the body, as the trunk
/// with an arm.
const MOST_LACK: f64 = 0.5;

/// The insets of a garment's rows.
pub struct Insets {
    rows: Rows,
    /// Of each row, m; 0 where its ring is large enough.
    now_m: Vec<f64>,
    /// The same as they were judged last, before corrections.
    judged_m: Vec<f64>,
}

impl Insets {
    /// None at first.
    #[must_use]
    pub fn new(rows: Rows) -> Self {
        let none = vec![0.0; rows.len()];
        Self { rows, now_m: none.clone(), judged_m: none }
    }

    /// Judges by how much rings are too small, where the cloth is now: a tape round the body inside them, `offset_m` off the
    /// skin, is longer than their cloth stretched by a share. Positions `x` in m.
    pub fn judge(&mut self, body: &TriMesh, x: &[V3], offset_m: f64, share: f64) {
        let mut members = vec![Vec::new(); self.rows.len()];
        for &(row, v) in self.rows.of_vertex() {
            members[row].push(v);
        }
        let middle = |rows: &mut dyn Iterator<Item = usize>| {
            let (sum, n) =
                rows.flat_map(|r| &members[r]).fold((V3::zeros(), 0.0), |(sum, n), &v| (sum + x[v], n + 1.0));
            (n > 0.0).then(|| sum / n)
        };
        let lack = |row: usize| {
            let ring = self.rows.ring(row);
            let centre = middle(&mut ring.iter().copied())?;
            let [above, below] = [0, 1].map(|k| middle(&mut ring.iter().map(|&r| self.rows.beside(r)[k].unwrap_or(r))));
            let plane = Plane::normal_to(centre, (above? - below?).try_normalize(1e-6)?);
            let outlines = section(body, &plane);
            let inside = outlines.iter().find(|o| o.closed && o.contains(plane.project(centre)))?;
            let cloth_m = self.rows.girth_m(row);
            let lack_m = tape_girth(&inside.points) + TAU * offset_m - (1.0 + share) * cloth_m;
            (lack_m < MOST_LACK * cloth_m).then_some(lack_m)
        };
        let lacks: Vec<Option<f64>> =
            (0..self.rows.len()).map(|row| lack(row).filter(|_| self.rows.is_closed(row))).collect();
        let judged = |row: usize| {
            let of_piece = (0..lacks.len()).filter(|&other| self.rows.are_of_one_piece(row, other));
            let known: Vec<(usize, f64)> =
                of_piece.filter_map(|other| Some((other, lacks[other]?.max(0.0) / TAU))).collect();
            let &(nearest, _) = known.iter().min_by_key(|(other, _)| other.abs_diff(row))?;
            // Girths change little from row to row: one that stands out is that of trunk and arm together.
            let steepest = |&(other, inset): &(usize, f64)| inset + STEEPEST_M * other.abs_diff(nearest) as f64;
            known.iter().map(steepest).min_by(f64::total_cmp).filter(|_| self.rows.is_closed(row))
        };
        self.judged_m = (0..self.rows.len()).map(|row| judged(row).unwrap_or(0.0)).collect();
        self.now_m.clone_from(&self.judged_m);
    }

    /// Corrects the insets of rings that were judged too small: until their cloth is stretched by a share, no more and no less.
    pub fn correct(&mut self, elastic: &Elastic, x: &[V3], share: f64) {
        if self.judged_m.iter().all(|inset| *inset == 0.0) {
            return;
        }
        let stretches = self.rows.stretches(elastic, x);
        let corrected = |(row, &judged): (usize, &f64)| {
            let lack_m = (stretches[row] - share) * self.rows.girth_m(row);
            let now = (self.now_m[row] + GAIN * lack_m / TAU).clamp(LEAST_INSET_M, 4.0 * judged + DOUBT_M);
            if judged > 0.0 { now } else { 0.0 }
        };
        let own: Vec<f64> = self.judged_m.iter().enumerate().map(corrected).collect();
        self.now_m = own;
    }

    /// Inset for each sewn vertex, m: that of its ring, the greatest where pieces meet, and about rings less and less with
    /// the distance over the cloth. `sides` are the lengths of the cloth's edges in the pattern, m.
    #[must_use]
    pub fn of_vertices(&self, count: usize, sides: &[([usize; 2], f64)]) -> Vec<f64> {
        let mut insets = vec![0.0_f64; count];
        for &(row, v) in self.rows.of_vertex() {
            insets[v] = insets[v].max(self.now_m[row]);
        }
        let mut spreads = insets.iter().any(|inset| *inset > 0.0);
        while spreads {
            spreads = false;
            for &([a, b], length_m) in sides {
                for (from, to) in [(a, b), (b, a)] {
                    let faded = insets[from] - FADE * length_m;
                    if faded > insets[to] {
                        insets[to] = faded;
                        spreads = true;
                    }
                }
            }
        }
        insets
    }
}
