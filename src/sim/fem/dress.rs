//! A garment put on once: sewn as it was placed, then settled mesh by mesh.

use super::params::Params;
use super::run::Simulation;
use super::settle::{Around, Grip, Settled, Settling};
use crate::cloth::{Cloth, slack};
use crate::contact::{BodyContact, ClothContact, Skin};
use crate::hands::Hands;
use crate::levels::prolong;
use crate::placement::Folded;
use crate::quality;
use crate::sewing::{self, Springs};
use crate::solver::System;
use crate::walls::Walls;
use crate::{Distortion, Fabric, SimError};
use body::Body;
use geom::{DistanceField, V3};
use pattern::{Garment, PieceMesh};

geom::constants! {
    "fem.dress",
    /// A sewn garment that yields this much has been drawn into the body, m.
    const SEWN_INTO_M: f64 = 4e-3;
    /// Gap of seams that a body which does not give way may leave where one that does leaves less, m.
    const CLOSED_M: f64 = 1e-2;
    /// Principal stretch beyond 1 that 1 % of the cloth may exceed on any mesh, unless more is allowed: what is drawn on all the same
    /// ends inside the body. Coarse meshes are stretched more than fine ones (1.06 where the drape has 0.54).
    const TORN: f64 = 1.25;
    /// A garment that yields this much on a coarse mesh is tight, m: it is about to leave the offset that keeps it outside.
    pub const TIGHT_M: f64 = 8e-4;
    /// Residual with which the next share begins.
    const EASED: f64 = 0.1;
    /// Residual without friction of all the stiffness, from which on friction holds.
    const RESTED: f64 = 0.02;
    /// Room between sole and floor, m: what contact keeps off either, and as much again. Without it cloth under a heel is pushed up by the one
    /// and down by the other for ever.
    const SOLE_M: f64 = 3e-3;
    /// Principal stretch beyond 1 that 1 % of the sewn cloth exceeds where it is drawn tight: there are no folds then, and slack cloth is
    /// drawn out of shape.
    const DRAWN: f64 = 0.1;
}

/// A garment, placed, and the body that is to wear it.
pub struct Dressing<'a> {
    /// Body that wears it.
    pub body: &'a Body,
    /// Its exact surface, where it bounds a solid.
    pub skin: Option<&'a Skin<'a>>,
    /// Distance from it.
    pub field: &'a DistanceField,
    /// Hands that the garment comes near.
    pub hands: Option<&'a Hands<'a>>,
    /// Meshes of the garment, coarse to fine.
    pub garments: &'a [Garment],
    /// What it is made of.
    pub fabric: &'a Fabric,
    /// Where the coarsest mesh's vertices are placed, m.
    pub placed: &'a [V3],
    /// Factor on the sewing force.
    pub force: f64,
}

