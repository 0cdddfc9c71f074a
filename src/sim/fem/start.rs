//! Small perturbations of the placed start, by which the sensitivity of the drape to its start is measured.

use crate::laboratory::sheets::{noise, shaken};
use geom::V3;

geom::constants! {
    "fem.start",
    /// Along each axis.
    const SHIFT_M: f64 = 5e-3;
    /// Greatest turn about the vertical: one degree.
    const TURN_RAD: f64 = 0.0175;
    /// Greatest widening about the garment's middle, as a share.
    const WIDENING: f64 = 0.05;
    /// Greatest displacement of single vertices along each axis.
    const JITTER_M: f64 = 1e-3;
    /// Greatest factor on the force of the seam springs; its inverse is the least.
    const FORCE: f64 = 1.5;
}

/// Shifts a placed garment, turns it about the vertical, widens it and jitters each vertex. Returns the factor on the
/// sewing force. Seed 0 changes nothing.
pub fn perturb(seed: u64, x: &mut [V3]) -> f64 {
    if seed == 0 || x.is_empty() {
        return 1.0;
    }
    let draw = noise(6, seed);
    let middle = x.iter().sum::<V3>() / x.len() as f64;
    let turn = nalgebra::Rotation3::from_axis_angle(&V3::z_axis(), TURN_RAD * draw[0]);
    let shift = V3::new(draw[1], draw[2], draw[3]) * SHIFT_M;
    let widening = 1.0 + 0.5 * WIDENING * (1.0 + draw[4]);
    let jitter = shaken(&vec![V3::zeros(); x.len()], JITTER_M, seed);
    for (p, jitter) in x.iter_mut().zip(jitter) {
        let out = turn * (*p - middle);
        *p = middle + V3::new(widening * out.x, widening * out.y, out.z) + shift + jitter;
    }
    FORCE.powf(draw[5])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_moves_everything_a_little_and_always_alike() {
        let placed: Vec<V3> = (0..20).map(|i| V3::new(0.02 * f64::from(i), 0.1, 1.0)).collect();
        let moved = |seed: u64| {
            let mut x = placed.clone();
            let force = perturb(seed, &mut x);
            (x, force)
        };
        assert_eq!(moved(0), (placed.clone(), 1.0));
        assert_eq!(moved(3), moved(3));
        assert_ne!(moved(3), moved(4));
        for seed in 1..20 {
            let (x, force) = moved(seed);
            let farthest = x.iter().zip(&placed).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
            assert!((1e-4..0.03).contains(&farthest), "seed {seed}: {farthest}");
            assert!((1.0 / FORCE..=FORCE).contains(&force));
        }
    }
}
