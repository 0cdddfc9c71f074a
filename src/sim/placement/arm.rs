//! Sleeves: bent to a cylinder about the upper arm's bone, cap towards the shoulder (4.2.5), and below the elbow about
//! the arm.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::body_parts::{Axis, Cylindrical, Form, Hand, arm_bones};
use super::layout::{Joins, Part, Sheet};
use super::limb::{Limb, Station};
use super::trunk::{BACKS, FRONTS};
use geom::{V2, V3};
use pattern::Role;

geom::constants! {
    "placement.arm",
    const SLEEVE_CLEARANCE_M: f64 = 0.012;
    /// Greatest share of a full turn: the underarm seam starts open.
    const SLEEVE_TURN: f64 = 0.95;
    /// Share of its cap on one side of the trunk below which a sleeve piece belongs to the other side.
    const HALF_SLEEVE: f64 = 0.2;
    /// Vertices of a sleeve for each one that counts as its far end.
    const FAR_SHARE: usize = 10;
    /// Greatest distance of an arm's skin from its axis: skin farther away is the trunk's.
    const ARM_RADIUS_M: f64 = 0.1;
    /// Least descent from one joint to the next along the axis for the sleeve to follow it.
    const BENT_BACK_M: f64 = 0.05;
    /// Part of the arm in which its girth is measured, from the shoulder joint: well below the armpit.
    const UPPER_ARM_M: std::ops::Range<f64> = 0.15..0.25;
    /// Half length of the wrist in which its girth is measured.
    const WRIST_M: f64 = 0.02;
}

pub struct Sleeve {
    pub limb: Limb,
    /// Pieces with the angles of their middles, rad.
    pub parts: Vec<(Sheet, f64)>,
    /// Height along the axis of the sheet's 0, m.
    top: f64,
}

impl Sleeve {
    /// Takes the pieces of one arm that are sewn to the trunk: a whole sleeve, or its front and back half. Other sleeve
    /// pieces are placed later by the pieces that they are sewn to.
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
        let radius = (turn / (SLEEVE_TURN * TAU)).max(arm_radius(form, &axis, UPPER_ARM_M) + SLEEVE_CLEARANCE_M);
        let top = form.shoulder_height(hand);
        let width = |height: f64| {
            let rows = parts.iter().filter_map(|(sheet, _)| sheet.row(joins.garment, height - top));
            rows.map(|(low, high)| high - low).sum()
        };
        let limb = arm(form, axis, hand, width, radius);
        Self { limb, parts, top }
    }

    pub fn at(&self, p: V2, middle: f64) -> V3 {
        let height = self.top + p.y;
        let radius = self.limb.station(height).radius;
        self.limb.point(middle + p.x / radius, radius, height)
    }
}

/// Arm from the elbow over the wrist to the tip of the hand, continued straight where it is bent back. Its stations
/// have the initial radii of a sleeve that is `width` wide at a height and has `radius` at the elbow.
fn arm(form: &Form, axis: Axis, hand: Hand, width: impl Fn(f64) -> f64, radius: f64) -> Limb {
    let [_, elbow, wrist] = arm_bones(form.body, hand);
    let elbow = Station { height: axis.coordinates(&elbow).height, beside: V3::zeros(), radius };
    let mut below: Vec<Station> = Vec::new();
    for joint in [Some(wrist), form.tip(hand)].into_iter().flatten() {
        let Cylindrical { height, .. } = axis.coordinates(&joint);
        let above = below.last().copied().unwrap_or(elbow);
        if height < above.height - BENT_BACK_M {
            let beside = joint - axis.point(0.0, 0.0, height);
            let needed = arm_radius(form, &Axis { origin: wrist, ..axis }, -WRIST_M..WRIST_M) + SLEEVE_CLEARANCE_M;
            let radius = (width(height) / (SLEEVE_TURN * TAU)).max(needed).min(above.radius);
            below.push(Station { height, beside, radius });
        }
    }
    Limb::bent(axis, elbow, below)
}

fn far_end(joins: &Joins, piece: usize, cap: V2) -> V2 {
    let mut vertices: Vec<usize> = joins.garment.pieces[piece].vertices.clone().collect();
    vertices.sort_by(|&a, &b| {
        let distance = |v: usize| (joins.garment.rest[v] - cap).norm_squared();
        distance(b).total_cmp(&distance(a))
    });
    let count = (vertices.len() / FAR_SHARE).max(1);
    joins.mean_rest(vertices.into_iter().take(count)).unwrap_or(cap)
}

/// Shifts the second half of a sleeve to the height at which its seams meet those of the first.
fn level(joins: &Joins, parts: &mut [(Sheet, f64)]) {
    let [(one, _), (other, _)] = parts else { return };
    let (a, b) = (one.parts[0], other.parts[0]);
    let pairs = joins.between(a.piece, b.piece);
    let rest = &joins.garment.rest;
    let rise = pairs.iter().map(|pair| a.at(rest[pair[0]]).y - b.at(rest[pair[1]]).y).sum::<f64>();
    other.shift(V2::new(0.0, rise / pairs.len().max(1) as f64));
}

/// Greatest distance of the skin from an arm's axis within a range of depths below its origin, m.
fn arm_radius(form: &Form, axis: &Axis, below: std::ops::Range<f64>) -> f64 {
    let near = form.arms.iter().filter_map(|p| {
        let Cylindrical { radius, height, .. } = axis.coordinates(p);
        (below.contains(&-height) && radius < ARM_RADIUS_M).then_some(radius)
    });
    near.fold(0.0, f64::max)
}
