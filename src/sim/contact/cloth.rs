//! Contact of the cloth with itself: vertices are kept a thickness away from triangles, edges from edges.
//!
//! A pair is found while its two sides are still clear of each other; which way round they then lie is remembered for
//! as long as they stay near, so cloth that slips through is pushed back to where it came from. Pairs are sought within a
//! reach that no step can cross, so none is met unseen. Cloth that already crosses when it is first seen passes through
//! itself until it has come free. There is no friction between layers.

use super::grid::BoxGrid;
use crate::geom::V3;
use crate::sim::solver::{Contact4, PairList};

/// Parameters of self-contact.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ClothContactParams {
    /// Distance at which layers begin to push each other apart, m.
    pub thickness_m: f64,
    /// Penalty, N/m3.
    pub stiffness_n_m3: f64,
    /// Pairs are sought up to this distance, m: at least twice what a vertex moves in a step.
    pub reach_m: f64,
}

impl Default for ClothContactParams {
    fn default() -> Self {
        Self { thickness_m: 2e-3, stiffness_n_m3: 1e6, reach_m: 0.02 }
    }
}

/// How far outside its triangle or edge a foot point may lie for a pair to be remembered, as a barycentric weight: it may
/// slide in before pairs are sought again.
const MARGIN: f64 = 0.3;

/// Vertices of a pair: `[vertex, triangle]` or `[edge, edge]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Primitives {
    VertexTriangle([usize; 4]),
    EdgeEdge([usize; 4]),
}

impl Primitives {
    fn vertices(self) -> [usize; 4] {
        match self {
            Self::VertexTriangle(vertices) | Self::EdgeEdge(vertices) => vertices,
        }
    }
}

/// A pair that is near, and which way round it lay when it was found.
#[derive(Clone, Copy, Debug)]
struct Pair {
    primitives: Primitives,
    /// +1 or -1 along the pair's normal.
    side: f64,
}

