//! Laying measurement paths on the mesh.

use super::MeshError;
use super::sampling::EdgeSamples;
use crate::garment::{Garment, MaterialLine, MaterialPoint};
use crate::style::{EdgePoint, EdgeRef, PathPart, Style};
use geom::V2;
use geom::polyline::segment_meeting;

/// Points of a straight path closer than this share of its length are one.
const SAME_SHARE: f64 = 1e-6;

/// Lays paths on the mesh of a style.
pub struct Layer<'a> {
    style: &'a Style,
    samples: &'a [Vec<EdgeSamples>],
    boundary: &'a [Vec<Vec<usize>>],
    garment: &'a Garment,
    /// One triangle of each vertex.
    triangle_of: Vec<usize>,
}

impl<'a> Layer<'a> {
    /// `samples` and `boundary` hold arc lengths and garment vertices of every edge of every piece.
    pub fn new(
        style: &'a Style,
        samples: &'a [Vec<EdgeSamples>],
        boundary: &'a [Vec<Vec<usize>>],
        garment: &'a Garment,
    ) -> Self {
        let mut triangle_of = vec![0; garment.rest.len()];
        for (index, triangle) in garment.triangles.iter().enumerate() {
            for &vertex in triangle {
                triangle_of[vertex] = index;
            }
        }
        Self { style, samples, boundary, garment, triangle_of }
    }

    /// The runs of a path; `place` names it in messages.
    ///
    /// # Errors
    /// [`MeshError::LineLeavesPiece`].
    pub fn runs(&self, place: &str, path: &[PathPart]) -> Result<Vec<MaterialLine>, MeshError> {
        path.iter()
            .map(|part| match *part {
                PathPart::Edge(edge) => Ok(self.edge_run(edge)),
                PathPart::Line(ends) => self.line_run(place, ends),
            })
            .collect()
    }

    /// Along an edge, from vertex to vertex, with the arcs of the drawn curve.
    fn edge_run(&self, edge: EdgeRef) -> MaterialLine {
        let arcs = &self.samples[edge.piece][edge.edge].arcs;
        let vertices = &self.boundary[edge.piece][edge.edge];
        MaterialLine {
            points: vertices.iter().map(|&vertex| self.at_vertex(vertex)).collect(),
            arc_m: arcs.windows(2).map(|ends| ends[1] - ends[0]).collect(),
        }
    }

    fn at_vertex(&self, vertex: usize) -> MaterialPoint {
        let vertices = self.garment.triangles[self.triangle_of[vertex]];
        MaterialPoint { vertices, weights: vertices.map(|v| if v == vertex { 1.0 } else { 0.0 }) }
    }

    /// Straight across a piece, from mesh edge to mesh edge.
    fn line_run(&self, place: &str, ends: [EdgePoint; 2]) -> Result<MaterialLine, MeshError> {
        let piece = &self.garment.pieces[ends[0].edge.piece];
        let [from, to] = ends.map(|end| self.style.place(end));
        let length = (to - from).norm();
        let mut crossings: Vec<(f64, MaterialPoint)> = Vec::new();
        for &triangle in &self.garment.triangles[piece.triangles.clone()] {
            for k in 0..3 {
                let side = (self.garment.rest[triangle[k]], self.garment.rest[triangle[(k + 1) % 3]]);
                // A little longer than it is, so that its own end points are found in spite of rounding.
                let reach = (to - from) * (0.5 * SAME_SHARE);
                if let Some((share, along)) = segment_meeting((from - reach, to + reach), side) {
                    let mut weights = [0.0; 3];
                    weights[k] = 1.0 - along;
                    weights[(k + 1) % 3] = along;
                    crossings.push((share, MaterialPoint { vertices: triangle, weights }));
                }
            }
        }
        crossings.sort_by(|p, q| p.0.total_cmp(&q.0));
        crossings.dedup_by(|later, earlier| later.0 - earlier.0 < SAME_SHARE);
        let places: Vec<V2> = crossings.iter().map(|(_, point)| point.at_rest(&self.garment.rest)).collect();
        let is_whole = places.first().is_some_and(|p| (p - from).norm() < 10.0 * SAME_SHARE * length)
            && places.last().is_some_and(|p| (p - to).norm() < 10.0 * SAME_SHARE * length)
            && places.windows(2).all(|ends| self.is_on_cloth(piece.triangles.clone(), &ends[0].lerp(&ends[1], 0.5)));
        if !is_whole {
            let text = |p: V2| format!("({:.1}, {:.1})", p.x * 1e3, p.y * 1e3);
            return Err(MeshError::LineLeavesPiece {
                place: place.to_owned(),
                piece: piece.id.clone(),
                from: text(from),
                to: text(to),
            });
        }
        Ok(MaterialLine {
            arc_m: places.windows(2).map(|ends| (ends[1] - ends[0]).norm()).collect(),
            points: crossings.into_iter().map(|(_, point)| point).collect(),
        })
    }

    fn is_on_cloth(&self, mut triangles: std::ops::Range<usize>, point: &V2) -> bool {
        triangles.any(|index| {
            let corners = self.garment.triangles[index].map(|vertex| self.garment.rest[vertex]);
            (0..3).all(|k| (corners[(k + 1) % 3] - corners[k]).perp(&(point - corners[k])) >= -1e-12)
        })
    }
}
