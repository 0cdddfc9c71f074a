//! Corners of an outline, the edges between them, and their mirror images.

use std::collections::BTreeSet;

use super::Edge;
use crate::geom::V2;
use crate::geom::polyline::Polyline;
use crate::pattern::piece::Piece;

/// Distance within which a turn point is taken to lie on a vertex of the outline, m.
const ON_OUTLINE_M: f64 = 0.5e-3;
/// Turn of an outline at which a vertex is a corner where the file marks none, degrees.
const CORNER_TURN_DEG: f64 = 30.0;

/// Outline vertices that are corners, counter-clockwise from the first turn point in the file.
pub(in crate::pattern) fn corner_vertices(piece: &Piece) -> Vec<usize> {
    let outline = piece.seam_outline();
    let nearest = |point: &V2| {
        let distance = |i: &usize| (outline[*i] - point).norm();
        (0..outline.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).filter(|i| distance(i) < ON_OUTLINE_M)
    };
    let marked: Vec<usize> = piece.turn_points.iter().filter_map(nearest).collect();
    let distinct: BTreeSet<usize> = marked.iter().copied().collect();
    // Some writers mark every vertex as a turn point; then the marks say nothing.
    if distinct.len() >= 2 && (distinct.len() < outline.len() || outline.len() <= 8) {
        let mut corners: Vec<usize> = distinct.into_iter().collect();
        let start = corners.iter().position(|&vertex| vertex == marked[0]).unwrap_or(0);
        corners.rotate_left(start);
        return corners;
    }
    let n = outline.len();
    let turn = |i: usize| (outline[i] - outline[(i + n - 1) % n]).angle(&(outline[(i + 1) % n] - outline[i]));
    (0..n).filter(|&i| turn(i).to_degrees() >= CORNER_TURN_DEG).collect()
}

/// The stretch of an outline from one corner over `span` corners, counter-clockwise.
pub(super) fn cut_edge(outline: &[V2], corners: &[usize], from: usize, span: usize, name: Option<String>) -> Edge {
    let n = outline.len();
    let corner = |k: usize| corners[(from + k) % corners.len()];
    let steps = |vertex: usize| match (vertex + n - corner(0)) % n {
        0 => n,
        steps => steps,
    };
    let points = (0..=steps(corner(span))).map(|k| outline[(corner(0) + k) % n]).collect();
    let line = Polyline::new(points).expect("different corners are at least one side apart");
    let corners = (1..span).map(|k| line.arcs()[steps(corner(k))]).collect();
    Edge { name, line, corners }
}

pub(super) fn mirrored(point: V2) -> V2 {
    V2::new(-point.x, point.y)
}

/// Mirrors an edge and turns it round, so that it is counter-clockwise again.
pub(super) fn mirror_edge(edge: &mut Edge) {
    let length = edge.line.length();
    let points = edge.line.points().iter().rev().map(|&p| mirrored(p)).collect();
    edge.line = Polyline::new(points).expect("as many points as before");
    edge.corners = edge.corners.iter().rev().map(|arc| length - arc).collect();
}
