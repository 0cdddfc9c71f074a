//! The limb that a piece is worn about: a straight axis, and the offset of the arm from it beyond the elbow.

use super::body_parts::{Axis, Cylindrical};
use geom::V3;

/// Cross section of an arm at or below the elbow, with the sleeve about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Along the axis of the upper arm, m.
    pub height: f64,
    /// Offset of the arm's middle from that axis.
    pub beside: V3,
    /// Radius of the sleeve, m; 0 where there is none.
    pub radius: f64,
}

/// Limb, unrolled to (angle, height).
#[derive(Clone, Debug, PartialEq)]
pub struct Limb {
    pub axis: Axis,
    /// Cross sections from the elbow of an arm down; a single one on the axis of a straight limb. Never empty.
    course: Vec<Station>,
}

impl Limb {
    pub fn straight(axis: Axis) -> Self {
        Self::bent(axis, Station { height: 0.0, beside: V3::zeros(), radius: 0.0 }, Vec::new())
    }

    /// Arm that continues from the elbow through some stations, downwards.
    pub fn bent(axis: Axis, elbow: Station, below: Vec<Station>) -> Self {
        Self { axis, course: [vec![elbow], below].concat() }
    }

    /// Linear interpolation; constant beyond the ends.
    pub fn station(&self, height: f64) -> Station {
        let within = self.course.windows(2).find(|ends| height > ends[1].height);
        let last = self.course[self.course.len() - 1];
        let (from, to) = within.map_or((last, last), |ends| (ends[0], ends[1]));
        let share = ((from.height - height) / (from.height - to.height).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let radius = from.radius + (to.radius - from.radius) * share;
        Station { height, beside: from.beside.lerp(&to.beside, share), radius }
    }

    /// Takes an angle (rad), a distance from the limb's middle and a height.
    pub fn point(&self, angle: f64, radius: f64, height: f64) -> V3 {
        self.axis.point(angle, radius, height) + self.station(height).beside
    }

    /// About the limb's middle.
    pub fn coordinates(&self, p: &V3) -> Cylindrical {
        let Cylindrical { height, .. } = self.axis.coordinates(p);
        self.axis.coordinates(&(p - self.station(height).beside))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arm() -> Limb {
        let axis = Axis { origin: V3::new(0.2, 0.0, 1.4), up: V3::z(), outward: V3::x() };
        let elbow = Station { height: -0.3, beside: V3::zeros(), radius: 0.07 };
        let wrist = Station { height: -0.55, beside: V3::new(0.0, 0.1, 0.0), radius: 0.04 };
        Limb::bent(axis, elbow, vec![wrist])
    }

    #[test]
    fn a_sleeve_follows_the_arm_from_the_elbow_on() {
        let check = |height: f64, beside: f64, radius: f64| {
            let found = arm().station(height);
            assert!((found.beside.y - beside).abs() < 1e-12, "{beside} m at {height}: {}", found.beside);
            assert!((found.radius - radius).abs() < 1e-12, "{radius} m at {height}: {}", found.radius);
        };
        check(0.1, 0.0, 0.07);
        check(-0.3, 0.0, 0.07);
        check(-0.425, 0.05, 0.055);
        check(-0.55, 0.1, 0.04);
        check(-0.8, 0.1, 0.04);
    }

    #[test]
    fn a_point_has_the_coordinates_that_it_was_made_of() {
        let straight = Limb::straight(arm().axis);
        for limb in [arm(), straight] {
            for height in [0.1, -0.4, -0.7] {
                let found = limb.coordinates(&limb.point(0.7, 0.05, height));
                let off = [found.angle - 0.7, found.radius - 0.05, found.height - height];
                assert!(off.iter().all(|off| off.abs() < 1e-12), "{off:?}");
            }
        }
    }
}
