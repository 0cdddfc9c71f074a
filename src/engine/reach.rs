//! Effect of a movement on a garment: its drape is carried from one pose into another and measured in both.

use serde::Serialize;

use crate::carry::{Carried, Carry};
use crate::error::EngineError;
use crate::faults::drape_faults;
use crate::stages::Garb;
use body::{Body, Pose};
use fit::{on_body, reach};
use geom::units::mm;
use sim::sewn::Sewn;
use sim::{Drape, Monitor};
use spec::Parameters;
use store::{InOrigin, Origin, Result};

/// Share of a piece's vertices whose tensions are left out, the greatest first: single vertices say little.
const LEFT_OUT: f64 = 0.01;

/// Displacement of an opening into the garment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReachedOpening {
    pub opening: String,
    pub drawn_mm: f64,
    pub drawn_most_mm: f64,
}

/// A quantity before and after the movement, for a piece of the garment or a region of the body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReachedAt {
    pub place: String,
    pub before: f64,
    pub after: f64,
}

/// Changes of a garment by a movement, and its state in the pose reached.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reached {
    pub pose: String,
    /// Displacements of hem, cuffs, neckline and other closed free edges.
    pub opening: Vec<ReachedOpening>,
    /// Tension in warp or weft that 1 % of each piece exceeds.
    pub tension_n_m: Vec<ReachedAt>,
    /// Pressure that 1 % of the pressed area of each region exceeds.
    pub pressure_kpa: Vec<ReachedAt>,
    /// Rms residual force divided by the mean weight of a vertex.
    pub residual: f64,
    pub penetration_max_mm: f64,
    pub self_crossings: usize,
    pub problems: Vec<String>,
}

pub(crate) struct Moved {
    pub reached: Reached,
    pub body: Body,
    pub drape: Drape,
}

/// Carries the drape of a garment from one pose of its body into another, and measures it in both.
pub(crate) fn moved(
    upright: &Body,
    poses: [Pose; 2],
    garb: &Garb,
    drape: &Drape,
    monitor: &mut dyn Monitor,
) -> Result<Moved> {
    let parameters = Parameters::default();
    let ([_, to], garment, fabric) = (poses, garb.meshes.finest()?, &garb.fabric);
    let carry = Carry { upright, poses, garment, fabric, drape, parameters: &parameters };
    let Carried { bodies, drape: after } = carry.run(monitor)?;
    let [first, .., last] = &bodies[..] else { return Err(EngineError::NoPose.into()) };
    let kept = after.kept.as_deref().unwrap_or_default();
    let opening = reach::drawn(garment, kept, &after.positions).into_iter().map(|drawn| ReachedOpening {
        opening: drawn.opening,
        drawn_mm: mm(drawn.mean_m),
        drawn_most_mm: mm(drawn.most_m),
    });
    let (before, loaded) = (loads(first, garb, drape)?, loads(last, garb, &after)?);
    let depth_mm = mm(after.penetration_max_m);
    let faults = drape_faults(after.converged, after.residual, depth_mm, after.self_crossings as i64);
    let reached = Reached {
        pose: to.to_string(),
        opening: opening.collect(),
        tension_n_m: paired(before.tension_n_m, &loaded.tension_n_m),
        pressure_kpa: paired(before.pressure_kpa, &loaded.pressure_kpa),
        residual: after.residual,
        penetration_max_mm: depth_mm,
        self_crossings: after.self_crossings,
        problems: faults.into_iter().map(|fault| format!("{to}: {}", fault.words)).collect(),
    };
    Ok(Moved { reached, body: last.clone(), drape: after })
}

struct Loads {
    tension_n_m: Vec<(String, f64)>,
    pressure_kpa: Vec<(String, f64)>,
}

fn loads(body: &Body, garb: &Garb, drape: &Drape) -> Result<Loads> {
    let garment = garb.meshes.finest()?;
    let sewn = Sewn::new(garment, &garb.fabric, &drape.positions).origin(Origin::Measure)?;
    let tensions = sewn.tensions_n_m();
    let greatest = |own: &[f64]| {
        let mut sorted = own.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted.get(((sorted.len() as f64) * (1.0 - LEFT_OUT)) as usize).copied().unwrap_or(0.0)
    };
    let pressed = on_body::pressed(body, &sewn.mesh, &sewn.welded_pressures_kpa());
    let pieces = garment.pieces.iter();
    Ok(Loads {
        tension_n_m: pieces.map(|piece| (piece.id.clone(), greatest(&tensions[piece.vertices.clone()]))).collect(),
        pressure_kpa: pressed.into_iter().map(|on| (on.region.as_str().to_owned(), on.most_kpa)).collect(),
    })
}

/// Pairs values of the same place; a missing value counts as 0.
fn paired(before: Vec<(String, f64)>, after: &[(String, f64)]) -> Vec<ReachedAt> {
    let value_at = |values: &[(String, f64)], place: &str| {
        values.iter().find(|(known, _)| known == place).map_or(0.0, |(_, value)| *value)
    };
    let new = after.iter().filter(|(place, _)| !before.iter().any(|(known, _)| known == place));
    let places: Vec<String> = before.iter().chain(new).map(|(place, _)| place.clone()).collect();
    let pair = |place: String| ReachedAt { before: value_at(&before, &place), after: value_at(after, &place), place };
    places.into_iter().map(pair).collect()
}
