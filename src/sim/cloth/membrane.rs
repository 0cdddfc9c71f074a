//! Membrane of constant-strain triangles with an orthotropic St. Venant-Kirchhoff law [T 4.2-4.10]. The moduli of knits
//! rise under stretch ([`law`](super::law)).
//!
//! With `F = Ds Dm^-1` (3 x 2, columns along weft and warp) the Green strain is `E = (F^T F - I)/2`, and `S(E)` is the
//! second Piola-Kirchhoff stress, N/m. The energy of a triangle is `A` times the integral of `S : dE`, J; that is `A/2
//! S : E` for a linear law. The shape gradients `g_i` are the rows of `Dm^-1`, and the first is the negative of their
//! sum. Then the nodal force is `f_i = -A F S g_i`, and the stiffness `K_ij = A (B_i^T C B_j + (g_i . S+ g_j) I)`,
//! where `B_i = dE/dx_i` and `C = dS/dE`. `S+` is `S` without its negative eigenvalues: compression would make the
//! stiffness indefinite. Forces and energy use `S` itself.
//!
//! A step that rotates triangles also stretches them, to second order. At the membrane stiffness of cloth that spurious
//! stress outweighs the true one, and the geometric stiffness at the end of the step would be far too high. So `S+` may
//! be taken from the stress that the last linear solve predicted ([`Membrane::assemble_towards`]), which has no such
//! part. The equilibrium is the same, and is reached in fewer steps [Magisano 2017].

use nalgebra::Matrix2;
use wide::f32x4;

use super::arcs::{Arcs, Bent};
use super::element::{Element, Foreseen};
use super::fours::{Assembly, Compression, Correction, Four};
use super::law::{Orthotropic, Tensor};
use geom::V3;
use linalg::PairList;
use linalg::quad::Block;
use linalg::simd;

#[derive(Clone, Debug)]
pub struct Membrane {
    laws: Vec<Orthotropic>,
    /// Triangles in the garment's order.
    pub elements: Vec<Element>,
    fours: Vec<Four>,
    mixtures: Vec<[u32; 4]>,
    packed: Vec<Orthotropic<[f64; 4]>>,
    /// Vertices that share a triangle.
    pub pairs: PairList,
    /// Indices of each triangle's sides among `pairs`.
    pub sides: Vec<[u32; 3]>,
    /// Empty where sides are taken as chords.
    pub arcs: Arcs,
}

/// Terms for the stiffness of the arcs ([`super::arcs`]).
#[derive(Clone, Debug, Default)]
pub struct Bowed {
    pub bent: Bent,
    /// Tensile part of the tensions conjugate to half of the squared sides, N/m.
    pub tensions: Vec<f64>,
    /// Second derivatives of each triangle's energy by half of its squared sides, N/m3: of each side with itself, then
    /// of the pairs (0, 1), (1, 2), (2, 0).
    pub couplings: Vec<[f32; 6]>,
}

impl Membrane {
    pub fn new(laws: Vec<Orthotropic>, elements: Vec<Element>) -> Self {
        let sides = [[0, 1], [1, 2], [2, 0]];
        let pairs = PairList::new(elements.iter().flat_map(|e| sides.map(|s| s.map(|k| e.vertices()[k]))));
        let with_slots = |element: &Element| {
            let vertices = element.vertices();
            let slots = sides.map(|side| {
                let [i, j] = side.map(|corner| vertices[corner]);
                let slot = pairs.slot(i, j).expect("the pair was just collected");
                (slot << 1) as u32 | u32::from(i > j)
            });
            (*element, slots)
        };
        let with_slots: Vec<(Element, [u32; 3])> = elements.iter().map(with_slots).collect();
        let mut mixtures: Vec<[u32; 4]> = Vec::new();
        let four = |elements: &[(Element, [u32; 3])]| {
            let mixture = [0, 1, 2, 3].map(|lane| elements.get(lane).unwrap_or(&elements[0]).0.law);
            let known = mixtures.iter().position(|known| *known == mixture);
            let number = known.unwrap_or_else(|| {
                mixtures.push(mixture);
                mixtures.len() - 1
            });
            Four::new(elements, number)
        };
        let fours = with_slots.chunks(4).map(four).collect();
        let sides = with_slots.iter().map(|(_, slots)| slots.map(|slot| slot >> 1)).collect();
        let packed = packed(&laws, &mixtures);
        Self { laws, elements, fours, mixtures, packed, pairs, sides, arcs: Arcs::default() }
    }

