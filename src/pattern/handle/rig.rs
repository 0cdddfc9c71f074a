//! Outlines displaced by knots: places whose displacement is told. Every sharp corner is one, and stays where nothing is told of it.
//!
//! Between two knots the displacement goes from the one to the other: evenly along the edge, smoothly across it. So an edge keeps its
//! direction at every knot, and with it its right angles and its smooth joints; only a straight edge from corner to corner stays straight.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::plan::Move;
use crate::style::openings::EdgeEnd;
use crate::style::{Edge, EdgeRef, Style};
use geom::V2;
use geom::polyline::{Polyline, segment_distance};

/// Distance within which two knots of an edge are one, m.
const SAME_M: f64 = 1e-6;
/// Greatest distance of a straight edge from its chord, m: what a flattened curve has beside it is more.
const STRAIGHT_M: f64 = 0.2e-3;
/// Turn of an outline up to which two edges join smoothly, rad: 10 degrees.
const SMOOTH_RAD: f64 = 0.175;
/// Part of a stretch over which its direction at an end is taken.
const END_SHARE: f64 = 0.01;
/// Least ratio of the chord of a stretch to its length for places on it to go by the chord.
const ALONG_CHORD: f64 = 0.5;
/// Greatest length of a segment of what bends, m: a seam of 100 mm that is moved by 10 turns by less than 2 degrees from one to the next.
const SEGMENT_M: f64 = 5e-3;
/// Distance from a vertex within which a knot needs none of its own, m.
const BESIDE_M: f64 = 0.5e-3;

/// Displacement of the vertices of each edge of the pieces that are touched.
pub type Displacement = BTreeMap<usize, Vec<Vec<V2>>>;

/// Knots of the outlines of the pieces that are touched.
pub struct Rig<'a> {
    style: &'a Style,
    rings: BTreeMap<usize, Ring>,
}

/// The outline of a piece with its knots.
struct Ring {
    /// Vertices, the first one again at the end, and their arc lengths.
    line: Polyline,
    /// Number of the first vertex of each edge, and of the last one of the last.
    firsts: Vec<usize>,
    /// Arc lengths of the knots in rising order.
    knots: Vec<f64>,
}

/// Whether the outline turns at the end of an edge.
pub fn is_sharp(style: &Style, (EdgeRef { piece, edge }, is_last): EdgeEnd) -> bool {
    let vertex = edge + usize::from(is_last);
    Ring::new(&style.pieces[piece].edges).is_some_and(|ring| ring.is_sharp(ring.firsts[vertex]))
}

impl<'a> Rig<'a> {
    /// Knots of the places that some moves tell.
    pub fn new<'m>(style: &'a Style, moves: impl Iterator<Item = &'m Move>) -> Self {
        let mut rings: BTreeMap<usize, Ring> = BTreeMap::new();
        for one in moves {
            let piece = one.at.edge.piece;
            let ring = match rings.entry(piece) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => match Ring::new(&style.pieces[piece].edges) {
                    Some(ring) => new.insert(ring),
                    None => continue,
                },
            };
            ring.add(ring.arc_m(one));
        }
        Self { style, rings }
    }

    /// The style with vertices enough on the edges that some moves bend.
    pub fn refined(&self, moves: &[Move]) -> Style {
        let mut style = self.style.clone();
        for (piece, ring) in &self.rings {
            let own: Vec<Move> = moves.iter().filter(|m| m.at.edge.piece == *piece).copied().collect();
            let bent = ring.bent(&own);
            for (k, edge) in style.pieces[*piece].edges.iter_mut().enumerate() {
                let ends = [ring.firsts[k], ring.firsts[k + 1]].map(|vertex| ring.line.arcs()[vertex]);
                if bent.iter().any(|[from, to]| *from < ends[1] - SAME_M && *to > ends[0] + SAME_M) {
                    let knots: Vec<f64> = ring.knots.iter().map(|arc| arc - ends[0]).collect();
                    edge.line = refined(&edge.line, &knots);
                }
            }
        }
        style
    }

    /// Displacement of every vertex by some moves, per metre of amount.
    pub fn displacement(&self, moves: &[Move]) -> Displacement {
        let edges = |(piece, ring): (&usize, &Ring)| {
            let own: Vec<Move> = moves.iter().filter(|m| m.at.edge.piece == *piece).copied().collect();
            let moved = ring.moved(&own);
            let n = moved.len();
            let edge = |ends: &[usize]| (ends[0]..=ends[1]).map(|vertex| moved[vertex % n]).collect();
            (*piece, ring.firsts.windows(2).map(edge).collect())
        };
        self.rings.iter().map(edges).collect()
    }
}

