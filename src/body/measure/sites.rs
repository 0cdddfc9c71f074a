//! Measurement of an upright body mesh: finds the levels on the mesh, and lays the tape there.

use super::AxisPoint;
use super::landmarks::crotch;
use super::shoulder::Frame;
use super::slices::{Sliced, Slices, steps};
use super::tape::{self, Neck};
use crate::repair::feet::Feet;
use crate::{BodyError, Dimension, Girths, Levels, Sex};
use geom::section::{Plane, section};
use geom::{TriMesh, V2, V3};

/// Levels and points of a mesh at which the tape is laid, m.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sites {
    /// Heights of floor and crown. Without feet, the height of the floor is an estimate from the trunk.
    pub floor: f64,
    pub crown: f64,
    /// Position of the median plane, along x.
    pub middle: f64,
    pub crotch: f64,
    pub hip: f64,
    pub waist: f64,
    pub underbust: f64,
    pub chest: f64,
    pub neck: Neck,
    /// Points, right and left.
    pub shoulder: [V3; 2],
    pub back_neck: V3,
    /// Standard deviations as in `Upper`, m.
    pub upper_sd: [f64; 2],
    /// Middle of the right upper arm. `None` if the arm is not apart from the trunk.
    pub upper_arm: Option<AxisPoint>,
}

impl Sites {
    pub fn levels(&self) -> Levels {
        Levels {
            chest_m: self.chest,
            underbust_m: self.underbust,
            waist_m: self.waist,
            hip_m: self.hip,
            crotch_m: self.crotch,
            neck_m: self.neck.height,
        }
    }
}

/// Height of the ISO 8559-1 waist / stature, men and women [Gordon 2014]. The skin has no mark of it.
const ISO_WAIST: [f64; 2] = [0.6212, 0.6299];

/// Measures an upright closed (or nearly closed) body mesh in the world frame. The sex decides the height of the waist.
/// `None` estimates the sex from neck, hip and waist girth.
pub fn measure(mesh: &TriMesh, sex: Option<Sex>) -> Result<Girths, BodyError> {
    let (sites, _) = find_sites(mesh, sex, Feet::BOTH)?;
    girths_at(mesh, &sites)
}

pub(crate) fn girths_at(mesh: &TriMesh, sites: &Sites) -> Result<Girths, BodyError> {
    let trunk = |part, z| tape::trunk_girth(mesh, z, sites.middle).ok_or_else(|| missing(part, z));
    let thigh_level = sites.crotch - THIGH_BELOW_CROTCH;
    let thighs = tape::right_limbs(mesh, thigh_level, sites.middle);
    let thigh = thighs
        .iter()
        .min_by(|a, b| a.bounds().0.x.total_cmp(&b.bounds().0.x))
        .ok_or_else(|| missing("thigh", thigh_level))?;
    let [right, left] = sites.shoulder;
    let across_shoulder =
        tape::tape_over(mesh, right, sites.back_neck, left).ok_or_else(|| missing("shoulder", right.z))?;
    let upper_arm = sites.upper_arm.and_then(|arm| Some((tape::girth_round(mesh, arm.place, arm.along)?, arm.place.z)));
    let mut girths = Girths::of(mesh.volume());
    let mut note = |dimension, value: Option<f64>, z: Option<f64>| {
        girths.set(dimension, value);
        girths.set_level(dimension, z.map(|z| z - sites.floor));
    };
    note(Dimension::Stature, Some(sites.crown - sites.floor), None);
    note(Dimension::NeckGirth, Some(sites.neck.girth), Some(sites.neck.height));
    note(Dimension::ChestGirth, Some(trunk("chest", sites.chest)?), Some(sites.chest));
    note(Dimension::UnderbustGirth, Some(trunk("underbust", sites.underbust)?), Some(sites.underbust));
    note(Dimension::WaistGirth, Some(trunk("waist", sites.waist)?), Some(sites.waist));
    note(Dimension::HipGirth, Some(trunk("hip", sites.hip)?), Some(sites.hip));
    note(Dimension::ThighGirth, Some(tape::girth(thigh)), Some(thigh_level));
    note(Dimension::UpperArmGirth, upper_arm.map(|(girth, _)| girth), upper_arm.map(|(_, z)| z));
    note(Dimension::AcrossShoulder, Some(across_shoulder), Some((right.z + left.z) / 2.0));
    note(Dimension::Inseam, Some(sites.crotch - sites.floor), Some(sites.crotch));
    Ok(girths)
}

