//! The solver: one proximal Newton step at a time towards static equilibrium.

pub mod blocks;
pub mod factor;
pub mod lanes;
pub mod linear;
pub mod machine;
pub mod operator;
mod packed;
pub mod part;
pub mod patches;
pub mod pcg;
pub mod proximal;
pub mod quad;
pub mod rows;
pub mod system;

pub use linear::LinearSolver;
pub use operator::{Contact4, Operator, PairList};
pub use proximal::{StepInfo, StepParams, Stepper};
pub use system::System;

#[cfg(test)]
mod tests;
