//! FEM-GS (chapter 4): placement, sewing and draping by physics alone.

pub mod carry;
mod dress;
pub mod params;
pub mod response;
mod run;
mod settle;
mod start;
mod together;

pub use dress::floor_m;
pub use params::{Params, Sewing, level_edges};

use crate::contact::Skin;
use crate::placement::{self, Bend};
use crate::quality::top_m;
use crate::{Distortion, Drape, Fabric, Monitor, SimError};
use body::Body;
use geom::constants::Constant;
use geom::{DistanceField, V3};
use pattern::Garment;

use crate::hands::Hands;
use dress::Dressing;
use run::Simulation;
use settle::{Grip, Settled};

geom::constants! {
    "fem",
    /// Deepest point inside the body of a drape without fault, m.
    const FAULTLESS_DEPTH_M: f64 = 5e-4;
    /// A garment whose top has come this far up from where it was placed has been squeezed off the body, m.
    const MOST_RISE_M: f64 = 0.25;
    /// Factors on the sewing force with which what ends with a fault, or is torn as it is sewn, is sewn again. Whether
    /// a fold that is drawn tight goes through another is chance, and so is how a ruffle is drawn out. These keep what
    /// is mirrored so.
    const RESEWN: [f64; 2] = [1.5, 0.67];
    /// Steps times vertices (5 to 20 microseconds each) after which a fault is no longer tried to be put right: who waits has waited. A
    /// T-shirt takes 0.7 million.
    const MOST_TRIED: u64 = 12_000_000;
}

/// Dresses a body in a garment.
///
/// `garments` are meshes of the same garment, coarse to fine; the drape is on the last. The coarsest is placed, sewn and
/// roughly draped, each finer one starts from the one before. All settle without friction first, so that the drape
/// does not depend on how the seams were closed; only then does friction hold it. What slides off without is settled again
/// with friction throughout.
///
/// A garment that is much too small is squeezed along the body by its own seams as they close, folds into itself at a
/// narrower place or comes off over the head. Where a tight one ends with a fault or open seams it is therefore sewn
/// once more with friction from the first seam on. Any other that does is sewn from pieces that are bent otherwise,
/// unless how was asked for: a cuff drawn through a wrist, a fold through a fold are chance. What still has a fault is
/// then sewn with more force, and with less. The first such drape that has no fault is taken, or, if the garment came
/// off at first, that stays on; failing that, the best of them. Where all tries so far have taken long, the best of
/// them has to do.
///
/// # Errors
/// When the garment cannot be placed, is degenerate, its seams stay open, it diverges, slides off the body even so or
/// comes off upwards. Also when it is stretched beyond what cloth can be or a limit that is to end it, or the monitor
/// cancels. Not converging is no error.
///
/// # Examples
/// ```
/// use body::{Measurements, Sex};
/// use geom::DistanceField;
/// use pattern::{Style, draft::Model};
/// use sim::{Silent, fabric, fem};
///
/// let body = body::build(&Measurements::of(Sex::Male, 1.76))?;
/// let field = DistanceField::build(&body.mesh, 0.01)?;
/// let medium = &Model::Tshirt.drafts()[1];
/// let style = Style::read(&medium.pieces, Model::Tshirt.seams(), "tshirt.seams.toml")?;
/// let meshes = fem::level_edges(0.05).into_iter().map(|edge_m| style.mesh(edge_m)).collect::<Result<Vec<_>, _>>()?;
///
/// let cotton = &fabric::library()[0];
/// let drape = fem::simulate(&body, &field, &meshes, cotton, &fem::Params::default(), &mut Silent)?;
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
    let (Some(coarsest), Some(finest)) = (garments.first(), garments.last()) else {
        return Err(SimError::NoMesh);
    };
    let mut run = Simulation::new(params, monitor, garments.len() - 1);
    let (placed, force) = placed_at_start(body, coarsest, &params.bend, params.seed)?;
    let hands = Hands::near(body, field, &placed);
    let skin = Skin::new(&body.mesh).ok();
    let (hands, skin) = (hands.as_ref(), skin.as_ref());
    let dressing = Dressing { body, skin, field, hands, garments, fabric, placed: &placed, force };
    let ended = |settled: Settled| settled.into_drape(skin, field, finest, params.tolerance);
    let (settled, grip) = match dressing.dress(Grip::AtTheEnd, &mut run) {
        Err(error) if !run.tries_again() => return Err(error),
        Err(open @ SimError::Open { .. }) => (dressing.dress_or(open, &mut run)?, Grip::Throughout),
        Err(torn @ SimError::Torn { .. }) => (dressing.resewn_or(torn, &RESEWN, &mut run)?, Grip::AtTheEnd),
        other => (other?, Grip::AtTheEnd),
    };
    let mut drape = ended(settled);
    // How far its top has come up from where it was placed.
    let rise_m = |drape: &Drape| top_m(finest, &drape.positions) - top_m(coarsest, &placed);
    let is_off = |drape: &Drape| rise_m(drape) > MOST_RISE_M;
    let came_off = is_off(&drape);
    for Start { placed, force, grip } in other_starts(&dressing, grip, &drape, came_off, params)? {
        if !run.tries_again() || !came_off && run.vertex_steps() > MOST_TRIED {
            break;
        }
        match (Dressing { placed: &placed, force, ..dressing }).dress(grip, &mut run).map(&ended) {
            Err(SimError::Cancelled) => return Err(SimError::Cancelled),
            Ok(again) if !is_off(&again) && (came_off || is_faultless(&again)) => {
                drape = again;
                break;
            }
            Ok(again) if !is_off(&again) && is_better(&again, &drape) => drape = again,
            _ => {}
        }
    }
    if is_off(&drape) {
        return Err(SimError::CameOff { garment: finest.name.clone(), rise_m: rise_m(&drape) });
    }
    Ok(Drape { iterations: run.iterations(), history: run.into_history(), ..drape })
}

