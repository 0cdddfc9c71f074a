//! Checks on a finished drape, made on the meshes themselves and not on what the solver believed.

use crate::body::Body;
use crate::geom::{Surface, V3};
use crate::pattern::Garment;
use crate::sim::contact::grid::BoxGrid;
use crate::sim::solver::PairList;

/// Deepest point of the cloth inside the body, m: vertices, edge middles and triangle centres against the exact surface;
/// 0 when none is inside.
#[must_use]
pub fn penetration_m(body: &Body, garment: &Garment, positions: &[V3]) -> f64 {
    let Ok(surface) = Surface::new(&body.mesh) else { return f64::NAN };
    let samples = garment.triangles.iter().flat_map(|t| {
        let [a, b, c] = t.map(|v| positions[v]);
        [a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0]
    });
    samples.map(|p| -surface.signed_distance(&p)).fold(0.0, f64::max)
}

/// Greatest distance between the two vertices of a seam pair, m.
#[must_use]
pub fn seam_gap_m(garment: &Garment, positions: &[V3]) -> f64 {
    let pairs = garment.seams.iter().flat_map(|s| &s.pairs);
    pairs.map(|&[a, b]| (positions[a] - positions[b]).norm()).fold(0.0, f64::max)
}

/// Number of edges that pierce a triangle of the same cloth with which they share no vertex. `triangles` index sewn
/// vertices at `x`.
#[must_use]
pub fn self_crossings(x: &[V3], triangles: &[[usize; 3]]) -> usize {
    let edges = PairList::new(triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]));
    let length = edges.pairs().iter().map(|&[a, b]| (x[a] - x[b]).norm()).fold(0.0, f64::max);
    // Every point of an edge is within half the greatest length of the edge's middle.
    let grid = BoxGrid::new(x, triangles, 0.5 * length, length.max(1e-6));
    let pierces = |&[a, b]: &[usize; 2]| {
        let near = grid.near(&((x[a] + x[b]) / 2.0));
        near.filter(|&t| !triangles[t].contains(&a) && !triangles[t].contains(&b))
            .filter(|&t| segment_hits(x[a], x[b], triangles[t].map(|v| x[v])))
            .count()
    };
    edges.pairs().iter().map(pierces).sum()
}

fn segment_hits(p: V3, q: V3, [a, b, c]: [V3; 3]) -> bool {
    let volume = |u: V3, v: V3, w: V3, z: V3| (v - u).cross(&(w - u)).dot(&(z - u));
    let (above, below) = (volume(a, b, c, p), volume(a, b, c, q));
    if above * below >= 0.0 {
        return false;
    }
    let sides = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
}
