//! Corners of an outline, the edges between them, and their mirror images.

use std::collections::BTreeSet;

use super::Edge;
use crate::piece::Piece;
use geom::V2;
use geom::polyline::Polyline;

/// Distance below which a turn point counts as on a vertex of the outline.
const ON_OUTLINE_M: f64 = 0.5e-3;
/// Turning angle from which a vertex is a corner if the file marks no corners. Of 296 corners that six files mark, 265
/// turn by as much, and no other vertex does.
const CORNER_TURN_DEG: f64 = 30.0;
/// Turning angle from which a vertex is a corner besides the marked ones. A vertex of a sampled curve turns less.
const SHARP_TURN_DEG: f64 = 45.0;
/// Turning angle below which a marked vertex is no corner if an internal line meets the outline there.
const SLIGHT_TURN_DEG: f64 = 20.0;
/// Turning angle from which a marked point is a corner whatever its neighbours. A curve of 30 mm radius, the narrowest
/// of an armhole or a neck, turns by 19 degrees per centimetre.
const CLEAR_TURN_DEG: f64 = 20.0;
/// Least share of the turning angle of a vertex by which its neighbour on the same curve turns.
const SAME_CURVE: f64 = 0.5;
/// Most vertices of an outline that has no sampled curve.
const FEW: usize = 8;
/// Length within which a rounded corner turns: a quarter of a circle of 15 mm radius.
const ROUNDED_M: f64 = 24e-3;
/// Turning angle within [`ROUNDED_M`] from which an outline has a rounded corner.
const ROUNDED_TURN_DEG: f64 = 60.0;
/// Least distance of an unmarked corner from the next. Sharp vertices nearer than that form a notch or a step.
const APART_M: f64 = 15e-3;

/// Vertex indices, counter-clockwise from the first turn point in the file: marked vertices and isolated sharp ones. If
/// the file marks none, all vertices with a large turning angle.
pub(crate) fn corner_vertices(piece: &Piece) -> Vec<usize> {
    let outline = piece.seam_outline();
    let nearest = |point: &V2| {
        let distance = |i: &usize| (outline[*i] - point).norm();
        (0..outline.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).filter(|i| distance(i) < ON_OUTLINE_M)
    };
    // Programs mark the turn points of internal lines on the same layer. The outline need not turn where such a line
    // meets it.
    let ends_inner_line = |point: &V2| piece.internal_lines.iter().flatten().any(|p| (p - point).norm() < ON_OUTLINE_M);
    let is_inner = |point: &V2, i: usize| turn_deg(outline, i) < SLIGHT_TURN_DEG && ends_inner_line(point);
    let marked = piece.turn_points.iter().filter_map(|point| nearest(point).filter(|&i| !is_inner(point, i)));
    let marked: Vec<usize> = marked.collect();
    let distinct: BTreeSet<usize> = marked.iter().copied().collect();
    // Some writers mark every vertex as a turn point. On curves the marks then carry no information.
    let on_curves = || (0..outline.len()).filter(|&i| is_on_curve(outline, i)).count();
    let is_told = distinct.len() < outline.len() || outline.len() <= FEW || 2 * on_curves() < outline.len();
    if distinct.len() >= 2 && is_told {
        let mut corners: Vec<usize> = with_unmarked(outline, distinct).into_iter().collect();
        let start = corners.iter().position(|&vertex| vertex == marked[0]).unwrap_or(0);
        corners.rotate_left(start);
        return corners;
    }
    let sharp: Vec<usize> = (0..outline.len()).filter(|&i| turn_deg(outline, i) >= CORNER_TURN_DEG).collect();
    if sharp.len() > 1 { sharp } else { rounded_corners(outline) }
}

