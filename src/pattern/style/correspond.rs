//! Correspondence of corners between sizes, because a seam file is made on one size and holds for all.
//!
//! Grading keeps the order of the corners and moves each a little relative to the piece. The seam file has each corner
//! as shares of the width and height of the piece. They are scaled onto the outline of another size, and matched with
//! its vertices in cyclic order so that the sum of squared distances is least. A vertex that is no corner of that
//! outline costs a penalty.

use super::corners::corner_vertices;
use crate::piece::Piece;
use geom::V2;

/// Penalty of a vertex that is no corner, as a distance divided by the size of the piece: it is taken only if nearer by
/// this than every corner.
pub(super) const CORNER_WORTH: f64 = 0.03;
/// Greatest distance of corresponding corners, divided by the size of the piece.
const TOO_FAR: f64 = 0.15;
/// First round scales by the bounding boxes, the others fit the last match.
const ROUNDS: usize = 3;
/// Number of vertices that are tried for the first corner.
const STARTS: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lost {
    pub corner: usize,
    /// Distance from the vertex that matches best.
    pub away_m: f64,
}

/// Shares of width and height, rounded to 1e-5.
pub(crate) fn shares(outline: &[V2], vertices: &[usize]) -> Vec<[f64; 2]> {
    let rounded = |share: f64| (share * 1e5).round() / 1e5;
    places(outline, vertices).into_iter().map(|place| [place.x, place.y].map(rounded)).collect()
}

/// Shares of width and height.
pub(super) fn places(outline: &[V2], vertices: &[usize]) -> Vec<V2> {
    let [low, high] = extent(outline);
    let share = |at: V2, axis: usize| {
        let width = high[axis] - low[axis];
        if width > 0.0 { (at[axis] - low[axis]) / width } else { 0.0 }
    };
    vertices.iter().map(|&vertex| V2::new(share(outline[vertex], 0), share(outline[vertex], 1))).collect()
}

/// Vertices counter-clockwise as drawn. `shares` are the corners' positions in another size, as of [`shares`].
pub(super) fn corresponding(piece: &Piece, shares: &[[f64; 2]]) -> Result<Vec<usize>, Lost> {
    let mut worth = vec![CORNER_WORTH * CORNER_WORTH; piece.seam_outline().len()];
    corner_vertices(piece).iter().for_each(|&corner| worth[corner] = 0.0);
    let places: Vec<V2> = shares.iter().map(|&share| V2::from(share)).collect();
    matched(piece.seam_outline(), &places, |_, vertex| worth[vertex])
}

/// Vertices of an outline, in cyclic order, for corners at `places` (shares of width and height). `unlike(corner,
/// vertex)` is the penalty of a match: the square of a distance divided by the size of the piece.
pub(super) fn matched(outline: &[V2], places: &[V2], unlike: impl Fn(usize, usize) -> f64) -> Result<Vec<usize>, Lost> {
    let [low, high] = extent(outline);
    let size = (high - low).norm();
    if places.len() > outline.len() || size == 0.0 {
        return Err(Lost { corner: outline.len(), away_m: size });
    }
    let mut scaling = Scaling { scale: high - low, shift: low };
    let mut found = Vec::new();
    for _ in 0..ROUNDS {
        let expected: Vec<V2> = places.iter().map(|&place| scaling.applied(place)).collect();
        let cost = |k: usize, vertex: usize| {
            (expected[k] - outline[vertex]).norm_squared() / (size * size) + unlike(k, vertex)
        };
        found = in_order(places.len(), outline.len(), cost);
        scaling = Scaling::fitted(places, found.iter().map(|&vertex| outline[vertex]));
    }
    let away_m = |k: usize| (scaling.applied(places[k]) - outline[found[k]]).norm();
    let furthest = (0..places.len()).max_by(|&i, &j| away_m(i).total_cmp(&away_m(j)));
    match furthest.filter(|&k| away_m(k) > TOO_FAR * size) {
        Some(corner) => Err(Lost { corner, away_m: away_m(corner) }),
        None => Ok(found),
    }
}

/// Least and greatest coordinates.
pub(super) fn extent(points: &[V2]) -> [V2; 2] {
    let both = points.iter().map(|p| [*p, *p]).reduce(|[low, high], [p, _]| [low.inf(&p), high.sup(&p)]);
    both.unwrap_or_default()
}

/// Axis-aligned affine map: scale and shift along each axis.
struct Scaling {
    scale: V2,
    shift: V2,
}

impl Scaling {
    fn applied(&self, point: V2) -> V2 {
        point.component_mul(&self.scale) + self.shift
    }

