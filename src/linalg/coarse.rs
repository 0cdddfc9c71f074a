//! Coarse space of the linear solves: patches of the cloth that move as rigid bodies.
//!
//! Block-Jacobi is slow at motions of many vertices together, such as a sleeve that swings or a fold that travels.
//! Cloth hardly resists motions that move each of its patches rigidly. The rigid motions of patches, with six degrees
//! of freedom each, therefore span these well: they are the near null space of smoothed aggregation [Vanek 1996], here
//! without smoothing. The remaining error, at the borders of patches, is local, and block-Jacobi reduces it. The
//! stiffness between patches is small enough to be factorised ([`super::cholesky`]), and one factor serves for several
//! steps.

use std::cmp::Ordering;

use nalgebra::{Matrix3, Matrix6, Vector6};
use wide::f32x4;

use super::cholesky::{Dense, Numeric, Row, Symbolic};
use super::operator::Operator;
use super::pairs::PairList;
use super::quad;
use super::simd::Simd;
use geom::V3;

geom::constants! {
    "linalg.coarse",
    /// Least distance between the centres of patches, in edges. A patch then has about twenty vertices.
    const APART: usize = 4;
    /// As `APART`, in large cloth, where the factor between patches would cost most of a solve.
    const APART_IN_LARGE: usize = 5;
    /// Number of vertices from which cloth is large: the solves between patches of [`APART`] edges then cost more than
    /// the iterations that they save.
    const LARGE: usize = 12_000;
    /// Share of a patch's stiffness (summed over the axes of translation, and over those of rotation) that is added to
    /// each axis. Without it, a patch whose vertices lie on a line could turn about it freely.
    const REGULARISATION: f64 = 1e-6;
}

/// Preconditioned residual `P r` in two parts, which are to be added.
#[derive(Clone, Copy)]
pub struct Correction<'a> {
    pub motions: &'a [Row],
    pub z: &'a [f32x4],
}

/// Patches of a cloth and their couplings.
pub struct CoarseSpace {
    patch_of: Vec<usize>,
    count: usize,
    members: Vec<u32>,
    /// Beginning of each patch in `members`, then the end of the last.
    ends: Vec<usize>,
    /// Coupled patches, the smaller first. Each is coupled with itself as well.
    pairs: PairList,
    /// Index of the pair of patches of each membrane pair, bending pair and spring.
    slots: [Vec<usize>; 3],
    symbolic: Symbolic,
}

impl CoarseSpace {
    pub fn new(operator: &Operator) -> Self {
        let springs: Vec<[usize; 2]> = operator.springs.iter().map(|s| s.0).collect();
        let lists = [operator.membrane_pairs.pairs(), operator.bending_pairs.pairs(), &springs];
        let vertices = operator.diagonal.len();
        let apart = if vertices < LARGE { APART } else { APART_IN_LARGE };
        let (patch_of, count) = operator.membrane_pairs.divide(vertices, apart);
        let coupled = |pair: &[usize; 2]| pair.map(|v| patch_of[v]);
        let own = (0..count).map(|a| [a, a]);
        let pairs = PairList::new(own.chain(lists.iter().flat_map(|list| list.iter().map(coupled))));
        let slot = |pair: &[usize; 2]| {
            let [a, b] = coupled(pair);
            pairs.slot(a, b).expect("the pair was just collected")
        };
        let slots = lists.map(|list| list.iter().map(slot).collect());
        let symbolic = Symbolic::new(count, pairs.pairs());
        let mut members: Vec<u32> = (0..vertices as u32).collect();
        members.sort_by_key(|v| patch_of[*v as usize]);
        let ends = (0..=count).map(|a| members.partition_point(|v| patch_of[*v as usize] < a)).collect();
        Self { patch_of, count, members, ends, pairs, slots, symbolic }
    }