impl Ring {
    /// Of the edges of a piece, with their sharp corners as knots.
    fn new(edges: &[Edge]) -> Option<Self> {
        let mut points = Vec::new();
        let mut firsts = vec![0];
        for edge in edges {
            points.extend(edge.line.points().split_last()?.1);
            firsts.push(points.len());
        }
        points.push(*points.first()?);
        let mut ring = Self { line: Polyline::new(points)?, firsts, knots: Vec::new() };
        for k in 0..edges.len() {
            if ring.is_sharp(ring.firsts[k]) {
                ring.add(ring.line.arcs()[ring.firsts[k]]);
            }
        }
        Some(ring)
    }

    fn length_m(&self) -> f64 {
        self.line.length()
    }

    /// Whether the outline turns at a vertex.
    fn is_sharp(&self, vertex: usize) -> bool {
        let (points, n) = (self.line.points(), self.line.points().len() - 1);
        let at = points[vertex % n];
        (at - points[(vertex + n - 1) % n]).angle(&(points[vertex % n + 1] - at)) > SMOOTH_RAD
    }

    /// Arc length of a place that moves; that of the first vertex for the last.
    fn arc_m(&self, one: &Move) -> f64 {
        let arc_m = self.line.arcs()[self.firsts[one.at.edge.edge]] + one.at.arc_m;
        if arc_m > self.length_m() - SAME_M { 0.0 } else { arc_m }
    }

    /// Number of the knot at an arc length, or of the place where it would be.
    fn knot(&self, arc_m: f64) -> usize {
        self.knots.partition_point(|knot| *knot < arc_m - SAME_M)
    }

    fn add(&mut self, arc_m: f64) {
        let at = self.knot(arc_m);
        if self.knots.get(at).is_none_or(|knot| (knot - arc_m).abs() > SAME_M) {
            self.knots.insert(at, arc_m);
        }
    }

    /// What some moves tell of each knot.
    fn told(&self, moves: &[Move]) -> Vec<V2> {
        let mut told = vec![V2::zeros(); self.knots.len()];
        for one in moves {
            told[self.knot(self.arc_m(one))] += one.by;
        }
        told
    }

    /// Stretches between neighbouring knots, the last one over the first vertex.
    fn stretches(&self) -> impl Iterator<Item = (Stretch, [usize; 2])> + '_ {
        let n = self.knots.len();
        (0..n).map(move |k| {
            let next = (k + 1) % n;
            let to = if next > k { self.knots[next] } else { self.knots[next] + self.length_m() };
            (Stretch::new(self, [self.knots[k], to]), [k, next])
        })
    }

    /// Arc lengths between which moves bend the outline: where they move it, and it does not stay straight.
    fn bent(&self, moves: &[Move]) -> Vec<[f64; 2]> {
        let told = self.told(moves);
        let is_moved = |knot: usize| told[knot] != V2::zeros();
        let bent =
            self.stretches().filter(|(stretch, ends)| !stretch.is_stiff && ends.iter().any(|end| is_moved(*end)));
        let arcs = bent.flat_map(|(stretch, _)| {
            let [from, to] = stretch.arcs_m;
            [[from, to], [from - self.length_m(), to - self.length_m()]]
        });
        arcs.collect()
    }

    /// Displacement of each vertex, the first one once.
    fn moved(&self, moves: &[Move]) -> Vec<V2> {
        let told = self.told(moves);
        let n = self.line.points().len() - 1;
        let mut moved = vec![V2::zeros(); n];
        for (stretch, [from, to]) in self.stretches() {
            for (vertex, moved) in moved.iter_mut().enumerate() {
                let arcs = [0.0, self.length_m()].map(|round_m| self.line.arcs()[vertex] + round_m);
                let within = arcs
                    .into_iter()
                    .find(|arc| (stretch.arcs_m[0] - SAME_M..=stretch.arcs_m[1] + SAME_M).contains(arc));
                if let Some(arc_m) = within {
                    *moved = stretch.between(stretch.share(self.line.points()[vertex], arc_m), [told[from], told[to]]);
                }
            }
        }
        moved
    }
}

