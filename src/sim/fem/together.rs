//! Layers of an outfit that come to rest together.

use super::dress::floor_m;
use super::params::Params;
use super::run::{MOST_DESCENT_M, Simulation};
use super::settle::{Around, Grip, Settled, Settling};
use crate::contact::Skin;
use crate::outfit::{Joined, Layer, Wear, Wearer, joined, parted};
use crate::quality::{self, top_m};
use crate::{Drape, Monitor, SimError};
use geom::V3;
use pattern::Garment;

impl Wear for Params {
    fn alone(
        &self,
        Wearer { body, field }: Wearer,
        layer: Layer,
        room_m: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Drape, SimError> {
        let mut params = *self;
        params.contact.offset_m += room_m;
        super::simulate(body, field, layer.garments, layer.fabric, &params, monitor)
    }

    fn together(
        &self,
        Wearer { body, field }: Wearer,
        layers: &[Layer],
        drapes: Vec<Drape>,
        monitor: &mut dyn Monitor,
    ) -> Result<Vec<Drape>, SimError> {
        let Joined { garments, all, cloth } = joined(layers)?;
        let start: Vec<V3> = drapes.iter().flat_map(|drape| drape.positions.iter().copied()).collect();
        let skin = Skin::new(&body.mesh).ok();
        let Params { contact, self_contact, .. } = *self;
        let around = Around { skin: skin.as_ref(), field, floor_m: floor_m(body), hands: None, contact, self_contact };
        let mut run = Simulation::new(self, monitor, 1);
        let mut settled = |grip| {
            let settling = Settling { around, garment: &all, cloth: &cloth, level: run.levels(), grip };
            settling.settle(cloth.weld(&start), &mut run)
        };
        let mut lies = settled(Grip::AtTheEnd)?;
        if slid(&garments, &drapes, &lies).is_some() {
            lies = settled(Grip::Throughout)?;
        }
        if let Some((garment, descent_m)) = slid(&garments, &drapes, &lies) {
            return Err(SimError::SlidOff { garment: garment.name.clone(), descent_m });
        }
        let (iterations, history) = (run.iterations(), run.into_history());
        let crossings = quality::self_crossings(&lies.sewn, &lies.triangles);
        let ended = |((drape, garment), positions): ((Drape, &&Garment), Vec<V3>)| Drape {
            converged: lies.residual <= self.tolerance,
            iterations: drape.iterations + iterations,
            residual: lies.residual,
            penetration_max_m: quality::penetration_by_field_m(skin.as_ref(), field, garment, &positions),
            seam_gap_max_m: quality::seam_gap_m(garment, &positions),
            self_crossings: crossings,
            positions,
            history: drape.history.into_iter().chain(history.iter().copied()).collect(),
            ..drape
        };
        let lying = parted(&garments, &lies.positions);
        Ok(drapes.into_iter().zip(&garments).zip(lying).map(ended).collect())
    }
}

/// Layer that has come down farthest, with its descent, m; `None` where none has slid off.
fn slid<'a>(garments: &[&'a Garment], drapes: &[Drape], lies: &Settled) -> Option<(&'a Garment, f64)> {
    let after = parted(garments, &lies.positions);
    let descents = garments
        .iter()
        .zip(drapes)
        .zip(&after)
        .map(|((garment, drape), after)| (*garment, top_m(garment, &drape.positions) - top_m(garment, after)));
    descents.max_by(|(_, a), (_, b)| a.total_cmp(b)).filter(|(_, descent_m)| *descent_m > MOST_DESCENT_M)
}
