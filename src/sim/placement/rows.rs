//! Rings of long straight pieces, as tiers of ruffles are, laid out row by row.
//!
//! If their sides slant, such pieces look like parts of a sector. Laid about its tip a straight strip would become an
//! arch, its ends far below its middle. Each height of the ring is therefore a row of its own, from side to side of
//! every piece.

use nalgebra::Rotation2;

use super::interval::{bounds, front};
use super::layout::Joins;
use geom::V2;

geom::constants! {
    "placement.rows",
    /// Least width of a piece over its height.
    const LONG: f64 = 4.0;
    /// Greatest height of a piece over that of its sides.
    const STRAIGHT: f64 = 1.25;
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InRow {
    pub vertex: usize,
    /// From the front to the right seen from outside, as a share of the row.
    pub share: f64,
    pub row_m: f64,
    /// Distance from the uppermost row.
    pub below_m: f64,
}

pub struct Strip {
    points: Vec<(usize, V2)>,
    /// Left and right side seen from outside, from below.
    sides: [Vec<V2>; 2],
    is_rightwards: bool,
    /// Height of the sides' upper ends, m.
    top: f64,
    is_in_front: bool,
}

impl Strip {
    /// Takes the vertices that are sewn to the piece before and to the next; `None` where the piece is not long and
    /// straight.
    pub fn of(joins: &Joins, piece: usize, before: &[usize], next: &[usize], is_in_front: bool) -> Option<Self> {
        let upright = Rotation2::rotation_between(&joins.up(piece, V2::y()), &V2::y());
        let turned = |v: usize| upright * joins.garment.rest[v];
        let side = |vertices: &[usize]| {
            let mut side: Vec<V2> = vertices.iter().map(|&v| turned(v)).collect();
            side.sort_by(|p, q| p.y.total_cmp(&q.y));
            side
        };
        let points: Vec<(usize, V2)> = joins.garment.pieces[piece].vertices.clone().map(|v| (v, turned(v))).collect();
        let (before, next) = (side(before), side(next));
        let mean = |side: &[V2]| side.iter().map(|p| p.x).sum::<f64>() / side.len() as f64;
        let is_rightwards = mean(&before) < mean(&next);
        let [low, top] = bounds(before.iter().chain(&next).map(|p| p.y));
        let [lowest, highest] = bounds(points.iter().map(|(_, p)| p.y));
        let width = (mean(&before) - mean(&next)).abs();
        let have_ends = before.len() > 1 && next.len() > 1;
        let is_strip = have_ends && width > LONG * (top - low) && highest - lowest < STRAIGHT * (top - low);
        let sides = if is_rightwards { [before, next] } else { [next, before] };
        is_strip.then_some(Self { points, sides, is_rightwards, top, is_in_front })
    }

    fn row(&self, below: f64) -> [f64; 2] {
        [0, 1].map(|side| across(&self.sides[side], self.top - below))
    }

    fn width(&self, below: f64) -> f64 {
        let [left, right] = self.row(below);
        right - left
    }
}

/// Ring of pieces in order, the middle of those in front at the front.
pub fn laid_out(strips: &[Strip]) -> Vec<InRow> {
    let middle = 0.5 * strips.iter().flat_map(|s| s.points.iter().map(|(_, p)| s.top - p.y)).fold(0.0, f64::max);
    let row_m = |below: f64| strips.iter().map(|strip| strip.width(below)).sum::<f64>();
    let mut begun = 0.0;
    let starts = strips.iter().map(|strip| {
        let share = strip.width(middle) / row_m(middle);
        begun += share;
        // The strip's left end and its width, as shares of the turn.
        (if strip.is_rightwards { begun - share } else { -begun }, share)
    });
    let starts: Vec<(f64, f64)> = starts.collect();
    let middles = |is_in_front: bool| -> Vec<f64> {
        let some = strips.iter().zip(&starts).filter(|(strip, _)| strip.is_in_front || !is_in_front);
        some.map(|(_, (start, share))| start + 0.5 * share).collect()
    };
    let front = front(&middles(true), front(&middles(false), 0.0));
    let rows_of = |(strip, &(start, share)): (&Strip, &(f64, f64))| {
        let in_row = |&(vertex, p): &(usize, V2)| {
            let below = (strip.top - p.y).max(0.0);
            let [left, right] = strip.row(below);
            let share = start + share * (p.x - left) / (right - left) - front;
            InRow { vertex, share, row_m: row_m(below), below_m: below }
        };
        strip.points.iter().map(in_row).collect::<Vec<_>>()
    };
    strips.iter().zip(&starts).flat_map(rows_of).collect()
}

/// Sideways place at a height of a side whose points are sorted from below.
fn across(side: &[V2], y: f64) -> f64 {
    let next = side.partition_point(|p| p.y < y).clamp(1, side.len() - 1);
    let [a, b] = [side[next - 1], side[next]];
    let share = ((y - a.y) / (b.y - a.y).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    a.x + (b.x - a.x) * share
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde_json::json;

    use super::super::piece_ring::{Flat, Ring};
    use super::*;
    use pattern::{Garment, garmentcode};

    /// Trapezoids sewn to each other at both sides: length of the upper edge, excess of the lower one at each side, and
    /// height, cm.
    fn tier(lengths: [f64; 2], slant: f64, height: f64) -> Garment {
        let panel = |length: f64| {
            let vertices = [[-slant, 0.0], [length + slant, 0.0], [length, height], [0.0, height]];
            let edges: Vec<_> = (0..4).map(|k| json!({ "endpoints": [k, (k + 1) % 4] })).collect();
            json!({ "translation": [0, 0, 0], "rotation": [0, 0, 0], "vertices": vertices, "edges": edges })
        };
        let stitch = |a: &str, b: &str| json!([{ "panel": a, "edge": 1 }, { "panel": b, "edge": 3 }]);
        let document = json!({
            "pattern": {
                "panels": { "skirt_back": panel(lengths[0]), "skirt_front": panel(lengths[1]) },
                "stitches": [stitch("skirt_front", "skirt_back"), stitch("skirt_back", "skirt_front")]
            },
            "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
        });
        let read = garmentcode::read(document.to_string().as_bytes(), "tier").expect("a specification");
        read.style().mesh(0.05).expect("a mesh")
    }

    #[test]
    fn a_tier_of_trapezoids_is_a_row_at_each_height() {
        for slant in [0.0, 18.0] {
            let (lengths, height) = ([237.0, 155.0], 16.0);
            let garment = tier(lengths, slant, height);
            let joins = Joins::of(&garment);
            let front = garment.pieces.iter().position(|piece| piece.id == "skirt_front").expect("a front");
            let rings = Ring::of_tiers(&joins, &[0, 1]);
            assert_eq!(rings.len(), 1);
            let Flat::Rows(points) = rings[0].flat(&joins, &[front]) else { panic!("{slant}: no rows") };
            let [top, hem] = bounds(points.iter().map(|p| p.row_m));
            assert!((top - 3.92).abs() < 1e-9 && (hem - top - 0.04 * slant).abs() < 1e-9, "{slant}: {top} to {hem} m");
            let rows: BTreeMap<usize, InRow> = points.iter().map(|p| (p.vertex, *p)).collect();
            assert_eq!(rows.len(), garment.rest.len());
            // Sides meet, one of them a whole turn apart; upper and lower edges are level.
            for [a, b] in garment.seams.iter().flat_map(|seam| &seam.pairs) {
                let apart = (rows[a].share - rows[b].share).abs();
                assert!(apart < 1e-9 || (apart - 1.0).abs() < 1e-9, "{slant}: {apart} of a turn apart");
                assert!((rows[a].below_m - rows[b].below_m).abs() < 1e-9);
            }
            for p in &points {
                assert!((p.below_m - (0.01 * height - garment.rest[p.vertex].y)).abs() < 1e-9);
            }
            let middle: Vec<f64> =
                points.iter().filter(|p| joins.piece_of[p.vertex] == front).map(|p| p.share).collect();
            let [left, right] = bounds(middle.iter().copied());
            assert!((left + right).abs() < 1e-9, "{slant}: the front goes from {left} to {right} of a turn");
        }
    }

    #[test]
    fn short_pieces_are_no_rows() {
        let check = |lengths: [f64; 2], slant: f64, height: f64| {
            let garment = tier(lengths, slant, height);
            let joins = Joins::of(&garment);
            let flat = Ring::of_tiers(&joins, &[0, 1])[0].flat(&joins, &[]);
            assert!(!matches!(flat, Flat::Rows(_)), "{lengths:?}, {slant}, {height}");
        };
        check([45.0, 40.0], 18.0, 60.0);
        check([35.0, 35.0], 25.0, 16.0);
    }
}
