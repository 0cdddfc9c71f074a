//! Insets of the body, ring by ring: the distance by which it must shrink for the garment to close on it.
//!
//! A bust stretches the front and leaves the back slack. The pattern is too small only where the body inside a ring has
//! a greater girth than the ring's cloth. There the body counts as smaller all round, by as much as the ring needs.

use std::f64::consts::TAU;

use super::girth_lines::{Ring, Rings};
use geom::hull::tape_girth;
use geom::section::{Outline, section};
use geom::{TriMesh, V2, V3};

geom::constants! {
    "hybrid.inset",
    /// Share applied of the inset that the stretch of a ring asks for.
    const GAIN: f64 = 0.3;
    /// Inset that a ring may come to need in addition to the judged one. A tape is straighter than the body, the cloth
    /// beside a ring pulls at it, and over a bust the front is tight before the back is.
    const DOUBT_M: f64 = 20e-3;
    /// Least inset of a ring that was too small once: it may become too small again.
    const LEAST_INSET_M: f64 = 1e-6;
    /// Growth of a ring's inset between two judgements, for a garment that hangs from the shoulders and does not slide.
    const SLIP_M: f64 = 4e-3;
    /// As `SLIP_M`, for a garment that only its rings hold up: with more it would slide over wider parts of the body.
    const SLIP_ON_HIPS_M: f64 = 1e-3;
    /// Decrease of an inset per length of cloth away from its ring: over a slope of 0.1 the cloth is longer by 0.5 %.
    const FADE: f64 = 0.1;
    /// Greatest difference of the insets of neighbouring rings.
    const STEEPEST_M: f64 = 6e-3;
    /// Greatest lack of a ring, as a share of its length. A greater one compares it with another part of the body, as
    /// the trunk together with an arm.
    const MOST_LACK: f64 = 0.5;
}

#[derive(Default)]
pub struct Insets {
    rings: Vec<Ring>,
    beside: Vec<[usize; 2]>,
    /// Inset of each ring; 0 where it is large enough.
    now_m: Vec<f64>,
    /// Greatest inset of each ring; 0 where it must not yield.
    most_m: Vec<f64>,
    /// Growth of each inset between two judgements.
    slip_m: f64,
}

#[derive(Clone, Copy, Debug)]
pub struct Fit {
    pub offset_m: f64,
    pub share: f64,
}

impl Insets {
    /// Judges which rings are too small, and the insets that they need. `is_hung` is true of a garment that hangs from
    /// the shoulders.
    pub fn judged(lines: Rings, body: &TriMesh, x: &[V3], fit: Fit, is_hung: bool) -> Self {
        let Rings { rings, beside } = lines;
        let slip_m = if is_hung { SLIP_M } else { SLIP_ON_HIPS_M };
        let mut insets = Self { rings, beside, now_m: Vec::new(), most_m: Vec::new(), slip_m };
        insets.now_m = insets.lacks(body, x, fit);
        insets.most_m = insets.now_m.iter().map(|now| if *now > 0.0 { now + DOUBT_M } else { 0.0 }).collect();
        insets
    }

    /// Judges again after the cloth has slid. A ring that was large enough at first does not count as too small where
    /// it slides over a wider part of the body: that part holds it up.
    pub fn judge_again(&mut self, body: &TriMesh, x: &[V3], fit: Fit) {
        let lacks = self.lacks(body, x, fit);
        for ((now, most), lack) in self.now_m.iter_mut().zip(&mut self.most_m).zip(lacks) {
            *most = if lack > 0.0 && *now > 0.0 { now.min(lack + DOUBT_M) + self.slip_m } else { 0.0 };
            *now = now.min(*most);
        }
    }

    /// Inset that each ring needs, m: the girth of the body inside less the length of the cloth, over a turn.
    fn lacks(&self, body: &TriMesh, x: &[V3], fit: Fit) -> Vec<f64> {
        let Fit { offset_m, share } = fit;
        let lack = |ring: &Ring| {
            let lack_m = inside_m(body, ring, x)? + TAU * offset_m - (1.0 + share) * ring.rest_m;
            (lack_m < MOST_LACK * ring.rest_m).then_some(lack_m.max(0.0) / TAU)
        };
        let mut lacks: Vec<f64> = self.rings.iter().map(|ring| lack(ring).unwrap_or(f64::INFINITY)).collect();
        // Girths change little from ring to ring: an outlier is the girth of trunk and arm together.
        let (up, down) = (self.beside.iter(), self.beside.iter().rev());
        for &[a, b] in up.chain(down) {
            lacks[a] = lacks[a].min(lacks[b] + STEEPEST_M);
            lacks[b] = lacks[b].min(lacks[a] + STEEPEST_M);
        }
        lacks.iter_mut().filter(|lack| lack.is_infinite()).for_each(|lack| *lack = 0.0);
        lacks
    }

    /// Corrects the insets of rings judged too small, until their cloth is stretched by just `share`.
    pub fn correct(&mut self, x: &[V3], share: f64) {
        if self.now_m.iter().all(|inset| *inset == 0.0) {
            return;
        }
        let lengths: Vec<[f64; 2]> = self.rings.iter().map(|ring| [ring.length_m(x), ring.rest_m]).collect();
        // Averaged with the neighbours: the stretch of a single ring oscillates.
        let mut sums = lengths.clone();
        for &[a, b] in &self.beside {
            for k in 0..2 {
                sums[a][k] += lengths[b][k];
                sums[b][k] += lengths[a][k];
            }
        }
        for (k, now) in self.now_m.iter_mut().enumerate().filter(|(k, _)| self.most_m[*k] > 0.0) {
            let lack_m = (sums[k][0] / sums[k][1] - 1.0 - share) * self.rings[k].rest_m;
            *now = (*now + GAIN * lack_m / TAU).clamp(LEAST_INSET_M, self.most_m[k]);
        }
    }

    /// Greatest of a sewn vertex's own inset, those of its rings, and those of other vertices less [`FADE`] times the
    /// distance over the cloth, m. `sides` are the cloth's edges with their lengths in the pattern, m.
    pub fn of_vertices(&self, own_m: Vec<f64>, sides: &[([usize; 2], f64)]) -> Vec<f64> {
        let mut insets = own_m;
        for (ring, now) in self.rings.iter().zip(&self.now_m) {
            ring.vertices().for_each(|v| insets[v] = insets[v].max(*now));
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

/// Girth of the parts of the body inside a ring. A part is inside if it contains the ring's middle or has its own
/// middle within the ring, as both legs have in a skirt. `None` where no part is.
fn inside_m(body: &TriMesh, ring: &Ring, x: &[V3]) -> Option<f64> {
    let plane = ring.plane(x)?;
    let line = Outline { points: ring.points(x).map(|p| plane.project(p)).collect(), closed: true };
    let middle = |outline: &Outline| {
        let (low, high) = outline.bounds();
        (low + high) / 2.0
    };
    let own = middle(&line);
    let held: Vec<V2> = section(body, &plane)
        .into_iter()
        .filter(|part| part.closed && (part.contains(own) || line.contains(middle(part))))
        .flat_map(|part| part.points)
        .collect();
    (!held.is_empty()).then(|| tape_girth(&held))
}
