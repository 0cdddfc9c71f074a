//! Trunk block that T-shirt, tee-top and dress share: neck, shoulder, armhole and side, and the sleeve for it.

use super::marks::{DOUBLE_NOTCH_M, mirrored, mirrored_notch, net, notch, notches_along};
use crate::curve::{bezier, bisect, length};
use crate::piece::{Notch, Piece};
use geom::V2;

pub const SHOULDER_SLOPE_DEG: f64 = 20.0;
/// Difference between the length of the front armhole and the mean of both.
const ARMHOLE_BALANCE_M: f64 = 0.003;
/// From the underarm.
const ARMHOLE_NOTCH_SHARE: f64 = 0.35;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrontNeck {
    /// Begins along its chord, which makes the apex a corner.
    V,
    /// Leaves the centre line at a right angle.
    Round,
}

/// Dimensions of the trunk block, m.
#[derive(Clone, Debug)]
pub struct TrunkPlan {
    /// Half, from the centre line to the side. For a straight edge, only its end.
    pub lower: Vec<V2>,
    pub underarm: V2,
    /// Heights of the neck points at front and back.
    pub centre: [f64; 2],
    /// Below the side-neck points.
    pub back_neck_drop: f64,
    pub front_neck: FrontNeck,
    /// Opening, all round.
    pub neck: f64,
    pub shoulder: f64,
    /// Length, front and back together.
    pub armhole: f64,
    /// Length of the Bezier handle at the shoulder, square to it, as a share of the depth of the armhole, front and
    /// back. A shorter one makes the underarm rounder.
    pub armhole_reach: [f64; 2],
    /// With a sleeve the notches are on the armhole, otherwise on the side.
    pub has_sleeve: bool,
}

/// Half front and half back, on the side `u > 0` of the centre line.
pub struct Trunk {
    plan: TrunkPlan,
    /// Curves from the centre outwards, or from the shoulder downwards.
    pub front_neck: Vec<V2>,
    pub back_neck: Vec<V2>,
    pub front_armhole: Vec<V2>,
    pub back_armhole: Vec<V2>,
}

impl Trunk {
    /// Solves for the neck width that gives the neck opening, and the scoops that give the armhole.
    pub fn solve(plan: TrunkPlan) -> Self {
        let slope = SHOULDER_SLOPE_DEG.to_radians();
        let along_shoulder = V2::new(slope.cos(), -slope.sin());
        // Both necklines and both armholes leave the shoulder line at right angles.
        let down = V2::new(-slope.sin(), -slope.cos());
        let [centre_front, centre_back] = plan.centre.map(|height| V2::new(0.0, height));
        let side_neck = |width: f64| V2::new(width, centre_back.y + plan.back_neck_drop);
        let front_neck = |width: f64| {
            let end = side_neck(width);
            let chord = end - centre_front;
            match plan.front_neck {
                FrontNeck::V => {
                    bezier([centre_front, centre_front + chord / 3.0, end + down * (0.36 * chord.norm()), end])
                }
                FrontNeck::Round => {
                    let level = centre_front + V2::x() * (0.62 * width);
                    bezier([centre_front, level, end + down * (0.58 * chord.y), end])
                }
            }
        };
        let back_neck = |width: f64| {
            let end = side_neck(width);
            let drop = 0.72 * plan.back_neck_drop;
            bezier([centre_back, centre_back + V2::x() * (0.55 * width), end + down * drop, end])
        };
        let width = bisect(0.02, 0.2, |w| 2.0 * (length(&front_neck(w)) + length(&back_neck(w))) - plan.neck);
        let tip = side_neck(width) + along_shoulder * plan.shoulder;
        let depth = tip.y - plan.underarm.y;
        let square = plan.square_to_side();
        let armhole_curve = |reach: f64, target: f64| {
            let curve =
                |inset: f64| bezier([tip, tip + down * (reach * depth), plan.underarm - square * inset, plan.underarm]);
            curve(bisect(0.0, 0.25, |inset| length(&curve(inset)) - target))
        };
        Self {
            front_neck: front_neck(width),
            back_neck: back_neck(width),
            front_armhole: armhole_curve(plan.armhole_reach[0], plan.armhole / 2.0 + ARMHOLE_BALANCE_M),
            back_armhole: armhole_curve(plan.armhole_reach[1], plan.armhole / 2.0 - ARMHOLE_BALANCE_M),
            plan,
        }
    }

    /// Outline from the lower edge up one side, along armhole, shoulder and neck, and down the other side.
    pub fn front(&self, block: &str) -> Piece {
        let mut piece = self.both_halves(block, &self.front_armhole, &self.front_neck, &[0.0]);
        if self.plan.front_neck == FrontNeck::V {
            piece.turn_points.insert(5, self.front_neck[0]);
        }
        piece
    }

