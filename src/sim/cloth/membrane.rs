//! Orthotropic St. Venant-Kirchhoff membrane on constant-strain triangles [T 4.2-4.10], for knits with moduli that rise under
//! stretch ([`Fibre`]).
//!
//! With `F = Ds Dm^-1` (3x2, columns along weft and warp) the Green strain is `E = (F^T F - I)/2`, the second
//! Piola-Kirchhoff stress `S = C : E` and the energy `W = A/2 S : E`. With shape gradients `g_i` (rows of `Dm^-1`, the
//! first minus their sum) the nodal force is `f_i = -A F S g_i` and the stiffness
//! `K_ij = A (B_i^T C B_j + (g_i . S+ g_j) I)`, where `B_i = dE/dx_i` and `S+` is `S` without its negative eigenvalues:
//! a compressed membrane would make the stiffness indefinite. Forces and energy use `S` itself.
//!
//! A step that turns triangles also stretches them, in second order, and at the stiffness of cloth that spurious stress
//! outweighs the true one: the stiffness at its end would hold the cloth like a drum. So `S+` may be taken from the stress
//! that the last linear solve predicted instead ([`Membrane::foresee`]), which has no such part; the equilibrium is
//! the same, and is reached in fewer steps [Magisano 2017].

use nalgebra::{Matrix2, Matrix3, Matrix3x2};

use crate::geom::{V2, V3};
use crate::sim::Fabric;
use crate::sim::solver::PairList;

/// The law of one direction of the grain: stress against Green strain, N/m.
///
/// Knits stiffen as their loops straighten. Under stretch the secant modulus rises linearly with the strain from its value
/// at rest, through the one measured at a known stretch, as the measurements were interpolated [Wang, O'Brien, Ramamoorthi
/// 2011]; beyond that the stress goes on along its tangent. Compression keeps the modulus at rest. The stress is the
/// derivative of an energy, once continuously differentiable, and its slope never falls below that at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibre {
    /// Modulus at rest, N/m.
    pub rest: f64,
    /// Rise of the secant modulus with Green strain, N/m; 0 for a linear law.
    pub rise: f64,
    /// Green strain up to which it rises.
    pub until: f64,
}

impl Fibre {
    /// A linear law.
    #[must_use]
    pub fn linear(modulus: f64) -> Self {
        Self { rest: modulus, rise: 0.0, until: f64::INFINITY }
    }

    /// A law with secant modulus `rest` at rest and `stretched` at stretch ratio `1 + stretch`.
    #[must_use]
    pub fn stiffening(rest: f64, stretched: f64, stretch: f64) -> Self {
        let until = stretch * (1.0 + 0.5 * stretch);
        Self { rest, rise: (stretched - rest).max(0.0) / until, until }
    }

    /// Stress, N/m.
    #[must_use]
    pub fn stress(&self, strain: f64) -> f64 {
        let within = strain.clamp(0.0, self.until);
        self.rest * strain + self.rise * within * (within + 2.0 * (strain.max(0.0) - within))
    }

    /// Slope of the stress, N/m.
    #[must_use]
    pub fn tangent(&self, strain: f64) -> f64 {
        self.rest + 2.0 * self.rise * strain.clamp(0.0, self.until)
    }

    /// Energy per area, N/m.
    #[must_use]
    pub fn energy(&self, strain: f64) -> f64 {
        let within = strain.clamp(0.0, self.until);
        let beyond = strain.max(0.0) - within;
        let rising = within * (within * within / 3.0 + beyond * (within + beyond));
        0.5 * self.rest * strain * strain + self.rise * rising
    }
}

/// Membrane law in grain axes (1 weft, 2 warp).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthotropic {
    /// Along the weft.
    pub weft: Fibre,
    /// Coupling entry, N/m.
    pub c12: f64,
    /// Along the warp.
    pub warp: Fibre,
    /// Shear: `S12 = shear * 2 E12`, N/m.
    pub shear: f64,
}

impl Orthotropic {
    /// Membrane law of a fabric.
    #[must_use]
    pub fn of(fabric: &Fabric) -> Self {
        Self {
            weft: fabric.weft_law(),
            c12: fabric.membrane_coupling_n_m,
            warp: fabric.warp_law(),
            shear: fabric.shear_n_m,
        }
    }