/// Distance below the crotch at which the thigh girth is read, m: part of its definition here.
const THIGH_BELOW_CROTCH: f64 = 0.02;

fn missing(part: &'static str, z: f64) -> BodyError {
    BodyError::MissingPart { part, height_m: z }
}

/// Mean height of the crotch / stature, of the model bodies of [`crate::shape::atlas`].
const USUAL_CROTCH: f64 = 0.481;

/// Least height of the crotch of a body without feet, as a share of its height: legs that end about at the knee.
const LEAST_CROTCH: f64 = 0.25;

/// Estimate of the height of the floor of an upright body without feet, by crotch and crown. `None` without a crotch.
pub(crate) fn usual_floor(mesh: &TriMesh, [low, high]: [V3; 2]) -> Option<f64> {
    let height = high.z - low.z;
    let middle = trunk_middle(mesh, low.z, height).x;
    let crotch = crotch(mesh, low.z + LEAST_CROTCH * height, low.z + 0.56 * height, middle)?;
    Some(high.z - (high.z - crotch) / (1.0 - USUAL_CROTCH))
}

/// Estimates the sex if it is not given.
pub(crate) fn find_sites(mesh: &TriMesh, sex: Option<Sex>, feet: Feet) -> Result<(Sites, Sex), BodyError> {
    let (mut low, high) = mesh.bounds().ok_or_else(|| missing("body", 0.0))?;
    if !feet.stand() {
        low.z = usual_floor(mesh, [low, high]).ok_or_else(|| missing("crotch", 0.4 * high.z))?;
    }
    let stature = high.z - low.z;
    let middle = trunk_middle(mesh, low.z, stature).x;
    let height_at = |share: f64| low.z + share * stature;
    let crotch =
        crotch(mesh, height_at(0.38), height_at(0.56), middle).ok_or_else(|| missing("crotch", height_at(0.47)))?;
    let hip = hip_level(mesh, crotch, stature, middle).ok_or_else(|| missing("hip", height_at(0.52)))?;
    let chest = chest_level(mesh, low.z, stature, crotch, middle).ok_or_else(|| missing("chest", height_at(0.73)))?;
    let underbust = underbust_level(mesh, chest, stature, middle);
    let upper = tape::above(mesh, height_at(0.7));
    let neck =
        tape::neck(&upper, height_at(0.83), height_at(0.90), middle).ok_or_else(|| missing("neck", height_at(0.87)))?;
    let hip_girth = tape::trunk_girth(mesh, hip, middle).ok_or_else(|| missing("hip", hip))?;
    let about_waist = height_at((ISO_WAIST[0] + ISO_WAIST[1]) / 2.0);
    let waist_girth = tape::trunk_girth(mesh, about_waist, middle).ok_or_else(|| missing("waist", about_waist))?;
    let sex = sex.unwrap_or_else(|| likely_sex([neck.girth, hip_girth, waist_girth].map(|girth| girth / stature)));
    let waist = height_at(ISO_WAIST[usize::from(sex == Sex::Female)]);
    let frame = Frame { upper: &upper, mesh, floor: low.z, stature, middle, waist, neck: &neck, sex };
    let found = frame.find().ok_or_else(|| missing("shoulder", height_at(0.82)))?;
    let upper_arm = upper_arm(mesh, found.shoulder[0], low.z, stature, middle);
    let sites = Sites {
        floor: low.z,
        crown: high.z,
        middle,
        crotch,
        hip,
        waist,
        underbust,
        chest,
        neck,
        shoulder: found.shoulder,
        back_neck: found.back_neck,
        upper_sd: found.sd,
        upper_arm,
    };
    Ok((sites, sex))
}

