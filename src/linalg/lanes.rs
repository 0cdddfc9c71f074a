//! Formulas for one number or for four at once.

use std::ops::{Add, Div, Mul, Sub};

use super::machine::Machine;

/// What formulas are written in.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// A constant, beside this.
    fn same(self, number: f64) -> Self;
    /// `self factor + sum`.
    fn times_plus(self, factor: Self, sum: Self) -> Self;
    /// The lesser.
    fn least(self, other: Self) -> Self;
    /// The greater.
    fn most(self, other: Self) -> Self;
    /// Square root.
    fn root(self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn same(self, number: f64) -> f64 {
        number
    }

    #[inline(always)]
    fn times_plus(self, factor: f64, sum: f64) -> f64 {
        self * factor + sum
    }

    #[inline(always)]
    fn least(self, other: f64) -> f64 {
        self.min(other)
    }

    #[inline(always)]
    fn most(self, other: f64) -> f64 {
        self.max(other)
    }

    #[inline(always)]
    fn root(self) -> f64 {
        self.sqrt()
    }
}

/// Four numbers on a machine.
#[derive(Clone, Copy)]
pub struct Lanes<M: Machine> {
    four: M::Four,
    machine: M,
}

impl<M: Machine> Lanes<M> {
    /// Four numbers.
    #[inline(always)]
    pub fn of(machine: M, numbers: [f64; 4]) -> Self {
        Self { four: machine.four(numbers), machine }
    }

    /// The numbers in single precision.
    #[inline(always)]
    pub fn single(self) -> [f32; 4] {
        self.machine.single(self.four)
    }

    /// The numbers.
    #[inline(always)]
    pub fn numbers(self) -> [f64; 4] {
        self.machine.numbers(self.four)
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident, $on:ident) => {
        impl<M: Machine> $operator for Lanes<M> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { four: self.machine.$on(self.four, other.four), ..self }
            }
        }
    };
}

operator!(Add, add, sum);
operator!(Sub, sub, difference);
operator!(Mul, mul, product);
operator!(Div, div, quotient);

impl<M: Machine> Number for Lanes<M> {
    #[inline(always)]
    fn same(self, number: f64) -> Self {
        Self::of(self.machine, [number; 4])
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, sum: Self) -> Self {
        Self { four: self.machine.fours_plus(self.four, factor.four, sum.four), ..self }
    }

    #[inline(always)]
    fn least(self, other: Self) -> Self {
        Self { four: self.machine.least(self.four, other.four), ..self }
    }

    #[inline(always)]
    fn most(self, other: Self) -> Self {
        Self { four: self.machine.most(self.four, other.four), ..self }
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self { four: self.machine.root(self.four), ..self }
    }
}