    /// Factorises the stiffness between the patches, with the cloth at `x`. `diagonal` are the diagonal blocks of the
    /// operator.
    pub fn factorise(&self, operator: &Operator, diagonal: &[Matrix3<f64>], x: &[V3]) -> CoarseFactor {
        let arms = self.arms(x);
        let mut blocks = vec![Matrix6::zeros(); self.pairs.pairs().len()];
        let mut add =
            |slot: usize, [i, j]: [usize; 2], block: Matrix6<f64>| match self.patch_of[i].cmp(&self.patch_of[j]) {
                Ordering::Less => blocks[slot] += block,
                Ordering::Greater => blocks[slot] += block.transpose(),
                Ordering::Equal => blocks[slot] += block + block.transpose(),
            };
        let [membrane, bending, springs] = &self.slots;
        for ((&pair, &slot), m) in operator.membrane_pairs.pairs().iter().zip(membrane).zip(&operator.membrane) {
            let [p, q] = pair.map(|v| &arms[v]);
            add(slot, pair, between(p, &quad::matrix(m), q));
        }
        for ((&pair, &slot), k) in operator.bending_pairs.pairs().iter().zip(bending).zip(operator.bending) {
            let [p, q] = pair.map(|v| &arms[v]);
            add(slot, pair, between_alike(p, *k, q));
        }
        for ((pair, k), &slot) in operator.springs.iter().zip(springs) {
            let [p, q] = pair.map(|v| &arms[v]);
            add(slot, *pair, between_alike(p, -k, q));
        }
        let own: Vec<usize> = (0..self.count).filter_map(|a| self.pairs.slot(a, a)).collect();
        for ((a, arm), block) in self.patch_of.iter().zip(&arms).zip(diagonal) {
            blocks[own[*a]] += between(arm, block, arm);
        }
        self.add_contacts(operator, &arms, &mut blocks);
        for &slot in &own {
            regularise(&mut blocks[slot]);
        }
        let blocks: Vec<Dense> = blocks.into_iter().map(Into::into).collect();
        let arms = self.members.iter().map(|v| Arm::new(&arms[*v as usize])).collect();
        CoarseFactor { arms, factor: self.symbolic.factorise(&blocks) }
    }

    /// Vector from the centre of its patch to each vertex.
    fn arms(&self, x: &[V3]) -> Vec<V3> {
        let mut sums = vec![(V3::zeros(), 0.0); self.count];
        for (a, p) in self.patch_of.iter().zip(x) {
            sums[*a].0 += p;
            sums[*a].1 += 1.0;
        }
        self.patch_of.iter().zip(x).map(|(a, p)| p - sums[*a].0 / sums[*a].1).collect()
    }

    /// Adds contacts between patches that are coupled already. Other contacts count in the diagonal blocks only.
    fn add_contacts(&self, operator: &Operator, arms: &[V3], blocks: &mut [Matrix6<f64>]) {
        for contact in &operator.contacts {
            let wrench = |k: usize| {
                let (v, w) = (contact.vertices[k], contact.normal * contact.weights[k]);
                let turn = arms[v].cross(&w);
                Vector6::new(w.x, w.y, w.z, turn.x, turn.y, turn.z)
            };
            for k in 0..4 {
                for l in (0..4).filter(|l| *l != k) {
                    let [a, b] = [k, l].map(|k| self.patch_of[contact.vertices[k]]);
                    // The transposed pair has the same block.
                    if a <= b
                        && let Some(slot) = self.pairs.slot(a, b)
                    {
                        blocks[slot] += wrench(k) * wrench(l).transpose() * contact.stiffness;
                    }
                }
            }
        }
    }

    /// Computes the rigid motions of the patches under the forces `r`. Returns the work of the forces along them.
    #[inline(always)]
    pub fn restrict_and_solve<S: Simd>(
        &self,
        simd: S,
        coarse: &CoarseFactor,
        r: &[f32x4],
        motions: &mut Vec<Row>,
    ) -> f64 {
        motions.clear();
        motions.resize(self.count, Row::default());
        let Some(factor) = &coarse.factor else { return 0.0 };
        for ((members, arms), row) in self.members(coarse).zip(motions.iter_mut()) {
            let (mut force, mut moment) = (f32x4::ZERO, [f32x4::ZERO; 2]);
            for (v, arm) in members.iter().zip(arms) {
                let r = r[*v as usize];
                force += r;
                moment = arm.add_moment(simd, r, moment);
            }
            *row = six([force, moment[0] - moment[1]].map(f32x4::to_array));
        }
        let forces = motions.clone();
        self.symbolic.solve(simd, factor, motions);
        let work = |(force, motion): (&Row, &Row)| -> f32 { force.iter().zip(motion).map(|(f, m)| f * m).sum() };
        forces.iter().zip(motions.iter()).map(|pair| f64::from(work(pair))).sum()
    }

