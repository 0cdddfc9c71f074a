//! Men's trousers, drafted from six lengths per size: a front and a back for each leg, without darts and waistband. The
//! published numbers leave the constants open.
//!
//! A leg piece is drawn with the crease on `u = 0`, the outseam on `-u` and the hem at `v = 0`: the right front as seen
//! from outside. The right back is the mirror image of such a drawing.

use super::Draft;
use super::marks::{DOUBLE_NOTCH_M, mirrored, mirrored_notch, net, notches_along};
use crate::curve::{bezier, bisect, length};
use crate::piece::Piece;
use geom::V2;
use geom::units::from_mm;

const HIP_OVER_WAIST_M: f64 = 0.040;
/// Difference in width at hem, knee, hip and waist.
const BACK_OVER_FRONT_M: f64 = 0.020;
const HIP_ABOVE_CROTCH_M: f64 = 0.075;
/// Distance of the leg's edge from the crease at the knee less that at the hem.
const KNEE_FLARE_M: f64 = 0.010;
/// Height of the knee above the middle of the inseam.
const KNEE_ABOVE_MIDDLE_M: f64 = 0.045;

/// Published lengths `#1` to `#6`, mm [T tables 6-14, 6-17, 6-20].
pub(super) const SIZES: [(&str, [f64; 6]); 3] = [
    ("S", [239.00, 357.53, 719.10, 956.48, 981.48, 441.66]),
    ("M", [239.09, 357.60, 747.49, 984.92, 1001.36, 441.66]),
    ("L", [252.24, 377.71, 788.12, 1037.83, 1031.43, 461.62]),
];

/// Right leg. The left blocks are its mirror images.
pub(super) fn draft(size: &str, lengths_mm: [f64; 6]) -> Draft {
    let [crotch_front, crotch_back, inseam, outseam, waist, hem] = lengths_mm.map(from_mm);
    let hip = waist + HIP_OVER_WAIST_M;
    let plan = |side: f64, crotch: f64, proportions: Proportions| Plan {
        hem: hem / 2.0 + side * BACK_OVER_FRONT_M / 2.0,
        hip: hip / 4.0 + side * BACK_OVER_FRONT_M / 2.0,
        waist: waist / 4.0 + side * BACK_OVER_FRONT_M / 4.0,
        fork: proportions.fork_share * hip,
        crotch,
        inseam,
        outseam,
        proportions,
    };
    let front = plan(-1.0, crotch_front, FRONT);
    // The inseam of the front ends at the crotch line, below the hip line of both pieces.
    let crotch_line = bisect(0.5 * inseam, inseam, |v| length(&front.inseam_to(v)) - inseam);
    let hip_line = crotch_line + HIP_ABOVE_CROTCH_M;
    let front = Leg::solve(&front, crotch_line, hip_line, None);
    let back = plan(1.0, crotch_back, BACK);
    let fork_height = bisect(0.5 * inseam, inseam, |v| length(&back.inseam_to(v)) - inseam);
    let back = Leg::solve(&back, fork_height, hip_line, Some(length(&front.outseam_lower)));
    Draft::new("Mens trousers", size, "TWILL", vec![front.piece("FRONT", &[0.0]), back_piece(&back)])
}

/// Mirror image of the drawing.
fn back_piece(back: &Leg) -> Piece {
    let mut piece = back.piece("BACK", &[0.0, DOUBLE_NOTCH_M]);
    piece.outline = piece.outline.iter().rev().map(|&p| mirrored(p)).collect();
    piece.turn_points = piece.turn_points.iter().rev().map(|&p| mirrored(p)).collect();
    // The first corner is again the lower left one.
    piece.turn_points.rotate_right(2);
    piece.notches = piece.notches.iter().map(|n| mirrored_notch(*n)).collect();
    piece
}

#[derive(Clone, Copy, Debug)]
struct Proportions {
    /// Length of the fork divided by the hip girth.
    fork_share: f64,
    /// Share of the fork by which the piece is shifted towards the outseam, to balance about the crease.
    set_out: f64,
    /// Slant of the centre line from the vertical.
    slant_deg: f64,
    /// Depth of the hollow of the inseam, m.
    hollow: f64,
}

const FRONT: Proportions = Proportions { fork_share: 0.047, set_out: 0.5, slant_deg: 3.0, hollow: 0.006 };
const BACK: Proportions = Proportions { fork_share: 0.115, set_out: 0.46, slant_deg: 5.0, hollow: 0.004 };

/// Lengths in m.
#[derive(Clone, Copy, Debug)]
struct Plan {
    hem: f64,
    hip: f64,
    waist: f64,
    fork: f64,
    crotch: f64,
    inseam: f64,
    outseam: f64,
    proportions: Proportions,
}

impl Plan {
    /// Distance of the outseam from the crease at the hip line, m.
    fn side(&self) -> f64 {
        self.hip / 2.0 + self.proportions.set_out * self.fork
    }

    fn knee(&self) -> V2 {
        V2::new(self.hem / 2.0 + KNEE_FLARE_M, self.inseam / 2.0 + KNEE_ABOVE_MIDDLE_M)
    }

    /// Knee point and next control point of the inseam (`side` 1) or outseam (`side` -1), which continues the lower leg
    /// by a third of the distance to `end`.
    fn on_from_knee(&self, side: f64, end: V2) -> [V2; 2] {
        let knee = V2::new(side * self.knee().x, self.knee().y);
        let hem = V2::new(side * self.hem / 2.0, 0.0);
        [knee, knee + (knee - hem).normalize() * ((end - knee).norm() / 3.0)]
    }

