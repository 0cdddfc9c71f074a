//! Pieces set upright: CAD programs draw them with the grain along x, on their side or their head.
//!
//! Simulators and measures take a piece with what is worn above drawn above. A piece that stands upright already is left as it is, to the
//! bit.

use std::f64::consts::FRAC_PI_2;

use super::StylePiece;
use crate::propose;

/// Greatest angle between the grain and an axis at which a piece is taken to be drawn along the axes, rad. Grain lines are drawn by
/// hand, and gores have theirs down the middle while they are drawn by a side.
const ALONG_RAD: f64 = 0.26;
/// How much better a piece must fit as drawn for its grain not to be set along an axis: a piece cut on the bias does.
const BIAS: f64 = 0.03;

/// Sets a piece upright by its role, its outline and its grain.
pub(super) fn set_upright(piece: &mut StylePiece) {
    let fit_as_drawn = propose::pose(piece).map(|pose| (pose.quarter_turns, pose.score));
    let off_rad = off_axis_rad(piece);
    // Straightened by the grain first, where that lies aslant; a piece that is cut on the bias is drawn upright all the same.
    let mut best: Option<(f64, f64)> = fit_as_drawn.map(|(quarters, score)| (FRAC_PI_2 * quarters as f64, score));
    if off_rad.abs() > ALONG_RAD {
        let mut straight = piece.clone();
        straight.turn(-off_rad);
        if let Some(pose) = propose::pose(&straight)
            && best.is_none_or(|(_, score)| pose.score > score - BIAS)
        {
            best = Some((FRAC_PI_2 * pose.quarter_turns as f64 - off_rad, pose.score));
        }
    }
    if let Some((turn, _)) = best.filter(|(turn, _)| *turn != 0.0) {
        piece.turn(turn);
    }
}

/// Angle of the grain from the nearest axis, within 45 degrees either way, rad.
fn off_axis_rad(piece: &StylePiece) -> f64 {
    let angle = piece.grain.y.atan2(piece.grain.x);
    angle - (angle / FRAC_PI_2).round() * FRAC_PI_2
}
