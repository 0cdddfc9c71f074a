//! Displacement of outlines by *knots*: points with a given displacement. Every sharp corner is a knot, of displacement
//! zero unless it is moved.
//!
//! Between two knots the displacement is a cubic Hermite curve: linear along the edge, a smooth step across it. An edge
//! thus keeps its direction at every knot, and the outline its right angles and smooth joints. Only an edge that is
//! straight between two corners stays straight.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::plan::Move;
use crate::style::openings::EdgeEnd;
use crate::style::{Edge, EdgeRef, Style};
use geom::V2;
use geom::polyline::{Polyline, segment_distance};

const SAME_M: f64 = 1e-6;
/// Greatest distance of a straight edge from its chord. A flattened curve departs further.
const STRAIGHT_M: f64 = 0.2e-3;
/// Turning angle below which two edges join smoothly: 10 degrees.
const SMOOTH_RAD: f64 = 0.175;
/// Share of a section, at either end, whose chord gives the direction of the outline there.
const END_SHARE: f64 = 0.01;
/// Least ratio of chord to length of a section whose points are parametrised by the chord.
const ALONG_CHORD: f64 = 0.5;
/// Least sine of the angles between a chord and the directions of its curve at both ends, for scaling along them: 6
/// degrees. A flatter curve would be scaled by far more than its ends move.
const LEAST_BOW: f64 = 0.1;
/// Least depth of a curve that is sheared to keep its direction at one end: above the amounts by which ends are moved,
/// so that it bends the same way afterwards.
const LEAST_DEPTH_M: f64 = 0.02;
/// Longest segment of an edge that bends. A seam of 100 mm that is moved by 10 mm turns by less than 2 degrees from one
/// to the next.
const SEGMENT_M: f64 = 5e-3;
/// Distance below which a knot takes a vertex.
const BESIDE_M: f64 = 0.5e-3;

/// By piece, edge and vertex; only affected pieces.
pub type Displacement = BTreeMap<usize, Vec<Vec<V2>>>;

pub struct Rig<'a> {
    style: &'a Style,
    outlines: BTreeMap<usize, Outline>,
}

struct Outline {
    /// Vertices, the first one repeated at the end.
    line: Polyline,
    /// First vertex of each edge, then the last vertex of the last edge.
    firsts: Vec<usize>,
    /// Arc lengths in increasing order.
    knots: Vec<f64>,
    /// Arc lengths where a nearly straight edge may turn.
    turning: Vec<f64>,
}

pub fn is_sharp(style: &Style, EdgeEnd { edge: EdgeRef { piece, edge }, is_last }: EdgeEnd) -> bool {
    let vertex = edge + usize::from(is_last);
    Outline::new(&style.pieces[piece].edges).is_some_and(|outline| outline.is_sharp(outline.firsts[vertex]))
}

impl<'a> Rig<'a> {
    /// Sets knots at the points of the moves.
    pub fn new<'m>(style: &'a Style, moves: impl Iterator<Item = &'m Move>) -> Self {
        let mut outlines: BTreeMap<usize, Outline> = BTreeMap::new();
        for moved in moves {
            let piece = moved.at.edge.piece;
            let outline = match outlines.entry(piece) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => match Outline::new(&style.pieces[piece].edges) {
                    Some(outline) => new.insert(outline),
                    None => continue,
                },
            };
            let arc_m = outline.arc_m(moved);
            outline.add(arc_m);
            outline.turning.extend(moved.turns.then_some(arc_m));
        }
        Self { style, outlines }
    }

    /// Adds vertices at the knots and short segments, on the edges that the moves bend.
    pub fn refined(&self, moves: &[Move]) -> Style {
        let mut style = self.style.clone();
        for (piece, outline) in &self.outlines {
            let own: Vec<Move> = moves.iter().filter(|m| m.at.edge.piece == *piece).copied().collect();
            let bent = outline.bent(&own);
            for (k, edge) in style.pieces[*piece].edges.iter_mut().enumerate() {
                let ends = [outline.firsts[k], outline.firsts[k + 1]].map(|vertex| outline.line.arcs()[vertex]);
                if bent.iter().any(|[from, to]| *from < ends[1] - SAME_M && *to > ends[0] + SAME_M) {
                    let knots: Vec<f64> = outline.knots.iter().map(|arc| arc - ends[0]).collect();
                    edge.line = refined(&edge.line, &knots);
                }
            }
        }
        style
    }

    /// Of every vertex, m/m of amount.
    pub fn displacement(&self, moves: &[Move]) -> Displacement {
        let edges = |(piece, outline): (&usize, &Outline)| {
            let own: Vec<Move> = moves.iter().filter(|m| m.at.edge.piece == *piece).copied().collect();
            let moved = outline.moved(&own);
            let n = moved.len();
            let edge = |ends: &[usize]| (ends[0]..=ends[1]).map(|vertex| moved[vertex % n]).collect();
            (*piece, outline.firsts.windows(2).map(edge).collect())
        };
        self.outlines.iter().map(edges).collect()
    }
}

