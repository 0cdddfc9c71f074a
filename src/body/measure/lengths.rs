//! Lengths on the surface and girths of the limbs, named after ISO 8559-1. The tape is taut, so it spans hollows.

use super::arm::Arm;
use super::confidence::{self, Confidence};
use super::neck_base;
use super::sites::{self, Sites};
use super::slices::{Slices, steps};
use super::tailor::{self, Marks, Taken};
use super::tape;
use crate::repair::feet::Feet;
use crate::{BodyError, Dimension, Girths, Sex};
use geom::section::{Plane, section};
use geom::units::mm;
use geom::{TriMesh, V2, V3, hull};
use std::collections::BTreeSet;

/// Lengths of `body measure` besides [`Girths`]. `None` where the body does not show one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lengths {
    /// Height of the back neck point.
    pub cervicale_height_m: Option<f64>,
    /// From the back neck point down the centre back to the waist level.
    pub back_waist_length_m: Option<f64>,
    /// From the front neck point down the centre front to the waist level.
    pub front_waist_length_m: Option<f64>,
    /// From the waist level at the centre front through the crotch to the waist level at the centre back.
    pub total_crotch_length_m: Option<f64>,
    /// Height of the greatest girth of the right calf.
    pub calf_level_m: Option<f64>,
    /// Height of the middle of the right knee, estimated from stature and crotch.
    pub knee_level_m: Option<f64>,
    /// Girth of the straight right arm.
    pub elbow_girth_m: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    pub girths: Girths,
    pub lengths: Lengths,
    pub tailor: Vec<Taken>,
    pub confidence: Vec<Confidence>,
}

impl Measured {
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, Option<f64>)> {
        let lengths = &self.lengths;
        let lengths = [
            ("cervicale_height_mm", lengths.cervicale_height_m),
            ("back_waist_length_mm", lengths.back_waist_length_m),
            ("front_waist_length_mm", lengths.front_waist_length_m),
            ("total_crotch_length_mm", lengths.total_crotch_length_m),
            ("calf_level_mm", lengths.calf_level_m),
            ("knee_level_mm", lengths.knee_level_m),
            ("elbow_girth_mm", lengths.elbow_girth_m),
        ];
        let lengths = lengths.into_iter().map(|(key, length)| (key, length.map(mm)));
        let tailor = self.tailor.iter().map(|taken| (taken.key, taken.written));
        self.girths.entries().chain(lengths).chain(tailor)
    }

    fn keep_known(&mut self, feet: Feet) {
        self.girths.keep_known(feet);
        if !feet.right {
            self.lengths.calf_level_m = None;
            self.lengths.knee_level_m = None;
        }
        if !feet.stand() {
            self.lengths = Lengths { elbow_girth_m: self.lengths.elbow_girth_m, ..Lengths::default() };
            for taken in &mut self.tailor {
                (taken.written, taken.path) = (None, Vec::new());
            }
        }
        let known: BTreeSet<&str> = self.entries().filter_map(|(key, value)| value.map(|_| key)).collect();
        self.confidence.retain(|confidence| known.contains(confidence.key));
    }
}

impl serde::Serialize for Measured {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut document = serde_json::Map::new();
        document.extend(self.entries().map(|(key, value)| (key.to_owned(), value.into())));
        let entry = |known: &Confidence| {
            let unit = known.key.rsplit('_').next().unwrap_or_default();
            serde_json::json!({ format!("sd_{unit}"): known.sd, "reason": known.reason })
        };
        let confidence = self.confidence.iter().map(|known| (known.key.to_owned(), entry(known))).collect();
        document.insert("confidence".to_owned(), serde_json::Value::Object(confidence));
        document.serialize(serializer)
    }
}

/// Heights between which calf and ankle are sought, as shares of the height of the crotch. Judgement.
const CALF: [f64; 2] = [0.38, 0.60];
const ANKLE: [f64; 2] = [0.10, 0.30];

/// Measures the lengths of an upright body mesh in the world frame, and adds the girths of the limbs to `girths`.
pub fn lengths(mesh: &TriMesh, sex: Option<Sex>, girths: Girths) -> Result<Measured, BodyError> {
    let (sites, sex) = sites::find_sites(mesh, sex, Feet::BOTH)?;
    Ok(at_sites(mesh, &sites, sex, girths))
}

pub(crate) fn of_scan(mesh: &TriMesh, sex: Sex, feet: Feet, girths: Girths) -> Result<Measured, BodyError> {
    let (sites, sex) = sites::find_sites(mesh, Some(sex), feet)?;
    let mut measured = at_sites(mesh, &sites, sex, girths);
    measured.keep_known(feet);
    Ok(measured)
}

fn at_sites(mesh: &TriMesh, sites: &Sites, sex: Sex, mut girths: Girths) -> Measured {
    let median = median_section(mesh, sites);
    let front_neck = neck_base::front_neck(mesh, sites);
    let marks = Marks::of_mesh(mesh, sites, sex);
    let limbs = read_limbs(mesh, sites, &marks, &mut girths);
    let lengths = Lengths {
        cervicale_height_m: Some(sites.back_neck.z - sites.floor),
        back_waist_length_m: taut(&median, sites.back_neck, sites.waist, -1.0),
        front_waist_length_m: front_neck.and_then(|top| taut(&median, top, sites.waist, 1.0)),
        total_crotch_length_m: crotch_length(&median, sites.waist),
        calf_level_m: limbs.calf.map(|z| z - sites.floor),
        knee_level_m: Some(limbs.knee - sites.floor),
        elbow_girth_m: limbs.elbow_girth,
    };
    let confidence = confidence::uncertainties(mesh, sites, &marks);
    let tailor = tailor::take(mesh, &marks);
    Measured { girths, lengths, tailor, confidence }
}

