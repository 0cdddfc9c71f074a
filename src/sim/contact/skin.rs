//! The exact surface of the body, for queries at which the blurred distance field is too inaccurate.

use geom::surface::SurfaceError;
use geom::winding::winding_number;
use geom::{Surface, TriMesh, V3};

/// The surface of a body mesh.
pub struct Skin<'a> {
    mesh: &'a TriMesh,
    surface: Surface,
}

geom::constants! {
    "contact.skin",
    /// Depth up to which the sign of the distance to the nearest feature is trusted, m. At such a depth a wrong sign
    /// does no harm.
    const SHALLOW_M: f64 = 2e-4;
}

impl<'a> Skin<'a> {
    /// Prepares the mesh of a body.
    ///
    /// When it encloses no volume.
    pub fn new(mesh: &'a TriMesh) -> Result<Self, SurfaceError> {
        Ok(Self { mesh, surface: Surface::new(mesh)? })
    }

    /// Depth of a point inside, m, by the nearest feature alone; `None` outside. It is quick. On a crumpled mesh the
    /// normal of that feature can point the wrong way, and the sign is then wrong.
    #[must_use]
    pub fn quick_depth(&self, p: &V3) -> Option<f64> {
        self.surface.depth(p)
    }

    /// True if a point is inside, by the winding number: slow, but reliable on any mesh.
    #[must_use]
    pub fn contains(&self, p: &V3) -> bool {
        winding_number(self.mesh, *p) > 0.5
    }

    /// Depth of a point inside, m; `None` outside. Where the distance `field_m` in the field shows the point outside, a
    /// greater depth is checked by the winding number.
    #[must_use]
    pub fn depth(&self, p: &V3, field_m: f64) -> Option<f64> {
        self.quick_depth(p).filter(|depth| *depth <= SHALLOW_M || field_m <= 0.0 || self.contains(p))
    }
}
