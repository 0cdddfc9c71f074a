//! The search for parts of a cloth that are near each other and share no vertex.

use super::grid::BoxGrid;
use super::nearest::Primitives;
use super::tangle::edges_of;
use crate::geom::V3;
use crate::geom::triangle::sorted;
use crate::sim::solver::PairList;

/// The cloth as the search sees it.
pub struct Neighbours<'a> {
    triangles: &'a [[usize; 3]],
    edges: PairList,
    /// One of the vertices that a vertex is sewn to, the same for all of them.
    joined: Vec<usize>,
}

impl<'a> Neighbours<'a> {
    /// Of `vertices` vertices.
    #[must_use]
    pub fn new(triangles: &'a [[usize; 3]], vertices: usize) -> Self {
        Self { triangles, edges: edges_of(triangles), joined: (0..vertices).collect() }
    }

    /// Takes the two of each `sewn` pair for one vertex.
    pub fn join(&mut self, sewn: impl Iterator<Item = [usize; 2]>) {
        for [a, b] in sewn {
            let (kept, gone) = (self.joined[a], self.joined[b]);
            self.joined.iter_mut().filter(|v| **v == gone).for_each(|v| *v = kept);
        }
    }

    /// The cloth's edges.
    #[must_use]
    pub fn edges(&self) -> &[[usize; 2]] {
        self.edges.pairs()
    }

    /// The cloth's triangles.
    #[must_use]
    pub fn triangles(&self) -> &'a [[usize; 3]] {
        self.triangles
    }

    /// Takes each pair whose boxes are within `reach` of each other; all that are within it are among them.
    pub fn each_within(&self, x: &[V3], reach: f64, mut take: impl FnMut(Primitives)) {
        self.vertex_triangle_pairs(x, reach, &mut take);
        self.edge_edge_pairs(x, reach, &mut take);
    }

    fn vertex_triangle_pairs(&self, x: &[V3], reach: f64, take: &mut impl FnMut(Primitives)) {
        let grid = BoxGrid::new(x, self.triangles, reach, 0.0, (2.0 * reach).max(CELL_M));
        for v in 0..x.len() {
            for t in grid.near([&x[v]]) {
                let triangle = self.triangles[t];
                if self.apart(&[v], &triangle) {
                    let [a, b, c] = sorted(triangle);
                    take(Primitives::VertexTriangle([v, a, b, c]));
                }
            }
        }
    }

    fn edge_edge_pairs(&self, x: &[V3], reach: f64, take: &mut impl FnMut(Primitives)) {
        let edges = self.edges.pairs();
        let longest = edges.iter().map(|&[a, b]| (x[a] - x[b]).norm()).fold(0.0, f64::max);
        let grid = BoxGrid::new(x, edges, reach, 0.5 * longest, 2.0 * reach + longest);
        for (e, &[a, b]) in edges.iter().enumerate() {
            for f in grid.near([&x[a], &x[b]]).filter(|&f| f > e) {
                let [c, d] = edges[f];
                if self.apart(&[a, b], &[c, d]) {
                    take(Primitives::EdgeEdge([a, b, c, d]));
                }
            }
        }
    }

    /// Whether the two sides have no vertex in common.
    fn apart(&self, one: &[usize], other: &[usize]) -> bool {
        one.iter().all(|&v| other.iter().all(|&w| self.joined[v] != self.joined[w]))
    }
}

/// Least cell of the grid, m: smaller ones hold each triangle many times.
const CELL_M: f64 = 0.02;
