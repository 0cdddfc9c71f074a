//! The figure: from dimensions to the sections of trunk, neck and head, arms and legs.

use super::anthropometry::Profile;
use super::atlas::Atlas;
use super::field::Parts;
use super::interpolate::Monotone;
use super::loft::{Loft, Shape, Station, dome};
use crate::geom::{V2, V3};

/// Angle of the arms from the vertical, radians.
pub(super) const ARM_ANGLE: f64 = 38.0 * std::f64::consts::PI / 180.0;

/// Slope of the shoulder line, radians.
const SHOULDER_SLOPE: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// Spacing of the tables of the lofts, metres.
const TABLE_STEP: f64 = 0.003;

/// A section that is an ellipse.
const ELLIPSE: Shape = [0.0; 9];

/// Girths and lengths that the fit adjusts until the skin measures as asked, metres.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Targets {
    pub neck: f64,
    pub chest: f64,
    pub waist: f64,
    pub hip: f64,
    /// Half of the distance of the shoulder points.
    pub shoulder_x: f64,
}

/// A profile laid out in space.
#[derive(Clone, Debug)]
pub(super) struct Figure<'a> {
    pub profile: &'a Profile,
    pub atlas: &'static Atlas,
    pub targets: Targets,
}

impl<'a> Figure<'a> {
    /// The figure before any fitting.
    pub fn new(profile: &'a Profile) -> Self {
        let targets = Targets {
            neck: profile.neck,
            chest: profile.chest,
            waist: profile.waist,
            hip: profile.hip,
            shoulder_x: profile.biacromial / 2.0,
        };
        Self { profile, atlas: Atlas::of(profile.sex), targets }
    }

    /// The lofts of all parts.
    pub fn parts(&self) -> Parts {
        let trunk = self.trunk_sections();
        let leg = self.leg_sections(&trunk);
        let upright = [V3::x(), V3::y(), V3::z()];
        let mut core = self.perineum(&trunk);
        core.extend(&trunk);
        core.extend(self.shoulder_sections(&trunk[8]));
        core.extend(self.head_sections());
        Parts {
            trunk: Loft::new(V3::zeros(), upright, &core, TABLE_STEP),
            arm: self.arm(),
            thumb: self.thumb(),
            hand_start: self.hand_start(),
            leg: Loft::new(V3::zeros(), upright, &leg, TABLE_STEP),
            foot: self.foot(leg[0].centre.x),
        }
    }

    /// Height of the back neck point, metres.
    pub fn back_neck_height(&self) -> f64 {
        self.atlas.cervicale * self.stature()
    }

    /// Height of the front neck point, metres.
    pub fn front_neck_height(&self) -> f64 {
        self.atlas.suprasternale * self.stature()
    }

    /// Height at which the shoulder line meets the neck, metres.
    pub fn side_neck_height(&self) -> f64 {
        let (_, z_neck) = self.shoulder_line();
        z_neck
    }

    /// Inner end of the shoulder line: distance from the median plane, and height.
    fn shoulder_line(&self) -> (f64, f64) {
        let h = self.stature();
        let x_neck = self.atlas.neck_half_width * h * self.neck_factor() * 1.10;
        let z_shoulder = self.atlas.shoulder * h;
        let ceiling = (1.0 - self.atlas.head_height) * h - 0.018 * h;
        (x_neck, (z_shoulder + (self.targets.shoulder_x - x_neck) * SHOULDER_SLOPE.tan()).min(ceiling))
    }

    fn stature(&self) -> f64 {
        self.profile.stature
    }

    /// Heights of the nine trunk sections, metres.
    fn trunk_heights(&self) -> [f64; 9] {
        let Atlas { crotch, hip, waist, chest, axilla, .. } = *self.atlas;
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
        .map(|share| share * self.stature())
    }

