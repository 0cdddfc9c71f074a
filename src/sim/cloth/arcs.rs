//! Arcs: what the sides of triangles are longer by than their chords where cloth curves.
//!
//! A triangle of constant strain on a cylinder shortens each side to its chord, by the fourth power of the side's share along the
//! bend; the three shortenings do not add up to a strain that a motion in the plane takes back, and at the stiffness of cloth in its
//! plane that outweighs bending: folds of few edges lock. So strains are taken of arcs, whose squared length is
//! `|x_b - x_a|^2 + q / (1 + q / q_max)` with `q = |k|^2 / 12` and the curvature along the side `k = d^T (k_s + k_t) / 2 d`, `d` the
//! side at rest, `s` and `t` its triangles. The curvature tensor of a triangle is the quadratic that fits, by least squares, how far
//! the vertices about its corners lie from its plane, with a little of the tensor of its hinges [Onate & Zarate 2000] where these do
//! not tell. It is linear in the positions, and so is `k`: a few weights a side, known once the cloth is cut.

use std::collections::VecDeque;

use nalgebra::{Matrix3, Vector3};

use super::bending::{Hinge, Plate};
use geom::{V2, V3};
use linalg::PairList;
use linalg::stencil::Stencils;

geom::constants! {
    "cloth.arcs",
    /// Weight of vertices about the corners that do not face the triangle across a side: those do with 1.
    const AROUND: f64 = 0.3;
    /// Weight of the hinges' tensor.
    const HINGES: f64 = 0.02;
    /// Greatest excess of a squared arc over a share of the squared side: crumpled folds would grow without limit.
    const MOST: f64 = 0.1;
}

/// The sides of a membrane's triangles as arcs, in the order of its pairs.
#[derive(Clone, Debug, Default)]
pub struct Arcs {
    /// What the curvature along each side is told by: `k = sum weight_j x_j`, m.
    pub stencils: Stencils,
    /// Bound on the excess of the squared arc, m2.
    pub most: Vec<f64>,
}

/// The arcs of cloth somewhere.
#[derive(Clone, Debug, Default)]
pub struct Bent {
    /// By how much squared arcs exceed squared chords, m2.
    pub excess: Vec<f64>,
    /// Half of the excess grows by this times the change of the curvature along the side, m.
    pub slopes: Vec<V3>,
    /// `dc/dq / 6`.
    pub rates: Vec<f64>,
}

/// A triangle of cloth at rest.
#[derive(Clone, Copy, Debug)]
pub struct Laid {
    /// Its corners among the vertices.
    pub vertices: [usize; 3],
    /// Its corners in (weft, warp), m.
    pub rest: [V2; 3],
    /// Triangle and side across each of its sides.
    pub across: [Option<[usize; 2]>; 3],
}

impl Laid {
    /// Its sides by the numbers of their ends: in the same order whichever way round it is.
    fn sides(&self) -> [usize; 3] {
        let mut order = [0, 1, 2];
        order.sort_unstable_by_key(|&side| {
            let [a, b] = [side, (side + 1) % 3].map(|k| self.vertices[k]);
            [a.min(b), a.max(b)]
        });
        order
    }
}

