//! Draped draws of one size: body, cloth and start are drawn, and the drapes measured.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;
use serde_json::json;

use crate::chance::Question;
use crate::chance::bench::{Bench, Level, Sized};
use crate::error::AdviceError;
use engine::Outcome;
use engine::fitting::Fitting;
use engine::stages::{self, Garb, Meshes};
use fit::chance::{self, Share, Sitting};
use fit::{Draw, Simulator};
use geom::DistanceField;
use geom::units::mm;
use sim::dressing::Wearer;
use sim::fabric::{Kind, weights};
use sim::{Fabric, Silent};
use spec::versions::FIELD_SPACING_M;
use spec::{JobSpec, bodies};
use store::{InOrigin, Origin, Result};

/// Range of the distance at which pieces start from the body, in body depths: from the default to that of the thesis [T
/// 4.4.2].
const OFFSET_MU: [f64; 2] = [2.1, 4.1];

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrapedChance {
    pub draws: usize,
    pub at_rest: usize,
    /// Probability that every level of the drape is within its target.
    pub fits: Share,
    /// Lower end, middle and upper end of the 80 % interval of the drape's ease, by level.
    pub ease_mm: BTreeMap<String, [f64; 3]>,
    /// Height of the hem in front minus its height behind, likewise.
    pub hem_front_over_back_mm: Option<[f64; 3]>,
    /// Greatest pressure, likewise.
    pub most_kpa: Option<[f64; 3]>,
    /// Cantilever bending length along the grain line, likewise.
    pub bending_length_mm: [f64; 3],
    pub refused: Vec<String>,
}

struct Drawn {
    outcome: Outcome,
    eases_m: Vec<f64>,
    bending_m: f64,
}

/// A draw that cannot be draped is no error.
pub(super) fn draped(job: &JobSpec, bench: &Bench, question: &Question) -> Result<DrapedChance> {
    let style = stages::style(job)?;
    let meshes = Arc::new(Meshes::of(&style, job.edge_length_m)?);
    let garb = Garb { style, meshes, fabric: job.fabric.clone() };
    let size = bench.sizes.iter().find(|size| size.size == job.size).ok_or(AdviceError::UnknownSize)?;
    let mut draw = Draw::new(question.seed);
    let (mut drawn, mut refused) = (Vec::new(), Vec::new());
    for number in 1..=question.fem {
        match drawn_and_draped(job, bench, size, &garb, &mut draw) {
            Ok(draped) => drawn.push(draped),
            Err(error) => refused.push(format!("draw {number}: {error}")),
        }
    }
    let bands = size.bands();
    let fits =
        |draw: &&Drawn| chance::verdict(&draw.eases_m, &bands).sitting == Sitting::Fits && draw.outcome.converged;
    let values = |value: &dyn Fn(&Drawn) -> Option<f64>| -> Vec<f64> { drawn.iter().filter_map(value).collect() };
    let known = |values: Vec<f64>| (!values.is_empty()).then(|| chance::interval(&values));
    let level = |number: usize| chance::interval(&values(&|draw| draw.eases_m.get(number).copied())).map(mm);
    Ok(DrapedChance {
        draws: drawn.len(),
        at_rest: drawn.iter().filter(|draw| draw.outcome.converged).count(),
        fits: Share::of(drawn.iter().filter(fits).count(), drawn.len()),
        ease_mm: size.levels.iter().enumerate().map(|(number, known)| (known.name.clone(), level(number))).collect(),
        hem_front_over_back_mm: known(values(&|draw| draw.outcome.worn.hem_front_over_back_m().map(mm))),
        most_kpa: known(values(&|draw| draw.outcome.worn.most_kpa())),
        bending_length_mm: chance::interval(&values(&|draw| Some(draw.bending_m))).map(mm),
        refused,
    })
}

fn drawn_and_draped(job: &JobSpec, bench: &Bench, size: &Sized, garb: &Garb, draw: &mut Draw) -> Result<Drawn> {
    let person = bench.person(draw);
    let made_m = size.made_m(draw);
    let garb = Garb { fabric: drawn_fabric(&garb.fabric, draw), ..garb.clone() };
    let [near, far] = OFFSET_MU;
    let mut parameters = job.parameters.clone();
    parameters.set("fem.offset_mu", json!(near + (far - near) * draw.share())).origin(Origin::Chance)?;
    let body = bodies::build_body(&person)?;
    let field = DistanceField::build(&body.mesh, FIELD_SPACING_M).origin(Origin::Field)?;
    let wearer = Wearer { body: &body, field: &field };
    let fitting = Fitting { wearer, garb: &garb, simulator: Simulator::Fem, parameters: &parameters };
    let outcome = fitting.outcome(&fitting.simulate(&mut Silent)?)?;
    let ease_m = |(level, made_m): (&Level, f64)| worn_ease_m(&outcome, &level.name) + made_m;
    let eases_m = size.levels.iter().zip(made_m).map(ease_m).collect();
    Ok(Drawn { eases_m, bending_m: garb.fabric.bending_lengths_m()[0], outcome })
}

/// Draws a cloth for a class: as stiff as one of the known cloths of its weight. A fabric that is a measured cloth
/// stays.
fn drawn_fabric(fabric: &Fabric, draw: &mut Draw) -> Fabric {
    let percentile = 100.0 * draw.share();
    let is_class = fabric.known().is_some_and(|known| known.kind == Kind::Class);
    if !is_class {
        return fabric.clone();
    }
    let [bending_warp_nm, bending_weft_nm] = weights::rigidities(fabric.density_kg_m2, percentile);
    Fabric { bending_warp_nm, bending_weft_nm, ..fabric.clone() }
}

/// Flat length times the stretch of the point of measure nearest to the level, less the body's length. NaN where the
/// garment has no such level on this body.
fn worn_ease_m(outcome: &Outcome, level: &str) -> f64 {
    let points: &[&str] = match level {
        "chest" | "bust" | "underbust" => &["half_chest"],
        "waist" => &["half_waist"],
        "hip" => &["half_hip", "half_hem"],
        "thigh" => &["half_thigh"],
        "knee" => &["half_knee"],
        "upper_arm" | "forearm" => &["half_bicep"],
        "wrist" => &["half_cuff"],
        "neck" => &["neck"],
        _ => &["across_shoulder"],
    };
    let point = points.iter().find_map(|name| outcome.points.iter().find(|point| point.point == *name));
    let stretch = point.and_then(|point| Some(point.draped_m? / point.flat_m)).unwrap_or(1.0);
    let ease = outcome.eases.iter().find(|ease| ease.level == level);
    ease.map_or(f64::NAN, |ease| stretch * ease.pattern_girth_m - ease.body_girth_m)
}
