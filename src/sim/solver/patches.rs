//! A coarse space for the linear solves: the cloth in patches that move as rigid bodies.
//!
//! What block-Jacobi is slow at are motions of many vertices together: a sleeve that swings, a fold that travels. Cloth
//! resists those hardly at all where each patch of it moves rigidly, so rigid motions of patches, six degrees of freedom each,
//! span them well (smoothed aggregation's near null space [Vanek 1996]), without smoothing: what remains at the borders of
//! patches is local, and block-Jacobi's. The stiffness between patches is small enough to be factorised ([`super::blocks`]), and a
//! factor serves for several steps.

use nalgebra::{Matrix3, Matrix6, Vector6};

use super::blocks::{Dense, Lanes, Numeric, Symbolic};
use super::operator::Operator;
use super::rows::{self, Quad};
use crate::geom::V3;

/// Least distance, in edges, between the middles of patches.
const APART: usize = 4;
/// What is added to the stiffness of a patch against rotation, as a share of that against translation times its radius
/// squared: the vertices of a patch may lie on a line.
const REGULARISATION: f64 = 1e-6;

/// The patches of a cloth and how they couple.
pub struct Patches {
    /// Patch of each vertex.
    of: Vec<usize>,
    count: usize,
    /// Pairs of patches, the smaller first, a patch with itself too.
    pairs: Vec<[usize; 2]>,
    /// Pair of patches of each membrane pair, bending pair and spring.
    slots: [Vec<usize>; 3],
    symbolic: Symbolic,
}

impl Patches {
    /// Divides a cloth into patches.
    #[must_use]
    pub fn new(operator: &Operator) -> Self {
        let springs: Vec<[usize; 2]> = operator.springs.iter().map(|s| s.0).collect();
        let lists = [operator.membrane_pairs.pairs(), operator.bending_pairs.pairs(), &springs];
        let (of, count) = operator.membrane_pairs.divide(operator.diagonal.len(), APART);
        let coupled = |&[i, j]: &[usize; 2]| [of[i].min(of[j]), of[i].max(of[j])];
        let mut pairs: Vec<[usize; 2]> = (0..count).map(|a| [a, a]).collect();
        pairs.extend(lists.iter().flat_map(|list| list.iter().map(coupled)));
        pairs.sort_unstable();
        pairs.dedup();
        let slot = |pair: &[usize; 2]| pairs.binary_search(&coupled(pair)).expect("the pair was just collected");
        let slots = lists.map(|list| list.iter().map(slot).collect());
        let symbolic = Symbolic::new(count, &pairs);
        Self { of, count, pairs, slots, symbolic }
    }

    /// The stiffness between the patches, factorised, with the cloth at `x`; `diagonal` are the diagonal blocks of the operator.
    #[must_use]
    pub fn factorise(&self, operator: &Operator, diagonal: &[Matrix3<f64>], x: &[V3]) -> Coarse {
        let arms = self.arms(x);
        let mut blocks = vec![Matrix6::zeros(); self.pairs.len()];
        let mut add = |slot: usize, i: usize, j: usize, m: &Matrix3<f64>| {
            let swapped = self.of[i] > self.of[j];
            let block =
                if swapped { between(&arms[j], &m.transpose(), &arms[i]) } else { between(&arms[i], m, &arms[j]) };
            blocks[slot] += block;
            if self.of[i] == self.of[j] {
                blocks[slot] += block.transpose();
            }
        };
        let [membrane, bending, springs] = &self.slots;
        for ((&[i, j], &slot), m) in operator.membrane_pairs.pairs().iter().zip(membrane).zip(&operator.membrane) {
            add(slot, i, j, m);
        }
        for ((&[i, j], &slot), q) in operator.bending_pairs.pairs().iter().zip(bending).zip(operator.bending) {
            add(slot, i, j, &Matrix3::from_diagonal_element(*q));
        }
        for ((&[i, j], k), &slot) in operator.springs.iter().map(|(p, k)| (p, k)).zip(springs) {
            add(slot, i, j, &Matrix3::from_diagonal_element(-k));
        }
        let own: Vec<usize> = (0..self.count).map(|a| self.pairs.partition_point(|p| *p < [a, a])).collect();
        for ((a, arm), block) in self.of.iter().zip(&arms).zip(diagonal) {
            blocks[own[*a]] += between(arm, block, arm);
        }
        self.add_contacts(operator, &arms, &mut blocks);
        for &slot in &own {
            regularise(&mut blocks[slot]);
        }
        let blocks: Vec<Dense> = blocks.into_iter().map(Into::into).collect();
        Coarse { arms: arms.iter().map(rows::quad).collect(), factor: self.symbolic.factorise(&blocks) }
    }

