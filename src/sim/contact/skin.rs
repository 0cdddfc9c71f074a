//! The exact surface of the body, for queries at which the blurred distance field is too inaccurate.

use geom::surface::SurfaceError;
use geom::winding::winding_number;
use geom::{Surface, TriMesh, V3};

pub struct Skin<'a> {
    mesh: &'a TriMesh,
    surface: Surface,
}

geom::constants! {
    "contact.skin",
    /// Depth up to which the sign of the distance to the nearest feature is trusted. So shallow, a wrong sign does no
    /// harm.
    const SHALLOW_M: f64 = 2e-4;
}

impl<'a> Skin<'a> {
    /// Fails where the mesh encloses no volume.
    pub fn new(mesh: &'a TriMesh) -> Result<Self, SurfaceError> {
        Ok(Self { mesh, surface: Surface::new(mesh)? })
    }

    /// Depth inside, m, by the nearest feature alone; `None` outside. Quick, but on a crumpled mesh that feature's
    /// normal can point the wrong way.
    pub fn quick_depth(&self, p: &V3) -> Option<f64> {
        self.surface.depth(p)
    }

    /// Winding number: slow, but reliable on any mesh.
    pub fn contains(&self, p: &V3) -> bool {
        winding_number(self.mesh, *p) > 0.5
    }

    /// Depth inside, m; `None` outside. Where the distance `field_m` in the field shows the point outside, a greater
    /// depth is checked by the winding number.
    pub fn depth(&self, p: &V3, field_m: f64) -> Option<f64> {
        self.quick_depth(p).filter(|depth| *depth <= SHALLOW_M || field_m <= 0.0 || self.contains(p))
    }
}
