//! A stiffness in compressed sparse rows, for the product of conjugate gradients.
//!
//! Each coupling is stored once, in the row of its smaller vertex, and serves both vertices: that moves fewer bytes
//! than a copy in each row, and memory limits the speed for a large cloth. Blocks are applied to differences of
//! displacements, because the large parts of membrane and bending that a common displacement causes
//! cancel only nearly in single precision.

use std::borrow::Cow;

use super::operator::{ArcStiffness, Contact4, Operator};
use super::pairs::{RowCursor, Upper};
use super::quad::{self, Block, Quad};
use super::simd::{Kernel, Simd};

/// An [`Operator`] in compressed rows.
pub struct CsrMatrix<'a, Q: Quad> {
    diagonal: Vec<Block<Q>>,
    membrane: &'a Upper,
    blocks: Cow<'a, [Block<Q>]>,
    bending: &'a Upper,
    entries: Vec<Q::Scalar>,
    springs: Vec<([usize; 2], Q)>,
    contacts: Vec<Contact<Q>>,
    arcs: Option<Arcs<'a, Q>>,
}

/// An [`ArcStiffness`] in the precision of the solve.
struct Arcs<'a, Q: Quad> {
    stiffness: &'a ArcStiffness<'a>,
    chords: Vec<Q>,
    slopes: Vec<Q>,
    drawn: Vec<Q::Scalar>,
}

/// [`Contact4`] whose direction is scaled by the root of its stiffness.
struct Contact<Q> {
    vertices: [usize; 4],
    weights: [Q; 4],
    along: Q,
}

impl<'a, Q: Quad> CsrMatrix<'a, Q> {
    pub fn new(operator: &'a Operator) -> Self {
        let contact = |c: &Contact4| Contact {
            vertices: c.vertices,
            weights: c.weights.map(Q::spread),
            along: Q::from_vector(&(c.normal * c.stiffness.sqrt())),
        };
        Self {
            diagonal: operator.diagonal.iter().map(quad::block).collect(),
            membrane: operator.membrane_pairs.upper(),
            blocks: Q::blocks(&operator.membrane),
            bending: operator.bending_pairs.upper(),
            entries: operator.bending.iter().map(|q| Q::scalar(*q)).collect(),
            springs: operator.springs.iter().map(|(pair, k)| (*pair, Q::spread(*k))).collect(),
            contacts: operator.contacts.iter().map(contact).collect(),
            arcs: operator.arcs.as_ref().map(Arcs::new),
        }
    }

    /// Computes `y = K x` for states `[x, y]`. Both lie side by side because they are read together.
    #[inline(always)]
    pub fn apply<S: Simd>(&self, simd: S, states: &mut [[Q; 2]]) {
        simd.run(Product { rows: self, states });
    }

    #[inline(always)]
    fn product<S: Simd>(&self, simd: S, states: &mut [[Q; 2]]) {
        states.iter_mut().for_each(|[_, y]| *y = Q::ZERO);
        let mut membrane = RowCursor::new(self.membrane, &self.blocks);
        let mut bending = RowCursor::new(self.bending, &self.entries);
        for (i, diagonal) in self.diagonal.iter().enumerate() {
            let [here, mut force] = states[i];
            let mut rows = diagonal.map(|row| row * here);
            for (j, block) in membrane.next_row() {
                let [x, y] = &mut states[j];
                let difference = *x - here;
                for (row, entries) in rows.iter_mut().zip(block) {
                    *row = entries.mul_add_on(difference, *row, simd);
                }
                for (row, along) in block.iter().zip(quad::spread_out(difference)) {
                    *y = row.neg_mul_add_on(along, *y, simd);
                }
            }
            for (j, entry) in bending.next_row() {
                let [x, y] = &mut states[j];
                let (difference, entry) = (*x - here, Q::splat(*entry));
                force = difference.mul_add_on(entry, force, simd);
                *y = difference.neg_mul_add_on(entry, *y, simd);
            }
            states[i][1] = force + Q::totals(rows);
        }
        for (pair, stiffness) in &self.springs {
            let pull = (states[pair[0]][0] - states[pair[1]][0]) * *stiffness;
            states[pair[0]][1] += pull;
            states[pair[1]][1] -= pull;
        }
        for contact in &self.contacts {
            contact.apply(states);
        }
        if let Some(arcs) = &self.arcs {
            arcs.apply(simd, states);
        }
    }
}

impl<'a, Q: Quad> Arcs<'a, Q> {
    fn new(stiffness: &'a ArcStiffness<'a>) -> Self {
        Self {
            stiffness,
            chords: stiffness.chords.iter().map(Q::from_vector).collect(),
            slopes: stiffness.slopes.iter().map(Q::from_vector).collect(),
            drawn: stiffness.drawn.iter().map(|k| Q::scalar(*k)).collect(),
        }
    }

