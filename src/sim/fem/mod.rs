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
use crate::dressing::{Dressing, Layer, Wearer};
use crate::placement::{self, Bend};
use crate::quality::top_m;
use crate::tries::{self, Criteria, Faults, Trial};
use crate::{Distortion, Drape, Fabric, Monitor, SimError};
use body::Body;
use geom::constants::Constant;
use geom::{DistanceField, V3};
use pattern::Garment;

use crate::hands::Hands;
use dress::Placed;
use run::Simulation;
use settle::{Grip, Settled};

geom::constants! {
    "fem",
    /// Deepest point inside the body of a drape without a fault.
    const FAULTLESS_DEPTH_M: f64 = 5e-4;
    /// Rise of a garment's top from its place before sewing beyond which its seams have squeezed it off the body.
    const MOST_RISE_M: f64 = 0.25;
    /// Factors on the sewing force for a garment that ends with a fault, or is torn while it is sewn. It is an accident
    /// of the start whether one tight fold goes through another, and how a ruffle is drawn out. A changed force gives
    /// another start that is as symmetric as the first.
    const RESEWN: [f64; 2] = [1.5, 0.67];
    /// Steps times vertices (5 to 20 microseconds each) after which no other way is tried: the user has waited long
    /// enough. A T-shirt at 15 mm takes 0.7 million.
    const MOST_TRIED: u64 = 2_000_000;
}

/// `garments` are meshes of the same garment, coarse to fine; the drape is on the last. The coarsest mesh is placed,
/// sewn and roughly draped. Each finer one starts from the drape of the one before. All settle without friction first,
/// so that the drape does not depend on the path by which the seams closed. Only then does friction hold the garment. A
/// garment that slides off without friction is settled again with friction throughout.
///
/// The seams of a garment that is much too small squeeze it along the body as they close. It folds into itself at a
/// narrower place, or comes off over the head. A tight garment that ends with a fault or open seams is therefore sewn
/// once more, with friction from the first seam on. Any other garment with a fault is sewn from pieces with another
/// bend, unless the parameters ask for a bend. If a fault is left, the garment is sewn with more force, and with less.
/// Of these drapes the first without a fault is taken, failing that the best (`sim::tries`). The tries end early once
/// they have taken long.
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
    let layer = Layer { garments, fabric };
    let (coarsest, garment) = (layer.coarsest()?, layer.finest()?);
    let mut run = Simulation::new(params, monitor, garments.len() - 1).within_patience(garment);
    let Start { positions: start, force } = perturbed_start(body, coarsest, &params.bend, params.seed)?;
    let hands = Hands::near(body, field, &start);
    let skin = Skin::new(&body.mesh).ok();
    let dressing = Dressing { wearer: Wearer { body, field }, skin: skin.as_ref(), layer };
    let placed = Placed { dressing, hands: hands.as_ref(), start: &start, force };
    let (settled, grip) = match placed.dress(Grip::AtTheEnd, &mut run) {
        Err(error) if !run.tries_again() => return Err(error),
        Err(open @ SimError::Open { .. }) => {
            let settled = tries::instead(open, [Grip::Throughout], |grip| placed.dress(grip, &mut run))?;
            (settled, Grip::Throughout)
        }
        Err(torn @ SimError::Torn { .. }) => {
            let settled = tries::instead(torn, RESEWN, |factor| placed.resewn(factor, &mut run))?;
            (settled, Grip::AtTheEnd)
        }
        other => (other?, Grip::AtTheEnd),
    };
    let mut sewing = Resewing { placed, garment, placed_top_m: top_m(coarsest, &start), run: &mut run };
    let first = sewing.ended(settled);
    let ways = other_ways(&placed, grip, &first, sewing.has_come_off(&first), params)?;
    let drape = tries::best(&mut sewing, Some(first), ways)?;
    if sewing.has_come_off(&drape) {
        return Err(SimError::CameOff { garment: garment.name.clone(), rise_m: sewing.rise_m(&drape) });
    }
    Ok(Drape { iterations: run.iterations(), history: run.into_history(), ..drape })
}

