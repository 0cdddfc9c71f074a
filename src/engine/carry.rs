//! A dressed body moved from one pose into another, with the garment carried along.

use body::{Body, Pose};
use pattern::Garment;
use sim::fem::carry::{Motion, Worn};
use sim::{Drape, Fabric, Monitor};
use spec::Parameters;
use spec::versions::FIELD_SPACING_M;
use store::{InOrigin, Origin, Result, StudyError};

/// A drape that is to be carried into another pose of its body.
pub(crate) struct Carry<'a> {
    /// Body as it stands upright.
    pub upright: &'a Body,
    /// Pose of the drape, and pose to reach.
    pub poses: [Pose; 2],
    /// Mesh of the garment that is draped.
    pub garment: &'a Garment,
    /// Fabric of the garment.
    pub fabric: &'a Fabric,
    /// Drape in the first pose.
    pub drape: &'a Drape,
    /// Parameters of FEM-GS that are not the default ones.
    pub parameters: &'a Parameters,
}

/// A drape that was carried into another pose.
pub(crate) struct Carried {
    /// Body in all poses on the way.
    pub bodies: Vec<Body>,
    /// Drape in the last of them.
    pub drape: Drape,
}

impl Carry<'_> {
    /// Carries the drape along.
    ///
    /// # Errors
    /// When the body cannot stand in one of the poses, or the simulator refuses.
    pub fn run(&self, monitor: &mut dyn Monitor) -> Result<Carried> {
        let [from, to] = self.poses;
        let bodies = body::way(self.upright, from, to, sim::fem::carry::TURN_DEG).origin(Origin::Body)?;
        let motion = Motion { bodies: &bodies, spacing_m: FIELD_SPACING_M };
        let worn = Worn { garment: self.garment, fabric: self.fabric, drape: self.drape };
        let carried = sim::fem::carry::carry(motion, worn, &self.parameters.fem()?, monitor);
        Ok(Carried { drape: carried.map_err(StudyError::sim)?, bodies })
    }
}
