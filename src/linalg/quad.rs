//! A vector of space in one vector register: three components and a zero.
//!
//! The register is explicit because the compiler turns loops over arrays mostly into instructions on single numbers.

use std::borrow::Cow;
use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

use nalgebra::Matrix3;
use wide::{f32x4, f64x4};

use super::simd::Simd;
use geom::V3;

/// Four numbers in the precision of a solve.
pub trait Quad:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + AddAssign + SubAssign + 'static
{
    type Scalar: Copy;
    const ZERO: Self;
    /// Value of `r . P r`, the work of the residual forces, below which a system counts as solved.
    const NEGLIGIBLE: f64;
    fn of(numbers: [f64; 4]) -> Self;
    fn scalar(number: f64) -> Self::Scalar;
    fn splat(number: Self::Scalar) -> Self;
    fn numbers(self) -> [Self::Scalar; 4];
    fn total(self) -> f64;
    /// Totals of three quads, and a zero.
    fn totals(quads: [Self; 3]) -> Self;
    fn vector(self) -> V3;

    fn spread(number: f64) -> Self {
        Self::splat(Self::scalar(number))
    }

    fn spread_single(number: f32) -> Self;

    fn mul_add_on<S: Simd>(self, factor: Self, sum: Self, simd: S) -> Self;
    fn neg_mul_add_on<S: Simd>(self, factor: Self, from: Self, simd: S) -> Self;

    fn blocks(single: &[Block<f32x4>]) -> Cow<'_, [Block<Self>]>;

    fn from_vector(v: &V3) -> Self {
        Self::of([v.x, v.y, v.z, 0.0])
    }
}

macro_rules! quad {
    ($quad:ty, $scalar:ty, $on:expr, $mul_add:ident, $neg_mul_add:ident, $blocks:expr) => {
        impl Quad for $quad {
            type Scalar = $scalar;
            const ZERO: Self = <$quad>::ZERO;
            const NEGLIGIBLE: f64 = {
                let epsilon = <$scalar>::EPSILON as f64;
                epsilon * epsilon * epsilon
            };
            fn blocks(single: &[Block<f32x4>]) -> Cow<'_, [Block<Self>]> {
                $blocks(single)
            }
            #[inline(always)]
            fn mul_add_on<S: Simd>(self, factor: Self, sum: Self, simd: S) -> Self {
                $on(simd, S::$mul_add, [self, factor, sum])
            }
            #[inline(always)]
            fn neg_mul_add_on<S: Simd>(self, factor: Self, from: Self, simd: S) -> Self {
                $on(simd, S::$neg_mul_add, [self, factor, from])
            }
            #[inline(always)]
            fn of(numbers: [f64; 4]) -> Self {
                Self::from(numbers.map(Self::scalar))
            }
            #[inline(always)]
            #[allow(clippy::unnecessary_cast, reason = "not in double precision")]
            fn spread_single(number: f32) -> Self {
                <$quad>::splat(number as $scalar)
            }
            #[inline(always)]
            fn scalar(number: f64) -> $scalar {
                number as $scalar
            }
            #[inline(always)]
            fn splat(number: $scalar) -> Self {
                <$quad>::splat(number)
            }
            #[inline(always)]
            fn numbers(self) -> [$scalar; 4] {
                self.to_array()
            }
            #[inline(always)]
            fn total(self) -> f64 {
                let [a, b, c, d] = self.to_array();
                f64::from((a + c) + (b + d))
            }
            #[inline(always)]
            fn totals(quads: [Self; 3]) -> Self {
                let [a, b, c] = quads.map(|quad| quad.to_array()).map(|[a, b, c, d]| (a + c) + (b + d));
                Self::from([a, b, c, 0.0])
            }
            #[inline(always)]
            fn vector(self) -> V3 {
                let [x, y, z, _] = self.to_array();
                V3::new(f64::from(x), f64::from(y), f64::from(z))
            }
        }
    };
}

#[inline(always)]
fn in_single<S>(simd: S, operation: impl Fn(S, f32x4, f32x4, f32x4) -> f32x4, [a, b, c]: [f32x4; 3]) -> f32x4 {
    operation(simd, a, b, c)
}

#[inline(always)]
fn in_double<S: Simd>(
    simd: S,
    operation: impl Fn(S, S::F64x4, S::F64x4, S::F64x4) -> S::F64x4,
    numbers: [f64x4; 3],
) -> f64x4 {
    let [a, b, c] = numbers.map(|quad| simd.f64s(quad.to_array()));
    f64x4::from(simd.to_f64s(operation(simd, a, b, c)))
}

quad!(f32x4, f32, in_single, mul_add, neg_mul_add, Cow::Borrowed);
quad!(f64x4, f64, in_double, mul_add_f64s, neg_mul_add_f64s, |blocks: &[Block<f32x4>]| blocks
    .iter()
    .map(|block| block.map(|row| f64x4::from(row.to_array().map(f64::from))))
    .collect());

/// By rows.
pub type Block<Q> = [Q; 3];

/// The block `n I`.
#[inline(always)]
pub fn alike(n: f32) -> Block<f32x4> {
    [f32x4::from([n, 0.0, 0.0, 0.0]), f32x4::from([0.0, n, 0.0, 0.0]), f32x4::from([0.0, 0.0, n, 0.0])]
}

pub fn matrix<Q: Quad>(block: &Block<Q>) -> Matrix3<f64> {
    Matrix3::from_rows(&block.map(|row| row.vector().transpose()))
}

pub fn block<Q: Quad>(m: &Matrix3<f64>) -> Block<Q> {
    [0, 1, 2].map(|r| Q::of([m[(r, 0)], m[(r, 1)], m[(r, 2)], 0.0]))
}

pub fn subtract(from: &mut Block<f32x4>, matrix: &Matrix3<f64>) {
    for (row, taken) in from.iter_mut().zip(block::<f32x4>(matrix)) {
        *row -= taken;
    }
}

#[inline(always)]
pub fn spread_out<Q: Quad>(v: Q) -> [Q; 3] {
    let [x, y, z, _] = v.numbers();
    [x, y, z].map(Q::splat)
}

#[inline(always)]
pub fn transposed_times<Q: Quad>(block: &Block<Q>, v: Q) -> Q {
    let [x, y, z] = spread_out(v);
    (block[0] * x + block[1] * y) + block[2] * z
}
