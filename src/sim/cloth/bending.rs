//! Bending of a thin plate on triangles. The energy is quadratic in the positions: for nearly inextensible cloth the
//! stiffness is constant, and is assembled once.
//!
//! Each edge with a triangle on either side is a hinge. `J = sum K0_i x_i` with the cotangents of [Bergou 2006], `K0 =
//! (c03+c04, c01+c02, -c01-c03, -c02-c04)`, is the jump of the normal derivative across the edge times its length. `J /
//! (A0+A1)` is the curvature across the edge, 1/m. The three edges of a triangle give its curvature tensor, `k = sum
//! J_e / (A0+A1)_e n_e n_e^T` with the edge normals `n_e` [Onate & Zarate 2000]. The energy is that of an orthotropic
//! plate, `A/2 (B1 k11^2 + B2 k22^2 + 2 sqrt(B1 B2) k12^2)`, J. 1 is the weft and 2 the warp; there is no coupling
//! between them, and the twist is that of [Huber 1923].
//!
//! So a narrow strip and a wide plate are as stiff as the measured strip, whatever the orientation of the triangles.
//! Independent hinges would make a plate of Poisson ratio 1/3 instead, whose strips are softer by an eighth. At a free
//! edge of the cloth the curvature is the one of least energy, since no moment acts there.
//!
//! Hinges continue across sewn seams: each side uses its own rest triangle and grain.
//!
//! Linear solves take independent hinges instead ([`Tangent`]). They have half of the couplings, and half of those lie
//! along sides of triangles, which the membrane couples anyway. The direction of a step need not be more exact.

use nalgebra::{Matrix3, Vector3};
use wide::f32x4;

use geom::{V2, V3};
use linalg::PairList;
use linalg::quad::{self, Block};
use linalg::rows::sorted_by_row;

/// Interior edge with its two triangles.
#[derive(Clone, Copy, Debug)]
pub struct Hinge {
    /// Ends of the edge, then the opposite vertex of each triangle.
    pub vertices: [usize; 4],
    /// `K0 / (A0 + A1)`, 1/m2: the curvature across the edge is `sum coefficients_i x_i`, 1/m.
    pub coefficients: [f64; 4],
}

#[derive(Clone, Copy, Debug)]
pub struct Flap {
    /// Edge start, edge end, opposite corner.
    pub rest: [V2; 3],
}

impl Flap {
    fn area(&self) -> f64 {
        // Taken from the corner opposite the edge, so that the result has the same bits for either direction of the
        // edge.
        let [a, b, c] = self.rest;
        0.5 * (a - c).perp(&(b - c)).abs()
    }

    /// Those of the interior angles at the edge's start and end.
    fn cotangents(&self) -> [f64; 2] {
        let [a, b, c] = self.rest;
        let cot = |end: V2, other: V2| (other - end).dot(&(c - end)) / (other - end).perp(&(c - end)).abs();
        [cot(a, b), cot(b, a)]
    }
}

