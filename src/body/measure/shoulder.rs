//! Shoulder points and nape, which the skin shows only by what lies round them.
//!
//! Both belong to bones. Where they lie is read from marks that bodies do show: where the line over the shoulder turns down, the
//! armpit, the direction of the arm, the neck. The rules are least squares over 194 bodies of a parametric model (CC0-1.0) of
//! both sexes, arms 16 to 60 degrees from the vertical. That of the nape is the mean of two, with and without the armpit.

use super::arm::Arm;
use super::landmarks::{self, Side, median_point, shoulder_top};
use super::slices::steps;
use super::tape::{self, Neck};
use crate::Sex;
use geom::{TriMesh, V3};

/// Mean distance of the shoulder point from the median plane and mean height of the back neck point, over stature
/// [Gordon 2014].
const SHOULDER: f64 = 0.1148;
const CERVICALE: f64 = 0.8617;

/// Fall per distance at which the line over the shoulder turns into the arm.
const TURN: f64 = 0.90;

/// Distance from the median plane at which the height of the trapezius is read, over stature.
const TRAPEZIUS: f64 = 0.07;

/// How far outside the model bodies a mark still counts: the shares of stature between which shoulder point and nape lie.
const SHOULDERS: [f64; 2] = [0.085, 0.150];
const NAPES: [f64; 2] = [0.835, 0.890];

/// What is left of the error on bodies with and without the marks, over stature.
const SEEN: [f64; 2] = [0.0028, 0.0034];
const UNSEEN: [f64; 2] = [0.0100, 0.0070];

/// What the tape needs of the upper body, with how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Upper {
    /// Shoulder points, right and left.
    pub shoulder: [V3; 2],
    pub back_neck: V3,
    /// Standard deviations of a shoulder point's distance from the median plane, and of the height of the back neck
    /// point, metres.
    pub sd: [f64; 2],
}

/// The frame in which an upper body is read.
pub(super) struct Frame<'a> {
    /// The mesh above the chest, and the whole of it.
    pub upper: &'a TriMesh,
    pub mesh: &'a TriMesh,
    pub floor: f64,
    pub stature: f64,
    pub middle: f64,
    pub waist: f64,
    pub neck: &'a Neck,
    pub sex: Sex,
}

/// Marks of one side, over stature: where the shoulder turns, the armpit, the outward fall of the arm, the height of the trapezius.
struct Marks {
    turn: f64,
    armpit: V3,
    slope: f64,
    trapezius: f64,
}

impl Frame<'_> {
    /// Shoulder points and nape; `None` where the skin has neither shoulders nor a neck.
    pub fn find(&self) -> Option<Upper> {
        let right = self.marks(self.mesh);
        let mirrored = landmarks::mirrored(self.mesh, self.middle);
        let left = self.marks(&mirrored);
        let seen = right.is_some() && left.is_some();
        let sd = if seen { SEEN } else { UNSEEN }.map(|share| share * self.stature);
        let x = [&right, &left].map(|marks| self.out(marks.as_ref()));
        let top = |x: f64| shoulder_top(self.upper, self.middle + x, self.at(0.86));
        let napes: Vec<f64> = [&right, &left].into_iter().flatten().map(|marks| self.nape(marks)).collect();
        let nape = if napes.is_empty() { CERVICALE } else { napes.iter().sum::<f64>() / napes.len() as f64 };
        let back_neck = median_point(self.upper, self.at(nape), self.middle, Side::Back)?;
        Some(Upper { shoulder: [top(x[0])?, top(-x[1])?], back_neck, sd })
    }

    fn at(&self, share: f64) -> f64 {
        self.floor + share * self.stature
    }

    /// Distance of the shoulder point from the median plane, metres.
    fn out(&self, marks: Option<&Marks>) -> f64 {
        let woman = f64::from(u8::from(self.sex == Sex::Female));
        let share = marks.map_or(SHOULDER, |at| {
            0.0203 + 0.6518 * at.turn + 0.3599 * at.armpit.x - 0.0272 * at.slope + 0.0030 * woman
        });
        share.clamp(SHOULDERS[0], SHOULDERS[1]) * self.stature
    }

    /// Height of the nape over stature.
    fn nape(&self, marks: &Marks) -> f64 {
        let neck = (self.neck.height - self.floor) / self.stature;
        let share = 0.0270 + 0.151 * marks.trapezius + 0.122 * marks.armpit.z + 0.706 * neck;
        share.clamp(NAPES[0], NAPES[1])
    }

    /// The marks of the right side of a mesh; `None` where the arm is not apart.
    fn marks(&self, mesh: &TriMesh) -> Option<Marks> {
        let h = self.stature;
        let upper = &tape::above(mesh, self.at(0.7));
        let top = |x: f64| shoulder_top(upper, self.middle + x, self.at(0.86));
        let usual = top(SHOULDER * h)?;
        let armpit = landmarks::armpit(mesh, self.waist, usual.z, self.middle)?;
        let arm = Arm::trace(mesh, usual, armpit, h)?;
        let along = arm.at(0.25).1;
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