    /// From the middle of its patch to each vertex.
    fn arms(&self, x: &[V3]) -> Vec<V3> {
        let mut sums = vec![(V3::zeros(), 0.0); self.count];
        for (a, p) in self.of.iter().zip(x) {
            sums[*a].0 += p;
            sums[*a].1 += 1.0;
        }
        self.of.iter().zip(x).map(|(a, p)| p - sums[*a].0 / sums[*a].1).collect()
    }

    /// Couplings of contacts between patches that are coupled anyhow; the diagonal blocks have the rest.
    fn add_contacts(&self, operator: &Operator, arms: &[V3], blocks: &mut [Matrix6<f64>]) {
        for contact in &operator.contacts {
            let wrench = |k: usize| {
                let (v, w) = (contact.vertices[k], contact.normal * contact.weights[k]);
                let turn = arms[v].cross(&w);
                Vector6::new(w.x, w.y, w.z, turn.x, turn.y, turn.z)
            };
            for k in 0..4 {
                for l in (0..4).filter(|l| *l != k) {
                    let [a, b] = [k, l].map(|k| self.of[contact.vertices[k]]);
                    if let Ok(slot) = self.pairs.binary_search(&[a, b]) {
                        blocks[slot] += wrench(k) * wrench(l).transpose() * contact.stiffness;
                    }
                }
            }
        }
    }

    /// Adds to `z` the rigid motions of the patches that the forces `r` cause.
    pub fn add(&self, coarse: &Coarse, r: &[Quad<f32>], z: &mut [Quad<f32>]) {
        let Some(factor) = &coarse.factor else { return };
        let mut motions: Vec<Lanes> = vec![Lanes::default(); self.count];
        for ((a, arm), r) in self.of.iter().zip(&coarse.arms).zip(r) {
            let turn = cross(arm, r);
            let wrench = &mut motions[*a];
            for k in 0..3 {
                wrench[k] += r[k];
                wrench[3 + k] += turn[k];
            }
        }
        self.symbolic.solve(factor, &mut motions, &mut vec![Lanes::default(); self.count]);
        for ((a, arm), z) in self.of.iter().zip(&coarse.arms).zip(z) {
            let motion = &motions[*a];
            let moved = cross(&[motion[3], motion[4], motion[5], 0.0], arm);
            for k in 0..3 {
                z[k] += motion[k] + moved[k];
            }
        }
    }
}

/// A factorised stiffness between patches.
pub struct Coarse {
    /// From the middle of its patch to each vertex.
    arms: Vec<Quad<f32>>,
    /// `None` where the stiffness was not positive definite.
    factor: Option<Numeric>,
}

fn cross(a: &Quad<f32>, b: &Quad<f32>) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `P^T m Q` for the rigid motions `P = [I, -[p]x]`, `Q = [I, -[q]x]` of two vertices at arms `p` and `q`.
fn between(p: &V3, m: &Matrix3<f64>, q: &V3) -> Matrix6<f64> {
    let [p, q] = [p.cross_matrix(), q.cross_matrix()];
    let (pm, mq) = (p * m, m * q);
    let mut block = Matrix6::zeros();
    block.fixed_view_mut::<3, 3>(0, 0).copy_from(m);
    block.fixed_view_mut::<3, 3>(0, 3).copy_from(&-mq);
    block.fixed_view_mut::<3, 3>(3, 0).copy_from(&pm);
    block.fixed_view_mut::<3, 3>(3, 3).copy_from(&(-p * mq));
    block
}