impl Arcs {
    /// Weights of the curvature along each of the `pairs`, which are the sides of the triangles.
    #[must_use]
    pub fn new(laid: &[Laid], plates: &[Plate], hinges: &[Hinge], pairs: &PairList, vertices: usize) -> Self {
        let count = pairs.pairs().len();
        let mut sides: Vec<Vec<(usize, f64)>> = vec![Vec::new(); count];
        let mut most = vec![0.0; count];
        let mut shares = vec![0.0; count];
        for triangle in laid {
            for k in 0..3 {
                let (a, b) = (triangle.vertices[k], triangle.vertices[(k + 1) % 3]);
                if let Some(slot) = pairs.slot(a, b).filter(|_| a != b) {
                    shares[slot] += 1.0;
                }
            }
        }
        for (t, triangle) in laid.iter().enumerate() {
            let curvature = curvature(laid, t, &plates[t], hinges);
            for k in 0..3 {
                let (a, b) = (triangle.vertices[k], triangle.vertices[(k + 1) % 3]);
                let Some(slot) = pairs.slot(a, b).filter(|_| a != b) else { continue };
                let d = triangle.rest[(k + 1) % 3] - triangle.rest[k];
                let along = Vector3::new(d.x * d.x, d.y * d.y, 2.0 * d.x * d.y);
                most[slot] += MOST * d.norm_squared() / shares[slot];
                sides[slot].extend(curvature.iter().map(|(v, k)| (*v, k.dot(&along) / shares[slot])));
            }
        }
        for side in &mut sides {
            side.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            let sums = side.chunk_by(|a, b| a.0 == b.0).map(|run| (run[0].0, run.iter().map(|(_, w)| w).sum()));
            *side = sums.collect();
        }
        Self { stencils: Stencils::new(&sides, vertices), most }
    }

    /// Those of a part with `pairs` of its own, whose vertices the cloth calls `vertices`, and which calls the cloth's by `name`.
    #[must_use]
    pub fn part(&self, all: &PairList, pairs: &PairList, vertices: &[usize], name: impl Fn(usize) -> usize) -> Self {
        let side = |&[i, j]: &[usize; 2]| all.slot(vertices[i], vertices[j]).expect("a side of the whole");
        let sides: Vec<usize> = match self.most.is_empty() {
            true => Vec::new(),
            false => pairs.pairs().iter().map(side).collect(),
        };
        let rows: Vec<Vec<(usize, f64)>> =
            sides.iter().map(|&side| self.of(side).map(|(v, weight)| (name(v), weight)).collect()).collect();
        Self {
            stencils: Stencils::new(&rows, vertices.len()),
            most: sides.iter().map(|&side| self.most[side]).collect(),
        }
    }

    /// The vertices and weights of a side.
    pub fn of(&self, side: usize) -> impl Iterator<Item = (usize, f64)> {
        self.stencils.row(side)
    }

    /// The arcs of cloth at `x`.
    #[must_use]
    pub fn bent(&self, x: &[V3]) -> Bent {
        let mut bent = Bent::default();
        for side in 0..self.most.len() {
            let k = self.stencils.sum(side, x);
            let q = k.norm_squared() / 12.0;
            let share = 1.0 / (1.0 + q / self.most[side].max(f64::MIN_POSITIVE));
            bent.excess.push(q * share);
            let rate = share * share / 6.0;
            bent.rates.push(rate);
            bent.slopes.push(k * (0.5 * rate));
        }
        bent
    }

    /// Half of what a displacement adds to the squared arcs' excess in first order, m2.
    #[must_use]
    pub fn changes(&self, bent: &Bent, d: &[V3]) -> Vec<f64> {
        let change = |(side, slope): (usize, &V3)| slope.dot(&self.stencils.sum(side, d));
        bent.slopes.iter().enumerate().map(change).collect()
    }

    /// Adds the forces of energies that grow by `tensions` (N/m) with half of the squared arcs.
    pub fn add_forces(&self, bent: &Bent, tensions: &[f64], forces: &mut [V3]) {
        for (side, (slope, tension)) in bent.slopes.iter().zip(tensions).enumerate() {
            let pull = slope * *tension;
            for (v, weight) in self.of(side) {
                forces[v] -= pull * weight;
            }
        }
    }
}