    /// Fits by least squares along each axis.
    fn fitted(from: &[V2], to: impl Iterator<Item = V2> + Clone) -> Self {
        let count = from.len().max(1) as f64;
        let centre = from.iter().sum::<V2>() / count;
        let aim = to.clone().sum::<V2>() / count;
        let scale = |axis: usize| {
            let spread: f64 = from.iter().map(|p| (p[axis] - centre[axis]).powi(2)).sum();
            let shared: f64 =
                from.iter().zip(to.clone()).map(|(p, q)| (p[axis] - centre[axis]) * (q[axis] - aim[axis])).sum();
            if spread > 0.0 { shared / spread } else { 1.0 }
        };
        let scale = V2::new(scale(0), scale(1));
        Self { scale, shift: aim - centre.component_mul(&scale) }
    }
}

/// Assigns one of `vertices` to each of `count` corners, in cyclic order, with the least sum of costs.
fn in_order(count: usize, vertices: usize, cost: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    let mut starts: Vec<usize> = (0..vertices).collect();
    starts.sort_by(|&i, &j| cost(0, i).total_cmp(&cost(0, j)).then(i.cmp(&j)));
    starts.truncate(STARTS);
    let ways = starts.into_iter().map(|start| from_start(start, count, vertices, &cost));
    ways.reduce(|best, way| if way.cost < best.cost { way } else { best }).map_or_else(Vec::new, |way| way.vertices)
}

struct Assignment {
    cost: f64,
    vertices: Vec<usize>,
}

/// Best assignment with the first corner at the vertex `start`, by dynamic programming.
fn from_start(start: usize, count: usize, vertices: usize, cost: impl Fn(usize, usize) -> f64) -> Assignment {
    let vertex = |step: usize| (start + step) % vertices;
    // Entry `k`: least cost of the corners so far with the last of them at most `k` vertices after the start, and the
    // position of that last corner.
    let mut least: Vec<(f64, usize)> = vec![(cost(0, start), 0); vertices];
    let mut before: Vec<Vec<usize>> = Vec::new();
    for k in 1..count {
        let mut next = vec![(f64::INFINITY, 0); vertices];
        let mut came = vec![0; vertices];
        for step in k..vertices {
            let (sum, last) = least[step - 1];
            came[step] = last;
            let here = (sum + cost(k, vertex(step)), step);
            next[step] = if here.0 < next[step - 1].0 { here } else { next[step - 1] };
        }
        least = next;
        before.push(came);
    }
    let (sum, mut step) = least[vertices - 1];
    let mut way = vec![vertex(step)];
    for came in before.iter().rev() {
        step = came[step];
        way.push(vertex(step));
    }
    way.reverse();
    Assignment { cost: sum, vertices: way }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::Model;

    #[test]
    fn corners_of_one_size_are_found_on_every_other() {
        for model in Model::ALL {
            let drafts = model.drafts();
            for made_on in &drafts {
                for other in &drafts {
                    for (reference, piece) in made_on.pieces.iter().zip(&other.pieces) {
                        let places = shares(reference.seam_outline(), &corner_vertices(reference));
                        let found = corresponding(piece, &places).unwrap_or_else(|at| panic!("{}: {at:?}", piece.name));
                        assert_eq!(found, corner_vertices(piece), "{model:?} {}", piece.name);
                    }
                }
            }
        }
    }

    #[test]
    fn a_corner_that_is_not_marked_and_hardly_turns_is_found_by_its_place() {
        let ring = |middle: f64, width: f64| Piece {
            outline: vec![
                V2::new(0.0, 0.0),
                V2::new(0.5 * width, 0.0),
                V2::new(width, middle),
                V2::new(width, 0.9),
                V2::new(0.0, 0.9),
            ],
            ..Piece::default()
        };
        // 40 degrees at the second corner of one, 20 of the other, which counts as none.
        let (sharp, blunt) = (ring(0.25, 0.6), ring(0.12, 0.66));
        assert_eq!((corner_vertices(&sharp).len(), corner_vertices(&blunt).len()), (5, 4));
        let places = shares(sharp.seam_outline(), &[0, 1, 2, 3, 4]);
        assert_eq!(corresponding(&blunt, &places), Ok(vec![0, 1, 2, 3, 4]));
    }

    #[test]
    fn another_outline_is_not_taken_for_a_size() {
        let square = [V2::zeros(), V2::new(0.5, 0.0), V2::new(0.5, 0.5), V2::new(0.0, 0.5)];
        let piece = Piece { outline: square.to_vec(), ..Piece::default() };
        assert!(corresponding(&piece, &[[0.0, 0.0], [1.0, 0.0], [0.5, 0.03], [0.0, 1.0]]).is_err());
        assert!(corresponding(&piece, &[[0.0, 0.0]; 8]).is_err());
    }
}
