//! Straight ways across the cloth: over a piece from outline to outline, on through the seam there, and over the next piece.
//!
//! A tape that is laid on a flat garment does the same. Where a way meets a dart, it goes on from the other leg: what the dart takes in is
//! not measured.

use std::collections::BTreeMap;

use crate::style::{EdgePoint, EdgeRef, PathPart, Style};
use geom::V2;
use geom::polyline::{contains, segment_meeting};

/// Farthest that a way may go in one piece, m.
const REACH_M: f64 = 10.0;
/// Least length of a way in one piece, m: nearer, it is still at the edge that it starts from.
const LEAST_M: f64 = 1e-5;
/// Most pieces that a way crosses.
const MOST_PIECES: usize = 64;
/// Distance from its start within which a way round has come back to it, m.
const BACK_M: f64 = 0.05;

/// Where a way goes, as the garment is worn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// Round the body or the limb.
    Level,
    /// Away from the neck, along the body or the limb.
    Down,
}

/// A way across the cloth.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Its straight parts, one a piece.
    pub parts: Vec<PathPart>,
    /// Where it ends.
    pub end: EdgePoint,
}

/// Place of an edge in a seam.
#[derive(Clone, Copy)]
struct Sewn {
    seam: usize,
    is_b: bool,
    /// Distance from the side's first point to the edge's, in the order of sewing, m.
    from_m: f64,
}

/// The seams of a style as ways cross them.
pub struct Ways<'a> {
    /// The style whose pieces are crossed.
    pub style: &'a Style,
    sewn: BTreeMap<EdgeRef, Sewn>,
    /// Unit vector away from the neck in each piece; `None` of a piece that hangs as the seam it is sewn to.
    down: Vec<Option<V2>>,
}

impl<'a> Ways<'a> {
    /// The ways of a style; `down` is the unit vector away from the neck in each piece.
    pub fn new(style: &'a Style, down: Vec<Option<V2>>) -> Self {
        let mut sewn = BTreeMap::new();
        for (seam, joined) in style.seams.iter().enumerate() {
            for (is_b, chain) in [(false, &joined.a), (true, &joined.b)] {
                let mut from_m = 0.0;
                for &edge in chain {
                    sewn.insert(edge, Sewn { seam, is_b, from_m });
                    from_m += style.edge(edge).line.length();
                }
            }
        }
        Self { style, sewn, down }
    }

    /// Unit vector away from the neck in a piece.
    pub fn down(&self, piece: usize) -> Option<V2> {
        self.down[piece]
    }

    /// Whether nothing is sewn to an edge.
    pub fn is_free(&self, edge: EdgeRef) -> bool {
        !self.sewn.contains_key(&edge)
    }

