//! Parameters of FEM-GS.

use crate::contact::{ClothContactParams, ContactParams};
use crate::placement::Bend;
use crate::solver::StepParams;

geom::constants! {
    "fem.params",
    /// Coarsest mesh that still wraps an arm: triangles of longer edges pass through it, m.
    const COARSEST_EDGE_M: f64 = 0.065;
    /// Most meshes that are worth going through.
    const MOST_LEVELS: u32 = 3;
}

/// Edge lengths (m) of the meshes that FEM-GS goes through, coarse to fine: each half the one before, the last `finest_m`.
#[must_use]
pub fn level_edges(finest_m: f64) -> Vec<f64> {
    let coarser = (1..MOST_LEVELS).rev().map(|level| finest_m * f64::from(1 << level));
    coarser.filter(|edge| *edge <= COARSEST_EDGE_M).chain([finest_m]).collect()
}

/// How FEM-GS closes seams.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sewing {
    /// Stiffness of a seam spring, N/m.
    pub seam_stiffness_n_m: f64,
    /// Force of a seam spring at first, N.
    pub seam_cap_n: f64,
    /// Growth of force and stiffness when the seams come no closer.
    pub seam_growth: f64,
    /// The seams come closer when their mean gap falls below this share of the least so far.
    pub sewing_progress: f64,
    /// Steps without that after which the springs grow.
    pub sewing_patience: u32,
    /// Least step size while sewing, s.
    pub sewing_h_min_s: f64,
    /// Greatest step size while sewing, s.
    pub sewing_h_max_s: f64,
    /// Greatest displacement of a vertex in a step of sewing, m.
    pub sewing_clamp_m: f64,
    /// Most steps of sewing, where seams are nearly closed by then; others take up to three times as many.
    pub sewing_steps: u32,
    /// Gap at which seams are welded, m.
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

/// How FEM-GS places, sews and drapes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Params {
    /// How pieces of the trunk are bent before they are sewn.
    #[serde(flatten)]
    pub bend: Bend,
    /// Draws a start that differs a little from the placed one, to measure what the drape owes to it; 0 for the placed one.
    pub seed: u64,
    /// How seams are closed.
    #[serde(flatten)]
    pub sewing: Sewing,
    /// Residual without friction at which a level is good enough to start the next.
    pub coarse_tolerance: f64,
    /// Most steps without friction on a level.
    pub coarse_steps: u32,
    /// Most steps without friction on the finest level where a coarser one has settled.
    pub finest_frictionless_steps: u32,
    /// Residual, rms force over mean vertex weight, at which the drape counts as in equilibrium.
    pub tolerance: f64,
    /// Most steps of the last phase, with friction.
    pub max_iterations: u32,
    /// Principal stretch beyond 1 that 1 % of the cloth may exceed ([`Distortion`](crate::Distortion)); more is reported. Just
    /// below the 17 % up to which the laws of the library's fabrics are measured.
    pub distortion_limit: f64,
    /// Whether more than that ends the simulation, as soon as a mesh has settled.
    pub distortion_stops: bool,
    /// How the cloth meets the body.
    pub contact: ContactParams,
    /// Contact of the cloth with itself.
    pub self_contact: ClothContactParams,
    /// Step sizes, tolerances and limits of the solver.
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