    /// Sections of the trunk at their girths: the asked ones at hip, waist and chest, between them the mean body's
    /// departure from a straight course.
    fn trunk_sections(&self) -> Vec<Station> {
        let heights = self.trunk_heights();
        let mean = |i: usize| self.atlas.trunk[i].girth;
        let course = |at: f64, hip: f64, waist: f64, chest: f64| {
            let (low, high, a, b) = if at < heights[4] {
                (heights[1], heights[4], hip, waist)
            } else {
                (heights[4], heights[7], waist, chest)
            };
            a + (b - a) * ((at - low) / (high - low)).clamp(0.0, 1.0)
        };
        let section = |i: usize| {
            let usual = mean(i) / course(heights[i], mean(1), mean(4), mean(7));
            let girth = usual * course(heights[i], self.targets.hip, self.targets.waist, self.targets.chest);
            self.trunk_section(i, heights[i], girth)
        };
        (0..9).map(section).collect()
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

    /// The lower end of the trunk, between the thighs.
    fn perineum(&self, trunk: &[Station]) -> Vec<Station> {
        let at = self.atlas.crotch * self.stature() + 0.010;
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

    /// Sections from the armpit over the shoulder line up to the neck.
    fn shoulder_sections(&self, axilla: &Station) -> Vec<Station> {
        let h = self.stature();
        let outline = self.neck_outline();
        let neck = self.neck_factor();
        let x_shoulder = self.targets.shoulder_x;
        let z_shoulder = self.atlas.shoulder * h;
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
            let fullness = 1.0 - ((at - axilla.at) / (z_shoulder - axilla.at)).clamp(0.0, 1.0);
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

    /// Front and back of a section, moved with the girth of the chest near the armpit and with that of the neck above.
    fn grown(&self, axilla: &Station, at: f64, front: f64, back: f64, neck: f64) -> (f64, f64) {
        let h = self.stature();
        let outline = self.neck_outline();
        let [mean_front, mean_back] = outline.map(|curve| curve.at(self.atlas.axilla) * h);
        let upness = ((at / h - self.atlas.axilla) / (0.855 - self.atlas.axilla)).clamp(0.0, 1.0);
        let by_chest = (1.0 - upness) * (1.0 - upness);
        let centre = (front + back) / 2.0;
        let by_neck = 1.0 + (neck - 1.0) * upness * upness;
        let widen = |y: f64, mean: f64, actual: f64| centre + (y - centre) * by_neck + (actual - mean) * by_chest;
        (
            widen(front, mean_front, axilla.centre.y + axilla.half_depth),
            widen(back, mean_back, axilla.centre.y - axilla.half_depth),
        )
    }

    /// Front and back outline in the median plane over stature.
    fn neck_outline(&self) -> [Monotone; 2] {
        let rows = &self.atlas.neck_outline;
        let at: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        [1, 2].map(|side| Monotone::new(&at, &rows.iter().map(|row| row[side]).collect::<Vec<_>>()))
    }

    /// Girth of the neck relative to the mean neck.
    fn neck_factor(&self) -> f64 {
        self.targets.neck / (self.atlas.neck_girth * self.stature())
    }

    fn head_sections(&self) -> Vec<Station> {
        let h = self.stature();
        let head = self.atlas.head_height * h;
        let chin = h - head;
        let section = |row: &[f64; 4]| {
            let [up, half_width, front, back] = *row;
            // The jaw narrows towards the chin, the brow is broad: harmonics of the mean heads, halved above the jaw.
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
            // A thick neck widens the jaw above it.
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
        // The crown: the rest of an ellipsoid whose section `top` lies at 0.9 of the head's height.
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

    /// Distance along the arm's axis from the shoulder joint at which the hand begins.
    pub fn hand_start(&self) -> f64 {
        self.arm_lengths()[1]
    }

    /// Centre of the shoulder joint of the right arm.
    pub fn shoulder_joint(&self) -> V3 {
        let h = self.stature();
        let radius = self.deltoid_radius();
        V3::new(self.targets.shoulder_x - 0.45 * radius, -0.014 * h, self.atlas.shoulder * h - 0.92 * radius)
    }

    fn deltoid_radius(&self) -> f64 {
        self.profile.upper_arm * 0.99 / std::f64::consts::TAU
    }

    /// Distances from the shoulder joint to elbow, wrist and finger tips.
    pub fn arm_lengths(&self) -> [f64; 3] {
        [0.172, 0.172 + 0.150, 0.172 + 0.150 + 0.107].map(|share| share * self.stature())
    }

    /// Axes of the arm's loft: outward in the frontal plane, forward, down the arm.
    pub fn arm_axes(&self) -> [V3; 3] {
        let (sin, cos) = ARM_ANGLE.sin_cos();
        [V3::new(cos, 0.0, sin), V3::y(), V3::new(sin, 0.0, -cos)]
    }

    fn arm(&self) -> Loft {
        let h = self.stature();
        let [elbow, wrist, tip] = self.arm_lengths();
        let p = self.profile;
        let ring = |at: f64, girth: f64, depth_over_width: f64| {
            Station { at, centre: V2::zeros(), half_width: 1.0, half_depth: depth_over_width, shape: ELLIPSE }
                .with_girth(girth)
        };
        let plate = |at: f64, half_width: f64, half_depth: f64| Station {
            at,
            centre: V2::new(0.0, 0.002 * h),
            half_width: half_width * h,
            half_depth: half_depth * h,
            shape: [0.0, 0.0, 0.0, 0.0, -0.03, 0.0, 0.0, 0.0, 0.0],
        };
        let deltoid = ring(0.0, p.upper_arm * 0.99, 1.08);
        let mut stations = dome(&deltoid, self.deltoid_radius(), -1.0);
        stations.reverse();
        stations.extend([
            deltoid,
            ring(0.30 * elbow, p.upper_arm * 1.01, 1.10),
            ring(0.58 * elbow, p.upper_arm, 1.10),
            ring(0.85 * elbow, 0.55 * p.upper_arm + 0.45 * p.forearm, 1.0),
            ring(elbow, p.forearm * 0.98, 0.98),
            ring(elbow + 0.2 * (wrist - elbow), p.forearm, 1.02),
            ring(elbow + 0.6 * (wrist - elbow), 0.55 * p.forearm + 0.45 * p.wrist, 1.10),
            ring(wrist, p.wrist, 1.28),
            plate(wrist + 0.018 * h, 0.0125, 0.0190),
            plate(wrist + 0.045 * h, 0.0125, 0.0240),
            plate(wrist + 0.068 * h, 0.0110, 0.0225),
            plate(tip - 0.020 * h, 0.0090, 0.0165),
        ]);
        let fingers = stations[stations.len() - 1];
        stations.extend(dome(&fingers, 0.020 * h, 1.0));
        Loft::new(self.shoulder_joint(), self.arm_axes(), &stations, TABLE_STEP)
    }

    /// The thumb: a tapering rod at the front edge of the palm.
    fn thumb(&self) -> Loft {
        let h = self.stature();
        let [outward, forward, down] = self.arm_axes();
        let [_, wrist, _] = self.arm_lengths();
        let along = (down * 0.86 + forward * 0.5).normalize();
        let side = along.cross(&outward);
        let root = self.shoulder_joint() + down * (wrist + 0.012 * h) + forward * 0.010 * h;
        let ring = |at: f64, radius: f64| Station {
            at,
            centre: V2::zeros(),
            half_width: radius * h,
            half_depth: radius * h,
            shape: ELLIPSE,
        };
        let mut stations = vec![ring(0.0, 0.0110), ring(0.025 * h, 0.0100), ring(0.042 * h, 0.0065)];
        let end = stations[2];
        stations.extend(dome(&end, 0.0085 * h, 1.0));
        Loft::new(root, [outward, side, along], &stations, TABLE_STEP)
    }

    /// Sections of the right leg from the instep to inside the pelvis.
    fn leg_sections(&self, trunk: &[Station]) -> Vec<Station> {
        let h = self.stature();
        let p = self.profile;
        let crotch = self.atlas.crotch * h;
        let thigh_shape = [-0.008, -0.003, -0.005, 0.002, -0.003, 0.0, 0.0, 0.0, 0.0];
        let ring = |at: f64, girth: f64, depth_over_width: f64, centre: V2, shape: Shape| {
            Station { at, centre, half_width: 1.0, half_depth: depth_over_width, shape }.with_girth(girth)
        };
        let thigh = ring(0.955 * crotch, p.thigh * 0.98, 1.10, V2::new(0.0, 0.007 * h), thigh_shape);
        let hip_x = thigh_x(&trunk[0], &thigh);
        let ankle_x = self.ankle_x(hip_x);
        let x_at = |z: f64| ankle_x + (hip_x - ankle_x) * z / crotch;
        let at = |z: f64, y: f64| V2::new(x_at(z), y * h);
        let calf_shape = [-0.022, -0.030, 0.0, 0.025, 0.008, 0.0, 0.0, 0.0, 0.0];
        let (knee, calf) = (self.atlas.knee * h, self.atlas.calf * h);
        let mut sections = vec![
            ring(0.012 * h, p.ankle * 1.00, 1.30, at(0.0, -0.018), ELLIPSE),
            ring(0.040 * h, p.ankle * 1.06, 1.35, at(0.040 * h, -0.018), ELLIPSE),
            ring(0.072 * h, p.ankle, 1.30, at(0.072 * h, -0.018), ELLIPSE),
            ring(0.125 * h, 0.60 * p.ankle + 0.40 * p.calf, 1.12, at(0.125 * h, -0.019), calf_shape),
            ring(calf, p.calf, 1.02, at(calf, -0.0165), calf_shape),
            ring(knee, p.knee, 1.06, at(knee, -0.0065), [-0.022, -0.025, 0.0, 0.025, 0.004, 0.0, 0.0, 0.0, 0.0]),
            ring(1.25 * knee, 0.53 * p.knee + 0.45 * p.thigh, 1.05, at(1.25 * knee, -0.001), thigh_shape),
            ring(0.82 * crotch, 0.22 * p.knee + 0.76 * p.thigh, 1.06, at(0.82 * crotch, 0.004), thigh_shape),
            Station { centre: at(thigh.at, 0.006), ..thigh },
        ];
        sections.extend(self.leg_roots(trunk, x_at(crotch)));
        sections
    }

    /// The upper end of the leg: fills the outer half of the hip up to the buttocks and ends inside the pelvis.
    fn leg_roots(&self, trunk: &[Station], crotch_x: f64) -> Vec<Station> {
        let fill = |at: f64, outer: &Station, inner_x: f64, share: f64, depth: f64| {
            let outer_x = outer.half_width * share;
            Station {
                at,
                centre: V2::new((outer_x + inner_x) / 2.0, outer.centre.y),
                half_width: (outer_x - inner_x) / 2.0,
                half_depth: outer.half_depth * depth,
                shape: ELLIPSE,
            }
        };
        let (low, hip) = (&trunk[0], &trunk[1]);
        let inner = 0.1 * crotch_x;
        let root =
            Station { shape: [0.0, 0.0, 0.0, 0.0, -0.03, 0.0, 0.0, 0.0, 0.0], ..fill(low.at, low, inner, 0.985, 0.84) };
        let inside = fill(hip.at, hip, inner, 0.88, 0.75);
        let mut sections = vec![root, inside];
        sections.extend(dome(&inside, 0.03 * self.stature(), 1.0));
        sections
    }

    /// The right foot, from heel to toes.
    fn foot(&self, x: f64) -> Loft {
        let length = self.profile.foot_length;
        let ankle = self.profile.ankle / 0.229;
        let heel_y = -0.018 * self.stature() - 0.24 * length;
        // Share of the length, half width, height, sideways place (towards the big toe is negative), all over length.
        let rows: [[f64; 4]; 6] = [
            [0.10, 0.118, 0.270, 0.0],
            [0.25, 0.122, 0.300, 0.0],
            [0.45, 0.140, 0.285, -0.005],
            [0.62, 0.172, 0.200, -0.012],
            [0.76, 0.185, 0.135, -0.015],
            [0.90, 0.160, 0.095, -0.022],
        ];
        let section = |&[along, half_width, height, side]: &[f64; 4]| {
            // The ellipse reaches below the floor, which cuts the sole.
            let half_depth = 0.62 * height * length;
            Station {
                at: along * length,
                centre: V2::new(side * length, height * length - half_depth),
                half_width: half_width * length * (0.8 + 0.2 * ankle),
                half_depth,
                shape: ELLIPSE,
            }
        };
        let sections: Vec<Station> = rows.iter().map(section).collect();
        let mut stations = dome(&sections[0], 0.10 * length, -1.0);
        stations.reverse();
        stations.extend(&sections);
        stations.extend(dome(&sections[5], 0.10 * length, 1.0));
        Loft::new(V3::new(x, heel_y, 0.0), [V3::x(), V3::z(), V3::y()], &stations, TABLE_STEP)
    }

    /// Sideways place of the right ankle: the thighs' inclination, somewhat straightened.
    fn ankle_x(&self, hip_x: f64) -> f64 {
        hip_x + 0.022 * self.stature()
    }
}

/// Sideways place of the right thigh below the crotch: its outer side continues the hip's, and the thighs part.
fn thigh_x(low: &Station, thigh: &Station) -> f64 {
    (0.97 * low.half_width - thigh.half_width).max(thigh.half_width + 0.008)
}
