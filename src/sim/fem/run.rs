//! The loop that both phases of FEM-GS share: step, record, report, stop.

use crate::quality::top_m;
use crate::sewing::OPEN_M;
use crate::solver::{StepInfo, StepParams, Stepper, System};
use crate::{Monitor, Progress, SimError, Step};
use geom::V3;
use pattern::{Garment, Measurement};

use super::params::Params;

/// When a stretch of steps ends, and what it is called.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    name: &'static str,
    level: usize,
    /// Residual that ends it.
    tolerance: f64,
    /// Steps that end it at the latest.
    max_steps: u32,
    /// Share of the whole work done before and after it, for the progress.
    share: [f64; 2],
    /// First step size, s.
    h_start_s: f64,
}

geom::constants! {
    "fem.run",
    /// First step size of the end of a drape, s: it goes on with cloth that has lain down already.
    const LAIN_DOWN_S: f64 = 0.5;
    /// Steps of easing at most: T-shirts and dresses take 10 to 33.
    const EASING_STEPS: u32 = 50;
    /// Steps of sewing at most over those that nearly closed seams get: these have met what holds them up, and are drawn through it.
    const PATIENCE: u32 = 3;
    /// How far the top of a garment may come down from where it was sewn, m: trousers and skirts that do not hold at the waist
    /// hold at the hips, a fifth of a metre lower, or not at all.
    pub const MOST_DESCENT_M: f64 = 0.25;
}

impl Phase {
    /// Coming to rest without friction on level `level` of `last`.
    pub fn frictionless(params: &Params, level: usize, last: usize) -> Self {
        let at = |l: usize| 0.2 + 0.6 * (l as f64 / (last + 1) as f64).powi(2);
        // What a finer mesh starts from has settled already; it only has to lie down.
        let has_settled = level > 0 && level == last;
        Self {
            name: "settle",
            level,
            tolerance: params.coarse_tolerance,
            max_steps: if has_settled { params.finest_frictionless_steps } else { params.coarse_steps },
            share: [at(level), at(level + 1)],
            h_start_s: params.step.h_start_s,
        }
    }

    /// Coming nearly to rest on a level, before it does so with more stiffness.
    pub fn easing(params: &Params, level: usize, last: usize, tolerance: f64) -> Self {
        Self { tolerance, max_steps: EASING_STEPS, ..Self::frictionless(params, level, last) }
    }

    /// A few steps of coming to rest, while what the cloth lies on moves.
    pub fn passing(params: &Params, level: usize, last: usize, steps: u32) -> Self {
        Self { max_steps: steps, ..Self::frictionless(params, level, last) }
    }

    /// The end of the drape, with friction.
    pub fn final_drape(params: &Params, level: usize, tolerance: f64) -> Self {
        Self {
            name: "drape",
            level,
            tolerance,
            max_steps: params.max_iterations,
            share: [0.8, 1.0],
            h_start_s: LAIN_DOWN_S.min(params.step.h_max_s),
        }
    }
}

/// A simulation under way.
pub struct Simulation<'a> {
    params: &'a Params,
    monitor: &'a mut dyn Monitor,
    levels: usize,
    /// Height of the garment's top as it was sewn, m.
    worn_at_m: Option<f64>,
    iteration: u32,
    vertex_steps: u64,
    fraction: f64,
    history: Vec<Step>,
    /// Whether the last stretch of steps ended because none moved anything.
    is_stuck: bool,
}

impl<'a> Simulation<'a> {
    /// Starts a run over levels 0 to `levels`.
    pub fn new(params: &'a Params, monitor: &'a mut dyn Monitor, levels: usize) -> Self {
        let history = Vec::new();
        Self {
            params,
            monitor,
            levels,
            worn_at_m: None,
            iteration: 0,
            vertex_steps: 0,
            fraction: 0.0,
            history,
            is_stuck: false,
        }
    }

