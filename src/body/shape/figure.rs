//! The figure: sections of trunk, neck and head, arms and legs by the dimensions of a person.
//!
//! The mean sections are those of [`super::atlas`]. The numbers inside the functions are judgement: no source of them
//! is recorded.

use super::atlas::Atlas;
use super::interpolate::Monotone;
use super::loft::{Part, Shape, Station};
use crate::people::dimension::{COUNT, Dimension};
use crate::people::figures::{ByTrait, TRAITS, Trait};
use crate::people::profile::Profile;
use geom::{V2, V3, smooth_step};

/// Slope of the shoulder line, radians. Judgement.
const SHOULDER_SLOPE: f64 = 20.0 * std::f64::consts::PI / 180.0;

pub(super) const ELLIPSE: Shape = [0.0; 9];

pub(crate) type Factors = [f64; COUNT];

/// Person of a profile, laid out in space. Lengths in metres.
#[derive(Clone, Debug)]
pub(crate) struct Figure<'a> {
    pub profile: &'a Profile,
    pub atlas: &'static Atlas,
    /// Factors by [`Dimension`], adjusted until the tape reads the requested dimensions on the skin.
    pub factors: Factors,
    /// Strength of the bends of skin and moves of shoulder from the standard body, m. 0 for the standard body.
    pub doses: ByTrait<f64>,
}

impl<'a> Figure<'a> {
    pub fn new(profile: &'a Profile) -> Self {
        Self { profile, atlas: Atlas::of(profile.sex), factors: [1.0; COUNT], doses: [0.0; TRAITS] }
    }

    /// Dimension times its factor.
    pub fn size(&self, dimension: Dimension) -> f64 {
        self.profile.at(dimension) * self.factors[dimension as usize]
    }

    /// Multiplies the factor of a dimension, by 0.85 to 1.18 at a time.
    pub fn adjust(&mut self, dimension: Dimension, factor: f64) {
        self.factors[dimension as usize] *= factor.clamp(0.85, 1.18);
    }

    /// Half of the distance between the shoulder points.
    pub fn shoulder_x(&self) -> f64 {
        self.size(Dimension::AcrossShoulder) / self.atlas.tape_over_biacromial / 2.0
    }

    pub fn crotch(&self) -> f64 {
        self.size(Dimension::Inseam)
    }

    /// Height of the hip, m: above the crotch by the mean share of stature.
    pub fn hip(&self) -> f64 {
        self.crotch() + (self.atlas.hip - self.atlas.crotch) * self.stature()
    }

    /// Height of the section that the under-bust girth adjusts, m.
    pub fn underbust(&self) -> f64 {
        self.trunk_heights()[6]
    }

    pub fn knee_and_calf(&self) -> [f64; 2] {
        [self.atlas.knee, self.atlas.calf].map(|share| share / self.atlas.crotch * self.crotch())
    }

    /// Least and greatest corner of a box round the figure, m, with room for the fit.
    pub fn extent(&self) -> (V3, V3) {
        let h = self.stature();
        let room = 0.03 * h;
        let [_, _, tip] = self.arm_lengths();
        let hand = self.shoulder_joint() + self.arm_axes()[2] * tip;
        let trunk = self.trunk_sections();
        let front =
            trunk.iter().map(|s| s.centre.y + 1.1 * s.half_depth).fold(self.size(Dimension::FootLength), f64::max);
        let back = trunk.iter().map(|s| s.centre.y - 1.1 * s.half_depth).fold(-0.1 * h, f64::min);
        (V3::new(-hand.x - room, back - room, -0.4 * room), V3::new(hand.x + room, front + room, h + 0.4 * room))
    }

    /// All parts of the right half: trunk with head, arm, thumb, leg, foot.
    pub fn parts(&self) -> [Part; 5] {
        let trunk = self.trunk_sections();
        let leg = self.leg_sections(&trunk);
        let upright = [V3::x(), V3::y(), V3::z()];
        let foot = self.foot(leg[0].centre.x);
        let mut core = self.perineum(&trunk);
        core.extend(&trunk);
        core.extend(self.shoulder_sections(&trunk[8]));
        core.extend(self.head_sections());
        let root = Some([trunk[1].at, trunk[0].at]);
        let standing = |stations, root| Part { origin: V3::zeros(), axes: upright, stations, root };
        [standing(core, None), self.arm(), self.thumb(), standing(leg, root), foot]
    }

    pub fn back_neck_height(&self) -> f64 {
        self.atlas.cervicale * self.stature()
    }

    pub fn front_neck_height(&self) -> f64 {
        self.atlas.suprasternale * self.stature()
    }

