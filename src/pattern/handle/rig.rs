//! Outlines displaced by knots: places whose displacement is told. Every corner is one, and stays where nothing is told of it.
//!
//! Between two knots the displacement goes from the one to the other: evenly along the edge, smoothly across it. So an edge keeps its
//! direction at every knot, and with it its right angles and its smooth joints; only a straight edge from corner to corner stays straight.

use std::collections::BTreeMap;

use super::plan::Move;
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
/// Greatest length of a segment of what bends, m: a side seam of 200 mm moved by 10 is followed within 0.01 mm.
const SEGMENT_M: f64 = 10e-3;
/// Distance from a vertex within which a knot needs none of its own, m.
const BESIDE_M: f64 = 0.5e-3;

/// Displacement of the vertices of each edge of the pieces that are touched.
pub type Displacement = BTreeMap<usize, Vec<Vec<V2>>>;

/// Knots of the outlines of a style.
pub struct Rig<'a> {
    style: &'a Style,
    /// Arc lengths of the knots of each edge of the pieces that are touched, both ends among them.
    knots: BTreeMap<usize, Vec<Vec<f64>>>,
}

/// What is told of a knot.
#[derive(Clone, Copy)]
struct Told {
    by: V2,
    bend: V2,
}

impl<'a> Rig<'a> {
    /// Knots of all the places that may move.
    pub fn new<'m>(style: &'a Style, moves: impl Iterator<Item = &'m Move>) -> Self {
        let mut knots: BTreeMap<usize, Vec<Vec<f64>>> = BTreeMap::new();
        for one in moves {
            let EdgeRef { piece, edge } = one.at.edge;
            let ends = || style.pieces[piece].edges.iter().map(|edge| vec![0.0, edge.line.length()]).collect();
            let arcs = &mut knots.entry(piece).or_insert_with(ends)[edge];
            let at = arcs.partition_point(|arc| *arc < one.at.arc_m - SAME_M);
            if arcs.get(at).is_none_or(|arc| (arc - one.at.arc_m).abs() > SAME_M) {
                arcs.insert(at, one.at.arc_m);
            }
        }
        Self { style, knots }
    }

    /// The pieces that are touched.
    pub fn pieces(&self) -> impl Iterator<Item = usize> + '_ {
        self.knots.keys().copied()
    }

    /// The style with vertices enough on the edges that some moves bend.
    pub fn refined(&self, moves: &[Move]) -> Style {
        let mut style = self.style.clone();
        for (piece, told) in self.told(moves) {
            for (k, told) in told.iter().enumerate() {
                let edge = EdgeRef { piece, edge: k };
                let is_moved = told.iter().any(|told| told.by != V2::zeros() || told.bend != V2::zeros());
                if is_moved && !self.is_stiff(edge) {
                    let line = &mut style.pieces[piece].edges[k].line;
                    *line = refined(line, &self.knots[&piece][k]);
                }
            }
        }
        style
    }

    /// Displacement of every vertex by some moves, per metre of amount.
    pub fn displacement(&self, moves: &[Move]) -> Displacement {
        let edges = |(piece, told): (usize, Vec<Vec<Told>>)| {
            let moved = told.iter().enumerate().map(|(edge, told)| self.edge(EdgeRef { piece, edge }, told));
            (piece, moved.collect())
        };
        self.told(moves).into_iter().map(edges).collect()
    }

    /// What some moves tell of each knot.
    fn told(&self, moves: &[Move]) -> BTreeMap<usize, Vec<Vec<Told>>> {
        let zero = Told { by: V2::zeros(), bend: V2::zeros() };
        let each = |edges: &Vec<Vec<f64>>| edges.iter().map(|arcs| vec![zero; arcs.len()]).collect::<Vec<_>>();
        let mut told: BTreeMap<usize, Vec<Vec<Told>>> =
            self.knots.iter().map(|(piece, edges)| (*piece, each(edges))).collect();
        for one in moves {
            let EdgeRef { piece, edge } = one.at.edge;
            let (Some(knots), Some(told)) = (self.knots.get(&piece), told.get_mut(&piece)) else { continue };
            let knot = knots[edge].partition_point(|arc| *arc < one.at.arc_m - SAME_M);
            let (last, n) = (knots[edge].len() - 1, knots.len());
            let mut tell = |edge: usize, knot: usize| {
                told[edge][knot].by += one.by;
                told[edge][knot].bend += one.bend;
            };
            tell(edge, knot);
            // A corner belongs to both of its edges.
            if knot == 0 {
                tell((edge + n - 1) % n, knots[(edge + n - 1) % n].len() - 1);
            } else if knot == last {
                tell((edge + 1) % n, 0);
            }
        }
        told
    }

    /// Whether an edge stays straight: from corner to corner, with no knot between.
    fn is_stiff(&self, edge: EdgeRef) -> bool {
        let has_no_knot = self.knots[&edge.piece][edge.edge].len() == 2;
        has_no_knot && is_straight(self.style.edge(edge)) && self.has_corners(edge)
    }

    fn edge(&self, edge: EdgeRef, told: &[Told]) -> Vec<V2> {
        let arcs = &self.knots[&edge.piece][edge.edge];
        let line = &self.style.edge(edge).line;
        let is_stiff = self.is_stiff(edge);
        let mut moved = vec![V2::zeros(); line.points().len()];
        for (knots, told) in arcs.windows(2).zip(told.windows(2)) {
            let stretch = Stretch::new(self.style.edge(edge), [knots[0], knots[1]]);
            for (k, arc) in line.arcs().iter().enumerate() {
                if (knots[0] - SAME_M..=knots[1] + SAME_M).contains(arc) {
                    moved[k] = stretch.between(stretch.share(line.points()[k], *arc), told, is_stiff);
                }
            }
        }
        moved
    }

    /// Whether the outline turns at both ends of an edge.
    fn has_corners(&self, edge: EdgeRef) -> bool {
        let edges = &self.style.pieces[edge.piece].edges;
        let n = edges.len();
        let own = edges[edge.edge].line.points();
        let (before, after) = (
            edges[(edge.edge + n - 1) % n].line.points(),
            edges[(edge.edge + 1) % n].line.points(),
        );
        let first = |points: &[V2]| points[1] - points[0];
        let last = |points: &[V2]| points[points.len() - 1] - points[points.len() - 2];
        last(before).angle(&first(own)) > SMOOTH_RAD && last(own).angle(&first(after)) > SMOOTH_RAD
    }
}

