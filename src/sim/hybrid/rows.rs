//! How much the cloth is stretched round the body: the mean over whole rows of a piece.
//!
//! A piece is drawn upright, so that its rows (the `u` direction) go round trunk or limb. A bust stretches a row in one place and
//! leaves it slack in another; only where the whole row is stretched is the pattern too small.

use super::elastic::Elastic;
use super::sewn::Sewn;
use crate::geom::V3;
use crate::pattern::Garment;

/// Height of a row in the piece's plane, m.
const HEIGHT_M: f64 = 0.02;

/// The rows of a garment's pieces.
pub struct Rows {
    /// Row of each triangle.
    of_triangle: Vec<usize>,
    /// Row and sewn vertex of each garment vertex.
    of_vertex: Vec<(usize, usize)>,
    /// Whether each row and the next are of one piece.
    goes_on: Vec<bool>,
}

impl Rows {
    /// Sorts triangles and vertices into rows.
    #[must_use]
    pub fn new(garment: &Garment, sewn: &Sewn) -> Self {
        let mut rows = Self {
            of_triangle: vec![0; garment.triangles.len()],
            of_vertex: sewn.vertex_of.iter().map(|&v| (0, v)).collect(),
            goes_on: Vec::new(),
        };
        for piece in &garment.pieces {
            let low = garment.rest[piece.vertices.clone()].iter().map(|p| p.y).fold(f64::MAX, f64::min);
            let first = rows.goes_on.len();
            let row = |v: f64| first + ((v - low) / HEIGHT_M).max(0.0) as usize;
            for v in piece.vertices.clone() {
                rows.of_vertex[v].0 = row(garment.rest[v].y);
            }
            for t in piece.triangles.clone() {
                rows.of_triangle[t] = row(garment.triangles[t].iter().map(|&v| garment.rest[v].y).sum::<f64>() / 3.0);
            }
            let last = piece.vertices.clone().map(|v| rows.of_vertex[v].0).max().unwrap_or(first);
            rows.goes_on.resize(last, true);
            rows.goes_on.push(false);
        }
        rows
    }

    /// Mean stretch beyond 1 of the row through each sewn vertex: of the most stretched one where pieces meet.
    #[must_use]
    pub fn stretch(&self, elastic: &Elastic, x: &[V3]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.goes_on.len()];
        for (&row, (stretch, area)) in self.of_triangle.iter().zip(elastic.stretches(x)) {
            sums[row].0 += (stretch[(0, 0)] - 1.0) * area;
            sums[row].1 += area;
        }
        // Each row with its neighbours: single rows are few triangles high.
        let wide = |row: usize| {
            let mut sum = sums[row];
            let mut add = |other: usize| sum = (sum.0 + sums[other].0, sum.1 + sums[other].1);
            if self.goes_on[row] {
                add(row + 1);
            }
            if row > 0 && self.goes_on[row - 1] {
                add(row - 1);
            }
            sum.0 / sum.1.max(f64::MIN_POSITIVE)
        };
        let means: Vec<f64> = (0..sums.len()).map(wide).collect();
        let mut greatest = vec![f64::MIN; x.len()];
        for &(row, v) in &self.of_vertex {
            greatest[v] = greatest[v].max(means[row]);
        }
        greatest
    }
}
