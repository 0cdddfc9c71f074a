//! Hybrid-GS (chapter 5): geometry first, then physics; the pattern's size is kept on any body.
//!
//! Four phases, each with a result of its own: [`mapping`] lays the pieces on the body, [`sewn`] joins them, [`popup`] gives
//! them back their size, and a short drape lets them come to rest on the fine mesh.

mod assemble;
mod draw;
mod elastic;
pub mod features;
mod follow;
pub mod form;
pub mod gap;
mod give;
pub mod harmonic;
mod inset;
mod layers;
mod locate;
pub mod mapping;
mod obstacle;
pub mod outline;
pub mod patch;
pub mod path;
pub mod popup;
pub mod pyramid;
pub mod relax;
mod ring;
pub mod sewn;
mod silhouette;
pub mod sparse;
mod untangle;

use crate::cloth::Cloth;
use crate::contact::Skin;
use crate::levels::prolong;
use crate::walls::Walls;
use crate::{Drape, Fabric, Monitor, Progress, SimError, Stage, Staged, Step, quality};
use body::{Body, Layer};
use geom::constants::Constant;
use geom::{DistanceField, V3};
use pattern::{Garment, Measurement};

pub use gap::{Closure, closures};
pub use mapping::OnForm;
pub use popup::Backend;
pub use relax::RelaxParams;
pub use sewn::Sewn;

use layers::Parted;
use relax::{Push, Relaxation};

/// Parameters of Hybrid-GS.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Params {
    /// Numbers of measurements that are not controlled: what their chi is without.
    pub uncontrolled: Vec<u32>,
    /// How the size comes back in the pop-up.
    pub popup: Backend,
    /// Pop-up and drape.
    pub relax: RelaxParams,
    /// Steps of the drape in which the cloth slides over the body.
    pub push_steps: u32,
    /// Steps after them, in which contact is firm.
    pub firm_steps: u32,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            uncontrolled: Vec::new(),
            popup: Backend::default(),
            relax: RelaxParams::default(),
            push_steps: 40,
            firm_steps: 15,
        }
    }
}

geom::constants! {
    "hybrid",
    /// Rms movement in a step below which a drape counts as come to rest, m.
    const AT_REST_M: f64 = 1e-3;
    /// Steps of the drape after which it is judged anew where the garment is too small: it slides.
    const JUDGE_EVERY: u32 = 20;
    /// Last steps after each of which cloth that is large enough is lifted out of the body.
    const LIFTS: u32 = 3;
    /// Steps that the drape goes on after cloth was pulled apart, and how often it does at most.
    const AGAIN: u32 = 6;
    const MOST_AGAIN: u32 = 2;
    /// Mean error of the measurements above which a garment has not got its size.
    const OFF: f64 = 0.01;
    /// How far the top of a garment may slide down, m: trousers and skirts that do not hold at the waist hold at the hips.
    const MOST_DESCENT_M: f64 = 0.25;
    /// Rounds in which cloth that runs through itself is pulled apart in the end.
    const PARTINGS: u32 = 80;
}

/// What each phase left, positions of the garment's vertices in metres.
#[derive(Clone, Debug)]
pub struct Phases {
    /// On the form, piece by piece; `None` where it cannot be mapped. The drape may have been drawn together all the same.
    pub mapped: Option<OnForm>,
    /// Draped; its earlier stages are those sewn, smoothed and lifted onto the fine mesh, and popped up.
    pub drape: Drape,
}

/// Dresses a body in a garment.
///
/// `garments` are meshes of the same garment, coarse to fine; the drape is on the last. What has features on the body is mapped onto it by
/// them; all else, and what ends with a fault, is drawn together about the body from the mesh before the last (`draw`).
///
/// # Errors
/// When a piece cannot be placed, is degenerate, its seams stay open, the positions diverge, or the monitor cancels.
///
/// # Examples
/// ```
/// use body::{Measurements, Sex};
/// use geom::DistanceField;
/// use pattern::{Style, draft::Model};
/// use sim::{Silent, fabric, hybrid};
///
/// let body = body::build(&Measurements::of(Sex::Male, 1.76))?;
/// let field = DistanceField::build(&body.mesh, 0.01)?;
/// let medium = &Model::Tshirt.drafts()[1];
/// let garment = Style::read(&medium.pieces, Model::Tshirt.seams(), "tshirt.seams.toml")?.mesh(0.05)?;
///
/// let cotton = &fabric::library()[0];
/// let drape = hybrid::simulate(&body, &field, &[garment], cotton, &hybrid::Params::default(), &mut Silent)?;
/// assert!(drape.converged && drape.seam_gap_max_m == 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate(
    body: &Body,
    field: &DistanceField,
    garments: &[Garment],
    fabric: &Fabric,
    params: &Params,
    monitor: &mut dyn Monitor,
) -> Result<Drape, SimError> {
    phases(body, field, garments, fabric, params, monitor).map(|phases| phases.drape)
}