/// A way to put a garment on.
struct Start {
    /// Where the vertices of its coarsest mesh are placed, m.
    placed: Vec<V3>,
    /// Factor on the sewing force.
    force: f64,
    /// When friction begins.
    grip: Grip,
}

/// Other ways to put a garment on that was put on as `dressing` says, with this grip, and came off or ended with a fault; in the
/// order in which to try them.
fn other_starts(
    dressing: &Dressing,
    grip: Grip,
    drape: &Drape,
    came_off: bool,
    params: &Params,
) -> Result<Vec<Start>, SimError> {
    let mut starts = Vec::new();
    let (Some(coarsest), Some(finest)) = (dressing.garments.first(), dressing.garments.last()) else {
        return Ok(starts);
    };
    if !came_off && is_faultless(drape) {
        return Ok(starts);
    }
    let (placed, force) = (dressing.placed.to_vec(), dressing.force);
    if grip == Grip::AtTheEnd {
        if came_off || Distortion::of(finest, &drape.positions)?.stretch > params.distortion_limit {
            starts.push(Start { placed: placed.clone(), force, grip: Grip::Throughout });
        } else if let Some(bend) = params.bend.otherwise() {
            let (elsewhere, force) = placed_at_start(dressing.body, coarsest, &bend, params.seed)?;
            // Trousers and what goes round alone are not bent: from the same start comes the same drape.
            starts.extend((elsewhere != placed).then_some(Start { placed: elsewhere, force, grip }));
        }
    }
    if !came_off {
        starts.extend(RESEWN.map(|factor| Start { placed: placed.clone(), force: factor * force, grip }));
    }
    Ok(starts)
}

/// Where a garment starts, as perturbed, m, and the factor on its sewing force.
fn placed_at_start(body: &Body, garment: &Garment, bend: &Bend, seed: u64) -> Result<(Vec<V3>, f64), SimError> {
    let mut placed = placement::place(body, garment, bend)?;
    let force = start::perturb(seed, &mut placed);
    Ok((placed, force))
}

/// Whether a drape is what was asked for: at rest, outside the body, and not through itself.
fn is_faultless(drape: &Drape) -> bool {
    drape.converged && drape.penetration_max_m <= FAULTLESS_DEPTH_M && drape.self_crossings == 0
}

/// Whether one drape's faults are fewer than another's, and none of them worse.
fn is_better(one: &Drape, other: &Drape) -> bool {
    let faults =
        |drape: &Drape| (!drape.converged, drape.self_crossings, drape.penetration_max_m.max(FAULTLESS_DEPTH_M));
    let ((moves, crossings, depth_m), (others, other_crossings, other_m)) = (faults(one), faults(other));
    moves <= others && crossings <= other_crossings && depth_m <= other_m && faults(one) != faults(other)
}

/// Constants of FEM-GS that decide results.
pub(crate) fn constants() -> Vec<Constant> {
    [
        carry::CONSTANTS,
        dress::CONSTANTS,
        CONSTANTS,
        params::CONSTANTS,
        response::CONSTANTS,
        run::CONSTANTS,
        settle::CONSTANTS,
        start::CONSTANTS,
    ]
    .concat()
}

#[cfg(test)]
mod tests;
