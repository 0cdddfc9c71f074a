//! Bodies from files and back: formats, units, and which way is up.

mod align;
pub mod import;
mod stl;