    fn inseam_to(&self, v: f64) -> Vec<V2> {
        let fork = V2::new(self.hip - self.side() + self.fork, v);
        let [knee, above] = self.on_from_knee(1.0, fork);
        let hollow = fork.lerp(&knee, 0.3) - V2::x() * self.proportions.hollow;
        let mut line = vec![V2::new(self.hem / 2.0, 0.0)];
        line.extend(bezier([knee, above, hollow, fork]));
        line
    }

    /// From the hem to the hip line at height `v`, where it is vertical.
    fn outseam_to(&self, v: f64) -> Vec<V2> {
        let hip = V2::new(-self.side(), v);
        let [knee, above] = self.on_from_knee(-1.0, hip);
        let mut line = vec![V2::new(-self.hem / 2.0, 0.0)];
        line.extend(bezier([knee, above, hip - V2::y() * (0.4 * (hip - knee).norm()), hip]));
        line
    }
}

struct Leg {
    /// From hem to fork.
    inseam: Vec<V2>,
    /// From fork to hip line, and from hip line to waist.
    crotch_lower: Vec<V2>,
    crotch_upper: Vec<V2>,
    /// From centre to side.
    waist: Vec<V2>,
    /// From hem to hip line, and from hip line to waist.
    outseam_lower: Vec<V2>,
    outseam_upper: Vec<V2>,
    /// From the hem to the knee notch, m.
    knee_arc: f64,
}

impl Leg {
    /// `outseam_lower` is the length of the outseam below the hip line, if the other piece determines it.
    fn solve(plan: &Plan, fork_height: f64, hip_line: f64, outseam_lower: Option<f64>) -> Self {
        let inseam = plan.inseam_to(fork_height);
        let hip_at_side = outseam_lower.map_or(hip_line, |target| {
            bisect(hip_line - 0.1, hip_line + 0.1, |v| length(&plan.outseam_to(v)) - target)
        });
        let outseam_lower = plan.outseam_to(hip_at_side);
        let fork = inseam[inseam.len() - 1];
        let side = outseam_lower[outseam_lower.len() - 1];
        let slant = plan.proportions.slant_deg.to_radians();
        let upwards = V2::new(-slant.sin(), slant.cos());
        let seat = V2::new(plan.hip - plan.side(), hip_line);
        let rise = seat.y - fork.y;
        // The crotch curve begins at a right angle to the inseam, so that the forks of front and back join without a
        // peak.
        let along_inseam = (fork - inseam[inseam.len() - 2]).normalize();
        let square = V2::new(-along_inseam.y, along_inseam.x);
        let crotch_lower = bezier([fork, fork + square * (0.45 * plan.fork), seat - upwards * (0.66 * rise), seat]);
        let centre = seat + upwards * (plan.crotch - length(&crotch_lower));
        let upper = plan.outseam - length(&outseam_lower);
        let outseam = |inset: f64| {
            let curve = |v: f64| {
                let top = V2::new(side.x + inset, side.y + v);
                bezier([side, side + V2::y() * (v / 3.0), top - V2::new(0.6 * inset, v / 3.0), top])
            };
            curve(bisect(0.5 * upper, upper, |v| length(&curve(v)) - upper))
        };
        let waist = |outseam: &[V2]| {
            let top = outseam[outseam.len() - 1];
            let third = (top - centre).norm() / 3.0;
            let square_to_centre = V2::new(-upwards.y, upwards.x);
            bezier([centre, centre + square_to_centre * third, top + V2::x() * third, top])
        };
        let inset = bisect(-0.05, 0.1, |inset| plan.waist - length(&waist(&outseam(inset))));
        let outseam_upper = outseam(inset);
        Self {
            waist: waist(&outseam_upper),
            crotch_upper: vec![seat, centre],
            knee_arc: length(&inseam[..2]),
            inseam,
            crotch_lower,
            outseam_lower,
            outseam_upper,
        }
    }

    /// Counter-clockwise from the hem at the outseam. `marks` are the crotch notches above the hip line, m.
    fn piece(&self, block: &str, marks: &[f64]) -> Piece {
        let reversed = |curve: &[V2]| -> Vec<V2> { curve.iter().rev().copied().collect() };
        let edges = [
            vec![self.outseam_lower[0], self.inseam[0]],
            self.inseam.clone(),
            self.crotch_lower.clone(),
            self.crotch_upper.clone(),
            self.waist.clone(),
            reversed(&self.outseam_upper),
            reversed(&self.outseam_lower),
        ];
        let outline: Vec<V2> = edges.iter().flat_map(|edge| edge[..edge.len() - 1].to_vec()).collect();
        let mut notches = notches_along(&self.crotch_upper, marks);
        notches.extend(notches_along(&self.inseam, &[self.knee_arc]));
        notches.extend(notches_along(&self.outseam_lower, &[self.knee_arc, length(&self.outseam_lower)]));
        let top = self.crotch_upper[1].y;
        Piece {
            turn_points: edges.iter().map(|edge| edge[0]).collect(),
            notches,
            grain: Some([V2::new(0.0, 0.25 * top), V2::new(0.0, 0.85 * top)]),
            ..net(block, "2", outline)
        }
    }
}