/// Self-contact of one cloth.
pub struct ClothContact<'a> {
    params: ClothContactParams,
    triangles: &'a [[usize; 3]],
    edges: PairList,
    areas: &'a [f64],
    /// Vertices that share a triangle with a vertex, itself included, sorted.
    ring: Vec<Vec<usize>>,
    /// Group of each vertex where only groups are kept apart from each other; 0 belongs to none.
    groups: Option<Vec<u8>>,
    /// Sorted by primitives.
    pairs: Vec<Pair>,
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
        let edges = PairList::new(triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]));
        Self { params, triangles, edges, areas, ring, groups: None, pairs: Vec::new(), found_at: Vec::new() }
    }

    /// Keeps apart only vertices of different groups (0 belongs to none), and those not where `sewn` pairs will join
    /// them: what two limbs wear must not interlock while it is sewn, all else may still pass through itself.
    #[must_use]
    pub fn between(mut self, groups: Vec<u8>, sewn: impl Iterator<Item = [usize; 2]>) -> Self {
        let unsewn = self.ring.clone();
        for [a, b] in sewn {
            for (own, other) in [(a, b), (b, a)] {
                for &v in &unsewn[own] {
                    self.ring[v].extend_from_slice(&unsewn[other]);
                }
            }
        }
        for ring in &mut self.ring {
            ring.sort_unstable();
            ring.dedup();
        }
        self.groups = Some(groups);
        self
    }

    /// Seeks near pairs anew where cloth has moved so far that one could have been missed.
    pub fn update(&mut self, x: &[V3]) {
        let slack = 0.25 * self.params.reach_m;
        let moved = |(p, q): (&V3, &V3)| (p - q).norm_squared() > slack * slack;
        if self.found_at.len() == x.len() && !x.iter().zip(&self.found_at).any(moved) {
            return;
        }
        let mut found = self.vertex_triangle_pairs(x);
        found.extend(self.edge_edge_pairs(x));
        found.sort_unstable_by_key(|p| p.primitives);
        let tangled = self.tangled(x);
        found.retain_mut(|pair| match self.pairs.binary_search_by_key(&pair.primitives, |p| p.primitives) {
            Ok(known) => {
                pair.side = self.pairs[known].side;
                true
            }
            // Cloth that crosses when it first meets has no right side: it passes until it has come free.
            Err(_) => pair.primitives.vertices().iter().all(|v| !tangled[*v]),
        });
        self.pairs = found;
        self.found_at = x.to_vec();
    }

    /// Vertices of edges and triangles that pierce each other.
    fn tangled(&self, x: &[V3]) -> Vec<bool> {
        let mut tangled = vec![false; x.len()];
        for (edge, triangle) in crossings(x, self.edges.pairs(), self.triangles) {
            for v in edge.into_iter().chain(triangle) {
                tangled[v] = true;
            }
        }
        tangled
    }

    fn vertex_triangle_pairs(&self, x: &[V3]) -> Vec<Pair> {
        let reach = self.params.reach_m;
        let longest = self.longest_edge(x);
        let grid = BoxGrid::new(x, self.triangles, reach, 2.0 * reach);
        let mut pairs = Vec::new();
        for v in 0..x.len() {
            for t in grid.near(&x[v]) {
                let [a, b, c] = self.triangles[t];
                if near(&x[v], &x[a], reach + longest) && self.apart(&[v], &[a, b, c]) {
                    pairs.extend(self.near_pair(x, Primitives::VertexTriangle([v, a, b, c])));
                }
            }
        }
        pairs
    }

    fn edge_edge_pairs(&self, x: &[V3]) -> Vec<Pair> {
        let reach = self.params.reach_m;
        let edges = self.edges.pairs();
        let longest = self.longest_edge(x);
        // Two edges within reach of each other: the middle of one is within that and half its length of the other's box.
        let grid = BoxGrid::new(x, edges, reach + 0.5 * longest, 2.0 * reach + longest);
        let mut pairs = Vec::new();
        for (e, &[a, b]) in edges.iter().enumerate() {
            let middle = (x[a] + x[b]) / 2.0;
            for f in grid.near(&middle).filter(|&f| f > e) {
                let [c, d] = edges[f];
                if near(&middle, &((x[c] + x[d]) / 2.0), reach + longest) && self.apart(&[a, b], &[c, d]) {
                    pairs.extend(self.near_pair(x, Primitives::EdgeEdge([a, b, c, d])));
                }
            }
        }
        pairs
    }

    fn longest_edge(&self, x: &[V3]) -> f64 {
        self.edges.pairs().iter().map(|&[a, b]| (x[a] - x[b]).norm()).fold(0.0, f64::max)
    }

    /// Whether no vertex of one side shares a triangle with one of the other.
    fn apart(&self, one: &[usize], other: &[usize]) -> bool {
        if let Some(groups) = &self.groups {
            let (a, b) = (groups[one[0]], groups[other[0]]);
            if a == b || a == 0 || b == 0 {
                return false;
            }
        }
        one.iter().all(|&v| other.iter().all(|w| self.ring[v].binary_search(w).is_err()))
    }

    fn near_pair(&self, x: &[V3], primitives: Primitives) -> Option<Pair> {
        let facing = Facing::of(x, primitives, MARGIN)?;
        (facing.height.abs() < self.params.reach_m).then(|| Pair { primitives, side: facing.height.signum() })
    }

    fn active<'s>(&'s self, x: &'s [V3]) -> impl Iterator<Item = (f64, f64, Facing)> + 's {
        self.pairs.iter().filter_map(|pair| {
            let facing = Facing::of(x, pair.primitives, 0.0)?;
            let depth = self.params.thickness_m - pair.side * facing.height;
            (depth > 0.0).then_some((pair.side, depth, facing))
        })
    }

    /// Penalty stiffness of a contact, N/m: by the smallest rest area among its vertices.
    fn stiffness(&self, facing: &Facing) -> f64 {
        self.params.stiffness_n_m3 * facing.vertices.iter().map(|&v| self.areas[v]).fold(f64::MAX, f64::min)
    }

    /// Contact energy, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        self.active(x).map(|(_, depth, facing)| 0.5 * self.stiffness(&facing) * depth * depth).sum()
    }

    /// Adds the contact forces and returns the stiffness.
    pub fn assemble(&self, x: &[V3], forces: &mut [V3]) -> Vec<Contact4> {
        let mut contacts = Vec::new();
        for (side, depth, facing) in self.active(x) {
            let stiffness = self.stiffness(&facing);
            let contact =
                Contact4 { vertices: facing.vertices, weights: facing.weights, normal: facing.normal, stiffness };
            for k in 0..4 {
                forces[contact.vertices[k]] += facing.normal * (side * stiffness * depth * contact.weights[k]);
            }
            contacts.push(contact);
        }
        contacts
    }
}