    /// Height at which the shoulder line meets the neck, m.
    pub fn side_neck_height(&self) -> f64 {
        let (_, z_neck) = self.shoulder_line();
        z_neck
    }

    pub fn shoulder_height(&self) -> f64 {
        self.atlas.shoulder * self.stature() - self.doses[Trait::ShoulderSlope as usize]
    }

    /// Inner end of the shoulder line: distance from the median plane, and height.
    pub(super) fn shoulder_line(&self) -> (f64, f64) {
        let h = self.stature();
        let x_neck = self.atlas.neck_half_width * h * self.neck_factor() * 1.10;
        let z_shoulder = self.atlas.shoulder * h;
        let ceiling = (1.0 - self.atlas.head_height) * h - 0.018 * h;
        (x_neck, (z_shoulder + (self.shoulder_x() - x_neck) * SHOULDER_SLOPE.tan()).min(ceiling))
    }

    pub fn stature(&self) -> f64 {
        self.profile.at(Dimension::Stature)
    }

    fn trunk_heights(&self) -> [f64; 9] {
        let h = self.stature();
        let (crotch, hip) = (self.crotch(), self.hip());
        let [waist, chest, axilla] = [self.atlas.waist, self.atlas.chest, self.atlas.axilla].map(|share| share * h);
        let between = |a: f64, b: f64, share: f64| a + (b - a) * share;
        [
            between(crotch, hip, 0.5),
            hip,
            between(hip, waist, 1.0 / 3.0),
            between(hip, waist, 2.0 / 3.0),
            waist,
            between(waist, chest, 1.0 / 3.0),
            between(waist, chest, 2.0 / 3.0),
            chest,
            axilla,
        ]
    }

    /// Hip, waist and chest have the requested girths. Between hip and waist and above the chest, girths depart from
    /// linear interpolation by the factor of the mean body. Between waist and chest they lie at the same share of the
    /// difference as in the mean body, so that the ribs of a body without a waist do not draw in below the chest.
    pub fn trunk_sections(&self) -> Vec<Station> {
        let heights = self.trunk_heights();
        let mean = |i: usize| self.atlas.trunk[i].girth;
        let [hip, waist, chest] =
            [Dimension::HipGirth, Dimension::WaistGirth, Dimension::ChestGirth].map(|girth| self.size(girth));
        let course = |at: f64, hip: f64, waist: f64| {
            waist + (hip - waist) * ((heights[4] - at) / (heights[4] - heights[1])).clamp(0.0, 1.0)
        };
        let girth = |i: usize| match i {
            0..=4 => course(heights[i], hip, waist) * mean(i) / course(heights[i], mean(1), mean(4)),
            5..=6 => waist + (chest - waist) * (mean(i) - mean(4)) / (mean(7) - mean(4)),
            _ => chest * mean(i) / mean(7),
        };
        (0..9).map(|i| self.trunk_section(i, heights[i], girth(i) * self.underbust_share(i))).collect()
    }

    /// Factor of the sections between waist and chest that gives the under-bust girth.
    fn underbust_share(&self, i: usize) -> f64 {
        let factor = self.factors[Dimension::UnderbustGirth as usize];
        match i {
            5 => 1.0 + (factor - 1.0) * 0.6,
            6 => factor,
            _ => 1.0,
        }
    }

    fn trunk_section(&self, i: usize, at: f64, girth: f64) -> Station {
        let level = &self.atlas.trunk[i];
        let excess = (girth / self.stature() - level.girth).clamp(-0.12, 0.25);
        let depth_over_width = level.depth_over_width[0] + level.depth_over_width[1] * excess;
        let forward = (level.centre[0] + level.centre[1] * excess) * self.stature();
        let raw = Station {
            at,
            centre: V2::new(0.0, forward),
            half_width: 1.0,
            half_depth: depth_over_width,
            shape: level.shape,
        };
        raw.with_girth(girth)
    }

    fn perineum(&self, trunk: &[Station]) -> Vec<Station> {
        let at = self.crotch() + 0.010;
        let lowest = &trunk[0];
        let end = Station {
            at,
            centre: lowest.centre,
            half_width: 0.45 * lowest.half_width,
            half_depth: 0.5 * lowest.half_depth,
            shape: ELLIPSE,
        };
        vec![end]
    }

