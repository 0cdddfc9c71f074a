//! One level of a sewn garment comes to rest: without friction, and on the finest mesh with it and held outside the body.

use super::Params;
use super::hands::Hands;
use super::run::{Phase, Run};
use crate::geom::{DistanceField, V3};
use crate::pattern::Garment;
use crate::sim::cloth::Cloth;
use crate::sim::contact::{BodyContact, ClothContact, ContactParams, Skin};
use crate::sim::solver::System;
use crate::sim::{Fabric, SimError};

/// Deepest point of a drape that is good, m.
const DEEPEST_M: f64 = 3e-4;
/// Times at most that a drape is taken up again, because it is not at rest yet or to hold out points inside the body.
const HOLDING_ROUNDS: usize = 5;
/// Penalty of the contact with the body where cloth is drawn tight or over a hand, N/m3: fingertips press through a softer one.
const HARD_N_M3: f64 = 1e9;
/// Steps on each shape of a hand that opens or is laid bare.
const OPENING_STEPS: u32 = 12;

/// From when on friction holds a garment.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Grip {
    /// Once it has come to rest without: then the drape does not depend on how the seams were closed.
    AtTheEnd,
    /// From the sewing on: for what would slide off the body without.
    Throughout,
}

/// The body as contact sees it: exactly, and as a field.
#[derive(Clone, Copy)]
pub struct Around<'a> {
    /// `None` where the mesh bounds no solid: then only the field holds the cloth.
    pub skin: Option<&'a Skin<'a>>,
    /// Distance from the body.
    pub field: &'a DistanceField,
    /// Hands that the cloth comes near.
    pub hands: Option<&'a Hands<'a>>,
    /// How the body pushes.
    pub contact: ContactParams,
}

impl Around<'_> {
    /// The same with a contact that does not give way under cloth that is drawn tight.
    pub fn hardened(self) -> Self {
        let stiffness_n_m3 = self.contact.stiffness_n_m3.max(HARD_N_M3);
        Self { contact: ContactParams { stiffness_n_m3, ..self.contact }, ..self }
    }

    /// The fields in which a level settles without friction, one after the other, where they are not the body's own: hands
    /// are folded on the coarsest level and opened on the next.
    fn without_fingers(&self, level: usize, finest: usize) -> Vec<DistanceField> {
        let Some(hands) = self.hands else { return Vec::new() };
        match level {
            0 if finest > 0 => vec![hands.folded()],
            0 | 1 => hands.opening().collect(),
            _ => hands.opening().last().into_iter().collect(),
        }
    }
}

/// A settled level.
pub struct Settled {
    /// Of the garment's vertices, m.
    pub positions: Vec<V3>,
    /// Rms force over mean vertex weight.
    pub residual: f64,
    /// How far the contact with the body yields, m.
    pub yields_m: f64,
    /// Positions of the sewn vertices, m.
    pub sewn: Vec<V3>,
    /// Triangles of the sewn vertices.
    pub triangles: Vec<[usize; 3]>,
}

/// A level that is to settle.
pub struct Settling<'a> {
    /// What it lies on.
    pub around: Around<'a>,
    /// Its mesh.
    pub garment: &'a Garment,
    /// The same, sewn.
    pub cloth: &'a Cloth,
    /// What it is made of.
    pub fabric: &'a Fabric,
    /// Its number, coarsest first.
    pub level: usize,
    /// When friction begins.
    pub grip: Grip,
}

impl Settling<'_> {
    /// Lets the sewn vertices come to rest from `x`.
    ///
    /// # Errors
    /// When they diverge or slide off the body, or the monitor cancels.
    pub fn settle(&self, mut x: Vec<V3>, run: &mut Run) -> Result<Settled, SimError> {
        let Self { around, cloth, level, .. } = *self;
        let params = run.params();
        let is_finest = level == run.levels();
        let stages = around.without_fingers(level, run.levels());
        let baring: Vec<DistanceField> =
            around.hands.filter(|_| is_finest).into_iter().flat_map(Hands::baring).collect();
        let (last, opening) = stages.split_last().map_or((around.field, &[][..]), |(last, opening)| (last, opening));
        let mut system = System::new(cloth, self.contact(last, &x, run), None);
        system.self_contact = Some(ClothContact::new(params.self_contact, &cloth.triangles, &cloth.areas));
        if !opening.is_empty() {
            self.pass_through(opening, &mut system, &mut x, run)?;
            system.contact = self.contact(last, &x, run);
        }
        let frictionless = Phase::frictionless(params, level, run.levels());
        let mut residual = run.drape(self.garment, &mut system, &mut x, frictionless)?;
        if is_finest {
            if baring.is_empty() {
                self.hold_out(&mut system.contact, &x, residual <= params.coarse_tolerance);
            } else {
                self.pass_through(&baring, &mut system, &mut x, run)?;
                system.contact = self.contact(around.field, &x, run);
            }
            residual = self.hold(&mut system, &mut x, run)?;
        }
        let yields_m = system.contact.yields_m(&x);
        Ok(Settled { positions: cloth.unweld(&x), residual, yields_m, sewn: x, triangles: cloth.triangles.clone() })
    }

    /// Contact in a field of cloth that begins at `x`.
    fn contact<'f>(&self, field: &'f DistanceField, x: &[V3], run: &Run) -> BodyContact<'f> {
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
        if self.grip == Grip::Throughout {
            contact.set_friction(Some(self.fabric.friction_body));
        }
        contact
    }

    /// Holds points inside the body out from now on; returns how deep the deepest lies, m.
    fn hold_out(&self, contact: &mut BodyContact, x: &[V3], is_at_rest: bool) -> f64 {
        let deepest = |skin| contact.hold_out(skin, &self.cloth.triangles, x, is_at_rest);
        self.around.skin.map_or(0.0, deepest)
    }

    /// A few steps in each of some fields.
    fn pass_through<'f>(
        &self,
        fields: &'f [DistanceField],
        system: &mut System<'f>,
        x: &mut Vec<V3>,
        run: &mut Run,
    ) -> Result<(), SimError> {
        let brief = Params { coarse_steps: OPENING_STEPS, finest_frictionless_steps: OPENING_STEPS, ..*run.params() };
        let phase = Phase::frictionless(&brief, self.level, run.levels());
        for field in fields {
            system.contact = self.contact(field, x, run);
            run.drape(self.garment, system, x, phase)?;
        }
        Ok(())
    }

    /// The end of the drape, with friction, until no point lies inside the body; returns the residual.
    fn hold(&self, system: &mut System, x: &mut Vec<V3>, run: &mut Run) -> Result<f64, SimError> {
        let params = run.params();
        system.contact.set_friction(Some(self.fabric.friction_body));
        let mut residual = f64::MAX;
        for round in 0..HOLDING_ROUNDS {
            residual = run.drape(self.garment, system, x, Phase::final_drape(params, self.level))?;
            let is_at_rest = residual <= params.tolerance;
            let deepest_m = self.hold_out(&mut system.contact, x, is_at_rest);
            if deepest_m <= DEEPEST_M && is_at_rest {
                break;
            }
            if deepest_m > DEEPEST_M && round > 0 {
                system.contact.set_stiffness(self.around.hardened().contact.stiffness_n_m3);
            }
        }
        Ok(residual)
    }
}