    #[inline(always)]
    fn apply<S: Simd>(&self, simd: S, states: &mut [[Q; 2]]) {
        let count = self.slopes.len();
        let mut bends = vec![Q::ZERO; count];
        // Change of half of each squared arc length: by curvature alone, and by curvature and chord. Then the tension
        // that each change causes.
        let mut grown = vec![[0.0_f32; 2]; count];
        let mut tensions = vec![[0.0_f32; 2]; count];
        for (side, &[i, j]) in self.stiffness.pairs.pairs().iter().enumerate() {
            let bend = self.stiffness.stencils.sum_of(simd, side, states);
            bends[side] = bend;
            let by_bend = (self.slopes[side] * bend).total() as f32;
            let by_chord = (self.chords[side] * (states[j][0] - states[i][0])).total() as f32;
            grown[side] = [by_bend, by_bend + by_chord];
        }
        for (sides, couplings) in self.stiffness.triangles.iter().zip(&self.stiffness.couplings) {
            let [a, b, c] = sides.map(|side| side as usize);
            let [aa, bb, cc, ab, bc, ca] = *couplings;
            for k in 0..2 {
                let (x, y, z) = (grown[a][k], grown[b][k], grown[c][k]);
                // In this order the sums of a mirrored triangle, whose sides come in the opposite order, are the same
                // to the bit.
                tensions[a][k] += (aa * x + ca * z) + ab * y;
                tensions[b][k] += (ab * x + bc * z) + bb * y;
                tensions[c][k] += (cc * z + ca * x) + bc * y;
            }
        }
        for (side, &[i, j]) in self.stiffness.pairs.pairs().iter().enumerate() {
            let [by_bend, by_all] = tensions[side];
            let pull = self.chords[side] * Q::spread_single(by_bend);
            states[i][1] -= pull;
            states[j][1] += pull;
            let push = self.slopes[side] * Q::spread_single(by_all);
            bends[side] = bends[side].mul_add_on(Q::splat(self.drawn[side]), push, simd);
        }
        for (v, [_, force]) in states.iter_mut().enumerate() {
            *force += self.stiffness.stencils.column_sum(simd, v, &bends);
        }
    }
}

struct Product<'a, 'b, Q: Quad> {
    rows: &'a CsrMatrix<'b, Q>,
    states: &'a mut [[Q; 2]],
}

impl<Q: Quad> Kernel for Product<'_, '_, Q> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        self.rows.product(simd, self.states);
    }
}

impl<Q: Quad> Contact<Q> {
    #[inline(always)]
    fn apply(&self, states: &mut [[Q; 2]]) {
        let mut moved = Q::ZERO;
        for (v, weight) in self.vertices.iter().zip(&self.weights) {
            moved += states[*v][0] * *weight;
        }
        let force = self.along * Q::spread((moved * self.along).total());
        for (v, weight) in self.vertices.iter().zip(&self.weights) {
            states[*v][1] += force * *weight;
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;
    use wide::{f32x4, f64x4};

    use super::*;
    use crate::PairList;
    use crate::simd::{self, Plain};
    use geom::V3;

    fn expected(operator: &Operator, x: &[V3]) -> Vec<V3> {
        let mut y = operator.contact_forces(x);
        let mut couple = |[i, j]: [usize; 2], block: Matrix3<f64>| {
            y[i] += block * (x[j] - x[i]);
            y[j] += block.transpose() * (x[i] - x[j]);
        };
        for (pair, block) in operator.membrane_pairs.pairs().iter().zip(&operator.membrane) {
            couple(*pair, quad::matrix(block));
        }
        for (pair, entry) in operator.bending_pairs.pairs().iter().zip(operator.bending) {
            couple(*pair, Matrix3::identity() * *entry);
        }
        for (pair, stiffness) in &operator.springs {
            couple(*pair, -Matrix3::identity() * *stiffness);
        }
        y
    }

    fn check<Q: Quad>(operator: &Operator, x: &[V3], tolerance: f64) {
        let start: Vec<[Q; 2]> = x.iter().map(|p| [Q::from_vector(p), Q::spread(7.0)]).collect();
        let (mut plain, mut best) = (start.clone(), start);
        let rows = CsrMatrix::<Q>::new(operator);
        rows.apply(Plain, &mut plain);
        simd::dispatch(Product { rows: &rows, states: &mut best });
        for ((plain, best), expect) in plain.iter().zip(&best).zip(expected(operator, x)) {
            for found in [plain[1], best[1]] {
                assert!((found.vector() - expect).amax() < tolerance, "{} for {expect}", found.vector());
            }
        }
    }

    #[test]
    fn rows_multiply_as_the_operator_on_every_machine() {
        let membrane_pairs = PairList::new([[0, 1], [0, 3], [1, 2], [2, 3], [1, 3]]);
        let bending_pairs = PairList::new([[0, 2], [2, 4]]);
        let number = |k: usize| (1.0 + 3.0 * k as f64).sin();
        let matrix = |k: usize| Matrix3::from_fn(|r, c| number(k + 3 * r + c));
        let contact = |k: usize| Contact4 {
            vertices: [k, k + 1, 3, 4],
            weights: [0.4, 0.6, -0.7, -0.3],
            normal: V3::y(),
            stiffness: 2.0,
        };
        let operator = Operator {
            diagonal: (0..5).map(|v| matrix(v) + matrix(v).transpose()).collect(),
            membrane_pairs: &membrane_pairs,
            membrane: (0..5).map(|k| quad::block::<f32x4>(&matrix(10 + k))).collect(),
            bending_pairs: &bending_pairs,
            bending: &[-0.7, 0.4],
            springs: vec![([1, 4], 3.0)],
            contacts: vec![contact(0), contact(1)],
            arcs: None,
        };
        let x: Vec<V3> = (0..5).map(|v| V3::new(number(v), number(v + 20), number(v + 40))).collect();
        check::<f32x4>(&operator, &x, 1e-5);
        check::<f64x4>(&operator, &x, 1e-6);
    }
}
