//! Cardinal points of a piece: those that a grade moves, while curves follow. They are the turn points, the notches,
//! the ends and bends of lines inside, drill holes and the grain.

use crate::piece::{Beside, Piece};
use crate::style::corners::corner_vertices;
use geom::V2;
use geom::polyline::Polyline;

const SAME_M: f64 = 0.1e-3;
/// Turning angle from which a vertex inside is a cardinal point, as that of a corner of an outline.
const BEND_RAD: f64 = 30.0 * std::f64::consts::PI / 180.0;
/// Spacing of the places of a side at which its displacement is examined.
const APART_M: f64 = 5e-3;
/// Least distance of such a place from the ends of its side: nearer, the corner sets the width.
const FROM_CORNER_M: f64 = 40e-3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Outline,
    SewLine,
    /// Keeps its place on the outline.
    Notch,
    /// Both ends move alike.
    Grain,
    /// On a line inside, or drill hole.
    Inner,
}

/// Point that takes a grade rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cardinal {
    pub piece: usize,
    /// In the sample size, m.
    pub at: V2,
    pub kind: Kind,
}

impl Cardinal {
    pub fn is_sewn(&self, piece: &Piece) -> bool {
        self.kind == if piece.sew_line.is_some() { Kind::SewLine } else { Kind::Outline }
    }
}

/// Part of an outline or sew line between two corners.
pub(super) struct Side {
    pub piece: usize,
    pub kind: Kind,
    /// From one corner to the other, both included, evenly spaced.
    pub places: Vec<V2>,
    /// Places that are far enough from both corners.
    pub inner: std::ops::Range<usize>,
}

fn lines(piece: &Piece) -> impl Iterator<Item = (Kind, &Vec<V2>)> {
    [(Kind::Outline, &piece.outline)].into_iter().chain(piece.sew_line.as_ref().map(|line| (Kind::SewLine, line)))
}

fn corners(piece: &Piece, line: &[V2]) -> Vec<usize> {
    let alone = Piece {
        outline: line.to_vec(),
        turn_points: piece.turn_points.clone(),
        internal_lines: piece.internal_lines.clone(),
        beside: Beside::default(),
        ..Piece::default()
    };
    let mut corners = corner_vertices(&alone);
    corners.sort_unstable();
    corners
}

pub(super) fn points(number: usize, piece: &Piece) -> Vec<Cardinal> {
    let mut all: Vec<Cardinal> = Vec::new();
    let mut mark = |at: V2, kind: Kind| {
        let is_known = |known: &Cardinal| known.kind == kind && (known.at - at).norm() < SAME_M;
        if !all.iter().any(is_known) {
            all.push(Cardinal { piece: number, at, kind });
        }
    };
    for (kind, line) in lines(piece) {
        corners(piece, line).into_iter().for_each(|vertex| mark(line[vertex], kind));
    }
    piece.notches.iter().for_each(|notch| mark(notch.at, Kind::Notch));
    for line in piece.internal_lines.iter().chain(&piece.cut_outs) {
        let bends = |k: &usize| {
            *k == 0 || *k + 1 == line.len() || (line[*k] - line[*k - 1]).angle(&(line[*k + 1] - line[*k])) > BEND_RAD
        };
        (0..line.len()).filter(bends).for_each(|k| mark(line[k], Kind::Inner));
    }
    piece.drill_holes.iter().for_each(|hole| mark(*hole, Kind::Inner));
    piece.grain.into_iter().flatten().for_each(|end| mark(end, Kind::Grain));
    all
}

pub(super) fn sides(number: usize, piece: &Piece) -> Vec<Side> {
    let of_line = |(kind, line): (Kind, &Vec<V2>)| -> Vec<Side> {
        let corners = corners(piece, line);
        let side = |k: usize| {
            let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
            let count = if to > from { to - from } else { to + line.len() - from };
            let curve = Polyline::new((0..=count).map(|step| line[(from + step) % line.len()]).collect())?;
            let parts = (curve.length() / APART_M).ceil().max(1.0);
            let far = (FROM_CORNER_M / curve.length() * parts).ceil() as usize;
            let places: Vec<V2> = (0..=parts as usize).map(|k| curve.at(curve.length() * k as f64 / parts)).collect();
            let inner = far..places.len().saturating_sub(far).max(far);
            Some(Side { piece: number, kind, places, inner })
        };
        (0..corners.len()).filter_map(side).collect()
    };
    lines(piece).flat_map(of_line).collect()
}

pub(super) fn with_vertex(line: &mut Vec<V2>, at: V2) {
    let n = line.len();
    let away = |k: &usize| geom::polyline::segment_distance(&line[*k], &line[(*k + 1) % n], &at);
    let Some(k) = (0..n).min_by(|a, b| away(a).total_cmp(&away(b))) else { return };
    if [k, (k + 1) % n].iter().all(|end| (line[*end] - at).norm() > SAME_M) {
        line.insert(k + 1, at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_notches_and_ends_are_cardinal_and_a_curve_is_not() {
        // A half disc on a rectangle: the curve meets the sides in corners that the file marks.
        let arc = (0..=20).map(|k| std::f64::consts::PI * f64::from(k) / 20.0);
        let mut outline = vec![V2::new(-0.1, 0.0), V2::new(0.1, 0.0)];
        outline.extend(arc.map(|angle| V2::new(0.1 * angle.cos(), 0.3 + 0.1 * angle.sin())));
        let turns = vec![outline[0], outline[1], outline[2], outline[22]];
        let piece = Piece {
            outline,
            turn_points: turns,
            internal_lines: vec![vec![V2::new(0.0, 0.1), V2::new(0.01, 0.15), V2::new(0.0, 0.2)]],
            drill_holes: vec![V2::new(0.05, 0.05)],
            ..Piece::default()
        };
        let found = points(0, &piece);
        let count = |kind: Kind| found.iter().filter(|point| point.kind == kind).count();
        assert_eq!([Kind::Outline, Kind::Inner, Kind::Notch, Kind::Grain].map(count), [4, 3, 0, 0]);
        let sides = sides(0, &piece);
        assert_eq!(sides.len(), 4);
        let side = sides.iter().find(|side| (side.places[0] - V2::new(0.1, 0.0)).norm() < 1e-9).expect("a side");
        assert!(side.inner.clone().all(|k| (0.04..=0.26).contains(&side.places[k].y)), "{:?}", side.inner);
    }
}
