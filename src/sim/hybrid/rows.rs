//! Where the cloth is too small to go round the body, over whole rings of rows.
//!
//! A piece is drawn upright, so that its rows (the `u` direction) go round trunk or limb, and on in the piece beside it: front
//! and back make a ring. A bust stretches the front and leaves the back slack; only where the body inside a ring is
//! wider than its cloth is the pattern too small.

use std::collections::{BTreeMap, BTreeSet};

use super::elastic::Elastic;
use super::sewn::Sewn;
use crate::geom::hull::tape_girth;
use crate::geom::section::{Plane, section};
use crate::geom::{TriMesh, V2, V3};
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

/// Share of what the stretch of a ring says that its inset is corrected by at once.
const GAIN: f64 = 0.3;
/// Inset by which a judgement may be wrong besides half of it, m: rings are not quite level.
const DOUBT_M: f64 = 3e-3;
/// Inset that a ring keeps that was too small once, m: it may become so again.
const LEAST_INSET_M: f64 = 1e-6;

/// Distance from the nearest ring over which cloth that goes round nothing by itself is set in less and less, m.
const FADE_M: f64 = 0.15;

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
    /// The row itself where its ring closes, else the nearest of its piece that does.
    closed: Vec<Option<usize>>,
    /// Width of each row in the piece's plane, m.
    widths_m: Vec<f64>,
    /// By how much the body must be smaller all round for the ring of each row to close on it, m; 0 where it does.
    insets_m: Vec<f64>,
    /// The same as it was judged last, before corrections.
    judged_m: Vec<f64>,
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
            insets_m: Vec::new(),
            judged_m: Vec::new(),
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
            for t in &garment.triangles[piece.triangles.clone()] {
                let corners = t.map(|v| garment.rest[v] - V2::new(0.0, low));
                rows.add_widths(first, &corners);
            }
        }
        rows.find_rings(garment);
        rows.insets_m = vec![0.0; rows.goes_on.len()];
        rows.judged_m.clone_from(&rows.insets_m);
        rows
    }

    /// Adds a triangle to the widths of the rows whose middle lines cut it; `first` is the row at height 0.
    fn add_widths(&mut self, first: usize, corners: &[V2; 3]) {
        let heights = corners.map(|p| p.y / HEIGHT_M - 0.5);
        let [low, high] =
            [heights.iter().copied().fold(f64::MAX, f64::min), heights.iter().copied().fold(0.0, f64::max)];
        for row in low.max(0.0).ceil() as usize..=high as usize {
            let cuts = (0..3).filter_map(|k| {
                let (below, above) = (heights[k] - row as f64, heights[(k + 1) % 3] - row as f64);
                let along = below / (below - above);
                ((below < 0.0) != (above < 0.0)).then(|| corners[k].x + (corners[(k + 1) % 3].x - corners[k].x) * along)
            });
            if let ([a, b], Some(width)) = (cuts.collect::<Vec<_>>().as_slice(), self.widths_m.get_mut(first + row)) {
                *width += (b - a).abs();
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
        self.close_rings(garment, &joined);
    }

    /// Finds the rows that close: cloth of the same limb goes on at both their ends, in vertices that are `joined`. Beside an
    /// armhole a front is as tight as in the nearest ring below it.
    fn close_rings(&mut self, garment: &Garment, joined: &BTreeSet<usize>) {
        self.closed = vec![None; self.goes_on.len()];
        for piece in &garment.pieces {
            let mut ends: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
            for v in piece.vertices.clone() {
                let u = |w: usize| garment.rest[w].x;
                let [left, right] = ends.entry(self.of_vertex[v].0).or_insert([v, v]);
                *left = if u(v) < u(*left) { v } else { *left };
                *right = if u(v) > u(*right) { v } else { *right };
            }
            let closes = |ends: &[usize; 2]| ends.iter().all(|v| joined.contains(v));
            let whole: Vec<usize> = ends.iter().filter(|(_, ends)| closes(ends)).map(|(row, _)| *row).collect();
            for row in ends.into_keys() {
                self.closed[row] = whole.iter().copied().min_by_key(|other| other.abs_diff(row));
            }
        }
    }

    /// Judges by how much rings are too small, where the cloth is now: a tape round the body inside them, `offset_m` off the
    /// skin, is longer than their cloth stretched by a share. Positions `x` in m.
    pub fn judge(&mut self, body: &TriMesh, x: &[V3], offset_m: f64, share: f64) {
        let mut members = vec![Vec::new(); self.goes_on.len()];
        for &(row, v) in &self.of_vertex {
            members[row].push(v);
        }
        let middle = |rows: &mut dyn Iterator<Item = usize>| {
            let (sum, n) =
                rows.flat_map(|r| &members[r]).fold((V3::zeros(), 0.0), |(sum, n), &v| (sum + x[v], n + 1.0));
            (n > 0.0).then(|| sum / n)
        };
        let lack = |row: usize| {
            let ring = &self.rings[row];
            let centre = middle(&mut ring.iter().copied())?;
            let above = middle(&mut ring.iter().map(|&r| if self.goes_on[r] { r + 1 } else { r }))?;
            let below = middle(&mut ring.iter().map(|&r| r.checked_sub(1).filter(|&b| self.goes_on[b]).unwrap_or(r)))?;
            let plane = Plane::normal_to(centre, (above - below).try_normalize(1e-6)?);
            let outlines = section(body, &plane);
            let inside = outlines.iter().find(|o| o.closed && o.contains(plane.project(centre)))?;
            let body_m = tape_girth(&inside.points) + std::f64::consts::TAU * offset_m;
            Some(body_m - (1.0 + share) * self.girth_m(row))
        };
        let is_closed = |row: usize| self.closed[row] == Some(row);
        let inset = |row: usize| lack(row).map_or(0.0, |lack| lack.max(0.0) / std::f64::consts::TAU);
        let own: Vec<f64> = (0..members.len()).map(|row| if is_closed(row) { inset(row) } else { 0.0 }).collect();
        self.judged_m.clone_from(&own);
        self.spread(&own);
    }

    /// Gives every row the inset of its ring, and those that do not close that of the nearest that does, less with the distance.
    fn spread(&mut self, own: &[f64]) {
        let inset = |(row, closed): (usize, &Option<usize>)| {
            let fade = |closed: usize| 1.0 - HEIGHT_M * row.abs_diff(closed) as f64 / FADE_M;
            closed.map_or(0.0, |closed| own[closed] * fade(closed).max(0.0))
        };
        self.insets_m = self.closed.iter().enumerate().map(inset).collect();
    }

    /// Length of the cloth of the ring of a row, m.
    fn girth_m(&self, row: usize) -> f64 {
        self.rings[row].iter().map(|&r| self.widths_m[r]).sum()
    }

    /// Corrects the insets of rings that were judged too small: until their cloth is stretched by a share, no more and no less.
    pub fn correct(&mut self, elastic: &Elastic, x: &[V3], share: f64) {
        let means = self.means(elastic, x);
        let corrected = |row: usize| {
            let lack = (means[row] - share) * self.girth_m(row);
            let most = 1.5 * self.judged_m[row] + DOUBT_M;
            (self.insets_m[row] + GAIN * lack / std::f64::consts::TAU).clamp(LEAST_INSET_M, most)
        };
        let is_tight = |row: usize| self.closed[row] == Some(row) && self.insets_m[row] > 0.0;
        let own: Vec<f64> = (0..means.len()).map(|row| if is_tight(row) { corrected(row) } else { 0.0 }).collect();
        self.spread(&own);
    }

    /// Inset of the body for each of `count` sewn vertices, m: the greatest where pieces meet.
    #[must_use]
    pub fn insets_m(&self, count: usize) -> Vec<f64> {
        let mut insets = vec![0.0_f64; count];
        for &(row, v) in &self.of_vertex {
            insets[v] = insets[v].max(self.insets_m[row]);
        }
        insets
    }

    /// Mean stretch beyond 1 of each ring: rows with their neighbours, as single ones are few triangles high.
    fn means(&self, elastic: &Elastic, x: &[V3]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.goes_on.len()];
        for (&row, (stretch, area)) in self.of_triangle.iter().zip(elastic.stretches(x)) {
            sums[row].0 += (stretch[(0, 0)] - 1.0) * area;
            sums[row].1 += area;
        }
        let wide = |row: usize| {
            let above = self.goes_on[row].then_some(row + 1);
            let below = row.checked_sub(1).filter(|&below| self.goes_on[below]);
            [Some(row), above, below].into_iter().flatten()
        };
        let mean = |row: usize| {
            let rows = self.rings[row].iter().flat_map(|&r| wide(r));
            let (stretch, area) = rows.fold((0.0, 0.0), |sum, row| (sum.0 + sums[row].0, sum.1 + sums[row].1));
            stretch / area.max(f64::MIN_POSITIVE)
        };
        (0..sums.len()).map(mean).collect()
    }
}