/// Curvature tensor of a triangle: of each vertex, what it has of `k11`, `k22` and `k12`, 1 along the weft and 2 along the warp, 1/m2.
fn curvature(laid: &[Laid], t: usize, plate: &Plate, hinges: &[Hinge]) -> Vec<(usize, Vector3<f64>)> {
    // Corners by their numbers, and what lies about them: a mirrored garment has the mirrored weights to the bit.
    let mut order = [0, 1, 2];
    order.sort_unstable_by_key(|&k| laid[t].vertices[k]);
    let (vertices, corners) = (order.map(|k| laid[t].vertices[k]), order.map(|k| laid[t].rest[k]));
    let twice = (corners[1] - corners[0]).perp(&(corners[2] - corners[0]));
    let half = |p: V2| Vector3::new(0.5 * p.x * p.x, 0.5 * p.y * p.y, p.x * p.y);
    let regular = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 2.0)) * HINGES;
    let mut normal = regular;
    let mut terms: Vec<(usize, Vector3<f64>)> = Vec::new();
    for (v, (p, weight)) in around(laid, t) {
        let lambda = [0, 1, 2].map(|k| {
            let (b, c) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            (b - p).perp(&(c - p)) / twice
        });
        let flat: Vector3<f64> = (0..3).map(|k| half(corners[k]) * lambda[k]).sum();
        let row = (half(p) - flat) / twice;
        normal += row * row.transpose() * weight;
        let term = row * (weight / twice);
        terms.push((v, term));
        terms.extend((0..3).map(|k| (vertices[k], -term * lambda[k])));
    }
    let order = laid[t].sides();
    for (side, tensor) in order.into_iter().zip(plate.curvature_tensor(order)) {
        let Some(hinge) = plate.hinges[side].map(|h| &hinges[h]) else { continue };
        let of = regular * tensor;
        terms.extend(hinge.vertices.into_iter().zip(hinge.coefficients).map(|(v, c)| (v, of * c)));
    }
    let inverse = normal.try_inverse().unwrap_or_else(Matrix3::zeros);
    terms.into_iter().map(|(v, term)| (v, inverse * term)).collect()
}

/// The vertices about the corners of a triangle, ascending, unfolded into its plane, with their weights.
fn around(laid: &[Laid], t: usize) -> Vec<(usize, (V2, f64))> {
    let corners = laid[t].vertices;
    let mut placed = vec![(t, laid[t].rest)];
    let mut queue = VecDeque::from([0]);
    let mut found: Vec<(usize, (V2, f64))> = Vec::new();
    while let Some(at) = queue.pop_front() {
        let (from, rest) = placed[at];
        for side in laid[from].sides() {
            let Some([next, back]) = laid[from].across[side] else { continue };
            let touches = laid[next].vertices.iter().any(|v| corners.contains(v));
            if !touches || placed.iter().any(|(other, _)| *other == next) {
                continue;
            }
            let shape = unfolded([rest[side], rest[(side + 1) % 3]], laid[next].rest, back);
            let facing = (back + 2) % 3;
            let v = laid[next].vertices[facing];
            if !corners.contains(&v) && found.iter().all(|(other, _)| *other != v) {
                found.push((v, (shape[facing], if at == 0 { 1.0 } else { AROUND })));
            }
            queue.push_back(placed.len());
            placed.push((next, shape));
        }
    }
    found.sort_unstable_by_key(|(v, _)| *v);
    found
}

/// A triangle laid beside a side from `a` to `b`, along which its own side `back` runs the other way.
fn unfolded([a, b]: [V2; 2], rest: [V2; 3], back: usize) -> [V2; 3] {
    let (from, to) = (rest[back], rest[(back + 1) % 3]);
    if (from, to) == (b, a) {
        return rest;
    }
    let own = (to - from).try_normalize(0.0).unwrap_or_else(V2::x);
    let wanted = (a - b).try_normalize(0.0).unwrap_or_else(V2::x);
    let (cos, sin) = (own.dot(&wanted), own.perp(&wanted));
    let (middle, place) = ((from + to) * 0.5, (a + b) * 0.5);
    rest.map(|p| {
        let d = p - middle;
        place + V2::new(cos * d.x - sin * d.y, sin * d.x + cos * d.y)
    })
}
