//! Arcs: the sides of triangles taken as arcs, which are longer than their chords where the cloth curves.
//!
//! A constant-strain triangle on a cylinder has chords for its sides. Each squared side is shorter than that of the arc
//! by the fourth power of its component along the bend. The three shortenings of a triangle add up to a strain that no
//! motion in the plane removes. At the membrane stiffness of cloth it outweighs bending, and folds of few edges lock
//! (membrane locking). So strains are computed from arcs, whose squared length is `|x_b - x_a|^2 + q / (1 + q / q_max)`
//! with `q = |k|^2 / 12`. `k = d^T k_ab d` is the curvature along the side times its squared length, m, with the side
//! `d` at rest.
//!
//! The curvature tensor at a side is a least-squares fit of a quadratic. It fits the offsets of the vertices around the
//! ends of the side from the planes of its triangles. The tensor of the hinges [Onate & Zarate 2000] takes part with a
//! small weight, which determines the fit where the vertices do not. The tensor is linear in the positions, and so is
//! `k`. There are about ten weights to a side, constant once the cloth is cut.

use nalgebra::{Matrix3, Vector3};

use super::bending::{Hinge, Plate};
use geom::{V2, V3};
use linalg::PairList;
use linalg::stencil::Stencils;

geom::constants! {
    "cloth.arcs",
    /// Weight of the curvature tensor of the hinges in the fit; that of a vertex is 1.
    const HINGES: f64 = 0.02;
    /// Greatest excess of a squared arc as a share of the squared side at rest. Without it, crumpled folds would grow
    /// without limit.
    const MOST: f64 = 0.1;
}

/// Triangle sides of a membrane as arcs, in the order of its pairs.
#[derive(Clone, Debug, Default)]
pub struct Arcs {
    /// Weights of the vertices in the curvature along each side, `k = sum weight_j x_j`, m.
    pub stencils: Stencils,
    /// Bound `q_max` on the excess of the squared arc, m2.
    pub most: Vec<f64>,
}

#[derive(Clone, Debug, Default)]
pub struct Bent {
    /// Excess `c(q) = q / (1 + q / q_max)` of squared arcs over squared chords, m2.
    pub excess: Vec<f64>,
    /// Derivative of half of the excess by the curvature `k` along the side, m.
    pub slopes: Vec<V3>,
    /// `dc/dq / 6`, without unit.
    pub rates: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
pub struct Laid {
    pub vertices: [usize; 3],
    /// Corners in (weft, warp).
    pub rest: [V2; 3],
    /// Index of the triangle across each side, and the number of the common side in it.
    pub across: [Option<[usize; 2]>; 3],
}

impl Laid {
    fn ends(&self, side: usize) -> [usize; 2] {
        [self.vertices[side], self.vertices[(side + 1) % 3]]
    }

    /// Sides in the order of the indices of their ends. A mirrored triangle has the same order.
    fn sides(&self) -> [usize; 3] {
        let mut order = [0, 1, 2];
        order.sort_unstable_by_key(|&side| {
            let [a, b] = self.ends(side);
            [a.min(b), a.max(b)]
        });
        order
    }
}

impl Arcs {
    /// `pairs` are the sides of the triangles.
    pub fn new(laid: &[Laid], plates: &[Plate], hinges: &[Hinge], pairs: &PairList, vertices: usize) -> Self {
        let count = pairs.pairs().len();
        let mut found: Vec<Vec<Side>> = vec![Vec::new(); count];
        for (t, triangle) in laid.iter().enumerate() {
            for side in 0..3 {
                let [a, b] = triangle.ends(side);
                let is_others = triangle.across[side].is_some_and(|[other, _]| other < t);
                if let Some(slot) = pairs.slot(a, b).filter(|_| a != b && !is_others) {
                    found[slot].push(Side { laid, plates, hinges, t, side });
                }
            }
        }
        // Where more than two triangles meet, the mean over them.
        let mean = |sides: &Vec<Side>, value: &dyn Fn(&Side) -> f64| {
            sides.iter().map(value).sum::<f64>() / sides.len().max(1) as f64
        };
        let most = found.iter().map(|sides| mean(sides, &|side| MOST * side.along().norm_squared())).collect();
        let weights = |sides: &Vec<Side>| {
            let share = 1.0 / sides.len().max(1) as f64;
            let mut all: Vec<(usize, f64)> =
                sides.iter().flat_map(Side::weights).map(|(v, w)| (v, w * share)).collect();
            all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            all.chunk_by(|a, b| a.0 == b.0).map(|run| (run[0].0, run.iter().map(|(_, w)| w).sum())).collect()
        };
        let rows: Vec<Vec<(usize, f64)>> = found.iter().map(weights).collect();
        Self { stencils: Stencils::new(&rows, vertices), most }
    }

