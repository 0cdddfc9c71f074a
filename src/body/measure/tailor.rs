//! Tailor's measurements other than girths: armscye, bust points, shoulder slope, widths and rise. Each has the line
//! along which it is read, for drawing.

use super::arm::Arm;
use super::landmarks::{self, Side, median_point};
use super::neck_base;
use super::sites::Sites;
use super::slices::steps;
use super::tape;
use crate::{Body, Joint, Sex};
use geom::section::{Outline, Plane, section};
use geom::units::mm;
use geom::{TriMesh, V2, V3, hull};

#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// Key with its unit: `armscye_depth_mm`, `shoulder_slope_deg`.
    pub key: &'static str,
    /// `None` if the body does not show the measurement.
    pub written: Option<f64>,
    /// Line on the skin along which the measurement is read, m.
    pub path: Vec<V3>,
}

/// Landmarks and levels by which a tailor measures, m. Those of limbs are for the right side.
pub(super) struct Marks {
    pub stature: f64,
    pub floor: f64,
    pub middle: f64,
    pub crotch: f64,
    pub waist: f64,
    pub shoulder: V3,
    pub back_neck: V3,
    pub side_neck: Option<V3>,
    pub armpit: Option<V3>,
    pub bust: Option<[V3; 2]>,
    pub arm: Option<Arm>,
}

impl Marks {
    pub fn of_mesh(mesh: &TriMesh, sites: &Sites, sex: Sex) -> Self {
        let stature = sites.crown - sites.floor;
        let shoulder = sites.shoulder[0];
        let armpit = landmarks::armpit(mesh, sites.waist, shoulder.z, sites.middle)
            .or_else(|| landmarks::armpit_of_spread(mesh, shoulder, stature));
        let bust =
            [1.0, -1.0].map(|side| landmarks::usual_bust_point(mesh, sites.chest, side, [sites.middle, stature], sex));
        Self {
            stature,
            floor: sites.floor,
            middle: sites.middle,
            crotch: sites.crotch,
            waist: sites.waist,
            shoulder,
            back_neck: sites.back_neck,
            side_neck: neck_base::side_neck(mesh, sites, shoulder),
            armpit,
            bust: bust[0].zip(bust[1]).map(|(right, left)| [right, left]),
            arm: armpit.and_then(|armpit| Arm::trace(mesh, shoulder, armpit, stature)),
        }
    }

    fn of_body(body: &Body) -> Self {
        let (low, high) = body.mesh.bounds().unwrap_or((V3::zeros(), V3::zeros()));
        let stature = high.z - low.z;
        let [shoulder, armpit] = [body.landmarks.shoulder[0], body.landmarks.armpit[0]];
        Self {
            stature,
            floor: low.z,
            middle: body.skeleton.at(Joint::Waist).x,
            crotch: body.landmarks.crotch.z,
            waist: low.z + body.levels.waist_m,
            shoulder,
            back_neck: body.landmarks.back_neck,
            side_neck: Some(body.landmarks.side_neck[0]),
            armpit: Some(armpit),
            bust: Some(body.landmarks.bust),
            arm: Arm::trace(&body.mesh, shoulder, armpit, stature),
        }
    }
}

pub(crate) fn of_body(body: &Body) -> Vec<Taken> {
    take(&body.mesh, &Marks::of_body(body))
}