/// Edges that pierce a triangle with which they share no vertex.
pub fn crossings<'s>(
    x: &'s [V3],
    edges: &'s [[usize; 2]],
    triangles: &'s [[usize; 3]],
) -> impl Iterator<Item = ([usize; 2], [usize; 3])> + 's {
    let length = edges.iter().map(|&[a, b]| (x[a] - x[b]).norm()).fold(0.0, f64::max);
    // Every point of an edge is within half the greatest length of the edge's middle.
    let grid = BoxGrid::new(x, triangles, 0.5 * length, length.max(1e-6));
    edges.iter().flat_map(move |&[a, b]| {
        let near: Vec<usize> = grid.near(&((x[a] + x[b]) / 2.0)).collect();
        let hits = move |t: &usize| {
            let triangle = triangles[*t];
            !triangle.contains(&a) && !triangle.contains(&b) && segment_hits(x[a], x[b], triangle.map(|v| x[v]))
        };
        near.into_iter().filter(hits).map(move |t| ([a, b], triangles[t]))
    })
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

fn near(p: &V3, q: &V3, distance_m: f64) -> bool {
    (p - q).norm_squared() < distance_m * distance_m
}

/// Two primitives that face each other: the height of one over the other is `normal . sum w_k x_k`.
struct Facing {
    vertices: [usize; 4],
    /// Weights of the vertices; they sum to zero.
    weights: [f64; 4],
    /// Unit normal.
    normal: V3,
    /// Signed height, m.
    height: f64,
}

impl Facing {
    /// `None` when a foot point lies more than `margin` outside its primitive, or edges are parallel.
    fn of(x: &[V3], primitives: Primitives, margin: f64) -> Option<Self> {
        let (vertices, weights, cross) = match primitives {
            Primitives::VertexTriangle(vertices) => {
                let [p, a, b, c] = vertices.map(|v| x[v]);
                let cross = (b - a).cross(&(c - a));
                let area = cross.norm_squared();
                let wb = (p - a).cross(&(c - a)).dot(&cross) / area;
                let wc = (b - a).cross(&(p - a)).dot(&cross) / area;
                let wa = 1.0 - wb - wc;
                (wa >= -margin && wb >= -margin && wc >= -margin).then_some(())?;
                (vertices, [1.0, -wa, -wb, -wc], cross)
            }
            Primitives::EdgeEdge(vertices) => {
                let [a, b, c, d] = vertices.map(|v| x[v]);
                let (u, w, between) = (b - a, d - c, c - a);
                let cross = u.cross(&w);
                let area = cross.norm_squared();
                let s = between.cross(&w).dot(&cross) / area;
                let t = between.cross(&u).dot(&cross) / area;
                let range = -margin..=1.0 + margin;
                (range.contains(&s) && range.contains(&t)).then_some(())?;
                (vertices, [1.0 - s, s, t - 1.0, -t], cross)
            }
        };
        let normal = cross.try_normalize(0.0)?;
        let height = (0..4).map(|k| weights[k] * normal.dot(&x[vertices[k]])).sum();
        Some(Self { vertices, weights, normal, height })
    }
}