impl Dressing<'_> {
    /// Sews the garment and lets it come to rest. What slides off without friction is settled again with friction throughout, and what slides
    /// off with it hangs from its top edge; `Grip::Throughout` has friction hold it from the first seam on.
    ///
    /// # Errors
    /// When its seams stay open, it diverges, slides off, is stretched beyond what cloth can be or a limit that is to end it, or the
    /// monitor cancels.
    pub fn dress(&self, grip: Grip, run: &mut Simulation) -> Result<Settled, SimError> {
        let Some(coarsest) = self.garments.first() else { return Err(SimError::NoMesh) };
        let Params { contact, self_contact, .. } = *run.params();
        let floor_m = floor_m(self.body);
        let soft = Around { skin: self.skin, field: self.field, floor_m, hands: self.hands, contact, self_contact };
        if grip != Grip::AtTheEnd {
            run.keep_up(coarsest, self.placed);
        }
        let (mut sewn, yields_m) = self.sew(coarsest, soft, grip, run)?;
        let is_drawn_in = yields_m > SEWN_INTO_M;
        let around = if self.hands.is_some() || is_drawn_in { soft.hardened() } else { soft };
        if is_drawn_in {
            let (again, _) = self.sew(coarsest, around, grip, run)?;
            if quality::seam_gap_m(coarsest, &again) <= quality::seam_gap_m(coarsest, &sewn).max(CLOSED_M) {
                sewn = again;
            }
        }
        sewing::closed(coarsest, &sewn)?;
        run.keep_up(coarsest, &sewn);
        // Nothing but friction may hold it up, or nothing at all.
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

    /// The same with friction throughout, after it failed without: where that fails as well, the first error tells.
    pub fn dress_or(&self, first: SimError, run: &mut Simulation) -> Result<Settled, SimError> {
        self.dress(Grip::Throughout, run).map_err(|error| match error {
            SimError::Cancelled => error,
            _ => first,
        })
    }

    /// The same with other sewing forces, after it was torn with its own, as a ruffle is by chance: where it is with all of them, or
    /// tight, the first error tells.
    pub fn resewn_or(&self, first: SimError, factors: &[f64], run: &mut Simulation) -> Result<Settled, SimError> {
        let limit = run.params().distortion_limit;
        for factor in factors {
            match (Dressing { force: factor * self.force, ..*self }).dress(Grip::AtTheEnd, run) {
                Err(SimError::Cancelled) => return Err(SimError::Cancelled),
                Ok(settled) if self.distortion(&settled)?.stretch <= limit => return Ok(settled),
                _ => {}
            }
        }
        Err(first)
    }

    /// How far the finest mesh is stretched.
    fn distortion(&self, settled: &Settled) -> Result<Distortion, SimError> {
        Distortion::of(&self.garments[self.garments.len() - 1], &settled.positions)
    }

    /// Draws the seams of the garment together, those of what is folded onto it once all others are closed; returns garment
    /// positions with all seams (nearly) closed, and how far the contact with the body yields there, m.
    fn sew(
        &self,
        garment: &Garment,
        around: Around,
        grip: Grip,
        run: &mut Simulation,
    ) -> Result<(Vec<V3>, f64), SimError> {
        let params = run.params();
        let mut x = self.placed.to_vec();
        if let Some(folded) = Folded::of(garment) {
            let (under, kept) = garment.without(&folded.pieces);
            let whole = |sewn: &[V3]| {
                let mut all = self.placed.to_vec();
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
        Ok((x, yields_m))
    }

    /// Draws all seams of pieces together by `sew`, from `x`; returns how far the contact with the body yields then, m.
    fn draw_together(
        &self,
        garment: &Garment,
        params: &Params,
        around: Around,
        grip: Grip,
        x: &mut Vec<V3>,
        sew: impl FnOnce(&mut System, &mut Vec<V3>) -> Result<(), SimError>,
    ) -> Result<f64, SimError> {
        let cloth = Cloth::new(garment, self.fabric, sewing::unsewn(garment))?;
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
        let walls = Walls::new(self.body, garment, &vertex_of, &sewing::merged(&vertex_of, x));
        system.walls = Some(walls.unsewn(&vertex_of));
        sew(&mut system, x)?;
        Ok(system.contact.yields_m(x))
    }

    /// Shares of its stiffness in the plane with which the sewn garment comes to rest first: none where it is drawn tight, or of cloth that
    /// stretches as easily as it is.
    fn shares(&self, sewn: &[V3]) -> Result<Vec<f64>, SimError> {
        let coarsest = &self.garments[0];
        if Distortion::of(coarsest, sewn)?.stretch > DRAWN {
            return Ok(Vec::new());
        }
        Ok(slack::shares(self.fabric, length_m(coarsest)))
    }

    /// Settles the sewn garment on the coarsest mesh, and on each finer one from the one before.
    fn refine(&self, mut around: Around, sewn: &[V3], grip: Grip, run: &mut Simulation) -> Result<Settled, SimError> {
        // What friction has to hold is not let slip.
        let shares = if grip == Grip::Throughout { Vec::new() } else { self.shares(sewn)? };
        let mut last: Option<(&Garment, Settled)> = None;
        for (level, garment) in self.garments.iter().enumerate() {
            let cloth = Cloth::new(garment, self.fabric, sewing::welded(garment))?;
            let mut x = match &last {
                None => cloth.weld(sewn),
                Some((coarser, drape)) => prolong(coarser, &drape.positions, garment, &cloth, self.fabric),
            };
            let settling = Settling { around, garment, cloth: &cloth, level, grip };
            let is_finest = level + 1 == self.garments.len();
            for share in shares.iter().filter(|_| is_finest) {
                let slack = cloth.clone().slackened(*share);
                // What does not has more ways to lie than easing could tell apart, as ruffles do.
                if !(Settling { cloth: &slack, ..settling }.ease(&mut x, EASED, run)?) {
                    break;
                }
            }
            let settled = match shares.first() {
                Some(share) if !is_finest => {
                    let slack = cloth.clone().slackened(*share);
                    Settling { cloth: &slack, ..settling }.settle(x, run)?
                }
                Some(_) => {
                    settling.ease(&mut x, RESTED, run)?;
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

/// Height of the floor that a body stands on, m: so far below its lowest point that cloth under a sole has room.
pub fn floor_m(body: &Body) -> f64 {
    body.mesh.positions.iter().map(|p| p.z).fold(f64::MAX, f64::min) - SOLE_M
}

/// Length of the longest piece along its grain, m.
fn length_m(garment: &Garment) -> f64 {
    let length = |piece: &PieceMesh| {
        let along = garment.rest[piece.vertices.clone()].iter().map(|p| p.dot(&piece.grain));
        let (low, high) = along.fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(at), high.max(at)));
        high - low
    };
    garment.pieces.iter().map(length).fold(0.0, f64::max)
}

/// Ends a simulation whose cloth is stretched farther than cloth can be, or, where that is asked for, than it should.
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
            let (body, field, fabric, garments) = (&body, &field, &soft, &garments[..]);
            let dressing =
                Dressing { body, skin: None, field, hands: None, garments, fabric, placed: &sewn, force: 1.0 };
            let shares = dressing.shares(&sewn).expect("sound");
            assert!(shares.len() == expect && shares.is_sorted(), "{stretch}, {softer}: {shares:?}");
        };
        check(1.0, 1.0, 3);
        check(1.08, 1.0, 3);
        check(1.12, 1.0, 0);
        check(1.0, 10.0, 1);
        check(1.0, 1000.0, 0);
    }
}
