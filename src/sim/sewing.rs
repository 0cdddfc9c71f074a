//! Sewing: capped springs that draw the two sides of a seam together, then welding.

use crate::{SimError, quality};
use geom::V3;
use pattern::Garment;

/// Simulated vertex of each garment vertex once every seam is closed: groups of paired vertices, numbered by their
/// smallest member (thesis, Algorithm 5.4).
#[must_use]
pub fn welded(garment: &Garment) -> Vec<usize> {
    let mut leader: Vec<usize> = (0..garment.rest.len()).collect();
    fn find(leader: &mut [usize], mut v: usize) -> usize {
        while leader[v] != v {
            leader[v] = leader[leader[v]];
            v = leader[v];
        }
        v
    }
    for &[a, b] in garment.seams.iter().flat_map(|s| &s.pairs) {
        let (a, b) = (find(&mut leader, a), find(&mut leader, b));
        leader[a.max(b)] = a.min(b);
    }
    let mut number = vec![usize::MAX; leader.len()];
    let mut count = 0;
    (0..leader.len())
        .map(|v| {
            let group = find(&mut leader, v);
            if number[group] == usize::MAX {
                number[group] = count;
                count += 1;
            }
            number[group]
        })
        .collect()
}

/// Positions of the simulated vertices: the mean of the garment vertices of each group.
#[must_use]
pub fn merged(vertex_of: &[usize], positions: &[V3]) -> Vec<V3> {
    let count = vertex_of.iter().max().map_or(0, |m| m + 1);
    let mut sums = vec![(V3::zeros(), 0.0); count];
    for (&v, p) in vertex_of.iter().zip(positions) {
        sums[v].0 += p;
        sums[v].1 += 1.0;
    }
    sums.into_iter().map(|(sum, n)| sum / n).collect()
}

/// Every garment vertex on its own: nothing is sewn yet.
#[must_use]
pub fn unsewn(garment: &Garment) -> Vec<usize> {
    (0..garment.rest.len()).collect()
}

/// Ends a simulation whose seams stay open, the vertices of its garment at `positions`, m.
///
/// # Errors
/// [`SimError::Open`].
pub fn closed(garment: &Garment, positions: &[V3]) -> Result<(), SimError> {
    let piece_of = |v: usize| garment.pieces.iter().find(|piece| piece.vertices.contains(&v));
    let name = |v: usize| piece_of(v).map_or_else(String::new, |piece| piece.id.clone());
    match quality::widest_seam(garment, positions) {
        Some((gap_m, pair)) if gap_m > OPEN_M => {
            Err(SimError::Open { garment: garment.name.clone(), pieces: pair.map(name), gap_m })
        }
        _ => Ok(()),
    }
}

/// Springs between the vertices of seam pairs: `f = k d` up to a cap (4.15, with the cap trials asked for).
#[derive(Clone, Debug)]
pub struct Springs {
    /// Garment vertices that each spring draws together.
    pub pairs: Vec<[usize; 2]>,
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Greatest force, N.
    pub cap_n: f64,
    /// Greatest force when the springs begin, N; `cap_n` grows from it.
    first_cap_n: f64,
}

geom::constants! {
    "sewing",
    /// Most that springs grow by: garments that are stretched by half took up to 2e4.
    const MOST_GROWTH: f64 = 1e6;
    /// Gap of seams from which on they count as open, m: what welding them would make of a garment is no garment.
    pub const OPEN_M: f64 = 8e-2;
}

impl Springs {
    /// Springs on all seams of a garment that is not welded.
    #[must_use]
    pub fn new(garment: &Garment, stiffness_n_m: f64, cap_n: f64) -> Self {
        Self {
            pairs: garment.seams.iter().flat_map(|s| s.pairs.iter().copied()).collect(),
            stiffness_n_m,
            cap_n,
            first_cap_n: cap_n,
        }
    }

    /// Greatest distance of a pair, m.
    #[must_use]
    pub fn gap_m(&self, x: &[V3]) -> f64 {
        self.pairs.iter().map(|&[a, b]| (x[a] - x[b]).norm()).fold(0.0, f64::max)
    }

    /// Mean distance of the pairs, m.
    #[must_use]
    pub fn mean_gap_m(&self, x: &[V3]) -> f64 {
        self.pairs.iter().map(|&[a, b]| (x[a] - x[b]).norm()).sum::<f64>() / self.pairs.len().max(1) as f64
    }

    /// Makes the springs stronger: both what far pairs feel and what near ones do; says whether it did, since there is
    /// an end to that.
    pub fn tighten(&mut self, factor: f64) -> bool {
        let is_weaker = self.cap_n < MOST_GROWTH * self.first_cap_n;
        if is_weaker {
            self.stiffness_n_m *= factor;
            self.cap_n *= factor;
        }
        is_weaker
    }

    /// Energy, J: quadratic up to the cap, linear beyond.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        let knee = self.cap_n / self.stiffness_n_m;
        let of = |&[a, b]: &[usize; 2]| {
            let d = (x[a] - x[b]).norm();
            if d <= knee { 0.5 * self.stiffness_n_m * d * d } else { self.cap_n * (d - 0.5 * knee) }
        };
        self.pairs.iter().map(of).sum()
    }

    /// Adds the forces and returns each pair's stiffness: the secant beyond the cap, which bounds the energy from above.
    pub fn assemble(&self, x: &[V3], forces: &mut [V3]) -> Vec<([usize; 2], f64)> {
        let stiffness = |&[a, b]: &[usize; 2]| {
            let d = (x[a] - x[b]).norm();
            if self.stiffness_n_m * d <= self.cap_n { self.stiffness_n_m } else { self.cap_n / d }
        };
        self.pairs
            .iter()
            .map(|pair| {
                let k = stiffness(pair);
                let [a, b] = *pair;
                let pull = (x[b] - x[a]) * k;
                forces[a] += pull;
                forces[b] -= pull;
                (*pair, k)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::{self, sheets::sheet};

    #[test]
    fn springs_grow_and_not_for_ever() {
        let mut springs = Springs::new(&laboratory::garment(sheet(2, 2, 0.1)), 10.0, 1.0);
        let times = (0..1000).take_while(|_| springs.tighten(2.0)).count();
        assert_eq!(times, 20);
        assert!((springs.cap_n / MOST_GROWTH - 1.0).abs() < 0.1 && springs.stiffness_n_m == 10.0 * springs.cap_n);
    }
}