    /// Stress of a strain; both symmetric.
    #[must_use]
    pub fn stress(&self, strain: &Matrix2<f64>) -> Matrix2<f64> {
        let (e11, e22) = (strain[(0, 0)], strain[(1, 1)]);
        let s12 = self.shear * 2.0 * strain[(0, 1)];
        Matrix2::new(self.weft.stress(e11) + self.c12 * e22, s12, s12, self.c12 * e11 + self.warp.stress(e22))
    }

    /// What a small change of strain adds to the stress.
    #[must_use]
    pub fn tangent(&self, strain: &Matrix2<f64>, change: &Matrix2<f64>) -> Matrix2<f64> {
        let (d11, d22) = (change[(0, 0)], change[(1, 1)]);
        let s12 = self.shear * 2.0 * change[(0, 1)];
        let s11 = self.weft.tangent(strain[(0, 0)]) * d11 + self.c12 * d22;
        let s22 = self.c12 * d11 + self.warp.tangent(strain[(1, 1)]) * d22;
        Matrix2::new(s11, s12, s12, s22)
    }

    /// Energy per area of a strain, N/m.
    #[must_use]
    pub fn energy(&self, strain: &Matrix2<f64>) -> f64 {
        let (e11, e22, e12) = (strain[(0, 0)], strain[(1, 1)], strain[(0, 1)]);
        self.weft.energy(e11) + self.warp.energy(e22) + self.c12 * e11 * e22 + 2.0 * self.shear * e12 * e12
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

    /// The same triangle with its vertices called otherwise, not yet in a membrane.
    #[must_use]
    pub fn renamed(&self, vertices: [usize; 3]) -> Self {
        Self { vertices, ..self.clone() }
    }

    /// What has become of a unit length of weft and of warp: the columns of the deformation gradient.
    fn fibres(&self, x: &[V3]) -> [V3; 2] {
        let [a, b, c] = self.vertices;
        let (p, q) = (x[b] - x[a], x[c] - x[a]);
        let [_, g, h] = self.gradients;
        [p * g.x + q * h.x, p * g.y + q * h.y]
    }

    /// Deformation gradient, columns along weft and warp.
    #[must_use]
    pub fn deformation_gradient(&self, x: &[V3]) -> Matrix3x2<f64> {
        Matrix3x2::from_columns(&self.fibres(x))
    }

    /// Green strain in (weft, warp).
    #[must_use]
    pub fn strain(&self, x: &[V3]) -> Matrix2<f64> {
        green(&self.fibres(x))
    }

    fn add_forces(&self, [weft, warp]: &[V3; 2], stress: &Matrix2<f64>, forces: &mut [V3]) {
        // The first Piola-Kirchhoff stress, by columns.
        let s = stress * -self.area;
        let (p, q) = (weft * s[(0, 0)] + warp * s[(1, 0)], weft * s[(0, 1)] + warp * s[(1, 1)]);
        for (v, g) in self.vertices.iter().zip(&self.gradients) {
            forces[*v] += p * g.x + q * g.y;
        }
    }
}

/// Green strain of what has become of weft and warp.
fn green([weft, warp]: &[V3; 2]) -> Matrix2<f64> {
    let shear = 0.5 * weft.dot(warp);
    Matrix2::new(0.5 * (weft.norm_squared() - 1.0), shear, shear, 0.5 * (warp.norm_squared() - 1.0))
}

/// Stress of an element, and what a displacement adds to it in first order, N/m.
#[derive(Clone, Copy, Debug)]
pub struct Foreseen {
    /// Stress before.
    pub stress: Matrix2<f64>,
    /// What the displacement adds.
    pub change: Matrix2<f64>,
}

impl Foreseen {
    /// Stress after a share of the displacement.
    #[must_use]
    pub fn after(&self, share: f64) -> Matrix2<f64> {
        self.stress + self.change * share
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
            e.area * self.material.energy(&strain)
        };
        self.elements.iter().map(of).sum()
    }

