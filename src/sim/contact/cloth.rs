//! Contact of the cloth with itself: vertices are kept a thickness away from the triangles they face.
//!
//! A pair is found while its vertex is still clear of the triangle; the side it then lies on is remembered for as long as
//! the two stay near, so a vertex that slips through is pushed back to where it came from.

use std::collections::BTreeMap;

use super::grid::TriangleGrid;
use crate::geom::V3;
use crate::sim::solver::Contact4;

/// Parameters of self-contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClothContactParams {
    /// Distance at which layers begin to push each other apart, m.
    pub thickness_m: f64,
    /// Penalty, N/m3.
    pub stiffness_n_m3: f64,
    /// Pairs are sought up to this distance, m; it bounds how far cloth may move before they are sought anew.
    pub reach_m: f64,
}

impl Default for ClothContactParams {
    fn default() -> Self {
        Self { thickness_m: 2e-3, stiffness_n_m3: 1e6, reach_m: 0.012 }
    }
}

/// Self-contact of one cloth.
pub struct ClothContact<'a> {
    params: ClothContactParams,
    triangles: &'a [[usize; 3]],
    areas: &'a [f64],
    /// Vertices that share a triangle with a vertex, itself included.
    ring: Vec<Vec<usize>>,
    /// Remembered side (+1 along the triangle's normal) of each near pair (vertex, triangle).
    sides: BTreeMap<(usize, usize), f64>,
    found_at: Vec<V3>,
}

impl<'a> ClothContact<'a> {
    /// Self-contact over the triangles of a cloth; `areas` are the vertices' rest areas, m2.
    #[must_use]
    pub fn new(params: ClothContactParams, triangles: &'a [[usize; 3]], areas: &'a [f64]) -> Self {
        let mut ring = vec![Vec::new(); areas.len()];
        for t in triangles {
            for &v in t {
                ring[v].extend_from_slice(t);
            }
        }
        for r in &mut ring {
            r.sort_unstable();
            r.dedup();
        }
        Self { params, triangles, areas, ring, sides: BTreeMap::new(), found_at: Vec::new() }
    }

    /// Seeks near pairs anew where cloth has moved so far that one could have been missed.
    pub fn update(&mut self, x: &[V3]) {
        let slack = 0.5 * (self.params.reach_m - self.params.thickness_m);
        let moved = |(p, q): (&V3, &V3)| (p - q).norm_squared() > slack * slack;
        if self.found_at.len() == x.len() && !x.iter().zip(&self.found_at).any(moved) {
            return;
        }
        let grid = TriangleGrid::new(x, self.triangles, self.params.reach_m, 2.0 * self.params.reach_m);
        let mut sides = BTreeMap::new();
        for v in 0..x.len() {
            for t in grid.near(&x[v]) {
                if self.triangles[t].iter().any(|c| self.ring[v].binary_search(c).is_ok()) {
                    continue;
                }
                if let Some(facing) = Facing::of(x, v, self.triangles[t])
                    && facing.height.abs() < self.params.reach_m
                {
                    let side = self.sides.get(&(v, t)).copied().unwrap_or_else(|| facing.height.signum());
                    sides.insert((v, t), side);
                }
            }
        }
        self.sides = sides;
        self.found_at = x.to_vec();
    }

    fn active<'s>(&'s self, x: &'s [V3]) -> impl Iterator<Item = (usize, usize, f64, f64, Facing)> + 's {
        self.sides.iter().filter_map(|(&(v, t), &side)| {
            let facing = Facing::of(x, v, self.triangles[t])?;
            let depth = self.params.thickness_m - side * facing.height;
            (depth > 0.0).then_some((v, t, side, depth, facing))
        })
    }

    fn stiffness(&self, vertex: usize) -> f64 {
        self.params.stiffness_n_m3 * self.areas[vertex]
    }

    /// Contact energy, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        self.active(x).map(|(v, _, _, depth, _)| 0.5 * self.stiffness(v) * depth * depth).sum()
    }

    /// Adds the contact forces and returns the stiffness.
    pub fn assemble(&self, x: &[V3], forces: &mut [V3]) -> Vec<Contact4> {
        let mut contacts = Vec::new();
        for (v, t, side, depth, facing) in self.active(x) {
            let [a, b, c] = self.triangles[t];
            let [wa, wb, wc] = facing.weights;
            let stiffness = self.stiffness(v);
            let contact =
                Contact4 { vertices: [v, a, b, c], weights: [1.0, -wa, -wb, -wc], normal: facing.normal, stiffness };
            for k in 0..4 {
                forces[contact.vertices[k]] += facing.normal * (side * stiffness * depth * contact.weights[k]);
            }
            contacts.push(contact);
        }
        contacts
    }
}

/// A vertex above or below a triangle.
struct Facing {
    /// Signed height over the triangle's plane, m.
    height: f64,
    /// Unit normal of the triangle.
    normal: V3,
    /// Barycentric coordinates of the foot point, none negative.
    weights: [f64; 3],
}

impl Facing {
    /// `None` when the foot point lies outside the triangle.
    fn of(x: &[V3], vertex: usize, triangle: [usize; 3]) -> Option<Self> {
        let [a, b, c] = triangle.map(|v| x[v]);
        let cross = (b - a).cross(&(c - a));
        let area = cross.norm_squared();
        let d = x[vertex] - a;
        let wb = d.cross(&(c - a)).dot(&cross) / area;
        let wc = (b - a).cross(&d).dot(&cross) / area;
        let wa = 1.0 - wb - wc;
        (wa >= 0.0 && wb >= 0.0 && wc >= 0.0).then(|| {
            let normal = cross / area.sqrt();
            Self { height: d.dot(&normal), normal, weights: [wa, wb, wc] }
        })
    }
}
