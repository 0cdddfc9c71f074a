//! Contact: cloth with body, cloth with itself.

pub mod body;

pub use body::{BodyContact, ContactParams};
