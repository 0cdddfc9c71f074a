//! Sleeves: bent to a cylinder about the upper arm's bone, cap towards the shoulder (4.2.5).

use std::f64::consts::{FRAC_PI_2, TAU};

use super::form::{Axis, Form, Hand, arm_bones};
use super::sheet::{Joins, Part, Sheet};
use super::trunk::{BACKS, FRONTS};
use crate::geom::{V2, V3};
use crate::pattern::Role;
use crate::sim::fem::hands;

/// Least clearance of a sleeve from the arm before sewing, m.
const SLEEVE_CLEARANCE_M: f64 = 0.012;
/// Most of a full turn that a sleeve is bent over: its underarm seam starts open.
const SLEEVE_TURN: f64 = 0.95;
/// A sleeve piece with less than this share of its cap on one side of the trunk belongs to the other side.
const HALF_SLEEVE: f64 = 0.2;
/// One in so many vertices of a sleeve counts as its far end.
const FAR_SHARE: usize = 10;
/// A joint less than this below the one before is not followed, m.
const BENT_BACK_M: f64 = 0.05;
/// Where along the arm its girth is read, from the shoulder joint, m.
const UPPER_ARM_M: std::ops::Range<f64> = 0.15..0.25;

/// Sleeve pieces of one arm, placed: where the points of each go.
pub struct Sleeve {
    pub axis: Axis,
    /// Pieces with the angle of their middle.
    pub parts: Vec<(Sheet, f64)>,
    radius: f64,
    top: f64,
    /// Middles of the arm below the elbow: height along the axis, and how far beside it, m.
    course: Vec<(f64, V3)>,
}

impl Sleeve {
    /// The pieces of one arm that are sewn to the trunk: a whole sleeve, or its front and back half. Others are left to
    /// follow what they are sewn to.
    pub fn new(form: &Form, joins: &Joins, hand: Hand) -> Self {
        let role = if hand > 0.0 { Role::SleeveRight } else { Role::SleeveLeft };
        let trunk = [joins.worn_as(&FRONTS), joins.worn_as(&BACKS)];
        let mut whole: Option<(usize, Sheet)> = None;
        let mut halves = Vec::new();
        for piece in joins.worn_as(&[role]) {
            let caps = [0, 1].map(|face| joins.to_any(piece, &trunk[face]));
            let sewn = [0, 1].map(|face| joins.length_to_any(piece, &trunk[face]));
            let Some(cap) = joins.mean_rest(caps.iter().flatten().map(|pair| pair[0])) else { continue };
            let up = joins.up(piece, cap - far_end(joins, piece, cap));
            let sheet = Sheet { parts: vec![Part::new(piece, up)] };
            let share = sewn[0] / (sewn[0] + sewn[1]);
            // The angle grows to the front on the right arm and to the back on the left one.
            if share > 1.0 - HALF_SLEEVE {
                halves.push((sheet, hand * FRAC_PI_2));
            } else if share < HALF_SLEEVE {
                halves.push((sheet, -hand * FRAC_PI_2));
            } else {
                let size = joins.garment.pieces[piece].vertices.len();
                if whole.as_ref().is_none_or(|(most, _)| size > *most) {
                    whole = Some((size, sheet));
                }
            }
        }
        let mut parts = whole.map_or(halves, |(_, sheet)| vec![(sheet, 0.0)]);
        let mut turn = 0.0;
        for (sheet, _) in &mut parts {
            let (low, high) = sheet.bounds(joins.garment);
            sheet.shift(V2::new(-0.5 * (low.x + high.x), -high.y));
            turn += high.x - low.x;
        }
        level(joins, &mut parts);
        let axis = form.arm_axis(hand);
        let radius = (turn / (SLEEVE_TURN * TAU)).max(arm_radius(form, &axis) + SLEEVE_CLEARANCE_M);
        Self { axis, parts, radius, top: form.shoulder_height(hand), course: course(form, &axis, hand) }
    }

    /// Where a point of a part's sheet goes.
    pub fn at(&self, p: V2, middle: f64) -> V3 {
        let height = self.top + p.y;
        self.axis.point(middle + p.x / self.radius, self.radius, height) + beside(&self.course, height)
    }
}

/// Where an arm goes from the elbow over the wrist to the end of the hand, by heights along the axis of the upper arm and from
/// it; straight on where the arm is bent back.
fn course(form: &Form, axis: &Axis, hand: Hand) -> Vec<(f64, V3)> {
    let [_, elbow, wrist] = arm_bones(form.body, hand);
    let mut course = vec![(axis.coordinates(&elbow).2, V3::zeros())];
    for joint in [Some(wrist), hands::tip(form.body, hand)].into_iter().flatten() {
        let height = axis.coordinates(&joint).2;
        if course.last().is_some_and(|(above, _)| height < above - BENT_BACK_M) {
            course.push((height, joint - axis.point(0.0, 0.0, height)));
        }
    }
    course
}

/// How far beside its axis an arm is at a height; beyond its ends as there.
fn beside(course: &[(f64, V3)], height: f64) -> V3 {
    let within = course.windows(2).find(|ends| height > ends[1].0);
    match within {
        Some(&[(high, from), (low, to)]) => from.lerp(&to, ((high - height) / (high - low)).clamp(0.0, 1.0)),
        _ => course.last().map_or(V3::zeros(), |(_, at)| *at),
    }
}

/// Middle of what lies farthest from the cap of a sleeve.
fn far_end(joins: &Joins, piece: usize, cap: V2) -> V2 {
    let mut vertices: Vec<usize> = joins.garment.pieces[piece].vertices.clone().collect();
    vertices.sort_by(|&a, &b| {
        let distance = |v: usize| (joins.garment.rest[v] - cap).norm_squared();
        distance(b).total_cmp(&distance(a))
    });
    let count = (vertices.len() / FAR_SHARE).max(1);
    joins.mean_rest(vertices.into_iter().take(count)).unwrap_or(cap)
}

/// Brings the second half of a sleeve to the height at which its seams meet those of the first.
fn level(joins: &Joins, parts: &mut [(Sheet, f64)]) {
    let [(one, _), (other, _)] = parts else { return };
    let (a, b) = (one.parts[0], other.parts[0]);
    let pairs = joins.between(a.piece, b.piece);
    let rest = &joins.garment.rest;
    let rise = pairs.iter().map(|pair| a.at(rest[pair[0]]).y - b.at(rest[pair[1]]).y).sum::<f64>();
    other.shift(V2::new(0.0, rise / pairs.len().max(1) as f64));
}

/// Greatest distance of the skin from the bone of the upper arm, well below the armpit, m.
fn arm_radius(form: &Form, axis: &Axis) -> f64 {
    let near = form.arms.iter().filter_map(|p| {
        let (_, radius, height) = axis.coordinates(p);
        (UPPER_ARM_M.contains(&-height) && radius < 0.1).then_some(radius)
    });
    near.fold(0.0, f64::max)
}
