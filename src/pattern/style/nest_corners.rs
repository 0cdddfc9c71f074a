//! Corners tracked from size to size of a nest, beginning with the size that the seam file was made on.
//!
//! Between neighbouring sizes an outline changes little. If a program grades the vertices of an outline one by one, all
//! sizes have the same vertices in the same order, and a corner keeps its index. If it redraws curves in each size, a
//! corner is the vertex that is nearest in position, headings and grade rule.

use super::corners::corner_vertices;
use super::correspond::{CORNER_WORTH, Lost, corresponding, extent, matched, places};
use crate::piece::Piece;
use geom::V2;

/// Arc length over which the heading of an outline at a vertex is taken, divided by the size of the piece.
const HEADING_REACH: f64 = 0.02;
/// Penalty per radian of difference in heading, as a distance divided by the size of the piece. A vertex beside a fork
/// differs from the fork by a right angle on one side. It is not taken for the fork even if it is nearer by a twelfth
/// of the leg.
const RADIAN_WORTH: f64 = 0.05;
/// Greatest change of a heading at a corner between neighbouring sizes with corresponding vertex indices, radians.
const SAME_HEADING: f64 = 0.35;
const ON_VERTEX_M: f64 = 0.5e-3;

/// Corners, as vertices of an outline, that the edges of a seam file refer to. `places` are the shares in its
/// `corners_at`; without any, the corners are those of the piece. They are found on the size `made_on`, if the nest has
/// it, and tracked from there.
pub(crate) fn corners_of(piece: &Piece, made_on: Option<&str>, places: &[[f64; 2]]) -> Result<Vec<usize>, Lost> {
    let found = |piece: &Piece| match places {
        [] => Ok(corner_vertices(piece)),
        places => corresponding(piece, places),
    };
    let index_of = |size: Option<&str>| {
        let size = size?;
        piece
            .beside
            .sizes
            .iter()
            .position(|sized| sized.size.as_deref().is_some_and(|name| name.eq_ignore_ascii_case(size)))
    };
    let (Some(first), Some(last)) = (index_of(made_on), index_of(piece.size.as_deref())) else { return found(piece) };
    let low = first.min(last);
    let nest = &piece.beside.sizes[low..=first.max(last)];
    let mut corners = in_sizes(nest, first - low, &found(&piece.beside.sizes[first])?).map_err(|(_, lost)| lost)?;
    Ok(corners.swap_remove(last - low))
}

/// Vertices in all sizes of a piece, from the smallest, that correspond to corners of the size `sample`. The error has
/// the index of the size in which a corner has no counterpart.
pub(crate) fn in_sizes(sizes: &[Piece], sample: usize, corners: &[usize]) -> Result<Vec<Vec<usize>>, (usize, Lost)> {
    let mut found = vec![corners.to_vec(); sizes.len()];
    for size in sample + 1..sizes.len() {
        found[size] = followed(&sizes[size - 1], &found[size - 1], &sizes[size]).map_err(|lost| (size, lost))?;
    }
    for size in (0..sample).rev() {
        found[size] = followed(&sizes[size + 1], &found[size + 1], &sizes[size]).map_err(|lost| (size, lost))?;
    }
    Ok(found)
}

/// Takes the same piece in the neighbouring size.
fn followed(from: &Piece, corners: &[usize], to: &Piece) -> Result<Vec<usize>, Lost> {
    let (before, after) = (headings(from.seam_outline()), headings(to.seam_outline()));
    let unlike = |corner: usize, vertex: usize| -> [f64; 2] {
        [0, 1].map(|side| (after[vertex][side] - before[corner][side]).sin_cos()).map(|(sin, cos)| sin.atan2(cos))
    };
    if let Some(turn) = index_offset(from, to) {
        let vertices: Vec<usize> = corners.iter().map(|corner| (corner + turn) % after.len()).collect();
        let is_alike =
            |(&corner, &vertex): (&usize, &usize)| unlike(corner, vertex).iter().all(|by| by.abs() < SAME_HEADING);
        if corners.iter().zip(&vertices).all(is_alike) {
            return Ok(vertices);
        }
    }
    let (rules, turns) = ([rules(from), rules(to)], [turning(from), turning(to)]);
    let cost = |k: usize, vertex: usize| {
        let corner = corners[k];
        let heading: f64 = unlike(corner, vertex).iter().map(|by| (RADIAN_WORTH * by).powi(2)).sum();
        let is_other_rule = rules[0][corner].zip(rules[1][vertex]).is_some_and(|(rule, other)| rule != other);
        let is_blunt = turns[0][corner] && !turns[1][vertex];
        heading + CORNER_WORTH.powi(2) * (f64::from(is_other_rule) + f64::from(is_blunt))
    };
    matched(to.seam_outline(), &places(from.seam_outline(), corners), cost)
}