    /// How it simulates.
    pub fn params(&self) -> &'a Params {
        self.params
    }

    /// From here on a garment whose top comes down far from that of `sewn` ends the run.
    pub fn keep_up(&mut self, garment: &Garment, sewn: &[V3]) {
        self.worn_at_m = Some(top_m(garment, sewn));
    }

    /// Number of the finest level; the coarsest is 0.
    pub fn levels(&self) -> usize {
        self.levels
    }

    /// Whether a garment that ends with a fault is put on again otherwise.
    pub fn tries_again(&self) -> bool {
        self.monitor.tries_again()
    }

    /// Whether the last stretch of steps ended because no step lowered the energy any more.
    pub fn is_stuck(&self) -> bool {
        self.is_stuck
    }

    /// Iterations so far.
    pub fn iterations(&self) -> u32 {
        self.iteration
    }

    /// Sum over all iterations of the vertices that were stepped.
    pub fn vertex_steps(&self) -> u64 {
        self.vertex_steps
    }

    /// Every recorded step.
    pub fn into_history(self) -> Vec<Step> {
        self.history
    }

    /// Draws the seams together until they can be welded. The springs grow stronger while the seams do not get closer, so
    /// that a tight garment is pulled as hard as it needs and a loose one is not torn about.
    /// `whole` are the positions of all of the garment's vertices, of which the system may have a part.
    pub fn sew(
        &mut self,
        garment: &Garment,
        system: &mut System,
        x: &mut Vec<V3>,
        whole: impl Fn(&[V3]) -> Vec<V3>,
    ) -> Result<(), SimError> {
        let params = self.params;
        let mut stepper = Stepper::new(StepParams {
            h_start_s: params.sewing.sewing_h_min_s,
            h_max_s: params.sewing.sewing_h_max_s,
            clamp_m: params.sewing.sewing_clamp_m,
            ..params.step
        });
        let gaps =
            |system: &System, x: &[V3]| system.springs.as_ref().map_or((0.0, 0.0), |s| (s.gap_m(x), s.mean_gap_m(x)));
        let start = gaps(system, x).0.max(f64::MIN_POSITIVE);
        let (mut least, mut stalled) = (start, 0);
        for step in 1..=PATIENCE * params.sewing.sewing_steps {
            let info = stepper.step(system, x, 0.0);
            let (widest, mean) = gaps(system, x);
            let done = (1.0 - (widest / start).sqrt()).clamp(0.0, 1.0);
            self.record(garment, x, &whole(x), info, "sew", 0, widest, 0.2 * done)?;
            let is_closed =
                widest <= params.sewing.weld_gap_m || (step >= params.sewing.sewing_steps && widest <= OPEN_M);
            if is_closed || stepper.is_stuck() {
                break;
            }
            if mean < least * params.sewing.sewing_progress {
                (least, stalled) = (mean, 0);
            } else {
                stalled += 1;
            }
            if stalled >= params.sewing.sewing_patience && info.alpha >= 0.25 {
                stalled = 0;
                if !system.springs.as_mut().is_some_and(|springs| springs.tighten(params.sewing.seam_growth)) {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Steps until the residual is reached, the steps are used up, or none gets anywhere; returns the residual.
    pub fn drape(
        &mut self,
        garment: &Garment,
        system: &mut System,
        x: &mut Vec<V3>,
        phase: Phase,
    ) -> Result<f64, SimError> {
        let mut stepper = Stepper::new(StepParams { h_start_s: phase.h_start_s, ..self.params.step });
        let mut first = 0.0;
        let mut residual = f64::MAX;
        for step in 0..=phase.max_steps {
            let info = stepper.step(system, x, phase.tolerance);
            residual = info.residual;
            if step == 0 {
                first = residual.max(phase.tolerance * 1.01);
            }
            let done = ((first / residual).ln() / (first / phase.tolerance).ln()).clamp(0.0, 1.0);
            let fraction = phase.share[0] + (phase.share[1] - phase.share[0]) * done;
            let positions = system.cloth.unweld(x);
            self.record(garment, x, &positions, info, phase.name, phase.level, 0.0, fraction)?;
            if residual <= phase.tolerance || stepper.is_stuck() {
                break;
            }
        }
        self.is_stuck = stepper.is_stuck();
        Ok(residual)
    }

    #[allow(clippy::too_many_arguments)]
    fn record(
        &mut self,
        garment: &Garment,
        x: &[V3],
        positions: &[V3],
        info: StepInfo,
        phase: &'static str,
        level: usize,
        seam_gap_m: f64,
        fraction: f64,
    ) -> Result<(), SimError> {
        self.iteration += 1;
        self.vertex_steps += x.len() as u64;
        if !x.iter().all(|p| p.iter().all(|c| c.is_finite())) {
            return Err(SimError::Diverged { garment: garment.name.clone(), iteration: self.iteration });
        }
        let descent_m = self.worn_at_m.map_or(0.0, |worn_at| worn_at - top_m(garment, positions));
        if descent_m > MOST_DESCENT_M {
            return Err(SimError::SlidOff { garment: garment.name.clone(), descent_m });
        }
        let step = Step {
            iteration: self.iteration,
            level: level as u32,
            residual: info.residual,
            seam_gap_m,
            e_chi: mean_chi(garment, positions),
        };
        self.history.push(step);
        self.fraction = self.fraction.max(fraction);
        self.monitor.progress(&Progress { phase, fraction: self.fraction, step });
        if self.monitor.wants_snapshot() {
            self.monitor.snapshot(positions);
        }
        if self.monitor.cancelled() { Err(SimError::Cancelled) } else { Ok(()) }
    }
}

/// E of the moment: the mean of L3D / L2D over the garment's measurements; not a number when it has none.
fn mean_chi(garment: &Garment, positions: &[V3]) -> f64 {
    let chi = |m: &Measurement| m.length_m(&garment.rest, positions) / m.l2d_m;
    garment.measurements.iter().map(chi).sum::<f64>() / garment.measurements.len() as f64
}
