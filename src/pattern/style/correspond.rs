//! Corners of one size found on the outline of another: a seam file is made on one size and holds for all.
//!
//! Grading keeps the order of the corners and moves each a little beside what it moves the whole piece by. So the seam file
//! gives each as shares of the width and the height of the piece. They are scaled onto the outline, and each takes a vertex
//! of it, in their order, such that they lie as near as they can. A vertex that turns is taken before one that does not.

use super::corners::corner_vertices;
use crate::piece::Piece;
use geom::V2;

/// Distance that a corner is worth, over the size of the piece: a vertex that does not turn is taken where no corner is nearer by this.
pub(super) const CORNER_WORTH: f64 = 0.03;
/// Distance from which on a corner stands for none of the seam file's, over the size of the piece.
const TOO_FAR: f64 = 0.15;
/// Rounds of scaling and matching; the first scales by the extents of the outline.
const ROUNDS: usize = 3;
/// Vertices that are tried for the first corner.
const STARTS: usize = 8;

/// A corner that has no like on an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lost {
    /// Number of the corner.
    pub corner: usize,
    /// Distance of the nearest vertex that it may have, m.
    pub away_m: f64,
}

/// Places of vertices of an outline as shares of its width and its height, to 0.01 mm of a piece of a metre.
pub(crate) fn shares(outline: &[V2], vertices: &[usize]) -> Vec<[f64; 2]> {
    let rounded = |share: f64| (share * 1e5).round() / 1e5;
    places(outline, vertices).into_iter().map(|place| [place.x, place.y].map(rounded)).collect()
}

/// Places of vertices of an outline as shares of its width and its height.
pub(super) fn places(outline: &[V2], vertices: &[usize]) -> Vec<V2> {
    let [low, high] = extent(outline);
    let share = |at: V2, axis: usize| {
        let width = high[axis] - low[axis];
        if width > 0.0 { (at[axis] - low[axis]) / width } else { 0.0 }
    };
    vertices.iter().map(|&vertex| V2::new(share(outline[vertex], 0), share(outline[vertex], 1))).collect()
}

/// Vertices of the outline that correspond to corners of another size, in their order: counter-clockwise as drawn. `shares`
/// are their places there, as [`shares`] gives them.
///
/// # Errors
/// [`Lost`] where a corner has no like.
pub(super) fn corresponding(piece: &Piece, shares: &[[f64; 2]]) -> Result<Vec<usize>, Lost> {
    let mut worth = vec![CORNER_WORTH * CORNER_WORTH; piece.seam_outline().len()];
    corner_vertices(piece).iter().for_each(|&corner| worth[corner] = 0.0);
    let places: Vec<V2> = shares.iter().map(|&share| V2::from(share)).collect();
    matched(piece.seam_outline(), &places, |_, vertex| worth[vertex])
}

/// Vertices of an outline, in their order, for corners that lie at shares of its width and height. `unlike` says how little a
/// vertex is like a corner, as the square of a distance over the size of the piece.
///
/// # Errors
/// [`Lost`] where a corner has no like.
pub(super) fn matched(outline: &[V2], places: &[V2], unlike: impl Fn(usize, usize) -> f64) -> Result<Vec<usize>, Lost> {
    let [low, high] = extent(outline);
    let size = (high - low).norm();
    if places.len() > outline.len() || size == 0.0 {
        return Err(Lost { corner: outline.len(), away_m: size });
    }
    let mut scaling = Scaling { scale: high - low, shift: low };
    let mut found = Vec::new();
    for _ in 0..ROUNDS {
        let expected: Vec<V2> = places.iter().map(|&place| scaling.of(place)).collect();
        let cost = |k: usize, vertex: usize| {
            (expected[k] - outline[vertex]).norm_squared() / (size * size) + unlike(k, vertex)
        };
        found = in_order(places.len(), outline.len(), cost);
        scaling = Scaling::fitted(places, found.iter().map(|&vertex| outline[vertex]));
    }
    let away_m = |k: usize| (scaling.of(places[k]) - outline[found[k]]).norm();
    let furthest = (0..places.len()).max_by(|&i, &j| away_m(i).total_cmp(&away_m(j)));
    match furthest.filter(|&k| away_m(k) > TOO_FAR * size) {
        Some(corner) => Err(Lost { corner, away_m: away_m(corner) }),
        None => Ok(found),
    }
}

/// The least and greatest coordinates of points.
pub(super) fn extent(points: &[V2]) -> [V2; 2] {
    let both = points.iter().map(|p| [*p, *p]).reduce(|[low, high], [p, _]| [low.inf(&p), high.sup(&p)]);
    both.unwrap_or_default()
}

/// Scale and shift along each axis.
struct Scaling {
    scale: V2,
    shift: V2,
}

impl Scaling {
    fn of(&self, point: V2) -> V2 {
        point.component_mul(&self.scale) + self.shift
    }

    /// What lays points nearest to their partners, by least squares along each axis.
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

/// For each of `count` corners one of `vertices` in cyclic order, such that the sum of costs is least.
fn in_order(count: usize, vertices: usize, cost: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    let mut starts: Vec<usize> = (0..vertices).collect();
    starts.sort_by(|&i, &j| cost(0, i).total_cmp(&cost(0, j)).then(i.cmp(&j)));
    starts.truncate(STARTS);
    let ways = starts.into_iter().map(|start| from_start(start, count, vertices, &cost));
    ways.reduce(|best, way| if way.0 < best.0 { way } else { best }).map_or_else(Vec::new, |(_, way)| way)
}

/// The best way whose first corner is the vertex `start`, with its cost.
fn from_start(start: usize, count: usize, vertices: usize, cost: impl Fn(usize, usize) -> f64) -> (f64, Vec<usize>) {
    let vertex = |step: usize| (start + step) % vertices;
    // Least cost of the corners so far, the last of them at most so many vertices after the start, and where that is.
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
    (sum, way)
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
