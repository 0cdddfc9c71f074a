//! Helpers for the tests of the simulators: finite differences and flat sheets.

use crate::geom::{V2, V3};
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
    }
}

/// A flat sheet of `columns` x `rows` squares of side `step`, each cut into two triangles, alternately.
pub fn sheet(columns: usize, rows: usize, step: f64) -> (Vec<V2>, Vec<[usize; 3]>) {
    let at = |i: usize, j: usize| j * (columns + 1) + i;
    let rest = (0..=rows).flat_map(|j| (0..=columns).map(move |i| V2::new(i as f64 * step, j as f64 * step))).collect();
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    (rest, triangles)
}

/// A repeatable sequence of numbers in -1..1.
pub fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..count)
        .map(|_| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
        .collect()
}

/// Positions with noise of amplitude `size` added.
pub fn shaken(positions: &[V3], size: f64, seed: u64) -> Vec<V3> {
    let noise = noise(3 * positions.len(), seed);
    positions.iter().enumerate().map(|(i, p)| p + V3::from_row_slice(&noise[3 * i..3 * i + 3]) * size).collect()
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
