//! Actions, and the keys for them.

pub mod action;
pub mod binding;
pub mod file;
pub mod screen;
pub mod table;
