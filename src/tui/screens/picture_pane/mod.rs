//! The pane with the picture of a drape or a body, shared by several screens.

pub mod actions;
pub mod draw;
pub mod state;