/// A line with vertices at some of its arc lengths, and no long segment.
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

/// The part of an outline between two knots.
struct Stretch {
    /// Arc lengths of its ends; beyond the outline's length where it goes over the first vertex.
    arcs_m: [f64; 2],
    ends: [V2; 2],
    /// Unit vectors along the outline at both ends.
    along: [V2; 2],
    /// Whether places on it go by its chord; by arc length where it turns back on that.
    by_chord: bool,
    /// Whether it is straight from corner to corner, and stays so.
    is_stiff: bool,
}

impl Stretch {
    fn new(ring: &Ring, arcs_m: [f64; 2]) -> Self {
        let length_m = ring.length_m();
        let at = |arc: f64| ring.line.at(if arc > length_m { arc - length_m } else { arc });
        let ends = arcs_m.map(at);
        let step = END_SHARE * (arcs_m[1] - arcs_m[0]);
        let unit = |way: V2| way.try_normalize(0.0).unwrap_or_else(V2::zeros);
        let along = [unit(at(arcs_m[0] + step) - ends[0]), unit(ends[1] - at(arcs_m[1] - step))];
        let arcs = ring.line.arcs();
        let rounds = [0.0, length_m].into_iter().flat_map(|round_m| arcs.iter().map(move |arc| arc + round_m));
        let inner: Vec<V2> =
            rounds.filter(|arc| (arcs_m[0] + SAME_M..arcs_m[1] - SAME_M).contains(arc)).map(at).collect();
        let chord = ends[1] - ends[0];
        let axis = unit(chord);
        let mut places = vec![ends[0].dot(&axis)];
        places.extend(inner.iter().map(|p| p.dot(&axis)));
        places.push(ends[1].dot(&axis));
        let goes_on = places.windows(2).all(|pair| pair[1] >= pair[0] - SAME_M);
        let is_straight = inner.iter().all(|p| segment_distance(&ends[0], &ends[1], p) < STRAIGHT_M);
        let is_corner = |arc: f64| {
            let arc = if arc > length_m - SAME_M { arc - length_m } else { arc };
            ring.firsts.iter().any(|first| (arcs[*first] - arc).abs() < SAME_M && ring.is_sharp(*first))
        };
        Self {
            arcs_m,
            ends,
            along,
            by_chord: goes_on && chord.norm() > ALONG_CHORD * (arcs_m[1] - arcs_m[0]),
            is_stiff: is_straight && arcs_m.into_iter().all(is_corner),
        }
    }

    /// How far a place lies along the stretch, from 0 to 1.
    fn share(&self, place: V2, arc_m: f64) -> f64 {
        let chord = self.ends[1] - self.ends[0];
        if self.by_chord {
            (place - self.ends[0]).dot(&chord) / chord.norm_squared()
        } else {
            (arc_m - self.arcs_m[0]) / (self.arcs_m[1] - self.arcs_m[0]).max(f64::MIN_POSITIVE)
        }
    }

    /// The displacement at a share of the stretch.
    fn between(&self, t: f64, [from, to]: [V2; 2]) -> V2 {
        let change = to - from;
        if self.is_stiff {
            return from + change * t;
        }
        let slope = |end: usize| self.along[end] * change.dot(&self.along[end]);
        let (square, cube) = (t * t, t * t * t);
        let bent = slope(0) * (cube - 2.0 * square + t) + slope(1) * (cube - square);
        from + change * (3.0 * square - 2.0 * cube) + bent
    }
}
