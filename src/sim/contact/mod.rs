//! Contact: cloth with body, cloth with itself.

mod advance;
mod areas;
mod barrier;
pub mod body;
mod bounds;
pub mod cloth;
mod clusters;
pub mod grid;
mod knots;
pub mod nearest;
mod point;
mod pressure;
pub mod search;
pub mod skin;
pub mod tangle;

pub use areas::contact_areas;
pub use body::BodyContact;
pub use cloth::{ClothContact, ClothContactParams};
pub use pressure::ContactParams;
pub use skin::Skin;
pub use tangle::{Crossing, crossings};

#[cfg(test)]
mod tests;
