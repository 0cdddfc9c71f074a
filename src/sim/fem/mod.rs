//! FEM-GS (chapter 4): preposition, sewing and draping by physics alone.

mod dress;
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
use crate::sim::contact::Skin;
use crate::sim::quality;
use crate::sim::{Distortion, Drape, Fabric, Monitor, SimError, Stage};

use dress::Dressing;
use hands::Hands;
use run::Run;
use settle::{Grip, Settled};

/// Deepest point inside the body of a drape without fault, m.
const FAULTLESS_DEPTH_M: f64 = 5e-4;
/// A garment whose top has come this far up from where it was placed has been squeezed off the body, m.
const MOST_RISE_M: f64 = 0.25;

/// Dresses a body in a garment.
///
/// `garments` are meshes of the same garment, coarse to fine; the drape is on the last. The coarsest is placed, sewn and
/// roughly draped, each finer one starts from the one before. All settle without friction first, so that the drape
/// does not depend on how the seams were closed; only then does friction hold it. What slides off without is settled again
/// with friction throughout.
///
/// A garment that is much too small is squeezed along the body by its own seams as they close, folds into itself at a
/// narrower place or comes off over the head. Where a tight one ends with a fault or open seams it is therefore sewn once more with
/// friction from the first seam on; any other that does, from pieces that are bent otherwise, unless how was asked for: a cuff drawn through a wrist, a fold
/// through a fold are chance. That drape is taken if it has no fault, or if the first has come off.
///
/// # Errors
/// When the garment cannot be placed, is degenerate, its seams stay open, it diverges, slides off the body even so or comes off
/// upwards, is stretched beyond what cloth can be or a limit that is to end it, or the monitor cancels. Not converging is no error.
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
    let (placed, force) = placed_at_start(body, coarsest, params)?;
    let hands = Hands::near(body, field, &placed);
    let skin = Skin::new(&body.mesh).ok();
    let (hands, skin) = (hands.as_ref(), skin.as_ref());
    let dressing = Dressing { body, skin, field, hands, garments, fabric, placed: &placed, force };
    let ended = |settled: Settled| Drape {
        stage: Stage::Drape,
        converged: settled.residual <= params.tolerance,
        iterations: 0,
        residual: settled.residual,
        penetration_max_m: quality::penetration_by_field_m(skin, field, finest, &settled.positions),
        seam_gap_max_m: quality::seam_gap_m(finest, &settled.positions),
        self_crossings: quality::self_crossings(&settled.sewn, &settled.triangles),
        welded_vertices: settled.sewn.len(),
        positions: settled.positions,
        history: Vec::new(),
        earlier: Vec::new(),
    };
    let (settled, is_gripped) = match dressing.dress(Grip::AtTheEnd, &mut run) {
        Err(open @ SimError::Open { .. }) => (dressing.dress_or(open, &mut run)?, true),
        other => (other?, false),
    };
    let mut drape = ended(settled);
    let risen_m = rise_m(&placed, &drape.positions);
    let is_off = risen_m > MOST_RISE_M;
    if is_off || !is_faultless(&drape) {
        let is_tight = Distortion::of(finest, &drape.positions)?.stretch > params.distortion_limit;
        let again = if is_gripped {
            None
        } else if is_off || is_tight {
            Some(dressing.dress(Grip::Throughout, &mut run))
        } else {
            let place = |bent: Params| placed_at_start(body, coarsest, &bent);
            let elsewhere = params.otherwise_bent().map(place).transpose()?;
            // Trousers and what goes round alone are not bent: from the same start comes the same drape.
            let elsewhere = elsewhere.filter(|(elsewhere, _)| *elsewhere != placed);
            elsewhere
                .map(|(placed, force)| Dressing { placed: &placed, force, ..dressing }.dress(Grip::AtTheEnd, &mut run))
        };
        let stays_on = |again: &Drape| rise_m(&placed, &again.positions) <= MOST_RISE_M;
        match again.map(|settled| settled.map(&ended)) {
            Some(Err(SimError::Cancelled)) => return Err(SimError::Cancelled),
            Some(Ok(again)) if stays_on(&again) && (is_off || is_faultless(&again)) => drape = again,
            _ if is_off => return Err(SimError::CameOff { garment: finest.name.clone(), rise_m: risen_m }),
            _ => {}
        }
    }
    Ok(Drape { iterations: run.iterations(), history: run.into_history(), ..drape })
}

/// Where a garment starts, as perturbed, m, and the factor on its sewing force.
fn placed_at_start(body: &Body, garment: &Garment, params: &Params) -> Result<(Vec<V3>, f64), SimError> {
    let mut placed = preposition::place(body, garment, params)?;
    let force = start::perturb(params.seed, &mut placed);
    Ok((placed, force))
}

/// Whether a drape is what was asked for: at rest, outside the body, and not through itself.
fn is_faultless(drape: &Drape) -> bool {
    drape.converged && drape.penetration_max_m <= FAULTLESS_DEPTH_M && drape.self_crossings == 0
}

/// How far the top of a garment has come up from where it was placed, m.
fn rise_m(placed: &[V3], draped: &[V3]) -> f64 {
    let top_m = |x: &[V3]| x.iter().map(|p| p.z).fold(f64::MIN, f64::max);
    top_m(draped) - top_m(placed)
}

#[cfg(test)]
mod tests;