    /// The edges that are sewn to an edge's side of its seam.
    pub fn partners(&self, edge: EdgeRef) -> &'a [EdgeRef] {
        let side = |sewn: &Sewn| self.side(sewn.seam, !sewn.is_b);
        self.sewn.get(&edge).map_or(&[], side)
    }

    fn side(&self, seam: usize, is_b: bool) -> &'a [EdgeRef] {
        let seam = &self.style.seams[seam];
        if is_b { &seam.b } else { &seam.a }
    }

    fn is_forwards(&self, sewn: &Sewn) -> bool {
        !sewn.is_b || self.style.seams[sewn.seam].b_forwards
    }

    fn length_m(&self, chain: &[EdgeRef]) -> f64 {
        chain.iter().map(|edge| self.style.edge(*edge).line.length()).sum()
    }

    /// The point that is sewn to a point of an edge, at the same share of its side; `None` of a free edge.
    pub fn across(&self, point: EdgePoint) -> Option<EdgePoint> {
        let sewn = self.sewn.get(&point.edge)?;
        let along = |edge: EdgeRef, arc_m: f64, forwards: bool| {
            if forwards { arc_m } else { self.style.edge(edge).line.length() - arc_m }
        };
        let (own, other) = (self.side(sewn.seam, sewn.is_b), self.side(sewn.seam, !sewn.is_b));
        let distance_m = sewn.from_m + along(point.edge, point.arc_m, self.is_forwards(sewn));
        let mut rest_m = distance_m * self.length_m(other) / self.length_m(own).max(f64::MIN_POSITIVE);
        for (k, &edge) in other.iter().enumerate() {
            let length_m = self.style.edge(edge).line.length();
            if rest_m <= length_m || k + 1 == other.len() {
                let forwards = self.is_forwards(&Sewn { is_b: !sewn.is_b, ..*sewn });
                return Some(EdgePoint { edge, arc_m: along(edge, rest_m.min(length_m), forwards) });
            }
            rest_m -= length_m;
        }
        None
    }

    /// Direction in which a seam is sewn at a point of one of its edges; of a free edge its own.
    fn sewn_along(&self, point: EdgePoint) -> V2 {
        let line = &self.style.edge(point.edge).line;
        let ahead = line.at(point.arc_m + LEAST_M) - line.at(point.arc_m - LEAST_M);
        let forwards = self.sewn.get(&point.edge).is_none_or(|sewn| self.is_forwards(sewn));
        if forwards { ahead.normalize() } else { -ahead.normalize() }
    }

    /// Directions that a way may take from a point; `turn` turns the direction in which it came to the seam into the point's piece.
    fn directions(&self, at: EdgePoint, heading: Heading, came: Option<V2>) -> Vec<V2> {
        match (self.down[at.edge.piece], heading, came) {
            // Into what a dart turns the cloth where there is none straight on.
            (Some(down), Heading::Down, came) => [Some(down), came].into_iter().flatten().collect(),
            (Some(down), Heading::Level, came) => {
                let level = V2::new(-down.y, down.x);
                [Some(level), Some(-level), came].into_iter().flatten().collect()
            }
            (None, _, Some(came)) => vec![came],
            (None, _, None) => vec![self.inwards(at)],
        }
    }

    /// Direction at right angles to an edge, into its piece.
    fn inwards(&self, at: EdgePoint) -> V2 {
        let line = &self.style.edge(at.edge).line;
        let ahead = (line.at(at.arc_m + LEAST_M) - line.at(at.arc_m - LEAST_M)).normalize();
        V2::new(-ahead.y, ahead.x)
    }

    /// Where a straight way from a point leaves its piece; `None` where it does not enter it.
    fn leaves(&self, piece: usize, start: V2, direction: V2) -> Option<EdgePoint> {
        let ray = (start, start + direction * REACH_M);
        let mut nearest: Option<(f64, EdgePoint)> = None;
        for (edge, drawn) in self.style.pieces[piece].edges.iter().enumerate() {
            for (ends, arcs) in drawn.line.points().windows(2).zip(drawn.line.arcs().windows(2)) {
                let Some((s, t)) = segment_meeting(ray, (ends[0], ends[1])) else { continue };
                let way_m = s * REACH_M;
                if way_m > LEAST_M && nearest.is_none_or(|(least, _)| way_m < least) {
                    let arc_m = arcs[0] + t * (arcs[1] - arcs[0]);
                    nearest = Some((way_m, EdgePoint { edge: EdgeRef { piece, edge }, arc_m }));
                }
            }
        }
        let (way_m, end) = nearest?;
        let middle = start + direction * (0.5 * way_m);
        contains(&self.style.pieces[piece].outline(), &middle).then_some(end)
    }

    /// The way from a point of an edge until `is_end` says so of a point that it comes to, or the edge there is free; `None` where
    /// no cloth lies that way.
    pub fn walk(&self, from: EdgePoint, heading: Heading, is_end: impl Fn(EdgePoint) -> bool) -> Option<Way> {
        let (mut at, mut came, mut parts) = (from, None, Vec::new());
        while parts.len() < MOST_PIECES {
            let directions = self.directions(at, heading, came);
            let (direction, end) =
                directions.into_iter().find_map(|d| Some((d, self.leaves(at.edge.piece, self.style.place(at), d)?)))?;
            parts.push(PathPart::Line([at, end]));
            match self.across(end) {
                Some(next) if !is_end(end) => {
                    let [u, v] = [self.sewn_along(end), self.sewn_along(next)];
                    let turn = u.perp(&v).atan2(u.dot(&v));
                    let (sin, cos) = turn.sin_cos();
                    came = Some(V2::new(cos * direction.x - sin * direction.y, sin * direction.x + cos * direction.y));
                    at = next;
                }
                _ => return Some(Way { parts, end }),
            }
        }
        None
    }

    /// The point at a distance along a path of straight parts, m, and its piece; `None` beyond its ends.
    pub fn along(&self, path: &[PathPart], distance_m: f64) -> Option<(usize, V2)> {
        let mut rest_m = (distance_m >= 0.0).then_some(distance_m)?;
        for part in path {
            let PathPart::Line([from, to]) = part else { return None };
            let (start, end) = (self.style.place(*from), self.style.place(*to));
            let length_m = (end - start).norm();
            if rest_m <= length_m {
                return Some((from.edge.piece, start.lerp(&end, rest_m / length_m)));
            }
            rest_m -= length_m;
        }
        None
    }

    /// The way round the body or a limb from a point of a sewn edge: until it comes back, or where the garment is open, from one
    /// free edge to the other.
    pub fn round(&self, from: EdgePoint) -> Option<Vec<PathPart>> {
        let start = self.style.place(from);
        let is_back = |end: EdgePoint| {
            let next = self.across(end).filter(|next| next.edge.piece == from.edge.piece);
            next.is_some_and(|next| (self.style.place(next) - start).norm() < BACK_M)
        };
        let ahead = self.walk(from, Heading::Level, is_back)?;
        if is_back(ahead.end) {
            return Some(ahead.parts);
        }
        self.open_round(ahead.parts, from)
    }

    /// The way round the body or a limb through a point within a piece, likewise.
    pub fn round_through(&self, piece: usize, at: V2) -> Option<Vec<PathPart>> {
        let down = self.down[piece]?;
        let level = V2::new(-down.y, down.x);
        let [one, other] = [self.leaves(piece, at, level)?, self.leaves(piece, at, -level)?];
        let across = PathPart::Line([other, one]);
        let start = self.style.place(other);
        let is_back = |end: EdgePoint| {
            let next = self.across(end).filter(|next| next.edge.piece == piece);
            next.is_some_and(|next| (self.style.place(next) - start).norm() < BACK_M)
        };
        let mut path = vec![across];
        // A piece that is sewn to itself goes round by itself.
        if is_back(one) {
            return Some(path);
        }
        let Some(next) = self.across(one) else { return self.open_round(path, other) };
        let ahead = self.walk(next, Heading::Level, is_back)?;
        let came_back = is_back(ahead.end);
        path.extend(ahead.parts);
        if came_back { Some(path) } else { self.open_round(path, other) }
    }

    /// The rest of a way round that came to a free edge: the other way from its start.
    fn open_round(&self, mut path: Vec<PathPart>, start: EdgePoint) -> Option<Vec<PathPart>> {
        if let Some(next) = self.across(start) {
            path.extend(self.walk(next, Heading::Level, |_| false)?.parts);
        }
        Some(path)
    }
}