    pub fn with_laws(self, change: impl Fn(&Orthotropic) -> Orthotropic) -> Self {
        let laws: Vec<Orthotropic> = self.laws.iter().map(change).collect();
        Self { packed: packed(&laws, &self.mixtures), laws, ..self }
    }

    pub fn laws(&self) -> &[Orthotropic] {
        &self.laws
    }

    pub fn law(&self, triangle: usize) -> &Orthotropic {
        &self.laws[self.elements[triangle].law as usize]
    }

    pub fn with_arcs(self, arcs: Arcs) -> Self {
        Self { arcs, ..self }
    }

    pub fn blocks(&self) -> Vec<Block<f32x4>> {
        vec![[f32x4::ZERO; 3]; self.pairs.pairs().len()]
    }

    /// J.
    pub fn energy(&self, x: &[V3]) -> f64 {
        let bent = self.arcs.bent(x);
        simd::dispatch(self.assembly(x, &bent))
    }

    /// Green strain of each element, weft first, arcs included.
    pub fn strains(&self, x: &[V3]) -> Vec<Matrix2<f64>> {
        let bent = self.arcs.bent(x);
        let strain = |(element, sides): (&Element, &[u32; 3])| {
            let f = element.deformation_gradient(x);
            let chords = 0.5 * (f.transpose() * f - Matrix2::identity());
            let [g, h] = element.gradients();
            let gradients = [-g - h, g, h];
            let of_side = |k: usize| {
                let (i, j) = (gradients[k], gradients[(k + 1) % 3]);
                let excess = bent.excess.get(sides[k] as usize).copied().unwrap_or(0.0);
                (i * j.transpose() + j * i.transpose()) * (-0.25 * excess)
            };
            chords + (0..3).map(of_side).sum::<Matrix2<f64>>()
        };
        self.elements.iter().zip(&self.sides).map(strain).collect()
    }

