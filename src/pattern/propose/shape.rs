//! The outline of a piece as edges between corners, darts taken out.

use crate::piece::Piece;
use crate::style::corners::corner_vertices;
use geom::V2;

/// Turn to the right at which a corner is the apex of a dart, degrees.
const APEX_TURN_DEG: f64 = 120.0;
/// Greatest difference of the two legs of a dart, share of the longer.
const LEG_DIFFERENCE: f64 = 0.04;
/// Greatest mouth of a dart, share of its leg: what is wider is a V-neck.
const WIDEST_MOUTH: f64 = 0.7;
/// Least leg of a dart, m.
const LEAST_LEG_M: f64 = 20e-3;
/// Turn from which a marked point is a corner whatever its neighbours do, degrees: a curve of 30 mm radius, the narrowest of an
/// armhole or a neck, turns by 19 a centimetre.
const CLEAR_TURN_DEG: f64 = 20.0;
/// Share of its turn that a neighbour has along a curve.
const SAME_CURVE: f64 = 0.5;
/// Growth of a mouth below which it does not count as growth, m.
const LEAST_STEP_M: f64 = 1e-3;
/// Greatest distance of corners from the images of others in an outline that is its own mirror image, share of its size.
const MIRRORED: f64 = 0.003;
/// Most corners of a piece that is looked at; more are no pattern's, and alignment takes the square of their number.
const MOST_CORNERS: usize = 100;

/// The outline that is sewn, cut at its corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Vertices of the outline, counter-clockwise, m.
    outline: Vec<V2>,
    /// Corners, counter-clockwise: those of [`corner_vertices`] that lie on no curve.
    corners: Vec<usize>,
    /// Darts cut into the outline.
    darts: Vec<Dart>,
}

/// A dart in an outline: as many edges before its apex as after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dart {
    /// Corner at its tip.
    pub apex: usize,
    /// Edges of each leg: one, or several where the dart narrows again towards the edge it is cut into.
    pub span: usize,
}

/// A stretch of outline over some edges, in the frame of a [`Shape::framed`] outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// From its first to its last point.
    pub chord: V2,
    /// The point at half its length.
    pub middle: V2,
    /// Length without darts.
    pub length: f64,
    /// Area between it and its chord over the square of the chord; positive where it bulges outwards.
    pub bow: f64,
    /// Sum of the turns at the corners that it passes, darts left out, radians.
    pub turn: f64,
}

/// A point turned about the origin by quarter turns, counter-clockwise.
#[must_use]
pub fn quarter_turned(p: &V2, quarter_turns: usize) -> V2 {
    match quarter_turns % 4 {
        0 => *p,
        1 => V2::new(-p.y, p.x),
        2 => -*p,
        _ => V2::new(p.y, -p.x),
    }
}

/// Whether an outline turns at a vertex no more than a curve does that goes on at a neighbour: programs mark graded points
/// along an edge as they mark corners.
fn is_on_curve(outline: &[V2], vertex: usize) -> bool {
    let n = outline.len();
    let turn = |i: usize| {
        let (u, v) = (outline[i] - outline[(i + n - 1) % n], outline[(i + 1) % n] - outline[i]);
        u.perp(&v).atan2(u.dot(&v)).to_degrees()
    };
    let own = turn(vertex);
    let goes_on = |other: f64| other * own > 0.0 && (SAME_CURVE * own.abs()..CLEAR_TURN_DEG).contains(&other.abs());
    own.abs() < CLEAR_TURN_DEG && [vertex + n - 1, vertex + 1].into_iter().any(|other| goes_on(turn(other % n)))
}

impl Shape {
    /// The shape of a piece; `None` where it has fewer than three corners or more than any pattern.
    #[must_use]
    pub fn of(piece: &Piece) -> Option<Self> {
        let outline = piece.seam_outline();
        let marked = Self::new(outline.to_vec(), corner_vertices(piece))?;
        let ends_edge = |k: &usize| !is_on_curve(outline, marked.corners[*k]) || marked.is_in_dart(*k);
        let corners = (0..marked.len()).filter(ends_edge).map(|k| marked.corners[k]).collect();
        Self::new(outline.to_vec(), corners)
    }

