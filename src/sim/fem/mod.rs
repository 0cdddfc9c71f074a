//! FEM-GS (chapter 4): preposition, sewing and draping by physics alone.

mod hands;
pub mod params;
pub mod preposition;
mod run;
mod start;

pub use params::{Params, level_edges};

use crate::body::Body;
use crate::geom::{DistanceField, V3};
use crate::pattern::Garment;
use crate::sim::cloth::Cloth;
use crate::sim::contact::{BodyContact, ClothContact, ContactParams, Skin};
use crate::sim::levels::prolong;
use crate::sim::quality;
use crate::sim::sewing::{self, Springs};
use crate::sim::solver::System;
use crate::sim::walls::Walls;
use crate::sim::{Distortion, Drape, Fabric, Monitor, SimError, Stage};

use hands::Hands;
use run::{Phase, Run};

/// Deepest point of a drape that is good, m.
const DEEPEST_M: f64 = 3e-4;
/// Penalty of the contact with the body where cloth is drawn tight or over a hand, N/m3: fingertips press through a softer one.
const HARD_N_M3: f64 = 1e9;
/// A sewn garment that yields this much has been drawn into the body, m.
const SEWN_INTO_M: f64 = 4e-3;
/// A garment that yields this much on a coarse mesh is tight, m: it is about to leave the offset that keeps it outside.
const TIGHT_M: f64 = 8e-4;
/// Steps on each shape of a hand that opens.
const OPENING_STEPS: u32 = 12;
/// Times at most that a drape is taken up again, because it is not at rest yet or to hold out points inside the body.
const HOLDING_ROUNDS: usize = 5;

/// Dresses a body in a garment.
///
/// `garments` are meshes of the same garment, coarse to fine; the drape is on the last. The coarsest is placed, sewn and
/// roughly draped, each finer one starts from the one before. All settle without friction first, so that the drape
/// does not depend on how the seams were closed; only then does friction hold it. What slides off without is settled again
/// with friction throughout.
///
/// # Errors
/// When the garment cannot be placed, is degenerate, diverges, slides off the body even so, is stretched beyond a limit that
/// is to end it, or the monitor cancels. Not converging is no error.
pub fn simulate(
    body: &Body,
    field: &DistanceField,
    garments: &[Garment],
    fabric: &Fabric,
    params: &Params,
    monitor: &mut dyn Monitor,
) -> Result<Drape, SimError> {
    let (Some(coarsest), Some(finest)) = (garments.first(), garments.last()) else {
        return Err(SimError::NoMesh);
    };
    let mut run = Run::new(params, monitor, garments.len() - 1);
    let mut placed = preposition::place(body, coarsest, params)?;
    let force = start::perturb(params.seed, &mut placed);
    let hands = Hands::near(body, field, &placed);
    let folded = hands.as_ref().map(Hands::folded);
    let skin = Skin::new(&body.mesh).ok();
    let soft = Around { skin: skin.as_ref(), field, hands: hands.as_ref(), contact: params.contact };
    let sewing_field = folded.as_ref().unwrap_or(field);
    let mut sew =
        |around: Around| sew(body, sewing_field, around.contact, coarsest, fabric, placed.clone(), force, &mut run);
    let (mut sewn, yields_m) = sew(soft)?;
    let mut around = if hands.is_some() { soft.hardened() } else { soft };
    if yields_m > SEWN_INTO_M {
        around = soft.hardened();
        (sewn, _) = sew(around)?;
    }
    run.keep_up(&sewn);
    let mut from_sewn = |grip| refine(around, garments, fabric, &sewn, &mut run, grip);
    let last = match from_sewn(Grip::AtTheEnd) {
        // Nothing but friction may hold it up.
        Err(SimError::SlidOff { .. }) => from_sewn(Grip::Throughout)?,
        other => other?,
    };
    Ok(Drape {
        stage: Stage::Drape,
        converged: last.residual <= params.tolerance,
        iterations: run.iterations(),
        residual: last.residual,
        penetration_max_m: quality::penetration_m(body, finest, &last.positions),
        seam_gap_max_m: quality::seam_gap_m(finest, &last.positions),
        self_crossings: quality::self_crossings(&last.sewn, &last.triangles),
        welded_vertices: last.sewn.len(),
        positions: last.positions,
        history: run.into_history(),
        earlier: Vec::new(),
    })
}

