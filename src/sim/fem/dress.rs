//! A garment put on once: sewn from where it was placed, then settled mesh by mesh.

use super::params::Params;
use super::run::{Rest, Simulation};
use super::settle::{Around, Grip, Settled, Settling};
use crate::cloth::{Cloth, slack};
use crate::contact::{BodyContact, ClothContact};
use crate::dressing::{Dressing, Layer};
use crate::hands::Hands;
use crate::levels::prolong;
use crate::placement::Folded;
use crate::quality;
use crate::sewing::{self, Springs};
use crate::solver::System;
use crate::walls::Walls;
use crate::{Distortion, SimError};
use body::Body;
use geom::V3;
use pattern::{Garment, PieceMesh};

geom::constants! {
    "fem.dress",
    /// Depth by which contact with the body yields to a sewn garment beyond which it has been drawn into the body.
    const SEWN_INTO_M: f64 = 4e-3;
    /// Seam gap that hardened contact may leave where softer contact leaves less.
    const CLOSED_M: f64 = 1e-2;
    /// Principal stretch beyond 1 that 1 % of the cloth may exceed on any mesh, unless more is allowed. Cloth that is
    /// drawn farther ends inside the body. Coarse meshes are stretched more than fine ones (1.06 where the drape has
    /// 0.54).
    const TORN: f64 = 1.25;
    /// Depth by which contact yields to a tight garment on a coarse mesh: it is about to leave the offset that keeps it
    /// outside.
    pub const TIGHT_M: f64 = 8e-4;
    /// Residual at which the next share of the stiffness begins.
    const EASED: f64 = 0.1;
    /// Displacement of a full step at which it begins as well ([`Rest::still_m`]): it moves the cloth by millimetres.
    const EASED_STILL_M: f64 = 1e-4;
    /// Residual with the whole stiffness and without friction from which on friction holds.
    const RESTED: f64 = 0.02;
    /// Displacement of a full step from which on it holds as well.
    const RESTED_STILL_M: f64 = 5e-5;
    /// Room between sole and floor: the offsets of both contacts, and as much again. Without it the sole pushes the
    /// cloth under a heel down and the floor pushes it up, and it never comes to rest.
    const SOLE_M: f64 = 3e-3;
    /// Principal stretch beyond 1 that 1 % of the sewn cloth exceeds where it is drawn tight. It has no folds then, and
    /// reduced stiffness would only draw it out of shape.
    const DRAWN: f64 = 0.1;
}

/// Garment whose seams are closed, or nearly.
struct Sewn {
    positions: Vec<V3>,
    yields_m: f64,
}

#[derive(Clone, Copy)]
pub struct Placed<'a> {
    pub dressing: Dressing<'a>,
    pub hands: Option<&'a Hands<'a>>,
    pub start: &'a [V3],
    pub force: f64,
}

