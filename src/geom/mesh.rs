//! Indexed triangle meshes.

use std::collections::BTreeMap;

use super::V3;

/// Edges of only one triangle, each as `[lesser, greater]` vertex index, sorted.
pub fn free_edges(triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let mut uses: BTreeMap<[usize; 2], u32> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    uses.into_iter().filter(|(_, count)| *count == 1).map(|(ends, _)| ends).collect()
}

/// Mesh with triangles counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TriMesh {
    pub positions: Vec<V3>,
    pub triangles: Vec<[usize; 3]>,
}

impl TriMesh {
    /// Normals with twice the triangles' areas as lengths, m2.
    pub fn triangle_normals(&self) -> Vec<V3> {
        let corner = |i: usize| self.positions[i];
        self.triangles.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(&(corner(c) - corner(a)))).collect()
    }

    /// Unit means of the adjacent triangle normals, weighted by area. Zero for a vertex without triangles.
    pub fn vertex_normals(&self) -> Vec<V3> {
        let mut normals = vec![V3::zeros(); self.positions.len()];
        for (triangle, normal) in self.triangles.iter().zip(self.triangle_normals()) {
            for &vertex in triangle {
                normals[vertex] += normal;
            }
        }
        normals.into_iter().map(|n| n.try_normalize(0.0).unwrap_or_else(V3::zeros)).collect()
    }

    /// Least and greatest corner of the axis-aligned bounding box. `None` for an empty mesh.
    pub fn bounds(&self) -> Option<(V3, V3)> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p))))
    }

    /// Volume of a closed mesh by the divergence theorem, m3.
    pub fn volume(&self) -> f64 {
        let corner = |i: usize| self.positions[i];
        self.triangles.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c)))).sum::<f64>() / 6.0
    }

    /// m2.
    pub fn area(&self) -> f64 {
        self.triangle_normals().iter().map(V3::norm).sum::<f64>() / 2.0
    }

    /// Mesh of the triangles with at least one vertex for which `keep` is true. Vertices and triangles keep their
    /// order, so the mesh gives the same section by any plane that meets no other triangle.
    pub fn part(&self, keep: impl Fn(V3) -> bool) -> Self {
        let kept: Vec<bool> = self.positions.iter().map(|&p| keep(p)).collect();
        let chosen = |triangle: &&[usize; 3]| triangle.iter().any(|&vertex| kept[vertex]);
        let mut triangles: Vec<[usize; 3]> = self.triangles.iter().filter(chosen).copied().collect();
        let mut used = vec![false; self.positions.len()];
        for &vertex in triangles.iter().flatten() {
            used[vertex] = true;
        }
        let mut positions = Vec::new();
        let mut renumbered = vec![0; used.len()];
        for (vertex, _) in used.iter().enumerate().filter(|(_, used)| **used) {
            renumbered[vertex] = positions.len();
            positions.push(self.positions[vertex]);
        }
        for vertex in triangles.iter_mut().flatten() {
            *vertex = renumbered[*vertex];
        }
        Self { positions, triangles }
    }

    /// Undirected edges, each once as `[lesser, greater]` vertex index, sorted.
    pub fn edges(&self) -> Vec<[usize; 2]> {
        let mut edges: Vec<[usize; 2]> = self.directed_edges().into_iter().map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// True if every directed edge occurs once, and so does its reverse: closed, consistently oriented, without
    /// branching edges.
    pub fn is_closed_manifold(&self) -> bool {
        let mut directed = self.directed_edges();
        directed.sort_unstable();
        let once = directed.windows(2).all(|pair| pair[0] != pair[1]);
        let paired = directed.iter().all(|&[a, b]| a != b && directed.binary_search(&[b, a]).is_ok());
        once && paired && !self.triangles.is_empty()
    }

    fn directed_edges(&self) -> Vec<[usize; 2]> {
        self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> TriMesh {
        let positions = vec![V3::zeros(), V3::x(), V3::y(), V3::z()];
        TriMesh { positions, triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] }
    }

    #[test]
    fn a_tetrahedron_is_measured() {
        let mesh = tetrahedron();
        assert!(mesh.is_closed_manifold());
        assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-15);
        assert!((mesh.area() - (1.5 + 3.0_f64.sqrt() / 2.0)).abs() < 1e-15);
        assert_eq!(mesh.edges().len(), 6);
    }

    #[test]
    fn a_part_is_a_mesh_of_its_own() {
        let part = tetrahedron().part(|p| p.z > 0.5);
        assert_eq!((part.positions.len(), part.triangles.len()), (4, 3));
        let mut lifted = tetrahedron();
        lifted.triangles.retain(|triangle| triangle.contains(&0));
        let part = lifted.part(|p| p == V3::z());
        assert_eq!(part.triangles, [[0, 1, 3], [0, 3, 2]]);
        assert!(tetrahedron().part(|_| false).positions.is_empty());
    }

    #[test]
    fn holes_flips_and_branches_are_seen() {
        let check = |change: &dyn Fn(&mut TriMesh)| {
            let mut mesh = tetrahedron();
            change(&mut mesh);
            assert!(!mesh.is_closed_manifold());
        };
        check(&|mesh| mesh.triangles.clear());
        check(&|mesh| mesh.triangles.truncate(3));
        check(&|mesh| mesh.triangles[0].reverse());
        check(&|mesh| mesh.triangles.push([0, 2, 1]));
    }
}