    /// The shape of an outline, counter-clockwise, with the indices of its corners; `None` as [`Shape::of`].
    #[must_use]
    pub fn new(outline: Vec<V2>, corners: Vec<usize>) -> Option<Self> {
        if !(3..=MOST_CORNERS).contains(&corners.len()) {
            return None;
        }
        let mut shape = Self { outline, corners, darts: Vec::new() };
        let apexes = (0..shape.corners.len()).filter(|&corner| shape.is_apex(corner));
        shape.darts = apexes.map(|apex| Dart { apex, span: shape.leg_span(apex) }).collect();
        Some(shape)
    }

    /// Vertices of the corners on the outline.
    #[must_use]
    pub fn corners(&self) -> &[usize] {
        &self.corners
    }

    /// Number of corners, which is the number of edges: edge `k` runs from corner `k` to the next.
    #[must_use]
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// Darts, by the number of their apex.
    #[must_use]
    pub fn darts(&self) -> &[Dart] {
        &self.darts
    }

    /// The dart of which an edge is a leg, or part of one.
    #[must_use]
    pub fn dart_of(&self, edge: usize) -> Option<Dart> {
        let n = self.len();
        self.darts.iter().copied().find(|dart| (edge + n + dart.span - dart.apex) % n < 2 * dart.span)
    }

    /// Whether an edge is a leg of a dart.
    #[must_use]
    pub fn is_leg(&self, edge: usize) -> bool {
        self.dart_of(edge).is_some()
    }

    /// Whether a corner is the apex of a dart, or lies within one of its legs.
    #[must_use]
    pub fn is_in_dart(&self, corner: usize) -> bool {
        let n = self.len();
        let is_in = |dart: &Dart| (corner + n + dart.span - dart.apex - 1) % n < 2 * dart.span - 1;
        self.darts.iter().any(is_in)
    }

    /// Points of an edge, both ends included.
    pub fn points(&self, edge: usize) -> Vec<V2> {
        let n = self.outline.len();
        let (from, to) = (self.corners[edge], self.corners[(edge + 1) % self.len()]);
        (0..=(to + n - from) % n).map(|k| self.outline[(from + k) % n]).collect()
    }

    /// Length of an edge, m.
    #[must_use]
    pub fn length(&self, edge: usize) -> f64 {
        self.points(edge).windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum()
    }

    /// Turn of the outline at a corner, radians, positive to the left.
    fn turn(&self, corner: usize) -> f64 {
        let before = self.points((corner + self.len() - 1) % self.len());
        let after = self.points(corner);
        let (u, v) = (before[before.len() - 1] - before[before.len() - 2], after[1] - after[0]);
        u.perp(&v).atan2(u.dot(&v))
    }

    fn is_apex(&self, corner: usize) -> bool {
        let legs = [self.length((corner + self.len() - 1) % self.len()), self.length(corner)];
        let place = |corner: usize| self.outline[self.corners[corner % self.len()]];
        let mouth = (place(corner + 1) - place(corner + self.len() - 1)).norm();
        let (short, long) = (legs[0].min(legs[1]), legs[0].max(legs[1]));
        // By the chords of the legs: those of a waist dart are often curved.
        let into = place(corner) - place(corner + self.len() - 1);
        let out = place(corner + 1) - place(corner);
        into.perp(&out).atan2(into.dot(&out)).to_degrees() < -APEX_TURN_DEG
            && short > LEAST_LEG_M
            && mouth < WIDEST_MOUTH * short
            && long - short < LEG_DIFFERENCE * long.max(LEAST_LEG_M)
    }