    /// Has double notches, and a neck of one smooth curve.
    pub fn back(&self, block: &str) -> Piece {
        let mut piece = self.both_halves(block, &self.back_armhole, &self.back_neck, &[0.0, -DOUBLE_NOTCH_M]);
        piece.notches.push(notch(self.back_neck[0], 270.0));
        piece
    }

    /// `marks` are the distances of the armhole notches from the first of them, m.
    fn both_halves(&self, block: &str, armhole: &[V2], neck: &[V2], marks: &[f64]) -> Piece {
        let (lower, bottom) = (&self.plan.lower, self.plan.bottom());
        let (tip, side_neck) = (armhole[0], neck[neck.len() - 1]);
        let mut right_half = vec![bottom];
        right_half.extend(armhole.iter().rev());
        right_half.extend(neck.iter().rev());
        // The mirrored half runs back down. Both halves share the centre points.
        let left_half = right_half.iter().rev().skip(1).map(|&p| mirrored(p));
        let mut outline: Vec<V2> = lower.iter().rev().filter(|p| p.x > 0.0).map(|&p| mirrored(p)).collect();
        outline.extend(&lower[..lower.len() - 1]);
        outline.extend(right_half.iter().copied().chain(left_half));
        outline.pop();
        let corners = [bottom, self.plan.underarm, tip, side_neck];
        let turn_points =
            [mirrored(bottom)].into_iter().chain(corners).chain(corners[1..].iter().rev().map(|&p| mirrored(p)));
        let mut notches = if self.plan.has_sleeve {
            let first = length(armhole) * (1.0 - ARMHOLE_NOTCH_SHARE);
            notches_along(armhole, &marks.iter().map(|mark| first + mark).collect::<Vec<_>>())
        } else {
            let side = [bottom, self.plan.underarm];
            notches_along(&side, &[0.5 * length(&side)])
        };
        let other_side: Vec<Notch> = notches.iter().map(|n| mirrored_notch(*n)).collect();
        notches.extend(other_side);
        notches.push(notch(V2::zeros(), 90.0));
        Piece {
            turn_points: turn_points.collect(),
            notches,
            grain: Some([V2::new(0.0, 0.08), V2::new(0.0, 0.40)]),
            ..net(block, "1", outline)
        }
    }

    /// Right sleeve with its front half on `+u`. Each half of the cap is as long as its armhole, without ease. The cap
    /// height is `cap_share` times the depth of the armhole.
    pub fn sleeve(&self, cap_share: f64, opening: f64, underarm_seam: f64) -> Piece {
        let height = cap_share * (self.front_armhole[0].y - self.plan.underarm.y);
        let front = cap(height, length(&self.front_armhole));
        let back: Vec<V2> = cap(height, length(&self.back_armhole)).into_iter().map(mirrored).collect();
        let (front_width, back_width) = (front[0].x, -back[0].x);
        let taper = (front_width + back_width - opening) / 2.0;
        let drop = (underarm_seam.powi(2) - taper.powi(2)).sqrt();
        let opening_front = V2::new(front_width - taper, -drop);
        let opening_back = V2::new(taper - back_width, -drop);
        let mut outline = vec![opening_back, opening_front];
        outline.extend(&front);
        outline.extend(back.iter().rev().skip(1));
        let top = V2::new(0.0, height);
        let [front_notch, back_notch] = [&front, &back].map(|curve| length(curve) * ARMHOLE_NOTCH_SHARE);
        let mut notches = notches_along(&front, &[front_notch]);
        notches.extend(notches_along(&back, &[back_notch, back_notch + DOUBLE_NOTCH_M]));
        notches.push(notch(top, 270.0));
        Piece {
            turn_points: vec![opening_back, opening_front, front[0], top, back[0]],
            notches,
            grain: Some([V2::new(0.0, -0.6 * drop), V2::new(0.0, 0.7 * height)]),
            ..net("SLEEVE", "2", outline)
        }
    }
}

impl TrunkPlan {
    /// Lower end of the side.
    fn bottom(&self) -> V2 {
        self.lower[self.lower.len() - 1]
    }

    /// Unit vector outwards.
    fn square_to_side(&self) -> V2 {
        let side = (self.underarm - self.bottom()).normalize();
        V2::new(side.y, -side.x)
    }
}

/// Half of a sleeve cap of length `target`, from the underarm point on `+u` to the top.
fn cap(height: f64, target: f64) -> Vec<V2> {
    let curve = |width: f64| {
        bezier([
            V2::new(width, 0.0),
            V2::new(0.62 * width, 0.06 * height),
            V2::new(0.45 * width, height),
            V2::new(0.0, height),
        ])
    };
    curve(bisect(0.0, target, |width| length(&curve(width)) - target))
}
