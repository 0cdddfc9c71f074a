//! One level of a sewn garment comes to rest: without friction, and on the finest mesh with it and held outside the
//! body.

use super::run::{Ending, Phase, Rest, Simulation};
use crate::cloth::Cloth;
use crate::contact::{BodyContact, ClothContact, ClothContactParams, ContactParams, Skin, contact_areas};
use crate::hands::{Hands, Shape};
use crate::quality;
use crate::solver::System;
use crate::solver::braces::Braces;
use crate::{Drape, SimError, Stage};
use geom::{DistanceField, V3};
use pattern::Garment;

geom::constants! {
    "fem.settle",
    /// Deepest point inside the body up to which no point has to be held out.
    const DEEPEST_M: f64 = 3e-4;
    /// Greatest number of times that a drape is taken up again, because it is not at rest or has points inside the
    /// body.
    const HOLDING_ROUNDS: usize = 8;
    /// Residual at which points inside the body are looked for: the forces that press them in leave one of hundreds.
    const HELD: f64 = 1.0;
    /// Penalty of body contact for cloth that is drawn tight or over a hand: fingertips press through a softer one.
    const HARD_N_M3: f64 = 1e9;
    /// Penalty of the cloth's contact with itself for the same cloth: where a seat is drawn tight, a softer one lets
    /// layers through.
    const HARD_LAYERS_N_M3: f64 = 1e7;
    /// Residual at which a drape without friction is handed on to Newton's method, and the greatest number of rounds in
    /// which points inside the body are held out before.
    const FREE: f64 = 0.05;
    const FREE_ROUNDS: usize = 4;
    /// Rise of the floor at a time, m, and steps of the solver after each.
    const RISE_M: f64 = 5e-3;
    const STEPS_A_RISE: u32 = 3;
    const PASSING_STEPS: u32 = 12;
}

/// Time from which on friction holds a garment.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Grip {
    /// Once it has come to rest without friction: the drape does not depend on the path by which the seams closed.
    AtTheEnd,
    /// From the sewing on: for a garment that would slide off without friction.
    Throughout,
    /// As `Throughout`, and the top edge keeps its height: for a garment that would slide off with friction as well.
    Braced,
}

/// Body as contact sees it: exactly, and as a field.
#[derive(Clone, Copy)]
pub struct Around<'a> {
    /// `None` where the mesh bounds no solid: only the field holds the cloth.
    pub skin: Option<&'a Skin<'a>>,
    pub field: &'a DistanceField,
    pub floor_m: f64,
    pub hands: Option<&'a Hands<'a>>,
    pub contact: ContactParams,
    pub self_contact: ClothContactParams,
}

impl Around<'_> {
    /// Contacts stiff enough for cloth that is drawn tight.
    pub fn hardened(mut self) -> Self {
        self.contact.stiffness_n_m3 = self.contact.stiffness_n_m3.max(HARD_N_M3);
        self.self_contact.stiffness_n_m3 = self.self_contact.stiffness_n_m3.max(HARD_LAYERS_N_M3);
        self
    }
}

pub struct Settled {
    pub positions: Vec<V3>,
    /// Rms force over mean vertex weight.
    pub residual: f64,
    /// True if no step lowered the energy any more, though it was not at rest.
    pub is_stuck: bool,
    pub yields_m: f64,
    pub braced_n: Option<f64>,
    pub sewn: Vec<V3>,
    pub triangles: Vec<[usize; 3]>,
}

impl Settled {
    /// Makes a drape of the finest mesh, converged where the residual is at most `tolerance`.
    pub fn into_drape(self, skin: Option<&Skin>, field: &DistanceField, garment: &Garment, tolerance: f64) -> Drape {
        Drape {
            stage: Stage::Drape,
            converged: self.residual <= tolerance,
            iterations: 0,
            residual: self.residual,
            penetration_max_m: quality::penetration_by_field_m(skin, field, garment, &self.positions),
            seam_gap_max_m: quality::seam_gap_m(garment, &self.positions),
            self_crossings: quality::self_crossings(&self.sewn, &self.triangles),
            welded_vertices: self.sewn.len(),
            braced_n: self.braced_n,
            is_stuck: self.is_stuck && self.residual > tolerance,
            positions: self.positions,
            history: Vec::new(),
            earlier: Vec::new(),
            kept: None,
        }
    }
}

#[derive(Clone, Copy)]
pub struct Settling<'a> {
    pub around: Around<'a>,
    /// Mesh of this level, its pieces apart.
    pub garment: &'a Garment,
    pub cloth: &'a Cloth,
    /// 0 is the coarsest.
    pub level: usize,
    pub grip: Grip,
}