/// [`simulate`] with what each phase left.
///
/// # Errors
/// As there.
pub fn phases(
    body: &Body,
    field: &DistanceField,
    garments: &[Garment],
    fabric: &Fabric,
    params: &Params,
    monitor: &mut dyn Monitor,
) -> Result<Phases, SimError> {
    let Some(garment) = garments.last() else { return Err(SimError::NoMesh) };
    let skin = Skin::new(&body.mesh).ok();
    let dressing = Dressing { body, skin: skin.as_ref(), field, garments, garment, fabric, params };
    let mut run = Simulation { garment, monitor, history: Vec::new() };
    let mapped = match mapping::map(body, garment) {
        Err(error @ (SimError::CannotMap { .. } | SimError::CannotPlace { .. })) => Err(error),
        mapped => Ok(mapped?),
    };
    let (mut best, mut failed): (Option<(Faults, Drape)>, _) = (None, None);
    for start in mapped.as_ref().map_or(&[Start::Drawn][..], |_| &Start::ALL) {
        let sewn = match (start, &mapped) {
            (Start::Drawn, _) | (_, Err(_)) => dressing.drawn(&mut run),
            (_, Ok(mapped)) => Ok(Sewn::new(garment, &mapped.positions)),
        };
        match sewn.and_then(|sewn| dressing.dress(&sewn, *start != Start::Mapped, &mut run)) {
            Ok(drape) => {
                let faults = Faults::of(garment, &drape);
                if best.as_ref().is_none_or(|(least, _)| faults.is_less(least)) {
                    best = Some((faults, drape));
                }
            }
            Err(SimError::Cancelled) => return Err(SimError::Cancelled),
            Err(error) => failed = failed.or(Some(error)),
        }
        if best.as_ref().is_some_and(|(faults, _)| faults.is_none()) {
            break;
        }
    }
    match (best, mapped) {
        (Some((_, drape)), mapped) => {
            Ok(Phases { mapped: mapped.ok(), drape: Drape { history: run.history, ..drape } })
        }
        // What it could not be mapped for says more than what it could not be drawn together for.
        (None, Err(refused)) => Err(refused),
        (None, Ok(_)) => Err(failed.unwrap_or(SimError::NoMesh)),
    }
}

/// How a garment begins.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Start {
    /// Mapped onto the body.
    Mapped,
    /// Likewise, with more care.
    Careful,
    /// Drawn together about the body.
    Drawn,
}

impl Start {
    /// In the order in which they are tried, until one ends without a fault.
    const ALL: [Self; 3] = [Self::Mapped, Self::Careful, Self::Drawn];
}

/// What tells a worse drape from a better one.
#[derive(Clone, Copy)]
struct Faults {
    moves: bool,
    self_crossings: usize,
    /// Mean error of the measurements.
    off: f64,
}

impl Faults {
    fn of(garment: &Garment, drape: &Drape) -> Self {
        let error = |m: &Measurement| (m.length_m(&garment.rest, &drape.positions) / m.l2d_m - 1.0).abs();
        let off = garment.measurements.iter().map(error).sum::<f64>() / garment.measurements.len().max(1) as f64;
        Self { moves: !drape.converged, self_crossings: drape.self_crossings, off }
    }

    fn is_none(&self) -> bool {
        !self.moves && self.self_crossings == 0 && self.off <= OFF
    }

    fn is_less(&self, other: &Self) -> bool {
        let crossings = (self.moves, self.self_crossings).cmp(&(other.moves, other.self_crossings));
        crossings.then(self.off.total_cmp(&other.off)).is_lt()
    }
}

/// A garment and the body that is to wear it.
#[derive(Clone, Copy)]
struct Dressing<'a> {
    body: &'a Body,
    /// Its exact surface, where it bounds a solid.
    skin: Option<&'a Skin<'a>>,
    field: &'a DistanceField,
    /// Meshes of the garment, coarse to fine.
    garments: &'a [Garment],
    /// The last of them.
    garment: &'a Garment,
    fabric: &'a Fabric,
    params: &'a Params,
}

