//! The simulators (GSM, thesis 3.4): a body and a garment become a drape.
//!
//! [`fem`](self) and hybrid never call each other; both return a [`Drape`] made from the cloth energies, contact and
//! sewing that are siblings here.

pub mod drape;
pub mod fabric;

pub use drape::{Drape, Monitor, Progress, Simulator, Stage, Step};
pub use fabric::Fabric;