    /// Updates the direction `p = P r + beta p` of states `[p, K p]`.
    #[inline(always)]
    pub fn next_direction<S: Simd>(
        &self,
        simd: S,
        coarse: &CoarseFactor,
        preconditioned: Correction,
        beta: f32x4,
        states: &mut [[f32x4; 2]],
    ) {
        for ((members, arms), [x, y, w, a, b, c]) in self.members(coarse).zip(preconditioned.motions) {
            let shift = f32x4::from([*x, *y, *w, 0.0]);
            let turn = [f32x4::from([*b, *c, *a, 0.0]), f32x4::from([*c, *a, *b, 0.0])];
            for (v, arm) in members.iter().zip(arms) {
                let v = *v as usize;
                let p = &mut states[v][0];
                *p = simd.mul_add(beta, *p, arm.add_motion(simd, turn, preconditioned.z[v] + shift));
            }
        }
    }

    #[inline(always)]
    fn members<'a>(&'a self, coarse: &'a CoarseFactor) -> impl Iterator<Item = (&'a [u32], &'a [Arm])> {
        self.ends.windows(2).map(|ends| (&self.members[ends[0]..ends[1]], &coarse.arms[ends[0]..ends[1]]))
    }
}

/// Vector from the centre of a patch to a vertex, in the cyclic orders (y, z, x) and (z, x, y) of the two terms of a
/// cross product.
#[derive(Clone, Copy)]
struct Arm([f32x4; 2]);

impl Arm {
    fn new(arm: &V3) -> Self {
        let [x, y, z] = [arm.x, arm.y, arm.z].map(|c| c as f32);
        Self([f32x4::from([y, z, x, 0.0]), f32x4::from([z, x, y, 0.0])])
    }

    /// Adds the two terms of the moment `arm x force`; the second is to be subtracted from the first.
    #[inline(always)]
    fn add_moment<S: Simd>(&self, simd: S, force: f32x4, [plus, minus]: [f32x4; 2]) -> [f32x4; 2] {
        let [x, y, z, _] = force.to_array();
        let (from_y, from_z) = (f32x4::from([y, z, x, 0.0]), f32x4::from([z, x, y, 0.0]));
        [simd.mul_add(self.0[0], from_z, plus), simd.mul_add(self.0[1], from_y, minus)]
    }

    /// Adds `turn x arm` to `to`. The rotation is given in the cyclic orders (y, z, x) and (z, x, y).
    #[inline(always)]
    fn add_motion<S: Simd>(&self, simd: S, [from_y, from_z]: [f32x4; 2], to: f32x4) -> f32x4 {
        simd.neg_mul_add(from_z, self.0[0], simd.mul_add(from_y, self.0[1], to))
    }
}

pub struct CoarseFactor {
    /// Patch by patch.
    arms: Vec<Arm>,
    /// `None` if the stiffness is not positive definite.
    factor: Option<Numeric>,
}

#[inline(always)]
fn six([[a, b, c, _], [x, y, z, _]]: [[f32; 4]; 2]) -> Row {
    [a, b, c, x, y, z]
}

/// Coarse block `P^T m Q` of two vertices at `p` and `q` from the centres of their patches, with their rigid motions `P
/// = [I, -[p]x]` and `Q = [I, -[q]x]`.
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