impl Hinge {
    pub fn new(vertices: [usize; 4], flaps: [Flap; 2]) -> Self {
        let [[c01, c03], [c02, c04]] = flaps.map(|f| f.cotangents());
        let areas = flaps[0].area() + flaps[1].area();
        Self { vertices, coefficients: [c03 + c04, c01 + c02, -c01 - c03, -c02 - c04].map(|c| c / areas) }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Plate {
    /// Rest area, m2.
    pub area: f64,
    /// Along weft and warp.
    pub rigidities_nm: [f64; 2],
    /// Unit normals of the sides in (weft, warp).
    pub normals: [V2; 3],
    /// Hinge on each side; `None` at a free edge.
    pub hinges: [Option<usize>; 3],
}

impl Plate {
    /// Quadratic form `G` of the curvatures `k` across the sides, N m: the energy per area is `k^T G k / 2`. Curvature
    /// across a free edge is eliminated at its value of least energy (Schur complement).
    fn form(&self) -> [[f64; 3]; 3] {
        let [weft, warp] = self.rigidities_nm.map(f64::sqrt);
        let n = &self.normals;
        let mut form = [[0.0; 3]; 3];
        for e in 0..3 {
            for f in 0..3 {
                form[e][f] = (weft * (n[e].x * n[f].x) + warp * (n[e].y * n[f].y)).powi(2);
            }
        }
        // The stiffest first, so that the order of the corners does not matter.
        let mut free: Vec<usize> = (0..3).filter(|&e| self.hinges[e].is_none()).collect();
        free.sort_by(|&e, &f| form[f][f].total_cmp(&form[e][e]));
        for free in free {
            let row = form[free];
            for e in 0..3 {
                for f in 0..3 {
                    form[e][f] -= if row[free] > 0.0 { row[e] * row[f] / row[free] } else { 0.0 };
                }
            }
            form[free] = [0.0; 3];
            form.iter_mut().for_each(|r| r[free] = 0.0);
        }
        form
    }

    /// Contribution of the curvature across each side, in this order, to the curvature tensor `k11, k22, k12`.
    /// Curvatures across free sides minimise the norm of the tensor.
    pub fn curvature_tensor(&self, order: [usize; 3]) -> [Vector3<f64>; 3] {
        let n = order.map(|side| self.normals[side]);
        let known = Matrix3::from_fn(|e, f| match self.hinges[order[e]] {
            None => n[e].dot(&n[f]).powi(2),
            Some(_) => f64::from(u8::from(e == f)),
        });
        let all = known.try_inverse().unwrap_or_else(Matrix3::zeros);
        let outer = n.map(|n| Vector3::new(n.x * n.x, n.y * n.y, n.x * n.y));
        let tensors = Matrix3::from_columns(&outer) * all;
        [0, 1, 2].map(|e| tensors.column(e).into_owned())
    }

    /// Appends the stiffness above its diagonal for each pair of corners. Corners sewn into one vertex couple it to
    /// itself, which adds nothing.
    fn push_terms(&self, hinges: &[Hinge], terms: &mut Vec<([usize; 2], f64)>) {
        let form = self.form();
        let own = self.hinges.map(|hinge| hinge.map(|h| &hinges[h]));
        let mut order = [0, 1, 2];
        order.sort_by_key(|&e| own[e].map(|h| (h.vertices[0].min(h.vertices[1]), h.vertices[0].max(h.vertices[1]))));
        // Each corner once, in ascending order, with the coefficient of each hinge. Three hinges of four corners have
        // at most twelve.
        let mut shares = [(0, [0.0; 3]); 12];
        let mut count = 0;
        for (e, hinge) in own.iter().enumerate() {
            for (corner, coefficient) in hinge.iter().flat_map(|h| h.vertices.into_iter().zip(h.coefficients)) {
                let place = shares[..count].partition_point(|(other, _)| *other < corner);
                if place == count || shares[place].0 != corner {
                    shares[place..=count].rotate_right(1);
                    shares[place] = (corner, [0.0; 3]);
                    count += 1;
                }
                shares[place].1[e] += coefficient;
            }
        }
        let shares = &shares[..count];
        for (i, (corner, of_i)) in shares.iter().enumerate() {
            let row = order.map(|f| order.map(|e| form[e][f] * of_i[e]).iter().sum::<f64>() * self.area);
            for (other, of_j) in &shares[i + 1..] {
                let value = (0..3).map(|k| row[k] * of_j[order[k]]).sum();
                terms.push(([*corner, *other], value));
            }
        }
    }
}

/// Stiffness of independent hinges, N/m, the same in x, y and z, scaled to be as stiff as the plate against being
/// rolled up.
#[derive(Clone, Debug)]
pub struct Tangent {
    /// Off-diagonal entries for the triangle sides, in the order of the membrane's pairs.
    pub along: Vec<f64>,
    /// Vertices that face each other across a side.
    pub pairs: PairList,
    pub across: Vec<f64>,
}

geom::constants! {
    "cloth.bending",
    /// Ratio of the energies of a rolled-up isotropic plate and of its independent hinges, for equilateral triangles.
    const ROLLED: f64 = 1.25;
}

impl Tangent {
    pub fn add_along(&self, blocks: &mut [Block<f32x4>]) {
        for (block, entry) in blocks.iter_mut().zip(&self.along) {
            for (row, alike) in block.iter_mut().zip(quad::alike(*entry as f32)) {
                *row += alike;
            }
        }
    }

    fn new(hinges: &[Hinge], plates: &[Plate], sides: &PairList) -> Self {
        let mut stiffness = vec![0.0; hinges.len()];
        for plate in plates {
            let form = plate.form();
            for (e, hinge) in plate.hinges.iter().enumerate() {
                if let Some(hinge) = *hinge {
                    stiffness[hinge] += ROLLED * plate.area * form[e][e];
                }
            }
        }
        let mut along = Vec::with_capacity(5 * hinges.len());
        let mut across = Vec::with_capacity(hinges.len());
        for (hinge, k) in hinges.iter().zip(stiffness) {
            for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                let [i, j] = [a, b].map(|end| hinge.vertices[end]);
                let term = ([i.min(j), i.max(j)], k * hinge.coefficients[a] * hinge.coefficients[b]);
                match sides.slot(i, j) {
                    _ if i == j => {}
                    Some(_) => along.push(term),
                    None => across.push(term),
                }
            }
        }
        let mut entries = vec![0.0; sides.pairs().len()];
        let (pairs, sums) = summed(&along);
        for (&[i, j], sum) in pairs.pairs().iter().zip(sums) {
            entries[sides.slot(i, j).expect("a side")] = sum;
        }
        let (pairs, across) = summed(&across);
        Self { along: entries, pairs, across }
    }
}

#[derive(Clone, Debug)]
pub struct Bending {
    pub pairs: PairList,
    /// Off-diagonal stiffness, N/m, the same in x, y and z.
    pub entries: Vec<f64>,
    /// Approximate stiffness for linear solves.
    pub tangent: Tangent,
}

/// Adds the terms of a pair in the order of their values, so that a mirrored garment is rounded alike.
fn summed(terms: &[([usize; 2], f64)]) -> (PairList, Vec<f64>) {
    let rows = terms.iter().map(|([i, _], _)| i + 1).max().unwrap_or(0);
    let (starts, mut sorted) = sorted_by_row(rows, terms, |([i, _], _)| *i, |([_, j], value)| (*j, *value));
    let (mut pairs, mut entries): (Vec<[usize; 2]>, Vec<f64>) = (Vec::new(), Vec::new());
    for (i, ends) in starts.windows(2).enumerate() {
        let row = &mut sorted[ends[0] as usize..ends[1] as usize];
        row.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for (j, value) in row {
            match entries.last_mut().filter(|_| pairs.last() == Some(&[i, *j])) {
                Some(sum) => *sum += *value,
                None => {
                    pairs.push([i, *j]);
                    entries.push(*value);
                }
            }
        }
    }
    (PairList::new(pairs), entries)
}

impl Bending {
    pub fn new(hinges: &[Hinge], plates: &[Plate], sides: &PairList) -> Self {
        let mut terms = Vec::with_capacity(15 * plates.len());
        for plate in plates {
            plate.push_terms(hinges, &mut terms);
        }
        let (pairs, entries) = summed(&terms);
        Self { pairs, entries, tangent: Tangent::new(hinges, plates, sides) }
    }

