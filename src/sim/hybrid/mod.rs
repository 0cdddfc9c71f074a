//! Hybrid-GS (chapter 5): geometry first, then physics; the pattern's size is kept on any body.
//!
//! Four phases, each with a result of its own: [`mapping`] lays the pieces on the body, [`welded_mesh`] joins them,
//! [`popup`] gives them back their size, and a short drape lets them come to rest on the fine mesh.

mod assemble;
mod continuation;
mod draw;
mod elastic;
pub mod features;
pub mod form;
pub mod gap;
mod girth_lines;
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
mod silhouette;
pub mod sparse;
mod underarms;
mod untangle;
pub mod welded_mesh;

use crate::cloth::Cloth;
use crate::contact::Skin;
use crate::dressing::{self, Dressing, Wearer};
use crate::levels::prolong;
use crate::tries::{self, Criteria, Faults, Trial};
use crate::walls::Walls;
use crate::{Drape, Fabric, Monitor, Progress, SimError, Stage, Staged, Step, quality};
use body::Body;
use geom::constants::Constant;
use geom::{DistanceField, V3};
use pattern::{Garment, Measurement};

pub use gap::{Closure, closures};
pub use mapping::OnForm;
pub use popup::Backend;
pub use relax::RelaxParams;
pub use welded_mesh::Sewn;

use layers::Parted;
use relax::{Push, Relaxation};

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Params {
    /// Numbers of measurements that are not controlled, to see what their chi is then.
    pub uncontrolled: Vec<u32>,
    pub popup: Backend,
    pub relax: RelaxParams,
    pub push_steps: u32,
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
    /// Rms movement in a step below which a drape counts as at rest.
    const AT_REST_M: f64 = 1e-3;
    /// Steps after which it is judged anew where the garment is too small: it slides.
    const JUDGE_EVERY: u32 = 20;
    /// Last steps after each of which cloth that is large enough is lifted out of the body.
    const LIFTS: u32 = 3;
    /// Steps by which the drape goes on after layers were separated, and the greatest number of times that it does so.
    const AGAIN: u32 = 6;
    const MOST_AGAIN: u32 = 2;
    /// Mean error of the measurements above which a garment has not got its size.
    const OFF: f64 = 0.01;
    /// Greatest descent of a garment's top: trousers and skirts that do not hold at the waist hold at the hips.
    const MOST_DESCENT_M: f64 = 0.25;
    const PARTINGS: u32 = 80;
}

#[derive(Clone, Debug)]
pub struct Phases {
    /// Garment on the form, piece by piece; `None` where it cannot be mapped. It may have been drawn together all the
    /// same.
    pub mapped: Option<OnForm>,
    /// Earlier stages are the garment sewn, smoothed and lifted off the body, and popped up.
    pub drape: Drape,
}

/// `garments` are meshes of the same garment, coarse to fine; the drape is on the last. A garment whose corners have
/// features on the body is mapped onto it by these. If its drape has a fault it is mapped again, with its layers kept
/// apart. Any other garment, and one that still has a fault, is drawn together about the body on the mesh before the
/// last (`draw`). The first drape without a fault is taken, failing that the best.
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

/// [`simulate`] with the results of all phases.
pub fn phases(
    body: &Body,
    field: &DistanceField,
    garments: &[Garment],
    fabric: &Fabric,
    params: &Params,
    monitor: &mut dyn Monitor,
) -> Result<Phases, SimError> {
    let layer = dressing::Layer { garments, fabric };
    let garment = layer.finest()?;
    let skin = Skin::new(&body.mesh).ok();
    let dressing = Dressing { wearer: Wearer { body, field }, skin: skin.as_ref(), layer };
    let mut run = Simulation { garment, monitor, history: Vec::new() };
    let mapped = match mapping::map(body, garment) {
        Err(error @ (SimError::CannotMap { .. } | SimError::CannotPlace { .. })) => Err(error),
        mapped => Ok(mapped?),
    };
    let ways = mapped.as_ref().map_or(&[Start::Drawn][..], |_| &Start::ALL);
    let mut reshaping = Reshaping { dressing, garment, params, mapped: mapped.as_ref().ok(), run: &mut run };
    match (tries::best(&mut reshaping, None, ways.iter().copied()), mapped) {
        (Ok(drape), mapped) => Ok(Phases { mapped: mapped.ok(), drape: Drape { history: run.history, ..drape } }),
        // The refusal of the mapping says more than a failure to draw the pieces together.
        (Err(error), Err(refused)) if !matches!(error, SimError::Cancelled) => Err(refused),
        (Err(error), _) => Err(error),
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Start {
    Mapped,
    /// Mapped, with the layers kept apart; the body gives way to all tight cloth.
    Careful,
    /// Drawn together about the body, with the same care.
    Drawn,
}

impl Start {
    /// Order in which they are tried, until one ends without a fault.
    const ALL: [Self; 3] = [Self::Mapped, Self::Careful, Self::Drawn];
}

struct Reshaping<'a, 'r, 'm> {
    dressing: Dressing<'a>,
    garment: &'a Garment,
    params: &'a Params,
    /// `None` where the garment cannot be mapped.
    mapped: Option<&'a OnForm>,
    run: &'r mut Simulation<'m>,
}

impl Trial for Reshaping<'_, '_, '_> {
    type Way = Start;

    /// Depth counts for nothing: cloth that is too small keeps its size and lies inside the body. Rest comes first: it
    /// is measured by movement, and cloth that moves by a millimetre in a step is still sliding. Its crossings and
    /// lengths are not those that it would come to rest with.
    const CRITERIA: Criteria = Criteria { depth_m: 0.0, length_error: OFF, is_rest_first: true };

    fn put_on(&mut self, way: &Start) -> Result<Drape, SimError> {
        let sewn = match (way, self.mapped) {
            (Start::Drawn, _) | (_, None) => self.drawn()?,
            (_, Some(mapped)) => Sewn::new(self.garment, &mapped.positions),
        };
        self.dress(&sewn, *way != Start::Mapped)
    }

    fn faults(&self, drape: &Drape) -> Faults {
        let garment = self.garment;
        let error = |m: &Measurement| (m.length_m(&garment.rest, &drape.positions) / m.l2d_m - 1.0).abs();
        let length_error =
            garment.measurements.iter().map(error).sum::<f64>() / garment.measurements.len().max(1) as f64;
        let &Drape { converged, self_crossings, .. } = drape;
        Faults { came_off: false, moves: !converged, self_crossings, depth_m: 0.0, length_error }
    }

    fn has_time(&self, _: &Faults) -> bool {
        self.run.monitor.tries_again()
    }
}

