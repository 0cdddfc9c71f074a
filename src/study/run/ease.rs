//! Ease of a garment on a body, before anything is draped.

use body::{Body, Dimension, Joint};
use fit::{Cuts, Ease};
use geom::V3;
use pattern::Style;
use pattern::pom::{Stand, WornLength};

/// Distance of the forearm's girth below the elbow, m.
const FOREARM_BELOW_ELBOW_M: f64 = 0.045;

/// What a body has at a level of its clothes, m.
fn body_length_m(body: &Body, level: &str) -> Option<f64> {
    let dimension = match level {
        "neck" => Dimension::NeckGirth,
        "across_shoulder" => Dimension::AcrossShoulder,
        "chest" | "bust" => Dimension::ChestGirth,
        "underbust" => Dimension::UnderbustGirth,
        "waist" => Dimension::WaistGirth,
        "hip" => Dimension::HipGirth,
        "thigh" => Dimension::ThighGirth,
        "knee" => Dimension::KneeGirth,
        "upper_arm" => Dimension::UpperArmGirth,
        "forearm" => Dimension::ForearmGirth,
        "wrist" => Dimension::WristGirth,
        _ => return None,
    };
    body.girths.get(dimension)
}

/// Where a body has its levels.
fn stand(body: &Body) -> Stand {
    let mean = |pair: [V3; 2]| 0.5 * (pair[0] + pair[1]);
    let levels = &body.levels;
    let at = |joint: Joint| body.skeleton.at(joint);
    let upper_arm_m = (at(Joint::ElbowRight) - body.landmarks.shoulder[0]).norm();
    let lower_arm_m = (at(Joint::WristRight) - at(Joint::ElbowRight)).norm();
    Stand {
        side_neck_m: mean(body.landmarks.side_neck).z,
        underbust_m: levels.underbust_m,
        waist_m: levels.waist_m,
        hip_m: levels.hip_m,
        crotch_m: levels.crotch_m,
        knee_m: 0.5 * (at(Joint::KneeRight).z + at(Joint::KneeLeft).z),
        forearm_along_m: upper_arm_m + FOREARM_BELOW_ELBOW_M,
        wrist_along_m: upper_arm_m + lower_arm_m,
    }
}

/// Ease at every level that the garment covers, from the neck down: along the lines of its seam file, and where that has none, along
/// those found by what its pieces are. A study's own cuts classify it when it is read.
pub(crate) fn on(style: &Style, body: &Body) -> Vec<Ease> {
    on_all(style, &[body]).pop().unwrap_or_default()
}

/// The same for several bodies: what the pieces are is found once.
pub(crate) fn on_all(style: &Style, bodies: &[&Body]) -> Vec<Vec<Ease>> {
    let stands: Vec<Stand> = bodies.iter().map(|body| stand(body)).collect();
    let stated: Vec<(&str, f64)> =
        style.fit_levels.iter().map(|(level, path)| (level.as_str(), style.path_length_m(path))).collect();
    let worn = style.worn_lengths_on(&stands);
    bodies.iter().zip(&worn).map(|(body, found)| of(&stated, found, body)).collect()
}

fn of(stated: &[(&str, f64)], found: &[WornLength], body: &Body) -> Vec<Ease> {
    let is_stated = |level: &str| stated.iter().any(|(name, _)| *name == level);
    let mut levels: Vec<(&str, f64, Option<f64>)> = Vec::new();
    levels.extend(stated.iter().map(|(level, length_m)| (*level, *length_m, None)));
    let others = found.iter().filter(|worn| !is_stated(worn.level));
    levels.extend(others.map(|worn| (worn.level, worn.length_m, worn.height_m)));
    let pattern = levels.iter().map(|(level, length_m, _)| (*level, *length_m));
    let of_body = |level: &str| {
        let height_m = levels.iter().find(|(name, ..)| *name == level).and_then(|(_, _, height_m)| *height_m);
        height_m.and_then(|height_m| body.trunk_girth_at(height_m)).or_else(|| body_length_m(body, level))
    };
    fit::ease(pattern, of_body, &Cuts::default())
}
