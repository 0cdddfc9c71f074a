//! Points of the cloth: vertices, midpoints of edges and centroids of triangles. Forces act on them through the
//! vertices.

use geom::V3;
use geom::triangle::sorted;
use linalg::Contact4;

/// Point by barycentric weights of up to three vertices.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// A vertex itself is given three times; of an edge the second end is given twice.
    pub vertices: [usize; 3],
    /// They sum to one.
    pub weights: [f64; 3],
}

impl Point {
    pub fn vertex(vertex: usize) -> Self {
        Self { vertices: [vertex; 3], weights: [1.0, 0.0, 0.0] }
    }

    pub fn between<'m>(edges: &'m [[usize; 2]], triangles: &'m [[usize; 3]]) -> impl Iterator<Item = Self> + 'm {
        let middle = |&[a, b]: &[usize; 2]| Self { vertices: [a, b, b], weights: [0.5, 0.5, 0.0] };
        let centre = |t: &[usize; 3]| Self { vertices: sorted(*t), weights: [1.0 / 3.0; 3] };
        edges.iter().map(middle).chain(triangles.iter().map(centre))
    }

    pub fn at(&self, x: &[V3]) -> V3 {
        let ([a, b, c], [wa, wb, wc]) = (self.vertices, self.weights);
        if wa == 1.0 { x[a] } else { x[a] * wa + x[b] * wb + x[c] * wc }
    }

    pub fn add_force(&self, force: &V3, forces: &mut [V3]) {
        for k in 0..3 {
            forces[self.vertices[k]] += force * self.weights[k];
        }
    }

    /// N/m.
    pub fn coupling(&self, normal: V3, stiffness: f64) -> Contact4 {
        let ([a, b, c], [wa, wb, wc]) = (self.vertices, self.weights);
        Contact4 { vertices: [a, b, c, c], weights: [wa, wb, wc, 0.0], normal, stiffness }
    }
}