impl Dressing<'_> {
    /// Draws the pieces together about the body, on the mesh before the last, or, where their seams stay open on it, on the coarsest: fewer
    /// vertices have less to be caught by.
    fn drawn(&self, run: &mut Simulation) -> Result<Sewn, SimError> {
        let Self { body, field, garments, garment, fabric, .. } = *self;
        let finer = garments.iter().rev().nth(1).unwrap_or(garment);
        let mut together = |coarse: &Garment| {
            let places = draw::together(body, field, coarse, fabric, |x| run.drawing(coarse, x))?;
            let mut sewn = Sewn::at(garment, &vec![V3::zeros(); garment.rest.len()]);
            let cloth = Cloth::new(garment, fabric, sewn.vertex_of.clone())?;
            sewn.x = prolong(coarse, &places, garment, &cloth, fabric);
            Ok(sewn)
        };
        match (together(finer), garments.first()) {
            (Err(SimError::Open { .. }), Some(coarsest)) if garments.len() > 2 => together(coarsest),
            (drawn, _) => drawn,
        }
    }

    /// Pop-up and drape of a sewn garment. With more care no cloth goes through cloth, and the body gives way to whatever is tight.
    fn dress(&self, sewn: &Sewn, takes_care: bool, run: &mut Simulation) -> Result<Drape, SimError> {
        let Self { body, field, garment, fabric, params, .. } = *self;
        let controls: Vec<&Measurement> =
            garment.measurements.iter().filter(|m| !params.uncontrolled.contains(&m.no)).collect();
        let walls = Walls::new(body, garment, &sewn.vertex_of, &sewn.x);
        let mut relaxation = Relaxation::new(field, garment, sewn, fabric, &controls, walls, params.relax)?
            .over_feet(body.control.ring_centre(Layer::AnkleRight).z);
        if takes_care {
            relaxation = relaxation.kept_apart(garment, sewn).giving_way();
        }
        relaxation.part_layers(PARTINGS);
        let on_skin = sewn.unsewn(&relaxation.x);
        let lift: f64 = relaxation.x.iter().zip(&sewn.x).map(|(a, b)| (a - b).norm_squared()).sum();
        run.record("sew", 0.2, 0, &on_skin, (lift / sewn.x.len() as f64).sqrt() / AT_REST_M)?;
        let mut done = 0.0;
        let error = |x: &[V3]| mean_chi(garment, &sewn.unsewn(x)) - 1.0;
        let cloth = popup::Cloth { garment, sewn };
        popup::reconstruct(params.popup, cloth, &mut relaxation, body, error, |now, moved| {
            done += 1.0;
            let fraction = 0.2 + 0.4 * done / f64::from(popup::steps());
            run.record("popup", fraction, 1, &sewn.unsewn(&now.x), moved / AT_REST_M)
        })?;
        relaxation.part_layers(PARTINGS);
        let popped = sewn.unsewn(&relaxation.x);
        let (last, self_crossings) = run.drape(&mut relaxation, body, sewn, params)?;
        let positions = sewn.unsewn(&relaxation.x);
        Ok(Drape {
            stage: Stage::Drape,
            converged: last <= AT_REST_M,
            iterations: run.history.len() as u32,
            residual: last / AT_REST_M,
            penetration_max_m: quality::penetration_by_field_m(self.skin, field, garment, &positions),
            seam_gap_max_m: quality::seam_gap_m(garment, &positions),
            self_crossings,
            braced_n: None,
            is_stuck: false,
            welded_vertices: sewn.x.len(),
            positions,
            history: Vec::new(),
            earlier: vec![
                Staged { stage: Stage::Sewn, positions: on_skin },
                Staged { stage: Stage::Popup, positions: popped },
            ],
            kept: None,
        })
    }
}

/// E: mean chi over the measurements; positions of the garment's vertices in m.
fn mean_chi(garment: &Garment, positions: &[V3]) -> f64 {
    let chi = |m: &Measurement| m.length_m(&garment.rest, positions) / m.l2d_m;
    garment.measurements.iter().map(chi).sum::<f64>() / garment.measurements.len() as f64
}

/// A run under way: what is recorded and reported of each step.
struct Simulation<'a> {
    garment: &'a Garment,
    monitor: &'a mut dyn Monitor,
    history: Vec<Step>,
}

