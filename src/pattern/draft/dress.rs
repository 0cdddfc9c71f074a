//! Women's dress, drafted from eleven lengths, in one size: a sleeveless bodice down to the hip and a short pegged
//! skirt.
//!
//! The published numbers leave the constants open.

use super::Draft;
use super::marks::{mirrored, mirrored_notch, net, notch, notches_along};
use super::trunk::{FrontNeck, Trunk, TrunkPlan};
use crate::curve::{arc, bisect};
use crate::piece::{Notch, Piece};
use geom::V2;
use geom::units::from_mm;

/// Pattern girth at the underarm.
const BUST_M: f64 = 0.960;
/// Below the side-neck points.
const BACK_NECK_DROP_M: f64 = 0.045;

/// Published lengths `#1` to `#11`, mm [T table 6-29].
pub(super) const SIZES: [(&str, [f64; 11]); 1] =
    [("ONE", [1036.40, 1104.24, 722.84, 437.95, 600.22, 58.41, 768.79, 605.61, 180.44, 179.35, 179.35])];

pub(super) fn draft(size: &str, lengths_mm: [f64; 11]) -> Draft {
    let lengths = lengths_mm.map(from_mm);
    let [hem, seam, centre_front, armhole, neck, shoulder, centre_back, side, skirt_side, skirt_front, skirt_back] =
        lengths;
    let (lower, underarm) = bodice_side(seam / 4.0, side - skirt_side);
    let bodice = Trunk::solve(TrunkPlan {
        lower,
        underarm,
        centre: [centre_front - skirt_front, centre_back - skirt_back],
        back_neck_drop: BACK_NECK_DROP_M,
        front_neck: FrontNeck::Round,
        neck,
        shoulder,
        armhole,
        armhole_reach: [0.5, 0.6],
        has_sleeve: false,
    });
    let skirt = |block: &str, centre: f64| skirt(block, [hem / 4.0, seam / 4.0], centre, skirt_side);
    let pieces = vec![
        bodice.front("BODICE-FRONT"),
        bodice.back("BODICE-BACK"),
        skirt("SKIRT-FRONT", skirt_front),
        skirt("SKIRT-BACK", skirt_back),
    ];
    Draft::new("Womens dress", size, "JERSEY", pieces)
}

/// Half of the lower edge, an arc at right angles to the side seam, and the underarm point.
fn bodice_side(half_seam: f64, side: f64) -> (Vec<V2>, V2) {
    let underarm = |flare: f64| {
        let lower = arc(half_seam, flare);
        lower[lower.len() - 1] + V2::new(-flare.sin(), flare.cos()) * side
    };
    let flare = bisect(1e-3, 0.3, |flare| BUST_M / 4.0 - underarm(flare).x);
    (arc(half_seam, flare), underarm(flare))
}

/// The hem is at `v = 0` on the centre line.
fn skirt(block: &str, [half_hem, half_seam]: [f64; 2], centre: f64, side: f64) -> Piece {
    // An arc with a total turning equal to the slope of the side meets the side at a right angle.
    let hem = arc(half_hem, -(half_seam - half_hem) / centre);
    let top = |angle: f64| -> Vec<V2> { arc(half_seam, -angle).into_iter().map(|p| p + V2::y() * centre).collect() };
    let last = hem.len() - 1;
    let angle = bisect(1e-3, 0.3, |angle| side - (top(angle)[last] - hem[last]).norm());
    let seam = top(angle);
    let left_of = |curve: &[V2]| -> Vec<V2> { curve[1..].iter().map(|&p| mirrored(p)).collect() };
    let mut outline: Vec<V2> = left_of(&hem).into_iter().rev().collect();
    outline.extend(hem.iter().chain(seam.iter().rev()));
    outline.extend(left_of(&seam));
    let mut notches = notches_along(&[hem[last], seam[last]], &[0.5 * side]);
    let other_side: Vec<Notch> = notches.iter().map(|n| mirrored_notch(*n)).collect();
    notches.extend(other_side);
    notches.push(notch(seam[0], 270.0));
    Piece {
        turn_points: vec![mirrored(hem[last]), hem[last], seam[last], mirrored(seam[last])],
        notches,
        grain: Some([V2::new(0.0, 0.2 * centre), V2::new(0.0, 0.8 * centre)]),
        ..net(block, "1", outline)
    }
}
