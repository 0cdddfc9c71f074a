//! Indexed triangle meshes.

use super::V3;

/// A triangle mesh; triangles are counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TriMesh {
    /// Vertex positions, metres.
    pub positions: Vec<V3>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[usize; 3]>,
}

impl TriMesh {
    /// Twice-area-weighted normals of the triangles (not normalised).
    #[must_use]
    pub fn triangle_normals(&self) -> Vec<V3> {
        let corner = |i: usize| self.positions[i];
        self.triangles.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(&(corner(c) - corner(a)))).collect()
    }

    /// Unit vertex normals, weighted by triangle area; zero where no triangle touches a vertex.
    #[must_use]
    pub fn vertex_normals(&self) -> Vec<V3> {
        let mut normals = vec![V3::zeros(); self.positions.len()];
        for (triangle, normal) in self.triangles.iter().zip(self.triangle_normals()) {
            for &vertex in triangle {
                normals[vertex] += normal;
            }
        }
        normals.into_iter().map(|n| n.try_normalize(0.0).unwrap_or_else(V3::zeros)).collect()
    }

    /// Componentwise least and greatest corner of the bounding box; `None` for an empty mesh.
    #[must_use]
    pub fn bounds(&self) -> Option<(V3, V3)> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p))))
    }
}
