//! What a user can do, and which key does it.

pub mod action;
pub mod binding;
pub mod file;
pub mod screen;
pub mod table;
