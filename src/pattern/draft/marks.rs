//! Notches, texts and sizes of drafted pieces.

use crate::piece::{Notch, Piece};
use geom::V2;
use geom::polyline::Polyline;

pub const DOUBLE_NOTCH_M: f64 = 0.010;
const NOTCH_DEPTH_M: f64 = 0.004;

pub fn net(block: &str, quantity: &str, outline: Vec<V2>) -> Piece {
    Piece {
        block: block.to_owned(),
        name: block.to_owned(),
        quantity: Some(quantity.to_owned()),
        outline,
        ..Piece::default()
    }
}

/// Makes every vertex that is no turn point a curve point.
pub fn finished(mut piece: Piece, size: &str, material: &str) -> Piece {
    let texts = [("Material", material), ("Annotation", "NET, NO SEAM ALLOWANCE")];
    piece.texts = texts.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec();
    piece.size = Some(size.to_owned());
    let is_corner = |point: &V2| piece.turn_points.contains(point);
    piece.curve_points = piece.outline.iter().copied().filter(|point| !is_corner(point)).collect();
    piece
}

pub fn notch(at: V2, angle_deg: f64) -> Notch {
    Notch { at, depth_m: Some(NOTCH_DEPTH_M), angle_deg: Some(angle_deg) }
}

/// Notches at arc lengths, cut at right angles to the curve towards the line `u = 0`.
pub fn notches_along(curve: &[V2], arcs: &[f64]) -> Vec<Notch> {
    let Some(line) = Polyline::new(curve.to_vec()) else { return Vec::new() };
    let step = 1e-3;
    let cut = |&arc: &f64| {
        let along = line.at(arc + step) - line.at(arc - step);
        let mut inwards = V2::new(-along.y, along.x);
        if inwards.x * line.at(arc).x > 0.0 {
            inwards = -inwards;
        }
        notch(line.at(arc), inwards.y.atan2(inwards.x).to_degrees().rem_euclid(360.0))
    };
    arcs.iter().map(cut).collect()
}

/// Mirrors a point at the line `u = 0`.
pub fn mirrored(point: V2) -> V2 {
    V2::new(-point.x, point.y)
}

pub fn mirrored_notch(original: Notch) -> Notch {
    Notch {
        at: mirrored(original.at),
        angle_deg: original.angle_deg.map(|angle| (180.0 - angle).rem_euclid(360.0)),
        ..original
    }
}
