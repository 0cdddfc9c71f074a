//! SIMD: fused multiply-add, and eight numbers in single precision at once.
//!
//! Every x86-64 processor has registers of four such numbers. Nearly all since 2013 have registers of eight, and fused
//! multiply-add, which rounds once. The loops of the linear solves are written once, for any [`Simd`], and [`dispatch`]
//! runs them with the best instructions of the processor. Processors of different kinds may therefore round
//! differently. One kind always rounds the same.

use wide::{f32x4, f64x4};

/// Set of instructions that not every processor has.
pub trait Simd: Copy {
    fn run<K: Kernel>(self, kernel: K) -> K::Output;

    type F32x8: Copy;
    type F64x4: Copy;
    fn mul_add(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4;
    /// `c - a b`.
    fn neg_mul_add(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4;
    fn f64s(self, numbers: [f64; 4]) -> Self::F64x4;
    fn to_f64s(self, four: Self::F64x4) -> [f64; 4];
    fn add_f64s(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    fn sub_f64s(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    fn mul_f64s(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    fn div_f64s(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    fn mul_add_f64s(self, a: Self::F64x4, b: Self::F64x4, c: Self::F64x4) -> Self::F64x4;
    /// `c - a b`.
    fn neg_mul_add_f64s(self, a: Self::F64x4, b: Self::F64x4, c: Self::F64x4) -> Self::F64x4;
    fn to_f32s(self, four: Self::F64x4) -> [f32; 4];
    fn sqrt_f64s(self, a: Self::F64x4) -> Self::F64x4;
    /// Second, where one is NaN.
    fn min_f64s(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    /// Second, where one is NaN.
    fn max_f64s(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    /// Puts the first in the lower half.
    fn join(self, halves: [f32x4; 2]) -> Self::F32x8;
    fn split(self, twin: Self::F32x8) -> [f32x4; 2];
    fn mul_add_f32x8(self, a: Self::F32x8, b: Self::F32x8, c: Self::F32x8) -> Self::F32x8;
}

/// Array of an expression's values for each index. `map` over an array is not inlined into a kernel.
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

/// Loop that is compiled for every instruction set, inlined with all functions that it calls.
pub trait Kernel {
    type Output;
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Runs with the widest instructions that the processor has.
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.run(kernel);
    }
    Plain.run(kernel)
}

/// Instructions that every processor has.
#[derive(Clone, Copy)]
pub struct Plain;

impl Simd for Plain {
    type F32x8 = [f32x4; 2];
    type F64x4 = f64x4;

    #[inline(never)]
    fn run<K: Kernel>(self, kernel: K) -> K::Output {
        kernel.run(self)
    }

    #[inline(always)]
    fn mul_add(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4 {
        a * b + c
    }

    #[inline(always)]
    fn neg_mul_add(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4 {
        c - a * b
    }

    #[inline(always)]
    fn f64s(self, numbers: [f64; 4]) -> f64x4 {
        f64x4::from(numbers)
    }

    #[inline(always)]
    fn to_f64s(self, four: f64x4) -> [f64; 4] {
        four.to_array()
    }

    #[inline(always)]
    fn add_f64s(self, a: f64x4, b: f64x4) -> f64x4 {
        a + b
    }

    #[inline(always)]
    fn sub_f64s(self, a: f64x4, b: f64x4) -> f64x4 {
        a - b
    }

    #[inline(always)]
    fn mul_f64s(self, a: f64x4, b: f64x4) -> f64x4 {
        a * b
    }

    #[inline(always)]
    fn div_f64s(self, a: f64x4, b: f64x4) -> f64x4 {
        a / b
    }

    #[inline(always)]
    fn mul_add_f64s(self, a: f64x4, b: f64x4, c: f64x4) -> f64x4 {
        a * b + c
    }

    #[inline(always)]
    fn neg_mul_add_f64s(self, a: f64x4, b: f64x4, c: f64x4) -> f64x4 {
        c - a * b
    }

    #[inline(always)]
    fn to_f32s(self, four: f64x4) -> [f32; 4] {
        let [a, b, c, d] = four.to_array();
        [a as f32, b as f32, c as f32, d as f32]
    }

    #[inline(always)]
    fn sqrt_f64s(self, a: f64x4) -> f64x4 {
        a.sqrt()
    }

    #[inline(always)]
    fn min_f64s(self, a: f64x4, b: f64x4) -> f64x4 {
        a.fast_min(b)
    }

    #[inline(always)]
    fn max_f64s(self, a: f64x4, b: f64x4) -> f64x4 {
        a.fast_max(b)
    }

    #[inline(always)]
    fn join(self, halves: [f32x4; 2]) -> [f32x4; 2] {
        halves
    }

    #[inline(always)]
    fn split(self, twin: [f32x4; 2]) -> [f32x4; 2] {
        twin
    }

    #[inline(always)]
    fn mul_add_f32x8(self, a: [f32x4; 2], b: [f32x4; 2], c: [f32x4; 2]) -> [f32x4; 2] {
        [a[0] * b[0] + c[0], a[1] * b[1] + c[1]]
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{__m128, __m256, __m256d};

    use pulp::cast;
    use pulp::x86::V3;
    use wide::f32x4;

    use super::{Kernel, Simd};

    struct On<K> {
        simd: V3,
        kernel: K,
    }

    impl<K: Kernel> pulp::NullaryFnOnce for On<K> {
        type Output = K::Output;

        #[inline(always)]
        fn call(self) -> K::Output {
            self.kernel.run(self.simd)
        }
    }

    impl Simd for V3 {
        type F32x8 = __m256;
        type F64x4 = __m256d;

        #[inline(always)]
        fn run<K: Kernel>(self, kernel: K) -> K::Output {
            self.vectorize(On { simd: self, kernel })
        }

        #[inline(always)]
        fn mul_add(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4 {
            cast(self.fma._mm_fmadd_ps(cast(a), cast(b), cast(c)))
        }

        #[inline(always)]
        fn neg_mul_add(self, a: f32x4, b: f32x4, c: f32x4) -> f32x4 {
            cast(self.fma._mm_fnmadd_ps(cast(a), cast(b), cast(c)))
        }

        #[inline(always)]
        fn f64s(self, numbers: [f64; 4]) -> __m256d {
            cast(numbers)
        }

        #[inline(always)]
        fn to_f64s(self, four: __m256d) -> [f64; 4] {
            cast(four)
        }

        #[inline(always)]
        fn add_f64s(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_add_pd(a, b)
        }

        #[inline(always)]
        fn sub_f64s(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_sub_pd(a, b)
        }

        #[inline(always)]
        fn mul_f64s(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_mul_pd(a, b)
        }

        #[inline(always)]
        fn div_f64s(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_div_pd(a, b)
        }

        #[inline(always)]
        fn mul_add_f64s(self, a: __m256d, b: __m256d, c: __m256d) -> __m256d {
            self.fma._mm256_fmadd_pd(a, b, c)
        }

        #[inline(always)]
        fn neg_mul_add_f64s(self, a: __m256d, b: __m256d, c: __m256d) -> __m256d {
            self.fma._mm256_fnmadd_pd(a, b, c)
        }

        #[inline(always)]
        fn to_f32s(self, four: __m256d) -> [f32; 4] {
            cast(self.avx._mm256_cvtpd_ps(four))
        }

        #[inline(always)]
        fn sqrt_f64s(self, a: __m256d) -> __m256d {
            self.avx._mm256_sqrt_pd(a)
        }

        #[inline(always)]
        fn min_f64s(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_min_pd(a, b)
        }

        #[inline(always)]
        fn max_f64s(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_max_pd(a, b)
        }

        #[inline(always)]
        fn join(self, [low, high]: [f32x4; 2]) -> __m256 {
            self.avx._mm256_set_m128(cast::<_, __m128>(high), cast::<_, __m128>(low))
        }

        #[inline(always)]
        fn split(self, twin: __m256) -> [f32x4; 2] {
            [cast(self.avx._mm256_castps256_ps128(twin)), cast(self.avx._mm256_extractf128_ps::<1>(twin))]
        }

        #[inline(always)]
        fn mul_add_f32x8(self, a: __m256, b: __m256, c: __m256) -> __m256 {
            self.fma._mm256_fmadd_ps(a, b, c)
        }
    }
}
