//! Shape of a piece: its outline as edges between corners, with darts identified.

use crate::piece::Piece;
use crate::style::corners::{corner_vertices, is_on_curve};
use geom::V2;

/// Turning angle to the right from which a corner is the apex of a dart.
const APEX_TURN_DEG: f64 = 120.0;
/// Greatest relative length difference between both edges of a dart.
const LEG_DIFFERENCE: f64 = 0.04;
/// Greatest mouth of a dart, as a share of its edges. A wider one is a V-neck.
const WIDEST_MOUTH: f64 = 0.7;
const LEAST_LEG_M: f64 = 20e-3;
/// Growth of the mouth of a dart that does not count.
const LEAST_STEP_M: f64 = 1e-3;
/// Greatest distance of a corner from the mirror image of its partner in a symmetric outline, as a share of the size.
const MIRRORED: f64 = 0.003;
/// Slope of a grain line below which it lies: half of that of a bias.
const LYING: f64 = 0.5;
/// Greatest number of corners of a piece. No pattern has more, and alignment takes time quadratic in the number.
const MOST_CORNERS: usize = 100;

/// Sewn outline, divided at its corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Counter-clockwise, m.
    outline: Vec<V2>,
    /// Vertex indices, counter-clockwise: those of [`corner_vertices`] that do not lie on a curve.
    corners: Vec<usize>,
    darts: Vec<Dart>,
    /// As drawn. `None` if none is drawn.
    grain: Option<V2>,
}

/// Dart with as many edges before its apex as after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dart {
    pub apex: usize,
    /// Edges on each side: one, or several if the dart narrows again towards the edge that it is cut into.
    pub span: usize,
}

/// Properties of consecutive edges, divided by the longer side of the bounding box, as of [`Shape::framed`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    pub chord: V2,
    /// By length.
    pub middle: V2,
    /// Excludes the edges of darts.
    pub length: f64,
    /// Signed area between edges and chord, divided by the square of the chord, positive if they bulge outwards.
    pub bow: f64,
    /// Sum of |turning angle| at the inner corners, without darts, radians.
    pub turn: f64,
    pub has_dart: bool,
}

/// Rotates about the origin, counter-clockwise.
pub fn quarter_turned(p: &V2, quarter_turns: usize) -> V2 {
    match quarter_turns % 4 {
        0 => *p,
        1 => V2::new(-p.y, p.x),
        2 => -*p,
        _ => V2::new(p.y, -p.x),
    }
}

impl Shape {
    /// `None` with fewer than 3 or more than [`MOST_CORNERS`] corners.
    pub fn of(piece: &Piece) -> Option<Self> {
        let outline = piece.seam_outline();
        let marked = Self::new(outline.to_vec(), corner_vertices(piece))?;
        let ends_edge = |k: &usize| !is_on_curve(outline, marked.corners[*k]) || marked.is_in_dart(*k);
        let corners = (0..marked.len()).filter(ends_edge).map(|k| marked.corners[k]).collect();
        let grain = piece.grain.map(|[from, to]| to - from);
        Some(Self { grain, ..Self::new(outline.to_vec(), corners)? })
    }

    /// Takes a counter-clockwise outline. `None` as of [`Shape::of`].
    pub fn new(outline: Vec<V2>, corners: Vec<usize>) -> Option<Self> {
        if !(3..=MOST_CORNERS).contains(&corners.len()) {
            return None;
        }
        let mut shape = Self { outline, corners, darts: Vec::new(), grain: None };
        let apexes = (0..shape.corners.len()).filter(|&corner| shape.is_apex(corner));
        shape.darts = apexes.map(|apex| Dart { apex, span: shape.leg_span(apex) }).collect();
        Some(shape)
    }

    /// True if the grain line lies on its side: nearer to the horizontal than a bias.
    pub fn lies(&self) -> bool {
        self.grain.is_some_and(|grain| grain.y.abs() < LYING * grain.x.abs())
    }

    /// Adds a corner at the vertex nearest to the middle of some edges. Returns the shape with the index of the corner.
    /// `None` if the edges have no vertex between their ends.
    pub fn with_middle(&self, from: usize, span: usize) -> Option<(Self, usize)> {
        let n = self.outline.len();
        let (start, end) = (self.corners[from], self.corners[(from + span) % self.len()]);
        let vertices: Vec<usize> = (0..=(end + n - start) % n).map(|k| (start + k) % n).collect();
        let step = |ends: &[usize]| (self.outline[ends[1]] - self.outline[ends[0]]).norm();
        let whole: f64 = vertices.windows(2).map(step).sum();
        let mut way = 0.0;
        let places = vertices.windows(2).map(|ends| {
            way += step(ends);
            (ends[1], (way - 0.5 * whole).abs())
        });
        let is_inner = |(vertex, _): &(usize, f64)| *vertex != end && !self.corners.contains(vertex);
        let (vertex, _) = places.filter(is_inner).min_by(|a, b| a.1.total_cmp(&b.1))?;
        let edge = (0..span).map(|k| (from + k) % self.len()).find(|&edge| {
            let first = self.corners[edge];
            (vertex + n - first) % n < (self.corners[(edge + 1) % self.len()] + n - first) % n
        })?;
        let mut corners = self.corners.clone();
        corners.insert(edge + 1, vertex);
        let darts = self.darts.iter().map(|dart| Dart { apex: dart.apex + usize::from(dart.apex > edge), ..*dart });
        Some((Self { corners, darts: darts.collect(), ..self.clone() }, edge + 1))
    }

    /// Vertex indices.
    pub fn corners(&self) -> &[usize] {
        &self.corners
    }

