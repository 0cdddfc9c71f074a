//! Meshing of a style into a garment: nearly equilateral triangles, and corresponding vertices on both sides of each
//! seam.

mod paths;
mod sampling;
mod triangulate;

use std::ops::Range;

use self::sampling::{EdgeSample, EdgeSamples, sample};
use self::triangulate::{Triangulation, triangulate};
use super::garment::{FitLevel, Garment, MaterialLine, Measurement, PieceMesh, Reinforcement, SeamMesh};
use super::scale;
use super::style::{PathPart, Style, StylePiece};
use geom::V2;
use geom::polyline::signed_area;
use geom::units::mm;

pub const EDGE_LENGTH_RANGE_M: Range<f64> = 1e-3..0.2;

/// A coat at 5 mm has a quarter of it, and a drape of so many would take more than a day.
const MOST_TRIANGLES: f64 = 400_000.0;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    #[error("edge length {found_mm} mm; accepted: {least_mm} to {greatest_mm} mm")]
    EdgeLength { found_mm: f64, least_mm: f64, greatest_mm: f64 },
    /// More triangles than can be draped.
    #[error(
        "about {thousands} thousand triangles at edge length {edge_length_mm} mm (pieces of {area_m2:.1} m2, the longest {longest_m:.1} m \
         long); accepted: at most 400 thousand; is the unit of the pattern right?"
    )]
    TooFine { edge_length_mm: f64, thousands: u64, area_m2: f64, longest_m: f64 },
    /// Outline at the edge length crosses itself or cannot be triangulated.
    #[error(
        "piece `{piece}` at edge length {edge_length_mm} mm: {reason}; accepted: an outline free of crossings, or a shorter edge length"
    )]
    Piece { piece: String, edge_length_mm: f64, reason: String },
    /// Measurement is a straight line.
    #[error(
        "{place}: the line from {from} to {to} (mm) leaves piece `{piece}`; accepted: points that see each other across the cloth"
    )]
    LineLeavesPiece {
        /// Measurement or fit level.
        place: String,
        piece: String,
        /// First end in the plane of the piece, as text, mm.
        from: String,
        to: String,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct MeshQuality {
    pub min_angle_deg: f64,
    pub min_edge_m: f64,
    pub max_edge_m: f64,
    /// Mean over the edges of all triangles: an inner edge counts twice.
    pub mean_edge_m: f64,
}

impl MeshQuality {
    /// Measured at rest. `None` without triangles.
    pub fn of(garment: &Garment) -> Option<Self> {
        let mut lengths = Vec::new();
        let mut min_angle = f64::INFINITY;
        for &triangle in &garment.triangles {
            let corners = triangle.map(|vertex| garment.rest[vertex]);
            min_angle = min_angle.min(triangulate::min_angle(corners));
            lengths.extend((0..3).map(|k| (corners[(k + 1) % 3] - corners[k]).norm()));
        }
        (!lengths.is_empty()).then(|| Self {
            min_angle_deg: min_angle.to_degrees(),
            min_edge_m: lengths.iter().copied().fold(f64::INFINITY, f64::min),
            max_edge_m: lengths.iter().copied().fold(0.0, f64::max),
            mean_edge_m: lengths.iter().sum::<f64>() / lengths.len() as f64,
        })
    }
}

impl Style {
    /// Refuses too many triangles before any work is done.
    fn check_bounds(&self, edge_length_m: f64) -> Result<(), MeshError> {
        let outlines: Vec<Vec<V2>> = self.pieces.iter().map(StylePiece::outline).collect();
        let area_m2: f64 = outlines.iter().map(|outline| signed_area(outline).abs()).sum();
        // An equilateral triangle of edge h has the area sqrt(3)/4 h^2.
        let triangles = area_m2 / (0.25 * 3.0_f64.sqrt() * edge_length_m * edge_length_m);
        if triangles <= MOST_TRIANGLES {
            return Ok(());
        }
        Err(MeshError::TooFine {
            edge_length_mm: mm(edge_length_m),
            thousands: (1e-3 * triangles) as u64,
            area_m2,
            longest_m: scale::longest_m(outlines.iter().map(|outline| &outline[..])),
        })
    }

    pub fn mesh(&self, edge_length_m: f64) -> Result<Garment, MeshError> {
        if !EDGE_LENGTH_RANGE_M.contains(&edge_length_m) {
            return Err(MeshError::EdgeLength {
                found_mm: mm(edge_length_m),
                least_mm: mm(EDGE_LENGTH_RANGE_M.start),
                greatest_mm: mm(EDGE_LENGTH_RANGE_M.end),
            });
        }
        self.check_bounds(edge_length_m)?;
        let samples = sample(self, edge_length_m);
        let mut assembly = Assembly::default();
        for piece in 0..self.pieces.len() {
            self.add_piece(piece, &samples.edges[piece], edge_length_m, &mut assembly)?;
        }
        let seams = self.seams.iter().zip(&samples.seams).map(|(seam, pairs)| SeamMesh {
            name: seam.name.clone(),
            pairs: pairs.iter().map(|[a, b]| [assembly.vertex(*a), assembly.vertex(*b)]).collect(),
        });
        let seams = seams.collect();
        let mut garment = Garment {
            name: self.name.clone(),
            size: self.size.clone(),
            pieces: assembly.pieces,
            rest: assembly.rest,
            triangles: assembly.triangles,
            seams,
            measurements: Vec::new(),
            fit_levels: Vec::new(),
            reinforcements: Vec::new(),
            edge_length_m,
        };
        let layer = paths::Layer::new(self, &samples.edges, &assembly.boundary, &garment);
        let measurements: Result<Vec<Measurement>, MeshError> = self
            .measurements
            .iter()
            .map(|measurement| {
                Ok(Measurement {
                    no: measurement.no,
                    name: measurement.name.clone(),
                    kind: measurement.kind,
                    is_free_edge: measurement.is_free_edge,
                    l2d_m: measurement.l2d_m,
                    runs: layer.runs(&format!("measurement {}", measurement.no), &measurement.path)?,
                })
            })
            .collect();
        let fit_level = |(level, path): &(String, Vec<PathPart>)| FitLevel {
            level: level.clone(),
            girth_m: self.path_length_m(path),
            // A fit level whose line leaves the piece keeps its girth but has no lines.
            runs: layer.runs(level, path).unwrap_or_default(),
        };
        let fit_levels = self.fit_levels.iter().map(fit_level).collect();
        garment.measurements = measurements?;
        garment.fit_levels = fit_levels;
        garment.reinforcements = self
            .reinforcements
            .iter()
            .map(|r| Reinforcement {
                band: r.band,
                stiffness_n: r.stiffness_n,
                length_factor: r.length_factor,
                vertices: assembly.boundary[r.edge.piece][r.edge.edge].clone(),
            })
            .collect();
        Ok(garment)
    }

    /// `None` for a path that leaves the cloth.
    pub fn laid(&self, garment: &Garment, paths: &[&[PathPart]]) -> Vec<Option<Vec<MaterialLine>>> {
        let samples = sample(self, garment.edge_length_m);
        let boundary: Vec<Vec<Vec<usize>>> = garment
            .pieces
            .iter()
            .zip(&samples.edges)
            .map(|(piece, edges)| boundary(piece.vertices.start, edges))
            .collect();
        let layer = paths::Layer::new(self, &samples.edges, &boundary, garment);
        paths.iter().map(|path| layer.near_runs(path)).collect()
    }

    fn add_piece(
        &self,
        piece: usize,
        edges: &[EdgeSamples],
        edge_length_m: f64,
        all: &mut Assembly,
    ) -> Result<(), MeshError> {
        let drawn = &self.pieces[piece];
        let first_vertex = all.rest.len();
        let mut outline: Vec<V2> = Vec::new();
        for (edge, samples) in drawn.edges.iter().zip(edges) {
            outline.extend(samples.arcs.iter().take(samples.arcs.len() - 1).map(|&arc| edge.line.at(arc)));
        }
        let vertices = boundary(first_vertex, edges);
        let Triangulation { points, triangles } = triangulate(&outline, edge_length_m).map_err(|reason| {
            MeshError::Piece { piece: drawn.id.clone(), edge_length_mm: mm(edge_length_m), reason }
        })?;
        let first_triangle = all.triangles.len();
        all.triangles.extend(triangles.iter().map(|triangle| triangle.map(|vertex| first_vertex + vertex)));
        all.rest.extend(points);
        let named = drawn.edges.iter().zip(&vertices).filter_map(|(edge, v)| Some((edge.name.clone()?, v.clone())));
        all.pieces.push(PieceMesh {
            id: drawn.id.clone(),
            role: drawn.role,
            vertices: first_vertex..all.rest.len(),
            triangles: first_triangle..all.triangles.len(),
            grain: drawn.grain,
            edges: named.collect(),
        });
        all.boundary.push(vertices);
        Ok(())
    }
}

/// Garment vertices of every edge. Boundary vertices come first. The last vertex of an edge is the first of the next.
fn boundary(first_vertex: usize, edges: &[EdgeSamples]) -> Vec<Vec<usize>> {
    let around: usize = edges.iter().map(|samples| samples.arcs.len() - 1).sum();
    let mut start = 0;
    let mut found = Vec::new();
    for samples in edges {
        found.push((0..samples.arcs.len()).map(|k| first_vertex + (start + k) % around).collect());
        start += samples.arcs.len() - 1;
    }
    found
}

#[derive(Default)]
struct Assembly {
    pieces: Vec<PieceMesh>,
    rest: Vec<V2>,
    triangles: Vec<[usize; 3]>,
    boundary: Vec<Vec<Vec<usize>>>,
}

impl Assembly {
    fn vertex(&self, EdgeSample { edge, index }: EdgeSample) -> usize {
        self.boundary[edge.piece][edge.edge][index]
    }
}

#[cfg(test)]
mod tests;
