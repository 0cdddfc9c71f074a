//! Pop-up by pyramid coordinates: the free edges first, by silhouette and length (5.4, 5.5), then the cloth between
//! them.

use super::pyramid::Pyramids;
use super::welded_mesh::Sewn;
use geom::{V2, V3};
use pattern::Garment;

geom::constants! {
    "hybrid.silhouette",
    const ROUNDS: u32 = 10;
}

/// Sewn garment that grows to its pattern's size from its free edges inwards.
pub struct Silhouette {
    pyramids: Pyramids,
    loops: Vec<Loop>,
}

/// Free edge: hem, neck, sleeve opening.
struct Loop {
    vertices: Vec<usize>,
    /// Length in the pattern.
    length_m: f64,
    /// Edges into the cloth, with their lengths in the pattern, m.
    inwards: Vec<([usize; 2], f64)>,
}

impl Silhouette {
    pub fn new(garment: &Garment, sewn: &Sewn) -> Self {
        let rest: Vec<[V2; 3]> = garment.triangles.iter().map(|t| t.map(|v| garment.rest[v])).collect();
        let sides = || {
            let edges_of = |&[a, b, c]: &[usize; 3]| [[a, b], [b, c], [c, a]];
            let side = |[a, b]: [usize; 2]| {
                ([sewn.vertex_of[a], sewn.vertex_of[b]], (garment.rest[a] - garment.rest[b]).norm())
            };
            garment.triangles.iter().flat_map(edges_of).map(side)
        };
        let edge = |vertices: &Vec<usize>| {
            let n = vertices.len();
            let is_along =
                |&([a, b], _): &([usize; 2], f64)| (0..n).any(|i| vertices[i] == a && vertices[(i + 1) % n] == b);
            let is_on = |v: &usize| vertices.contains(v);
            let inwards = sides().filter(|([a, b], _)| is_on(a) && !is_on(b));
            Loop {
                vertices: vertices.clone(),
                length_m: sides().filter(is_along).map(|(_, length_m)| length_m).sum(),
                inwards: inwards.collect(),
            }
        };
        Self {
            pyramids: Pyramids::of_pattern(&sewn.triangles, &rest, sewn.x.len()),
            loops: sewn.loops.iter().map(edge).collect(),
        }
    }

    /// Edges and lengths change by `share` of their difference from those of the pattern.
    pub fn step(&self, x: &[V3], share: f64) -> Vec<V3> {
        let mut now = x.to_vec();
        for edge in &self.loops {
            edge.grow(&mut now, share);
        }
        for _ in 0..ROUNDS {
            now = self.pyramids.rebuild(&now, share);
        }
        now
    }
}

impl Loop {
    fn grow(&self, x: &mut [V3], share: f64) {
        let n = self.vertices.len();
        let centre = self.vertices.iter().map(|&v| x[v]).sum::<V3>() / n as f64;
        let arm = |i: usize| x[self.vertices[i % n]] - centre;
        let length_m: f64 = (0..n).map(|i| (arm(i + 1) - arm(i)).norm()).sum();
        let area: V3 = (0..n).map(|i| arm(i).cross(&arm(i + 1))).sum();
        let Some(normal) = area.try_normalize(1e-18) else { return };
        // (5.4): every vertex moves away from the middle by the same distance.
        let wider = share * (self.length_m - length_m) / std::f64::consts::TAU;
        // (5.5): along the normal by the mean lack of the edges that end there.
        let lacks = self.inwards.iter().map(|&([v, w], pattern_m)| {
            let way = x[v] - x[w];
            (way * (pattern_m / way.norm().max(1e-9) - 1.0)).dot(&normal)
        });
        let longer = share * lacks.sum::<f64>() / self.inwards.len().max(1) as f64;
        for &v in &self.vertices {
            let out = (x[v] - centre) - normal * (x[v] - centre).dot(&normal);
            // Never past the middle: beyond it the edge would grow instead of shrinking.
            let by = wider.max(-0.5 * out.norm());
            x[v] += out.try_normalize(1e-9).unwrap_or_else(V3::zeros) * by + normal * longer;
        }
    }
}
