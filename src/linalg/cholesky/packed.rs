//! 6x6 blocks in vector registers, for the substitutions with a Cholesky factor.

use wide::f32x4;

use super::{Dense, Row};
use crate::simd::{Simd, each};

/// A 6x6 block. `heads` has rows 0-3 of each column, two columns side by side. `tails` has rows 4 and 5 of each column,
/// four columns side by side, with a last half of zeros.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
pub struct Packed {
    heads: [[f32x4; 2]; 3],
    tails: [[f32x4; 2]; 2],
}

impl Packed {
    /// Rounds to single precision.
    pub fn new(block: &Dense) -> Self {
        let entry = |c: usize, r: usize| block[c][r] as f32;
        let head = |c: usize| f32x4::from([entry(c, 0), entry(c, 1), entry(c, 2), entry(c, 3)]);
        let tail = |c: usize| f32x4::from([entry(c, 4), entry(c, 5), entry(c + 1, 4), entry(c + 1, 5)]);
        Self { heads: [0, 2, 4].map(|c| [head(c), head(c + 1)]), tails: [[tail(0), tail(2)], [tail(4), f32x4::ZERO]] }
    }
}

/// Values in the layout of a packed block: factors for its entries, or sums of products with them.
#[derive(Clone, Copy)]
pub struct Entries<T> {
    heads: [T; 3],
    tails: [T; 2],
}

/// A row of six numbers, each the sum of partial sums: two for each of the first four numbers, four for each of the
/// last two.
#[derive(Clone, Copy)]
pub struct Parts<T> {
    head: T,
    tail: T,
}

#[derive(Clone, Copy)]
pub struct Blockwise<S>(pub S);

impl<S: Simd> Blockwise<S> {
    #[inline(always)]
    pub fn nothing(self) -> Entries<S::F32x8> {
        let zero = self.0.join([f32x4::ZERO; 2]);
        Entries { heads: [zero; 3], tails: [zero; 2] }
    }

    #[inline(always)]
    pub fn parts(self, [a, b, c, d, e, f]: Row) -> Parts<S::F32x8> {
        let (head, tail) = (f32x4::from([a, b, c, d]), f32x4::from([e, f, 0.0, 0.0]));
        Parts { head: self.0.join([head, f32x4::ZERO]), tail: self.0.join([tail, f32x4::ZERO]) }
    }

    #[inline(always)]
    pub fn repeated(self, [a, b, c, d, e, f]: Row) -> Parts<S::F32x8> {
        let (head, tail) = (f32x4::from([a, b, c, d]), f32x4::from([e, f, e, f]));
        Parts { head: self.0.join([head; 2]), tail: self.0.join([tail; 2]) }
    }

    #[inline(always)]
    pub fn row(self, parts: &Parts<S::F32x8>) -> Row {
        let ([a, b], [c, d]) = (self.0.split(parts.head), self.0.split(parts.tail));
        let (head, tail) = ((a + b).to_array(), (c + d).to_array());
        [head[0], head[1], head[2], head[3], tail[0] + tail[2], tail[1] + tail[3]]
    }

    /// First partial sums, for a row that is repeated in all.
    #[inline(always)]
    pub fn first(self, parts: &Parts<S::F32x8>) -> Row {
        let ([a, b, c, d], [e, f, ..]) =
            (self.0.split(parts.head)[0].to_array(), self.0.split(parts.tail)[0].to_array());
        [a, b, c, d, e, f]
    }

    #[inline(always)]
    pub fn factors(self, y: Row) -> Entries<S::F32x8> {
        let tails = each!(k of 3 => f32x4::from([y[2 * k], y[2 * k], y[2 * k + 1], y[2 * k + 1]]));
        Entries {
            heads: each!(k of 3 => self.0.join([f32x4::splat(y[2 * k]), f32x4::splat(y[2 * k + 1])])),
            tails: [self.0.join([tails[0], tails[1]]), self.0.join([tails[2], f32x4::ZERO])],
        }
    }

    #[inline(always)]
    pub fn add_times(self, parts: &mut Parts<S::F32x8>, block: &Packed, factors: &Entries<S::F32x8>) {
        for (head, factor) in block.heads.iter().zip(&factors.heads) {
            parts.head = self.0.mul_add_f32x8(self.0.join(*head), *factor, parts.head);
        }
        for (tail, factor) in block.tails.iter().zip(&factors.tails) {
            parts.tail = self.0.mul_add_f32x8(self.0.join(*tail), *factor, parts.tail);
        }
    }

    /// Adds the products of a block's columns with a repeated row. Their totals are the transposed block times the row.
    #[inline(always)]
    pub fn add_products(self, sums: &mut Entries<S::F32x8>, block: &Packed, row: &Parts<S::F32x8>) {
        for (sum, head) in sums.heads.iter_mut().zip(&block.heads) {
            *sum = self.0.mul_add_f32x8(self.0.join(*head), row.head, *sum);
        }
        for (sum, tail) in sums.tails.iter_mut().zip(&block.tails) {
            *sum = self.0.mul_add_f32x8(self.0.join(*tail), row.tail, *sum);
        }
    }

    #[inline(always)]
    pub fn totals(self, sums: &Entries<S::F32x8>) -> Row {
        let heads = each!(k of 3 => self.0.split(sums.heads[k]));
        let tails = each!(k of 2 => self.0.split(sums.tails[k]));
        each!(column of 6 => {
            let [a, b, c, d] = heads[column / 2][column % 2].to_array();
            let tail = &tails[column / 4][column / 2 % 2].to_array()[2 * (column % 2)..];
            ((a + b) + (c + d)) + (tail[0] + tail[1])
        })
    }
}