fn regularise(block: &mut Matrix6<f64>) {
    let [translation, rotation] = [0, 3].map(|from| (from..from + 3).map(|k| block[(k, k)]).sum::<f64>());
    for k in 0..3 {
        block[(k, k)] += REGULARISATION * translation;
        block[(k + 3, k + 3)] += REGULARISATION * (rotation + 1e-6 * translation);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{DistanceField, shapes};
    use crate::sim::cloth::Cloth;
    use crate::sim::contact::{BodyContact, ContactParams};
    use crate::sim::laboratory::{self, sheets::sheet};
    use crate::sim::sewing::unsewn;
    use crate::sim::solver::{System, linear, pcg::PcgParams, rows};
    use crate::sim::testing::fabric;

    #[test]
    fn the_stiffness_between_patches_is_that_of_their_rigid_motions() {
        let garment = laboratory::garment(sheet(12, 9, 0.02));
        let cloth = Cloth::new(&garment, &fabric(), unsewn(&garment)).expect("sound");
        let x: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x, p.y, 0.3 * p.x * p.x)).collect();
        let field = DistanceField::build(&shapes::sphere(0.06, 24), 0.006).expect("a closed sphere");
        let mut system = System::new(&cloth, BodyContact::new(&field, ContactParams::default(), &cloth.areas), None);
        let (_, mut operator) = system.assemble(&x, None);
        for (v, block) in operator.diagonal.iter_mut().enumerate() {
            *block += Matrix3::identity() * (1.0 + v as f64);
        }
        let patches = Patches::new(&operator);
        let coarse = patches.factorise(&operator, &operator.diagonal_blocks(), &x);
        // Rigid motions q give forces K P q; of these, the patches must find q again.
        let q = |a: usize, k: usize| (1.0 + (7 * a + 3 * k) as f64).sin() * if k < 3 { 1.0 } else { 20.0 };
        let moved: Vec<Quad<f64>> = patches
            .of
            .iter()
            .zip(&coarse.arms)
            .map(|(&a, arm)| {
                let [t, w] = [0, 3].map(|from| V3::new(q(a, from), q(a, from + 1), q(a, from + 2)));
                rows::quad(&(t + w.cross(&V3::from_fn(|k, _| f64::from(arm[k])))))
            })
            .collect();
        let mut forces = vec![[0.0; 4]; x.len()];
        rows::Rows::<f64>::new(&operator).apply(&moved, &mut forces);
        let forces: Vec<Quad<f32>> = forces.iter().map(|f| f.map(|c| c as f32)).collect();
        let mut found = vec![[0.0; 4]; x.len()];
        patches.add(&coarse, &forces, &mut found);
        for (found, moved) in found.iter().zip(&moved) {
            for k in 0..3 {
                assert!((f64::from(found[k]) - moved[k]).abs() < 0.01, "{found:?} for {moved:?}");
            }
        }
    }

    #[test]
    fn both_solvers_find_the_same_and_patches_sooner() {
        let garment = laboratory::garment(sheet(30, 30, 0.02));
        let cloth = Cloth::new(&garment, &fabric(), unsewn(&garment)).expect("sound");
        let x: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x, p.y, 0.5 + 0.3 * p.x * p.x)).collect();
        let field = DistanceField::build(&shapes::sphere(0.06, 24), 0.006).expect("a closed sphere");
        let mut system = System::new(&cloth, BodyContact::new(&field, ContactParams::default(), &cloth.areas), None);
        let (forces, mut operator) = system.assemble(&x, None);
        for (block, mass) in operator.diagonal.iter_mut().zip(&cloth.masses) {
            *block += Matrix3::identity() * (mass / 0.01);
        }
        let within = |most: usize, system: &mut System, is_coarse: bool| {
            let params = PcgParams { tolerance: 1e-4, max_iterations: most };
            let mut found = vec![V3::zeros(); x.len()];
            if is_coarse {
                system.linear.solve(&operator, &x, &forces, &mut found, &params);
            } else {
                linear::jacobi(&operator, &forces, &mut found, &params);
            }
            found
        };
        let exact = within(5000, &mut system, false);
        let far = |found: Vec<V3>| {
            let [error, size] = [0.0, 1.0].map(|share: f64| {
                found.iter().zip(&exact).map(|(p, q)| (p * (1.0 - share) - q).norm_squared()).sum::<f64>().sqrt()
            });
            error / size
        };
        let (few, jacobi) = (far(within(40, &mut system, true)), far(within(40, &mut system, false)));
        assert!(far(within(5000, &mut system, true)) < 0.01, "the patches end elsewhere");
        assert!(few < 0.1 * jacobi, "after 40 iterations {few} with patches, {jacobi} without");
    }
}
