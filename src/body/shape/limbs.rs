//! Right arm and leg of the figure. The left ones are mirror images.
//!
//! The proportions of the sections inside the functions are judgement: no source of them is recorded.

use super::figure::{ELLIPSE, Figure};
use super::loft::{Part, Shape, Station, dome};
use crate::measure::AxisPoint;
use crate::people::dimension::Dimension;
use crate::people::figures::Trait;
use geom::{V2, V3};

/// Angle of the arms from the vertical, radians. Judgement.
const ARM_ANGLE: f64 = 38.0 * std::f64::consts::PI / 180.0;

/// Distance of the wrist from the shoulder joint, as a share of the arm length. Judgement.
const WRIST: f64 = 0.94;
/// Distance of the elbow from the shoulder joint, as a share of that of the wrist. Judgement.
const ELBOW: f64 = 0.534;
/// Length of the hand, as a share of the stature. Judgement.
const HAND: f64 = 0.107;

/// Position of the upper arm girth as a share of the distance from shoulder joint to elbow. Judgement.
pub(crate) const UPPER_ARM: f64 = 0.58;

/// Least height of the armpit, without its fillet, above the chest level, as a share of stature.
const ARMPIT_ABOVE_CHEST: f64 = 0.030;

impl Figure<'_> {
    pub fn hand_start(&self) -> f64 {
        self.arm_lengths()[1]
    }

    /// Centre of the right shoulder joint: below the shoulder point. The outside of the arm is half the breadth across
    /// the upper arms from the middle, or so far that the armpit lies above the chest.
    pub fn shoulder_joint(&self) -> V3 {
        let h = self.stature();
        let radius = self.deltoid_radius();
        let z = self.shoulder_height() - radius;
        let (sin, cos) = ARM_ANGLE.sin_cos();
        let trunk = &self.trunk_sections()[8];
        // Height at which the lower edge of the arm would meet the side of the trunk with the joint at x = 0.
        let meets = z - (trunk.half_width * cos + radius) / sin;
        let clear = (self.atlas.chest * h + ARMPIT_ABOVE_CHEST * h - meets) * sin / cos;
        let forward = self.doses[Trait::ShoulderForward as usize];
        V3::new((self.size(Dimension::ShoulderBreadth) / 2.0 - radius).max(clear), -0.014 * h + forward, z)
    }

    fn deltoid_radius(&self) -> f64 {
        self.size(Dimension::UpperArmGirth) * 0.99 / std::f64::consts::TAU
    }

    /// Distances of elbow, wrist and finger tips from the shoulder joint, m.
    pub fn arm_lengths(&self) -> [f64; 3] {
        let wrist = self.size(Dimension::ArmLength) * WRIST;
        [ELBOW * wrist, wrist, wrist + HAND * self.stature()]
    }

    /// Axes of the loft of the arm: outwards in the frontal plane, forwards, down the arm.
    pub fn arm_axes(&self) -> [V3; 3] {
        let (sin, cos) = ARM_ANGLE.sin_cos();
        [V3::new(cos, 0.0, sin), V3::y(), V3::new(sin, 0.0, -cos)]
    }

    pub fn upper_arm(&self) -> AxisPoint {
        let along = self.arm_axes()[2];
        AxisPoint { place: self.shoulder_joint() + along * UPPER_ARM * self.arm_lengths()[0], along }
    }

    pub fn arm(&self) -> Part {
        let h = self.stature();
        let [elbow, wrist, tip] = self.arm_lengths();
        let [upper_arm, forearm, wrist_girth] =
            [Dimension::UpperArmGirth, Dimension::ForearmGirth, Dimension::WristGirth].map(|girth| self.size(girth));
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
        let deltoid = ring(0.0, upper_arm * 0.99, 1.08);
        let mut stations = dome(&deltoid, self.deltoid_radius(), -1.0);
        stations.reverse();
        stations.extend([
            deltoid,
            ring(0.30 * elbow, upper_arm * 1.01, 1.10),
            ring(UPPER_ARM * elbow, upper_arm, 1.10),
            ring(0.85 * elbow, 0.55 * upper_arm + 0.45 * forearm, 1.0),
            ring(elbow, forearm * 0.98, 0.98),
            ring(elbow + 0.2 * (wrist - elbow), forearm, 1.02),
            ring(elbow + 0.6 * (wrist - elbow), 0.55 * forearm + 0.45 * wrist_girth, 1.10),
            ring(wrist, wrist_girth, 1.28),
            plate(wrist + 0.018 * h, 0.0125, 0.0190),
            plate(wrist + 0.045 * h, 0.0125, 0.0240),
            plate(wrist + 0.068 * h, 0.0110, 0.0225),
            plate(tip - 0.016 * h, 0.0090, 0.0190),
        ]);
        let fingers = stations[stations.len() - 1];
        stations.extend(dome(&fingers, 0.016 * h, 1.0));
        Part {
            origin: self.shoulder_joint(),
            axes: self.arm_axes(),
            stations,
            root: Some([-self.deltoid_radius(), 0.0]),
        }
    }

    /// Thumb: a tapering rod at the front edge of the palm.
    pub fn thumb(&self) -> Part {
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
        Part { origin: root, axes: [outward, side, along], stations, root: None }
    }

    /// Sections of the right leg from the instep to inside the pelvis.
    pub fn leg_sections(&self, trunk: &[Station]) -> Vec<Station> {
        let h = self.stature();
        let crotch = self.crotch();
        let [thigh_girth, knee_girth, calf_girth, ankle] =
            [Dimension::ThighGirth, Dimension::KneeGirth, Dimension::CalfGirth, Dimension::AnkleGirth]
                .map(|girth| self.size(girth));
        let thigh_shape = [-0.008, -0.003, -0.005, 0.002, -0.003, 0.0, 0.0, 0.0, 0.0];
        let ring = |at: f64, girth: f64, depth_over_width: f64, centre: V2, shape: Shape| {
            Station { at, centre, half_width: 1.0, half_depth: depth_over_width, shape }.with_girth(girth)
        };
        let thigh = ring(0.955 * crotch, thigh_girth * 0.98, 1.10, V2::zeros(), thigh_shape);
        let thigh = slimmed(thigh, 0.485 * trunk[0].half_width - 0.002);
        let hip_x = thigh_x(&trunk[0], &thigh);
        let forward = thigh_forward(&trunk[1], &thigh, thigh_girth / h, h);
        let ankle_x = self.ankle_x(hip_x);
        let x_at = |z: f64| ankle_x + (hip_x - ankle_x) * z / crotch;
        let centre = |z: f64, y: f64| V2::new(x_at(z), y * h);
        let calf_shape = [-0.022, -0.030, 0.0, 0.025, 0.008, 0.0, 0.0, 0.0, 0.0];
        let [knee, calf] = self.knee_and_calf();
        let mut sections = vec![
            ring(0.012 * h, ankle * 1.00, 1.30, centre(0.0, -0.018), ELLIPSE),
            ring(0.040 * h, ankle * 1.06, 1.35, centre(0.040 * h, -0.018), ELLIPSE),
            ring(0.072 * h, ankle, 1.30, centre(0.072 * h, -0.018), ELLIPSE),
            ring(0.125 * h, 0.60 * ankle + 0.40 * calf_girth, 1.12, centre(0.125 * h, -0.019), calf_shape),
            ring(calf, calf_girth, 1.02, centre(calf, -0.0165), calf_shape),
            ring(
                knee,
                knee_girth,
                1.06,
                centre(knee, -0.0065),
                [-0.022, -0.025, 0.0, 0.025, 0.004, 0.0, 0.0, 0.0, 0.0],
            ),
            ring(
                1.25 * knee,
                0.53 * knee_girth + 0.45 * thigh_girth,
                1.05,
                centre(1.25 * knee, 0.3 * forward),
                thigh_shape,
            ),
            ring(
                0.82 * crotch,
                0.22 * knee_girth + 0.76 * thigh_girth,
                1.06,
                centre(0.82 * crotch, 0.8 * forward),
                thigh_shape,
            ),
            Station { centre: centre(thigh.at, forward), ..thigh },
        ];
        let thigh = sections[sections.len() - 1];
        sections.extend(self.leg_roots(trunk, &thigh, x_at(crotch)));
        sections
    }

    /// Upper end of the leg: fills the outer half of the hip up to the buttocks, with its front half way between those
    /// of thigh and trunk, and ends inside the pelvis.
    fn leg_roots(&self, trunk: &[Station], thigh: &Station, crotch_x: f64) -> Vec<Station> {
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
        let mut root =
            Station { shape: [0.0, 0.0, 0.0, 0.0, -0.03, 0.0, 0.0, 0.0, 0.0], ..fill(low.at, low, inner, 0.985, 0.84) };
        let forward = (thigh.centre.y + thigh.half_depth - root.centre.y - root.half_depth).max(0.0) / 4.0;
        root.centre.y += forward;
        root.half_depth += forward;
        let inside = fill(hip.at, hip, inner, 0.88, 0.75);
        let mut sections = vec![root, inside];
        sections.extend(dome(&inside, 0.03 * self.stature(), 1.0));
        sections
    }

    /// The right foot, from heel to toes.
    pub fn foot(&self, x: f64) -> Part {
        let length = self.size(Dimension::FootLength);
        let ankle = self.size(Dimension::AnkleGirth) / 0.229;
        let heel_y = -0.018 * self.stature() - 0.24 * length;
        // Position along the foot, half width, height, and sideways position (negative towards the big toe), each
        // divided by the length of the foot.
        let rows: [[f64; 4]; 6] = [
            [0.10, 0.118, 0.270, 0.0],
            [0.25, 0.122, 0.300, 0.0],
            [0.45, 0.140, 0.285, -0.005],
            [0.62, 0.172, 0.200, -0.012],
            [0.76, 0.185, 0.150, -0.015],
            [0.90, 0.155, 0.112, -0.022],
        ];
        let section = |&[along, half_width, height, side]: &[f64; 4]| {
            // The ellipse extends below the floor, which cuts off the sole.
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
        Part { origin: V3::new(x, heel_y, 0.0), axes: [V3::x(), V3::z(), V3::y()], stations, root: None }
    }

    /// Sideways position of the right ankle. The lower legs lean less than the thighs.
    fn ankle_x(&self, hip_x: f64) -> f64 {
        hip_x + 0.022 * self.stature()
    }
}

