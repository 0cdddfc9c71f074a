//! A dressed body moved from one pose into another, with the garment carried along.

use body::{Body, Pose};
use pattern::Garment;
use sim::{Drape, Fabric, Monitor};
use spec::Parameters;
use spec::versions::FIELD_SPACING_M;
use store::{InOrigin, Origin, Result, StudyError};

/// Carries a drape from one pose of a body into another. Returns the body in all poses on the way, and the drape in
/// the last.
///
/// # Errors
/// When the body cannot stand in one of the poses, or the simulator refuses.
pub(crate) fn carry(
    upright: &Body,
    [from, to]: [Pose; 2],
    cloth: (&Garment, &Fabric),
    (drape, parameters): (&Drape, &Parameters),
    monitor: &mut dyn Monitor,
) -> Result<(Vec<Body>, Drape)> {
    let bodies = body::way(upright, from, to, sim::fem::carry::TURN_DEG).origin(Origin::Body)?;
    let carried = sim::fem::carry::carry((&bodies, FIELD_SPACING_M), cloth, drape, &parameters.fem()?, monitor);
    Ok((bodies, carried.map_err(StudyError::sim)?))
}