impl Outline {
    /// Sharp corners become knots.
    fn new(edges: &[Edge]) -> Option<Self> {
        let mut points = Vec::new();
        let mut firsts = vec![0];
        for edge in edges {
            points.extend(edge.line.points().split_last()?.1);
            firsts.push(points.len());
        }
        points.push(*points.first()?);
        let mut outline = Self { line: Polyline::new(points)?, firsts, knots: Vec::new(), turning: Vec::new() };
        for k in 0..edges.len() {
            if outline.is_sharp(outline.firsts[k]) {
                outline.add(outline.line.arcs()[outline.firsts[k]]);
            }
        }
        Some(outline)
    }

    fn length_m(&self) -> f64 {
        self.line.length()
    }

    fn is_sharp(&self, vertex: usize) -> bool {
        let (points, n) = (self.line.points(), self.line.points().len() - 1);
        let at = points[vertex % n];
        (at - points[(vertex + n - 1) % n]).angle(&(points[vertex % n + 1] - at)) > SMOOTH_RAD
    }

    /// The end of the outline counts as its beginning.
    fn arc_m(&self, moved: &Move) -> f64 {
        let arc_m = self.line.arcs()[self.firsts[moved.at.edge.edge]] + moved.at.arc_m;
        if arc_m > self.length_m() - SAME_M { 0.0 } else { arc_m }
    }

    /// Index at an arc length, or where it would be inserted.
    fn knot(&self, arc_m: f64) -> usize {
        self.knots.partition_point(|knot| *knot < arc_m - SAME_M)
    }

    fn add(&mut self, arc_m: f64) {
        let at = self.knot(arc_m);
        if self.knots.get(at).is_none_or(|knot| (knot - arc_m).abs() > SAME_M) {
            self.knots.insert(at, arc_m);
        }
    }

    /// Sum of the moves at each knot.
    fn told(&self, moves: &[Move]) -> Vec<V2> {
        let mut told = vec![V2::zeros(); self.knots.len()];
        for moved in moves {
            told[self.knot(self.arc_m(moved))] += moved.by;
        }
        told
    }

    /// Between neighbouring knots, whose indices stand beside. The last section passes the first vertex.
    fn sections(&self) -> impl Iterator<Item = (Section, [usize; 2])> + '_ {
        let n = self.knots.len();
        (0..n).map(move |k| {
            let next = (k + 1) % n;
            let to = if next > k { self.knots[next] } else { self.knots[next] + self.length_m() };
            (Section::new(self, [self.knots[k], to]), [k, next])
        })
    }

    /// Intervals of arc length that the moves bend, m.
    fn bent(&self, moves: &[Move]) -> Vec<[f64; 2]> {
        let told = self.told(moves);
        let is_moved = |knot: usize| told[knot] != V2::zeros();
        let bent = self
            .sections()
            .filter(|(section, ends)| section.kind != Kind::Stiff && ends.iter().any(|end| is_moved(*end)));
        let arcs = bent.flat_map(|(section, _)| {
            let [from, to] = section.arcs_m;
            [[from, to], [from - self.length_m(), to - self.length_m()]]
        });
        arcs.collect()
    }

    /// Displacement of each vertex; the first occurs once.
    fn moved(&self, moves: &[Move]) -> Vec<V2> {
        let told = self.told(moves);
        let n = self.line.points().len() - 1;
        let mut moved = vec![V2::zeros(); n];
        let sections: Vec<(Section, [V2; 2])> =
            self.sections().map(|(section, ends)| (section, ends.map(|end| told[end]))).collect();
        let count = sections.len();
        for (k, (section, told)) in sections.iter().enumerate() {
            let beside = [&sections[(k + count - 1) % count], &sections[(k + 1) % count]];
            let turns = beside.map(|(other, told)| if section.joins(other) { other.turn(*told) } else { 0.0 });
            for (vertex, moved) in moved.iter_mut().enumerate() {
                let arcs = [0.0, self.length_m()].map(|round_m| self.line.arcs()[vertex] + round_m);
                let within = arcs
                    .into_iter()
                    .find(|arc| (section.arcs_m[0] - SAME_M..=section.arcs_m[1] + SAME_M).contains(arc));
                if let Some(arc_m) = within {
                    let place = self.line.points()[vertex];
                    *moved = section.between(place, section.share(place, arc_m), *told, turns);
                }
            }
        }
        moved
    }
}

