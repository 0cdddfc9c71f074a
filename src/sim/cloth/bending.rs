//! Isometric quadratic bending [Bergou 2006]: for nearly inextensible cloth the bending energy is quadratic in the
//! positions, so its stiffness is constant and assembled once.
//!
//! For an edge `x0 x1` with opposite vertices `x2, x3` and the interior angles at its ends,
//! `K0 = (c03+c04, c01+c02, -c01-c03, -c02-c04)`, `Q = 1/(A0+A1) K0^T K0`, `E_b = (k_b/2) sum x^T Q x`. The printed factor
//! is 3; with it a sheet rolled to a cylinder holds three times the plate's `B kappa^2 / 2` per area, on right and on
//! equilateral triangles alike, so `k_b` would not be the measured rigidity. Hinges run on across sewn seams: each side
//! uses the angles and area of its own rest triangle.

use crate::geom::{V2, V3};
use crate::sim::Fabric;
use crate::sim::solver::PairList;

/// One interior edge with its two triangles.
#[derive(Clone, Copy, Debug)]
pub struct Hinge {
    /// The edge's ends, then the vertex opposite in either triangle.
    pub vertices: [usize; 4],
    /// `K0` of the quadratic form.
    pub coefficients: [f64; 4],
    /// `k_b / (A0 + A1)`, N/m.
    pub stiffness: f64,
}

/// A rest triangle as a hinge sees it: the edge first, then the opposite corner, and the piece's grain.
#[derive(Clone, Copy, Debug)]
pub struct Flap {
    /// Rest corners: edge start, edge end, opposite.
    pub rest: [V2; 3],
    /// Unit warp direction.
    pub grain: V2,
}

impl Flap {
    fn area(&self) -> f64 {
        let [a, b, c] = self.rest;
        0.5 * (b - a).perp(&(c - a)).abs()
    }

    /// Cotangents of the interior angles at the edge's start and end.
    fn cotangents(&self) -> [f64; 2] {
        let [a, b, c] = self.rest;
        let cot = |at: V2, to: V2| (to - at).dot(&(c - at)) / (to - at).perp(&(c - at)).abs();
        [cot(a, b), cot(b, a)]
    }

    /// Rigidity against a fold along this edge: the orthotropic plate's rigidity for curvature across the edge, with
    /// the twisting term `sqrt(B1 B2)` of a balanced plate [Huber 1923].
    fn rigidity(&self, fabric: &Fabric) -> f64 {
        let along = (self.rest[1] - self.rest[0]).normalize();
        let warp = along.perp(&self.grain).powi(2);
        let root = fabric.bending_warp_nm.sqrt() * warp + fabric.bending_weft_nm.sqrt() * (1.0 - warp);
        root * root
    }
}

impl Hinge {
    /// A hinge between two flaps that share the edge `vertices[0] vertices[1]`.
    #[must_use]
    pub fn new(vertices: [usize; 4], flaps: [Flap; 2], fabric: &Fabric) -> Self {
        let [[c01, c03], [c02, c04]] = flaps.map(|f| f.cotangents());
        let rigidity = 0.5 * (flaps[0].rigidity(fabric) + flaps[1].rigidity(fabric));
        Self {
            vertices,
            coefficients: [c03 + c04, c01 + c02, -c01 - c03, -c02 - c04],
            stiffness: rigidity / (flaps[0].area() + flaps[1].area()),
        }
    }
}

/// The bending of a garment.
#[derive(Clone, Debug)]
pub struct Bending {
    /// Pairs of vertices that share a hinge.
    pub pairs: PairList,
    /// Off-diagonal entries of `k_b Q` for those pairs, N/m.
    pub entries: Vec<f64>,
}

impl Bending {
    /// Adds up the hinges.
    #[must_use]
    pub fn new(hinges: &[Hinge]) -> Self {
        let sides = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
        // A hinge whose opposite corners were sewn into one vertex couples that vertex to itself, which adds nothing.
        let distinct = |h: &Hinge| sides.map(|s| s.map(|k| h.vertices[k]));
        let pairs = PairList::new(hinges.iter().flat_map(distinct).filter(|[i, j]| i != j));
        let mut entries = vec![0.0; pairs.pairs().len()];
        for hinge in hinges {
            for [a, b] in sides {
                if let Some(slot) = pairs.slot(hinge.vertices[a], hinge.vertices[b]) {
                    entries[slot] += hinge.stiffness * hinge.coefficients[a] * hinge.coefficients[b];
                }
            }
        }
        Self { pairs, entries }
    }

    /// Bending energy, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        // Rows of Q sum to zero, so x^T Q x = -sum over pairs of Q_ij |x_i - x_j|^2.
        let of = |(&[i, j], q): (&[usize; 2], &f64)| -0.5 * q * (x[j] - x[i]).norm_squared();
        self.pairs.pairs().iter().zip(&self.entries).map(of).sum()
    }

    /// Adds the bending forces, N.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        for (&[i, j], q) in self.pairs.pairs().iter().zip(&self.entries) {
            let pull = (x[j] - x[i]) * *q;
            forces[i] -= pull;
            forces[j] += pull;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::cloth::Flaps;
    use crate::sim::testing::{check_forces, fabric, shaken, sheet};

    fn bending(columns: usize, rows: usize, step: f64, fabric: &Fabric) -> (Bending, Vec<V2>) {
        let (rest, triangles) = sheet(columns, rows, step);
        let mut flaps = Flaps::default();
        for t in triangles {
            flaps.add(t, t.map(|v| rest[v]), V2::new(0.0, 1.0));
        }
        (Bending::new(&flaps.hinges(fabric)), rest)
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
        // Rolled isometrically to radius r about the warp: W = B_weft / (2 r^2) per area, away from the ends.
        let mut isotropic = fabric();
        isotropic.bending_warp_nm = isotropic.bending_weft_nm;
        let (columns, rows, step, radius) = (80, 80, 0.0025, 0.1);
        let (bending, rest) = bending(columns, rows, step, &isotropic);
        let x: Vec<V3> = rest
            .iter()
            .map(|p| V3::new(radius * (p.x / radius).sin(), p.y, radius * (1.0 - (p.x / radius).cos())))
            .collect();
        let area = (columns as f64 * step) * (rows as f64 * step);
        let expected = 0.5 * isotropic.bending_weft_nm / (radius * radius) * area;
        let energy = bending.energy(&x);
        assert!((energy / expected - 1.0).abs() < 0.05, "{energy} for {expected}");
    }
}
