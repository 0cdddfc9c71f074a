//! Blocks of six by six in vector registers: what a solve with the factor between patches runs through.

use wide::f32x4;

use super::blocks::{Dense, Row};

/// A block, or what multiplies or sums up its entries: of each column the first four, then the last two of each pair of columns.
#[derive(Clone, Copy, Default)]
pub struct Packed {
    heads: [f32x4; 6],
    tails: [f32x4; 3],
}

/// A row as it meets [`Packed`]: its first four numbers, and the last two twice, of which either half may hold a part.
#[derive(Clone, Copy, Default)]
pub struct Lanes {
    head: f32x4,
    tail: f32x4,
}

impl Packed {
    /// A block, rounded.
    pub fn new(block: &Dense) -> Self {
        let entry = |c: usize, r: usize| block[c][r] as f32;
        Self {
            heads: std::array::from_fn(|c| f32x4::from([entry(c, 0), entry(c, 1), entry(c, 2), entry(c, 3)])),
            tails: std::array::from_fn(|p| {
                let c = 2 * p;
                f32x4::from([entry(c, 4), entry(c, 5), entry(c + 1, 4), entry(c + 1, 5)])
            }),
        }
    }

    /// What a row multiplies the columns of a block with.
    #[inline(always)]
    pub fn factors(y: &Row) -> Self {
        let tail = |c: usize| f32x4::from([y[c], y[c], y[c + 1], y[c + 1]]);
        Self { heads: y.map(f32x4::splat), tails: [tail(0), tail(2), tail(4)] }
    }

    /// `block y` for the factors of `y`.
    #[inline(always)]
    pub fn products(&self, factors: &Self) -> Lanes {
        let head = |c: usize| self.heads[c] * factors.heads[c];
        let tail = |p: usize| self.tails[p] * factors.tails[p];
        Lanes {
            head: (head(0) + head(1)) + (head(2) + head(3)) + (head(4) + head(5)),
            tail: tail(0) + tail(1) + tail(2),
        }
    }

    /// `block y`.
    pub fn times(&self, y: &Row) -> Row {
        self.products(&Self::factors(y)).row()
    }

    /// Adds each column's products with `x`: their totals are `block^T x`.
    #[inline(always)]
    pub fn add_products(&mut self, block: &Self, x: &Lanes) {
        for (sum, head) in self.heads.iter_mut().zip(&block.heads) {
            *sum += *head * x.head;
        }
        for (sum, tail) in self.tails.iter_mut().zip(&block.tails) {
            *sum += *tail * x.tail;
        }
    }

    /// Sums of the columns.
    #[inline(always)]
    pub fn totals(&self) -> Row {
        std::array::from_fn(|c| {
            let ([a, b, c, d], tail) = (self.heads[c].to_array(), half(self.tails[c / 2], c % 2));
            ((a + b) + (c + d)) + (tail[0] + tail[1])
        })
    }
}

impl Lanes {
    /// A row whole in the first half of its tail.
    pub fn of(row: &Row) -> Self {
        let [a, b, c, d, e, f] = *row;
        Self { head: f32x4::from([a, b, c, d]), tail: f32x4::from([e, f, 0.0, 0.0]) }
    }

    /// A row whole in either half of its tail: what a block's columns are multiplied with.
    #[inline(always)]
    pub fn doubled(row: &Row) -> Self {
        let [a, b, c, d, e, f] = *row;
        Self { head: f32x4::from([a, b, c, d]), tail: f32x4::from([e, f, e, f]) }
    }

    /// Takes away another, half by half.
    #[inline(always)]
    pub fn subtract(&mut self, other: Self) {
        self.head -= other.head;
        self.tail -= other.tail;
    }

    /// The row, of both halves of the tail.
    #[inline(always)]
    pub fn row(&self) -> Row {
        let ([a, b, c, d], [e, f, g, h]) = (self.head.to_array(), self.tail.to_array());
        [a, b, c, d, e + g, f + h]
    }

    /// The row, of the first half of the tail.
    pub fn first(&self) -> Row {
        let ([a, b, c, d], [e, f, ..]) = (self.head.to_array(), self.tail.to_array());
        [a, b, c, d, e, f]
    }
}

#[inline(always)]
fn half(quad: f32x4, second: usize) -> [f32; 2] {
    let [a, b, c, d] = quad.to_array();
    if second == 0 { [a, b] } else { [c, d] }
}
