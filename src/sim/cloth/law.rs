//! Constitutive laws of the membrane: second Piola-Kirchhoff stress (N/m) as a function of the Green strain, in the
//! axes of the grain.

use std::ops::{Add, Mul, Sub};

use nalgebra::Matrix2;

use crate::Fabric;
use linalg::lanes::Number;

/// Symmetric tensor in the plane of the cloth, in the axes of the grain.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tensor<N = f64> {
    pub weft: N,
    pub warp: N,
    pub shear: N,
}

impl Tensor {
    pub fn of(matrix: &Matrix2<f64>) -> Self {
        Self { weft: matrix[(0, 0)], warp: matrix[(1, 1)], shear: matrix[(0, 1)] }
    }

    /// Weft first.
    pub fn matrix(self) -> Matrix2<f64> {
        Matrix2::new(self.weft, self.shear, self.shear, self.warp)
    }
}

impl<N: Number> Tensor<N> {
    /// Sets negative eigenvalues to zero.
    #[inline(always)]
    pub fn without_compression(self) -> Self {
        let (zero, half) = (self.weft.splat(0.0), self.weft.splat(0.5));
        let mean = half * (self.weft + self.warp);
        let apart = half * (self.weft - self.warp);
        let radius = self.shear.mul_add(self.shear, apart * apart).sqrt();
        let (high, low) = ((mean + radius).max(zero), (mean - radius).min(zero));
        // Where the eigenvalues have opposite signs, `high (S - low I) / (high - low)` projects onto the eigenvector of
        // the positive one.
        let share = high / (high - low).max(high.splat(f64::MIN_POSITIVE));
        Self { weft: self.weft - low, warp: self.warp - low, ..self } * share
    }
}

impl<N: Number> Add for Tensor<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { weft: self.weft + other.weft, warp: self.warp + other.warp, shear: self.shear + other.shear }
    }
}

impl<N: Number> Sub for Tensor<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { weft: self.weft - other.weft, warp: self.warp - other.warp, shear: self.shear - other.shear }
    }
}

impl<N: Number> Mul<N> for Tensor<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: N) -> Self {
        Self { weft: self.weft * factor, warp: self.warp * factor, shear: self.shear * factor }
    }
}

geom::constants! {
    "cloth.law",
    /// Green strain at which a slackened linear law has regained its stiffness.
    const SLACK: f64 = 0.01;
}

/// Law of one direction of the grain: `sigma(E) = K E + R (w^2 + 2 w b)`, N/m, of the Green strain `E`. `w` is the
/// tensile strain up to `E*`, and `b` that beyond `E*`.
///
/// Knits stiffen as their loops straighten. In tension the secant modulus `sigma / E` rises linearly from `K` at rest,
/// through the one measured at a known stretch, as the measurements were interpolated [Wang, O'Brien, Ramamoorthi
/// 2011]. Beyond `E*` the stress continues along its tangent. Compression keeps `K`. The stress is the derivative of an
/// energy and continuously differentiable once; its slope never falls below `K`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibre<N = f64> {
    /// Modulus `K` at rest, N/m.
    pub rest: N,
    /// Rise `R` of the secant modulus with the Green strain, N/m; 0 for a linear law.
    pub rise: N,
    /// Green strain `E*` up to which the secant modulus rises.
    pub until: N,
}

impl Fibre {
    /// N/m.
    pub fn linear(modulus: f64) -> Self {
        Self { rest: modulus, rise: 0.0, until: f64::INFINITY }
    }

    /// Secant modulus `rest` at rest and `stretched` at the stretch ratio `1 + stretch`. `E* = s (1 + s / 2)` is the
    /// Green strain of a stretch `s`.
    pub fn stiffening(rest: f64, stretched: f64, stretch: f64) -> Self {
        let until = stretch * (1.0 + 0.5 * stretch);
        Self { rest, rise: (stretched - rest).max(0.0) / until, until }
    }

    /// Returns the law with a share of its modulus at rest. Its slope regains the original value at `E*`, or at `SLACK`
    /// for a linear law. So the cloth is a little longer under tension, and then as stiff as before.
    pub fn slackened(self, share: f64) -> Self {
        let until = if self.until.is_finite() { self.until } else { SLACK };
        Self { rest: share * self.rest, rise: self.rise + 0.5 * (1.0 - share) * self.rest / until, until }
    }
}