impl<'a> Settling<'a> {
    pub fn settle(&self, mut x: Vec<V3>, run: &mut Simulation) -> Result<Settled, SimError> {
        let Self { around, cloth, level, .. } = *self;
        let params = run.params();
        let (hands, finest) = (around.hands.into_iter(), run.levels());
        let shapes: Vec<(Shape, DistanceField)> = hands.flat_map(|hands| hands.of_level(level, finest)).collect();
        let begin = shapes.first().map_or(around.field, |(_, field)| field);
        let mut system = self.system(self.contact(begin, &x, run), &x);
        let mut residual = f64::MAX;
        for (shape, field) in &shapes {
            system.contact = self.contact(field, &x, run);
            residual = self.frictionless(&mut system, &mut x, shape.is_passing, run)?;
        }
        if shapes.is_empty() {
            residual = self.frictionless(&mut system, &mut x, false, run)?;
        }
        let yields_m = system.contact.yields_m(&x);
        if level == run.levels() {
            if shapes.is_empty() {
                self.hold_out(&mut system.contact, &x, residual <= params.coarse_tolerance);
            } else {
                system.contact = self.contact(around.field, &x, run);
            }
            residual = self.hold(&mut system, &mut x, run)?;
            if self.is_below_floor(&x) {
                self.stand(&mut system, &mut x, run)?;
                residual = self.hold(&mut system, &mut x, run)?;
            }
        }
        let braced_n = system.braces.as_ref().map(|braces| braces.carry_n(&x));
        let (positions, triangles) = (cloth.unweld(&x), cloth.triangles.clone());
        Ok(Settled { positions, residual, is_stuck: run.is_stuck(), yields_m, braced_n, sewn: x, triangles })
    }

    /// Lets the sewn vertices come nearly to rest from `x`, without friction unless it holds throughout; returns true
    /// where they do. It is the round `rounds[0]` of `rounds[1]`.
    pub fn ease(
        &self,
        x: &mut Vec<V3>,
        rest: Rest,
        rounds: [usize; 2],
        run: &mut Simulation,
    ) -> Result<bool, SimError> {
        let Self { around, level, .. } = *self;
        let shape = around.hands.and_then(|hands| hands.of_level(level, run.levels()).next());
        let field = shape.as_ref().map_or(around.field, |(_, field)| field);
        let mut system = self.system(self.contact(field, x, run), x);
        let phase = Phase::easing(run.params(), level, run.levels(), rest, rounds);
        run.drape(self.garment, &mut system, x, phase)?;
        Ok(run.ending() == Ending::AtRest)
    }

    /// True if the cloth reaches below the floor. The floor comes last: it would catch a garment that slides off the
    /// body.
    fn is_below_floor(&self, x: &[V3]) -> bool {
        x.iter().any(|p| p.z < self.around.floor_m)
    }

    /// Raises the floor from below the cloth to its height: cloth longer than the leg comes to lie on it.
    fn stand(&self, system: &mut System, x: &mut Vec<V3>, run: &mut Simulation) -> Result<(), SimError> {
        let floor_m = self.around.floor_m;
        let lowest_m = x.iter().map(|p| p.z).fold(f64::MAX, f64::min) - self.around.contact.offset_m;
        let rises = ((floor_m - lowest_m) / RISE_M).ceil().max(0.0);
        let phase = Phase::passing(run.params(), self.level, run.levels(), STEPS_A_RISE);
        for rise in (0..rises as usize).rev() {
            system.contact.set_floor(floor_m - RISE_M * rise as f64);
            run.drape(self.garment, system, x, phase)?;
        }
        system.contact.set_floor(floor_m);
        Ok(())
    }

    fn contact_areas(&self) -> Vec<f64> {
        let Cloth { vertex_of, areas, .. } = self.cloth;
        contact_areas(self.garment, vertex_of, areas, 2.0 * self.around.self_contact.thickness_m)
    }