/// Middle of the trunk of an upright body with arms in any pose: in the median plane, half way from front to back.
pub(crate) fn trunk_middle(mesh: &TriMesh, floor: f64, stature: f64) -> V2 {
    let middle = |share: f64| {
        let outlines = section(mesh, &Plane::horizontal(floor + share * stature));
        let trunk = outlines.iter().max_by(|a, b| tape::girth(a).total_cmp(&tape::girth(b)))?;
        let (low, high) = trunk.bounds();
        Some((low + high) / 2.0)
    };
    let middles: Vec<V2> = [0.54, 0.57, 0.60, 0.63, 0.66].into_iter().filter_map(middle).collect();
    let median = |axis: usize| {
        let mut values: Vec<f64> = middles.iter().map(|middle| middle[axis]).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(0.0)
    };
    V2::new(median(0), median(1))
}

/// Linear discriminant by neck, hip and waist girth / stature for the 6,068 people of the ANSUR II survey [Gordon
/// 2014], of whom it classifies 97 % correctly. That is optimistic, because their waists at the navel were converted
/// into ISO waists by a mean factor for each sex. Only the height of the waist depends on the sex.
fn likely_sex([neck, hip, waist]: [f64; 3]) -> Sex {
    if 127.941 * hip - 256.512 * neck - 40.561 * waist > 1.005 { Sex::Female } else { Sex::Male }
}

/// Level of the greatest protrusion of the buttocks (ISO 8559-1).
pub(crate) fn hip_level(mesh: &TriMesh, crotch: f64, stature: f64, middle: f64) -> Option<f64> {
    let heights = steps(crotch + 0.01 * stature, crotch + 0.10 * stature, 96);
    let mesh = &Slices::new(mesh, crotch, crotch + 0.11 * stature);
    let back = |z: f64| Some((z, -tape::depth_range(&tape::trunk_outline(mesh, z, middle)?).1));
    summit(&heights.filter_map(back).collect::<Vec<_>>())
}

/// Mean height of the summit of a profile, weighted by the value above its foot. The summit is all values below the
/// greatest by less than twice the roughness, which is due to facets and noise. On a flat summit, the position of the
/// greatest value alone would be arbitrary. `None` without values.
fn summit(profile: &[(f64, f64)]) -> Option<f64> {
    let level = levelled(profile.to_vec(), 2);
    let greatest = level.iter().map(|(_, value)| *value).max_by(f64::total_cmp)?;
    let uneven = profile.iter().zip(&level).map(|(raw, level)| (raw.1 - level.1).powi(2)).sum::<f64>();
    let depth = (2.0 * (uneven / profile.len() as f64).sqrt()).max(LEAST_SUMMIT);
    let above = |(_, value): &(f64, f64)| (value - greatest + depth).max(0.0);
    let (weight, moment) =
        level.iter().fold((0.0, 0.0), |(w, m), point| (w + above(point), m + above(point) * point.0));
    Some(moment / weight)
}

/// Least depth of a summit, m, for rounding.
const LEAST_SUMMIT: f64 = 1e-6;

/// Moving average over `reach` neighbours on either side, without which scan noise would decide on a flat profile.
fn levelled(profile: Vec<(f64, f64)>, reach: usize) -> Vec<(f64, f64)> {
    let mean = |i: usize| {
        let reach = reach.min(i).min(profile.len() - 1 - i);
        let around = &profile[i - reach..=i + reach];
        around.iter().map(|(_, value)| value).sum::<f64>() / around.len() as f64
    };
    (0..profile.len()).map(|i| (profile[i].0, mean(i))).collect()
}

/// Height of the nipples / stature: intercept, and slope with crotch height / stature. Least squares for the 160 model
/// bodies (CC0-1.0) of [`crate::shape::atlas`], residual 8 mm.
const NIPPLES: [f64; 2] = [0.5123, 0.4651];

