//! Intersections of cloth with itself, and the forces that untangle them.
//!
//! A crossing has no inner and outer side. It does have the line along which two sheets cut each other. Forces along
//! the gradient of the length of that line draw its ends and bends out of the cloth, whatever the layers around it do
//! [Volino & Magnenat-Thalmann 2006].

use super::grid::BoxGrid;
use geom::V3;
use geom::triangle::sorted;
use linalg::{Contact4, PairList};

geom::constants! {
    "contact.intersections",
    /// Least sine of the angle between edge and pierced triangle in the contribution along the normal, which is
    /// inversely proportional to it.
    const LEAST_SLOPE: f64 = 0.2;
    const HALVINGS: usize = 6;
}

#[derive(Clone, Copy, Debug)]
pub struct Intersection {
    pub edge: [usize; 2],
    pub triangle: [usize; 3],
}

/// Edges and triangles share no vertex.
pub fn intersections(x: &[V3], edges: &[[usize; 2]], triangles: &[[usize; 3]]) -> Vec<Intersection> {
    let length = edges.iter().map(|&[a, b]| (x[a] - x[b]).norm()).fold(0.0, f64::max);
    let grid = BoxGrid::new(x, triangles, 0.0, length.max(1e-6));
    let mut found = Vec::new();
    let mut near = Vec::new();
    for &[a, b] in edges {
        let hits = |triangle: &[usize; 3]| {
            !triangle.contains(&a) && !triangle.contains(&b) && segment_hits(x[a], x[b], triangle.map(|v| x[v]))
        };
        let pierced = grid.near([&x[a], &x[b]], &mut near).iter().map(|t| triangles[*t]).filter(hits);
        found.extend(pierced.map(|triangle| Intersection { edge: [a, b], triangle: sorted(triangle) }));
    }
    found
}

/// Moves a cloth from `x` towards `y` as far as possible without making it intersect itself. Vertices at an
/// intersection are held back by half, repeatedly. Returns the positions with the fewest intersections.
pub fn held_apart(x: &[V3], y: &[V3], triangles: &[[usize; 3]]) -> Vec<V3> {
    let edges = edges_of(triangles);
    let mut shares = vec![1.0; x.len()];
    let mut reached = y.to_vec();
    let mut best = (usize::MAX, Vec::new());
    for _ in 0..=HALVINGS {
        let found = intersections(&reached, edges.pairs(), triangles);
        if found.len() < best.0 {
            best = (found.len(), reached.clone());
        }
        if found.is_empty() {
            break;
        }
        let mut held: Vec<usize> = found.iter().flat_map(|c| c.edge.into_iter().chain(c.triangle)).collect();
        held.sort_unstable();
        held.dedup();
        for v in held {
            shares[v] *= 0.5;
            reached[v] = x[v].lerp(&y[v], shares[v]);
        }
    }
    best.1
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

pub struct Wings {
    corners: Vec<([usize; 2], usize)>,
}

impl Wings {
    pub fn new(triangles: &[[usize; 3]]) -> Self {
        let sides = |&[a, b, c]: &[usize; 3]| [([a, b], c), ([b, c], a), ([c, a], b)];
        let sorted = |([a, b], c): ([usize; 2], usize)| ([a.min(b), a.max(b)], c);
        let mut corners: Vec<_> = triangles.iter().flat_map(sides).map(sorted).collect();
        corners.sort_unstable();
        Self { corners }
    }

    fn opposite(&self, [a, b]: [usize; 2]) -> impl Iterator<Item = usize> + '_ {
        let edge = [a.min(b), a.max(b)];
        let start = self.corners.partition_point(|(e, _)| *e < edge);
        self.corners[start..].iter().take_while(move |(e, _)| *e == edge).map(|(_, c)| *c)
    }
}

/// Force that shortens the line of intersection, on the vertices of one crossing of an edge and a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Release {
    /// Edge, then the triangle that it pierces.
    pub vertices: [usize; 5],
    /// Edge and, with the opposite sign, triangle.
    pub weights: [f64; 5],
    /// Rate at which the line shortens as the edge moves against the triangle, without unit; at most 1.
    pub fall: V3,
}

impl Release {
    /// `None` where the line is straight, and no motion shortens it.
    pub fn of(x: &[V3], wings: &Wings, crossing: &Intersection) -> Option<Self> {
        let ([p, q], [a, b, c]) = (crossing.edge, crossing.triangle);
        let along = (x[q] - x[p]).try_normalize(0.0)?;
        let face = (x[b] - x[a]).cross(&(x[c] - x[a]));
        let normal = face.try_normalize(0.0)?;
        let slope = along.dot(&normal);
        let share = ((x[a] - x[p]).dot(&normal) / (x[q] - x[p]).dot(&normal)).clamp(0.0, 1.0);
        let point = x[p].lerp(&x[q], share);
        let mut fall = V3::zeros();
        for third in wings.opposite(crossing.edge) {
            let inwards = x[third] - x[p] - along * along.dot(&(x[third] - x[p]));
            let wing = along.cross(&inwards);
            let Some(line) = wing.cross(&normal).try_normalize(0.0) else { continue };
            let line = line * line.dot(&inwards).signum();
            fall += line - normal * (along.dot(&line) / (slope.signum() * slope.abs().max(LEAST_SLOPE)));
        }
        let length = fall.norm();
        if length < 1e-6 {
            return None;
        }
        let area = face.norm_squared();
        let wb = (point - x[a]).cross(&(x[c] - x[a])).dot(&face) / area;
        let wc = (x[b] - x[a]).cross(&(point - x[a])).dot(&face) / area;
        let weights = [1.0 - share, share, wb + wc - 1.0, -wb, -wc];
        // NaN where the edge lies in the plane of the triangle.
        weights.iter().all(|w| w.is_finite()).then_some(Self {
            vertices: [p, q, a, b, c],
            weights,
            fall: fall / length.max(1.0),
        })
    }

    /// Decreases as the line shortens, m. Linear in the positions, by its gradient at the start of the step.
    pub fn potential(&self, x: &[V3]) -> f64 {
        -(0..5).map(|k| self.weights[k] * self.fall.dot(&x[self.vertices[k]])).sum::<f64>()
    }

    pub fn add_force(&self, force_n: f64, forces: &mut [V3]) {
        for k in 0..5 {
            forces[self.vertices[k]] += self.fall * (force_n * self.weights[k]);
        }
    }

    /// Stiffness along the force, which limits a step to about the range in which the force is valid.
    pub fn couplings(&self, stiffness: f64) -> [Contact4; 2] {
        let normal = self.fall.try_normalize(0.0).unwrap_or_default();
        let [p, q, a, b, c] = self.vertices;
        let [wp, wq, wa, wb, wc] = self.weights;
        [
            Contact4 { vertices: [p, q, p, q], weights: [wp, wq, 0.0, 0.0], normal, stiffness },
            Contact4 { vertices: [a, b, c, c], weights: [wa, wb, wc, 0.0], normal, stiffness },
        ]
    }
}

pub fn edges_of(triangles: &[[usize; 3]]) -> PairList {
    PairList::new(triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]))
}
