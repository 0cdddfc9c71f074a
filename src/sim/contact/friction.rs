//! Coulomb friction of a contact: a spring to an anchor, whose force is limited.

use geom::V3;

geom::constants! {
    "contact.friction",
    /// Stiffness of a sliding contact in the linear system, as a share of the sticking one. Keeps the system regular.
    const SLIDING_STIFFNESS_SHARE: f64 = 0.1;
}

#[derive(Clone, Copy, Debug)]
pub struct Friction {
    /// `k s^2 / 2` for a slip `s` up to `f_max / k`, linear beyond.
    pub energy_j: f64,
    /// Tangential, opposed to the slip, N.
    pub force: V3,
    pub stiffness_n_m: f64,
    /// Slip from the anchor once it has been dragged along.
    pub held: V3,
}

/// Tangential spring of a contact with a Coulomb limit.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    /// Coulomb limit `f_max`.
    pub limit_n: f64,
    /// Stiffness `k` while the contact sticks.
    pub stiffness_n_m: f64,
    /// True if the contact sticks whatever the force.
    pub is_fast: bool,
}

impl Hold {
    pub fn at(&self, slip: V3) -> Friction {
        let Self { limit_n, stiffness_n_m: k, is_fast } = *self;
        let length = slip.norm();
        if is_fast || k * length <= limit_n {
            return Friction { energy_j: 0.5 * k * length * length, force: slip * -k, stiffness_n_m: k, held: slip };
        }
        let direction = slip / length;
        Friction {
            energy_j: limit_n * (length - 0.5 * limit_n / k),
            force: direction * -limit_n,
            stiffness_n_m: k * SLIDING_STIFFNESS_SHARE,
            held: direction * (limit_n / k),
        }
    }
}

pub fn across(vector: &V3, normal: &V3) -> V3 {
    vector - normal * normal.dot(vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_is_the_energys_and_never_beyond_the_limit() {
        let hold = Hold { limit_n: 0.02, stiffness_n_m: 100.0, is_fast: false };
        let check = |slip: V3, slides: bool| {
            let found = hold.at(slip);
            let step = 1e-9;
            for axis in [V3::x(), V3::y(), V3::z()] {
                let slope =
                    (hold.at(slip + axis * step).energy_j - hold.at(slip - axis * step).energy_j) / (2.0 * step);
                assert!((found.force.dot(&axis) + slope).abs() < 1e-6, "{slip}");
            }
            assert_eq!(found.force.norm() > 0.02 * (1.0 - 1e-12), slides, "{slip}");
            // The dragged anchor gives the same force.
            assert!((hold.at(found.held).force - found.force).norm() < 1e-12);
        };
        check(V3::new(1e-4, 0.0, 5e-5), false);
        check(V3::new(1e-3, -2e-4, 0.0), true);
        let fast = Hold { is_fast: true, ..hold };
        assert!((fast.at(V3::x() * 1e-3).force.norm() - 0.1).abs() < 1e-12);
    }
}
