//! Proximal Newton: each step minimises `E(x) + |x - x_n|^2_M / (2 h^2)` by one Newton step with a line search.
//!
//! There is no inertia: `h` only keeps a step from going further than its linearisation is good for. It grows while
//! steps succeed, and the limit is static equilibrium.

use nalgebra::{Matrix2, Matrix3};

use super::operator::Operator;
use super::pcg::PcgParams;
use super::system::System;
use crate::geom::V3;

/// How to step.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StepParams {
    /// First step size, s.
    pub h_start_s: f64,
    /// Least step size, s.
    pub h_min_s: f64,
    /// Greatest step size, s.
    pub h_max_s: f64,
    /// Growth of the step size after a full step.
    pub growth: f64,
    /// Greatest displacement of a vertex in a step, m. A longer step is shortened for all vertices alike: shortened for
    /// some alone it would shear the cloth, and no longer descend.
    pub clamp_m: f64,
    /// Relative tolerance of the linear solve.
    pub linear_tolerance: f64,
    /// Most iterations of the linear solve.
    pub linear_iterations: usize,
    /// Most iterations of the linear solve of the second-order correction.
    pub correction_iterations: usize,
}

impl Default for StepParams {
    fn default() -> Self {
        Self {
            h_start_s: 0.05,
            h_min_s: 1e-3,
            h_max_s: 2.0,
            growth: 1.5,
            clamp_m: 0.01,
            linear_tolerance: 0.02,
            linear_iterations: 1000,
            correction_iterations: 100,
        }
    }
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepInfo {
    /// Rms force over mean vertex weight *before* the step.
    pub residual: f64,
    /// Share of the full step that was taken.
    pub share: f64,
}

/// The state that outlives a step.
pub struct Stepper {
    params: StepParams,
    h_s: f64,
    /// Displacement of the last step: soft modes go on in their direction for many steps.
    last: Option<Vec<V3>>,
    /// Stress of each membrane element that the last linear solve foresaw, N/m.
    predicted: Option<Vec<Matrix2<f64>>>,
}

/// Armijo's constant.
const SUFFICIENT_DECREASE: f64 = 1e-4;
const MOST_HALVINGS: usize = 12;

impl Stepper {
    /// Starts at the smallest step.
    #[must_use]
    pub fn new(params: StepParams) -> Self {
        Self { params, h_s: params.h_start_s, last: None, predicted: None }
    }

    /// Takes one step from `x`, unless the residual is already below `tolerance`; says what it did.
    pub fn step(&mut self, system: &mut System, x: &mut Vec<V3>, tolerance: f64) -> StepInfo {
        let (forces, mut operator) = system.assemble(x, self.predicted.as_deref());
        let residual = rms(&forces) / system.mean_weight();
        if residual <= tolerance {
            return StepInfo { residual, share: 1.0 };
        }
        let inertia: Vec<f64> = system.cloth.masses.iter().map(|m| m / (self.h_s * self.h_s)).collect();
        for (block, m) in operator.diagonal.iter_mut().zip(&inertia) {
            *block += Matrix3::identity() * *m;
        }
        let linear =
            PcgParams { tolerance: self.params.linear_tolerance, max_iterations: self.params.linear_iterations };
        let mut direction = self.last.take().unwrap_or_else(|| vec![V3::zeros(); x.len()]);
        system.linear.solve(&operator, &forces, &mut direction, &linear);
        self.clamp(&mut direction);
        let bend = self.bend(system, &mut operator, x, &direction, &inertia);
        let Found { share, bent, positions: next } = self.search(system, x, &direction, &bend, &forces, &inertia);
        self.predicted = Some(predicted(system, x, &direction, &bend, share, bent));
        self.last = Some(next.iter().zip(x.iter()).map(|(p, q)| p - q).collect());
        *x = next;
        system.contact.drag_anchors(x);
        self.h_s = if share == 1.0 {
            (self.h_s * self.params.growth).min(self.params.h_max_s)
        } else if share < 0.25 {
            (self.h_s * 0.5).max(self.params.h_min_s)
        } else {
            self.h_s
        };
        StepInfo { residual, share }
    }

