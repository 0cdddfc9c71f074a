//! Exact signed distance to a closed triangle mesh, by parry's bounding volume hierarchy and pseudo-normals.
//!
//! Parry decides the side, and gives the distance up to rounding. Which of two triangles with a common edge it returns,
//! and so the last bits, depends on how the mesh is stored. Here the distance is the least of the distances to all
//! triangles within that distance. Each is computed with its corners in sorted order, so that a mirrored mesh has
//! exactly the same distances.

use parry3d::partitioning::BvhNode;
use parry3d::query::PointQuery;
use parry3d::shape::{TriMesh as ParryMesh, TriMeshFlags};

use super::{TriMesh, V3, triangle};

/// A closed surface prepared for distance queries.
pub struct Surface {
    mesh: ParryMesh,
}

struct Projection {
    is_inside: bool,
    /// Distance from the surface up to rounding.
    about_m: f64,
}

#[derive(Debug, thiserror::Error)]
#[error("the surface cannot be used for distances: {0}")]
pub struct SurfaceError(String);

impl Surface {
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

    /// m, negative inside.
    pub fn signed_distance(&self, point: &V3) -> f64 {
        let Projection { is_inside, about_m } = self.project(point);
        let (distance_m, _) = self.nearest_within(point, about_m);
        if is_inside { -distance_m } else { distance_m }
    }

    /// Depth inside the surface, m. `None` for a point outside, which costs less than its distance.
    pub fn depth(&self, point: &V3) -> Option<f64> {
        let Projection { is_inside, about_m } = self.project(point);
        is_inside.then(|| self.nearest_within(point, about_m).0)
    }

    /// Decides by the pseudo-normal of the nearest feature.
    pub fn is_inside(&self, point: &V3) -> bool {
        self.project(point).is_inside
    }

    fn project(&self, point: &V3) -> Projection {
        let projection = self.mesh.project_local_point(to_parry(point), false);
        let about_m = f64::from((projection.point - to_parry(point)).length());
        Projection { is_inside: projection.is_inside, about_m }
    }

    /// Unsigned distance to the surface, m, and the nearest triangle. `most_m` is an upper bound of the distance up to
    /// rounding. A tighter bound makes the search faster and does not change a bit of the result.
    pub fn nearest_within(&self, point: &V3, most_m: f64) -> (f64, Option<u32>) {
        let p = to_parry(point);
        #[allow(clippy::cast_possible_truncation)]
        let within = most_m as f32 * (1.0 + ROUNDED) + ROUNDED;
        let box_distance = |node: &BvhNode, _: f32| node.aabb().distance_to_local_point(p, true) * (1.0 - ROUNDED);
        let rounded = from_parry(p);
        let triangle_distance = |index: u32, _: f32| Some((self.distance_of(index, &rounded)?, ()));
        let found = self.mesh.bvh().find_best(within, box_distance, triangle_distance);
        found.map_or((most_m, None), |(index, (distance, ()))| (f64::from(distance), Some(index)))
    }

    /// Distance from a triangle of the mesh, m. `None` if there is no such triangle.
    pub fn distance_to(&self, triangle: u32, point: &V3) -> Option<f32> {
        self.distance_of(triangle, &from_parry(to_parry(point)))
    }

    fn distance_of(&self, triangle: u32, p: &V3) -> Option<f32> {
        let corners = triangle::sorted(*self.mesh.indices().get(triangle as usize)?);
        let corners = corners.map(|corner| from_parry(self.mesh.vertices()[corner as usize]));
        let weights = triangle::nearest(p, &corners);
        let gap: V3 = (0..3).map(|k| (p - corners[k]) * weights[k]).sum();
        #[allow(clippy::cast_possible_truncation)]
        Some(gap.norm() as f32)
    }
}

/// Bound on the error of single precision, relative and in m.
const ROUNDED: f32 = 1e-5;

#[allow(clippy::cast_possible_truncation)]
fn to_parry(p: &V3) -> parry3d::math::Vector {
    parry3d::math::Vector::new(p.x as f32, p.y as f32, p.z as f32)
}

fn from_parry(p: parry3d::math::Vector) -> V3 {
    V3::new(f64::from(p.x), f64::from(p.y), f64::from(p.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn a_mirrored_mesh_has_the_same_distances_to_the_bit() {
        let flipped = |p: &V3| V3::new(-p.x, p.y, p.z);
        let bumpy = |p: &V3| p * (1.0 + 0.2 * (17.0 * p.x).sin() * (11.0 * p.y + 3.0 * p.z).cos());
        let sphere = shapes::sphere(0.1, 30);
        let mesh = TriMesh { positions: sphere.positions.iter().map(bumpy).collect(), triangles: sphere.triangles };
        let mirrored = TriMesh {
            positions: mesh.positions.iter().map(flipped).collect(),
            triangles: mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        };
        let [surface, mirror] = [&mesh, &mirrored].map(|mesh| Surface::new(mesh).expect("closed"));
        for p in &mesh.positions {
            // On the surface, just off it, and well inside and outside.
            for q in [*p, p * 1.003, p * 0.5, p * 1.4, p + V3::new(1e-3, -2e-3, 3e-3)] {
                assert_eq!(surface.signed_distance(&q).abs(), mirror.signed_distance(&flipped(&q)).abs(), "{q}");
            }
        }
    }
}
