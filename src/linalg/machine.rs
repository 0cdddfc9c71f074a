//! What a processor does in one go: a product and a sum, and eight numbers in single precision.
//!
//! Every x86-64 has registers of four such numbers; nearly all since 2013 have such of eight, and products that are summed up without
//! rounding in between. The loops of the linear solves are written once, for a [`Machine`]; [`on_best`] runs them on the best that is
//! there. Another processor may so round otherwise; the same rounds the same.

use wide::{f32x4, f64x4};

/// Arithmetic that not every processor does in one go.
pub trait Machine: Copy {
    /// Does a task by itself, with all registers to it.
    fn alone<T: Task>(self, task: T) -> T::Output;

    /// Two quads in single precision.
    type Twin: Copy;
    /// Four numbers in double precision.
    type Four: Copy;
    /// `a b + c`.
    fn plus(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4;
    /// `c - a b`.
    fn minus(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4;
    /// Four numbers in double precision.
    fn four(self, numbers: [f64; 4]) -> Self::Four;
    /// The numbers.
    fn numbers(self, four: Self::Four) -> [f64; 4];
    /// `a + b`.
    fn sum(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// `a - b`.
    fn difference(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// `a b`.
    fn product(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// `a / b`.
    fn quotient(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// `a b + c`.
    fn fours_plus(self, a: Self::Four, b: Self::Four, c: Self::Four) -> Self::Four;
    /// `c - a b`.
    fn fours_minus(self, a: Self::Four, b: Self::Four, c: Self::Four) -> Self::Four;
    /// The numbers in single precision.
    fn single(self, four: Self::Four) -> [f32; 4];
    /// The square roots.
    fn root(self, a: Self::Four) -> Self::Four;
    /// The lesser of each two; the second where one is not a number.
    fn least(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// The greater of each two; the second where one is not a number.
    fn most(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// Two quads side by side.
    fn twin(self, halves: [f32x4; 2]) -> Self::Twin;
    /// The two.
    fn halves(self, twin: Self::Twin) -> [f32x4; 2];
    /// `a b + c`.
    fn twins_plus(self, a: Self::Twin, b: Self::Twin, c: Self::Twin) -> Self::Twin;
}

/// An array of what an expression makes of each index, written out: maps over arrays are not inlined into tasks, in which then each
/// instruction is called as a function.
#[macro_export]
macro_rules! each {
    ($k:ident of 2 => $made:expr) => { $crate::each!([0, 1] $k $made) };
    ($k:ident of 3 => $made:expr) => { $crate::each!([0, 1, 2] $k $made) };
    ($k:ident of 4 => $made:expr) => { $crate::each!([0, 1, 2, 3] $k $made) };
    ($k:ident of 5 => $made:expr) => { $crate::each!([0, 1, 2, 3, 4] $k $made) };
    ($k:ident of 6 => $made:expr) => { $crate::each!([0, 1, 2, 3, 4, 5] $k $made) };
    ([$($index:literal),*] $k:ident $made:expr) => { [$({ let $k: usize = $index; $made }),*] };
}
pub use each;

/// What is to be done on a machine; to be inlined, with all that it calls.
pub trait Task {
    /// What comes of it.
    type Output;
    /// Does it.
    fn run<M: Machine>(self, machine: M) -> Self::Output;
}

/// Does a task on the best machine that the processor is.
pub fn on_best<T: Task>(task: T) -> T::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(machine) = pulp::x86::V3::try_new() {
        return machine.alone(task);
    }
    Plain.alone(task)
}

/// What every processor has.
#[derive(Clone, Copy)]
pub struct Plain;

impl Machine for Plain {
    type Twin = [f32x4; 2];
    type Four = f64x4;

    #[inline(never)]
    fn alone<T: Task>(self, task: T) -> T::Output {
        task.run(self)
    }

    #[inline(always)]
    fn plus(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4 {
        a * b + c
    }

    #[inline(always)]
    fn minus(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4 {
        c - a * b
    }

    #[inline(always)]
    fn four(self, numbers: [f64; 4]) -> f64x4 {
        f64x4::from(numbers)
    }

    #[inline(always)]
    fn numbers(self, four: f64x4) -> [f64; 4] {
        four.to_array()
    }

    #[inline(always)]
    fn sum(self, a: f64x4, b: f64x4) -> f64x4 {
        a + b
    }

    #[inline(always)]
    fn difference(self, a: f64x4, b: f64x4) -> f64x4 {
        a - b
    }

    #[inline(always)]
    fn product(self, a: f64x4, b: f64x4) -> f64x4 {
        a * b
    }

    #[inline(always)]
    fn quotient(self, a: f64x4, b: f64x4) -> f64x4 {
        a / b
    }

    #[inline(always)]
    fn fours_plus(self, a: f64x4, b: f64x4, c: f64x4) -> f64x4 {
        a * b + c
    }

    #[inline(always)]
    fn fours_minus(self, a: f64x4, b: f64x4, c: f64x4) -> f64x4 {
        c - a * b
    }

    #[inline(always)]
    fn single(self, four: f64x4) -> [f32; 4] {
        let [a, b, c, d] = four.to_array();
        [a as f32, b as f32, c as f32, d as f32]
    }

    #[inline(always)]
    fn root(self, a: f64x4) -> f64x4 {
        a.sqrt()
    }

    #[inline(always)]
    fn least(self, a: f64x4, b: f64x4) -> f64x4 {
        a.fast_min(b)
    }

    #[inline(always)]
    fn most(self, a: f64x4, b: f64x4) -> f64x4 {
        a.fast_max(b)
    }

    #[inline(always)]
    fn twin(self, halves: [f32x4; 2]) -> [f32x4; 2] {
        halves
    }

    #[inline(always)]
    fn halves(self, twin: [f32x4; 2]) -> [f32x4; 2] {
        twin
    }

    #[inline(always)]
    fn twins_plus(self, a: [f32x4; 2], b: [f32x4; 2], c: [f32x4; 2]) -> [f32x4; 2] {
        [a[0] * b[0] + c[0], a[1] * b[1] + c[1]]
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{__m128, __m256, __m256d};

    use pulp::cast;
    use pulp::x86::V3;
    use wide::f32x4;

    use super::{Machine, Task};

    /// A task for this machine.
    struct On<T> {
        machine: V3,
        task: T,
    }

    impl<T: Task> pulp::NullaryFnOnce for On<T> {
        type Output = T::Output;

        #[inline(always)]
        fn call(self) -> T::Output {
            self.task.run(self.machine)
        }
    }

    impl Machine for V3 {
        type Twin = __m256;
        type Four = __m256d;

        #[inline(always)]
        fn alone<T: Task>(self, task: T) -> T::Output {
            self.vectorize(On { machine: self, task })
        }

        #[inline(always)]
        fn plus(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4 {
            cast(self.fma._mm_fmadd_ps(cast(a), cast(b), cast(c)))
        }

        #[inline(always)]
        fn minus(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4 {
            cast(self.fma._mm_fnmadd_ps(cast(a), cast(b), cast(c)))
        }

        #[inline(always)]
        fn four(self, numbers: [f64; 4]) -> __m256d {
            cast(numbers)
        }

        #[inline(always)]
        fn numbers(self, four: __m256d) -> [f64; 4] {
            cast(four)
        }

        #[inline(always)]
        fn sum(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_add_pd(a, b)
        }

        #[inline(always)]
        fn difference(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_sub_pd(a, b)
        }

        #[inline(always)]
        fn product(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_mul_pd(a, b)
        }

        #[inline(always)]
        fn quotient(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_div_pd(a, b)
        }

        #[inline(always)]
        fn fours_plus(self, a: __m256d, b: __m256d, c: __m256d) -> __m256d {
            self.fma._mm256_fmadd_pd(a, b, c)
        }

        #[inline(always)]
        fn fours_minus(self, a: __m256d, b: __m256d, c: __m256d) -> __m256d {
            self.fma._mm256_fnmadd_pd(a, b, c)
        }

        #[inline(always)]
        fn single(self, four: __m256d) -> [f32; 4] {
            cast(self.avx._mm256_cvtpd_ps(four))
        }

        #[inline(always)]
        fn root(self, a: __m256d) -> __m256d {
            self.avx._mm256_sqrt_pd(a)
        }

        #[inline(always)]
        fn least(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_min_pd(a, b)
        }

        #[inline(always)]
        fn most(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_max_pd(a, b)
        }

        #[inline(always)]
        fn twin(self, [one, other]: [f32x4; 2]) -> __m256 {
            self.avx._mm256_set_m128(cast::<_, __m128>(other), cast::<_, __m128>(one))
        }

        #[inline(always)]
        fn halves(self, twin: __m256) -> [f32x4; 2] {
            [cast(self.avx._mm256_castps256_ps128(twin)), cast(self.avx._mm256_extractf128_ps::<1>(twin))]
        }

        #[inline(always)]
        fn twins_plus(self, a: __m256, b: __m256, c: __m256) -> __m256 {
            self.fma._mm256_fmadd_ps(a, b, c)
        }
    }
}