    /// Second-order correction: what the Newton direction leaves over at its end, through the same stiffness.
    ///
    /// Cloth is a million times softer in bending than in its plane. A step along a soft mode turns triangles and so, in
    /// second order, stretches them; without a correction the line search would cut it to a fraction of a millimetre.
    fn bend(
        &self,
        system: &mut System,
        operator: &mut Operator,
        x: &[V3],
        direction: &[V3],
        inertia: &[f64],
    ) -> Vec<V3> {
        let end: Vec<V3> = x.iter().zip(direction).map(|(p, d)| p + d).collect();
        system.contact.stiffen(&end, &mut operator.diagonal);
        let mut remainder = system.forces(&end);
        for ((r, d), m) in remainder.iter_mut().zip(direction).zip(inertia) {
            *r -= d * *m;
        }
        let linear =
            PcgParams { tolerance: self.params.linear_tolerance, max_iterations: self.params.correction_iterations };
        let mut bend = vec![V3::zeros(); x.len()];
        system.linear.solve(operator, &remainder, &mut bend, &linear);
        self.clamp(&mut bend);
        bend
    }

    /// Shortens a direction so that no vertex moves further than allowed.
    fn clamp(&self, direction: &mut [V3]) {
        let longest = direction.iter().map(V3::norm).fold(0.0, f64::max);
        if longest > self.params.clamp_m {
            direction.iter_mut().for_each(|d| *d *= self.params.clamp_m / longest);
        }
    }

    /// The longest share of the step that decreases the proximal energy enough, corrected where that does, else along the
    /// direction alone; none where no share does.
    fn search(
        &self,
        system: &System,
        x: &[V3],
        direction: &[V3],
        bend: &[V3],
        forces: &[V3],
        inertia: &[f64],
    ) -> Found {
        let start = system.energy(x);
        let slope: f64 = forces.iter().zip(direction).map(|(f, d)| f.dot(d)).sum();
        let decreases = |trial: &[V3], share: f64| {
            let moved = trial.iter().zip(x).zip(inertia).map(|((p, q), m)| 0.5 * m * (p - q).norm_squared());
            system.energy(trial) + moved.sum::<f64>() <= start - SUFFICIENT_DECREASE * share * slope.max(0.0)
        };
        // x + t direction + t^2 bend: the correction is of second order.
        let at = |share: f64, bent: f64| -> Vec<V3> {
            let point = |((p, d), b): ((&V3, &V3), &V3)| p + d * share + b * (bent * share * share);
            x.iter().zip(direction).zip(bend).map(point).collect()
        };
        let mut share = 1.0;
        for _ in 0..MOST_HALVINGS {
            for bent in [1.0, 0.0] {
                let positions = at(share, bent);
                if decreases(&positions, share) {
                    return Found { share, bent: bent > 0.0, positions };
                }
            }
            share *= 0.5;
        }
        Found { share: 0.0, bent: false, positions: x.to_vec() }
    }
}

/// What the line search found.
struct Found {
    /// Share of the full step.
    share: f64,
    /// Whether the second-order correction is in it.
    bent: bool,
    positions: Vec<V3>,
}

/// Membrane stresses that the linear solves of a step foresee at its end: the correction's where it was taken in full.
fn predicted(system: &System, x: &[V3], direction: &[V3], bend: &[V3], share: f64, bent: bool) -> Vec<Matrix2<f64>> {
    let membrane = &system.cloth.membrane;
    if bent && share == 1.0 {
        let end: Vec<V3> = x.iter().zip(direction).map(|(p, d)| p + d).collect();
        membrane.predicted_stress(x, &end, bend)
    } else {
        let taken: Vec<V3> = direction.iter().map(|d| d * share).collect();
        membrane.predicted_stress(x, x, &taken)
    }
}

/// Root mean square length of the vectors.
#[must_use]
pub fn rms(vectors: &[V3]) -> f64 {
    (vectors.iter().map(V3::norm_squared).sum::<f64>() / vectors.len().max(1) as f64).sqrt()
}
