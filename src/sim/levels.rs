//! Prolongation between mesh levels: the drape of a coarse mesh becomes the start on a finer mesh of the same pieces.

use nalgebra::Matrix3;

use super::Fabric;
use super::cloth::Cloth;
use super::contact::intersections::held_apart;
use geom::triangle::sorted;
use geom::{V2, V3};
use linalg::pcg::PcgParams;
use linalg::{Operator, PairList, linear};
use pattern::Garment;

geom::constants! {
    "levels",
    /// Wavelength whose amplitude smoothing halves, in edges of the coarser mesh.
    const ROUNDED_EDGES: f64 = 3.0;
}

/// Drape of `coarse`, interpolated at the vertices of `cloth`, the sewn mesh of `fine`. Facets of the coarse mesh are
/// smoothed, except where that would make the cloth intersect itself.
///
/// Facets that are left in do not vanish later. A dimple is nearly isometric to the smooth surface, but it would have
/// to stretch the cloth to pop out.
pub fn prolong(coarse: &Garment, coarse_positions: &[V3], fine: &Garment, cloth: &Cloth, fabric: &Fabric) -> Vec<V3> {
    let x = cloth.weld(&evaluate(coarse, coarse_positions, fine));
    let mut rounded = x.clone();
    round_off(cloth, fabric, ROUNDED_EDGES * coarse.edge_length_m, &mut rounded);
    held_apart(&x, &rounded, &cloth.triangles)
}

/// Smooths by the bending stiffness `Q` alone: one implicit step `(Q + k A) d = -Q x`. `k = B (2 pi / wave_m)^4` halves
/// the amplitude of waves of length `wave_m`.
fn round_off(cloth: &Cloth, fabric: &Fabric, wave_m: f64, x: &mut [V3]) {
    let rigidity_nm = (fabric.bending_warp_nm * fabric.bending_weft_nm).sqrt();
    let stiffness_n_m3 = rigidity_nm * (std::f64::consts::TAU / wave_m).powi(4);
    let operator = Operator {
        diagonal: cloth.areas.iter().map(|area| Matrix3::identity() * (area * stiffness_n_m3)).collect(),
        membrane_pairs: PairList::EMPTY,
        membrane: Vec::new(),
        bending_pairs: &cloth.bending.pairs,
        bending: &cloth.bending.entries,
        springs: Vec::new(),
        contacts: Vec::new(),
        arcs: None,
    };
    let mut forces = vec![V3::zeros(); x.len()];
    cloth.bending.add_forces(x, &mut forces);
    let mut moved = vec![V3::zeros(); x.len()];
    linear::jacobi(&operator, &forces, &mut moved, &PcgParams { tolerance: 1e-3, max_iterations: 500 });
    x.iter_mut().zip(moved).for_each(|(p, d)| *p += d);
}

/// Interpolates the drape of `coarse` in the planes of the pieces. Vertices outside the coarse outline, where a chord
/// cuts a curve, are extrapolated from the nearest triangle. The two sides of a seam then differ by a little; welding
/// takes their mean.
fn evaluate(coarse: &Garment, coarse_positions: &[V3], fine: &Garment) -> Vec<V3> {
    let mut positions = vec![V3::zeros(); fine.rest.len()];
    for (piece, source) in fine.pieces.iter().zip(&coarse.pieces) {
        let locator = Locator::new(coarse, source.triangles.clone());
        for v in piece.vertices.clone() {
            let Located { triangle, weights, .. } = locator.locate(fine.rest[v]);
            let corners = sorted(coarse.triangles[triangle]);
            positions[v] = (0..3).map(|k| coarse_positions[corners[k]] * weights[k]).sum();
        }
    }
    positions
}

struct Located {
    triangle: usize,
    /// Barycentric weights of the sorted corners.
    weights: [f64; 3],
    is_inside: bool,
}

/// Triangles of one piece in a uniform grid of buckets.
struct Locator<'a> {
    garment: &'a Garment,
    low: V2,
    cell: f64,
    columns: usize,
    rows: usize,
    buckets: Vec<Vec<usize>>,
}

