//! Straight paths across the cloth: across a piece to its outline, through the seam there, and across the next piece.
//!
//! This is how a tape runs on a flat garment. A path that meets a dart continues from the other edge of the dart, so
//! the cloth in the dart is not measured.

use std::collections::BTreeMap;

use crate::style::{EdgePoint, EdgeRef, PathPart, Style};
use geom::V2;
use geom::polyline::{contains, segment_meeting};

const REACH_M: f64 = 10.0;
/// Least length of a path in one piece. A nearer intersection is with the edge at which the path starts.
const LEAST_M: f64 = 1e-5;
const MOST_PIECES: usize = 64;
/// Cosine of the angle between an edge and the way down above which the edge is an opening: 45 degrees.
const UPRIGHT: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Distance from its start at which a path round the body counts as closed.
const BACK_M: f64 = 0.05;

/// Direction of a path, as the garment is worn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// Round the body or the limb.
    Level,
    /// Away from the neck, along the body or the limb.
    Down,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    /// Straight, one for each piece.
    pub parts: Vec<PathPart>,
    pub end: EdgePoint,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PiecePoint {
    pub piece: usize,
    pub at: V2,
}

#[derive(Clone, Copy)]
struct Sewn {
    seam: usize,
    is_b: bool,
    /// Distance along the side, in the direction of sewing, at which the edge begins.
    from_m: f64,
}

/// Seams of a style by their edges, for paths to cross.
pub struct Ways<'a> {
    pub style: &'a Style,
    sewn: BTreeMap<EdgeRef, Sewn>,
    /// Unit vectors away from the neck. `None` for a piece in which a path keeps the direction in which it came.
    down: Vec<Option<V2>>,
}

impl<'a> Ways<'a> {
    /// `down` is the unit vector away from the neck in each piece.
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

    /// `None` as of [`Ways::new`].
    pub fn down(&self, piece: usize) -> Option<V2> {
        self.down[piece]
    }

    pub fn is_free(&self, edge: EdgeRef) -> bool {
        !self.sewn.contains_key(&edge)
    }

    /// Edges on the other side of the seam. Empty for a free edge.
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

    /// Point that is sewn to a point of an edge, at the same share of the other side. `None` for a free edge.
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

    /// Direction of sewing at a point of an edge. For a free edge, the direction of the edge.
    fn sewn_along(&self, point: EdgePoint) -> V2 {
        let line = &self.style.edge(point.edge).line;
        let ahead = line.at(point.arc_m + LEAST_M) - line.at(point.arc_m - LEAST_M);
        let forwards = self.sewn.get(&point.edge).is_none_or(|sewn| self.is_forwards(sewn));
        if forwards { ahead.normalize() } else { -ahead.normalize() }
    }

    /// Candidates. `came` is the direction in which the path entered the piece, `None` at its start.
    fn directions(&self, at: EdgePoint, heading: Heading, came: Option<V2>) -> Vec<V2> {
        match (self.down[at.edge.piece], heading, came) {
            // Beside a dart the straight direction may lead off the piece. Then the path keeps its direction.
            (Some(down), Heading::Down, came) => [Some(down), came].into_iter().flatten().collect(),
            (Some(down), Heading::Level, came) => {
                let level = V2::new(-down.y, down.x);
                [Some(level), Some(-level), came].into_iter().flatten().collect()
            }
            (None, _, Some(came)) => vec![came],
            (None, _, None) => vec![self.inwards(at)],
        }
    }

    fn inwards(&self, at: EdgePoint) -> V2 {
        let line = &self.style.edge(at.edge).line;
        let ahead = (line.at(at.arc_m + LEAST_M) - line.at(at.arc_m - LEAST_M)).normalize();
        V2::new(-ahead.y, ahead.x)
    }

    /// `None` if the path does not enter the piece.
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

    /// Path from a point of an edge to the first point of an outline for which `is_end` is true, or to a free edge.
    /// `None` if no cloth lies in that direction.
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

    /// `None` past the ends of the path.
    pub fn along(&self, path: &[PathPart], distance_m: f64) -> Option<PiecePoint> {
        let mut rest_m = (distance_m >= 0.0).then_some(distance_m)?;
        for part in path {
            let PathPart::Line([from, to]) = part else { return None };
            let (start, end) = (self.style.place(*from), self.style.place(*to));
            let length_m = (end - start).norm();
            if rest_m <= length_m {
                return Some(PiecePoint { piece: from.edge.piece, at: start.lerp(&end, rest_m / length_m) });
            }
            rest_m -= length_m;
        }
        None
    }

    /// Path round the body or a limb from a point of a sewn edge back to that point, or in an open garment from one
    /// free edge to the other. `None` if no cloth lies in that direction.
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
        self.is_opening(ahead.end).then(|| self.open_round(ahead.parts, from))?
    }

    /// As [`Ways::round`], through a point inside a piece.
    pub fn round_through(&self, PiecePoint { piece, at }: PiecePoint) -> Option<Vec<PathPart>> {
        let down = self.down[piece]?;
        let level = V2::new(-down.y, down.x);
        let [ahead, behind] = [self.leaves(piece, at, level)?, self.leaves(piece, at, -level)?];
        let across = PathPart::Line([behind, ahead]);
        let start = self.style.place(behind);
        let is_back = |end: EdgePoint| {
            let next = self.across(end).filter(|next| next.edge.piece == piece);
            next.is_some_and(|next| (self.style.place(next) - start).norm() < BACK_M)
        };
        let mut path = vec![across];
        // A piece that is sewn to itself closes the path alone.
        if is_back(ahead) {
            return Some(path);
        }
        let Some(next) = self.across(ahead) else {
            return self.is_opening(ahead).then(|| self.open_round(path, behind))?;
        };
        let rest = self.walk(next, Heading::Level, is_back)?;
        path.extend(rest.parts);
        match is_back(rest.end) {
            true => Some(path),
            false => self.is_opening(rest.end).then(|| self.open_round(path, behind))?,
        }
    }

    /// True for a point of an edge that runs down the garment, as a front edge does. A level path that ends at a waist, a
    /// hem or a neckline has left the cloth, and does not go round.
    fn is_opening(&self, end: EdgePoint) -> bool {
        self.down[end.edge.piece].is_none_or(|down| self.sewn_along(end).dot(&down).abs() > UPRIGHT)
    }

    fn open_round(&self, mut path: Vec<PathPart>, start: EdgePoint) -> Option<Vec<PathPart>> {
        let mut end = start;
        if let Some(next) = self.across(start) {
            let rest = self.walk(next, Heading::Level, |_| false)?;
            end = rest.end;
            path.extend(rest.parts);
        }
        self.is_opening(end).then_some(path)
    }
}