/// Middles of the stretches that turn by a corner within [`ROUNDED_M`]: corners of bands and flaps that are cut round.
fn rounded_corners(outline: &[V2]) -> Vec<usize> {
    let n = outline.len();
    let step = |i: usize| (outline[(i + 1) % n] - outline[i % n]).norm();
    let signed = |i: usize| {
        let (u, v) = (outline[i] - outline[(i + n - 1) % n], outline[(i + 1) % n] - outline[i]);
        u.perp(&v).atan2(u.dot(&v)).to_degrees()
    };
    // Vertices within half the length to either side.
    let reach = |from: usize, is_forward: bool| {
        let (mut count, mut way) = (0, 0.0);
        while count < n / 2 {
            way += if is_forward { step(from + count) } else { step(from + 2 * n - count - 1) };
            if way > 0.5 * ROUNDED_M {
                break;
            }
            count += 1;
        }
        count
    };
    let turn = |i: usize| -> f64 {
        let (back, ahead) = (reach(i, false), reach(i, true));
        (0..=back + ahead).map(|k| signed((i + n - back + k) % n)).sum::<f64>().abs()
    };
    let turns: Vec<f64> = (0..n).map(turn).collect();
    let is_corner = |i: usize| turns[i % n] >= ROUNDED_TURN_DEG;
    let goes_on = |i: usize| is_corner(i) && is_corner(i + 1) && step(i) < 0.5 * ROUNDED_M;
    let starts = (0..n).filter(|&i| is_corner(i) && !goes_on(i + n - 1));
    starts.map(|start| (start + (0..n).take_while(|k| goes_on(start + k)).count().div_ceil(2)) % n).collect()
}

/// True if a vertex turns no more than a curve that continues at a neighbour: programs mark grade points along an edge
/// as they mark corners.
pub(crate) fn is_on_curve(outline: &[V2], vertex: usize) -> bool {
    let n = outline.len();
    let turn = |i: usize| {
        let (u, v) = (outline[i] - outline[(i + n - 1) % n], outline[(i + 1) % n] - outline[i]);
        u.perp(&v).atan2(u.dot(&v)).to_degrees()
    };
    let own = turn(vertex);
    let goes_on = |other: f64| other * own > 0.0 && (SAME_CURVE * own.abs()..CLEAR_TURN_DEG).contains(&other.abs());
    own.abs() < CLEAR_TURN_DEG && [vertex + n - 1, vertex + 1].into_iter().any(|other| goes_on(turn(other % n)))
}

/// To either side.
fn turn_deg(outline: &[V2], i: usize) -> f64 {
    let n = outline.len();
    (outline[i] - outline[(i + n - 1) % n]).angle(&(outline[(i + 1) % n] - outline[i])).to_degrees()
}

fn with_unmarked(outline: &[V2], marked: BTreeSet<usize>) -> BTreeSet<usize> {
    let n = outline.len();
    let is_corner = |i: usize| marked.contains(&i) || turn_deg(outline, i) >= SHARP_TURN_DEG;
    // True if the walk along the outline by `step` vertices at a time meets no corner within the distance.
    let is_apart = |from: usize, step: usize| {
        let (mut at, mut way) = (from, 0.0);
        loop {
            let next = (at + step) % n;
            way += (outline[next] - outline[at]).norm();
            at = next;
            if way >= APART_M || at == from {
                return true;
            }
            if is_corner(at) {
                return false;
            }
        }
    };
    let unmarked = (0..n).filter(|&i| !marked.contains(&i) && is_corner(i) && is_apart(i, 1) && is_apart(i, n - 1));
    let found: Vec<usize> = unmarked.collect();
    marked.into_iter().chain(found).collect()
}

/// Begins at the corner `from` and ends `span` corners later, counter-clockwise.
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

/// Mirrors and reverses an edge, so that it is counter-clockwise again.
pub(super) fn mirror_edge(edge: &mut Edge) {
    let length = edge.line.length();
    let points = edge.line.points().iter().rev().map(|&p| mirrored(p)).collect();
    edge.line = Polyline::new(points).expect("as many points as before");
    edge.corners = edge.corners.iter().rev().map(|arc| length - arc).collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_along_a_curve_is_no_corner_and_one_at_the_end_of_an_edge_is() {
        // A quarter of a circle in steps of a centimetre, between two straight sides.
        let on_arc = |k: u32| {
            let angle = std::f64::consts::FRAC_PI_2 * f64::from(k) / 20.0;
            V2::new(0.13 * angle.cos(), 0.13 * angle.sin())
        };
        let outline: Vec<V2> = std::iter::once(V2::zeros()).chain((0..=20).map(on_arc)).collect();
        let check = |vertex: usize, expect: bool| assert_eq!(is_on_curve(&outline, vertex), expect, "{vertex}");
        check(0, false);
        check(1, false);
        check(2, true);
        check(11, true);
        check(20, true);
        check(21, false);
        // A hip point between straight sides, shallow as it is.
        let hip: Vec<V2> = [[0.0, 0.0], [0.3, 0.0], [0.32, 0.2], [0.3, 0.4], [0.0, 0.4]].map(V2::from).to_vec();
        assert!(!is_on_curve(&hip, 2));
    }
}
