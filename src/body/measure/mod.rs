//! The tape: features and levels found on a mesh, girths and lengths read there.

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
