//! Orthotropic St. Venant-Kirchhoff membrane on constant-strain triangles [T 4.2-4.10].
//!
//! With `F = Ds Dm^-1` (3x2, columns along weft and warp) the Green strain is `E = (F^T F - I)/2`, the second
//! Piola-Kirchhoff stress `S = C : E` and the energy `W = A/2 S : E`. With shape gradients `g_i` (rows of `Dm^-1`, the
//! first minus their sum) the nodal force is `f_i = -A F S g_i` and the stiffness
//! `K_ij = A (B_i^T C B_j + (g_i . S+ g_j) I)`, where `B_i = dE/dx_i` and `S+` is `S` without its negative eigenvalues:
//! a compressed membrane would make the stiffness indefinite. Forces and energy use `S` itself.

use nalgebra::{Matrix2, Matrix3, Matrix3x2};

use crate::geom::{V2, V3};
use crate::sim::Fabric;
use crate::sim::solver::PairList;

/// Membrane matrix in grain axes (1 weft, 2 warp), N/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthotropic {
    /// Weft entry.
    pub c11: f64,
    /// Coupling entry.
    pub c12: f64,
    /// Warp entry.
    pub c22: f64,
    /// Shear: `S12 = shear * 2 E12`.
    pub shear: f64,
}

impl Orthotropic {
    /// Membrane matrix of a fabric.
    #[must_use]
    pub fn of(fabric: &Fabric) -> Self {
        Self {
            c11: fabric.membrane_weft_n_m,
            c12: fabric.membrane_coupling_n_m,
            c22: fabric.membrane_warp_n_m,
            shear: fabric.shear_n_m,
        }
    }

    /// Stress of a strain; both symmetric.
    #[must_use]
    pub fn stress(&self, strain: &Matrix2<f64>) -> Matrix2<f64> {
        let (e11, e22) = (strain[(0, 0)], strain[(1, 1)]);
        let s12 = self.shear * 2.0 * strain[(0, 1)];
        Matrix2::new(self.c11 * e11 + self.c12 * e22, s12, s12, self.c12 * e11 + self.c22 * e22)
    }
}

/// One triangle.
#[derive(Clone, Debug)]
pub struct Element {
    /// Simulated vertices, counter-clockwise.
    pub vertices: [usize; 3],
    /// Rest area, m2.
    pub area: f64,
    /// Gradients of the shape functions in (weft, warp), 1/m.
    pub gradients: [V2; 3],
    /// Slots of the pairs (0,1), (1,2), (2,0), and whether the pair's smaller vertex is the second one.
    slots: [(usize, bool); 3],
}

impl Element {
    /// A triangle with rest corners `rest`; `grain` is the unit warp direction. `None` when the triangle has no area.
    #[must_use]
    pub fn new(vertices: [usize; 3], rest: [V2; 3], grain: V2) -> Option<Self> {
        let weft = V2::new(grain.y, -grain.x);
        let local = rest.map(|p| V2::new(p.dot(&weft), p.dot(&grain)));
        let dm = Matrix2::from_columns(&[local[1] - local[0], local[2] - local[0]]);
        let area = 0.5 * dm.determinant();
        let inverse = dm.try_inverse().filter(|_| area > 0.0)?;
        let (g1, g2) = (inverse.row(0).transpose(), inverse.row(1).transpose());
        Some(Self { vertices, area, gradients: [-g1 - g2, g1, g2], slots: [(0, false); 3] })
    }

    /// Deformation gradient, columns along weft and warp.
    #[must_use]
    pub fn deformation_gradient(&self, x: &[V3]) -> Matrix3x2<f64> {
        let [a, b, c] = self.vertices;
        (x[b] - x[a]) * self.gradients[1].transpose() + (x[c] - x[a]) * self.gradients[2].transpose()
    }

    /// Green strain in (weft, warp).
    #[must_use]
    pub fn strain(&self, x: &[V3]) -> Matrix2<f64> {
        let f = self.deformation_gradient(x);
        (f.transpose() * f - Matrix2::identity()) * 0.5
    }
}

