//! Shoulder points and back neck point, which the skin shows only indirectly.
//!
//! Both lie on bones. They are estimated from marks that bodies do show: where the line over the shoulder turns down,
//! the armpit, the direction of the arm, the neck. The rules are least-squares fits for 194 bodies of a parametric
//! model (CC0-1.0) of both sexes, with arms 16 to 60 degrees from the vertical. The rule of the back neck point is the
//! mean of two rules, with and without the armpit.

use super::arm::Arm;
use super::landmarks::{self, Side, median_point, shoulder_top};
use super::slices::steps;
use super::tape::{self, Neck};
use crate::Sex;
use geom::{TriMesh, V3};

/// Mean distance of the shoulder point from the median plane, and mean height of the back neck point, as shares of
/// stature [Gordon 2014].
const SHOULDER: f64 = 0.1148;
const CERVICALE: f64 = 0.8617;

/// Slope of the line over the shoulder at which it turns into the arm. Judgement.
const TURN: f64 = 0.90;

/// Distance from the median plane at which the height of the trapezius is read / stature. Judgement.
const TRAPEZIUS: f64 = 0.07;

/// Ranges of shoulder and back neck point / stature to which rules are clamped: somewhat wider than in model bodies.
const SHOULDERS: [f64; 2] = [0.085, 0.150];
const NAPES: [f64; 2] = [0.835, 0.890];

/// Residual standard deviations of shoulder point and back neck point / stature, with and without the marks.
const SEEN: [f64; 2] = [0.0028, 0.0034];
const UNSEEN: [f64; 2] = [0.0100, 0.0070];

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Upper {
    /// Points, right and left.
    pub shoulder: [V3; 2],
    pub back_neck: V3,
    /// Standard deviations of the distance of a shoulder point from the median plane and of the back neck height, m.
    pub sd: [f64; 2],
}

pub(super) struct Frame<'a> {
    /// Mesh above the chest, and whole mesh.
    pub upper: &'a TriMesh,
    pub mesh: &'a TriMesh,
    pub floor: f64,
    pub stature: f64,
    pub middle: f64,
    pub waist: f64,
    pub neck: &'a Neck,
    pub sex: Sex,
}

/// Marks of one side / stature: turn of the shoulder, armpit, outward slope of the arm, height of the trapezius.
struct Marks {
    turn: f64,
    armpit: V3,
    slope: f64,
    trapezius: f64,
}

impl Frame<'_> {
    /// Shoulder points and back neck point. `None` if the skin has neither shoulders nor a neck.
    pub fn find(&self) -> Option<Upper> {
        let right = self.marks(self.mesh);
        let mirrored = landmarks::mirrored(self.mesh, self.middle);
        let left = self.marks(&mirrored);
        let seen = right.is_some() && left.is_some();
        let sd = if seen { SEEN } else { UNSEEN }.map(|share| share * self.stature);
        let x = [&right, &left].map(|marks| self.out(marks.as_ref()));
        let top = |x: f64| shoulder_top(self.upper, self.middle + x, self.height(0.86));
        let napes: Vec<f64> = [&right, &left].into_iter().flatten().map(|marks| self.nape(marks)).collect();
        let nape = if napes.is_empty() { CERVICALE } else { napes.iter().sum::<f64>() / napes.len() as f64 };
        let back_neck = median_point(self.upper, self.height(nape), self.middle, Side::Back)?;
        Some(Upper { shoulder: [top(x[0])?, top(-x[1])?], back_neck, sd })
    }

    fn height(&self, share: f64) -> f64 {
        self.floor + share * self.stature
    }

    /// Distance of the shoulder point from the median plane, m.
    fn out(&self, marks: Option<&Marks>) -> f64 {
        let woman = f64::from(u8::from(self.sex == Sex::Female));
        let share = marks.map_or(SHOULDER, |marks| {
            0.0203 + 0.6518 * marks.turn + 0.3599 * marks.armpit.x - 0.0272 * marks.slope + 0.0030 * woman
        });
        share.clamp(SHOULDERS[0], SHOULDERS[1]) * self.stature
    }

    /// Height of the back neck point / stature.
    fn nape(&self, marks: &Marks) -> f64 {
        let neck = (self.neck.height - self.floor) / self.stature;
        let share = 0.0270 + 0.151 * marks.trapezius + 0.122 * marks.armpit.z + 0.706 * neck;
        share.clamp(NAPES[0], NAPES[1])
    }

    /// Marks of the right side of a mesh. `None` if the arm is not apart from the trunk.
    fn marks(&self, mesh: &TriMesh) -> Option<Marks> {
        let h = self.stature;
        let upper = &tape::above(mesh, self.height(0.7));
        let top = |x: f64| shoulder_top(upper, self.middle + x, self.height(0.86));
        let usual = top(SHOULDER * h)?;
        let armpit = landmarks::armpit(mesh, self.waist, usual.z, self.middle)?;
        let arm = Arm::trace(mesh, usual, armpit, h)?;
        let along = arm.at(0.25).along;
        let line: Vec<V3> = steps(0.07 * h, 0.17 * h, 50).filter_map(top).collect();
        let fall = |i: usize| (line[i - 3].z - line[i + 3].z) / (line[i + 3].x - line[i - 3].x);
        let turn = (3..line.len().saturating_sub(3)).find(|&i| fall(i) > TURN)?;
        Some(Marks {
            turn: (line[turn].x - self.middle) / h,
            armpit: V3::new((armpit.x - self.middle) / h, armpit.y / h, (armpit.z - self.floor) / h),
            slope: along.x / -along.z,
            trapezius: (top(TRAPEZIUS * h)?.z - self.floor) / h,
        })
    }
}
