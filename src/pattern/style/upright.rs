//! Turning of pieces upright: CAD programs also draw them along x, or upside down.
//!
//! Simulators and measures expect the upper part of a piece on top. A piece that is upright already stays as it is, to
//! the bit.

use std::f64::consts::FRAC_PI_2;

use super::StylePiece;
use crate::propose;

/// Greatest angle between the grain and an axis at which a piece counts as drawn along the axes: 15 degrees. Grain
/// lines are drawn by hand, and that of a gore runs down its middle while the gore is drawn along a side.
const ALONG_RAD: f64 = 0.26;
/// Advantage in score by which a piece as drawn beats the piece set straight by its grain. A piece cut on the bias has
/// a slanted grain and is drawn upright.
const BIAS: f64 = 0.03;

pub(super) fn set_upright(piece: &mut StylePiece) {
    let fit_as_drawn = propose::pose(piece).map(|pose| (pose.quarter_turns, pose.score));
    let off_rad = off_axis_rad(piece);
    // A piece with a slanted grain is also tried with the grain set straight.
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

/// At most 45 degrees in magnitude.
fn off_axis_rad(piece: &StylePiece) -> f64 {
    let angle = piece.grain.y.atan2(piece.grain.x);
    angle - (angle / FRAC_PI_2).round() * FRAC_PI_2
}
