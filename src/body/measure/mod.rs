//! The tape: landmarks and levels are found on a mesh, and girths and lengths are read there.

pub mod arm;
pub mod confidence;
pub mod girths;
pub mod landmarks;
pub mod lengths;
pub mod neck_base;
mod shoulder;
pub mod sites;
pub mod slices;
pub mod tailor;
pub mod tape;

use geom::V3;

/// A point of a limb's axis, with the direction of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AxisPoint {
    /// Position, metres.
    pub place: V3,
    /// Unit direction, away from the trunk.
    pub along: V3,
}
