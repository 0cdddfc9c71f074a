//! The body as placement sees it: trunk and legs apart from the arms, and axes of the limbs.

use crate::hands;
use body::{Body, Joint};
use geom::{V2, V3};

geom::constants! {
    "placement.form",
    /// Half height of the band in which the body's depth is measured.
    const LEVEL_BAND_M: f64 = 0.02;
    const ARM_REACH_M: f64 = 0.1;
    /// Distance from the shoulder joint along the bone beyond which skin near it is the arm's, not the shoulder's.
    const SHOULDER_M: f64 = 0.1;
    /// Length of a hand beyond the wrist.
    const HAND_M: f64 = 0.25;
    /// Distance towards the median plane from the start of the arm's bone at which its skin begins.
    const WITHIN_JOINT_M: f64 = 0.03;
}

/// `1.0` right, `-1.0` left.
pub type Hand = f64;

/// Cylindrical coordinate system about a limb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    pub origin: V3,
    pub up: V3,
    /// Direction of angle 0.
    pub outward: V3,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylindrical {
    /// Within half a turn, rad.
    pub angle: f64,
    /// Distance from the limb's middle, m.
    pub radius: f64,
    /// Along the axis, m.
    pub height: f64,
}

impl Axis {
    /// To the right of `outward` seen from outside, in which the angle grows.
    fn rightward(&self) -> V3 {
        self.up.cross(&self.outward)
    }

    /// Angle in rad.
    pub fn point(&self, angle: f64, radius: f64, height: f64) -> V3 {
        let (sin, cos) = angle.sin_cos();
        self.origin + self.up * height + (self.outward * cos + self.rightward() * sin) * radius
    }

    pub fn coordinates(&self, p: &V3) -> Cylindrical {
        let d = p - self.origin;
        let (a, b) = (d.dot(&self.outward), d.dot(&self.rightward()));
        Cylindrical { angle: b.atan2(a), radius: a.hypot(b), height: d.dot(&self.up) }
    }
}

pub struct Form<'a> {
    pub body: &'a Body,
    /// Skin of trunk and legs.
    pub trunk: Vec<V3>,
    pub arms: Vec<V3>,
    /// Right and left hand; `None` where one cannot be told from the rest.
    tips: [Option<V3>; 2],
}

impl<'a> Form<'a> {
    pub fn of(body: &'a Body) -> Self {
        let hands = [1.0, -1.0].map(|side| hands::Hand::of(body, side));
        let is_hand = |v: &usize| hands.iter().flatten().any(|hand| hand.skin.binary_search(v).is_ok());
        let points = body.mesh.positions.iter().enumerate();
        let (arms, trunk): (Vec<_>, Vec<_>) = points.partition(|(v, p)| is_hand(v) || is_arm(body, p));
        let places = |points: Vec<(usize, &V3)>| points.into_iter().map(|(_, p)| *p).collect();
        let tips = hands.map(|hand| hand.map(|hand| hand.tip));
        Self { body, trunk: places(trunk), arms: places(arms), tips }
    }

    /// `None` where no skin is a hand's.
    pub fn tip(&self, hand: Hand) -> Option<V3> {
        self.tips[usize::from(hand < 0.0)]
    }

    /// Least and greatest `y` of the trunk at a height.
    pub fn depth(&self, height: f64) -> V2 {
        let near = self.trunk.iter().filter(|p| (p.z - height).abs() < LEVEL_BAND_M);
        let (back, front) = near.fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.y), high.max(p.y)));
        if back <= front { V2::new(back, front) } else { V2::zeros() }
    }

    pub fn half_width(&self, low: f64, high: f64) -> f64 {
        self.between(low, high).map(|p| p.x.abs()).fold(0.0, f64::max)
    }

    pub fn between(&self, low: f64, high: f64) -> impl Iterator<Item = &V3> {
        self.trunk.iter().filter(move |p| (low..=high).contains(&p.z))
    }

    /// Vertical, half way between chest and back; angle 0 in front.
    pub fn trunk_axis(&self) -> Axis {
        let depth = self.depth(self.body.levels.waist_m);
        Axis { origin: V3::new(0.0, 0.5 * (depth.x + depth.y), 0.0), up: V3::z(), outward: V3::y() }
    }

    /// Vertical through the knee; angle 0 in front.
    pub fn leg_axis(&self, hand: Hand) -> Axis {
        let knee = self.body.skeleton.at(if hand > 0.0 { Joint::KneeRight } else { Joint::KneeLeft });
        Axis { origin: V3::new(knee.x, knee.y, 0.0), up: V3::z(), outward: V3::y() }
    }

    /// Along the upper arm's bone, height 0 at the shoulder joint; angle 0 away from the trunk.
    pub fn arm_axis(&self, hand: Hand) -> Axis {
        let [shoulder, elbow, _] = arm_bones(self.body, hand);
        let up = (shoulder - elbow).normalize();
        let sideways = V3::new(hand, 0.0, 0.0);
        Axis { origin: shoulder, up, outward: (sideways - up * sideways.dot(&up)).normalize() }
    }

    pub fn shoulder_height(&self, hand: Hand) -> f64 {
        let tip = self.body.landmarks.shoulder[usize::from(hand < 0.0)];
        self.arm_axis(hand).coordinates(&tip).height
    }
}

pub fn arm_bones(body: &Body, hand: Hand) -> [V3; 3] {
    let joints = if hand > 0.0 {
        [Joint::ShoulderRight, Joint::ElbowRight, Joint::WristRight]
    } else {
        [Joint::ShoulderLeft, Joint::ElbowLeft, Joint::WristLeft]
    };
    joints.map(|joint| body.skeleton.at(joint))
}

fn is_arm(body: &Body, p: &V3) -> bool {
    [1.0, -1.0].into_iter().any(|hand| {
        let [shoulder, elbow, wrist] = arm_bones(body, hand);
        let tip = wrist + (wrist - elbow).try_normalize(0.0).unwrap_or_default() * HAND_M;
        let start = shoulder + (elbow - shoulder).try_normalize(0.0).unwrap_or_default() * SHOULDER_M;
        distance(p, start, elbow).min(distance(p, elbow, tip)) < ARM_REACH_M
            && p.x * hand > start.x.abs() - WITHIN_JOINT_M
    })
}

fn distance(p: &V3, a: V3, b: V3) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (p - a - along * share).norm()
}
