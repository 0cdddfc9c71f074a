//! Uncertainty of each measurement of a scan: a standard deviation with its cause.
//!
//! The standard deviation of a girth is that of its level times the change of girth with height there. The standard
//! deviations of the levels are residuals for 218 model bodies whose bones and nipples are known.

use super::sites::Sites;
use super::tailor::{Marks, knee_level};
use super::tape;
use geom::TriMesh;
use geom::units::mm;

#[derive(Clone, Debug, PartialEq)]
pub struct Confidence {
    pub key: &'static str,
    /// Standard deviation, in the unit of the key: millimetres or degrees.
    pub sd: f64,
    pub reason: &'static str,
}

/// Standard deviations of the levels of nipples, under-bust, hip and knee, as shares of stature.
const NIPPLES: f64 = 0.0090;
const UNDERBUST: f64 = 0.0060;
const HIP: f64 = 0.0040;
const KNEE: f64 = 0.0180;

/// Standard deviations / stature: of nipples from the median plane, wrist joint and elbow along the arm, neck base.
const NIPPLES_OUT: f64 = 0.0045;
const WRIST: f64 = 0.0055;
const NECK_BASE: f64 = 0.0050;

/// Standard deviation of the shoulder slope, degrees.
const SLOPE: f64 = 1.5;

/// Standard deviation of the tape on a smooth skin, m: facets of the mesh, and steps of the search.
const TAPE: f64 = 0.001;

/// Standard deviation of the middle of the thighs, which parts the crotch length, m. Judgement: that of the stance.
const CROTCH: f64 = 0.004;

/// Distance above and below a level over which the change of its girth is measured, m. Judgement.
const STEP: f64 = 0.008;

const SKIN: &str = "facets and noise of the skin";
const NO_MARK: &str = "the nipples leave no mark on the skin: their level is told from form and proportions";
const SHOULDER: &str = "the shoulder point is a bone, told from the turn of the shoulder, the armpit and the arm";
const NAPE: &str = "the back neck point is a bone, told from neck, trapezius and armpit";
const WAIST: &str = "the waist lies at a share of the stature by definition; a person's own may lie elsewhere";
const KNEE_CAP: &str = "the knee cap is not told from the skin: its level follows from stature and crotch";
const JOINTS: &str = "elbow and wrist joint are told from the line of the arm";
const BASE: &str = "the base of the neck is where the skin bends";
const FLOOR: &str = "front and back are parted above the middle of the thighs, which the stance moves";
const FLAT: &str = "a flat summit stands out alike over some height";

pub(super) fn uncertainties(mesh: &TriMesh, sites: &Sites, marks: &Marks) -> Vec<Confidence> {
    let h = marks.stature;
    let trunk = |level: f64, off: f64| {
        let girth_at = |z: f64| tape::trunk_girth(mesh, z, sites.middle);
        girth_error(girth_at(level), [girth_at(level - STEP), girth_at(level + STEP)], off * h)
    };
    let knee = knee_level(marks);
    let leg = |z: f64| tape::leg_girth(mesh, z, sites.middle);
    let knee_girth = girth_error(leg(knee), [leg(knee - STEP), leg(knee + STEP)], KNEE * h);
    let [shoulder, nape] = sites.upper_sd;
    // On a sloping shoulder, the tape lengthens by more than the shoulder point moves outwards.
    let (arm, over) = (shoulder.hypot(WRIST * h), 2.3 * shoulder);
    let base = NECK_BASE * h;
    let known = |key, sd: f64, reason| Confidence { key, sd: mm(sd.hypot(TAPE)), reason };
    vec![
        known("stature_mm", TAPE, SKIN),
        known("neck_girth_mm", TAPE, SKIN),
        known("chest_girth_mm", trunk(sites.chest, NIPPLES), NO_MARK),
        known("chest_level_mm", NIPPLES * h, NO_MARK),
        known("underbust_girth_mm", trunk(sites.underbust, UNDERBUST), NO_MARK),
        known("waist_girth_mm", TAPE, WAIST),
        known("waist_level_mm", 0.0, WAIST),
        known("hip_girth_mm", trunk(sites.hip, HIP), FLAT),
        known("hip_level_mm", HIP * h, FLAT),
        known("thigh_girth_mm", 2.0 * TAPE, SKIN),
        known("upper_arm_girth_mm", 0.005, JOINTS),
        known("knee_girth_mm", knee_girth, KNEE_CAP),
        known("calf_girth_mm", 2.0 * TAPE, SKIN),
        known("ankle_girth_mm", TAPE, SKIN),
        known("forearm_girth_mm", 2.0 * TAPE, JOINTS),
        known("elbow_girth_mm", 0.004, JOINTS),
        known("wrist_girth_mm", 0.002, JOINTS),
        known("arm_length_mm", arm, SHOULDER),
        known("across_shoulder_mm", over, SHOULDER),
        known("inseam_mm", TAPE, SKIN),
        known("cervicale_height_mm", nape, NAPE),
        known("back_waist_length_mm", nape, NAPE),
        known("front_waist_length_mm", 2.0 * base, BASE),
        known("total_crotch_length_mm", 2.0 * TAPE, WAIST),
        known("armscye_depth_mm", nape, NAPE),
        known("armscye_width_mm", shoulder, SHOULDER),
        known("armscye_girth_mm", 2.0 * shoulder, SHOULDER),
        known("bust_point_distance_mm", 2.0 * NIPPLES_OUT * h, NO_MARK),
        known("bust_point_height_mm", NIPPLES * h, NO_MARK),
        Confidence { key: "shoulder_slope_deg", sd: SLOPE, reason: SHOULDER },
        known("shoulder_length_mm", base.hypot(1.2 * shoulder), SHOULDER),
        known("scye_to_waist_mm", 2.0 * TAPE, WAIST),
        known("nape_to_waist_over_bust_mm", nape.hypot(NIPPLES * h), NO_MARK),
        known("front_width_mm", 1.5 * shoulder, SHOULDER),
        known("back_width_mm", 1.5 * shoulder, SHOULDER),
        known("body_rise_mm", TAPE, WAIST),
        known("crotch_length_front_mm", CROTCH, FLOOR),
        known("crotch_length_back_mm", CROTCH, FLOOR),
    ]
}

/// Error of a girth whose level is wrong by `off`, m, by the girths at, below and above the level. On the side where an
/// arm joins the trunk the girth jumps, and the other side is used.
fn girth_error(at: Option<f64>, around: [Option<f64>; 2], off: f64) -> f64 {
    /// Greatest change of a girth with height on a bent skin without a jump, m/m. Judgement.
    const STEEPEST: f64 = 2.5;
    let change = |neighbour: Option<f64>| Some((neighbour? - at?).abs() / STEP).filter(|slope| *slope < STEEPEST);
    around.into_iter().filter_map(change).reduce(f64::max).unwrap_or(STEEPEST) * off
}