impl<N: Number> Fibre<N> {
    /// `sigma(E)`, N/m.
    #[inline(always)]
    pub fn stress(&self, strain: N) -> N {
        let (within, beyond) = self.parts(strain);
        let rising = within * beyond.mul_add(strain.splat(2.0), within);
        strain.mul_add(self.rest, rising * self.rise)
    }

    /// `d sigma / d E`, N/m.
    #[inline(always)]
    pub fn tangent(&self, strain: N) -> N {
        self.parts(strain).0.mul_add(strain.splat(2.0) * self.rise, self.rest)
    }

    /// Integral of `sigma` per area, N/m: `K E^2 / 2 + R (w^3 / 3 + w b (w + b))`.
    #[inline(always)]
    pub fn energy(&self, strain: N) -> N {
        let (within, beyond) = self.parts(strain);
        let rising = within * (within * within * strain.splat(1.0 / 3.0) + beyond * (within + beyond));
        (strain * strain).mul_add(strain.splat(0.5) * self.rest, rising * self.rise)
    }

    /// Tensile strain up to `E*`, and that beyond.
    #[inline(always)]
    fn parts(&self, strain: N) -> (N, N) {
        let stretch = strain.max(strain.splat(0.0));
        let within = stretch.min(self.until);
        (within, stretch - within)
    }
}

/// Orthotropic St. Venant-Kirchhoff law in grain axes (1 weft, 2 warp) [T 4.2-4.10]: `S11 = sigma_1(E11) + c12 E22`,
/// `S22 = sigma_2(E22) + c12 E11`, `S12 = 2 G E12`, N/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthotropic<N = f64> {
    /// `sigma_1`.
    pub weft: Fibre<N>,
    /// Coupling modulus, N/m.
    pub c12: N,
    /// `sigma_2`.
    pub warp: Fibre<N>,
    /// Modulus `G`, N/m.
    pub shear: N,
}

impl Fabric {
    /// Along the grain line.
    pub fn warp_law(&self) -> Fibre {
        let rest = self.membrane_warp_n_m;
        self.stretched.map_or(Fibre::linear(rest), |s| Fibre::stiffening(rest, s.membrane_warp_n_m, s.stretch))
    }

    /// Across the grain line.
    pub fn weft_law(&self) -> Fibre {
        let rest = self.membrane_weft_n_m;
        self.stretched.map_or(Fibre::linear(rest), |s| Fibre::stiffening(rest, s.membrane_weft_n_m, s.stretch))
    }
}

impl Orthotropic {
    pub fn of(fabric: &Fabric) -> Self {
        Self {
            weft: fabric.weft_law(),
            c12: fabric.membrane_coupling_n_m,
            warp: fabric.warp_law(),
            shear: fabric.shear_n_m,
        }
    }

    /// Takes a share of the stiffness at rest. Along the grain it is regained under tension ([`Fibre::slackened`]).
    pub fn slackened(self, share: f64) -> Self {
        Self {
            weft: self.weft.slackened(share),
            c12: share * self.c12,
            warp: self.warp.slackened(share),
            shear: share * self.shear,
        }
    }

    pub fn packed(laws: [&Self; 4]) -> Orthotropic<[f64; 4]> {
        let fibre = |direction: fn(&Self) -> &Fibre| Fibre {
            rest: laws.map(|law| direction(law).rest),
            rise: laws.map(|law| direction(law).rise),
            until: laws.map(|law| direction(law).until),
        };
        Orthotropic {
            weft: fibre(|law| &law.weft),
            c12: laws.map(|law| law.c12),
            warp: fibre(|law| &law.warp),
            shear: laws.map(|law| law.shear),
        }
    }
}

impl<N: Number> Orthotropic<N> {
    /// Second Piola-Kirchhoff stress `S(E)`, N/m.
    #[inline(always)]
    pub fn stress(&self, strain: Tensor<N>) -> Tensor<N> {
        Tensor {
            weft: strain.warp.mul_add(self.c12, self.weft.stress(strain.weft)),
            warp: strain.weft.mul_add(self.c12, self.warp.stress(strain.warp)),
            shear: strain.shear * (strain.shear.splat(2.0) * self.shear),
        }
    }

