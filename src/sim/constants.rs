//! Collects the constants of the simulators that decide results.

use geom::constants::Constant;

use crate::{cloth, contact, fem, hybrid, laboratory, outfit, placement, solver};
use crate::{cover, distortion, hands, levels, quality, sewing};

/// Constants in a fixed order. A stored result that was computed with other values is out of date.
pub fn constants() -> Vec<Constant> {
    let own = [
        cover::CONSTANTS,
        distortion::CONSTANTS,
        hands::CONSTANTS,
        levels::CONSTANTS,
        quality::CONSTANTS,
        sewing::CONSTANTS,
    ]
    .concat();
    let rooms = [
        linalg::constants(),
        own,
        cloth::constants(),
        contact::constants(),
        solver::constants(),
        fem::constants(),
        placement::constants(),
        hybrid::constants(),
        hybrid::features::constants(),
        laboratory::constants(),
        outfit::constants(),
    ];
    rooms.concat()
}