pub(super) fn take(mesh: &TriMesh, marks: &Marks) -> Vec<Taken> {
    let length = |key, path: Option<Vec<V3>>| {
        let path = path.unwrap_or_default();
        Taken { key, written: (path.len() > 1).then(|| mm(length_of(&path))), path }
    };
    let down = |from: V3, to: f64| vec![from, V3::new(from.x, from.y, to)];
    let armpit = |to: f64| marks.armpit.map(|armpit| down(armpit, to));
    let armscye = armscye(mesh, marks);
    let slope = marks.side_neck.map(|neck| {
        let (out, fall) = ((marks.shoulder.x - neck.x).hypot(marks.shoulder.y - neck.y), neck.z - marks.shoulder.z);
        fall.atan2(out).to_degrees()
    });
    let shoulder = marks.side_neck.and_then(|neck| taut(mesh, neck, marks.shoulder, V3::z()));
    let rise = median_point(mesh, marks.waist, marks.middle, Side::Front).map(|waist| down(waist, marks.crotch));
    let crotch = |side: Side| crotch_length(mesh, [marks.crotch, marks.waist], marks.middle, side);
    vec![
        length("armscye_depth_mm", marks.armpit.and_then(|armpit| scye_depth(mesh, marks, armpit.z))),
        length("armscye_width_mm", armscye.as_deref().map(depth_of)),
        length("armscye_girth_mm", armscye),
        length("bust_point_distance_mm", marks.bust.map(|points| points.to_vec())),
        length("bust_point_height_mm", marks.bust.map(|[right, _]| down(right, marks.floor))),
        Taken { key: "shoulder_slope_deg", written: slope, path: shoulder.clone().unwrap_or_default() },
        length("shoulder_length_mm", shoulder),
        length("scye_to_waist_mm", armpit(marks.waist)),
        length("nape_to_waist_over_bust_mm", over_bust(mesh, marks)),
        length("front_width_mm", width(mesh, marks, 1.0)),
        length("back_width_mm", width(mesh, marks, -1.0)),
        length("body_rise_mm", rise),
        length("crotch_length_front_mm", crotch(Side::Front)),
        length("crotch_length_back_mm", crotch(Side::Back)),
    ]
}

pub(super) fn length_of(path: &[V3]) -> f64 {
    path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

/// Taut tape between two points of the skin: the convex hull of the section in the plane of both points and `out`, on
/// the side of `out`. `None` if no outline passes both ends.
pub(super) fn taut(mesh: &TriMesh, from: V3, to: V3, out: V3) -> Option<Vec<V3>> {
    /// Greatest distance of an end from the outline that the tape follows, m. Judgement.
    const NEAR: f64 = 0.02;
    let along = (to - from).try_normalize(1e-9)?;
    let up = (out - along * out.dot(&along)).try_normalize(1e-9)?;
    let plane = Plane { origin: from, u: along, v: up };
    let reach = (to - from).norm();
    let ends = [V2::zeros(), V2::new(reach, 0.0)];
    let near = |outline: &Outline| ends.iter().any(|end| outline.points.iter().any(|p| (p - end).norm() < NEAR));
    let between = |p: &V2| p.x > 0.0 && p.x < reach && p.y > 0.0;
    let outlines = section(mesh, &plane).into_iter().filter(near);
    let mut points: Vec<V2> = outlines.flat_map(|outline| outline.points).filter(between).collect();
    points.extend(ends);
    // From the first end the hull runs counter-clockwise straight to the second, and then back over the skin.
    let mut path: Vec<V2> = hull::convex_hull(&points);
    path.rotate_left(1);
    path.reverse();
    Some(path.into_iter().map(|p| plane.lift(p)).collect())
}

/// Armscye depth: from the back neck point down the centre back to the level of the armpit.
fn scye_depth(mesh: &TriMesh, marks: &Marks, level: f64) -> Option<Vec<V3>> {
    taut(mesh, marks.back_neck, median_point(mesh, level, marks.middle, Side::Back)?, -V3::y())
}

/// Crotch length front or back: from the waist level in the median plane to the fork, above the middle of the thighs.
pub(super) fn crotch_length(mesh: &TriMesh, [crotch, waist]: [f64; 2], middle: f64, side: Side) -> Option<Vec<V3>> {
    let out = if side == Side::Front { V3::y() } else { -V3::y() };
    taut(mesh, median_point(mesh, waist, middle, side)?, landmarks::fork(mesh, crotch, middle)?, out)
}

/// Distance of the armscye outside the armpit, m. Nearer, its plane would cut the trunk.
const OUTSIDE: f64 = 0.006;

/// Armscye girth: tape through the shoulder point and just outside the armpit.
fn armscye(mesh: &TriMesh, marks: &Marks) -> Option<Vec<V3>> {
    let armpit = marks.armpit? + V3::new(2.0 * OUTSIDE, 0.0, 0.0);
    let up = V3::new(marks.shoulder.x - armpit.x, 0.0, marks.shoulder.z - armpit.z).try_normalize(1e-9)?;
    let middle = marks.shoulder.lerp(&armpit, 0.5);
    let plane = Plane { origin: middle, u: V3::y(), v: up };
    let outlines = section(mesh, &plane);
    let outline = outlines.iter().find(|outline| outline.contains(V2::zeros()))?;
    let mut ring: Vec<V3> = hull::convex_hull(&outline.points).into_iter().map(|p| plane.lift(p)).collect();
    ring.push(*ring.first()?);
    Some(ring)
}

/// Line from the hindmost to the foremost extent of a ring, through its centroid.
fn depth_of(ring: &[V3]) -> Vec<V3> {
    let centre = ring.iter().sum::<V3>() / ring.len() as f64;
    let ends = ring.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p.y), high.max(p.y)]);
    ends.map(|y| V3::new(centre.x, y, centre.z)).to_vec()
}