impl<'a> Locator<'a> {
    fn new(garment: &'a Garment, triangles: std::ops::Range<usize>) -> Self {
        let corners = || triangles.clone().flat_map(|t| garment.triangles[t]).map(|v| garment.rest[v]);
        let low = corners().fold(V2::repeat(f64::MAX), |a, b| a.inf(&b));
        let high = corners().fold(V2::repeat(f64::MIN), |a, b| a.sup(&b));
        let cell = garment.edge_length_m;
        let count = |extent: f64| (extent / cell) as usize + 1;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        // The spare width of the grid is shared by both sides, so that a mirrored piece has mirrored buckets.
        let spare = V2::new(columns as f64 * cell, rows as f64 * cell) - (high - low);
        let low = low - spare * 0.5;
        let mut locator = Self { garment, low, cell, columns, rows, buckets: vec![Vec::new(); columns * rows] };
        for t in triangles {
            let points = garment.triangles[t].map(|v| garment.rest[v]);
            let (from, to) = (
                locator.bucket(points[0].inf(&points[1]).inf(&points[2])),
                locator.bucket(points[0].sup(&points[1]).sup(&points[2])),
            );
            for row in from[1]..=to[1] {
                for column in from[0]..=to[0] {
                    locator.buckets[row * columns + column].push(t);
                }
            }
        }
        locator
    }

    fn bucket(&self, p: V2) -> [usize; 2] {
        let cell = |x: f64, n: usize| ((x / self.cell).max(0.0) as usize).min(n - 1);
        [cell(p.x - self.low.x, self.columns), cell(p.y - self.low.y, self.rows)]
    }

    /// Triangle that contains a point, or else the one with the least negative barycentric weight.
    fn locate(&self, p: V2) -> Located {
        let [column, row] = self.bucket(p);
        for ring in 0.. {
            let found = self.best_within(p, column, row, ring);
            if let Some(located) = found {
                // A point outside the mesh may be nearer to a triangle of the next bucket. So the search goes one ring
                // further.
                if located.is_inside || ring > 0 {
                    return located;
                }
            }
        }
        unreachable!("the buckets hold at least one triangle")
    }

    /// Best triangle of the buckets at most `ring` away from one.
    fn best_within(&self, p: V2, column: usize, row: usize, ring: usize) -> Option<Located> {
        let mut best: Option<(f64, usize, [f64; 3])> = None;
        for r in row.saturating_sub(ring)..=(row + ring).min(self.rows - 1) {
            for c in column.saturating_sub(ring)..=(column + ring).min(self.columns - 1) {
                for &t in &self.buckets[r * self.columns + c] {
                    let weights = self.barycentric(t, p);
                    let outside = -weights.iter().copied().fold(f64::MAX, f64::min);
                    if best.is_none_or(|(least, ..)| outside < least) {
                        best = Some((outside, t, weights));
                    }
                }
            }
        }
        best.map(|(outside, triangle, weights)| Located { triangle, weights, is_inside: outside <= 1e-9 })
    }

    fn barycentric(&self, triangle: usize, p: V2) -> [f64; 3] {
        let [a, b, c] = sorted(self.garment.triangles[triangle]).map(|v| self.garment.rest[v]);
        let area = (b - a).perp(&(c - a));
        let wb = (p - a).perp(&(c - a)) / area;
        let wc = (b - a).perp(&(p - a)) / area;
        [1.0 - wb - wc, wb, wc]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::{self, Specimen, sheets::sheet};

    #[test]
    fn short_waves_are_rounded_off_and_long_ones_stay() {
        let fabric = laboratory::isotropic(0.1, 500.0, 1e-5);
        let rounded = 0.08;
        let check = |wave: f64, expect: f64| {
            let height = |p: &V2| 1e-3 * (std::f64::consts::TAU * p.y / wave).cos();
            // A whole number of waves between free edges, where a cosine has its crests.
            let rows = (4.0 * wave / 0.005).round() as usize;
            let specimen = Specimen::new(sheet(6, rows, 0.005), &fabric, |p| V3::new(p.x, p.y, height(p)));
            let Specimen { garment, cloth, mut positions, .. } = specimen.expect("a sound mesh");
            round_off(&cloth, &fabric, rounded, &mut positions);
            let within = |p: &V2| (p.y / wave - 2.0).abs() < 0.5;
            let kept = |v: usize| positions[v].z * height(&garment.rest[v]);
            let norm = |v: usize| height(&garment.rest[v]).powi(2);
            let inner: Vec<usize> = (0..positions.len()).filter(|v| within(&garment.rest[*v])).collect();
            let share = inner.iter().map(|v| kept(*v)).sum::<f64>() / inner.iter().map(|v| norm(*v)).sum::<f64>();
            assert!((share - expect).abs() < 0.04, "waves of {wave} m keep {share}, expected {expect}");
        };
        check(rounded, 0.5);
        check(2.0 * rounded, 1.0 / (1.0 + 0.5_f64.powi(4)));
        check(0.5 * rounded, 1.0 / (1.0 + 2.0_f64.powi(4)));
    }
}
