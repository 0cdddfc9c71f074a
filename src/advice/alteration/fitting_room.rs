//! Drapes of a changed pattern by FEM-GS: their readings, and the sensitivity of readings to the handles.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::alteration::readings::{Place, Reading, Readings};
use crate::alteration::{Redraped, STEP_M, Sensitivity};
use body::Body;
use engine::Outcome;
use engine::fitting::Fitting;
use engine::stages::{Garb, Meshes};
use fit::Simulator;
use geom::units::mm;
use geom::{DistanceField, V2, V3};
use pattern::{Garment, Handle, Style};
use sim::contact::Skin;
use sim::dressing::Wearer;
use sim::fem::response::{Lying, Response, sewn};
use sim::fem::{self, Params};
use sim::{Drape, Silent};
use spec::JobSpec;
use spec::versions::FIELD_SPACING_M;
use store::{InOrigin, Origin, Result};

/// Movement of a handle by which the response of a drape is found: so small that the mesh can deform along.
const TAKEN_ALONG_M: f64 = 0.1e-3;

/// Seeds of the drapes from which scatter is estimated.
const STARTS: [u64; 4] = [0, 1, 2, 3];
/// Least scatter that an estimate from a few drapes may claim: mm, degrees, or kPa.
const LEAST_SCATTER: f64 = 1.0;
const LEAST_SCATTER_KPA: f64 = 0.02;

pub struct FittingRoom<'a> {
    spec: &'a JobSpec,
    body: &'a Body,
    field: DistanceField,
}

impl<'a> FittingRoom<'a> {
    pub fn new(spec: &'a JobSpec, body: &'a Body) -> Result<Self> {
        let field = DistanceField::build(&body.mesh, FIELD_SPACING_M).origin(Origin::Field)?;
        Ok(Self { spec, body, field })
    }

    /// Drapes as the study does. Returns the ease of the drape at every level too.
    pub fn outcome(&self, style: &Style) -> Result<(Outcome, Vec<(String, f64)>)> {
        let Draped { garb, drape, outcome } = self.draped(style)?;
        Ok((outcome, self.fitting(&garb).eases_on(&drape)?))
    }

    fn draped(&self, style: &Style) -> Result<Draped> {
        let garb = self.garb(style, Meshes::of(style, self.spec.edge_length_m)?);
        let fitting = self.fitting(&garb);
        let drape = fitting.simulate(&mut Silent)?;
        let outcome = fitting.outcome(&drape)?;
        Ok(Draped { garb, drape, outcome })
    }

    /// Drapes as the study does.
    pub fn drape(&self, style: &Style) -> Result<(Redraped, Readings)> {
        let Draped { garb, drape, outcome } = self.draped(style)?;
        let garment = garb.meshes.finest()?;
        let place = Place::new(self.body, style, garment, &self.spec.fabric)?;
        let redraped = Redraped {
            converged: outcome.converged,
            ei: outcome.metrics.ei,
            penetration_max_mm: mm(outcome.penetration_max_m),
            hem_front_over_back_mm: outcome.worn.hem_front_over_back_m().map(mm),
            most_kpa: outcome.worn.most_kpa(),
            drag_lines: outcome.worn.folds.iter().filter(|fold| fold.is_drag).count(),
        };
        Ok((redraped, place.readings(garment, &drape.positions)?))
    }

    /// Scatter of readings between coarse drapes from slightly different starts: standard deviations, in the units of
    /// the readings. Drapes scatter since cloth can come to rest in many nearly equal ways.
    pub fn scatter(&self, style: &Style) -> Result<Readings> {
        let meshes = self.coarse(style)?;
        let garment = meshes.finest()?;
        let place = Place::new(self.body, style, garment, &self.spec.fabric)?;
        let drape = |seed: u64| {
            let params = Params { seed, ..self.spec.parameters.fem()? };
            let drape = fem::simulate(self.body, &self.field, &meshes.0, &self.spec.fabric, &params, &mut Silent);
            place.readings(garment, &drape.origin(Origin::Sim)?.positions)
        };
        let all = STARTS.into_iter().map(drape).collect::<Result<Vec<_>>>()?;
        let scatter = |(name, reading): (&String, &Reading)| {
            let values = all.iter().map(|readings| readings.get(name).map(|reading| reading.value));
            let values: Vec<f64> = values.collect::<Option<_>>()?;
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            let least = if reading.unit == "kPa" { LEAST_SCATTER_KPA } else { LEAST_SCATTER };
            let value = (squares / (values.len() - 1) as f64).sqrt().max(least);
            Some((name.clone(), Reading { value, ..*reading }))
        };
        Ok(all.first().map_or_else(Readings::new, |first| first.iter().filter_map(scatter).collect()))
    }

