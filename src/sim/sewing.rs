//! Sewing: springs of limited force draw the two sides of a seam together, then their vertices are welded (merged).

use crate::SimError;
use geom::V3;
use pattern::Garment;

/// Simulated vertex of each garment vertex once every seam is closed [T, Algorithm 5.4]: union-find over seam pairs,
/// groups numbered in the order of their smallest members.
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

/// Mean of the garment vertices of each group.
pub fn merged(vertex_of: &[usize], positions: &[V3]) -> Vec<V3> {
    let count = vertex_of.iter().max().map_or(0, |m| m + 1);
    let mut sums = vec![(V3::zeros(), 0.0); count];
    for (&v, p) in vertex_of.iter().zip(positions) {
        sums[v].0 += p;
        sums[v].1 += 1.0;
    }
    sums.into_iter().map(|(sum, n)| sum / n).collect()
}

/// Numbers vertices as if nothing were sewn.
pub fn unsewn(garment: &Garment) -> Vec<usize> {
    (0..garment.rest.len()).collect()
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamGap {
    pub gap_m: f64,
    pub pair: [usize; 2],
}

/// `None` where nothing is sewn.
pub fn widest_seam(garment: &Garment, positions: &[V3]) -> Option<SeamGap> {
    let pairs = garment.seams.iter().flat_map(|s| &s.pairs);
    let gaps = pairs.map(|&[a, b]| SeamGap { gap_m: (positions[a] - positions[b]).norm(), pair: [a, b] });
    gaps.max_by(|first, second| first.gap_m.total_cmp(&second.gap_m))
}

/// Fails with [`SimError::Open`] where a seam pair is more than [`OPEN_M`] apart.
pub fn closed(garment: &Garment, positions: &[V3]) -> Result<(), SimError> {
    let piece_of = |v: usize| garment.pieces.iter().find(|piece| piece.vertices.contains(&v));
    let name = |v: usize| piece_of(v).map_or_else(String::new, |piece| piece.id.clone());
    match widest_seam(garment, positions) {
        Some(SeamGap { gap_m, pair }) if gap_m > OPEN_M => {
            Err(SimError::Open { garment: garment.name.clone(), pieces: pair.map(name), gap_m })
        }
        _ => Ok(()),
    }
}

/// Springs between the vertices of seam pairs, `f = min(k d, f_max)` for a distance `d` [T 4.15]. The limit keeps
/// distant pairs from overstretching the cloth.
#[derive(Clone, Debug)]
pub struct Springs {
    pub pairs: Vec<[usize; 2]>,
    /// Stiffness `k`.
    pub stiffness_n_m: f64,
    /// Greatest force `f_max`.
    pub cap_n: f64,
    first_cap_n: f64,
}

geom::constants! {
    "sewing",
    /// Greatest factor by which the springs are strengthened. Judgement: garments whose cloth is stretched by half took
    /// factors up to 2e4.
    const MOST_GROWTH: f64 = 1e6;
    /// Gap above which a seam counts as open. Welding it would not give the garment of the pattern.
    pub const OPEN_M: f64 = 8e-2;
}

impl Springs {
    pub fn new(garment: &Garment, stiffness_n_m: f64, cap_n: f64) -> Self {
        Self {
            pairs: garment.seams.iter().flat_map(|s| s.pairs.iter().copied()).collect(),
            stiffness_n_m,
            cap_n,
            first_cap_n: cap_n,
        }
    }

    /// Greatest distance of a pair.
    pub fn gap_m(&self, x: &[V3]) -> f64 {
        self.pairs.iter().map(|&[a, b]| (x[a] - x[b]).norm()).fold(0.0, f64::max)
    }

    pub fn mean_gap_m(&self, x: &[V3]) -> f64 {
        self.pairs.iter().map(|&[a, b]| (x[a] - x[b]).norm()).sum::<f64>() / self.pairs.len().max(1) as f64
    }

    /// Multiplies stiffness and greatest force, so that distant and near pairs both feel it. Returns `false` once the
    /// greatest growth is reached, and then changes nothing.
    pub fn tighten(&mut self, factor: f64) -> bool {
        let is_weaker = self.cap_n < MOST_GROWTH * self.first_cap_n;
        if is_weaker {
            self.stiffness_n_m *= factor;
            self.cap_n *= factor;
        }
        is_weaker
    }

    /// J: `k d^2 / 2` up to the distance `f_max / k`, linear beyond.
    pub fn energy(&self, x: &[V3]) -> f64 {
        let knee = self.cap_n / self.stiffness_n_m;
        let spring_j = |&[a, b]: &[usize; 2]| {
            let d = (x[a] - x[b]).norm();
            if d <= knee { 0.5 * self.stiffness_n_m * d * d } else { self.cap_n * (d - 0.5 * knee) }
        };
        self.pairs.iter().map(spring_j).sum()
    }

    /// Adds the forces (N) and returns the stiffness of each pair, N/m. Beyond the limit it is the secant `f_max / d`,
    /// with which the quadratic model bounds the energy from above.
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
