//! Shape of a person: sections, trunk and limbs lofted through these, and the skin.

pub mod atlas;
pub mod bend;
pub mod field;
pub mod figure;
mod interpolate;
pub mod limbs;
pub mod loft;
pub mod surface;
