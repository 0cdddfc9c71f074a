//! The solver: one proximal Newton step at a time towards static equilibrium.

pub mod part;
pub mod proximal;
pub mod system;

pub use proximal::{StepInfo, StepParams, Stepper};
pub use system::System;

#[cfg(test)]
mod tests;
