//! A garment that a body takes along from one pose into another.

use body::{Body, Pose};
use sim::fem::carry::{Motion, Worn};
use sim::{Drape, Monitor};
use spec::Parameters;
use spec::versions::FIELD_SPACING_M;
use store::{InOrigin, Origin, Result, StudyError};

/// Carries a drape from one pose of a body into another: the body in all poses on the way, and the drape in the last.
///
/// # Errors
/// When the body cannot stand in one of them, or what the simulator refuses.
pub(crate) fn carry(
    upright: &Body,
    [from, to]: [Pose; 2],
    worn: Worn,
    parameters: &Parameters,
    monitor: &mut dyn Monitor,
) -> Result<(Vec<Body>, Drape)> {
    let bodies = body::way(upright, from, to, sim::fem::carry::TURN_DEG).origin(Origin::Body)?;
    let motion = Motion { bodies: &bodies, spacing_m: FIELD_SPACING_M };
    let carried = sim::fem::carry::carry(motion, worn, &parameters.fem()?, monitor);
    Ok((bodies, carried.map_err(StudyError::sim)?))
}