impl Placed<'_> {
    /// Sews the garment and lets it come to rest. If it slides off without friction it is settled again with friction
    /// throughout, and if it slides off even so it hangs from its top edge. With [`Grip::Throughout`] friction holds it
    /// from the first seam on.
    pub fn dress(&self, grip: Grip, run: &mut Simulation) -> Result<Settled, SimError> {
        let Dressing { wearer, skin, layer } = self.dressing;
        let coarsest = layer.coarsest()?;
        let Params { contact, self_contact, .. } = *run.params();
        let floor_m = floor_m(wearer.body);
        let soft = Around { skin, field: wearer.field, floor_m, hands: self.hands, contact, self_contact };
        if grip != Grip::AtTheEnd {
            run.keep_up(coarsest, self.start);
        }
        let Sewn { positions: mut sewn, yields_m } = self.sew(coarsest, soft, grip, run)?;
        let is_drawn_in = yields_m > SEWN_INTO_M;
        let around = if self.hands.is_some() || is_drawn_in { soft.hardened() } else { soft };
        if is_drawn_in {
            let Sewn { positions: again, .. } = self.sew(coarsest, around, grip, run)?;
            if quality::seam_gap_m(coarsest, &again) <= quality::seam_gap_m(coarsest, &sewn).max(CLOSED_M) {
                sewn = again;
            }
        }
        sewing::closed(coarsest, &sewn)?;
        run.keep_up(coarsest, &sewn);
        // Perhaps only friction holds it up, perhaps nothing does.
        let grips = [Grip::AtTheEnd, Grip::Throughout, Grip::Braced];
        let mut slid = None;
        for grip in grips.into_iter().skip_while(|first| *first != grip) {
            match self.refine(around, &sewn, grip, run) {
                Err(error @ SimError::SlidOff { .. }) => slid = Some(error),
                other => return other,
            }
        }
        Err(slid.unwrap_or(SimError::NoMesh))
    }

    /// As [`Self::dress`] with `factor` times the sewing force, after the garment was torn with its own. A ruffle may
    /// be torn by an accident of its start. Fails with [`SimError::Torn`] also where the drape is stretched beyond the
    /// limit.
    pub fn resewn(&self, factor: f64, run: &mut Simulation) -> Result<Settled, SimError> {
        let settled = Self { force: factor * self.force, ..*self }.dress(Grip::AtTheEnd, run)?;
        let distortion = Distortion::of(self.dressing.layer.finest()?, &settled.positions)?;
        let is_within = distortion.stretch <= run.params().distortion_limit;
        if is_within { Ok(settled) } else { Err(SimError::Torn { distortion }) }
    }

    /// Draws the seams together; those of pieces that are folded onto the garment follow once all others are closed.
    fn sew(&self, garment: &Garment, around: Around, grip: Grip, run: &mut Simulation) -> Result<Sewn, SimError> {
        let params = run.params();
        let mut x = self.start.to_vec();
        if let Some(folded) = Folded::of(garment) {
            let (under, kept) = garment.without(&folded.pieces);
            let whole = |sewn: &[V3]| {
                let mut all = self.start.to_vec();
                kept.iter().zip(sewn).for_each(|(&v, p)| all[v] = *p);
                all
            };
            let mut sewn: Vec<V3> = kept.iter().map(|&v| x[v]).collect();
            self.draw_together(&under, params, around, grip, &mut sewn, |part, x| run.sew(garment, part, x, whole))?;
            x = whole(&sewn);
            folded.turn_up(garment, &mut x);
        }
        let sew = |system: &mut System, x: &mut Vec<V3>| run.sew(garment, system, x, <[V3]>::to_vec);
        let yields_m = self.draw_together(garment, params, around, grip, &mut x, sew)?;
        Ok(Sewn { positions: x, yields_m })
    }

    /// Draws all seams of pieces together by `sew`, from `x`. Returns the depth by which the contact with the body
    /// yields then, m.
    fn draw_together(
        &self,
        garment: &Garment,
        params: &Params,
        around: Around,
        grip: Grip,
        x: &mut Vec<V3>,
        sew: impl FnOnce(&mut System, &mut Vec<V3>) -> Result<(), SimError>,
    ) -> Result<f64, SimError> {
        let Dressing { wearer, layer, .. } = self.dressing;
        let cloth = Cloth::new(garment, layer.fabric, sewing::unsewn(garment))?;
        let folded = self.hands.map(Hands::folded);
        let field = folded.as_ref().unwrap_or(around.field);
        let mut contact = BodyContact::new(field, around.contact, &cloth.areas).with_points_between(&cloth.triangles);
        if grip != Grip::AtTheEnd {
            contact.set_friction(cloth.frictions.iter().map(|friction| friction.body));
        }
        let springs = Springs::new(garment, params.sewing.seam_stiffness_n_m, self.force * params.sewing.seam_cap_n);
        let sewn = springs.pairs.clone();
        let mut system = System::new(&cloth, contact, Some(springs));
        let apart = ClothContact::new(around.self_contact, &cloth.triangles, &cloth.areas);
        system.self_contact = Some(apart.but_near(sewn.into_iter()));
        let vertex_of = sewing::welded(garment);
        let walls = Walls::new(wearer.body, garment, &vertex_of, &sewing::merged(&vertex_of, x));
        system.walls = Some(walls.unsewn(&vertex_of));
        sew(&mut system, x)?;
        Ok(system.contact.yields_m(x))
    }

    /// Shares of the membrane stiffness with which the sewn garment comes to rest first. None where it is drawn tight,
    /// or the fabric stretches easily anyway.
    fn shares(&self, sewn: &[V3]) -> Result<Vec<f64>, SimError> {
        let Layer { fabric, .. } = self.dressing.layer;
        let coarsest = self.dressing.layer.coarsest()?;
        if Distortion::of(coarsest, sewn)?.stretch > DRAWN {
            return Ok(Vec::new());
        }
        Ok(slack::shares(fabric, length_m(coarsest)))
    }

    fn refine(&self, mut around: Around, sewn: &[V3], grip: Grip, run: &mut Simulation) -> Result<Settled, SimError> {
        // A garment that only friction holds up would slip while its stiffness is reduced.
        let shares = if grip == Grip::Throughout { Vec::new() } else { self.shares(sewn)? };
        let Layer { garments, fabric } = self.dressing.layer;
        let mut last: Option<(&Garment, Settled)> = None;
        for (level, garment) in garments.iter().enumerate() {
            let cloth = Cloth::new(garment, fabric, sewing::welded(garment))?;
            let mut x = match &last {
                None => cloth.weld(sewn),
                Some((coarser, drape)) => prolong(coarser, &drape.positions, garment, &cloth, fabric),
            };
            let settling = Settling { around, garment, cloth: &cloth, level, grip };
            let is_finest = level + 1 == garments.len();
            let rounds = shares.len() + 1;
            for (round, share) in shares.iter().enumerate().filter(|_| is_finest) {
                let slack = cloth.clone().slackened(*share);
                let rest = Rest { residual: EASED, still_m: EASED_STILL_M };
                // Cloth that does not come to rest so, as ruffles do not, has too many equilibria for that.
                if !(Settling { cloth: &slack, ..settling }.ease(&mut x, rest, [round, rounds], run)?) {
                    break;
                }
            }
            let settled = match shares.first() {
                Some(share) if !is_finest => {
                    let slack = cloth.clone().slackened(*share);
                    Settling { cloth: &slack, ..settling }.settle(x, run)?
                }
                Some(_) => {
                    let rest = Rest { residual: RESTED, still_m: RESTED_STILL_M };
                    settling.ease(&mut x, rest, [shares.len(), rounds], run)?;
                    settling.settle(x, run)?
                }
                None => settling.settle(x, run)?,
            };
            control(garment, &settled.positions, run.params())?;
            if settled.yields_m > TIGHT_M {
                around = around.hardened();
            }
            last = Some((garment, settled));
        }
        last.map(|(_, settled)| settled).ok_or(SimError::NoMesh)
    }
}