struct Resewing<'a, 'r, 'm> {
    placed: Placed<'a>,
    garment: &'a Garment,
    placed_top_m: f64,
    run: &'r mut Simulation<'m>,
}

impl Resewing<'_, '_, '_> {
    fn ended(&self, settled: Settled) -> Drape {
        let Dressing { wearer, skin, .. } = self.placed.dressing;
        settled.into_drape(skin, wearer.field, self.garment, self.run.params().tolerance)
    }

    fn rise_m(&self, drape: &Drape) -> f64 {
        top_m(self.garment, &drape.positions) - self.placed_top_m
    }

    fn has_come_off(&self, drape: &Drape) -> bool {
        self.rise_m(drape) > MOST_RISE_M
    }
}

impl Trial for Resewing<'_, '_, '_> {
    type Way = Way;
    const CRITERIA: Criteria = CRITERIA;

    fn put_on(&mut self, way: &Way) -> Result<Drape, SimError> {
        let Start { positions, force } = &way.start;
        let placed = Placed { start: positions, force: *force, ..self.placed };
        placed.dress(way.grip, self.run).map(|settled| self.ended(settled))
    }

    fn faults(&self, drape: &Drape) -> Faults {
        faults(drape, self.has_come_off(drape))
    }

    /// A garment that has come off is no result: its only other way is tried however long the first took.
    fn has_time(&self, least: &Faults) -> bool {
        self.run.tries_again() && (least.came_off || self.run.vertex_steps() <= MOST_TRIED)
    }
}

/// Limits and order of the faults of a drape by FEM-GS.
///
/// Lengths count for nothing: cloth that is too small stretches, and that stretch is a result. Rest does not come
/// first: it is measured by the force that is left, and cloth with a little more than the tolerance left lies nearly
/// where it would come to rest. Its crossings count as much as those of a drape at rest.
const CRITERIA: Criteria = Criteria { depth_m: FAULTLESS_DEPTH_M, length_error: 0.0, is_rest_first: false };

fn faults(drape: &Drape, came_off: bool) -> Faults {
    let &Drape { converged, self_crossings, penetration_max_m: depth_m, .. } = drape;
    Faults { came_off, moves: !converged, self_crossings, depth_m, length_error: 0.0 }
}

struct Way {
    start: Start,
    grip: Grip,
}

#[derive(Clone)]
struct Start {
    positions: Vec<V3>,
    force: f64,
}

/// Other ways to put on a garment that came off or ended with a fault, in the order in which to try them. None for a
/// drape without a fault.
fn other_ways(
    placed: &Placed,
    grip: Grip,
    drape: &Drape,
    came_off: bool,
    params: &Params,
) -> Result<Vec<Way>, SimError> {
    let mut ways = Vec::new();
    if faults(drape, came_off).are_none(&CRITERIA) {
        return Ok(ways);
    }
    let Dressing { wearer, layer, .. } = placed.dressing;
    let (coarsest, finest) = (layer.coarsest()?, layer.finest()?);
    let start = Start { positions: placed.start.to_vec(), force: placed.force };
    if grip == Grip::AtTheEnd {
        if came_off || Distortion::of(finest, &drape.positions)?.stretch > params.distortion_limit {
            ways.push(Way { start: start.clone(), grip: Grip::Throughout });
        } else if let Some(bend) = params.bend.otherwise() {
            let elsewhere = perturbed_start(wearer.body, coarsest, &bend, params.seed)?;
            // Trousers and pieces that go round alone are not bent: the same start would give the same drape.
            ways.extend((elsewhere.positions != start.positions).then_some(Way { start: elsewhere, grip }));
        }
    }
    if !came_off {
        let force = start.force;
        ways.extend(RESEWN.map(|factor| Way { start: Start { force: factor * force, ..start.clone() }, grip }));
    }
    Ok(ways)
}

fn perturbed_start(body: &Body, garment: &Garment, bend: &Bend, seed: u64) -> Result<Start, SimError> {
    let mut positions = placement::place(body, garment, bend)?;
    let force = start::perturb(seed, &mut positions);
    Ok(Start { positions, force })
}

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
