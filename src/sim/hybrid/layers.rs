//! Separation of layers of cloth that intersect: a sleeve and the side below it, a fold.

use std::collections::BTreeMap;

use crate::contact::intersections::{Release, Wings};
use crate::contact::{Intersection, intersections};
use geom::V3;
use linalg::PairList;

geom::constants! {
    "hybrid.layers",
    /// Distance of the layers afterwards.
    const APART_M: f64 = 5e-4;
    /// Greatest displacement of a vertex in a round.
    const STRIDE_M: f64 = 3e-3;
    const PATIENCE: u32 = 24;
    /// Distance from a crossing within which cloth is tested again.
    const NEAR_M: f64 = 0.05;
}

/// Cloth as a mesh that may intersect itself.
pub struct Layers {
    edges: PairList,
    triangles: Vec<[usize; 3]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parted {
    pub found: usize,
    pub left: usize,
}

impl Layers {
    pub fn new(triangles: &[[usize; 3]]) -> Self {
        let edges = PairList::new(triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]));
        Self { edges, triangles: triangles.to_vec() }
    }

    /// Moves vertices until no edge pierces a triangle, in at most `rounds`; ends with the fewest crossings that it
    /// found.
    ///
    /// The end of an edge that has passed through less far goes back, and the triangle moves half of the way towards
    /// it. As cloth moves little between two separations, that is the end on the wrong side.
    pub fn part(&self, x: &mut [V3], rounds: u32) -> Parted {
        let mut pierced = intersections(x, self.edges.pairs(), &self.triangles);
        if pierced.is_empty() {
            return Parted { found: 0, left: 0 };
        }
        let found = pierced.len();
        let near = self.near(&pierced, x);
        let (mut best, mut least, mut waited) = (x.to_vec(), pierced.len(), 0);
        let wings = Wings::new(&near.triangles);
        for round in 0..rounds {
            // The two methods get stuck in different places.
            if round % 2 == 0 {
                apart(&pierced, x);
            } else {
                release(&pierced, &wings, x);
            }
            pierced = intersections(x, near.edges.pairs(), &near.triangles);
            waited += 1;
            if pierced.len() < least {
                (least, waited) = (pierced.len(), 0);
                best.copy_from_slice(x);
            }
            if least == 0 || waited > PATIENCE {
                break;
            }
        }
        x.copy_from_slice(&best);
        Parted { found, left: least }
    }

    fn near(&self, pierced: &[Intersection], x: &[V3]) -> Self {
        let places: Vec<V3> = pierced.iter().map(|Intersection { edge, .. }| (x[edge[0]] + x[edge[1]]) / 2.0).collect();
        let is_near = |v: usize| places.iter().any(|p| (x[v] - p).norm_squared() < NEAR_M * NEAR_M);
        let near: Vec<bool> = (0..x.len()).map(is_near).collect();
        let triangles: Vec<[usize; 3]> =
            self.triangles.iter().filter(|t| t.iter().any(|&v| near[v])).copied().collect();
        Self::new(&triangles)
    }
}

/// One round: every crossing asks for a displacement of its vertices, every vertex takes the mean of those asked for.
fn apart(pierced: &[Intersection], x: &mut [V3]) {
    let mut moves: BTreeMap<usize, (V3, f64)> = BTreeMap::new();
    for Intersection { edge, triangle } in pierced {
        let [a, b, c] = triangle.map(|v| x[v]);
        let Some(normal) = (b - a).cross(&(c - a)).try_normalize(0.0) else { continue };
        let heights = edge.map(|v| (x[v] - a).dot(&normal));
        let through = usize::from(heights[1].abs() < heights[0].abs());
        let by = -heights[through] - APART_M * heights[through].signum();
        let half = normal * (0.5 * by.clamp(-STRIDE_M, STRIDE_M));
        for (v, way) in std::iter::once((edge[through], half)).chain(triangle.iter().map(|&v| (v, -half))) {
            let (sum, n) = moves.entry(v).or_insert((V3::zeros(), 0.0));
            *sum += way;
            *n += 1.0;
        }
    }
    moves.into_iter().for_each(|(v, (sum, n))| x[v] += sum / n);
}

/// One round along the direction in which the intersection contours grow shorter.
fn release(pierced: &[Intersection], wings: &Wings, x: &mut [V3]) {
    let mut moves: BTreeMap<usize, (V3, f64)> = BTreeMap::new();
    for release in pierced.iter().filter_map(|crossing| Release::of(x, wings, crossing)) {
        for (v, weight) in release.vertices.into_iter().zip(release.weights) {
            let (sum, n) = moves.entry(v).or_insert((V3::zeros(), 0.0));
            *sum += release.fall * (weight * STRIDE_M);
            *n += 1.0;
        }
    }
    moves.into_iter().for_each(|(v, (sum, n))| x[v] += sum / n);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::sheets::sheet;

    #[test]
    fn two_sheets_that_dip_into_each_other_are_parted() {
        let (rest, below) = sheet(8, 8, 0.01);
        let count = rest.len();
        let triangles: Vec<[usize; 3]> =
            below.iter().copied().chain(below.iter().map(|t| t.map(|v| v + count))).collect();
        // The upper sheet sags through the lower in its middle.
        let sag = |x: f64, y: f64| 2.5e-3 - 4.5e-3 * (-((x - 0.043).powi(2) + (y - 0.037).powi(2)) / 2e-4).exp();
        let upper = rest.iter().map(|p| V3::new(p.x + 2e-3, p.y + 1e-3, sag(p.x, p.y)));
        let mut x: Vec<V3> = rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).chain(upper).collect();
        let layers = Layers::new(&triangles);
        assert!(layers.part(&mut x.clone(), 0).found > 0);
        assert_eq!(layers.part(&mut x, 30).left, 0);
        assert!(x[count..].iter().zip(&x[..count]).all(|(above, below)| above.z > below.z - 1e-3));
    }
}