    /// N.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        let bent = self.arcs.bent(x);
        let mut tensions = vec![0.0; bent.excess.len()];
        simd::dispatch(Assembly { forces: Some(forces), tensions: Some(&mut tensions), ..self.assembly(x, &bent) });
        self.arcs.add_forces(&bent, &tensions, forces);
    }

    /// Adds the elastic forces (N) and the off-diagonal stiffness (N/m). Returns the energy (J) and the terms of the
    /// arcs. The geometric part is that of the stresses `predicted`, one for each element, or without them of those at
    /// `x`.
    pub fn assemble(
        &self,
        x: &[V3],
        forces: &mut [V3],
        predicted: Option<&[Tensor]>,
        blocks: &mut [Block<f32x4>],
    ) -> (f64, Bowed) {
        let bent = self.arcs.bent(x);
        let none = vec![0.0; bent.excess.len()];
        let (mut tensions, mut pulls) = (none.clone(), none);
        let mut couplings = Vec::with_capacity(4 * self.fours.len());
        let all = Assembly {
            forces: Some(forces),
            tensions: Some(&mut tensions),
            pulls: Some(&mut pulls),
            blocks: Some(blocks),
            couplings: Some(&mut couplings),
            predicted,
            ..self.assembly(x, &bent)
        };
        let energy = simd::dispatch(all);
        couplings.truncate(self.elements.len());
        self.arcs.add_forces(&bent, &tensions, forces);
        pulls.iter_mut().for_each(|pull| *pull = pull.max(0.0));
        (energy, Bowed { bent, tensions: pulls, couplings })
    }

    fn assembly<'a>(&'a self, x: &'a [V3], bent: &'a Bent) -> Assembly<'a> {
        Assembly {
            laws: &self.packed,
            fours: &self.fours,
            x,
            excess: &bent.excess,
            forces: None,
            tensions: None,
            pulls: None,
            blocks: None,
            couplings: None,
            predicted: None,
        }
    }

    /// Adds a share of the first-order forces (N) of the compressive part of `stresses` along `d`, which the assembled
    /// stiffness leaves out.
    pub fn add_compression(&self, stresses: &[Tensor], d: &[V3], share: f64, forces: &mut [V3]) {
        simd::dispatch(Compression { fours: &self.fours, stresses, d, share, forces });
    }

    /// Assembles the second-order correction of a step from `x` to `x + d`: forces (N) of the stresses at its end in
    /// excess of those that a linear solve at `x` predicts, and the off-diagonal material stiffness at that end, N/m.
    /// Returns the predicted stresses and the terms of the arcs.
    pub fn assemble_towards(
        &self,
        x: &[V3],
        d: &[V3],
        forces: &mut [V3],
        blocks: &mut [Block<f32x4>],
    ) -> (Vec<Foreseen>, Bowed) {
        let mut foreseen = Vec::with_capacity(4 * self.fours.len());
        let mut couplings = Vec::with_capacity(4 * self.fours.len());
        let (laws, fours) = (&self.packed[..], &self.fours[..]);
        let start = self.arcs.bent(x);
        let end: Vec<V3> = x.iter().zip(d).map(|(p, d)| p + d).collect();
        let bent = self.arcs.bent(&end);
        let changes: Vec<f64> = self.arcs.changes(&start, d).iter().map(|half| 2.0 * half).collect();
        let mut tensions = vec![0.0; changes.len()];
        simd::dispatch(Correction {
            laws,
            fours,
            x,
            d,
            excess: [&start.excess, &changes, &bent.excess],
            forces,
            tensions: &mut tensions,
            blocks,
            couplings: &mut couplings,
            foreseen: &mut foreseen,
        });
        foreseen.truncate(self.elements.len());
        couplings.truncate(self.elements.len());
        self.arcs.add_forces(&bent, &tensions, forces);
        tensions.fill(0.0);
        (foreseen, Bowed { bent, tensions, couplings })
    }
}

