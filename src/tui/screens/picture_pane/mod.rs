//! The pane with the picture of a drape or a body, which several screens have.

pub mod actions;
pub mod draw;
pub mod state;
