//! The exact surface of the body, for questions that the blurred field cannot answer.

use geom::surface::SurfaceError;
use geom::winding::winding_number;
use geom::{Surface, TriMesh, V3};

/// A body's surface.
pub struct Skin<'a> {
    mesh: &'a TriMesh,
    surface: Surface,
}

geom::constants! {
    "contact.skin",
    /// Depth up to which the sign of the nearest distance is believed, m: a wrong one does no harm.
    const SHALLOW_M: f64 = 2e-4;
}

impl<'a> Skin<'a> {
    /// Prepares a body's mesh.
    ///
    /// # Errors
    /// When it bounds no solid.
    pub fn new(mesh: &'a TriMesh) -> Result<Self, SurfaceError> {
        Ok(Self { mesh, surface: Surface::new(mesh)? })
    }

    /// Depth of a point inside, m, by the nearest feature alone: quick, and wrong in places on a crumpled mesh, where that feature's
    /// normal points the wrong way.
    #[must_use]
    pub fn quick_depth(&self, p: &V3) -> Option<f64> {
        self.surface.depth(p)
    }

    /// Whether a point is inside, by how often the surface winds round it: slow, and never wrong.
    #[must_use]
    pub fn contains(&self, p: &V3) -> bool {
        winding_number(self.mesh, *p) > 0.5
    }

    /// Depth of a point inside, m; asks twice where `field_m`, the distance in the field, has it outside.
    #[must_use]
    pub fn depth(&self, p: &V3, field_m: f64) -> Option<f64> {
        self.quick_depth(p).filter(|depth| *depth <= SHALLOW_M || field_m <= 0.0 || self.contains(p))
    }
}