    /// All meshes but the finest.
    fn coarse(&self, style: &Style) -> Result<Meshes> {
        let mut meshes = Meshes::of(style, self.spec.edge_length_m)?;
        if meshes.0.len() > 1 {
            meshes.0.pop();
        }
        Ok(meshes)
    }

    /// Sensitivity of all readings of a drape to each handle, per metre. The drape is coarser than that of the study.
    /// It slides without friction, since a newly sewn drape would find its place freely.
    pub fn answers(&self, style: &Style, handles: &[Handle]) -> Result<Answers> {
        let garb = self.garb(style, self.coarse(style)?);
        let drape = self.fitting(&garb).simulate(&mut Silent)?;
        let (garment, fabric) = (garb.meshes.finest()?, &garb.fabric);
        let skin = Skin::new(&self.body.mesh).ok();
        let params = self.spec.parameters.fem()?;
        let floor_m = fem::floor_m(self.body);
        let lying = Lying {
            skin: skin.as_ref(),
            field: &self.field,
            floor_m,
            garment,
            fabric,
            params: &params,
            is_held: false,
        };
        let cloth = sewn(garment, fabric).origin(Origin::Alter)?;
        let response = Response::of(lying, &cloth, &drape.positions).origin(Origin::Alter)?;
        let place = Place::new(self.body, style, garment, fabric)?;
        let rested = response.positions();
        let answer = |handle: Handle| -> Result<Sensitivity> {
            let moved = |by_m: f64| style.moved_mesh(garment, handle, by_m);
            // A handle that cannot move on a changed style has no effect.
            let (Ok(more), Ok(less)) = (moved(TAKEN_ALONG_M), moved(-TAKEN_ALONG_M)) else {
                return Ok(Sensitivity::new());
            };
            let rates = response.rates([&less, &more], 2.0 * TAKEN_ALONG_M).origin(Origin::Alter)?;
            let readings_at = |by_m: f64| {
                let drawn = along(garment, [&less, &more], by_m);
                let positions: Vec<V3> = rested.iter().zip(&rates).map(|(p, rate)| p + rate * by_m).collect();
                place.readings(&drawn, &positions)
            };
            Ok(changes(&readings_at(STEP_M)?, &readings_at(-STEP_M)?, 2.0 * STEP_M))
        };
        let of_handles = handles.iter().map(|handle| answer(*handle)).collect::<Result<Vec<_>>>()?;
        Ok(Answers { of_handles, is_stable: response.is_stable() })
    }

    fn garb(&self, style: &Style, meshes: Meshes) -> Garb {
        Garb { style: style.clone(), meshes: Arc::new(meshes), fabric: self.spec.fabric.clone() }
    }

    fn fitting<'f>(&'f self, garb: &'f Garb) -> Fitting<'f> {
        let wearer = Wearer { body: self.body, field: &self.field };
        Fitting { wearer, garb, simulator: Simulator::Fem, parameters: &self.spec.parameters }
    }
}

struct Draped {
    garb: Garb,
    drape: Drape,
    outcome: Outcome,
}

pub struct Answers {
    /// Sensitivity of the readings to each handle, in their units per metre.
    pub of_handles: Vec<Sensitivity>,
    /// True if the drape is a stable equilibrium: every displacement raises its energy.
    pub is_stable: bool,
}

/// Mesh of a garment with a handle moved by `by_m`, by linear extrapolation from two meshes that differ by as much to
/// either side.
fn along(garment: &Garment, [less, more]: [&Garment; 2], by_m: f64) -> Garment {
    let share = by_m / (2.0 * TAKEN_ALONG_M);
    let rest: Vec<V2> =
        (0..garment.rest.len()).map(|v| garment.rest[v] + (more.rest[v] - less.rest[v]) * share).collect();
    garment.with_rest(rest)
}

/// Differences of readings divided by `between`.
fn changes(after: &Readings, before: &Readings, between: f64) -> BTreeMap<String, f64> {
    let change =
        |(name, after): (&String, &Reading)| Some((name.clone(), (after.value - before.get(name)?.value) / between));
    after.iter().filter_map(change).collect()
}