    /// Adds the elastic forces, N.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        for element in &self.elements {
            let f = element.fibres(x);
            let stress = self.material.stress(&green(&f));
            element.add_forces(&f, &stress, forces);
        }
    }

    /// Adds the elastic forces (N) and returns the off-diagonal stiffness blocks (N/m); their geometric part is that of
    /// the stresses `predicted`, one an element, or without them of the stresses at `x`.
    pub fn assemble(&self, x: &[V3], forces: &mut [V3], predicted: Option<&[Matrix2<f64>]>) -> Vec<Matrix3<f64>> {
        let mut blocks = vec![Matrix3::zeros(); self.pairs.pairs().len()];
        for (index, element) in self.elements.iter().enumerate() {
            let f = element.fibres(x);
            let strain = green(&f);
            let stress = self.material.stress(&strain);
            element.add_forces(&f, &stress, forces);
            self.add_stiffness(element, &f, &strain, predicted.map_or(&stress, |all| &all[index]), &mut blocks);
        }
        blocks
    }

    /// What a linear solve at `x` foresees of a displacement `d` in each element.
    #[must_use]
    pub fn foresee(&self, x: &[V3], d: &[V3]) -> Vec<Foreseen> {
        let of = |element: &Element| {
            let (f, moved) = (element.fibres(x), element.fibres(d));
            let strain = green(&f);
            let shear = 0.5 * (f[0].dot(&moved[1]) + f[1].dot(&moved[0]));
            let change = Matrix2::new(f[0].dot(&moved[0]), shear, shear, f[1].dot(&moved[1]));
            Foreseen { stress: self.material.stress(&strain), change: self.material.tangent(&strain, &change) }
        };
        self.elements.iter().map(of).collect()
    }

    /// Adds the forces (N) that would bring the stresses at `x` to those foreseen, and returns the off-diagonal
    /// blocks of the stiffness that stretching alone has there, N/m.
    pub fn assemble_towards(&self, x: &[V3], foreseen: &[Foreseen], forces: &mut [V3]) -> Vec<Matrix3<f64>> {
        let mut blocks = vec![Matrix3::zeros(); self.pairs.pairs().len()];
        for (element, foreseen) in self.elements.iter().zip(foreseen) {
            let f = element.fibres(x);
            let strain = green(&f);
            element.add_forces(&f, &(self.material.stress(&strain) - foreseen.after(1.0)), forces);
            self.add_stiffness(element, &f, &strain, &Matrix2::zeros(), &mut blocks);
        }
        blocks
    }

    fn add_stiffness(
        &self,
        element: &Element,
        [weft, warp]: &[V3; 2],
        strain: &Matrix2<f64>,
        stress: &Matrix2<f64>,
        blocks: &mut [Matrix3<f64>],
    ) {
        let m = &self.material;
        let area = element.area;
        let [c11, c12, c22] = [m.weft.tangent(strain[(0, 0)]), m.c12, m.warp.tangent(strain[(1, 1)])].map(|c| c * area);
        let tension = without_compression(stress) * area;
        let sheared = element.gradients.map(|g| warp * g.x + weft * g.y);
        for (k, &(slot, swapped)) in element.slots.iter().enumerate() {
            let (i, j) = if swapped { ((k + 1) % 3, k) } else { (k, (k + 1) % 3) };
            let (gi, gj) = (element.gradients[i], element.gradients[j]);
            let a = weft * (c11 * gi.x * gj.x) + warp * (c12 * gi.y * gj.x);
            let b = weft * (c12 * gi.x * gj.y) + warp * (c22 * gi.y * gj.y);
            let c = sheared[i] * (m.shear * area);
            let geometric = gi.dot(&(tension * gj));
            let block = &mut blocks[slot];
            for column in 0..3 {
                let sum = a * weft[column] + b * warp[column] + c * sheared[j][column];
                for row in 0..3 {
                    block[(row, column)] += sum[row];
                }
                block[(column, column)] += geometric;
            }
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
    use crate::sim::fabric::Stretched;
    use crate::sim::laboratory::sheets::{shaken, sheet};
    use crate::sim::testing::{check_forces, fabric};

    fn membrane(grain: V2) -> (Membrane, Vec<V3>) {
        membrane_of(&fabric(), grain)
    }

    /// A fabric that stiffens like a knit.
    fn knit() -> Fabric {
        let stretched = Stretched { stretch: 0.17, membrane_warp_n_m: 4000.0, membrane_weft_n_m: 1500.0 };
        Fabric { stretched: Some(stretched), ..fabric() }
    }

    fn membrane_of(fabric: &Fabric, grain: V2) -> (Membrane, Vec<V3>) {
        let (rest, triangles) = sheet(3, 3, 0.02);
        let elements = triangles.iter().map(|t| Element::new(*t, t.map(|v| rest[v]), grain).expect("has area"));
        let membrane = Membrane::new(Orthotropic::of(fabric), elements.collect());
        (membrane, rest.iter().map(|p| V3::new(p.x, p.y, 0.3)).collect())
    }

    #[test]
    fn forces_are_the_energys() {
        for fabric in [fabric(), knit()] {
            let (membrane, flat) = membrane_of(&fabric, V2::new(0.6, 0.8));
            let x = shaken(&flat, 4e-3, 1);
            let mut forces = vec![V3::zeros(); x.len()];
            membrane.add_forces(&x, &mut forces);
            check_forces(|x| membrane.energy(x), &forces, &x, 1e-7, 1e-6);
        }
    }

    #[test]
    fn stiffness_is_the_forces_derivative_under_tension() {
        for fabric in [fabric(), knit()] {
            // Stretched by a tenth and by half: no stress is compressive, so nothing is clamped.
            check_stiffness(&fabric, 1.1);
            check_stiffness(&fabric, 1.5);
        }
    }

    fn check_stiffness(fabric: &Fabric, stretch: f64) {
        let (membrane, flat) = membrane_of(fabric, V2::new(0.0, 1.0));
        let x: Vec<V3> = shaken(&flat, 2e-4, 2).iter().map(|p| V3::new(stretch * p.x, stretch * p.y, p.z)).collect();
        let blocks = membrane.assemble(&x, &mut vec![V3::zeros(); x.len()], None);
        let h = 1e-6;
        for (&[i, j], block) in membrane.pairs.pairs().iter().zip(&blocks) {
            for k in 0..3 {
                let force = |d: f64| {
                    let mut moved = x.clone();
                    moved[j][k] += d;
                    let mut forces = vec![V3::zeros(); x.len()];
                    membrane.add_forces(&moved, &mut forces);
                    forces[i]
                };
                let column = -(force(h) - force(-h)) / (2.0 * h);
                let expected: V3 = block.column(k).into();
                assert!((column - expected).norm() < 1e-6 * block.norm(), "{column} for {expected}");
            }
        }
    }

    #[test]
    fn a_stiffening_law_goes_through_what_was_measured_and_is_its_energys_derivative() {
        // The warp of the gray interlock: 68.95 N/m at rest, 811.7 N/m at 17 % stretch.
        let law = Fibre::stiffening(68.95, 811.7, 0.17);
        let strain = |stretch: f64| stretch * (1.0 + 0.5 * stretch);
        assert!((law.stress(strain(0.17)) / strain(0.17) - 811.7).abs() < 1e-9);
        assert!((law.tangent(0.0) - 68.95).abs() < 1e-12 && (law.stress(-0.1) + 6.895).abs() < 1e-12);
        let h = 1e-6;
        let scale = law.stress(0.1);
        for e in [-0.2, -1e-3, 1e-3, 0.05, strain(0.17) - 2.0 * h, strain(0.17) + 2.0 * h, 0.4] {
            let slope = (law.energy(e + h) - law.energy(e - h)) / (2.0 * h);
            assert!((slope - law.stress(e)).abs() < 1e-6 * scale, "stress at {e}");
            let slope = (law.stress(e + h) - law.stress(e - h)) / (2.0 * h);
            assert!((slope / law.tangent(e) - 1.0).abs() < 1e-6, "tangent at {e}");
        }
    }

    #[test]
    fn a_predicted_stress_is_the_true_one_to_first_order() {
        for fabric in [fabric(), knit()] {
            let (membrane, flat) = membrane_of(&fabric, V2::new(0.6, 0.8));
            let x: Vec<V3> = shaken(&flat, 1e-3, 5).iter().map(|p| p * 1.1).collect();
            let error = |size: f64| {
                let end = shaken(&x, size, 6);
                let d: Vec<V3> = end.iter().zip(&x).map(|(p, q)| p - q).collect();
                let predicted = membrane.foresee(&x, &d);
                let off =
                    |(e, p): (&Element, &Foreseen)| (membrane.material.stress(&e.strain(&end)) - p.after(1.0)).norm();
                membrane.elements.iter().zip(&predicted).map(off).fold(0.0, f64::max)
            };
            // A tenth of the displacement leaves a hundredth of the error.
            let ratio = error(1e-5) / error(1e-6);
            assert!((ratio - 100.0).abs() < 10.0, "{ratio}");
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