impl Reshaping<'_, '_, '_> {
    /// Draws the pieces together about the body on the mesh before the last. Where seams stay open, does so on the
    /// coarsest: fewer vertices are caught by less.
    fn drawn(&mut self) -> Result<Sewn, SimError> {
        let Dressing { wearer, layer, .. } = self.dressing;
        let (garments, fabric, garment) = (layer.garments, layer.fabric, self.garment);
        let finer = garments.iter().rev().nth(1).unwrap_or(garment);
        let mut together = |coarse: &Garment| {
            let places = draw::together(wearer, coarse, fabric, |x| self.run.drawing(coarse, x))?;
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

    /// Pop-up and drape. With care no cloth goes through cloth, and the body gives way to all tight cloth.
    fn dress(&mut self, sewn: &Sewn, takes_care: bool) -> Result<Drape, SimError> {
        let Dressing { wearer: Wearer { body, field }, skin, layer } = self.dressing;
        let (garment, params) = (self.garment, self.params);
        let run = &mut *self.run;
        let controls: Vec<&Measurement> =
            garment.measurements.iter().filter(|m| !params.uncontrolled.contains(&m.no)).collect();
        let walls = Walls::new(body, garment, &sewn.vertex_of, &sewn.x);
        let mut relaxation = Relaxation::new(field, garment, sewn, layer.fabric, &controls, walls, params.relax)?
            .over_feet(body.control.ring_centre(body::Layer::AnkleRight).z);
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
        let Lain { moved_m, crossings } = run.drape(&mut relaxation, body, sewn, params)?;
        let positions = sewn.unsewn(&relaxation.x);
        Ok(Drape {
            stage: Stage::Drape,
            converged: moved_m <= AT_REST_M,
            iterations: run.history.len() as u32,
            residual: moved_m / AT_REST_M,
            penetration_max_m: quality::penetration_by_field_m(skin, field, garment, &positions),
            seam_gap_max_m: quality::seam_gap_m(garment, &positions),
            self_crossings: crossings,
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

struct Lain {
    /// Rms movement of the vertices in the last step.
    moved_m: f64,
    crossings: usize,
}

fn mean_chi(garment: &Garment, positions: &[V3]) -> f64 {
    let chi = |m: &Measurement| m.length_m(&garment.rest, positions) / m.l2d_m;
    garment.measurements.iter().map(chi).sum::<f64>() / garment.measurements.len() as f64
}

struct Simulation<'a> {
    garment: &'a Garment,
    monitor: &'a mut dyn Monitor,
    history: Vec<Step>,
}

impl Simulation<'_> {
    /// Phase 4: lets the cloth slide and come to rest. A garment that its weight draws off the body is laid on it again
    /// without weight.
    fn drape(
        &mut self,
        relaxation: &mut Relaxation,
        body: &Body,
        sewn: &Sewn,
        params: &Params,
    ) -> Result<Lain, SimError> {
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

    fn lay(
        &mut self,
        relaxation: &mut Relaxation,
        body: &Body,
        sewn: &Sewn,
        params: &Params,
        gravity: f64,
    ) -> Result<Lain, SimError> {
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
                // Layers that were separated have lost their size there.
                Some(Parted { found, .. }) if found > 0 && end < steps + MOST_AGAIN * AGAIN => end += AGAIN,
                Some(Parted { left, .. }) => return Ok(Lain { moved_m: last, crossings: left }),
                None => {}
            }
        }
    }

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
        girth_lines::CONSTANTS,
        welded_mesh::CONSTANTS,
        silhouette::CONSTANTS,
        untangle::CONSTANTS,
    ]
    .concat()
}

#[cfg(test)]
mod tests;
