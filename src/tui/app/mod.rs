//! The update loop: what the workbench does with messages and actions, and the frame around its screens.

mod act;
pub mod frame;
pub mod headless;
pub mod session;
mod update;
