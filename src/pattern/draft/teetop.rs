//! Women's tee-top, drafted from the same nine lengths per size as the T-shirt.
//!
//! The published numbers leave the constants open.

use super::Draft;
use super::trunk::{FrontNeck, Trunk, TrunkPlan};
use geom::V2;
use geom::units::from_mm;

const BACK_NECK_DROP_M: f64 = 0.030;
const CAP_HEIGHT_SHARE: f64 = 0.78;

/// Published lengths `#1` to `#9`, mm [T tables 6-23, 6-26].
pub(super) const SIZES: [(&str, [f64; 9]); 2] = [
    ("M", [932.81, 295.60, 439.36, 589.39, 454.68, 709.00, 393.21, 67.36, 57.46]),
    ("L", [1012.76, 316.54, 449.36, 599.39, 489.88, 726.40, 392.97, 72.70, 58.34]),
];

/// The sleeve is the right one, and the left is its mirror image.
pub(super) fn draft(size: &str, lengths_mm: [f64; 9]) -> Draft {
    let [hem, opening, centre_front, centre_back, armhole, neck, side, shoulder, sleeve] = lengths_mm.map(from_mm);
    let trunk = Trunk::solve(TrunkPlan {
        lower: vec![V2::new(hem / 4.0, 0.0)],
        underarm: V2::new(hem / 4.0, side),
        centre: [centre_front, centre_back],
        back_neck_drop: BACK_NECK_DROP_M,
        front_neck: FrontNeck::Round,
        neck,
        shoulder,
        armhole,
        armhole_reach: [0.40, 0.38],
        has_sleeve: true,
    });
    let sleeve = trunk.sleeve(CAP_HEIGHT_SHARE, opening, sleeve);
    Draft::new("Womens tee-top", size, "JERSEY", vec![trunk.front("FRONT"), trunk.back("BACK"), sleeve])
}