/// [`between`] for a stiffness of `k` in all directions: `-[p]x [q]x = (p.q) I - q p^T`.
fn between_alike(p: &V3, k: f64, q: &V3) -> Matrix6<f64> {
    let dot = p.dot(q);
    #[rustfmt::skip]
    let block = Matrix6::new(
        1.0,   0.0,  0.0,  0.0,             q.z,            -q.y,
        0.0,   1.0,  0.0, -q.z,             0.0,             q.x,
        0.0,   0.0,  1.0,  q.y,            -q.x,             0.0,
        0.0,  -p.z,  p.y,  dot - q.x * p.x, -q.x * p.y,      -q.x * p.z,
        p.z,   0.0, -p.x, -q.y * p.x,       dot - q.y * p.y, -q.y * p.z,
       -p.y,   p.x,  0.0, -q.z * p.x,       -q.z * p.y,      dot - q.z * p.z,
    );
    block * k
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
    use crate::csr::CsrMatrix;
    use crate::operator::Contact4;
    use crate::quad::Quad;
    use crate::simd::{self, Kernel, Plain};
    use wide::f64x4;

    /// Bent sheet, 20 mm apart.
    fn sheet(w: usize, h: usize) -> Vec<V3> {
        let grid = |v: usize| [v % w, v / w].map(|k| 0.02 * k as f64);
        (0..w * h).map(grid).map(|[x, y]| V3::new(x, y, 0.3 * x * x)).collect()
    }

    fn pairs(w: usize, h: usize, apart: usize) -> PairList {
        let across = (0..w * h).filter(|v| v % w + apart < w).map(|v| [v, v + apart]);
        PairList::new(across.chain((0..w * (h - apart)).map(|v| [v, v + apart * w])))
    }

    #[test]
    fn the_stiffness_between_patches_is_that_of_their_rigid_motions() {
        let x = sheet(12, 9);
        let (near, far) = (pairs(12, 9, 1), pairs(12, 9, 2));
        let along = |&[i, j]: &[usize; 2]| {
            let d = (x[j] - x[i]).normalize();
            quad::block(&(d * d.transpose() * -50.0))
        };
        let operator = Operator {
            diagonal: (0..x.len()).map(|v| Matrix3::identity() * (1.0 + v as f64)).collect(),
            membrane_pairs: &near,
            membrane: near.pairs().iter().map(along).collect(),
            bending_pairs: &far,
            bending: &vec![-0.3; far.pairs().len()],
            springs: Vec::new(),
            contacts: vec![Contact4 {
                vertices: [3, 4, 15, 16],
                weights: [0.2, 0.3, 0.5, -1.0],
                normal: V3::z(),
                stiffness: 40.0,
            }],
            arcs: None,
        };
        let patches = CoarseSpace::new(&operator);
        let coarse = patches.factorise(&operator, &operator.diagonal_blocks(), &x);
        // Rigid motions q give forces K P q, from which the patches must recover q.
        let q = |a: usize, k: usize| (1.0 + (7 * a + 3 * k) as f64).sin() * if k < 3 { 1.0 } else { 20.0 };
        let moved: Vec<V3> = patches
            .patch_of
            .iter()
            .zip(patches.arms(&x))
            .map(|(&a, arm)| {
                let [t, w] = [0, 3].map(|from| V3::new(q(a, from), q(a, from + 1), q(a, from + 2)));
                t + w.cross(&arm)
            })
            .collect();
        let mut states: Vec<[f64x4; 2]> = moved.iter().map(|p| [f64x4::from_vector(p), f64x4::ZERO]).collect();
        CsrMatrix::new(&operator).apply(Plain, &mut states);
        let forces: Vec<f32x4> = states.iter().map(|[_, f]| f32x4::from_vector(&f.vector())).collect();
        for found in [simd::dispatch(Answer(&patches, &coarse, &forces)), Plain.run(Answer(&patches, &coarse, &forces))]
        {
            for (found, moved) in found.iter().zip(&moved) {
                assert!((found.vector() - moved).amax() < 0.01, "{found:?} for {moved:?}");
            }
        }
    }

    struct Answer<'a>(&'a CoarseSpace, &'a CoarseFactor, &'a [f32x4]);

    impl Kernel for Answer<'_> {
        type Output = Vec<f32x4>;

        fn run<S: Simd>(self, simd: S) -> Vec<f32x4> {
            let Self(patches, coarse, forces) = self;
            let (z, mut motions) = (vec![f32x4::ZERO; forces.len()], Vec::new());
            let r_dot_z = patches.restrict_and_solve(simd, coarse, forces, &mut motions);
            let mut states = vec![[f32x4::ONE; 2]; forces.len()];
            patches.next_direction(simd, coarse, Correction { motions: &motions, z: &z }, f32x4::ZERO, &mut states);
            let found: Vec<f32x4> = states.iter().map(|[p, _]| *p).collect();
            let work = |(p, f): (&f32x4, &f32x4)| p.vector().dot(&f.vector());
            let expect: f64 = found.iter().zip(forces).map(work).sum();
            assert!((r_dot_z / expect - 1.0).abs() < 1e-4, "{r_dot_z} for {expect}");
            found
        }
    }

    #[test]
    fn a_stiffness_alike_in_all_directions_is_a_stiffness() {
        let (p, q) = (V3::new(1.0, 2.0, -3.0), V3::new(0.5, -0.7, 0.2));
        let expect = between(&p, &Matrix3::from_diagonal_element(1.7), &q);
        assert!((between_alike(&p, 1.7, &q) - expect).amax() < 1e-14);
    }
}
