//! Shape of a person: cross-sections, limbs and trunk lofted through them, and the skin over all.

pub mod atlas;
pub mod field;
pub mod figure;
mod interpolate;
pub mod limbs;
pub mod loft;
pub mod surface;