/// From when on friction holds a garment.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Grip {
    /// Once it has come to rest without: then the drape does not depend on how the seams were closed.
    AtTheEnd,
    /// From the sewing on: for what would slide off the body without.
    Throughout,
}

/// Settles a sewn garment on the coarsest mesh, and on each finer one from the one before.
fn refine(
    mut around: Around,
    garments: &[Garment],
    fabric: &Fabric,
    sewn: &[V3],
    run: &mut Run,
    grip: Grip,
) -> Result<Settled, SimError> {
    let mut last: Option<(&Garment, Settled)> = None;
    for (level, garment) in garments.iter().enumerate() {
        let cloth = Cloth::new(garment, fabric, sewing::welded(garment))?;
        let x = match &last {
            None => cloth.weld(sewn),
            Some((coarser, drape)) => prolong(coarser, &drape.positions, garment, &cloth, fabric),
        };
        let settled = settle(around, garment, &cloth, x, fabric, run, level, grip)?;
        control(garment, &settled.positions, run.params())?;
        if settled.yields_m > TIGHT_M {
            around = around.hardened();
        }
        last = Some((garment, settled));
    }
    last.map(|(_, settled)| settled).ok_or(SimError::NoMesh)
}

/// Ends a simulation whose cloth is stretched too far, where that is asked for.
fn control(garment: &Garment, positions: &[V3], params: &Params) -> Result<(), SimError> {
    if !params.distortion_stops {
        return Ok(());
    }
    let distortion = Distortion::of(garment, positions)?;
    let limit = params.distortion_limit;
    if distortion.stretch > limit { Err(SimError::Distorted { distortion, limit }) } else { Ok(()) }
}

/// Draws the seams of a garment placed at `x` together, with `force` times the usual force; returns garment positions with
/// all seams (nearly) closed, and how far the contact with the body yields there, m.
#[allow(clippy::too_many_arguments)]
fn sew(
    body: &Body,
    field: &DistanceField,
    contact: ContactParams,
    garment: &Garment,
    fabric: &Fabric,
    mut x: Vec<V3>,
    force: f64,
    run: &mut Run,
) -> Result<(Vec<V3>, f64), SimError> {
    let params = run.params();
    let cloth = Cloth::new(garment, fabric, sewing::unsewn(garment))?;
    let contact = BodyContact::new(field, contact, &cloth.areas).with_points_between(&cloth.triangles);
    let springs = Springs::new(garment, params.seam_stiffness_n_m, force * params.seam_cap_n);
    let sewn = springs.pairs.clone();
    let mut system = System::new(&cloth, contact, Some(springs));
    let apart = ClothContact::new(params.self_contact, &cloth.triangles, &cloth.areas);
    system.self_contact = Some(apart.but_near(sewn.into_iter()));
    let vertex_of = sewing::welded(garment);
    system.walls = Some(Walls::new(body, garment, &vertex_of, &sewing::merged(&vertex_of, &x)).unsewn(&vertex_of));
    run.sew(garment, &mut system, &mut x)?;
    let yields_m = system.contact.yields_m(&x);
    Ok((x, yields_m))
}

/// A settled level.
struct Settled {
    positions: Vec<V3>,
    residual: f64,
    /// How far the contact with the body yields, m.
    yields_m: f64,
    /// Positions and triangles of the sewn vertices.
    sewn: Vec<V3>,
    triangles: Vec<[usize; 3]>,
}

/// The body as contact sees it: exactly, and as a field.
#[derive(Clone, Copy)]
struct Around<'a> {
    /// `None` where the mesh bounds no solid: then only the field holds the cloth.
    skin: Option<&'a Skin<'a>>,
    field: &'a DistanceField,
    /// Hands that the cloth comes near.
    hands: Option<&'a Hands<'a>>,
    contact: ContactParams,
}

