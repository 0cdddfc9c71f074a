//! Places of the numbers beside the edges. A label stands nearer to its own edge than to any other, or nowhere: on small
//! pieces the nearest free cell is often another edge's.

use ratatui::layout::Rect;

use crate::screens::styles::state::EdgeAt;
use crate::screens::styles::view::{View, walked};
use wardrobe::seams::{DeskEdge, DeskPiece};

/// Distances from the edge at which a label is tried, in braille dots; above 0 inside the piece.
const OFFSETS: [f64; 9] = [6.0, 9.0, 3.0, 13.0, -6.0, -9.0, -3.0, -13.0, 18.0];
/// Places along the edge at which a label is tried, as shares of its length.
const SHARES: [f64; 5] = [0.5, 0.35, 0.65, 0.2, 0.8];

/// All edges as points, in braille dots.
pub struct EdgeDots {
    edges: Vec<Dotted>,
}

/// An edge as points at most a dot apart.
struct Dotted {
    at: EdgeAt,
    points: Vec<[f64; 2]>,
    /// Least and greatest coordinates: left, top, right, bottom.
    bounds: [f64; 4],
}

impl EdgeDots {
    pub fn of(pieces: &[DeskPiece], view: &View) -> Self {
        let all = pieces.iter().enumerate();
        let all =
            all.flat_map(|(piece, drawn)| drawn.edges.iter().enumerate().map(move |(k, edge)| ((piece, k), edge)));
        let dotted = |(at, edge): (EdgeAt, &DeskEdge)| {
            let points: Vec<[f64; 2]> = walked(edge, view.scale).into_iter().map(|place| view.dots(place)).collect();
            let none = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
            let bounds = points.iter().fold(none, |[left, top, right, bottom], [x, y]| {
                [left.min(*x), top.min(*y), right.max(*x), bottom.max(*y)]
            });
            Dotted { at, points, bounds }
        };
        Self { edges: all.map(dotted).collect() }
    }

    /// True if a label at these cells of the view stands nearer to an edge than to any other.
    pub fn is_beside(&self, edge: EdgeAt, cells: Rect, view: &View) -> bool {
        self.is_nearest(|other| other == edge, cells, view)
    }

    /// True if a label at these cells of the view stands nearer to a piece than to any other, and covers no edge.
    pub fn is_of(&self, piece: usize, cells: Rect, view: &View) -> bool {
        let is_clear = self.is_nearest(|_| false, cells, view);
        is_clear && self.is_nearest(|(other, _)| other == piece, cells, view)
    }

    /// True if a label at these cells of the view stands nearer to its own edges than to others; without own edges, if it
    /// covers none.
    fn is_nearest(&self, is_own: impl Fn(EdgeAt) -> bool, cells: Rect, view: &View) -> bool {
        let [x, y] = [cells.x - view.area.x, cells.y - view.area.y].map(f64::from);
        let [left, top] = [2.0 * x, 4.0 * y];
        let label = [left, top, left + 2.0 * f64::from(cells.width), top + 4.0];
        let (own, others): (Vec<&Dotted>, Vec<&Dotted>) = self.edges.iter().partition(|edge| is_own(edge.at));
        let own = own.iter().map(|edge| edge.distance(label)).reduce(f64::min).unwrap_or(0.0);
        let mut near = others.into_iter().filter(|edge| apart(label, edge.bounds) <= own);
        near.all(|edge| edge.distance(label) > own)
    }
}

impl Dotted {
    /// Distance from a rectangle, dots.
    fn distance(&self, label: [f64; 4]) -> f64 {
        self.points.iter().map(|[x, y]| apart(label, [*x, *y, *x, *y])).fold(f64::INFINITY, f64::min)
    }
}

/// Distance between two rectangles, each as left, top, right and bottom; 0 where they meet.
fn apart(one: [f64; 4], other: [f64; 4]) -> f64 {
    let gap = |k: usize| (other[k] - one[k + 2]).max(one[k] - other[k + 2]).max(0.0);
    gap(0).hypot(gap(1))
}

/// Places for the label of an edge, mm, the likeliest first.
pub fn places(edge: &DeskEdge, view: &View) -> Vec<[f64; 2]> {
    let beside = |share: f64| {
        let ([x, y], [inwards_x, inwards_y]) = place(edge, share);
        OFFSETS.map(|dots| [x + inwards_x * dots * view.scale, y + inwards_y * dots * view.scale])
    };
    SHARES.into_iter().flat_map(beside).collect()
}

