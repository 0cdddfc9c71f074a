//! Proximal Newton method: each step reduces `E(x) + |x - x_n|^2_M / (2 h^2)` by one Newton step with a line search.
//!
//! There is no dynamics. The proximal term, with the step size `h` and the lumped masses `M`, keeps a step within the
//! range of its linearisation; the code calls it inertia. `h` grows while steps succeed, and the limit is static
//! equilibrium.
//!
//! Cloth is a million times softer in bending than in its plane. A step along a soft mode rotates triangles and so
//! stretches them, to second order. On its own it could go only a fraction of a millimetre. Each step is therefore
//! corrected: the stretch at its end that the linear solve did not predict is removed by the least displacement that
//! does so, as inextensible cloth is projected onto its constraints [Goldenthal 2007]. The step follows the curve `x +
//! alpha d + alpha^2 c`.
//!
//! The stiffness leaves out compressive stresses, which would make it indefinite. Buckling folds therefore move by a
//! part of the way only, in the same direction for many steps. So each step adds a part of the force that compression
//! would have had along the last one (`Stepper::rhs`).

use nalgebra::Matrix3;

use super::line_search::{Line, Reached};
use super::system::{Assembled, Excess, System, rms};
use crate::cloth::element::Foreseen;
use crate::cloth::law::Tensor;
use crate::contact::ClothContact;
use geom::V3;
use linalg::linear;
use linalg::pcg::PcgParams;

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StepParams {
    pub h_start_s: f64,
    pub h_min_s: f64,
    pub h_max_s: f64,
    pub growth: f64,
    /// Greatest displacement of a vertex in a step. A longer step is shortened for all vertices alike. Shortened for
    /// some alone it would shear the cloth, and no longer be a descent direction.
    pub clamp_m: f64,
    /// Relative tolerance.
    pub linear_tolerance: f64,
    pub linear_iterations: usize,
    /// Step size in the proximal term of the second-order correction. So small that the weight of a vertex moves it by
    /// less than 0.2 mm, so that the correction is the shortest one.
    pub correction_h_s: f64,
    /// Relative tolerance.
    pub correction_tolerance: f64,
    /// Greatest number of iterations of the correction's linear solve. Mostly it takes three. Near rest it would take
    /// fifty, and save no step.
    pub correction_iterations: usize,
}