    fn system<'s>(&self, contact: BodyContact<'s>, x: &[V3]) -> System<'s>
    where
        'a: 's,
    {
        let cloth: &'a Cloth = self.cloth;
        let mut system = System::new(cloth, contact, None);
        system.braces = (self.grip == Grip::Braced).then(|| Braces::new(cloth, x));
        let touching = ClothContact::new(self.around.self_contact, &cloth.triangles, self.contact_areas());
        system.self_contact = Some(touching);
        system
    }

    /// System of a finest mesh draped at `x`, which comes to rest there with friction where `is_held`.
    pub fn taken_up(&self, x: &mut Vec<V3>, is_held: bool, run: &mut Simulation) -> Result<System<'a>, SimError> {
        let mut system = self.system(self.contact(self.around.field, x, run), x);
        system.contact.set_floor(self.around.floor_m);
        if is_held {
            self.hold(&mut system, x, run)?;
        } else {
            let free = Phase::easing(run.params(), self.level, run.levels(), Rest::of_forces(FREE), [0, 1]);
            for _ in 0..FREE_ROUNDS {
                run.drape(self.garment, &mut system, x, free)?;
                if self.hold_out(&mut system.contact, x, true) <= DEEPEST_M {
                    break;
                }
            }
        }
        Ok(system)
    }

    pub fn pass(&self, x: &mut Vec<V3>, steps: u32, run: &mut Simulation) -> Result<(), SimError> {
        let mut system = self.system(self.contact(self.around.field, x, run), x);
        system.contact.set_floor(self.around.floor_m);
        system.set_friction();
        let phase = Phase::passing(run.params(), self.level, run.levels(), steps);
        run.drape(self.garment, &mut system, x, phase).map(|_| ())
    }

    pub fn rest(&self, mut x: Vec<V3>, run: &mut Simulation) -> Result<Settled, SimError> {
        let mut system = self.system(self.contact(self.around.field, &x, run), &x);
        system.contact.set_floor(self.around.floor_m);
        let residual = self.hold(&mut system, &mut x, run)?;
        let (yields_m, braced_n) = (system.contact.yields_m(&x), None);
        let (positions, triangles) = (self.cloth.unweld(&x), self.cloth.triangles.clone());
        Ok(Settled { positions, residual, is_stuck: run.is_stuck(), yields_m, braced_n, sewn: x, triangles })
    }

    /// Steps until the cloth is at rest, or only a few where `is_passing`. Returns the residual.
    fn frictionless(
        &self,
        system: &mut System,
        x: &mut Vec<V3>,
        is_passing: bool,
        run: &mut Simulation,
    ) -> Result<f64, SimError> {
        let mut params = *run.params();
        if is_passing {
            (params.coarse_steps, params.finest_frictionless_steps) = (PASSING_STEPS, PASSING_STEPS);
        }
        run.drape(self.garment, system, x, Phase::frictionless(&params, self.level, run.levels()))
    }

    fn contact<'f>(&self, field: &'f DistanceField, x: &[V3], run: &Simulation) -> BodyContact<'f> {
        let triangles = &self.cloth.triangles;
        let mut contact = BodyContact::new(field, self.around.contact, &self.cloth.areas);
        if self.level < run.levels() {
            contact = contact.with_points_between(triangles);
        } else {
            if let Some(hands) = self.around.hands {
                contact = contact.with_points_between(&hands.near_triangles(triangles, x));
            }
            self.hold_out(&mut contact, x, false);
        }
        if self.grip != Grip::AtTheEnd {
            contact.set_friction(self.cloth.frictions.iter().map(|friction| friction.body));
        }
        contact
    }

    /// Holds points inside the body out from now on. Returns the greatest depth, m.
    fn hold_out(&self, contact: &mut BodyContact, x: &[V3], is_at_rest: bool) -> f64 {
        let Cloth { membrane, triangles, .. } = self.cloth;
        let deepest = |skin| contact.hold_out(skin, (membrane.pairs.pairs(), triangles), x, is_at_rest);
        self.around.skin.map_or(0.0, deepest)
    }

    /// End of the drape, with friction, until no point lies inside the body. Returns the residual. The tolerance is
    /// loose until then: each round moves the cloth again.
    fn hold(&self, system: &mut System, x: &mut Vec<V3>, run: &mut Simulation) -> Result<f64, SimError> {
        let params = run.params();
        system.set_friction();
        let (mut residual, mut tolerance) = (f64::MAX, params.tolerance.max(HELD));
        for round in 0..HOLDING_ROUNDS {
            residual = run.drape(self.garment, system, x, Phase::final_drape(params, self.level, tolerance))?;
            if run.is_spent() {
                return Ok(residual);
            }
            let is_at_rest = residual <= tolerance;
            let deepest_m = self.hold_out(&mut system.contact, x, is_at_rest);
            if deepest_m <= DEEPEST_M && is_at_rest {
                if tolerance <= params.tolerance {
                    return Ok(residual);
                }
                tolerance = params.tolerance;
            } else if deepest_m > DEEPEST_M && round > 0 {
                system.contact.set_stiffness(self.around.hardened().contact.stiffness_n_m3);
            }
        }
        if tolerance > params.tolerance {
            residual = run.drape(self.garment, system, x, Phase::final_drape(params, self.level, params.tolerance))?;
        }
        Ok(residual)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::Params;
    use crate::laboratory;

    #[test]
    fn what_is_drawn_tight_meets_harder_contacts_but_none_softer_than_asked_for() {
        let (field, params) = (laboratory::nowhere(), Params::default());
        let check = |asked: [f64; 2], expect: [f64; 2]| {
            let contact = ContactParams { stiffness_n_m3: asked[0], ..params.contact };
            let self_contact = ClothContactParams { stiffness_n_m3: asked[1], ..params.self_contact };
            let around =
                Around { skin: None, field: &field, floor_m: 0.0, hands: None, contact, self_contact }.hardened();
            assert_eq!([around.contact.stiffness_n_m3, around.self_contact.stiffness_n_m3], expect);
        };
        check([params.contact.stiffness_n_m3, params.self_contact.stiffness_n_m3], [HARD_N_M3, HARD_LAYERS_N_M3]);
        check([1e10, 1e8], [1e10, 1e8]);
    }
}