    /// Arcs of a part of the cloth with `pairs` of its own. `name` gives the index in the part of a vertex of the
    /// cloth.
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

    pub fn of(&self, side: usize) -> impl Iterator<Item = (usize, f64)> {
        self.stencils.row(side)
    }

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

    /// Half of the first-order change of the excess along a displacement, m2.
    pub fn changes(&self, bent: &Bent, d: &[V3]) -> Vec<f64> {
        let change = |(side, slope): (usize, &V3)| slope.dot(&self.stencils.sum(side, d));
        bent.slopes.iter().enumerate().map(change).collect()
    }

    /// Adds the forces (N) of the excess. `tensions` (N/m) are the derivatives of the energy by half of each squared
    /// arc.
    pub fn add_forces(&self, bent: &Bent, tensions: &[f64], forces: &mut [V3]) {
        for (side, (slope, tension)) in bent.slopes.iter().zip(tensions).enumerate() {
            let pull = slope * *tension;
            for (v, weight) in self.of(side) {
                forces[v] -= pull * weight;
            }
        }
    }
}

#[derive(Clone, Copy)]
struct Side<'a> {
    laid: &'a [Laid],
    plates: &'a [Plate],
    hinges: &'a [Hinge],
    t: usize,
    side: usize,
}

impl Side<'_> {
    fn along(&self) -> V2 {
        let rest = self.laid[self.t].rest;
        rest[(self.side + 1) % 3] - rest[self.side]
    }

    /// Unfolded into the plane of the first.
    fn triangles(&self) -> Vec<(usize, [V2; 3])> {
        let first = &self.laid[self.t];
        let ends = [first.rest[self.side], first.rest[(self.side + 1) % 3]];
        let other = first.across[self.side].map(|[other, back]| (other, unfolded(ends, self.laid[other].rest, back)));
        [Some((self.t, first.rest)), other].into_iter().flatten().collect()
    }

    /// Weights in the curvature along the side, without unit. A vertex may appear more than once.
    fn weights(&self) -> Vec<(usize, f64)> {
        let triangles = self.triangles();
        let regular = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 2.0)) * (HINGES / triangles.len() as f64);
        let mut normal = Matrix3::zeros();
        let mut terms: Vec<(usize, Vector3<f64>)> = Vec::new();
        for (t, rest) in triangles {
            // Corners in the order of their indices: a mirrored garment has the mirrored weights to the bit.
            let mut order = [0, 1, 2];
            order.sort_unstable_by_key(|&k| self.laid[t].vertices[k]);
            let (vertices, corners) = (order.map(|k| self.laid[t].vertices[k]), order.map(|k| rest[k]));
            for (v, p) in self.around(t, rest) {
                let Departure { row, weights: lambda } = departure(corners, p);
                normal += row * row.transpose();
                let term = row / (corners[1] - corners[0]).perp(&(corners[2] - corners[0]));
                terms.push((v, term));
                terms.extend((0..3).map(|k| (vertices[k], -term * lambda[k])));
            }
            normal += regular;
            let order = self.laid[t].sides();
            for (side, tensor) in order.into_iter().zip(self.plates[t].curvature_tensor(order)) {
                let Some(hinge) = self.plates[t].hinges[side].map(|h| &self.hinges[h]) else { continue };
                let weighted = regular * tensor;
                terms.extend(hinge.vertices.into_iter().zip(hinge.coefficients).map(|(v, c)| (v, weighted * c)));
            }
        }
        let d = self.along();
        let inverse = normal.try_inverse().unwrap_or_else(Matrix3::zeros);
        let along = inverse * Vector3::new(d.x * d.x, d.y * d.y, 2.0 * d.x * d.y);
        terms.into_iter().map(|(v, term)| (v, along.dot(&term))).collect()
    }

    /// Vertices of the triangles around the ends of the side, except the corners of triangle `t`, ascending, each with
    /// its place when the cloth is unfolded into the plane of `t`.
    fn around(&self, t: usize, rest: [V2; 3]) -> Vec<(usize, V2)> {
        let ends = self.laid[self.t].ends(self.side);
        let mut placed = vec![(t, rest)];
        let mut found: Vec<(usize, V2)> = Vec::new();
        let mut next_placed = 0;
        while next_placed < placed.len() {
            let (from, rest) = placed[next_placed];
            next_placed += 1;
            for side in self.laid[from].sides() {
                let Some([next, back]) = self.laid[from].across[side] else { continue };
                let touches = self.laid[next].vertices.iter().any(|v| ends.contains(v));
                if !touches || placed.iter().any(|(other, _)| *other == next) {
                    continue;
                }
                let shape = unfolded([rest[side], rest[(side + 1) % 3]], self.laid[next].rest, back);
                let facing = (back + 2) % 3;
                let v = self.laid[next].vertices[facing];
                if !self.laid[t].vertices.contains(&v) && found.iter().all(|(other, _)| *other != v) {
                    found.push((v, shape[facing]));
                }
                placed.push((next, shape));
            }
        }
        found.sort_unstable_by_key(|(v, _)| *v);
        found
    }
}

