//! Exact signed distance to a closed triangle mesh, by parry's bounding volume hierarchy and pseudo-normals.

use parry3d::query::PointQuery;
use parry3d::shape::{TriMesh as ParryMesh, TriMeshFlags};

use super::{TriMesh, V3};

/// A closed surface prepared for distance queries.
pub struct Surface {
    mesh: ParryMesh,
}

/// The mesh cannot bound a solid.
#[derive(Debug, thiserror::Error)]
#[error("the surface cannot be used for distances: {0}")]
pub struct SurfaceError(String);

impl Surface {
    /// Prepares a closed, outward-oriented mesh.
    ///
    /// # Errors
    /// When the mesh is empty or its topology is not that of an oriented surface.
    pub fn new(mesh: &TriMesh) -> Result<Self, SurfaceError> {
        let vertices = mesh.positions.iter().map(to_parry).collect();
        let index = |i: usize| u32::try_from(i).map_err(|_| SurfaceError("more than 2^32 vertices".into()));
        let mut triangles = Vec::with_capacity(mesh.triangles.len());
        for &[a, b, c] in &mesh.triangles {
            triangles.push([index(a)?, index(b)?, index(c)?]);
        }
        ParryMesh::with_flags(vertices, triangles, TriMeshFlags::ORIENTED)
            .map(|mesh| Self { mesh })
            .map_err(|e| SurfaceError(e.to_string()))
    }

    /// Distance to the surface, m; negative inside.
    #[must_use]
    pub fn signed_distance(&self, point: &V3) -> f64 {
        let point = to_parry(point);
        let projection = self.mesh.project_local_point(point, false);
        let distance = f64::from((projection.point - point).length());
        if projection.is_inside { -distance } else { distance }
    }
}

#[allow(clippy::cast_possible_truncation)]
fn to_parry(p: &V3) -> parry3d::math::Vector {
    parry3d::math::Vector::new(p.x as f32, p.y as f32, p.z as f32)
}
