//! The rings in which a garment goes round the body.
//!
//! A piece is drawn upright, so that its rows (the `u` direction) go round trunk or limb, and on in the piece beside it: front
//! and back make a ring.

use std::collections::{BTreeMap, BTreeSet};

use super::elastic::Elastic;
use super::sewn::Sewn;
use crate::geom::{V2, V3};
use crate::pattern::{Garment, Role, SeamMesh};

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

/// The pairs of a seam, and whether it runs upright there, across the rows: round the body cloth goes on over sides and
/// inseams, not over shoulders.
fn upright<'a>(garment: &'a Garment, seam: &'a SeamMesh) -> impl Iterator<Item = ([usize; 2], bool)> + 'a {
    let pairs = &seam.pairs;
    pairs.iter().enumerate().map(move |(k, &pair)| {
        let (before, after) = (pairs[k.saturating_sub(1)], pairs[(k + 1).min(pairs.len() - 1)]);
        let is_upright = |side: usize| {
            let way = garment.rest[after[side]] - garment.rest[before[side]];
            way.y.abs() > way.x.abs()
        };
        (pair, is_upright(0) && is_upright(1))
    })
}

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
    /// Whether the ring of each row closes.
    closed: Vec<bool>,
    /// Width of each row in the piece's plane, m.
    widths_m: Vec<f64>,
    /// Where the middle line of each row begins and ends: its `u`, m, and the edge of the mesh that it crosses there.
    ends: Vec<[(f64, [usize; 2]); 2]>,
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
            closed: Vec::new(),
            widths_m: Vec::new(),
            ends: Vec::new(),
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
            rows.widths_m.resize(rows.goes_on.len(), 0.0);
            rows.ends.resize(rows.goes_on.len(), [(f64::MAX, [usize::MAX; 2]), (f64::MIN, [usize::MAX; 2])]);
            for t in &garment.triangles[piece.triangles.clone()] {
                let corners = t.map(|v| garment.rest[v] - V2::new(0.0, low));
                rows.add_cuts(first, t, &corners);
            }
        }
        rows.find_rings(garment);
        rows
    }

    /// Adds a triangle to the rows whose middle lines cut it; `first` is the row at height 0.
    fn add_cuts(&mut self, first: usize, t: &[usize; 3], corners: &[V2; 3]) {
        let heights = corners.map(|p| p.y / HEIGHT_M - 0.5);
        let [low, high] =
            [heights.iter().copied().fold(f64::MAX, f64::min), heights.iter().copied().fold(0.0, f64::max)];
        for row in low.max(0.0).ceil() as usize..=high as usize {
            let cuts = (0..3).filter_map(|k| {
                let next = (k + 1) % 3;
                let (below, above) = (heights[k] - row as f64, heights[next] - row as f64);
                let u = corners[k].x + (corners[next].x - corners[k].x) * below / (below - above);
                ((below < 0.0) != (above < 0.0)).then_some((u, [t[k], t[next]]))
            });
            if let ([a, b], true) = (cuts.collect::<Vec<_>>().as_slice(), first + row < self.widths_m.len()) {
                self.widths_m[first + row] += (b.0 - a.0).abs();
                let [left, right] = &mut self.ends[first + row];
                for cut in [a, b] {
                    *left = if cut.0 < left.0 { *cut } else { *left };
                    *right = if cut.0 > right.0 { *cut } else { *right };
                }
            }
        }
    }

    /// Joins each row with those it goes on in, over two seams at most: from a half of the front over the other to the back.
    fn find_rings(&mut self, garment: &Garment) {
        let piece_of = |v: usize| garment.pieces.iter().position(|p| p.vertices.contains(&v)).unwrap_or(usize::MAX);
        // Seam vertices that a row shares with each row of other pieces of its limb.
        let mut joined: BTreeSet<usize> = BTreeSet::new();
        let mut shared: BTreeMap<(usize, usize), BTreeMap<usize, usize>> = BTreeMap::new();
        for (pair, is_upright) in garment.seams.iter().flat_map(|s| upright(garment, s)) {
            let pieces = pair.map(piece_of);
            let limbs = pieces.map(|p| limb(garment.pieces[p].role));
            if limbs[0] != limbs[1] {
                continue;
            }
            if is_upright {
                joined.extend(pair);
            }
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
        self.close_rings(&joined);
    }

    /// Finds the rows that close: cloth of the same limb goes on at both their ends, in vertices that are `joined`.
    fn close_rings(&mut self, joined: &BTreeSet<usize>) {
        let closes = |row: &usize| self.ends[*row].iter().all(|(_, edge)| edge.iter().all(|v| joined.contains(v)));
        self.closed = (0..self.len()).map(|row| closes(&row)).collect();
    }

    /// Whether two rows are of one piece.
    #[must_use]
    pub fn are_of_one_piece(&self, a: usize, b: usize) -> bool {
        self.goes_on[a.min(b)..a.max(b)].iter().all(|goes_on| *goes_on)
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.goes_on.len()
    }

    /// Whether the ring of a row closes.
    #[must_use]
    pub fn is_closed(&self, row: usize) -> bool {
        self.closed[row]
    }

    /// Row and sewn vertex of each garment vertex.
    #[must_use]
    pub fn of_vertex(&self) -> &[(usize, usize)] {
        &self.of_vertex
    }

    /// Rows that go on in each other round the body, with the one asked for.
    #[must_use]
    pub fn ring(&self, row: usize) -> &[usize] {
        &self.rings[row]
    }

    /// The rows next to one on its piece: above and below.
    #[must_use]
    pub fn beside(&self, row: usize) -> [Option<usize>; 2] {
        [self.goes_on[row].then_some(row + 1), row.checked_sub(1).filter(|&below| self.goes_on[below])]
    }

    /// Length of the cloth of the ring of a row, m.
    #[must_use]
    pub fn girth_m(&self, row: usize) -> f64 {
        self.rings[row].iter().map(|&r| self.widths_m[r]).sum()
    }

    /// Mean stretch of each ring along its rows beyond 1: rows with their neighbours, as single ones are few triangles high.
    #[must_use]
    pub fn stretches(&self, elastic: &Elastic, x: &[V3]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.len()];
        for (&row, (stretch, area)) in self.of_triangle.iter().zip(elastic.stretches(x)) {
            sums[row].0 += (stretch[(0, 0)] - 1.0) * area;
            sums[row].1 += area;
        }
        let mean = |row: usize| {
            let rows = self.rings[row].iter().flat_map(|&r| self.beside(r).into_iter().flatten().chain([r]));
            let (stretch, area) = rows.fold((0.0, 0.0), |sum, row| (sum.0 + sums[row].0, sum.1 + sums[row].1));
            stretch / area.max(f64::MIN_POSITIVE)
        };
        (0..self.len()).map(mean).collect()
    }
}