    /// Sections from the armpit along the shoulder line up to the neck.
    fn shoulder_sections(&self, axilla: &Station) -> Vec<Station> {
        let h = self.stature();
        let outline = self.neck_outline();
        let neck = self.neck_factor();
        let x_shoulder = self.shoulder_x();
        let z_shoulder = self.shoulder_height();
        let (x_neck, z_neck) = self.shoulder_line();
        let rise = z_neck - z_shoulder;
        let on_line = |share: f64| (z_shoulder + rise * share, x_shoulder + (x_neck - x_shoulder) * share);
        let widths = [
            (axilla.at + 0.3 * (z_shoulder - axilla.at), axilla.half_width + 0.12 * (x_shoulder - axilla.half_width)),
            (axilla.at + 0.62 * (z_shoulder - axilla.at), axilla.half_width + 0.55 * (x_shoulder - axilla.half_width)),
            (z_shoulder - 0.009 * h, x_shoulder * 0.985),
            (z_shoulder + rise * 0.03, x_shoulder * 0.92),
            on_line(0.33),
            on_line(0.66),
            on_line(0.9),
            (z_neck + 0.004 * h, x_neck * 0.97),
            ((1.0 - self.atlas.head_height) * h - 0.008 * h, self.atlas.neck_half_width * h * neck),
        ];
        let section = |(at, half_width): (f64, f64)| {
            let [front, back] = outline.clone().map(|curve| curve.at(at / h) * h);
            let fullness = 1.0 - smooth_step((at - axilla.at) / (z_shoulder - axilla.at));
            let (front, back) = self.grown(axilla, at, front, back, neck);
            Station {
                at,
                centre: V2::new(0.0, (front + back) / 2.0),
                half_width,
                half_depth: (front - back) / 2.0,
                shape: axilla.shape.map(|c| c * fullness),
            }
        };
        widths.into_iter().map(section).collect()
    }

    /// Front and back of a section, displaced with the chest girth near the armpit and with the neck girth above.
    fn grown(&self, axilla: &Station, at: f64, front: f64, back: f64, neck: f64) -> (f64, f64) {
        let h = self.stature();
        let outline = self.neck_outline();
        let [mean_front, mean_back] = outline.map(|curve| curve.at(self.atlas.axilla) * h);
        let upness = ((at / h - self.atlas.axilla) / (0.855 - self.atlas.axilla)).clamp(0.0, 1.0);
        // Zero slope at the armpit leaves no ledge.
        let by_chest = (1.0 - upness) * (1.0 - upness) * (1.0 + upness);
        let centre = (front + back) / 2.0;
        let by_neck = 1.0 + (neck - 1.0) * upness * upness;
        let widen = |y: f64, mean: f64, actual: f64| centre + (y - centre) * by_neck + (actual - mean) * by_chest;
        (
            widen(front, mean_front, axilla.centre.y + axilla.half_depth),
            widen(back, mean_back, axilla.centre.y - axilla.half_depth),
        )
    }

    /// Front and back outline in the median plane, divided by stature.
    fn neck_outline(&self) -> [Monotone; 2] {
        let rows = &self.atlas.neck_outline;
        let heights: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        [1, 2].map(|side| Monotone::new(&heights, &rows.iter().map(|row| row[side]).collect::<Vec<_>>()))
    }

    fn neck_factor(&self) -> f64 {
        self.size(Dimension::NeckGirth) / (self.atlas.neck_girth * self.stature())
    }

    fn head_sections(&self) -> Vec<Station> {
        let h = self.stature();
        let head = self.atlas.head_height * h;
        let chin = h - head;
        let section = |row: &[f64; 4]| {
            let [up, half_width, front, back] = *row;
            // The jaw narrows towards the chin, and the brow is broad: harmonics of the mean heads, halved above the
            // jaw.
            let jaw = (1.0 - up / 0.35).max(0.0);
            let shape = [
                -0.01 - 0.05 * jaw,
                -0.02 - 0.10 * jaw,
                0.015 + 0.04 * jaw,
                0.015 + 0.07 * jaw,
                -0.012,
                0.0,
                0.0,
                0.0,
                0.0,
            ];
            // A thick neck widens the jaw.
            let size = head * (1.0 + (self.neck_factor().max(0.95) - 1.0) * (1.0 - up / 0.4).max(0.0));
            Station {
                at: chin + up * head,
                centre: V2::new(0.0, (front + back) / 2.0 * head),
                half_width: half_width * size,
                half_depth: (front - back) / 2.0 * size,
                shape,
            }
        };
        let mut sections: Vec<Station> = self.atlas.head.iter().map(section).collect();
        let top = sections[sections.len() - 1];
        // The crown is the top of an ellipsoid whose section `top` lies at 0.9 of the height of the head.
        let rest = h - top.at;
        for share in [0.3_f64, 0.55, 0.75, 0.88, 0.96, 1.0] {
            let factor = (1.0 - share).sqrt().max(0.02);
            sections.push(Station {
                at: top.at + rest * share,
                half_width: top.half_width * factor,
                half_depth: top.half_depth * factor,
                ..top
            });
        }
        sections
    }
}