/// `None` if the numbers of vertices differ.
fn index_offset(from: &Piece, to: &Piece) -> Option<usize> {
    let (from, to) = (from.seam_outline(), to.seam_outline());
    let count = to.len();
    (from.len() == count).then_some(())?;
    let [low, high] = extent(to);
    let all: Vec<usize> = (0..count).collect();
    let scaled: Vec<V2> =
        places(from, &all).into_iter().map(|place| low + place.component_mul(&(high - low))).collect();
    let apart = |turn: usize| -> f64 { (0..count).map(|k| (scaled[k] - to[(k + turn) % count]).norm_squared()).sum() };
    (0..count).min_by(|turn, other| apart(*turn).total_cmp(&apart(*other)))
}

/// Before and after each vertex, radians.
fn headings(outline: &[V2]) -> Vec<[f64; 2]> {
    let count = outline.len();
    let [low, high] = extent(outline);
    let reach_m = HEADING_REACH * (high - low).norm();
    // First vertex at or beyond that arc length from a vertex in one direction.
    let far = |from: usize, step: usize| {
        let (mut at, mut way_m) = (from, 0.0);
        while way_m < reach_m && (at + step) % count != from {
            let next = (at + step) % count;
            way_m += (outline[next] - outline[at]).norm();
            at = next;
        }
        outline[at]
    };
    let headings_at = |vertex: usize| {
        let [back, on] = [outline[vertex] - far(vertex, count - 1), far(vertex, 1) - outline[vertex]];
        [back, on].map(|along| along.y.atan2(along.x))
    };
    (0..count).map(headings_at).collect()
}

/// True for each vertex that is a corner.
fn turning(piece: &Piece) -> Vec<bool> {
    let mut turns = vec![false; piece.seam_outline().len()];
    corner_vertices(piece).into_iter().for_each(|vertex| turns[vertex] = true);
    turns
}

/// `None` for a vertex without a grade rule.
fn rules(piece: &Piece) -> Vec<Option<u32>> {
    let rule_at = |vertex: &V2| {
        let is_on = |point: &&crate::piece::GradePoint| !point.is_inner && (point.at - vertex).norm() < ON_VERTEX_M;
        piece.grade_points.iter().find(is_on).map(|point| point.rule)
    };
    piece.seam_outline().iter().map(rule_at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::Model;
    use crate::piece::Beside;
    use crate::style::correspond::shares;
    use std::sync::Arc;

    /// Sizes of this number between which each vertex moves as from the first draft to the last.
    const SIZES: usize = 28;

    /// `kept` says which vertices a size has.
    fn nest(pieces: [&Piece; 2], kept: impl Fn(usize, usize) -> bool) -> Vec<Piece> {
        let size = |number: usize| {
            let share = 2.0 * number as f64 / SIZES as f64 - 0.5;
            let between = |(a, b): (&V2, &V2)| a.lerp(b, share);
            let all: Vec<V2> = pieces[0].outline.iter().zip(&pieces[1].outline).map(between).collect();
            let is_corner = |vertex: &usize| pieces[0].turn_points.contains(&pieces[0].outline[*vertex]);
            let outline: Vec<usize> =
                (0..all.len()).filter(|vertex| is_corner(vertex) || kept(number, *vertex)).collect();
            Piece {
                name: pieces[0].name.clone(),
                size: Some(number.to_string()),
                turn_points: outline.iter().filter(|vertex| is_corner(vertex)).map(|&vertex| all[vertex]).collect(),
                outline: outline.into_iter().map(|vertex| all[vertex]).collect(),
                ..Piece::default()
            }
        };
        (0..SIZES).map(size).collect()
    }

    #[test]
    fn corners_are_followed_through_sizes_far_apart() {
        let check = |kept: fn(usize, usize) -> bool, is_marked: bool| {
            for model in Model::ALL {
                let drafts = model.drafts();
                let (first, last) = (&drafts[0], &drafts[drafts.len() - 1]);
                for (one, other) in
                    first.pieces.iter().zip(&last.pieces).filter(|(a, b)| a.outline.len() == b.outline.len())
                {
                    let marked = nest([one, other], kept);
                    let expect: Vec<Vec<V2>> = marked.iter().map(|piece| piece.turn_points.clone()).collect();
                    let plain = |piece: &Piece| Piece { turn_points: Vec::new(), ..piece.clone() };
                    let sizes: Vec<Piece> = if is_marked { marked.clone() } else { marked.iter().map(plain).collect() };
                    let made_on = 5;
                    let places = shares(&marked[made_on].outline, &corner_vertices(&marked[made_on]));
                    for (piece, expect) in sizes.iter().zip(&expect) {
                        let piece = Piece {
                            beside: Beside { sizes: Arc::from(sizes.clone()), ..Beside::default() },
                            ..piece.clone()
                        };
                        let found = corners_of(&piece, Some("5"), &places)
                            .unwrap_or_else(|lost| panic!("{model:?} {} {:?}: {lost:?}", piece.name, piece.size));
                        let found: Vec<V2> = found.into_iter().map(|vertex| piece.outline[vertex]).collect();
                        assert_eq!(&found, expect, "{model:?} {} {:?}", piece.name, piece.size);
                    }
                }
            }
        };
        check(|_, _| true, true);
        check(|_, _| true, false);
        // Curves that each size draws by other points.
        check(|size, vertex| (vertex + size) % 3 != 0, true);
        check(|size, vertex| (vertex + size) % 3 != 0, false);
    }
}