/// Whether an edge is straight.
fn is_straight(edge: &Edge) -> bool {
    let points = edge.line.points();
    let (from, to) = (points[0], points[points.len() - 1]);
    points.iter().all(|p| segment_distance(&from, &to, p) < STRAIGHT_M)
}

/// A line with vertices at some of its arc lengths, and no long segment.
fn refined(line: &Polyline, knots: &[f64]) -> Polyline {
    let mut ends = line.arcs().to_vec();
    for knot in knots {
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

/// The part of an edge between two knots.
struct Stretch {
    arcs_m: [f64; 2],
    ends: [V2; 2],
    /// Unit vectors along the edge at both ends.
    along: [V2; 2],
    /// Whether places on it go by its chord; by arc length where it turns back on that.
    by_chord: bool,
}

impl Stretch {
    fn new(edge: &Edge, arcs_m: [f64; 2]) -> Self {
        let line = &edge.line;
        let ends = arcs_m.map(|arc| line.at(arc));
        let step = END_SHARE * (arcs_m[1] - arcs_m[0]);
        let unit = |way: V2| way.try_normalize(0.0).unwrap_or_else(V2::zeros);
        let along = [unit(line.at(arcs_m[0] + step) - ends[0]), unit(ends[1] - line.at(arcs_m[1] - step))];
        let chord = ends[1] - ends[0];
        let axis = unit(chord);
        let inner = line.arcs().iter().zip(line.points()).filter(|(arc, _)| (arcs_m[0]..arcs_m[1]).contains(*arc));
        let mut places = vec![ends[0].dot(&axis)];
        places.extend(inner.map(|(_, p)| p.dot(&axis)));
        places.push(ends[1].dot(&axis));
        let goes_on = places.windows(2).all(|pair| pair[1] >= pair[0] - SAME_M);
        let is_along = goes_on && chord.norm() > ALONG_CHORD * (arcs_m[1] - arcs_m[0]);
        Self { arcs_m, ends, along, by_chord: is_along }
    }

    /// How far a place of the edge lies along the stretch, from 0 to 1.
    fn share(&self, place: V2, arc_m: f64) -> f64 {
        let chord = self.ends[1] - self.ends[0];
        if self.by_chord {
            (place - self.ends[0]).dot(&chord) / chord.norm_squared()
        } else {
            (arc_m - self.arcs_m[0]) / (self.arcs_m[1] - self.arcs_m[0]).max(f64::MIN_POSITIVE)
        }
    }

    /// The displacement at a share of the stretch.
    fn between(&self, t: f64, told: &[Told], is_stiff: bool) -> V2 {
        let [from, to] = [told[0], told[1]];
        let change = to.by - from.by;
        if is_stiff {
            return from.by + change * t;
        }
        let length_m = self.arcs_m[1] - self.arcs_m[0];
        let slope = |end: usize, told: Told| self.along[end] * change.dot(&self.along[end]) + told.bend * length_m;
        let (square, cube) = (t * t, t * t * t);
        from.by
            + change * (3.0 * square - 2.0 * cube)
            + slope(0, from) * (cube - 2.0 * square + t)
            + slope(1, to) * (cube - square)
    }
}