pub(crate) fn add_limbs(mesh: &TriMesh, sites: &Sites, sex: Sex, girths: &mut Girths) {
    read_limbs(mesh, sites, &Marks::of_mesh(mesh, sites, sex), girths);
}

/// Levels of the limbs, and readings that are not girths, m.
struct Limbs {
    calf: Option<f64>,
    knee: f64,
    elbow_girth: Option<f64>,
}

fn read_limbs(mesh: &TriMesh, sites: &Sites, marks: &Marks, girths: &mut Girths) -> Limbs {
    let arm = marks.arm.as_ref();
    let leg = |range: [f64; 2]| leg_girths(mesh, sites, range);
    let calf = leg(CALF).into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let ankle = leg(ANKLE).into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let wrist = arm.and_then(|arm| {
        let plane = arm.across(arm.wrist());
        tape::girth_round(mesh, plane.origin, plane.normal())
    });
    girths.set(Dimension::CalfGirth, calf.map(|(_, girth)| girth));
    girths.set(Dimension::AnkleGirth, ankle.map(|(_, girth)| girth));
    girths.set(Dimension::WristGirth, wrist);
    let [elbow_girth, forearm] = arm.map_or([None; 2], |arm| tailor::elbow_and_forearm(mesh, arm));
    let knee = tailor::knee_level(marks);
    girths.set(Dimension::KneeGirth, tape::leg_girth(mesh, knee, sites.middle));
    girths.set(Dimension::ForearmGirth, forearm);
    girths.set(Dimension::ArmLength, arm.map(|arm| arm_length(arm, sites.shoulder[0])));
    Limbs { calf: calf.map(|(z, _)| z), knee, elbow_girth }
}

/// Points of the median section of the trunk: forward and up.
fn median_section(mesh: &TriMesh, sites: &Sites) -> Vec<V2> {
    let origin = V3::new(sites.middle, 0.0, 0.0);
    let outlines = section(mesh, &Plane { origin, u: V3::y(), v: V3::z() });
    let longest = outlines.into_iter().max_by(|a, b| tape::girth(a).total_cmp(&tape::girth(b)));
    longest.map_or_else(Vec::new, |outline| outline.points)
}

/// Length of the taut tape from a point of the median section down to a height, m, along the front (`side` 1) or back
/// (-1).
fn taut(median: &[V2], top: V3, bottom: f64, side: f64) -> Option<f64> {
    let ends = |z: f64| crossing(median, z, side).map(|y| V2::new(y, z));
    let (from, to) = (V2::new(top.y, top.z), ends(bottom)?);
    let chord = to - from;
    let outside = |p: &&V2| p.y < from.y && p.y > to.y && side * chord.perp(&(*p - from)) > 0.0;
    let mut points: Vec<V2> = median.iter().filter(outside).copied().collect();
    points.extend([from, to]);
    Some(hull::tape_girth(&points) - chord.norm())
}

/// Foremost (`side` 1) or hindmost (-1) point of the median section at a height.
fn crossing(median: &[V2], z: f64, side: f64) -> Option<f64> {
    let next = median.iter().cycle().skip(1);
    let crossings = median.iter().zip(next).filter(|(a, b)| (a.y > z) != (b.y > z));
    let places = crossings.map(|(a, b)| a.x + (b.x - a.x) * (z - a.y) / (b.y - a.y));
    places.max_by(|a, b| (side * a).total_cmp(&(side * b)))
}

/// Length of the taut tape round the lower end of the median section, from waist level to waist level, m.
fn crotch_length(median: &[V2], waist: f64) -> Option<f64> {
    let ends = [1.0, -1.0].map(|side| crossing(median, waist, side).map(|y| V2::new(y, waist)));
    let [Some(front), Some(back)] = ends else { return None };
    let mut points: Vec<V2> = median.iter().filter(|p| p.y < waist).copied().collect();
    points.extend([front, back]);
    Some(hull::tape_girth(&points) - (front - back).norm())
}

fn arm_length(arm: &Arm, shoulder: V3) -> f64 {
    let (elbow, wrist) = (arm.at(arm.elbow()).place, arm.at(arm.wrist_joint()).place);
    (elbow - shoulder).norm() + (wrist - elbow).norm()
}

/// Heights and girths of the right leg in a range of heights, as shares of the height of the crotch.
fn leg_girths(mesh: &TriMesh, sites: &Sites, range: [f64; 2]) -> Vec<(f64, f64)> {
    let inseam = sites.crotch - sites.floor;
    let [low, high] = range.map(|share| sites.floor + share * inseam);
    let leg = Slices::new(mesh, low, high);
    steps(low, high, 40).filter_map(|z| Some((z, tape::leg_girth(&leg, z, sites.middle)?))).collect()
}

#[cfg(test)]
#[path = "lengths_tests.rs"]
mod tests;
