//! Contact: cloth with body, cloth with itself.

pub mod body;
pub mod cloth;
pub mod grid;

pub use body::{BodyContact, ContactParams};
pub use cloth::{ClothContact, ClothContactParams, crossings};