/// Line from the back neck point over side neck point and bust point, then straight down to the waist.
fn over_bust(mesh: &TriMesh, marks: &Marks) -> Option<Vec<V3>> {
    let (neck, [bust, _]) = (marks.side_neck?, marks.bust?);
    let waist = tape::trunk_outline(mesh, marks.waist, marks.middle)?;
    let foot = V3::new(bust.x, tape::edge(&waist, bust.x, 1.0)?, marks.waist);
    let base = neck - V3::new(marks.middle, (neck.y + marks.back_neck.y) / 2.0, neck.z);
    let parts = [
        taut(mesh, marks.back_neck, neck, base)?,
        taut(mesh, neck, bust, V3::y() + V3::z())?,
        taut(mesh, bust, foot, V3::y())?,
    ];
    Some(parts.concat())
}

/// Front (`side` 1) or back (-1) width: from armscye to armscye, half way between armpit and shoulder point.
fn width(mesh: &TriMesh, marks: &Marks, side: f64) -> Option<Vec<V3>> {
    let half = marks.shoulder.lerp(&marks.armpit?, 0.5) + V3::new(OUTSIDE, 0.0, 0.0);
    let outline = tape::trunk_outline(mesh, half.z, marks.middle)?;
    let end = |x: f64| tape::edge(&outline, x, side).map(|y| V3::new(x, y, half.z));
    taut(mesh, end(half.x)?, end(2.0 * marks.middle - half.x)?, V3::y() * side)
}

/// Estimates of the knee level as shares of stature and of crotch height, of which the mean is taken. Fitted to 200
/// model bodies, residual 30 mm, because the skin alone does not show the knee cap.
const KNEE: [f64; 2] = [0.299, 0.630];

pub(super) fn knee_level(marks: &Marks) -> f64 {
    marks.floor + (KNEE[0] * marks.stature + KNEE[1] * (marks.crotch - marks.floor)) / 2.0
}

/// Girth of the elbow, and greatest girth of the forearm.
pub(super) fn elbow_and_forearm(mesh: &TriMesh, arm: &Arm) -> [Option<f64>; 2] {
    /// Range between elbow (0) and wrist (1) in which the forearm is thickest. Judgement.
    const THICKEST: [f64; 2] = [0.08, 0.45];
    let girth = |share: f64| {
        let plane = arm.across(share);
        tape::girth_round(mesh, plane.origin, plane.normal())
    };
    let (elbow, wrist) = (arm.elbow(), arm.wrist());
    let along = steps(THICKEST[0], THICKEST[1], 12).filter_map(|part| girth(elbow + part * (wrist - elbow)));
    [girth(elbow), along.max_by(f64::total_cmp)]
}

#[cfg(test)]
#[path = "tailor_tests.rs"]
mod tests;
