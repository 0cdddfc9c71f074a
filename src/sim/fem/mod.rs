//! FEM-GS (chapter 4): preposition, sewing and draping by physics alone.

mod hands;
pub mod params;
pub mod preposition;
mod run;
mod settle;
mod start;

pub use params::{Params, level_edges};

use crate::body::Body;
use crate::geom::{DistanceField, V3};
use crate::pattern::Garment;
use crate::sim::cloth::Cloth;
use crate::sim::contact::{BodyContact, ClothContact, Skin};
use crate::sim::levels::prolong;
use crate::sim::quality;
use crate::sim::sewing::{self, Springs};
use crate::sim::solver::System;
use crate::sim::walls::Walls;
use crate::sim::{Distortion, Drape, Fabric, Monitor, SimError, Stage};

use hands::Hands;
use run::Run;
use settle::{Around, Grip, Settled, Settling};

/// A sewn garment that yields this much has been drawn into the body, m.
const SEWN_INTO_M: f64 = 4e-3;
/// Gap of seams that a body which does not give way may leave where one that does leaves less, m.
const CLOSED_M: f64 = 1e-2;
/// A garment that yields this much on a coarse mesh is tight, m: it is about to leave the offset that keeps it outside.
const TIGHT_M: f64 = 8e-4;

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
    let mut sew = |around: Around| {
        let folded = Around { field: folded.as_ref().unwrap_or(field), ..around };
        sew(body, folded, coarsest, fabric, placed.clone(), force, &mut run)
    };
    let (mut sewn, yields_m) = sew(soft)?;
    let is_drawn_in = yields_m > SEWN_INTO_M;
    let around = if hands.is_some() || is_drawn_in { soft.hardened() } else { soft };
    if is_drawn_in {
        let (again, _) = sew(around)?;
        if quality::seam_gap_m(coarsest, &again) <= quality::seam_gap_m(coarsest, &sewn).max(CLOSED_M) {
            sewn = again;
        }
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
        penetration_max_m: quality::penetration_by_field_m(body, field, finest, &last.positions),
        seam_gap_max_m: quality::seam_gap_m(finest, &last.positions),
        self_crossings: quality::self_crossings(&last.sewn, &last.triangles),
        welded_vertices: last.sewn.len(),
        positions: last.positions,
        history: run.into_history(),
        earlier: Vec::new(),
    })
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
        let settled = Settling { around, garment, cloth: &cloth, fabric, level, grip }.settle(x, run)?;
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
fn sew(
    body: &Body,
    around: Around,
    garment: &Garment,
    fabric: &Fabric,
    mut x: Vec<V3>,
    force: f64,
    run: &mut Run,
) -> Result<(Vec<V3>, f64), SimError> {
    let params = run.params();
    let cloth = Cloth::new(garment, fabric, sewing::unsewn(garment))?;
    let contact = BodyContact::new(around.field, around.contact, &cloth.areas).with_points_between(&cloth.triangles);
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

#[cfg(test)]
mod tests;