/// Offset of a point of a quadratic surface from the plane through three of its points.
struct Departure {
    /// Offset for a unit of each component `k11, k22, k12` of the curvature tensor, over twice the area of the corners.
    row: Vector3<f64>,
    weights: [f64; 3],
}

fn departure(corners: [V2; 3], p: V2) -> Departure {
    let half = |p: V2| Vector3::new(0.5 * p.x * p.x, 0.5 * p.y * p.y, p.x * p.y);
    let twice = (corners[1] - corners[0]).perp(&(corners[2] - corners[0]));
    let shares = [0, 1, 2].map(|k| {
        let (b, c) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        (b - p).perp(&(c - p)) / twice
    });
    let flat: Vector3<f64> = (0..3).map(|k| half(corners[k]) * shares[k]).sum();
    Departure { row: (half(p) - flat) / twice, weights: shares }
}

/// Lays a triangle beside the side from `a` to `b`, which its own side `back` traverses in the opposite direction.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::Cloth;
    use crate::cloth::membrane::Membrane;
    use crate::laboratory::Specimen;
    use crate::laboratory::sheets::{hexagonal_sheet, jittered, noise, shaken};
    use crate::testing::{check_forces, fabric};
    use nalgebra::DMatrix;

    const EDGE: f64 = 0.015;

    fn sheet(place: impl Fn(&V2) -> V3) -> Specimen {
        let flat = jittered(hexagonal_sheet(6, 6, EDGE), 0.15 * EDGE, |_| false);
        Specimen::new(flat, &fabric(), place).expect("a sound mesh")
    }

    fn on_cylinder(radius: f64) -> impl Fn(&V2) -> V3 {
        move |p| V3::new(p.x, radius * (p.y / radius).sin(), radius * (1.0 - (p.y / radius).cos()))
    }

    #[test]
    fn curvature_along_a_side_is_that_of_a_quadratic_and_none_of_a_plane() {
        let check = |form: [f64; 3], slope: V2| {
            let height =
                |p: &V2| 0.5 * (form[0] * p.x * p.x + form[1] * p.y * p.y) + form[2] * p.x * p.y + slope.dot(p);
            let Specimen { cloth, positions, garment, .. } = sheet(|p| V3::new(p.x, p.y, height(p)));
            let Membrane { arcs, pairs, .. } = &cloth.membrane;
            let inside = |p: &V2| p.x.min(p.y) > 1.5 * EDGE && p.x.max(p.y) < 4.0 * EDGE;
            for (side, &[a, b]) in pairs.pairs().iter().enumerate() {
                let d = garment.rest[b] - garment.rest[a];
                let known = form[0] * d.x * d.x + form[1] * d.y * d.y + 2.0 * form[2] * d.x * d.y;
                let found = arcs.stencils.sum(side, &positions);
                assert!(found.xy().norm() < 1e-12, "{found}");
                // The hinges weight curvature by area, and take part in the fit with a small weight.
                if inside(&garment.rest[a]) && inside(&garment.rest[b]) {
                    assert!((found.z - known).abs() < 0.02 * EDGE * EDGE, "{} for {known}", found.z);
                }
            }
        };
        check([0.0; 3], V2::new(0.3, -0.8));
        check([1.0, 0.0, 0.0], V2::zeros());
        check([0.0, 1.0, 0.0], V2::new(0.2, 0.1));
        check([0.5, -0.3, 0.4], V2::zeros());
    }

    #[test]
    fn forces_and_stiffness_are_the_energys() {
        let Specimen { cloth, positions, .. } = sheet(on_cylinder(4.0 * EDGE));
        let membrane = &cloth.membrane;
        let x = shaken(&positions, 5e-4, 3);
        let mut forces = vec![V3::zeros(); x.len()];
        membrane.add_forces(&x, &mut forces);
        check_forces(|x| membrane.energy(x), &forces, &x, 1e-7, 1e-6);
        let bent = membrane.arcs.bent(&x);
        let d: Vec<V3> = noise(3 * x.len(), 5).chunks(3).map(|c| V3::new(c[0], c[1], c[2])).collect();
        let step = 1e-6;
        let [low, high] = [-step, step].map(|by| {
            let moved: Vec<V3> = x.iter().zip(&d).map(|(p, d)| p + d * by).collect();
            membrane.arcs.bent(&moved).excess
        });
        for (change, (low, high)) in membrane.arcs.changes(&bent, &d).iter().zip(low.iter().zip(&high)) {
            let known = 0.5 * (high - low) / (2.0 * step);
            assert!((change - known).abs() < 1e-4 * known.abs() + 1e-9, "{change} for {known}");
        }
    }

    #[test]
    fn no_mode_of_a_sheet_held_all_round_is_softer_than_with_chords() {
        let softest = |place: &dyn Fn(&V2) -> V3, has_arcs: bool| {
            let Specimen { mut cloth, positions, garment, .. } = sheet(place);
            if !has_arcs {
                cloth.membrane = cloth.membrane.with_arcs(Arcs::default());
            }
            let forces = |x: &[V3]| {
                let mut f = vec![V3::zeros(); x.len()];
                cloth.membrane.add_forces(x, &mut f);
                cloth.bending.add_forces(x, &mut f);
                f
            };
            let high = garment.rest.iter().fold(V2::zeros(), |high, p| high.sup(p));
            let is_inside = |p: &V2| p.x.min(p.y) > 1e-9 && p.x < high.x - 1e-9 && p.y < high.y - 1e-9;
            let inner: Vec<usize> = (0..positions.len()).filter(|v| is_inside(&garment.rest[*v])).collect();
            let step = 1e-7;
            let mut stiffness = DMatrix::<f64>::zeros(3 * inner.len(), 3 * inner.len());
            for column in 0..3 * inner.len() {
                let [low, high] = [-step, step].map(|by| {
                    let mut x = positions.clone();
                    x[inner[column / 3]][column % 3] += by;
                    forces(&x)
                });
                for (row, &v) in inner.iter().enumerate() {
                    let change = (low[v] - high[v]) / (2.0 * step);
                    (0..3).for_each(|k| stiffness[(3 * row + k, column)] = change[k]);
                }
            }
            ((&stiffness + stiffness.transpose()) * 0.5).symmetric_eigenvalues().min()
        };
        let check = |place: &dyn Fn(&V2) -> V3, share: f64| {
            let [arcs, chords] = [true, false].map(|has_arcs| softest(place, has_arcs));
            assert!(arcs > share * chords && arcs > 0.0, "{arcs} with arcs, {chords} with chords");
        };
        check(&|p| V3::new(p.x, p.y, 0.0), 0.999);
        check(&|p| V3::new(1.01 * p.x, 1.01 * p.y, 0.0), 0.999);
        // Chords are under tension in a bent sheet, and that alone makes it stiff.
        check(&on_cylinder(6.0 * EDGE), 0.2);
    }

    #[test]
    fn a_part_has_the_arcs_of_the_whole() {
        let Specimen { cloth, positions, .. } = sheet(on_cylinder(3.0 * EDGE));
        let free: Vec<bool> = (0..cloth.len()).map(|v| v % 9 == 4).collect();
        let part = crate::cloth::part::Part::new(&cloth, &free, &[]);
        let (alone, _): (Cloth, _) = cloth.part(&part);
        let x: Vec<V3> = part.vertices.iter().map(|v| positions[*v]).collect();
        let [mut whole, mut own] = [vec![V3::zeros(); cloth.len()], vec![V3::zeros(); x.len()]];
        cloth.membrane.add_forces(&positions, &mut whole);
        alone.membrane.add_forces(&x, &mut own);
        for (name, &v) in part.vertices.iter().enumerate().filter(|(_, v)| free[**v]) {
            assert!((whole[v] - own[name]).norm() < 1e-12, "{v}: {} and {}", whole[v], own[name]);
        }
    }
}