    /// Edges of each leg of the dart with this apex: a dart that is widest inside the piece narrows again on its way out.
    fn leg_span(&self, apex: usize) -> usize {
        let n = self.len();
        let place = |corner: usize| self.outline[self.corners[corner % n]];
        let mouth = |span: usize| (place(apex + span) - place(apex + n - span)).norm();
        let is_on = |span: &usize| {
            let legs = [self.length((apex + n - span) % n), self.length((apex + span - 1) % n)];
            let (short, long) = (legs[0].min(legs[1]), legs[0].max(legs[1]));
            long - short < LEG_DIFFERENCE * long.max(LEAST_LEG_M) && mouth(*span) <= mouth(span - 1) + LEAST_STEP_M
        };
        // At least one edge stays outside.
        1 + (2..=(n - 1) / 2).take_while(is_on).count()
    }

    /// Length of a stretch once its darts are sewn, m.
    #[must_use]
    pub fn sewn_length(&self, from: usize, span: usize) -> f64 {
        let edges = (from..from + span).map(|edge| edge % self.len());
        edges.filter(|&edge| !self.is_leg(edge)).map(|edge| self.length(edge)).sum()
    }

    /// The least and greatest `v` of a stretch.
    #[must_use]
    pub fn heights(&self, from: usize, span: usize) -> [f64; 2] {
        let points = (0..span).flat_map(|k| self.points((from + k) % self.len()));
        points.fold([f64::MAX, f64::MIN], |[low, high], p| [low.min(p.y), high.max(p.y)])
    }

    /// The same shape turned by quarter turns and scaled into the unit square of its bounding box (both axes by the
    /// longer side, so that angles stay), with the box's width and height.
    #[must_use]
    pub fn framed(&self, quarter_turns: usize) -> (Self, V2) {
        let points: Vec<V2> = self.outline.iter().map(|p| quarter_turned(p, quarter_turns)).collect();
        let low = points.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
        let high = points.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
        let scale = (high - low).max().max(f64::MIN_POSITIVE);
        let outline = points.iter().map(|p| (p - low) / scale).collect();
        (Self { outline, ..self.clone() }, (high - low) / scale)
    }

    /// Of a framed outline that is its own mirror image, left to right: the sum, modulo the number of corners, of a corner and its image.
    #[must_use]
    pub fn mirror(&self) -> Option<usize> {
        let n = self.len();
        let place = |corner: usize| self.outline[self.corners[corner % n]];
        let middle = 0.5 * self.outline.iter().map(|p| p.x).fold(0.0, f64::max);
        let is_image = |a: V2, b: V2| (V2::new(2.0 * middle - a.x, a.y) - b).norm() < MIRRORED;
        (0..n).find(|sum| (0..n).all(|corner| is_image(place(corner), place(sum + n - corner))))
    }

    /// The stretch over `span` edges from the edge `from` on.
    #[must_use]
    pub fn stretch(&self, from: usize, span: usize) -> Stretch {
        let n = self.len();
        let mut points: Vec<V2> = Vec::new();
        let (mut turn, mut was_leg) = (0.0, false);
        for k in 0..span {
            let edge = (from + k) % n;
            let is_leg = self.is_leg(edge);
            if k > 0 && !is_leg && !was_leg {
                turn += self.turn(edge).abs();
            }
            was_leg = is_leg;
            if !is_leg {
                points.extend(self.points(edge));
            }
        }
        if points.is_empty() {
            points = self.points(from % n);
        }
        let chord = points[points.len() - 1] - points[0];
        // The mouth of a dart has no length: it is the step between two points that were put end to end.
        let mut arcs = vec![0.0];
        for ends in points.windows(2) {
            arcs.push(arcs[arcs.len() - 1] + (ends[1] - ends[0]).norm());
        }
        let length = arcs[arcs.len() - 1];
        let half = arcs.partition_point(|&arc| arc < 0.5 * length).min(points.len() - 1);
        let area = geom::polyline::signed_area(&points);
        Stretch { chord, middle: points[half], length, bow: area / chord.norm_squared().max(1e-12), turn }
    }
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
