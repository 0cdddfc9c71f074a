//! Ease of a garment on a body by the flat pattern, before draping.

use body::{Body, Dimension, Girths, Joint};
use fit::{Cuts, Ease};
use geom::V3;
use pattern::Style;
use pattern::pom::{Stand, WornLength};
use pattern::style::PathPart;

/// Distance below the elbow at which the forearm's girth is measured.
const FOREARM_BELOW_ELBOW_M: f64 = 0.045;

/// `None` where the body has no dimension for the level.
pub fn body_length_m(girths: &Girths, level: &str) -> Option<f64> {
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
    girths.get(dimension)
}

/// Heights of the levels, and lengths along the arms.
pub fn stand(body: &Body) -> Stand {
    let mean = |pair: [V3; 2]| 0.5 * (pair[0] + pair[1]);
    let levels = &body.levels;
    let joint = |joint: Joint| body.skeleton.at(joint);
    let upper_arm_m = (joint(Joint::ElbowRight) - body.landmarks.shoulder[0]).norm();
    let lower_arm_m = (joint(Joint::WristRight) - joint(Joint::ElbowRight)).norm();
    Stand {
        side_neck_m: mean(body.landmarks.side_neck).z,
        underbust_m: levels.underbust_m,
        waist_m: levels.waist_m,
        hip_m: levels.hip_m,
        crotch_m: levels.crotch_m,
        knee_m: 0.5 * (joint(Joint::KneeRight).z + joint(Joint::KneeLeft).z),
        forearm_along_m: upper_arm_m + FOREARM_BELOW_ELBOW_M,
        wrist_along_m: upper_arm_m + lower_arm_m,
    }
}

/// Ease at every level that the garment covers, from the neck down. The pattern is measured along the line that the
/// seam file gives for the level, else along a line found from the roles of the pieces. Fit classes use the default
/// cuts; readers apply those of the study.
pub fn on(style: &Style, body: &Body) -> Vec<Ease> {
    on_all(style, &[body]).pop().unwrap_or_default()
}

/// Ease as by [`on`], with the roles of the pieces found only once.
pub fn on_all(style: &Style, bodies: &[&Body]) -> Vec<Vec<Ease>> {
    let stands: Vec<Stand> = bodies.iter().map(|body| stand(body)).collect();
    bodies.iter().zip(lengths_on(style, &stands)).map(|(body, lengths)| ease(&lengths, body)).collect()
}

fn ease(lengths: &[Length], body: &Body) -> Vec<Ease> {
    let body_m = |level: &str| {
        let height_m = lengths.iter().find(|length| length.level == level).and_then(|length| length.height_m);
        height_m.and_then(|height_m| body.trunk_girth_at(height_m)).or_else(|| body_length_m(&body.girths, level))
    };
    let levels = lengths.iter().map(|length| (length.level.as_str(), length.length_m, length.is_held));
    fit::ease(levels, body_m, &Cuts::default())
}

pub struct Length {
    pub level: String,
    pub length_m: f64,
    /// Height above the floor where the body is measured; `None` for the height of the level.
    pub height_m: Option<f64>,
    /// True if the cut holds the garment to the body there.
    pub is_held: bool,
    /// Path along which the length is measured; where half a girth is measured, the path of this half.
    pub path: Vec<PathPart>,
}

/// Lengths at every level that a style covers, those along lines of the seam file first.
pub fn lengths(style: &Style, stand: &Stand) -> Vec<Length> {
    lengths_on(style, std::slice::from_ref(stand)).pop().unwrap_or_default()
}

fn lengths_on(style: &Style, stands: &[Stand]) -> Vec<Vec<Length>> {
    let is_stated = |level: &str| style.fit_levels.iter().any(|(name, _)| name == level);
    let stated = |worn: &[WornLength]| -> Vec<Length> {
        let is_held = |level: &str| worn.iter().find(|worn| worn.level == level).is_none_or(|worn| worn.is_held);
        let length = |(level, path): &(String, Vec<PathPart>)| Length {
            level: level.clone(),
            length_m: style.path_length_m(path),
            height_m: None,
            is_held: is_held(level),
            path: path.clone(),
        };
        style.fit_levels.iter().map(length).collect()
    };
    let found = |worn: WornLength| Length {
        level: worn.level.to_owned(),
        length_m: worn.length_m,
        height_m: worn.height_m,
        is_held: worn.is_held,
        path: worn.path,
    };
    let all = |worn: Vec<WornLength>| {
        stated(&worn).into_iter().chain(worn.into_iter().filter(|worn| !is_stated(worn.level)).map(found)).collect()
    };
    style.worn_lengths_on(stands).into_iter().map(all).collect()
}
