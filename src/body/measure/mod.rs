//! The tape: features and levels found on a mesh, girths and lengths read there.

pub mod arm;
pub mod confidence;
pub mod girths;
pub mod landmarks;
pub mod lengths;
mod shoulder;
pub mod sites;
mod slices;
pub mod tailor;
pub mod tape;
