//! By how much the body must be smaller for the garment to close on it, ring by ring.
//!
//! A bust stretches the front and leaves the back slack; only where the body inside a ring is wider than its cloth is the
//! pattern too small. There the body counts as smaller all round, by as much as the ring needs.

use std::f64::consts::TAU;

use super::ring::Ring;
use geom::hull::tape_girth;
use geom::section::{Outline, section};
use geom::{TriMesh, V2, V3};

geom::constants! {
    "hybrid.inset",
    /// Share of what the stretch of a ring says that its inset is corrected by at once.
    const GAIN: f64 = 0.3;
    /// Inset that a ring may come to need besides the judged one, m: a tape is straighter than the body, the cloth beside a ring
    /// pulls at it, and over a bust the front is tight before the back is.
    const DOUBT_M: f64 = 20e-3;
    /// Inset that a ring keeps that was too small once, m: it may become so again.
    const LEAST_INSET_M: f64 = 1e-6;
    /// Inset that a ring may come to need besides what it has where it is worn, m, until it is judged again. What hangs from the
    /// shoulders does not slide.
    const SLIP_M: f64 = 4e-3;
    /// The same for what is held up by its rings alone, m: one that could yield more would slide over what is wider.
    const SLIP_ON_HIPS_M: f64 = 1e-3;
    /// By how much an inset is less per length of the cloth away from its ring: over a slope of 0.1 the cloth is longer by 0.5 %.
    const FADE: f64 = 0.1;
    /// By how much an inset may be greater from one ring to the next, m.
    const STEEPEST_M: f64 = 6e-3;
    /// A ring is not too small by more than this share: what it is compared with is another part of the body, as the trunk
    /// with an arm.
    const MOST_LACK: f64 = 0.5;
}

/// The insets of a garment's rings.
#[derive(Default)]
pub struct Insets {
    rings: Vec<Ring>,
    /// Rings that lie next to each other.
    beside: Vec<[usize; 2]>,
    /// Of each ring, m; 0 where it is large enough.
    now_m: Vec<f64>,
    /// What each may grow to, m; 0 where the ring must not yield.
    most_m: Vec<f64>,
    /// What each may grow by between two judgements, m.
    slip_m: f64,
}

impl Insets {
    /// Judges by how much rings are too small. `offset_m` is how far off the skin they lie, `share` how far they may
    /// be stretched, positions `x` are in m; `is_hung` says whether the garment hangs from the shoulders.
    #[must_use]
    pub fn judged(
        (rings, beside): (Vec<Ring>, Vec<[usize; 2]>),
        body: &TriMesh,
        x: &[V3],
        offset_m: f64,
        share: f64,
        is_hung: bool,
    ) -> Self {
        let slip_m = if is_hung { SLIP_M } else { SLIP_ON_HIPS_M };
        let mut insets = Self { rings, beside, now_m: Vec::new(), most_m: Vec::new(), slip_m };
        insets.now_m = insets.lacks(body, x, offset_m, share);
        insets.most_m = insets.now_m.iter().map(|now| if *now > 0.0 { now + DOUBT_M } else { 0.0 }).collect();
        insets
    }

    /// Judges again, when the cloth has slid: a ring that was large enough where it is worn does not become too small by
    /// sliding to where the body is wider, which holds it up.
    pub fn judge_again(&mut self, body: &TriMesh, x: &[V3], offset_m: f64, share: f64) {
        let lacks = self.lacks(body, x, offset_m, share);
        for ((now, most), lack) in self.now_m.iter_mut().zip(&mut self.most_m).zip(lacks) {
            *most = if lack > 0.0 && *now > 0.0 { now.min(lack + DOUBT_M) + self.slip_m } else { 0.0 };
            *now = now.min(*most);
        }
    }

    /// By how much the body must be smaller for each ring, m: a tape round it inside the ring is longer than the ring's cloth.
    fn lacks(&self, body: &TriMesh, x: &[V3], offset_m: f64, share: f64) -> Vec<f64> {
        let lack = |ring: &Ring| {
            let lack_m = inside_m(body, ring, x)? + TAU * offset_m - (1.0 + share) * ring.rest_m;
            (lack_m < MOST_LACK * ring.rest_m).then_some(lack_m.max(0.0) / TAU)
        };
        let mut lacks: Vec<f64> = self.rings.iter().map(|ring| lack(ring).unwrap_or(f64::INFINITY)).collect();
        // Girths change little from ring to ring: one that stands out is that of trunk and arm together.
        let (up, down) = (self.beside.iter(), self.beside.iter().rev());
        for &[a, b] in up.chain(down) {
            lacks[a] = lacks[a].min(lacks[b] + STEEPEST_M);
            lacks[b] = lacks[b].min(lacks[a] + STEEPEST_M);
        }
        lacks.iter_mut().filter(|lack| lack.is_infinite()).for_each(|lack| *lack = 0.0);
        lacks
    }

    /// Corrects the insets of rings that were judged too small: until their cloth is stretched by a share, no more and no less.
    pub fn correct(&mut self, x: &[V3], share: f64) {
        if self.now_m.iter().all(|inset| *inset == 0.0) {
            return;
        }
        let lengths: Vec<[f64; 2]> = self.rings.iter().map(|ring| [ring.length_m(x), ring.rest_m]).collect();
        // With its neighbours: a single ring wavers.
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

    /// Inset for each sewn vertex, m: its own or that of its ring, the greatest where it has several, and about it less and less with
    /// the distance over the cloth. `sides` are the lengths of the cloth's edges in the pattern, m.
    #[must_use]
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

/// Length of a tape round what a ring holds of the body, m: a part of the body in which its middle lies, or whose middle lies
/// within it, as both legs' do in a skirt. `None` where it holds nothing.
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