/// The membrane of a garment.
#[derive(Clone, Debug)]
pub struct Membrane {
    /// Material.
    pub material: Orthotropic,
    /// Triangles.
    pub elements: Vec<Element>,
    /// Pairs of vertices that share a triangle.
    pub pairs: PairList,
}

impl Membrane {
    /// Collects the elements of a garment.
    #[must_use]
    pub fn new(material: Orthotropic, mut elements: Vec<Element>) -> Self {
        let sides = [[0, 1], [1, 2], [2, 0]];
        let pairs = PairList::new(elements.iter().flat_map(|e| sides.map(|s| s.map(|k| e.vertices[k]))));
        for element in &mut elements {
            element.slots = sides.map(|[a, b]| {
                let (i, j) = (element.vertices[a], element.vertices[b]);
                (pairs.slot(i, j).expect("the pair was just collected"), i > j)
            });
        }
        Self { material, elements, pairs }
    }

    /// Elastic energy, J.
    #[must_use]
    pub fn energy(&self, x: &[V3]) -> f64 {
        let of = |e: &Element| {
            let strain = e.strain(x);
            0.5 * e.area * self.material.stress(&strain).dot(&strain)
        };
        self.elements.iter().map(of).sum()
    }

    /// Adds the elastic forces (N) to `forces` and, where asked, writes the off-diagonal stiffness blocks (N/m).
    pub fn assemble(&self, x: &[V3], forces: &mut [V3], mut blocks: Option<&mut Vec<Matrix3<f64>>>) {
        if let Some(blocks) = blocks.as_deref_mut() {
            blocks.clear();
            blocks.resize(self.pairs.pairs().len(), Matrix3::zeros());
        }
        for element in &self.elements {
            let f = element.deformation_gradient(x);
            let strain = (f.transpose() * f - Matrix2::identity()) * 0.5;
            let stress = self.material.stress(&strain);
            let first_piola = f * stress * -element.area;
            for k in 0..3 {
                forces[element.vertices[k]] += first_piola * element.gradients[k];
            }
            if let Some(blocks) = blocks.as_deref_mut() {
                self.add_stiffness(element, &f, &stress, blocks);
            }
        }
    }

    fn add_stiffness(&self, element: &Element, f: &Matrix3x2<f64>, stress: &Matrix2<f64>, blocks: &mut [Matrix3<f64>]) {
        let m = &self.material;
        let (f1, f2) = (f.column(0), f.column(1));
        let tension = without_compression(stress);
        let shear_row = element.gradients.map(|g| f2 * g.x + f1 * g.y);
        for (k, &(slot, swapped)) in element.slots.iter().enumerate() {
            let (i, j) = if swapped { ((k + 1) % 3, k) } else { (k, (k + 1) % 3) };
            let (gi, gj) = (element.gradients[i], element.gradients[j]);
            let a = f1 * (m.c11 * gi.x * gj.x) + f2 * (m.c12 * gi.y * gj.x);
            let b = f1 * (m.c12 * gi.x * gj.y) + f2 * (m.c22 * gi.y * gj.y);
            let material = a * f1.transpose() + b * f2.transpose() + shear_row[i] * shear_row[j].transpose() * m.shear;
            let geometric = Matrix3::identity() * gi.dot(&(tension * gj));
            blocks[slot] += (material + geometric) * element.area;
        }
    }
}

