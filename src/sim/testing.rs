//! Helpers for the tests of the simulators: finite differences.

use crate::geom::V3;
use crate::sim::Fabric;

/// A fabric with different numbers everywhere, so that a mix-up shows.
pub fn fabric() -> Fabric {
    Fabric {
        name: "test".into(),
        density_kg_m2: 0.15,
        thickness_m: 3e-4,
        membrane_warp_n_m: 800.0,
        membrane_weft_n_m: 500.0,
        membrane_coupling_n_m: 120.0,
        shear_n_m: 90.0,
        bending_warp_nm: 8e-6,
        bending_weft_nm: 5e-6,
        friction_body: 0.3,
        friction_self: 0.5,
        source: "test".into(),
        stretched: None,
    }
}

/// Asserts that `forces` is minus the gradient of `energy`, by central differences of step `h`, to `relative` of the
/// greatest force.
pub fn check_forces(energy: impl Fn(&[V3]) -> f64, forces: &[V3], x: &[V3], h: f64, relative: f64) {
    let scale = forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
    for i in 0..x.len() {
        for k in 0..3 {
            let at = |d: f64| {
                let mut moved = x.to_vec();
                moved[i][k] += d;
                energy(&moved)
            };
            let expected = -(at(h) - at(-h)) / (2.0 * h);
            let error = (forces[i][k] - expected).abs();
            assert!(error <= relative * scale, "vertex {i} axis {k}: {} for {expected}", forces[i][k]);
        }
    }
}
