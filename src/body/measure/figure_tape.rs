//! The tape for the traits of a figure: one length for each on any upright mesh.

use super::landmarks::{self, Side, median_point};
use super::neck_base;
use super::sites::Sites;
use super::tailor::{crotch_length, length_of, taut};
use super::tape;
use crate::people::figures::{ByTrait, TRAITS, Trait};
use crate::{Dimension, Girths, Sex};
use geom::section::Outline;
use geom::{TriMesh, V2, V3, hull};

/// Height of the blades, at which the back stands out most, as a share of stature: that of the armpit, the mean of men and
/// women [Gordon 2014].
pub(crate) const BLADES: f64 = 0.758;

/// Greatest distance from the median plane at which the trunk depth is read / stature: farther out are arms. Judgement.
const CENTRAL: f64 = 0.08;

/// Share of the half width at which front and back of a section meet the sides. Judgement.
const SIDE: f64 = 0.95;

/// Range of distances from the median plane / stature in which the ridge of any shoulder is straight. Judgement.
const RIDGE: [f64; 2] = [0.056, 0.085];

/// Distance from side neck point to shoulder point along x, as a share of stature: that of a mean body.
const SHOULDER: f64 = 0.076;

/// Shares of the way from the half width of the waist to that of the hip at which the flanks are compared.
const FLANK: [f64; 5] = [0.3, 0.4, 0.5, 0.6, 0.7];

/// Number of heights at which a flank is read, and least difference between the half widths of hip and waist, m, for a
/// flank that is told. Judgement.
const FLANK_STEPS: u32 = 40;
const LEAST_FLANK: f64 = 0.010;

/// Reads the length of every trait, m. `None` where the body does not show it.
pub(crate) fn read(mesh: &TriMesh, sites: &Sites, girths: &Girths, sex: Sex) -> ByTrait<Option<f64>> {
    let tape = Tape { mesh, sites, stature: sites.crown - sites.floor };
    let shoulders = tape.shoulders();
    let mut read = [None; TRAITS];
    for of in Trait::ALL {
        read[of as usize] = match of {
            Trait::Seat => tape.crotch_length(Side::Back),
            Trait::Abdomen => tape.crotch_length(Side::Front),
            Trait::SwayBack => tape.back_bend(),
            Trait::UpperBack => tape.upper_back(),
            Trait::Bust => (sex == Sex::Female).then(|| tape.front_arc()).flatten(),
            Trait::ShoulderSlope => shoulders.map(|[fall, _]| fall),
            Trait::ShoulderForward => shoulders.map(|[_, forward]| forward),
            Trait::UpperArm => girths.get(Dimension::UpperArmGirth),
            Trait::Thigh => girths.get(Dimension::ThighGirth),
            Trait::Rise => Some(sites.waist - sites.crotch),
            Trait::HighHip => tape.flanks(),
        };
    }
    read
}

struct Tape<'a> {
    mesh: &'a TriMesh,
    sites: &'a Sites,
    stature: f64,
}