fn refined(line: &Polyline, knots: &[f64]) -> Polyline {
    let mut ends = line.arcs().to_vec();
    for knot in knots.iter().filter(|knot| (0.0..line.length()).contains(*knot)) {
        if !ends.iter().any(|arc| (arc - knot).abs() < BESIDE_M) {
            ends.push(*knot);
        }
    }
    ends.sort_by(f64::total_cmp);
    let mut points = vec![line.points()[0]];
    for (from, to) in ends.windows(2).map(|pair| (pair[0], pair[1])) {
        let parts = ((to - from) / SEGMENT_M).ceil().max(1.0) as usize;
        points.extend((1..=parts).map(|k| line.at(from + (to - from) * (k as f64 / parts as f64))));
    }
    Polyline::new(points).unwrap_or_else(|| line.clone())
}

struct Section {
    /// The second exceeds the length of the outline if the section passes the first vertex.
    arcs_m: [f64; 2],
    ends: [V2; 2],
    /// Unit vectors at both ends.
    along: [V2; 2],
    /// True for parameters by projection onto the chord, false for arc length, where the section turns back.
    by_chord: bool,
    is_corner: [bool; 2],
    kind: Kind,
}

/// Tells by what the displacement of the ends is carried to the points. The first three are affine maps, which make no
/// inflection.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Straight from corner to corner, and stays so.
    Stiff,
    /// Bends one way, by enough to tell its directions at both ends apart. Is scaled along them, so that it keeps both.
    Bow,
    /// May turn at the given end. Is sheared so that it keeps its direction at the other end.
    Sheared(usize),
    /// May turn at the given end, and is too flat to be sheared. Turns as a whole; the section beside it takes up the
    /// turn.
    Turned(usize),
    /// Cubic Hermite interpolation with the component of the change along the outline as slope at each end.
    Smooth,
}

impl Section {
    fn new(outline: &Outline, arcs_m: [f64; 2]) -> Self {
        let length_m = outline.length_m();
        let point_at = |arc: f64| outline.line.at(if arc > length_m { arc - length_m } else { arc });
        let ends = arcs_m.map(point_at);
        let step = END_SHARE * (arcs_m[1] - arcs_m[0]);
        let unit = |way: V2| way.try_normalize(0.0).unwrap_or_else(V2::zeros);
        let along = [unit(point_at(arcs_m[0] + step) - ends[0]), unit(ends[1] - point_at(arcs_m[1] - step))];
        let arcs = outline.line.arcs();
        let rounds = [0.0, length_m].into_iter().flat_map(|round_m| arcs.iter().map(move |arc| arc + round_m));
        let inner: Vec<V2> =
            rounds.filter(|arc| (arcs_m[0] + SAME_M..arcs_m[1] - SAME_M).contains(arc)).map(point_at).collect();
        let chord = ends[1] - ends[0];
        let axis = unit(chord);
        let mut places = vec![ends[0].dot(&axis)];
        places.extend(inner.iter().map(|p| p.dot(&axis)));
        places.push(ends[1].dot(&axis));
        let goes_on = places.windows(2).all(|pair| pair[1] >= pair[0] - SAME_M);
        let is_straight = inner.iter().all(|p| segment_distance(&ends[0], &ends[1], p) < STRAIGHT_M);
        let once = |arc: f64| if arc > length_m - SAME_M { arc - length_m } else { arc };
        let is_sharp = |first: &usize, arc: f64| (arcs[*first] - once(arc)).abs() < SAME_M && outline.is_sharp(*first);
        let is_corner = arcs_m.map(|arc| outline.firsts.iter().any(|first| is_sharp(first, arc)));
        let turns = arcs_m.map(|arc| outline.turning.iter().any(|turning| (turning - once(arc)).abs() < SAME_M));
        // Sines of the angles between the chord and the directions at the ends, and depths of the section along the
        // chord's normal to these directions.
        let sines = [along[0].perp(&axis), axis.perp(&along[1])];
        let sense = sines[0].signum();
        let path: Vec<V2> = std::iter::once(ends[0]).chain(inner.iter().copied()).chain([ends[1]]).collect();
        let bends_on = path.windows(3).all(|p| (p[1] - p[0]).perp(&(p[2] - p[1])) * sense > -SAME_M * SAME_M);
        let is_deep = |end: usize| bends_on && (sines[end] * chord.norm()).abs() > LEAST_DEPTH_M;
        let kind = if is_straight && is_corner == [true; 2] {
            Kind::Stiff
        } else if bends_on && turns == [false; 2] && sines.iter().all(|sine| sine * sense > LEAST_BOW) {
            Kind::Bow
        } else {
            match turns {
                [true, false] if is_deep(1) => Kind::Sheared(0),
                [false, true] if is_deep(0) => Kind::Sheared(1),
                [true, false] => Kind::Turned(0),
                [false, true] => Kind::Turned(1),
                _ => Kind::Smooth,
            }
        };
        Self {
            arcs_m,
            ends,
            along,
            by_chord: goes_on && chord.norm() > ALONG_CHORD * (arcs_m[1] - arcs_m[0]),
            is_corner,
            kind,
        }
    }