    /// Number of corners, and of edges. Edge `k` runs from corner `k` to the next.
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    pub fn darts(&self) -> &[Dart] {
        &self.darts
    }

    pub fn dart_of(&self, edge: usize) -> Option<Dart> {
        let n = self.len();
        self.darts.iter().copied().find(|dart| (edge + n + dart.span - dart.apex) % n < 2 * dart.span)
    }

    pub fn is_leg(&self, edge: usize) -> bool {
        self.dart_of(edge).is_some()
    }

    pub fn is_in_dart(&self, corner: usize) -> bool {
        let n = self.len();
        let is_in = |dart: &Dart| (corner + n + dart.span - dart.apex - 1) % n < 2 * dart.span - 1;
        self.darts.iter().any(is_in)
    }

    /// Includes both ends.
    pub fn points(&self, edge: usize) -> Vec<V2> {
        let n = self.outline.len();
        let (from, to) = (self.corners[edge], self.corners[(edge + 1) % self.len()]);
        (0..=(to + n - from) % n).map(|k| self.outline[(from + k) % n]).collect()
    }

    /// In m.
    pub fn length(&self, edge: usize) -> f64 {
        self.points(edge).windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum()
    }

    /// Turning angle of the outline at a corner, radians, positive to the left.
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
        // The edges of a waist dart are often curved, so the angle is that between their chords.
        let into = place(corner) - place(corner + self.len() - 1);
        let out = place(corner + 1) - place(corner);
        into.perp(&out).atan2(into.dot(&out)).to_degrees() < -APEX_TURN_DEG
            && short > LEAST_LEG_M
            && mouth < WIDEST_MOUTH * short
            && long - short < LEG_DIFFERENCE * long.max(LEAST_LEG_M)
    }

    /// Number of edges on each side of the dart with this apex. A dart that is widest inside the piece narrows again
    /// towards its mouth.
    fn leg_span(&self, apex: usize) -> usize {
        let n = self.len();
        let place = |corner: usize| self.outline[self.corners[corner % n]];
        let mouth = |span: usize| (place(apex + span) - place(apex + n - span)).norm();
        let is_on = |span: &usize| {
            let legs = [self.length((apex + n - span) % n), self.length((apex + span - 1) % n)];
            let (short, long) = (legs[0].min(legs[1]), legs[0].max(legs[1]));
            long - short < LEG_DIFFERENCE * long.max(LEAST_LEG_M) && mouth(*span) <= mouth(span - 1) + LEAST_STEP_M
        };
        // At least one edge remains outside the dart.
        1 + (2..=(n - 1) / 2).take_while(is_on).count()
    }

    /// In m, with darts sewn.
    pub fn sewn_length(&self, from: usize, span: usize) -> f64 {
        let edges = (from..from + span).map(|edge| edge % self.len());
        edges.filter(|&edge| !self.is_leg(edge)).map(|edge| self.length(edge)).sum()
    }

    /// Least and greatest `v` of consecutive edges.
    pub fn heights(&self, from: usize, span: usize) -> [f64; 2] {
        let points = (0..span).flat_map(|k| self.points((from + k) % self.len()));
        points.fold([f64::MAX, f64::MIN], |[low, high], p| [low.min(p.y), high.max(p.y)])
    }

    /// Rotates the shape and divides it by the longer side of its bounding box. Returns it with the resulting width and
    /// height.
    pub fn framed(&self, quarter_turns: usize) -> (Self, V2) {
        let points: Vec<V2> = self.outline.iter().map(|p| quarter_turned(p, quarter_turns)).collect();
        let low = points.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
        let high = points.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
        let scale = (high - low).max().max(f64::MIN_POSITIVE);
        let outline = points.iter().map(|p| (p - low) / scale).collect();
        (Self { outline, ..self.clone() }, (high - low) / scale)
    }

    /// Sum of the indices of a corner and its mirror image, left to right, modulo the number of corners. `None` if the
    /// outline is not symmetric.
    pub fn mirror(&self) -> Option<usize> {
        let n = self.len();
        let place = |corner: usize| self.outline[self.corners[corner % n]];
        let middle = 0.5 * self.outline.iter().map(|p| p.x).fold(0.0, f64::max);
        let is_image = |a: V2, b: V2| (V2::new(2.0 * middle - a.x, a.y) - b).norm() < MIRRORED;
        (0..n).find(|sum| (0..n).all(|corner| is_image(place(corner), place(sum + n - corner))))
    }

    /// Takes `span` edges from the edge `from` on.
    pub fn section(&self, from: usize, span: usize) -> Section {
        let n = self.len();
        let mut points: Vec<V2> = Vec::new();
        let (mut turn, mut was_leg, mut has_dart) = (0.0, false, false);
        for k in 0..span {
            let edge = (from + k) % n;
            let is_leg = self.is_leg(edge);
            if k > 0 && !is_leg && !was_leg {
                turn += self.turn(edge).abs();
            }
            was_leg = is_leg;
            has_dart |= is_leg;
            if !is_leg {
                points.extend(self.points(edge));
            }
        }
        if points.is_empty() {
            points = self.points(from % n);
        }
        let chord = points[points.len() - 1] - points[0];
        // The mouth of a dart counts as a straight step between the two points that the dart separates.
        let mut arcs = vec![0.0];
        for ends in points.windows(2) {
            arcs.push(arcs[arcs.len() - 1] + (ends[1] - ends[0]).norm());
        }
        let length = arcs[arcs.len() - 1];
        let half = arcs.partition_point(|&arc| arc < 0.5 * length).min(points.len() - 1);
        let area = geom::polyline::signed_area(&points);
        Section { chord, middle: points[half], length, bow: area / chord.norm_squared().max(1e-12), turn, has_dart }
    }
}
