//! Contact and friction: of cloth with the body, and of cloth with itself.

mod areas;
mod barrier;
pub mod body;
mod bounds;
pub mod broad_phase;
mod ccd;
pub mod cloth;
pub mod distance;
pub mod friction;
pub mod grid;
pub mod intersections;
mod normal_cones;
mod penalty;
mod point;
mod rub;
pub mod skin;
mod untangle;

pub use areas::contact_areas;
pub use body::BodyContact;
pub use cloth::{ClothContact, ClothContactParams};
pub use intersections::{Intersection, intersections};
pub use penalty::ContactParams;
pub use skin::Skin;

pub(crate) fn constants() -> Vec<Constant> {
    [
        barrier::CONSTANTS,
        body::CONSTANTS,
        bounds::CONSTANTS,
        broad_phase::CONSTANTS,
        ccd::CONSTANTS,
        cloth::CONSTANTS,
        friction::CONSTANTS,
        grid::CONSTANTS,
        intersections::CONSTANTS,
        normal_cones::CONSTANTS,
        rub::CONSTANTS,
        skin::CONSTANTS,
        untangle::CONSTANTS,
    ]
    .concat()
}

#[cfg(test)]
mod tests;

use geom::constants::Constant;
