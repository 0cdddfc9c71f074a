//! Men's T-shirt, drafted from nine lengths per size.
//!
//! The published numbers leave the constants open.

use super::Draft;
use super::trunk::{FrontNeck, Trunk, TrunkPlan};
use geom::V2;
use geom::units::from_mm;

const BACK_NECK_DROP_M: f64 = 0.022;
const CAP_HEIGHT_SHARE: f64 = 0.56;

pub const TSHIRT_SEAMS: &[u8] = include_bytes!("tshirt.seams.toml");

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TshirtSize {
    /// Hem circumference 974 mm.
    S,
    /// Hem circumference 1,034 mm.
    M,
    /// Hem circumference 1,094 mm.
    L,
}

impl TshirtSize {
    pub const ALL: [Self; 3] = [Self::S, Self::M, Self::L];

    pub fn as_str(self) -> &'static str {
        match self {
            Self::S => "S",
            Self::M => "M",
            Self::L => "L",
        }
    }

    /// Lengths `#1` to `#9` [T tables 6-5, 6-8, 6-11].
    pub fn published_mm(self) -> [f64; 9] {
        match self {
            Self::S => [974.10, 356.53, 550.76, 704.96, 503.71, 560.09, 458.95, 156.67, 119.18],
            Self::M => [1034.10, 366.53, 560.76, 719.96, 527.34, 569.46, 463.95, 166.01, 130.68],
            Self::L => [1094.10, 376.53, 570.76, 734.96, 551.55, 578.89, 468.96, 175.44, 142.55],
        }
    }
}

/// The sleeve is the right one, and the left is its mirror image.
pub fn tshirt(size: TshirtSize) -> Draft {
    let lengths = size.published_mm().map(from_mm);
    let trunk = trunk(&lengths);
    let sleeve = trunk.sleeve(CAP_HEIGHT_SHARE, lengths[1], lengths[8]);
    Draft::new("Mens T-shirt", size.as_str(), "JERSEY", vec![trunk.front("FRONT"), trunk.back("BACK"), sleeve])
}

/// The hem is at `v = 0`.
pub(super) fn trunk(lengths: &[f64; 9]) -> Trunk {
    let [hem, _, centre_front, centre_back, armhole, neck, side, shoulder, _] = *lengths;
    Trunk::solve(TrunkPlan {
        lower: vec![V2::new(hem / 4.0, 0.0)],
        underarm: V2::new(hem / 4.0, side),
        centre: [centre_front, centre_back],
        back_neck_drop: BACK_NECK_DROP_M,
        front_neck: FrontNeck::V,
        neck,
        shoulder,
        armhole,
        armhole_reach: [0.5, 0.6],
        has_sleeve: true,
    })
}