impl Simulation<'_> {
    /// Phase 4; returns the rms movement of the last step, m, and how many edges still pierce the cloth. What slides off the body by its
    /// weight is laid on it without.
    fn drape(
        &mut self,
        relaxation: &mut Relaxation,
        body: &Body,
        sewn: &Sewn,
        params: &Params,
    ) -> Result<(f64, usize), SimError> {
        let popped = relaxation.place();
        let top_m = |x: &[V3]| quality::top_m(self.garment, &sewn.unsewn(x));
        let top_before_m = top_m(&relaxation.x);
        let fallen = self.lay(relaxation, body, sewn, params, 1.0)?;
        if top_before_m - top_m(&relaxation.x) <= MOST_DESCENT_M {
            return Ok(fallen);
        }
        relaxation.go_back(&popped);
        self.lay(relaxation, body, sewn, params, 0.0)
    }

    /// Lets the cloth slide over the body with a share of its weight, and then lie.
    fn lay(
        &mut self,
        relaxation: &mut Relaxation,
        body: &Body,
        sewn: &Sewn,
        params: &Params,
        gravity: f64,
    ) -> Result<(f64, usize), SimError> {
        let steps = params.push_steps + params.firm_steps;
        let (mut step, mut end) = (0, steps);
        loop {
            step += 1;
            if step % JUDGE_EVERY == 1 && step <= params.push_steps {
                relaxation.judge_again(&body.mesh);
            } else {
                relaxation.correct();
            }
            let push = Push { firm: step > params.push_steps, gravity, share: 1.0, closer_m: 0.0 };
            let last = relaxation.step(push);
            if step + LIFTS > end {
                relaxation.lift_out();
            }
            let parted = (step >= end).then(|| relaxation.part_layers(PARTINGS));
            let fraction = 0.6 + 0.4 * f64::from(step.min(steps)) / f64::from(steps.max(1));
            self.record("drape", fraction, 2, &sewn.unsewn(&relaxation.x), last / AT_REST_M)?;
            match parted {
                // What was pulled apart has lost its size there.
                Some(Parted { found, .. }) if found > 0 && end < steps + MOST_AGAIN * AGAIN => end += AGAIN,
                Some(Parted { left, .. }) => return Ok((last, left)),
                None => {}
            }
        }
    }

    /// Reports pieces that are being drawn together: `x` are the places of a coarser mesh's vertices, m.
    fn drawing(&mut self, coarse: &Garment, x: &[V3]) -> Result<(), SimError> {
        let iteration = self.history.len() as u32 + 1;
        let seam_gap_m = quality::seam_gap_m(coarse, x);
        let step = Step { iteration, level: 0, residual: 0.0, seam_gap_m, e_chi: mean_chi(coarse, x) };
        self.monitor.progress(&Progress { phase: "sew", fraction: 0.1, step });
        if self.monitor.cancelled() { Err(SimError::Cancelled) } else { Ok(()) }
    }

    fn record(
        &mut self,
        phase: &'static str,
        fraction: f64,
        level: u32,
        positions: &[V3],
        residual: f64,
    ) -> Result<(), SimError> {
        let iteration = self.history.len() as u32 + 1;
        if !positions.iter().all(|p| p.iter().all(|c| c.is_finite())) {
            return Err(SimError::Diverged { garment: self.garment.name.clone(), iteration });
        }
        let e_chi = mean_chi(self.garment, positions);
        let step = Step { iteration, level, residual, seam_gap_m: 0.0, e_chi };
        self.history.push(step);
        self.monitor.progress(&Progress { phase, fraction, step });
        if self.monitor.wants_snapshot() {
            self.monitor.snapshot(positions);
        }
        if self.monitor.cancelled() { Err(SimError::Cancelled) } else { Ok(()) }
    }
}

/// Constants of Hybrid-GS that decide results.
pub(crate) fn constants() -> Vec<Constant> {
    [
        assemble::CONSTANTS,
        draw::CONSTANTS,
        elastic::CONSTANTS,
        form::CONSTANTS,
        give::CONSTANTS,
        inset::CONSTANTS,
        layers::CONSTANTS,
        mapping::CONSTANTS,
        CONSTANTS,
        popup::CONSTANTS,
        relax::CONSTANTS,
        ring::CONSTANTS,
        sewn::CONSTANTS,
        silhouette::CONSTANTS,
        untangle::CONSTANTS,
    ]
    .concat()
}

#[cfg(test)]
mod tests;
