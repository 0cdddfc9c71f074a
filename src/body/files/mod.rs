//! Bodies from files and back: formats, units, and which way is up.

mod align;
mod glb;
pub mod import;
mod stl;