/// Below the lowest point of the body by the room that cloth under a sole needs.
pub fn floor_m(body: &Body) -> f64 {
    body.mesh.positions.iter().map(|p| p.z).fold(f64::MAX, f64::min) - SOLE_M
}

fn length_m(garment: &Garment) -> f64 {
    let length = |piece: &PieceMesh| {
        let heights = garment.rest[piece.vertices.clone()].iter().map(|p| p.dot(&piece.grain));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), height| (low.min(height), high.max(height)));
        high - low
    };
    garment.pieces.iter().map(length).fold(0.0, f64::max)
}

/// Ends a simulation whose cloth is stretched beyond what cloth can bear, or, where that is asked for, beyond the
/// limit.
fn control(garment: &Garment, positions: &[V3], params: &Params) -> Result<(), SimError> {
    let distortion = Distortion::of(garment, positions)?;
    let limit = params.distortion_limit;
    if params.distortion_stops && distortion.stretch > limit {
        return Err(SimError::Distorted { distortion, limit });
    }
    if distortion.stretch > limit.max(TORN) { Err(SimError::Torn { distortion }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fabric;
    use crate::dressing::Wearer;
    use crate::laboratory::{self, sheets::sheet};
    use crate::testing::fabric;
    use body::{self, Measurements, Sex};

    #[test]
    fn a_garment_comes_to_rest_slack_first_where_it_is_neither_drawn_tight_nor_stretches_anyway() {
        let body = body::build(&Measurements::of(Sex::Male, 1.75)).expect("a body");
        let field = laboratory::nowhere();
        let garments = [laboratory::garment(sheet(20, 50, 0.01))];
        let check = |stretch: f64, softer: f64, expect: usize| {
            let stiff = fabric();
            let soft = Fabric {
                membrane_warp_n_m: stiff.membrane_warp_n_m / softer,
                membrane_weft_n_m: stiff.membrane_weft_n_m / softer,
                ..stiff
            };
            let sewn: Vec<V3> = garments[0].rest.iter().map(|p| V3::new(stretch * p.x, p.y, 0.0)).collect();
            let wearer = Wearer { body: &body, field: &field };
            let dressing = Dressing { wearer, skin: None, layer: Layer { garments: &garments, fabric: &soft } };
            let placed = Placed { dressing, hands: None, start: &sewn, force: 1.0 };
            let shares = placed.shares(&sewn).expect("sound");
            assert!(shares.len() == expect && shares.is_sorted(), "{stretch}, {softer}: {shares:?}");
        };
        check(1.0, 1.0, 3);
        check(1.08, 1.0, 3);
        check(1.12, 1.0, 0);
        check(1.0, 10.0, 1);
        check(1.0, 1000.0, 0);
    }
}