impl Tape<'_> {
    fn crotch_length(&self, side: Side) -> Option<f64> {
        let heights = [self.sites.crotch, self.sites.waist];
        crotch_length(self.mesh, heights, self.sites.middle, side).map(|path| length_of(&path))
    }

    fn blades(&self) -> f64 {
        self.sites.floor + BLADES * self.stature
    }

    fn trunk(&self, z: f64) -> Option<Outline> {
        tape::trunk_outline(self.mesh, z, self.sites.middle)
    }

    /// Front and back of the trunk between the arms.
    fn depth(&self, z: f64) -> Option<[f64; 2]> {
        let near = |p: &&V2| (p.x - self.sites.middle).abs() < CENTRAL * self.stature;
        let outline = self.trunk(z)?;
        let ends = outline
            .points
            .iter()
            .filter(near)
            .fold([f64::NEG_INFINITY, f64::INFINITY], |[front, back], p| [front.max(p.y), back.min(p.y)]);
        ends.iter().all(|y| y.is_finite()).then_some(ends)
    }

    /// Length of the back beside that of the side between blades and hip: the bend of the line through the middles of
    /// the sections, times the distance from side to back at the waist.
    fn back_bend(&self) -> Option<f64> {
        let heights = [self.blades(), self.sites.waist, self.sites.hip];
        let [blades, waist, hip] = heights.map(|z| self.depth(z));
        let [blades, waist, hip] = [blades?, waist?, hip?];
        let middle = |[front, back]: [f64; 2]| (front + back) / 2.0;
        let lean = |other: [f64; 2], height: f64| (middle(waist) - middle(other)) / height;
        let bend = lean(blades, heights[0] - heights[1]) + lean(hip, heights[1] - heights[2]);
        Some(-bend * (waist[0] - waist[1]) / 2.0)
    }

    fn upper_back(&self) -> Option<f64> {
        let blades = median_point(self.mesh, self.blades(), self.sites.middle, Side::Back)?;
        taut(self.mesh, self.sites.back_neck, blades, -V3::y()).map(|path| length_of(&path))
    }

    /// Forward position of the middle of the neck, between front and back neck point.
    fn neck(&self) -> Option<f64> {
        Some((self.sites.back_neck.y + neck_base::front_neck(self.mesh, self.sites)?.y) / 2.0)
    }

    /// Half of the tape round the chest that lies in front of the sides, where the section is widest.
    fn front_arc(&self) -> Option<f64> {
        let chest = self.trunk(self.sites.chest)?;
        let (low, high) = chest.bounds();
        let middle = self.sites.middle;
        let [left, right] = [low, high].map(|end| middle + SIDE * (end.x - middle));
        let ends =
            [(left, 1.0), (left, -1.0), (right, 1.0), (right, -1.0)].map(|(x, side)| tape::edge(&chest, x, side));
        let ends: Vec<f64> = ends.into_iter().collect::<Option<_>>()?;
        let side = ends.iter().sum::<f64>() / ends.len() as f64;
        let ring = hull::convex_hull(&chest.points);
        let part = |(a, b): (&V2, &V2)| {
            let [near, far] = [a, b].map(|p| p.y - side);
            let share = if (near > 0.0) == (far > 0.0) {
                f64::from(u8::from(near > 0.0))
            } else {
                near.max(far) / (near - far).abs()
            };
            share * (b - a).norm()
        };
        Some(ring.iter().zip(ring.iter().cycle().skip(1)).map(part).sum::<f64>() / 2.0)
    }

    /// Fall of the ridge from side neck point to shoulder point, independent of where the ridge is thought to end, and
    /// distance of the shoulder point in front of the middle between front and back neck point. Means of both sides.
    fn shoulders(&self) -> Option<[f64; 2]> {
        let [right, left] = self.sites.shoulder;
        let middle = self.sites.middle;
        let mirrored = landmarks::mirrored(self.mesh, middle);
        let left = V3::new(2.0 * middle - left.x, left.y, left.z);
        let ceiling = self.sites.neck.height;
        let neck = self.neck()?;
        let read = |mesh: &TriMesh, shoulder: V3| {
            let top = |share: f64| landmarks::shoulder_top(mesh, middle + share * self.stature, ceiling);
            let fall = (top(RIDGE[0])?.z - top(RIDGE[1])?.z) / (RIDGE[1] - RIDGE[0]) * SHOULDER;
            Some([fall, shoulder.y - neck])
        };
        let (right, left) = (read(self.mesh, right)?, read(&mirrored, left)?);
        Some([0, 1].map(|i| (right[i] + left[i]) / 2.0))
    }

    /// Height by which the right flank lies above the left one.
    fn flanks(&self) -> Option<f64> {
        let (waist, hip) = (self.sites.waist, self.sites.hip);
        let heights: Vec<f64> = super::slices::steps(waist, hip, FLANK_STEPS).collect();
        let outlines: Vec<Outline> = heights.iter().map(|z| self.trunk(*z)).collect::<Option<_>>()?;
        let flank = |side: usize| {
            let width = |outline: &Outline| {
                let (low, high) = outline.bounds();
                if side == 0 { high.x - self.sites.middle } else { self.sites.middle - low.x }
            };
            let widths: Vec<f64> = outlines.iter().map(width).collect();
            let (least, most) = (widths[0], widths[widths.len() - 1]);
            let reached = |share: &f64| {
                let asked = least + share * (most - least);
                let next = (1..widths.len()).find(|&i| widths[i] >= asked)?;
                let part = (asked - widths[next - 1]) / (widths[next] - widths[next - 1]);
                Some(heights[next - 1] + part * (heights[next] - heights[next - 1]))
            };
            let found: Vec<f64> = FLANK.iter().map(reached).collect::<Option<_>>()?;
            (most - least > LEAST_FLANK).then(|| found.iter().sum::<f64>() / found.len() as f64)
        };
        Some(flank(0)? - flank(1)?)
    }
}