impl Around<'_> {
    /// The same with a contact that does not give way under cloth that is drawn tight.
    fn hardened(self) -> Self {
        let stiffness_n_m3 = self.contact.stiffness_n_m3.max(HARD_N_M3);
        Self { contact: ContactParams { stiffness_n_m3, ..self.contact }, ..self }
    }

    /// The fields in which a level settles without friction, one after the other, where they are not the body's own: hands are
    /// folded on the coarsest level and opened on the next.
    fn before_fingers(&self, level: usize, finest: usize) -> Vec<DistanceField> {
        let Some(hands) = self.hands else { return Vec::new() };
        match level {
            0 if finest > 0 => vec![hands.folded()],
            0 | 1 => hands.opening().collect(),
            _ => hands.opening().last().into_iter().collect(),
        }
    }
}

/// Lets a sewn garment come to rest from `x`, without friction and then, on the finest level, with it.
#[allow(clippy::too_many_arguments)]
fn settle(
    around: Around,
    garment: &Garment,
    cloth: &Cloth,
    mut x: Vec<V3>,
    fabric: &Fabric,
    run: &mut Run,
    level: usize,
    grip: Grip,
) -> Result<Settled, SimError> {
    let params = run.params();
    let is_finest = level == run.levels();
    let hold_out = |contact: &mut BodyContact, x: &[V3], is_at_rest: bool| {
        let deepest = |skin| contact.hold_out(skin, &cloth.triangles, x, is_at_rest);
        around.skin.map_or(0.0, deepest)
    };
    let meet = |field, x: &[V3]| {
        let mut contact = BodyContact::new(field, around.contact, &cloth.areas);
        if !is_finest {
            contact = contact.with_points_between(&cloth.triangles);
        } else {
            if let Some(hands) = around.hands {
                contact = contact.with_points_between(&hands.near_triangles(&cloth.triangles, x));
            }
            hold_out(&mut contact, x, false);
        }
        if grip == Grip::Throughout {
            contact.set_friction(Some(fabric.friction_body));
        }
        contact
    };
    let baring: Vec<DistanceField> =
        around.hands.filter(|_| is_finest).map_or(Vec::new(), |hands| hands.baring().collect());
    let stages = around.before_fingers(level, run.levels());
    let (last, opening) = stages.split_last().map_or((around.field, &[][..]), |(last, opening)| (last, opening));
    let mut system = System::new(cloth, meet(opening.first().unwrap_or(last), &x), None);
    system.self_contact = Some(ClothContact::new(params.self_contact, &cloth.triangles, &cloth.areas));
    let brief = Params { coarse_steps: OPENING_STEPS, finest_frictionless_steps: OPENING_STEPS, ..*params };
    for next in opening.iter().skip(1).chain([last]).take(opening.len()) {
        run.drape(garment, &mut system, &mut x, Phase::frictionless(&brief, level, run.levels()))?;
        system.contact = meet(next, &x);
    }
    let mut residual = run.drape(garment, &mut system, &mut x, Phase::frictionless(params, level, run.levels()))?;
    if is_finest {
        if stages.is_empty() {
            hold_out(&mut system.contact, &x, residual <= params.coarse_tolerance);
        } else {
            for field in &baring {
                system.contact = meet(field, &x);
                run.drape(garment, &mut system, &mut x, Phase::frictionless(&brief, level, run.levels()))?;
            }
            system.contact = meet(around.field, &x);
        }
        system.contact.set_friction(Some(fabric.friction_body));
        for round in 0..HOLDING_ROUNDS {
            residual = run.drape(garment, &mut system, &mut x, Phase::final_drape(params, level))?;
            let is_at_rest = residual <= params.tolerance;
            let deepest_m = hold_out(&mut system.contact, &x, is_at_rest);
            if deepest_m <= DEEPEST_M && is_at_rest {
                break;
            }
            if deepest_m > DEEPEST_M && round > 0 {
                system.contact.set_stiffness(around.hardened().contact.stiffness_n_m3);
            }
        }
    }
    let yields_m = system.contact.yields_m(&x);
    Ok(Settled { positions: cloth.unweld(&x), residual, yields_m, sewn: x, triangles: cloth.triangles.clone() })
}

#[cfg(test)]
mod tests;