/// Narrows a section to `half_width` and deepens it, keeping the mean square radius and so nearly the girth.
fn slimmed(section: Station, half_width: f64) -> Station {
    if section.half_width <= half_width {
        return section;
    }
    let square = section.half_width.powi(2) + section.half_depth.powi(2) - half_width.powi(2);
    Station { half_width, half_depth: square.sqrt(), ..section }
}

/// Forward position of the centre of the thigh below the crotch, for a stature `h`. The buttocks lie behind it. Fitted
/// to six reference bodies (girth / stature 0.29 to 0.40, residual up to 5 mm), whose thighs lie at most a hundredth of
/// the stature in front of the hip.
fn thigh_forward(hip: &Station, thigh: &Station, girth: f64, h: f64) -> f64 {
    let usual = 0.0125 + 0.08 * (girth.clamp(0.26, 0.46) - 0.335);
    let at_most = (hip.centre.y + hip.half_depth - thigh.half_depth) / h + 0.010;
    usual.min(at_most.max(0.0))
}

/// Sideways position of the right thigh below the crotch: continues the hip's outer side, and thighs do not touch.
fn thigh_x(low: &Station, thigh: &Station) -> f64 {
    (0.97 * low.half_width - thigh.half_width).max(thigh.half_width + 0.008)
}
