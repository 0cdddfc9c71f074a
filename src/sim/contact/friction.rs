//! Coulomb friction of a contact, by a spring to where it was last held [method 7].

use geom::V3;

geom::constants! {
    "contact.friction",
    /// Share of the sticking stiffness that a sliding contact keeps in the linear system, so that it stays regular.
    const SLIDING_STIFFNESS_SHARE: f64 = 0.1;
}

/// What friction does to a contact.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    /// Energy of the spring and of what slides beyond it, J.
    pub energy_j: f64,
    /// Force across the normal, against the slip, N.
    pub force: V3,
    /// Stiffness across the normal, N/m.
    pub stiffness_n_m: f64,
    /// How far the contact is from where it is held, once it has slid as far as it must, m.
    pub held: V3,
}

/// A contact that may be held by `limit_n` at most.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    /// Coulomb limit, N.
    pub limit_n: f64,
    /// Stiffness while it sticks, N/m.
    pub stiffness_n_m: f64,
    /// Whether it sticks whatever that takes.
    pub is_fast: bool,
}

impl Hold {
    /// Friction of a contact that has come away from its hold by `slip`, m, across the normal.
    #[must_use]
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

/// A vector without its part along a unit normal.
#[must_use]
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
            // Held where it has slid to, it pulls as it did.
            assert!((hold.at(found.held).force - found.force).norm() < 1e-12);
        };
        check(V3::new(1e-4, 0.0, 5e-5), false);
        check(V3::new(1e-3, -2e-4, 0.0), true);
        let fast = Hold { is_fast: true, ..hold };
        assert!((fast.at(V3::x() * 1e-3).force.norm() - 0.1).abs() < 1e-12);
    }
}