impl Default for StepParams {
    fn default() -> Self {
        Self {
            h_start_s: 0.05,
            h_min_s: 1e-3,
            h_max_s: 2.0,
            growth: 2.0,
            clamp_m: 0.01,
            linear_tolerance: 0.06,
            linear_iterations: 1000,
            correction_h_s: 0.004,
            correction_tolerance: 0.1,
            correction_iterations: 6,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepInfo {
    /// Root mean square of the forces over the mean weight of a vertex, *before* the step.
    pub residual: f64,
    /// 1 for the full step, more where it was lengthened, 0 where no length reduced the energy.
    pub alpha: f64,
    /// Root mean square displacement of the full step that the linear solve found; 0 where none was needed.
    pub reach_m: f64,
    pub moved_m: f64,
}

pub struct Stepper {
    pub(super) params: StepParams,
    /// Step size `h`.
    pub(super) h_s: f64,
    /// Displacement of the last step, with which the linear solve starts: soft modes continue in their direction for
    /// many steps.
    pub(super) last: Option<Vec<V3>>,
    /// Stress of each membrane element that the last linear solve predicted, N/m.
    pub(super) predicted: Option<Vec<Tensor>>,
    /// Successive steps that moved nothing at the least step size.
    idle: u32,
    lengthens: bool,
}

geom::constants! {
    "solver.proximal",
    /// Share of the compressive force along the last step that the next one adds.
    const RUNS_ON: f64 = 0.5;
    /// Step size from which that is done. The first steps on a finer mesh remove errors of the prolongation, and do not
    /// predict the next.
    const RUNS_ON_FROM_S: f64 = 0.5;
    /// Residual forces of a full step up to which it is not lengthened, as a multiple of the final tolerance. The next
    /// step takes what the linear solve leaves of them.
    const ENOUGH: f64 = 2.0;
    /// Step size from which full steps may be lengthened. Lengthened steps throw cloth that has only begun to settle
    /// off the body.
    const LENGTHENED_FROM_S: f64 = 0.2;
    /// Successive steps at the least step size that may move nothing. The first also discards the displacement of the
    /// step before it, and the second lets the friction anchors follow. Every later step repeats the third.
    const IDLE_STEPS: u32 = 3;
}

impl Stepper {
    pub fn new(params: StepParams) -> Self {
        Self { params, h_s: params.h_start_s, last: None, predicted: None, idle: 0, lengthens: true }
    }

    /// Continues another run at the greatest step size, with the membrane stresses that it predicted.
    pub fn going_on(params: StepParams, predicted: Vec<Tensor>) -> Self {
        Self { params, h_s: params.h_max_s, last: None, predicted: Some(predicted), idle: 0, lengthens: true }
    }

    /// True if no step length reduces the energy at the least step size: further steps would do the same.
    pub fn is_stuck(&self) -> bool {
        self.idle >= IDLE_STEPS
    }

    /// Near rest a lengthened step follows soft modes for a micrometre, and calls back the stiff forces that the full
    /// one has balanced.
    pub fn stop_lengthening(&mut self) {
        self.lengthens = false;
    }

    pub fn lengthens(&self) -> bool {
        self.lengthens
    }

    /// True if the step size has grown to its greatest value: the proximal term no longer shortens steps.
    pub fn is_unhindered(&self) -> bool {
        self.h_s >= self.params.h_max_s
    }

    /// Membrane stresses that the last step predicted, N/m; empty before the first.
    pub fn predicted(&self) -> &[Tensor] {
        self.predicted.as_deref().unwrap_or_default()
    }

    /// Takes one step of the whole cloth, unless the residual is already at most `tolerance`. Returns the residual
    /// before the step and its length.
    pub fn step_whole(&mut self, system: &mut System, x: &mut Vec<V3>, tolerance: f64) -> StepInfo {
        let mut start = system.assemble(x, self.predicted.as_deref());
        let mut residual = rms(&start.forces) / system.mean_weight();
        if residual <= tolerance && system.self_contact.as_mut().is_some_and(ClothContact::ripen) {
            start = system.assemble(x, self.predicted.as_deref());
            residual = rms(&start.forces) / system.mean_weight();
        }
        if residual <= tolerance {
            return StepInfo { residual, alpha: 1.0, reach_m: 0.0, moved_m: 0.0 };
        }
        let without_inertia = start.operator.diagonal.clone();
        let inertia: Vec<f64> = system.cloth.masses.iter().map(|m| m / (self.h_s * self.h_s)).collect();
        add_inertia(&mut start.operator.diagonal, &inertia);
        let linear =
            PcgParams { tolerance: self.params.linear_tolerance, max_iterations: self.params.linear_iterations };
        let rhs = self.rhs(system, &start.forces);
        let mut direction = self.last.take().unwrap_or_else(|| vec![V3::zeros(); x.len()]);
        system.linear.solve(&start.operator, x, &rhs, &mut direction, &linear);
        let reach_m = rms(&direction);
        shorten(&mut direction, self.params.clamp_m);
        let free_share = system.free_share(&direction).min(1.0);
        direction.iter_mut().for_each(|d| *d *= free_share);
        start.operator.diagonal = without_inertia;
        let (correction, foreseen) = self.correction(system, &start, x, &direction);
        let enough_n =
            (self.lengthens && self.h_s >= LENGTHENED_FROM_S).then(|| ENOUGH * tolerance * system.mean_weight());
        let line = Line { system, x, start: &start, direction: &direction, correction: &correction, inertia: &inertia };
        let Reached { alpha, positions: next } = line.search(enough_n);
        self.predicted = Some(foreseen.iter().map(|f| f.after(alpha)).collect());
        let moved: Vec<V3> = next.iter().zip(x.iter()).map(|(p, q)| p - q).collect();
        let moved_m = rms(&moved);
        self.last = Some(moved);
        *x = next;
        system.drag_anchors(x);
        self.idle = if alpha == 0.0 && self.h_s <= self.params.h_min_s { self.idle + 1 } else { 0 };
        self.h_s = if alpha >= 1.0 {
            (self.h_s * self.params.growth).min(self.params.h_max_s)
        } else if alpha < 0.25 {
            (self.h_s * 0.5).max(self.params.h_min_s)
        } else {
            self.h_s
        };
        StepInfo { residual, alpha, reach_m, moved_m }
    }

    /// Right-hand side of the linear solve: `forces`, plus a share of the compressive force along the last step.
    ///
    /// The assembled stiffness `K` leaves out the compressive part `C`; the true one is `K - C`. The relative error is
    /// the greater, the softer a fold is. `K d = f` is solved instead of `K d = f + C d`. The last step resembles this
    /// one, so half of its `C d` is added.
    fn rhs(&self, system: &System, forces: &[V3]) -> Vec<V3> {
        let mut rhs = forces.to_vec();
        if let (Some(last), Some(stresses)) = (&self.last, &self.predicted)
            && self.h_s >= RUNS_ON_FROM_S
        {
            system.cloth.membrane.add_compression(stresses, last, RUNS_ON, &mut rhs);
        }
        rhs
    }

    /// Second-order correction of a step from `x`, where `start` acts without inertia, and the stresses predicted at
    /// its end.
    fn correction(&self, system: &System, start: &Assembled, x: &[V3], direction: &[V3]) -> (Vec<V3>, Vec<Foreseen>) {
        let Excess { forces, mut operator, foreseen } = system.excess(start, x, direction);
        let h2 = self.params.correction_h_s * self.params.correction_h_s;
        let inertia: Vec<f64> = system.cloth.masses.iter().map(|m| m / h2).collect();
        add_inertia(&mut operator.diagonal, &inertia);
        let params = PcgParams {
            tolerance: self.params.correction_tolerance,
            max_iterations: self.params.correction_iterations,
        };
        let mut correction = vec![V3::zeros(); x.len()];
        linear::jacobi(&operator, &forces, &mut correction, &params);
        shorten(&mut correction, self.params.clamp_m);
        (correction, foreseen)
    }
}

fn shorten(direction: &mut [V3], farthest_m: f64) {
    let longest = direction.iter().map(V3::norm).fold(0.0, f64::max);
    if longest > farthest_m {
        direction.iter_mut().for_each(|d| *d *= farthest_m / longest);
    }
}

fn add_inertia(diagonal: &mut [Matrix3<f64>], inertia: &[f64]) {
    for (block, m) in diagonal.iter_mut().zip(inertia) {
        *block += Matrix3::identity() * *m;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::Cloth;
    use crate::contact::{BodyContact, ClothContactParams, ContactParams};
    use crate::laboratory::{self, sheets};
    use crate::sewing::unsewn;
    use crate::testing::fabric;
    use geom::{DistanceField, V2, shapes};

    #[test]
    fn a_contact_that_a_step_makes_does_not_throw_the_cloth() {
        // Two layers 3 mm apart, the lower 2 mm above a ball.
        let (radius, apart) = (0.1, V2::new(0.5, 0.0));
        let field = DistanceField::build(&shapes::sphere(radius, 32), 0.006).expect("a closed ball");
        let ((lower, mut triangles), (upper, others)) = (sheets::sheet(8, 8, 0.02), sheets::sheet(4, 4, 0.02));
        triangles.extend(others.iter().map(|t| t.map(|v| v + lower.len())));
        let rest: Vec<V2> = lower.iter().copied().chain(upper.iter().map(|p| p + apart)).collect();
        let garment = laboratory::garment((rest, triangles));
        let is_upper: Vec<bool> = garment.rest.iter().map(|p| p.x >= apart.x).collect();
        let place = |(p, is_upper): (&V2, &bool)| {
            let (p, height) = if *is_upper { (p - apart + V2::new(0.043, 0.037), 3e-3) } else { (*p, 0.0) };
            V3::new(p.x - 0.08, p.y - 0.08, radius + 3e-3 + height)
        };
        let x: Vec<V3> = garment.rest.iter().zip(&is_upper).map(place).collect();
        let cloth = Cloth::new(&garment, &fabric(), unsewn(&garment)).expect("sound");
        let body = BodyContact::new(&field, ContactParams::default(), &cloth.areas);
        let mut system = System::new(&cloth, body.with_points_between(&cloth.triangles), None);
        system.self_contact = Some(ClothContact::new(ClothContactParams::default(), &cloth.triangles, &cloth.areas));
        let stepper = Stepper::new(StepParams::default());
        let mut check = |lower: f64, upper: f64| {
            let start = system.assemble(&x, None);
            let d: Vec<V3> =
                is_upper.iter().map(|&is_upper| V3::z() * -(if is_upper { upper } else { lower })).collect();
            let (bend, _) = stepper.correction(&system, &start, &x, &d);
            let longest = bend.iter().map(V3::norm).fold(0.0, f64::max);
            assert!(longest > 1e-4 && longest < 1.5 * lower.max(upper), "{longest} after {lower} and {upper}");
        };
        // Onto the ball, and one layer onto the other.
        check(4e-3, 4e-3);
        check(0.0, 2.8e-3);
    }
}
