//! Hybrid-GS (chapter 5): geometry first, then physics; the pattern's size is kept on any body.

pub mod features;
pub mod form;
pub mod harmonic;
mod locate;
pub mod mapping;
pub mod outline;
pub mod patch;
pub mod path;
pub mod sparse;
