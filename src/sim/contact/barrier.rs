//! Contact potential between two layers of cloth: a penalty that begins softly, and a barrier.

use super::penalty;

/// Contact potential and its derivatives, over the penalty stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// m2.
    pub energy: f64,
    /// Repulsive force, m.
    pub force: f64,
    /// Derivative of the force by the depth of the contact.
    pub stiffness: f64,
}

geom::constants! {
    "contact.barrier",
    /// Scale of the pressure of a light contact, N/m2 ([`penalty::push`]): the weight of a few layers. Where light
    /// contacts were stiff, every other step lost them and drove the layers through each other.
    const LIGHT_N_M2: f64 = 8.0;
    /// Depth over which the pressure of a light contact grows by a factor e, as a share of the thickness.
    const SOFTNESS: f64 = 0.05;
    /// Distance `d0` below which the barrier acts, as a share of the thickness.
    const FROM: f64 = 0.5;
    /// Distance down to which the barrier is logarithmic, as a share of the thickness. Below it is a parabola, so that
    /// the potential stays finite.
    const TO: f64 = 0.01;
    /// Factor of the barrier relative to the spring.
    const STRENGTH: f64 = 4.0;
}

/// Contact potential at the distance `d` with the penalty stiffness `k`, N/m3; `None` at or beyond the thickness `t`.
///
/// The pressure at the depth `t - d` is that of [`penalty::push`]. Below `d0 = t/2` the logarithmic barrier `-4 k (d -
/// d0)^2 ln(d / d0)` [Li 2020] is added to the energy. Its second derivative reaches ten thousand times `k` before the
/// barrier is cut off.
pub fn push(distance_m: f64, thickness_m: f64, stiffness_n_m3: f64) -> Option<Push> {
    let depth = thickness_m - distance_m;
    // NaN where a triangle has collapsed.
    if depth.is_nan() || depth <= 0.0 {
        return None;
    }
    let spring = penalty::push(depth, SOFTNESS * thickness_m, LIGHT_N_M2 / stiffness_n_m3, 1.0);
    let mut push = Push { energy: spring.energy_n_m, force: spring.pressure_n_m2, stiffness: spring.stiffness_n_m3 };
    let knee = FROM * thickness_m;
    if distance_m < knee {
        let d = distance_m.max(TO * thickness_m);
        let (u, log) = (knee - d, (knee / d).ln());
        let (energy, force) = (u * u * log, u * (2.0 * log + u / d));
        let stiffness = 2.0 * log + 4.0 * u / d + u * u / (d * d);
        let below = d - distance_m;
        push.energy += STRENGTH * (energy + below * (force + 0.5 * below * stiffness));
        push.force += STRENGTH * (force + below * stiffness);
        push.stiffness += STRENGTH * stiffness;
    }
    Some(push)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_and_stiffness_are_the_energys_and_grow_as_layers_come_near() {
        let thickness = 2e-3;
        let mut last = 0.0;
        for k in (0..200).rev() {
            let (d, h) = (thickness * (f64::from(k) + 0.5) / 200.0, 1e-9);
            let push_at = |d: f64| push(d, thickness, 1e6).expect("within the thickness");
            let slope = |f: &dyn Fn(f64) -> f64| -(f(d + h) - f(d - h)) / (2.0 * h);
            let Push { force, stiffness, .. } = push_at(d);
            assert!((slope(&|d| push_at(d).energy) / force - 1.0).abs() < 1e-5, "force at {d}");
            assert!((slope(&|d| push_at(d).force) / stiffness - 1.0).abs() < 1e-5, "stiffness at {d}");
            assert!(force > last, "at {d}");
            last = force;
        }
        assert_eq!(push(thickness, thickness, 1e6), None);
        // Ten times the pressure of body contact at a depth of 1 mm, with a tenth of its penalty.
        assert!(push(0.01 * thickness, thickness, 1e6).expect("within").force > 0.1);
    }
}
