//! The simulators, which turn a body and a garment into a drape (GSM in [T 3.4]).
//!
//! [`fem`] and [`hybrid`] never call each other. Both return a [`Drape`], and both use the cloth energies, the contact
//! and the sewing of the modules beside them.

pub mod cloth;
mod constants;
pub mod contact;
pub mod cover;
pub mod distortion;
pub mod drape;
pub mod dressing;
pub mod error;
pub mod fabric;
pub mod fem;
pub mod hands;
pub mod hybrid;
pub mod laboratory;
pub mod levels;
pub mod outfit;
pub mod placement;
pub mod quality;
pub mod sewing;
pub mod sewn;
pub mod solver;
#[cfg(test)]
mod testing;
mod tries;
mod walls;

pub use constants::constants;
pub use distortion::Distortion;
pub use drape::{Drape, Monitor, Progress, Silent, Stage, Staged, Step};
pub use error::SimError;
pub use fabric::Fabric;
