//! Parameters of FEM-GS.

use crate::contact::{ClothContactParams, ContactParams};
use crate::placement::Bend;
use crate::solver::StepParams;

geom::constants! {
    "fem.params",
    /// Edge length of the coarsest mesh that still wraps an arm: triangles with longer edges pass through it.
    const COARSEST_EDGE_M: f64 = 0.065;
    const MOST_LEVELS: u32 = 3;
}

/// Edge lengths (m), coarse to fine: each half the one before, the last `finest_m`.
pub fn level_edges(finest_m: f64) -> Vec<f64> {
    let coarser = (1..MOST_LEVELS).rev().map(|level| finest_m * f64::from(1 << level));
    coarser.filter(|edge| *edge <= COARSEST_EDGE_M).chain([finest_m]).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sewing {
    pub seam_stiffness_n_m: f64,
    /// Initial force of a seam spring.
    pub seam_cap_n: f64,
    /// Factor by which force and stiffness grow when the seams come no closer.
    pub seam_growth: f64,
    /// Share of the least mean gap so far below which the mean gap must fall to count as progress.
    pub sewing_progress: f64,
    /// Steps without progress after which the springs grow.
    pub sewing_patience: u32,
    pub sewing_h_min_s: f64,
    pub sewing_h_max_s: f64,
    /// Greatest displacement of a vertex in a step.
    pub sewing_clamp_m: f64,
    /// Greatest number of steps where the seams are nearly closed by then; others take up to three times as many.
    pub sewing_steps: u32,
    pub weld_gap_m: f64,
}

impl Default for Sewing {
    fn default() -> Self {
        Self {
            seam_stiffness_n_m: 50.0,
            seam_cap_n: 0.05,
            seam_growth: 1.5,
            sewing_progress: 0.98,
            sewing_patience: 3,
            sewing_h_min_s: 0.02,
            sewing_clamp_m: 0.005,
            sewing_h_max_s: 0.1,
            sewing_steps: 300,
            weld_gap_m: 2e-3,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Params {
    #[serde(flatten)]
    pub bend: Bend,
    /// Seed of a small perturbation of the placed start, by which the sensitivity of the drape is measured; 0 for none.
    pub seed: u64,
    #[serde(flatten)]
    pub sewing: Sewing,
    pub coarse_tolerance: f64,
    pub coarse_steps: u32,
    /// Greatest number of steps without friction on the finest level where a coarser one has settled.
    pub finest_frictionless_steps: u32,
    /// Residual, rms force over mean vertex weight, at which the drape is in equilibrium.
    pub tolerance: f64,
    /// Greatest number of steps of the last phase, with friction.
    pub max_iterations: u32,
    /// Principal stretch beyond 1 that 1 % of the cloth may exceed ([`Distortion`](crate::Distortion)) without a
    /// report. Just below the 17 % up to which the laws of the library's fabrics are measured.
    pub distortion_limit: f64,
    /// True if more than that ends the simulation as soon as a mesh has settled.
    pub distortion_stops: bool,
    pub contact: ContactParams,
    pub self_contact: ClothContactParams,
    pub step: StepParams,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            bend: Bend::default(),
            seed: 0,
            sewing: Sewing::default(),
            coarse_tolerance: 1.0,
            coarse_steps: 300,
            finest_frictionless_steps: 2,
            tolerance: 0.01,
            max_iterations: 600,
            distortion_limit: 0.15,
            distortion_stops: false,
            contact: ContactParams::default(),
            self_contact: ClothContactParams::default(),
            step: StepParams::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_halve_and_stay_fine_enough() {
        let check = |finest: f64, expect: &[f64]| assert_eq!(level_edges(finest), expect);
        check(0.015, &[0.06, 0.03, 0.015]);
        check(0.025, &[0.05, 0.025]);
        check(0.04, &[0.04]);
        check(0.1, &[0.1]);
    }
}
