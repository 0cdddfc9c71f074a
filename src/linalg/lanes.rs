//! Arithmetic for formulas that are written once, for one number or for four at once.

use std::ops::{Add, Div, Mul, Sub};

use super::simd::Simd;

/// Number or vector of numbers, in which formulas are written.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    fn splat(self, number: f64) -> Self;
    fn mul_add(self, factor: Self, sum: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn splat(self, number: f64) -> f64 {
        number
    }

    #[inline(always)]
    fn mul_add(self, factor: f64, sum: f64) -> f64 {
        self * factor + sum
    }

    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        self.min(other)
    }

    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        self.max(other)
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        self.sqrt()
    }
}

/// Four numbers in a register, with the instruction set to compute with.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd> {
    four: S::F64x4,
    simd: S,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub fn of(simd: S, numbers: [f64; 4]) -> Self {
        Self { four: simd.f64s(numbers), simd }
    }

    #[inline(always)]
    pub fn single(self) -> [f32; 4] {
        self.simd.to_f32s(self.four)
    }

    #[inline(always)]
    pub fn numbers(self) -> [f64; 4] {
        self.simd.to_f64s(self.four)
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident, $on:ident) => {
        impl<S: Simd> $operator for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { four: self.simd.$on(self.four, other.four), ..self }
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Number for Lanes<S> {
    #[inline(always)]
    fn splat(self, number: f64) -> Self {
        Self::of(self.simd, [number; 4])
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, sum: Self) -> Self {
        Self { four: self.simd.mul_add_f64s(self.four, factor.four, sum.four), ..self }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self { four: self.simd.min_f64s(self.four, other.four), ..self }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self { four: self.simd.max_f64s(self.four, other.four), ..self }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { four: self.simd.sqrt_f64s(self.four), ..self }
    }
}