/// Point at a share of an edge's length, mm, and there the unit normal into the piece.
fn place(edge: &DeskEdge, share: f64) -> ([f64; 2], [f64; 2]) {
    let length = |pair: &[[f64; 2]]| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
    let mut rest_mm = share * edge.line_mm.windows(2).map(length).sum::<f64>();
    for pair in edge.line_mm.windows(2) {
        let (length_mm, [a, b]) = (length(pair), [pair[0], pair[1]]);
        if length_mm > 0.0 && length_mm >= rest_mm {
            let along = [(b[0] - a[0]) / length_mm, (b[1] - a[1]) / length_mm];
            return ([a[0] + rest_mm * along[0], a[1] + rest_mm * along[1]], [-along[1], along[0]]);
        }
        rest_mm -= length_mm;
    }
    (edge.line_mm.last().copied().unwrap_or_default(), [0.0, 0.0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::Role;

    /// Strips of some widths beside each other, 100 mm high, each with the numbers of its edges.
    fn strips(widths_mm: &[f64]) -> Vec<DeskPiece> {
        let mut left = 0.0;
        let mut strip = |width_mm: &f64| {
            let corners = [[left, 0.0], [left + width_mm, 0.0], [left + width_mm, 100.0], [left, 100.0]];
            let edge = |k: usize| DeskEdge {
                number: k + 1,
                name: None,
                line_mm: vec![corners[k], corners[(k + 1) % 4]],
                length_mm: if k.is_multiple_of(2) { *width_mm } else { 100.0 },
                seam: None,
                notches_mm: vec![],
            };
            let edges = (0..4).map(edge).collect();
            left += width_mm + 10.0;
            DeskPiece { id: format!("strip_{left}"), role: Role::Other, turned_deg: 0.0, edges }
        };
        widths_mm.iter().map(&mut strip).collect()
    }

    #[test]
    fn a_label_is_beside_its_own_edge_alone() {
        let pieces = strips(&[200.0, 30.0, 8.0]);
        let view = View { area: Rect::new(3, 2, 60, 20), corner: [-20.0, 140.0], scale: 2.5 };
        let dots = EdgeDots::of(&pieces, &view);
        let check = |edge: EdgeAt, cells: [u16; 3], expect: bool| {
            let [x, y, width] = cells;
            let label = Rect::new(view.area.x + x, view.area.y + y, width, 1);
            assert_eq!(dots.is_beside(edge, label, &view), expect, "{edge:?} {cells:?}");
        };
        // The first strip has its left edge at the dots 8, its right edge at 88, both from 16 to 56.
        check((0, 3), [5, 8, 2], true);
        check((0, 1), [5, 8, 2], false);
        check((0, 1), [41, 8, 2], true);
        // Between two strips, nearer to the second.
        check((0, 1), [45, 8, 1], false);
        check((1, 3), [45, 8, 1], true);
    }

    #[test]
    fn names_of_pieces_cover_no_edge_and_stand_at_no_other_piece() {
        let pieces = strips(&[200.0, 30.0, 8.0]);
        let view = View { area: Rect::new(0, 0, 60, 20), corner: [-20.0, 140.0], scale: 2.5 };
        let dots = EdgeDots::of(&pieces, &view);
        let check = |piece: usize, cells: [u16; 3], expect: bool| {
            let [x, y, width] = cells;
            assert_eq!(dots.is_of(piece, Rect::new(x, y, width, 1), &view), expect, "{piece} {cells:?}");
        };
        check(0, [10, 8, 8], true);
        check(0, [1, 8, 8], false);
        check(1, [10, 8, 8], false);
        check(1, [47, 8, 3], true);
    }

    #[test]
    fn labels_of_small_pieces_are_right_or_left_out() {
        let pieces = strips(&[200.0, 30.0, 8.0]);
        let view = View { area: Rect::new(0, 0, 60, 20), corner: [-20.0, 140.0], scale: 2.5 };
        let dots = EdgeDots::of(&pieces, &view);
        let mut labelled = 0;
        for (piece, drawn) in pieces.iter().enumerate() {
            for (k, edge) in drawn.edges.iter().enumerate() {
                let cells = places(edge, &view).into_iter().filter_map(|place| view.cell(place));
                let mut rooms = cells.map(|cell| Rect::new(cell.x, cell.y, 1, 1));
                labelled += usize::from(rooms.any(|room| dots.is_beside((piece, k), room, &view)));
            }
        }
        // A strip of 8 mm is three dots wide: not all of its edges have a cell that is nobody else's.
        assert!((9..12).contains(&labelled), "{labelled}");
    }
}
