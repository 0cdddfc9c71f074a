//! A drape carried into another pose: the body turns its limbs a few degrees at a time and takes the cloth along.
//!
//! At each turn the cloth moves with the skin near it. Then it comes to rest under friction: cloth that is too short
//! for the pose slides, other cloth stays in its place on the skin.

use super::dress::{TIGHT_M, floor_m};
use super::params::Params;
use super::run::Simulation;
use super::settle::{Around, Grip, Settling};
use crate::cloth::Cloth;
use crate::contact::Skin;
use crate::contact::grid::BoxGrid;
use crate::{Drape, Fabric, Monitor, SimError, sewing};
use body::Body;
use geom::{DistanceField, Surface, V3};
use pattern::Garment;

geom::constants! {
    "fem.carry",
    /// Greatest angle by which limbs turn at a time: a cuff at the wrist moves by 3 cm.
    pub const TURN_DEG: f64 = 3.0;
    /// Steps of the solver at each turn but the last.
    const STEPS_A_TURN: u32 = 12;
    /// Radius about a vertex within which the skin takes it along: a factor on its distance from the skin, and an
    /// addend, m. The mean over such skin changes smoothly, and cloth beside the trunk does not go with a hand.
    const SHARE_OF_DISTANCE: f64 = 1.5;
    const BEYOND_M: f64 = 0.025;
    /// Distance up to which skin is sought.
    const FARTHEST_M: f64 = 1.0;
}

#[derive(Clone, Copy)]
pub struct Motion<'a> {
    /// Poses on the way, all with the same triangles; the drape lies on the first.
    pub bodies: &'a [Body],
    pub spacing_m: f64,
}

#[derive(Clone, Copy)]
pub struct Worn<'a> {
    pub garment: &'a Garment,
    pub fabric: &'a Fabric,
    pub drape: &'a Drape,
}

/// Carries a drape through the poses of its body, and returns that in the last. Not converging is no error.
pub fn carry(motion: Motion, worn: Worn, params: &Params, monitor: &mut dyn Monitor) -> Result<Drape, SimError> {
    let (Motion { bodies, spacing_m }, Worn { garment, fabric, drape }) = (motion, worn);
    let cloth = Cloth::new(garment, fabric, sewing::welded(garment))?;
    let mut run = Simulation::new(params, monitor, 0);
    let mut x = cloth.weld(&drape.positions);
    let mut kept = x.clone();
    let mut carried = drape.clone();
    for (turn, pair) in bodies.windows(2).enumerate() {
        let moves = Moves::new(&pair[0], &pair[1])?;
        moves.take_along(&mut x);
        moves.take_along(&mut kept);
        let (field, skin) =
            (DistanceField::build(&pair[1].mesh, spacing_m).map_err(SimError::Solid)?, Skin::new(&pair[1].mesh).ok());
        let Params { contact, self_contact, .. } = *params;
        let (skin, field, floor_m) = (skin.as_ref(), &field, floor_m(&pair[1]));
        let around = Around { skin, field, floor_m, hands: None, contact, self_contact };
        let settling = Settling { around, garment, cloth: &cloth, level: 0, grip: Grip::AtTheEnd };
        run.keep_up(garment, &cloth.unweld(&x));
        if turn + 2 < bodies.len() {
            settling.pass(&mut x, STEPS_A_TURN, &mut run)?;
            continue;
        }
        let mut settled = settling.rest(x.clone(), &mut run)?;
        if settled.yields_m > TIGHT_M {
            settled = Settling { around: around.hardened(), ..settling }.rest(settled.sewn, &mut run)?;
        }
        carried = settled.into_drape(skin, field, garment, params.tolerance);
    }
    let (iterations, history) = (drape.iterations + run.iterations(), run.into_history());
    let history = drape.history.iter().copied().chain(history).collect();
    Ok(Drape { iterations, history, kept: Some(cloth.unweld(&kept)), ..carried })
}

struct Moves<'a> {
    before: &'a [V3],
    after: &'a [V3],
    surface: Surface,
    grid: BoxGrid,
}

impl<'a> Moves<'a> {
    fn new(before: &'a Body, after: &'a Body) -> Result<Self, SimError> {
        let surface = Surface::new(&before.mesh).map_err(SimError::Solid)?;
        let points: Vec<[usize; 1]> = (0..before.mesh.positions.len()).map(|v| [v]).collect();
        let (before, after) = (&before.mesh.positions[..], &after.mesh.positions[..]);
        let grid = BoxGrid::new(before, &points, 0.0, BEYOND_M);
        Ok(Self { before, after, surface, grid })
    }

    /// Moves each vertex by the weighted mean displacement of the skin near it.
    fn take_along(&self, x: &mut [V3]) {
        let mut near = Vec::new();
        for p in x {
            let (distance_m, _) = self.surface.nearest_within(p, FARTHEST_M);
            let within = SHARE_OF_DISTANCE * distance_m + BEYOND_M;
            let reach = V3::repeat(within);
            let (mut sum, mut weights) = (V3::zeros(), 0.0);
            for &v in self.grid.near([&(*p - reach), &(*p + reach)], &mut near) {
                let share = (self.before[v] - *p).norm_squared() / within.powi(2);
                let weight = (1.0 - share).max(0.0).powi(2);
                sum += (self.after[v] - self.before[v]) * weight;
                weights += weight;
            }
            if weights > 0.0 {
                *p += sum / weights;
            }
        }
    }
}
