//! How much the cloth is stretched round the body, over whole rings of rows.
//!
//! A piece is drawn upright, so that its rows (the `u` direction) go round trunk or limb, and on in the piece beside it: front
//! and back make a ring. A bust stretches the front and leaves the back slack; only where the whole ring is stretched is the
//! pattern too small.

use std::collections::{BTreeMap, BTreeSet};

use super::elastic::Elastic;
use super::sewn::Sewn;
use crate::geom::V3;
use crate::pattern::{Garment, Role};

/// The part of the body that a piece goes round together with others.
fn limb(role: Role) -> Role {
    use Role::*;
    match role {
        Front | Back | BodiceFront | BodiceBack | SkirtFront | SkirtBack => Front,
        LegFrontRight | LegBackRight | LegFrontLeft | LegBackLeft => LegFrontRight,
        other => other,
    }
}

/// Height of a row in the piece's plane, m.
const HEIGHT_M: f64 = 0.02;

/// The rows of a garment's pieces.
pub struct Rows {
    /// Row of each triangle.
    of_triangle: Vec<usize>,
    /// Row and sewn vertex of each garment vertex.
    of_vertex: Vec<(usize, usize)>,
    /// Whether each row and the next are of one piece.
    goes_on: Vec<bool>,
    /// Rows that go on in each other round the body, each with itself.
    rings: Vec<Vec<usize>>,
}

impl Rows {
    /// Sorts triangles and vertices into rows.
    #[must_use]
    pub fn new(garment: &Garment, sewn: &Sewn) -> Self {
        let mut rows = Self {
            of_triangle: vec![0; garment.triangles.len()],
            of_vertex: sewn.vertex_of.iter().map(|&v| (0, v)).collect(),
            goes_on: Vec::new(),
            rings: Vec::new(),
        };
        for piece in &garment.pieces {
            let low = garment.rest[piece.vertices.clone()].iter().map(|p| p.y).fold(f64::MAX, f64::min);
            let first = rows.goes_on.len();
            let row = |v: f64| first + ((v - low) / HEIGHT_M).max(0.0) as usize;
            for v in piece.vertices.clone() {
                rows.of_vertex[v].0 = row(garment.rest[v].y);
            }
            for t in piece.triangles.clone() {
                rows.of_triangle[t] = row(garment.triangles[t].iter().map(|&v| garment.rest[v].y).sum::<f64>() / 3.0);
            }
            let last = piece.vertices.clone().map(|v| rows.of_vertex[v].0).max().unwrap_or(first);
            rows.goes_on.resize(last, true);
            rows.goes_on.push(false);
        }
        rows.find_rings(garment);
        rows
    }

    /// Joins each row with those it goes on in, over two seams at most: from a half of the front over the other to the back.
    fn find_rings(&mut self, garment: &Garment) {
        let piece_of = |v: usize| garment.pieces.iter().position(|p| p.vertices.contains(&v)).unwrap_or(usize::MAX);
        // Seam vertices that a row shares with each row of other pieces of its limb.
        let mut joined: BTreeSet<usize> = BTreeSet::new();
        let mut shared: BTreeMap<(usize, usize), BTreeMap<usize, usize>> = BTreeMap::new();
        for &pair in garment.seams.iter().flat_map(|s| &s.pairs) {
            let pieces = pair.map(piece_of);
            let limbs = pieces.map(|p| limb(garment.pieces[p].role));
            if limbs[0] != limbs[1] {
                continue;
            }
            joined.extend(pair);
            if pieces[0] == pieces[1] {
                continue;
            }
            let rows = pair.map(|v| self.of_vertex[v].0);
            for (own, other) in [(0, 1), (1, 0)] {
                *shared.entry((rows[own], pieces[other])).or_default().entry(rows[other]).or_default() += 1;
            }
        }
        let mut beside = vec![Vec::new(); self.goes_on.len()];
        for ((row, _), others) in shared {
            // Heights differ a little from piece to piece: the row it shares most with.
            beside[row].extend(others.into_iter().max_by_key(|&(_, count)| count).map(|(other, _)| other));
        }
        let ring = |row: usize| {
            let mut ring = vec![row];
            for _ in 0..2 {
                let next: Vec<usize> = ring.iter().flat_map(|&r| beside[r].iter().copied()).collect();
                ring.extend(next);
                ring.sort_unstable();
                ring.dedup();
            }
            ring
        };
        self.rings = (0..beside.len()).map(ring).collect();
        self.close_rings(garment, &joined);
    }

    /// Adds the nearest row that closes to rows that do not: beside an armhole a front is as tight as below it, but may be
    /// stretched by itself across a bust. A row closes when cloth of the same limb goes on at both its ends, in vertices
    /// that are `joined`.
    fn close_rings(&mut self, garment: &Garment, joined: &BTreeSet<usize>) {
        let mut closed = self.rings.clone();
        for piece in &garment.pieces {
            let mut ends: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
            for v in piece.vertices.clone() {
                let u = |w: usize| garment.rest[w].x;
                let [left, right] = ends.entry(self.of_vertex[v].0).or_insert([v, v]);
                *left = if u(v) < u(*left) { v } else { *left };
                *right = if u(v) > u(*right) { v } else { *right };
            }
            let (whole, open): (Vec<_>, Vec<_>) =
                ends.into_iter().partition(|(_, ends)| ends.iter().all(|v| joined.contains(v)));
            for (row, _) in open {
                if let Some((near, _)) = whole.iter().min_by_key(|(other, _)| other.abs_diff(row)) {
                    closed[row].extend(&self.rings[*near]);
                }
            }
        }
        self.rings = closed;
    }

    /// Stretch beyond 1 of the ring through each sewn vertex: the mean of its slackest row, from which the others can still
    /// take cloth. Of the most stretched ring where rings meet.
    #[must_use]
    pub fn stretch(&self, elastic: &Elastic, x: &[V3]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.goes_on.len()];
        for (&row, (stretch, area)) in self.of_triangle.iter().zip(elastic.stretches(x)) {
            sums[row].0 += (stretch[(0, 0)] - 1.0) * area;
            sums[row].1 += area;
        }
        // Each row with its neighbours: single rows are few triangles high.
        let wide = |row: usize| {
            let above = self.goes_on[row].then_some(row + 1);
            let below = row.checked_sub(1).filter(|&below| self.goes_on[below]);
            [Some(row), above, below].into_iter().flatten()
        };
        let mean = |row: usize| {
            let (stretch, area) = wide(row).fold((0.0, 0.0), |sum, row| (sum.0 + sums[row].0, sum.1 + sums[row].1));
            stretch / area.max(f64::MIN_POSITIVE)
        };
        let means: Vec<f64> = (0..sums.len()).map(mean).collect();
        let slackest: Vec<f64> =
            self.rings.iter().map(|ring| ring.iter().map(|&row| means[row]).fold(f64::MAX, f64::min)).collect();
        let mut greatest = vec![f64::MIN; x.len()];
        for &(row, v) in &self.of_vertex {
            greatest[v] = greatest[v].max(slackest[row]);
        }
        greatest
    }
}
