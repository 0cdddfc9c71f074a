//! Proximal Newton: each step minimises `E(x) + |x - x_n|^2_M / (2 h^2)` by one Newton step with a line search.
//!
//! There is no inertia: `h` only keeps a step from going further than its linearisation is good for. It grows while
//! steps succeed, and the limit is static equilibrium.

use nalgebra::Matrix3;

use super::operator::Operator;
use super::pcg::PcgParams;
use super::system::System;
use crate::geom::V3;

/// How to step.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StepParams {
    /// First step size, s.
    pub h_start_s: f64,
    /// Greatest step size, s.
    pub h_max_s: f64,
    /// Growth of the step size after a full step.
    pub growth: f64,
    /// Greatest displacement of a vertex in a step, m.
    pub clamp_m: f64,
    /// Whether a longer step is shortened for all vertices alike; else only for those that would go too far.
    pub clamps_alike: bool,
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
            h_max_s: 2.0,
            growth: 1.5,
            clamp_m: 0.01,
            clamps_alike: false,
            linear_tolerance: 0.1,
            linear_iterations: 300,
            correction_iterations: 30,
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
}

/// Armijo's constant.
const SUFFICIENT_DECREASE: f64 = 1e-4;
const MOST_HALVINGS: usize = 12;

impl Stepper {
    /// Starts at the smallest step.
    #[must_use]
    pub fn new(params: StepParams) -> Self {
        Self { params, h_s: params.h_start_s, last: None }
    }

    /// Takes one step from `x`, unless the residual is already below `tolerance`; says what it did.
    pub fn step(&mut self, system: &mut System, x: &mut Vec<V3>, tolerance: f64) -> StepInfo {
        let (forces, mut operator) = system.assemble(x);
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
        let bend = self.bend(system, &operator, x, &direction, &inertia);
        let (share, next) = self.search(system, x, &direction, &bend, &forces, &inertia);
        self.last = Some(next.iter().zip(x.iter()).map(|(p, q)| p - q).collect());
        *x = next;
        system.contact.drag_anchors(x);
        self.h_s = if share == 1.0 {
            (self.h_s * self.params.growth).min(self.params.h_max_s)
        } else if share < 0.25 {
            (self.h_s * 0.5).max(self.params.h_start_s)
        } else {
            self.h_s
        };
        StepInfo { residual, share }
    }

    /// Second-order correction: what the Newton direction leaves over at its end, through the same stiffness.
    ///
    /// Cloth is a million times softer in bending than in its plane. A step along a soft mode turns triangles and so, in
    /// second order, stretches them; without a correction the line search would cut it to a fraction of a millimetre.
    fn bend(&self, system: &mut System, operator: &Operator, x: &[V3], direction: &[V3], inertia: &[f64]) -> Vec<V3> {
        let end: Vec<V3> = x.iter().zip(direction).map(|(p, d)| p + d).collect();
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
        let limit = self.params.clamp_m;
        let longest = direction.iter().map(V3::norm).fold(0.0, f64::max);
        for d in direction.iter_mut() {
            let length = if self.params.clamps_alike { longest } else { d.norm() };
            if length > limit {
                *d *= limit / length;
            }
        }
    }

    /// The corrected full step where it decreases the proximal energy enough, else the longest share of the uncorrected
    /// direction that does; with the positions there.
    fn search(
        &self,
        system: &System,
        x: &[V3],
        direction: &[V3],
        bend: &[V3],
        forces: &[V3],
        inertia: &[f64],
    ) -> (f64, Vec<V3>) {
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
                let trial = at(share, bent);
                if decreases(&trial, share) {
                    return (share, trial);
                }
            }
            share *= 0.5;
        }
        (share, at(share, 0.0))
    }
}

/// Root mean square length of the vectors.
#[must_use]
pub fn rms(vectors: &[V3]) -> f64 {
    (vectors.iter().map(V3::norm_squared).sum::<f64>() / vectors.len().max(1) as f64).sqrt()
}
