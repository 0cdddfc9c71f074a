//! How two layers of cloth push each other apart.

/// What a contact does at some distance, over its penalty stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Energy over the stiffness, m2.
    pub energy: f64,
    /// Force over the stiffness, m; it pushes apart.
    pub force: f64,
    /// Slope of the force with the depth of the contact, over the stiffness.
    pub stiffness: f64,
}

geom::constants! {
    "contact.barrier",
    /// Share of the thickness below which the barrier rises.
    const FROM: f64 = 0.5;
    /// Share of the thickness down to which it rises as a logarithm; nearer still it runs on as a parabola.
    const TO: f64 = 0.01;
    /// Strength of the barrier over that of the spring.
    const STRENGTH: f64 = 4.0;
}

/// The push at a distance: a spring over the thickness, and within half of it a barrier `-(d - d0)^2 ln(d / d0)` besides
/// [Li 2020], whose slope grows ten-thousandfold before it is cut off. `None` beyond the thickness.
#[must_use]
pub fn push(distance_m: f64, thickness_m: f64) -> Option<Push> {
    let depth = thickness_m - distance_m;
    // Not a number where a triangle has collapsed.
    if depth.is_nan() || depth <= 0.0 {
        return None;
    }
    let mut push = Push { energy: 0.5 * depth * depth, force: depth, stiffness: 1.0 };
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
            let at = |d: f64| push(d, thickness).expect("within the thickness");
            let slope = |f: &dyn Fn(f64) -> f64| -(f(d + h) - f(d - h)) / (2.0 * h);
            let Push { force, stiffness, .. } = at(d);
            assert!((slope(&|d| at(d).energy) / force - 1.0).abs() < 1e-5, "force at {d}");
            assert!((slope(&|d| at(d).force) / stiffness - 1.0).abs() < 1e-5, "stiffness at {d}");
            assert!(force > last, "at {d}");
            last = force;
        }
        assert_eq!(push(thickness, thickness), None);
        // Ten times what body contact presses with at a depth of 1 mm, at a tenth of its penalty.
        assert!(push(0.01 * thickness, thickness).expect("within").force > 0.1);
    }
}
