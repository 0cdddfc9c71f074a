//! Tracing of measurement paths on the mesh.

use super::MeshError;
use super::sampling::EdgeSamples;
use crate::garment::{Garment, MaterialLine, MaterialPoint};
use crate::style::{EdgePoint, EdgeRef, PathPart, Style};
use geom::V2;
use geom::polyline::segment_meeting;

/// Distance below which points of a straight path coincide, over its length.
const SAME_SHARE: f64 = 1e-6;
/// Greatest distance between a drawn curve and the mesh boundary, which consists of chords.
const OFF_CURVE_M: f64 = 3e-3;

struct Crossing {
    /// Parameter along the segment, 0 to 1.
    share: f64,
    point: MaterialPoint,
}

/// Traces paths on the mesh of a style.
pub struct Layer<'a> {
    style: &'a Style,
    samples: &'a [Vec<EdgeSamples>],
    boundary: &'a [Vec<Vec<usize>>],
    garment: &'a Garment,
    /// One triangle at each vertex.
    triangle_of: Vec<usize>,
}

impl<'a> Layer<'a> {
    /// `samples` and `boundary` are the arc lengths and garment vertices by piece and edge.
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

    pub fn runs(&self, place: &str, path: &[PathPart]) -> Result<Vec<MaterialLine>, MeshError> {
        path.iter()
            .map(|part| match *part {
                PathPart::Edge(edge) => Ok(self.edge_run(edge)),
                PathPart::Line(ends) => self.line_run(place, ends),
            })
            .collect()
    }

    /// Line from vertex to vertex, with the arc lengths of the drawn curve.
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

    /// Lines whose ends need not be vertices, and so lie a little off the mesh. They end at its boundary and are scaled
    /// to the lengths on the pattern. `None` if a line leaves the cloth between its ends.
    pub fn near_runs(&self, path: &[PathPart]) -> Option<Vec<MaterialLine>> {
        let run = |part: &PathPart| match *part {
            PathPart::Edge(edge) => Some(self.edge_run(edge)),
            PathPart::Line(ends) => self.near_line_run(ends),
        };
        path.iter().map(run).collect()
    }

    fn near_line_run(&self, ends: [EdgePoint; 2]) -> Option<MaterialLine> {
        let [from, to] = ends.map(|end| self.style.place(end));
        let length = (to - from).norm();
        let reach = (to - from) * (OFF_CURVE_M / length);
        let triangles = self.garment.pieces[ends[0].edge.piece].triangles.clone();
        let crossings = self.crossings(triangles.clone(), (from - reach, to + reach));
        let places: Vec<V2> = crossings.iter().map(|crossing| crossing.point.at_rest(&self.garment.rest)).collect();
        let is_near = |place: Option<&V2>, end: V2| place.is_some_and(|p| (p - end).norm() <= OFF_CURVE_M);
        let is_whole = is_near(places.first(), from)
            && is_near(places.last(), to)
            && places.windows(2).all(|ends| self.is_on_cloth(triangles.clone(), &ends[0].lerp(&ends[1], 0.5)));
        let chords: Vec<f64> = places.windows(2).map(|ends| (ends[1] - ends[0]).norm()).collect();
        let found: f64 = chords.iter().sum();
        (is_whole && found > 0.0).then(|| MaterialLine {
            arc_m: chords.into_iter().map(|chord| chord * length / found).collect(),
            points: crossings.into_iter().map(|crossing| crossing.point).collect(),
        })
    }

    /// In order along the segment.
    fn crossings(&self, triangles: std::ops::Range<usize>, segment: (V2, V2)) -> Vec<Crossing> {
        let mut crossings: Vec<Crossing> = Vec::new();
        for &triangle in &self.garment.triangles[triangles] {
            for k in 0..3 {
                let side = (self.garment.rest[triangle[k]], self.garment.rest[triangle[(k + 1) % 3]]);
                if let Some((share, along)) = segment_meeting(segment, side) {
                    let mut weights = [0.0; 3];
                    weights[k] = 1.0 - along;
                    weights[(k + 1) % 3] = along;
                    crossings.push(Crossing { share, point: MaterialPoint { vertices: triangle, weights } });
                }
            }
        }
        crossings.sort_by(|p, q| p.share.total_cmp(&q.share));
        crossings.dedup_by(|later, earlier| later.share - earlier.share < SAME_SHARE);
        crossings
    }

    /// Straight line, divided where it crosses mesh edges.
    fn line_run(&self, place: &str, ends: [EdgePoint; 2]) -> Result<MaterialLine, MeshError> {
        let piece = &self.garment.pieces[ends[0].edge.piece];
        let [from, to] = ends.map(|end| self.style.place(end));
        let length = (to - from).norm();
        // Extends the segment a little, so that rounding does not lose its ends.
        let reach = (to - from) * (0.5 * SAME_SHARE);
        let crossings = self.crossings(piece.triangles.clone(), (from - reach, to + reach));
        let places: Vec<V2> = crossings.iter().map(|crossing| crossing.point.at_rest(&self.garment.rest)).collect();
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
            points: crossings.into_iter().map(|crossing| crossing.point).collect(),
        })
    }

    fn is_on_cloth(&self, mut triangles: std::ops::Range<usize>, point: &V2) -> bool {
        triangles.any(|index| {
            let corners = self.garment.triangles[index].map(|vertex| self.garment.rest[vertex]);
            (0..3).all(|k| (corners[(k + 1) % 3] - corners[k]).perp(&(point - corners[k])) >= -1e-12)
        })
    }
}
