//! A dressed body moved from one pose into another, carrying its garment along.

use body::{Body, Pose};
use pattern::Garment;
use sim::fem::carry::{Motion, Worn};
use sim::{Drape, Fabric, Monitor};
use spec::Parameters;
use spec::versions::FIELD_SPACING_M;
use store::{InOrigin, Origin, Result, StudyError};

pub(crate) struct Carry<'a> {
    /// Body in the pose in which it is built or scanned.
    pub upright: &'a Body,
    /// Pose of the drape, and pose to reach.
    pub poses: [Pose; 2],
    /// Finest mesh, on which the drape is.
    pub garment: &'a Garment,
    pub fabric: &'a Fabric,
    pub drape: &'a Drape,
    /// Parameters of FEM-GS that differ from their defaults.
    pub parameters: &'a Parameters,
}

pub(crate) struct Carried {
    /// All poses on the way.
    pub bodies: Vec<Body>,
    /// Drape on the last of these bodies.
    pub drape: Drape,
}

impl Carry<'_> {
    pub fn run(&self, monitor: &mut dyn Monitor) -> Result<Carried> {
        let [from, to] = self.poses;
        let bodies = body::way(self.upright, from, to, sim::fem::carry::TURN_DEG).origin(Origin::Body)?;
        let motion = Motion { bodies: &bodies, spacing_m: FIELD_SPACING_M };
        let worn = Worn { garment: self.garment, fabric: self.fabric, drape: self.drape };
        let carried = sim::fem::carry::carry(motion, worn, &self.parameters.fem()?, monitor);
        Ok(Carried { drape: carried.map_err(StudyError::sim)?, bodies })
    }
}