/// Heights between which the most prominent level of the chest is sought, as shares of stature. Judgement.
pub(crate) const CHEST: [f64; 2] = [0.70, 0.752];

/// Expected height of the nipples above the floor, m, by proportion alone.
pub(crate) fn usual_chest(stature: f64, crotch: f64) -> f64 {
    NIPPLES[0] * stature + NIPPLES[1] * crotch
}

/// Level of the nipples, of which a scan keeps no mark: mean of two estimates with similar errors. One is the height at
/// which the front stands out most from the chord between ribs and collar bones, which a breast or a muscle shifts, the
/// other follows from proportions. At most the highest level at which the arms are apart from the trunk.
pub(crate) fn chest_level(mesh: &TriMesh, floor: f64, stature: f64, crotch: f64, middle: f64) -> Option<f64> {
    let (low, high) = (floor + 0.66 * stature, floor + 0.80 * stature);
    let trunk = Slices::new(mesh, low, high);
    // Front of the trunk, and true if an arm is apart from it.
    let section = |z: f64| {
        let outlines = trunk.slice(z);
        let apart = outlines.iter().any(|outline| tape::is_right_limb(outline, middle));
        Some((tape::depth_range(&tape::trunk_among(outlines, middle)?).0, apart))
    };
    let ((y_low, has_arms), (y_high, _)) = (section(low)?, section(high)?);
    let standing_out = |z: f64| {
        let chord = y_low + (y_high - y_low) * (z - low) / (high - low);
        section(z).filter(|(_, apart)| *apart || !has_arms).map(|(front, _)| (z, front - chord))
    };
    let heights = steps(floor + CHEST[0] * stature, floor + CHEST[1] * stature, 40);
    let profile: Vec<(f64, f64)> = heights.filter_map(standing_out).collect();
    let (highest, _) = *profile.last()?;
    let (foremost, _) = levelled(profile, 4).into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let level = (foremost + floor + usual_chest(stature, crotch - floor)) / 2.0;
    Some(level.min(highest))
}

/// Under-bust level: below the chest, where the girth stops falling.
pub(crate) fn underbust_level(mesh: &TriMesh, chest: f64, stature: f64, middle: f64) -> f64 {
    let trunk = Slices::new(mesh, chest - 0.075 * stature, chest);
    let girth = |z: f64| tape::trunk_girth(&trunk, z, middle);
    let falling: Vec<(f64, f64)> =
        steps(chest, chest - 0.075 * stature, 30).map_while(|z| girth(z).map(|girth| (z, girth))).collect();
    let falling = levelled(falling, 2);
    let falls: Vec<f64> = falling.windows(2).map(|pair| pair[0].1 - pair[1].1).collect();
    let steepest = falls.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let Some((at, &most)) = steepest else { return chest - 0.05 * stature };
    // The fall ends where it is less than half as steep as at its steepest.
    let stop = (at..falls.len()).find(|&i| falls[i] < 0.5 * most).unwrap_or(falls.len());
    falling[stop].0
}

/// Middle of the right upper arm and direction of the hanging arm. `None` if it is not apart from the trunk.
fn upper_arm(mesh: &TriMesh, shoulder: V3, floor: f64, stature: f64, middle: f64) -> Option<AxisPoint> {
    let centre = |share: f64| {
        let z = floor + share * stature;
        let limbs = tape::right_limbs(mesh, z, middle + 0.08 * stature);
        let arm = limbs.iter().max_by(|a, b| a.bounds().1.x.total_cmp(&b.bounds().1.x))?;
        let (low, high) = arm.bounds();
        Some(V3::new((low.x + high.x) / 2.0, (low.y + high.y) / 2.0, z))
    };
    let (high, low) = (centre(0.715)?, centre(0.68)?);
    let along = (low - high).normalize();
    let joint = shoulder.z - 0.03 * stature;
    let root = high + along * ((joint - high.z) / along.z);
    Some(AxisPoint { place: root + along * 0.088 * stature, along })
}

#[cfg(test)]
#[path = "sites_tests.rs"]
mod tests;