    /// J.
    pub fn energy(&self, x: &[V3]) -> f64 {
        self.gather(x, |_, _, _| {})
    }

    /// N.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        self.assemble(x, forces);
    }

    /// Adds the forces, N. Returns the energy, J.
    pub fn assemble(&self, x: &[V3], forces: &mut [V3]) -> f64 {
        self.gather(x, |i, j, pull| {
            forces[i] -= pull;
            forces[j] += pull;
        })
    }

    /// Returns the energy, J, and hands the force (N) between each pair to `each`. The rows of the stiffness `Q` sum to
    /// zero, so `x^T Q x` is the negative sum over pairs of `Q_ij |x_i - x_j|^2`.
    #[inline(always)]
    fn gather(&self, x: &[V3], mut each: impl FnMut(usize, usize, V3)) -> f64 {
        let mut energy = 0.0;
        for (i, here) in x.iter().enumerate() {
            for (j, entry) in self.pairs.upper().couplings(i, &self.entries) {
                let apart = x[j] - here;
                energy -= 0.5 * entry * apart.norm_squared();
                each(i, j, apart * *entry);
            }
        }
        energy
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fabric;
    use crate::cloth::PlateBuilder;
    use crate::laboratory::sheets::{hexagonal_sheet, jittered, shaken, sheet};
    use crate::testing::{check_forces, fabric};

    fn flat_bending(rest: &[V2], triangles: &[[usize; 3]], fabric: &Fabric) -> Bending {
        let mut builder = PlateBuilder::default();
        for &t in triangles {
            builder.add(t, t.map(|v| rest[v]), V2::new(0.0, 1.0), fabric);
        }
        let sides = PairList::new(triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]));
        builder.finish(&sides)
    }

    fn bending(columns: usize, rows: usize, step: f64, fabric: &Fabric) -> (Bending, Vec<V2>) {
        let (rest, triangles) = sheet(columns, rows, step);
        (flat_bending(&rest, &triangles, fabric), rest)
    }

    #[test]
    fn forces_are_the_energys() {
        let (bending, rest) = bending(3, 3, 0.02, &fabric());
        let flat: Vec<V3> = rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
        let x = shaken(&flat, 5e-3, 3);
        let mut forces = vec![V3::zeros(); x.len()];
        bending.add_forces(&x, &mut forces);
        check_forces(|x| bending.energy(x), &forces, &x, 1e-6, 1e-6);
    }

    #[test]
    fn a_flat_sheet_does_not_bend_however_it_lies() {
        let (bending, rest) = bending(6, 4, 0.01, &fabric());
        let x: Vec<V3> = rest.iter().map(|p| V3::new(0.6 * p.x, p.y, 0.8 * p.x + 1.0)).collect();
        assert!(bending.energy(&x).abs() < 1e-18);
    }

    #[test]
    fn a_cylinder_has_its_bending_energy() {
        // Rolled to radius r: W = B / (2 r^2) per area, with the rigidity B of the direction that curves. At 45 degrees
        // the twist makes it ((sqrt B1 + sqrt B2) / 2)^2. No moment acts at the free edges of the sheet, but a cylinder
        // would need one there: the outermost triangles store less.
        let fabric = fabric();
        let (weft, warp) = (fabric.bending_weft_nm, fabric.bending_warp_nm);
        let bias = ((weft.sqrt() + warp.sqrt()) / 2.0).powi(2);
        let edge = 0.004;
        let squares = sheet(50, 50, edge);
        let hexagons = hexagonal_sheet(50, 50, edge);
        let irregular = jittered(hexagonal_sheet(50, 50, edge), 0.15 * edge, |_| false);
        let check = |(rest, triangles): &(Vec<V2>, Vec<[usize; 3]>), across: V2, rigidity: f64, tolerance: f64| {
            let radius = 0.1;
            let rolled = |p: &V2| {
                let (s, t) = (p.dot(&across), p.perp(&across));
                V3::new(radius * (s / radius).sin(), t, radius * (1.0 - (s / radius).cos()))
            };
            let x: Vec<V3> = rest.iter().map(rolled).collect();
            let area = |t: &[usize; 3]| 0.5 * (rest[t[1]] - rest[t[0]]).perp(&(rest[t[2]] - rest[t[0]]));
            let expected = 0.5 * rigidity / (radius * radius) * triangles.iter().map(area).sum::<f64>();
            let energy = flat_bending(rest, triangles, &fabric).energy(&x);
            assert!((energy / expected - 1.0).abs() < tolerance, "{energy} for {expected} across {across}");
        };
        check(&squares, V2::x(), weft, 0.04);
        check(&squares, V2::y(), warp, 0.04);
        check(&hexagons, V2::x(), weft, 0.04);
        check(&hexagons, V2::y(), warp, 0.04);
        check(&hexagons, V2::new(0.5_f64.sqrt(), 0.5_f64.sqrt()), bias, 0.05);
        check(&irregular, V2::y(), warp, 0.08);
    }
}
