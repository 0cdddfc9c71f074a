//! The loop that both phases of FEM-GS share: step, record, report, stop.

use crate::quality::top_m;
use crate::sewing::OPEN_M;
use crate::solver::{StepInfo, StepParams, Stepper, System};
use crate::{Monitor, Progress, SimError, Step};
use geom::V3;
use pattern::{Garment, Measurement};

use super::params::Params;

/// State at which cloth counts as at rest: either bound suffices.
///
/// The residual says little of how far cloth has to go: it rises and falls with the strains of the last step, and soft
/// modes cause hardly any force. Where another mesh or stiffness follows, cloth that is still is near enough.
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    /// Rms force over mean vertex weight.
    pub residual: f64,
    /// Root mean square displacement that the linear solve finds for a step at the greatest step size: an estimate of
    /// the distance from equilibrium. Steps that move the cloth by less on average, whatever cuts them, are as near. 0
    /// where forces alone tell.
    pub still_m: f64,
}

impl Rest {
    pub fn of_forces(residual: f64) -> Self {
        Self { residual, still_m: 0.0 }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    AtRest,
    /// No step lowered the energy any more, or all moved the cloth by next to nothing.
    Stuck,
    /// All steps were used, or the run has taken too long.
    OutOfSteps,
}

#[derive(Clone, Copy, Debug)]
pub struct Phase {
    name: &'static str,
    level: usize,
    rest: Rest,
    max_steps: u32,
    /// Share of the whole work that is done after it.
    until: f64,
    h_start_s: f64,
}

geom::constants! {
    "fem.run",
    /// Size of the first step at the end of a drape: the cloth has settled already.
    const LAIN_DOWN_S: f64 = 0.5;
    /// Displacement of a full step at which cloth on a coarse mesh is still ([`Rest::still_m`]): the next mesh moves it
    /// by millimetres.
    const COARSE_STILL_M: f64 = 2e-4;
    /// Steps over which the cloth's motion is averaged.
    const CRAWLING_STEPS: usize = 20;
    /// Mean of the root mean square displacements of so many steps below which a drape gets nowhere. A hundred more
    /// would move it by less than its distance from that of another mesh. It has as many more without lengthened steps.
    const CRAWLING_M: f64 = 2e-5;
    /// Greatest number of steps of easing: T-shirts and dresses take 10 to 33.
    const EASING_STEPS: u32 = 50;
    /// Steps times vertices that a drape may take on a mesh with edges of [`USUAL_EDGE_M`], about a minute on one core.
    /// Garments that come to rest mostly take 0.5 to 2 million.
    const MOST_WORK: f64 = 3e6;
    /// Edge length up to which that holds. Finer meshes may take more by the third power: they have more vertices and
    /// take more steps.
    const USUAL_EDGE_M: f64 = 0.015;
    /// Shares of the work of a T-shirt that are done once it is sewn, when the finest mesh begins, when friction begins
    /// to hold it, and when no point is inside the body any more.
    const DONE: [f64; 4] = [0.05, 0.2, 0.9, 0.95];
    /// Factor on the steps of sewing for seams that are nearly closed. A seam that nearly closed has met an obstacle;
    /// more steps would draw it through.
    const PATIENCE: u32 = 3;
    /// Greatest descent of a garment's top from its height as sewn. Trousers and skirts that do not hold at the waist
    /// hold at the hips, a fifth of a metre lower, or not at all.
    pub const MOST_DESCENT_M: f64 = 0.25;
}

impl Phase {
    pub fn frictionless(params: &Params, level: usize, last: usize) -> Self {
        let [sewn, coarse, eased, _] = DONE;
        let part = (level + 1) as f64 / last.max(1) as f64;
        // A finer mesh starts from a drape that has settled; only its short waves are left.
        let has_settled = level > 0 && level == last;
        Self {
            name: "settle",
            level,
            rest: Rest { residual: params.coarse_tolerance, still_m: if level < last { COARSE_STILL_M } else { 0.0 } },
            max_steps: if has_settled { params.finest_frictionless_steps } else { params.coarse_steps },
            until: if level < last { sewn + (coarse - sewn) * part * part } else { eased },
            h_start_s: params.step.h_start_s,
        }
    }

    /// Comes nearly to rest without friction.
    pub fn easing(params: &Params, level: usize, last: usize, rest: Rest, [round, rounds]: [usize; 2]) -> Self {
        let [_, coarse, eased, _] = DONE;
        let until = coarse + (eased - coarse) * (round + 1) as f64 / rounds as f64;
        Self { rest, max_steps: EASING_STEPS, until, ..Self::frictionless(params, level, last) }
    }

    /// A few steps while the surface that the cloth lies on moves.
    pub fn passing(params: &Params, level: usize, last: usize, steps: u32) -> Self {
        Self { max_steps: steps, ..Self::frictionless(params, level, last) }
    }

    pub fn final_drape(params: &Params, level: usize, tolerance: f64) -> Self {
        Self {
            name: "drape",
            level,
            rest: Rest::of_forces(tolerance),
            max_steps: params.max_iterations,
            until: if tolerance > params.tolerance { DONE[3] } else { 1.0 },
            h_start_s: LAIN_DOWN_S.min(params.step.h_max_s),
        }
    }
}

struct Recorded {
    name: &'static str,
    level: usize,
    fraction: f64,
    seam_gap_m: f64,
}

pub struct Simulation<'a> {
    params: &'a Params,
    monitor: &'a mut dyn Monitor,
    levels: usize,
    /// Height of the garment's top as it was sewn.
    worn_at_m: Option<f64>,
    iteration: u32,
    vertex_steps: u64,
    /// Number of vertex steps after which the run ends.
    most_vertex_steps: u64,
    /// Share of the whole work that is done.
    fraction: f64,
    history: Vec<Step>,
    ending: Ending,
}

