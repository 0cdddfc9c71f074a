//! The skin as one implicit surface: a smooth union of body parts.

use super::loft::{Loft, Part, Sample};
use geom::{V3, smooth_step};

/// Spacing of the tables of the lofts, m: below the grid spacing of the skin.
const TABLE_STEP: f64 = 0.004;

/// Distance from a part beyond which its field is that of a bounding cylinder, m: beyond the reach of all unions.
pub(crate) const NEAR: f64 = 0.12;

/// Width of the rounding between skin and floor, m. Judgement.
const SOLE_EDGE: f64 = 0.006;

/// Reach of the smooth unions between parts, m. Judgement: a smaller reach leaves creases, a larger one fills armpit
/// and crotch.
const ARM_JOINT: f64 = 0.035;
const LEG_JOINT: f64 = 0.025;
const BETWEEN_LEGS: f64 = 0.008;
const FOOT_JOINT: f64 = 0.045;
const THUMB_JOINT: f64 = 0.030;

/// Difference of the distances from trunk and limb up to which the joint is faired, m: more than the union's reach.
const ARM_SEAM: f64 = 0.040;
const LEG_SEAM: f64 = 0.045;

/// Distance from the arm up to which skin counts as that of the hand, and length along the hand over which its fairing
/// sets in, m. Then the weight of that fairing. Judgement.
const HAND_SKIN: f64 = 0.04;
const HAND_FAIRING: f64 = 0.04;

/// Lofts of the parts of a body. Limbs are those of the right side, and are mirrored for the left.
#[derive(Clone, Debug)]
pub(crate) struct Parts {
    pub trunk: Loft,
    pub arm: Loft,
    pub thumb: Loft,
    /// Distance from the shoulder joint along the arm at which the hand begins, m.
    pub hand_start: f64,
    pub leg: Loft,
    pub foot: Loft,
}

impl Parts {
    pub fn new([trunk, arm, thumb, leg, foot]: [Part; 5], hand_start: f64) -> Self {
        let loft = |part| Loft::new(part, TABLE_STEP);
        Self { trunk: loft(trunk), arm: loft(arm), thumb: loft(thumb), hand_start, leg: loft(leg), foot: loft(foot) }
    }

    /// Lofts in the order of [`Figure::parts`](super::figure::Figure::parts).
    pub fn lofts(&self) -> [&Loft; 5] {
        [&self.trunk, &self.arm, &self.thumb, &self.leg, &self.foot]
    }

    /// Field at a point: about the signed distance from the skin (negative inside), and the direction outwards.
    pub fn sample(&self, point: V3) -> Sample {
        let right = V3::new(point.x.abs(), point.y, point.z);
        let left = V3::new(-right.x, point.y, point.z);
        let arm = join(self.arm.sample(right, NEAR), self.thumb.sample(right, NEAR), THUMB_JOINT);
        let near_leg = join(self.leg.sample(right, NEAR), self.foot.sample(right, NEAR), FOOT_JOINT);
        let far_leg = mirrored(join(self.leg.sample(left, NEAR), self.foot.sample(left, NEAR), FOOT_JOINT));
        let legs = join(near_leg, far_leg, BETWEEN_LEGS);
        let lower = join(self.trunk.sample(right, NEAR), legs, LEG_JOINT);
        let skin = cut_at_floor(join(lower, arm, ARM_JOINT), point.z);
        if point.x < 0.0 { mirrored(skin) } else { skin }
    }

    /// Weight of the fairing at a point of the skin: 1 where trunk and limb meet, little on the hands, 0 elsewhere.
    pub fn fairness(&self, point: V3) -> f64 {
        let right = V3::new(point.x.abs(), point.y, point.z);
        let trunk = self.trunk.sample(right, NEAR).distance;
        let arm = self.arm.sample(right, NEAR).distance;
        let leg = self.leg.sample(right, NEAR).distance;
        let closeness = |limb: f64, reach: f64| (1.0 - (limb - trunk).abs() / reach).clamp(0.0, 1.0);
        let share = closeness(arm, ARM_SEAM).max(closeness(leg, LEG_SEAM));
        let on_hand =
            if arm < HAND_SKIN { ((self.arm.along(right) - self.hand_start) / HAND_SKIN).clamp(0.0, 1.0) } else { 0.0 };
        smooth_step(share).max(HAND_FAIRING * on_hand)
    }

    /// Signed distance of a point from the skin, m.
    pub fn distance(&self, point: V3) -> f64 {
        self.sample(point).distance
    }

    /// Projects a point onto the skin, in steps against the outward direction.
    pub fn project(&self, mut point: V3) -> V3 {
        const STEPS: usize = 6;
        const MET: f64 = 1e-5;
        for _ in 0..STEPS {
            let here = self.sample(point);
            if here.distance.abs() < MET {
                break;
            }
            point -= here.outward * here.distance;
        }
        point
    }
}

fn mirrored(sample: Sample) -> Sample {
    let outward = V3::new(-sample.outward.x, sample.outward.y, sample.outward.z);
    Sample { outward, ..sample }
}

/// Polynomial smooth union [Quilez], with the reach multiplied by `1 - n_a . n_b`, at most 1, for the outward
/// directions `n`. A limb that continues the outline of the trunk therefore does not swell it, and opposed surfaces
/// (armpit, crotch) get the full fillet.
fn join(a: Sample, b: Sample, reach: f64) -> Sample {
    let gap = (a.distance - b.distance).abs();
    let nearer = if a.distance < b.distance { a } else { b };
    if gap >= reach {
        return nearer;
    }
    let opposed = (1.0 - a.outward.dot(&b.outward)).clamp(0.0, 1.0);
    let reach = reach * opposed;
    if gap >= reach {
        return nearer;
    }
    let share = (reach - gap) / reach;
    let farther = if a.distance < b.distance { b } else { a };
    let outward = nearer.outward.lerp(&farther.outward, share / 2.0);
    let outward = outward.try_normalize(1e-9).unwrap_or(nearer.outward);
    Sample { distance: nearer.distance - share * share * reach / 4.0, outward }
}

/// Intersection with the half space above the floor, with a rounded edge.
fn cut_at_floor(skin: Sample, z: f64) -> Sample {
    let share = (SOLE_EDGE - (skin.distance + z).abs()).max(0.0) / SOLE_EDGE;
    let distance = skin.distance.max(-z) + share * share * SOLE_EDGE / 4.0;
    let outward = if -z > skin.distance { -V3::z() } else { skin.outward };
    Sample { distance, outward }
}
