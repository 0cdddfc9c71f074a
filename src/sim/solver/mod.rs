//! The solver: proximal Newton steps towards static equilibrium.

pub mod active_set;
pub mod braces;
pub mod line_search;
pub mod proximal;
pub mod system;

pub use proximal::{StepInfo, StepParams, Stepper};
pub use system::System;

pub(crate) fn constants() -> Vec<Constant> {
    [active_set::CONSTANTS, braces::CONSTANTS, line_search::CONSTANTS, proximal::CONSTANTS, system::CONSTANTS].concat()
}

#[cfg(test)]
mod tests;

use geom::constants::Constant;