/// The positive part of a symmetric 2x2 matrix: negative eigenvalues set to zero.
#[must_use]
pub fn without_compression(s: &Matrix2<f64>) -> Matrix2<f64> {
    let mean = 0.5 * (s[(0, 0)] + s[(1, 1)]);
    let half = 0.5 * (s[(0, 0)] - s[(1, 1)]);
    let radius = half.hypot(s[(0, 1)]);
    let (high, low) = (mean + radius, mean - radius);
    if low >= 0.0 {
        *s
    } else if high <= 0.0 {
        Matrix2::zeros()
    } else {
        // One eigenvalue of each sign: high * (S - low I) / (high - low) projects onto the positive one.
        (s - Matrix2::identity() * low) * (high / (high - low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::testing::{check_forces, fabric, shaken, sheet};

    fn membrane(grain: V2) -> (Membrane, Vec<V3>) {
        let (rest, triangles) = sheet(3, 3, 0.02);
        let elements = triangles.iter().map(|t| Element::new(*t, t.map(|v| rest[v]), grain).expect("has area"));
        let membrane = Membrane::new(Orthotropic::of(&fabric()), elements.collect());
        (membrane, rest.iter().map(|p| V3::new(p.x, p.y, 0.3)).collect())
    }

    #[test]
    fn forces_are_the_energys() {
        let (membrane, flat) = membrane(V2::new(0.6, 0.8));
        let x = shaken(&flat, 4e-3, 1);
        let mut forces = vec![V3::zeros(); x.len()];
        membrane.assemble(&x, &mut forces, None);
        check_forces(|x| membrane.energy(x), &forces, &x, 1e-7, 1e-6);
    }

    #[test]
    fn stiffness_is_the_forces_derivative_under_tension() {
        let (membrane, flat) = membrane(V2::new(0.0, 1.0));
        // Stretched by half both ways: no stress is compressive, so nothing is clamped.
        let x: Vec<V3> = shaken(&flat, 1e-3, 2).iter().map(|p| V3::new(1.5 * p.x, 1.5 * p.y, p.z)).collect();
        let mut blocks = Vec::new();
        membrane.assemble(&x, &mut vec![V3::zeros(); x.len()], Some(&mut blocks));
        let h = 1e-7;
        for (&[i, j], block) in membrane.pairs.pairs().iter().zip(&blocks) {
            for k in 0..3 {
                let force = |d: f64| {
                    let mut moved = x.clone();
                    moved[j][k] += d;
                    let mut forces = vec![V3::zeros(); x.len()];
                    membrane.assemble(&moved, &mut forces, None);
                    forces[i]
                };
                let column = -(force(h) - force(-h)) / (2.0 * h);
                let expected: V3 = block.column(k).into();
                assert!((column - expected).norm() < 1e-4 * block.norm(), "{column} for {expected}");
            }
        }
    }

    #[test]
    fn uniaxial_stretch_has_its_closed_form() {
        // Along the warp by 10 %, sides held: W = c22 E^2 / 2 per area with E = (1.1^2 - 1) / 2.
        let check = |grain: V2, modulus: f64| {
            let (membrane, flat) = membrane(grain);
            let x: Vec<V3> = flat.iter().map(|p| V3::new(p.x, 1.1 * p.y, p.z)).collect();
            let strain = (1.21_f64 - 1.0) / 2.0;
            let expected = 0.5 * modulus * strain * strain * 0.06 * 0.06;
            let energy = membrane.energy(&x);
            assert!((energy - expected).abs() < 1e-12, "{energy} for {expected}");
        };
        check(V2::new(0.0, 1.0), fabric().membrane_warp_n_m);
        check(V2::new(1.0, 0.0), fabric().membrane_weft_n_m);
    }

    #[test]
    fn turning_costs_nothing() {
        let (membrane, flat) = membrane(V2::new(0.0, 1.0));
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0);
        let x: Vec<V3> = flat.iter().map(|p| turn * p + V3::new(1.0, 2.0, 3.0)).collect();
        assert!(membrane.energy(&x) < 1e-20);
    }

    #[test]
    fn compression_is_taken_out_of_a_stress() {
        let check = |s: [f64; 3], expect: [f64; 3]| {
            let got = without_compression(&Matrix2::new(s[0], s[1], s[1], s[2]));
            assert!((got - Matrix2::new(expect[0], expect[1], expect[1], expect[2])).norm() < 1e-12, "{got}");
        };
        check([2.0, 0.0, 3.0], [2.0, 0.0, 3.0]);
        check([-2.0, 0.0, -3.0], [0.0, 0.0, 0.0]);
        check([2.0, 0.0, -3.0], [2.0, 0.0, 0.0]);
        check([0.0, 1.0, 0.0], [0.5, 0.5, 0.5]);
    }

    #[test]
    fn a_triangle_without_area_is_refused() {
        let points = [V2::zeros(), V2::new(1.0, 0.0), V2::new(2.0, 0.0)];
        assert!(Element::new([0, 1, 2], points, V2::new(0.0, 1.0)).is_none());
    }
}
