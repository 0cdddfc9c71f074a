//! The laboratory: experiments on cloth with known answers.

use sim::laboratory::bench::{Experiment, Finding};
use store::{InOrigin, Origin, Result};

/// Runs an experiment.
///
/// # Errors
/// Never with the specimens as they are: none has a triangle without area.
pub fn laboratory(experiment: Experiment) -> Result<Vec<Finding>> {
    experiment.run().origin(Origin::Sim)
}