    /// Moduli along weft and warp, N/m.
    #[inline(always)]
    pub fn tangents(&self, strain: Tensor<N>) -> [N; 2] {
        [self.weft.tangent(strain.weft), self.warp.tangent(strain.warp)]
    }

    /// First-order change of the stress for a change of strain, N/m.
    #[inline(always)]
    pub fn tangent(&self, strain: Tensor<N>, change: Tensor<N>) -> Tensor<N> {
        let [weft, warp] = self.tangents(strain);
        Tensor {
            weft: weft.mul_add(change.weft, self.c12 * change.warp),
            warp: warp.mul_add(change.warp, self.c12 * change.weft),
            shear: change.shear * (change.shear.splat(2.0) * self.shear),
        }
    }

    /// Energy per area, N/m: `psi_1(E11) + psi_2(E22) + c12 E11 E22 + 2 G E12^2`, with the energies `psi` of the two
    /// directions.
    #[inline(always)]
    pub fn energy(&self, strain: Tensor<N>) -> N {
        let along = self.weft.energy(strain.weft) + self.warp.energy(strain.warp);
        let across = strain.weft * strain.warp * self.c12;
        along + across + strain.shear * strain.shear * (strain.shear.splat(2.0) * self.shear)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_slopes(law: Fibre, scale: f64, strains: &[f64]) {
        let h = 1e-6;
        for &e in strains {
            let slope = (law.energy(e + h) - law.energy(e - h)) / (2.0 * h);
            assert!((slope - law.stress(e)).abs() < 1e-6 * scale, "stress at {e}");
            let slope = (law.stress(e + h) - law.stress(e - h)) / (2.0 * h);
            assert!((slope / law.tangent(e) - 1.0).abs() < 1e-6, "tangent at {e}");
        }
    }

    #[test]
    fn a_stiffening_law_goes_through_what_was_measured_and_is_its_energys_derivative() {
        // The warp of the gray interlock: 68.95 N/m at rest, 811.7 N/m at 17 % stretch.
        let law = Fibre::stiffening(68.95, 811.7, 0.17);
        let strain = |stretch: f64| stretch * (1.0 + 0.5 * stretch);
        assert!((law.stress(strain(0.17)) / strain(0.17) - 811.7).abs() < 1e-9);
        assert!((law.tangent(0.0) - 68.95).abs() < 1e-12 && (law.stress(-0.1) + 6.895).abs() < 1e-12);
        let until = strain(0.17);
        check_slopes(law, law.stress(0.1), &[-0.2, -1e-3, 1e-3, 0.05, until - 2e-6, until + 2e-6, 0.4]);
    }

    #[test]
    fn a_slackened_law_is_softer_at_rest_and_as_stiff_once_drawn() {
        for law in [Fibre::linear(3801.0), Fibre::stiffening(68.95, 811.7, 0.17)] {
            let slack = law.slackened(0.2);
            assert!((slack.tangent(0.0) / law.rest - 0.2).abs() < 1e-12);
            assert!((slack.stress(-0.1) / law.stress(-0.1) - 0.2).abs() < 1e-12);
            let until = slack.until;
            for drawn in [until, 0.2, 0.5] {
                assert!((slack.tangent(drawn) / law.tangent(drawn) - 1.0).abs() < 1e-12);
                assert!(slack.stress(drawn) < law.stress(drawn));
            }
            check_slopes(slack, law.stress(0.1), &[-0.2, -1e-3, 1e-3, until - 2e-6, until + 2e-6, 0.4]);
        }
    }

    #[test]
    fn compression_is_taken_out_of_a_stress() {
        let check = |stress: [f64; 3], expect: [f64; 3]| {
            let [stress, expect] = [stress, expect].map(|[weft, shear, warp]| Tensor { weft, warp, shear });
            let got = stress.without_compression();
            assert!((got - expect).matrix().norm() < 1e-12, "{got:?}");
        };
        check([2.0, 0.0, 3.0], [2.0, 0.0, 3.0]);
        check([-2.0, 0.0, -3.0], [0.0, 0.0, 0.0]);
        check([2.0, 0.0, -3.0], [2.0, 0.0, 0.0]);
        check([0.0, 1.0, 0.0], [0.5, 0.5, 0.5]);
    }
}