impl<'a> Simulation<'a> {
    /// Levels are 0 to `levels`.
    pub fn new(params: &'a Params, monitor: &'a mut dyn Monitor, levels: usize) -> Self {
        let history = Vec::new();
        Self {
            params,
            monitor,
            levels,
            worn_at_m: None,
            iteration: 0,
            vertex_steps: 0,
            most_vertex_steps: u64::MAX,
            fraction: 0.0,
            history,
            ending: Ending::OutOfSteps,
        }
    }

    /// Makes the run end with what it has once it has taken long, by the finest mesh.
    pub fn within_patience(mut self, finest: &Garment) -> Self {
        let area = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|v| finest.rest[v]);
            0.5 * (b - a).perp(&(c - a)).abs()
        };
        let mean = finest.triangles.iter().map(area).sum::<f64>() / finest.triangles.len().max(1) as f64;
        // Edge of the equilateral triangle of that area.
        let edge_m = (mean * 4.0 / 3.0_f64.sqrt()).sqrt();
        self.most_vertex_steps = (MOST_WORK * (USUAL_EDGE_M / edge_m).max(1.0).powi(3)) as u64;
        self
    }

    /// True if the run has taken so long that it ends with what it has.
    pub fn is_spent(&self) -> bool {
        self.vertex_steps > self.most_vertex_steps
    }

    pub fn params(&self) -> &'a Params {
        self.params
    }

    pub fn keep_up(&mut self, garment: &Garment, sewn: &[V3]) {
        self.worn_at_m = Some(top_m(garment, sewn));
    }

    /// Number of the finest level; the coarsest is 0.
    pub fn levels(&self) -> usize {
        self.levels
    }

    pub fn tries_again(&self) -> bool {
        self.monitor.tries_again()
    }

    pub fn ending(&self) -> Ending {
        self.ending
    }

    pub fn is_stuck(&self) -> bool {
        self.ending == Ending::Stuck
    }

    pub fn iterations(&self) -> u32 {
        self.iteration
    }

    pub fn vertex_steps(&self) -> u64 {
        self.vertex_steps
    }

    pub fn into_history(self) -> Vec<Step> {
        self.history
    }

    /// Draws the seams together until they can be welded. The springs grow stronger while the seams come no closer: a
    /// tight garment is pulled as hard as it needs, a loose one no harder. `whole` gives the positions of all vertices
    /// of the garment, of which the system may have only a part.
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
            let recorded = Recorded { name: "sew", level: 0, fraction: DONE[0] * done, seam_gap_m: widest };
            self.record(garment, x, &whole(x), info, recorded)?;
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

    /// Steps until the cloth is at rest, gets no nearer, or steps or patience are used up. Returns the residual.
    pub fn drape(
        &mut self,
        garment: &Garment,
        system: &mut System,
        x: &mut Vec<V3>,
        phase: Phase,
    ) -> Result<f64, SimError> {
        let Rest { residual: tolerance, still_m } = phase.rest;
        let mut stepper = Stepper::new(StepParams { h_start_s: phase.h_start_s, ..self.params.step });
        let mut first = 0.0;
        let mut residual = f64::MAX;
        let mut moved_m = [f64::MAX; CRAWLING_STEPS];
        let begins_at = self.fraction;
        self.ending = Ending::OutOfSteps;
        for step in 0..=phase.max_steps {
            let is_unhindered = stepper.is_unhindered();
            let info = stepper.step(system, x, tolerance);
            residual = info.residual;
            if step == 0 {
                first = residual.max(tolerance * 1.01);
            }
            let done = ((first / residual).ln() / (first / tolerance).ln()).clamp(0.0, 1.0);
            let fraction = begins_at + (phase.until - begins_at) * done;
            let positions = system.cloth.unweld(x);
            let recorded = Recorded { name: phase.name, level: phase.level, fraction, seam_gap_m: 0.0 };
            self.record(garment, x, &positions, info, recorded)?;
            moved_m.rotate_left(1);
            moved_m[CRAWLING_STEPS - 1] = info.moved_m;
            let mean_m = moved_m.iter().sum::<f64>() / CRAWLING_STEPS as f64;
            if residual <= tolerance || (is_unhindered && info.reach_m < still_m) || mean_m < still_m {
                self.ending = Ending::AtRest;
            } else if mean_m < CRAWLING_M && stepper.lengthens() {
                stepper.stop_lengthening();
                moved_m.fill(f64::MAX);
                continue;
            } else if stepper.is_stuck() || mean_m < CRAWLING_M {
                self.ending = Ending::Stuck;
            } else if !self.is_spent() {
                continue;
            }
            break;
        }
        Ok(residual)
    }

    fn record(
        &mut self,
        garment: &Garment,
        x: &[V3],
        positions: &[V3],
        info: StepInfo,
        recorded: Recorded,
    ) -> Result<(), SimError> {
        let Recorded { name: phase, level, fraction, seam_gap_m } = recorded;
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

/// Mean of L3D / L2D over the garment's measurements; not a number when it has none.
fn mean_chi(garment: &Garment, positions: &[V3]) -> f64 {
    let chi = |m: &Measurement| m.length_m(&garment.rest, positions) / m.l2d_m;
    garment.measurements.iter().map(chi).sum::<f64>() / garment.measurements.len() as f64
}
