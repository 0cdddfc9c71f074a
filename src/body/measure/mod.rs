//! The tape: finds landmarks and levels on a mesh, and reads girths and lengths there.

pub mod arm;
pub mod confidence;
pub mod figure_tape;
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

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AxisPoint {
    /// Position, m.
    pub place: V3,
    /// Unit direction, away from the trunk.
    pub along: V3,
}