fn packed(laws: &[Orthotropic], mixtures: &[[u32; 4]]) -> Vec<Orthotropic<[f64; 4]>> {
    mixtures.iter().map(|mixture| Orthotropic::packed(mixture.map(|law| &laws[law as usize]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fabric;
    use crate::fabric::Stretched;
    use crate::laboratory::sheets::{shaken, sheet};
    use crate::testing::{check_forces, fabric};
    use geom::V2;
    use linalg::quad;
    use linalg::simd::{Plain, Simd};

    fn membrane(grain: V2) -> (Membrane, Vec<V3>) {
        membrane_of(&fabric(), grain)
    }

    fn strain(element: &Element, x: &[V3]) -> Tensor {
        let gradient = element.deformation_gradient(x);
        Tensor::of(&(0.5 * (gradient.transpose() * gradient - Matrix2::identity())))
    }

    fn knit() -> Fabric {
        let stretched = Stretched { stretch: 0.17, membrane_warp_n_m: 4000.0, membrane_weft_n_m: 1500.0 };
        Fabric { stretched: Some(stretched), ..fabric() }
    }

    fn membrane_of(fabric: &Fabric, grain: V2) -> (Membrane, Vec<V3>) {
        let (rest, triangles) = sheet(3, 3, 0.02);
        let elements = triangles.iter().map(|t| Element::new(*t, t.map(|v| rest[v]), grain).expect("has area"));
        let membrane = Membrane::new(vec![Orthotropic::of(fabric)], elements.collect());
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
    fn every_machine_finds_the_same() {
        let (membrane, flat) = membrane_of(&knit(), V2::new(0.6, 0.8));
        let x = shaken(&flat, 4e-3, 1);
        let [mut forces, mut best_forces] = [0, 1].map(|_| vec![V3::zeros(); x.len()]);
        let [mut blocks, mut best_blocks] = [0, 1].map(|_| membrane.blocks());
        let bent = membrane.arcs.bent(&x);
        let parts = Assembly { forces: Some(&mut forces), blocks: Some(&mut blocks), ..membrane.assembly(&x, &bent) };
        let energy = Plain.run(parts);
        let (best, _) = membrane.assemble(&x, &mut best_forces, None, &mut best_blocks);
        assert!((energy - best).abs() < 1e-12 * best, "{energy} and {best}");
        let size = forces.iter().map(V3::amax).fold(0.0, f64::max);
        for (plain, best) in forces.iter().zip(&best_forces) {
            assert!((plain - best).amax() < 1e-12 * size, "{plain} and {best}");
        }
        let [blocks, best_blocks] =
            [blocks, best_blocks].map(|blocks| blocks.iter().map(quad::matrix).collect::<Vec<_>>());
        let size = blocks.iter().map(nalgebra::Matrix::amax).fold(0.0, f64::max);
        for (plain, best) in blocks.iter().zip(&best_blocks) {
            assert!((plain - best).amax() < 1e-6 * size, "{plain} and {best}");
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
        let mut blocks = membrane.blocks();
        let (energy, _) = membrane.assemble(&x, &mut vec![V3::zeros(); x.len()], None, &mut blocks);
        assert_eq!(energy.to_bits(), membrane.energy(&x).to_bits());
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
                let block = quad::matrix(block);
                let expected: V3 = block.column(k).into();
                assert!((column - expected).norm() < 1e-6 * block.norm(), "{column} for {expected}");
            }
        }
    }

    #[test]
    fn what_the_stiffness_leaves_out_is_the_compression() {
        for fabric in [fabric(), knit()] {
            let (membrane, flat) = membrane_of(&fabric, V2::new(0.6, 0.8));
            let x: Vec<V3> = shaken(&flat, 2e-4, 2).iter().map(|p| V3::new(0.9 * p.x, 1.1 * p.y, p.z)).collect();
            let d = shaken(&vec![V3::zeros(); x.len()], 1.0, 3);
            let forces = |h: f64| {
                let moved: Vec<V3> = x.iter().zip(&d).map(|(p, d)| p + d * h).collect();
                let mut forces = vec![V3::zeros(); x.len()];
                membrane.add_forces(&moved, &mut forces);
                forces
            };
            let mut expected = vec![V3::zeros(); x.len()];
            let stresses: Vec<Tensor> =
                membrane.elements.iter().map(|e| membrane.laws[0].stress(strain(e, &x))).collect();
            membrane.add_compression(&stresses, &d, 1.0, &mut expected);
            let left_out = expected.iter().map(V3::norm).fold(0.0, f64::max);
            let mut blocks = membrane.blocks();
            membrane.assemble(&x, &mut vec![V3::zeros(); x.len()], None, &mut blocks);
            for (&[i, j], block) in membrane.pairs.pairs().iter().zip(&blocks) {
                let block = quad::matrix(block);
                expected[i] -= block * (d[j] - d[i]);
                expected[j] -= block.transpose() * (d[i] - d[j]);
            }
            let h = 1e-6;
            let greatest = expected.iter().map(V3::norm).fold(0.0, f64::max);
            assert!(left_out > 1e-3 * greatest, "{left_out} of {greatest}");
            for ((after, before), expected) in forces(h).iter().zip(&forces(-h)).zip(&expected) {
                let change = (after - before) / (2.0 * h);
                assert!((change - expected).norm() < 1e-6 * greatest, "{change} for {expected}");
            }
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
                let (mut forces, mut blocks) = (vec![V3::zeros(); x.len()], membrane.blocks());
                let (predicted, _) = membrane.assemble_towards(&x, &d, &mut forces, &mut blocks);
                let off = |(e, p): (&Element, &Foreseen)| {
                    (membrane.laws[0].stress(strain(e, &end)) - p.after(1.0)).matrix().norm()
                };
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
}
