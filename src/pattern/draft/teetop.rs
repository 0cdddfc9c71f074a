//! The women's tee-top: nine lengths a size, the same nine as the T-shirt's.
//!
//! Decisions where the numbers leave them open:
//! - The neck is **round** [T figure 5-26] and scooped: 150 mm deeper in front than at the back.
//! - Sleeve length is the underarm seam, as in the T-shirt. An opening of 296 mm for an armhole of 455 mm then asks for a
//!   high, narrow cap, which is a women's cap.
//! - Sides are straight and vertical: the thesis prints no waist of it, and the girth at the underarm is the hem girth.
//! - Of size L the tables of the two simulators differ in `#8` and `#9`. Table 6-26 (FEM) is taken, because Table 6-27
//!   holds one subject's column twice and is the less trustworthy of the two.

use super::Draft;
use super::trunk::{FrontNeck, Trunk, TrunkPlan};
use geom::V2;
use geom::units::from_mm;

/// Depth of the back neck below the side-neck points, m.
const BACK_NECK_DROP_M: f64 = 0.030;
/// Cap height over armhole depth.
const CAP_HEIGHT_SHARE: f64 = 0.78;

/// Sizes with their published lengths `#1` to `#9`, mm [T tables 6-23, 6-26].
pub(super) const SIZES: [(&str, [f64; 9]); 2] = [
    ("M", [932.81, 295.60, 439.36, 589.39, 454.68, 709.00, 393.21, 67.36, 57.46]),
    ("L", [1012.76, 316.54, 449.36, 599.39, 489.88, 726.40, 392.97, 72.70, 58.34]),
];

/// Blocks `FRONT`, `BACK` and `SLEEVE` (the right one; the left is its mirror image).
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