    /// True if another section continues this one smoothly at one of its ends, and is turned as a whole about it.
    fn joins(&self, other: &Self) -> bool {
        let end = match other.kind {
            Kind::Turned(end) => 1 - end,
            _ => return false,
        };
        !other.is_corner[end] && self.kind != Kind::Stiff && !matches!(self.kind, Kind::Turned(_))
    }

    /// Turn of the section as a whole if its ends are displaced, radians.
    fn turn(&self, [from, to]: [V2; 2]) -> f64 {
        let chord = self.ends[1] - self.ends[0];
        chord.perp(&(to - from)) / chord.norm_squared()
    }

    /// Coordinates of a vector along the directions at both ends.
    fn oblique(&self, way: V2) -> [f64; 2] {
        let [first, last] = self.along;
        [way.perp(&last) / first.perp(&last), first.perp(&way) / first.perp(&last)]
    }

    /// From 0 to 1.
    fn share(&self, place: V2, arc_m: f64) -> f64 {
        let chord = self.ends[1] - self.ends[0];
        if self.by_chord {
            (place - self.ends[0]).dot(&chord) / chord.norm_squared()
        } else {
            (arc_m - self.arcs_m[0]) / (self.arcs_m[1] - self.arcs_m[0]).max(f64::MIN_POSITIVE)
        }
    }

    /// Displacement at the share `t`. `turns` are those of the sections beside it, radians.
    fn between(&self, place: V2, t: f64, [from, to]: [V2; 2], turns: [f64; 2]) -> V2 {
        let change = to - from;
        let (square, cube) = (t * t, t * t * t);
        let slopes = [cube - 2.0 * square + t, cube - square];
        let length_m = self.arcs_m[1] - self.arcs_m[0];
        let across = |end: usize| V2::new(-self.along[end].y, self.along[end].x) * (turns[end] * length_m);
        let turned: V2 = (0..2).map(|end| across(end) * slopes[end]).sum();
        let chord = self.ends[1] - self.ends[0];
        turned
            + match self.kind {
                Kind::Stiff | Kind::Turned(_) => from + change * t,
                Kind::Bow => {
                    let [change, chord, own] = [change, chord, place - self.ends[0]].map(|way| self.oblique(way));
                    from + (0..2).map(|end| self.along[end] * (change[end] * own[end] / chord[end])).sum::<V2>()
                }
                Kind::Sheared(end) => {
                    let kept = self.along[1 - end];
                    from + change * (kept.perp(&(place - self.ends[0])) / kept.perp(&chord))
                }
                Kind::Smooth => {
                    let slope = |end: usize| self.along[end] * change.dot(&self.along[end]);
                    from + change * (3.0 * square - 2.0 * cube) + slope(0) * slopes[0] + slope(1) * slopes[1]
                }
            }
    }
}
