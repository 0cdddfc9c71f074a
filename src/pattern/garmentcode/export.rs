//! Writing of a style as GarmentCode. Every seam becomes stitches of whole edges, and every edge is straight or a cubic
//! curve.
//!
//! The format sews one edge to one edge. Both sides of a seam are therefore divided where an edge of either ends, at
//! equal shares of their lengths, and bisected further until a cubic fits each part. Panels are laid out in a row,
//! because a style has no placement about a body.

use std::collections::BTreeMap;

use serde_json::Map;

use super::format::{Curvature, Curve, Document, Panel, PanelEdge, Pattern, Properties, StitchItem};
use crate::style::{EdgeRef, Seam, Style};
use geom::V2;
use geom::polyline::Polyline;

/// Greatest distance of a drawn curve from the cubic written for it.
const TOLERANCE_M: f64 = 0.05e-3;
/// Length below which a part is written straight.
const SHORTEST_M: f64 = 0.5e-3;
const SAMPLES: usize = 33;
const GAP_M: f64 = 0.05;
/// The unit written is centimetres.
const UNITS_IN_METER: f64 = 100.0;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    edge: EdgeRef,
    arcs: [f64; 2],
}

/// [`super::read`] reads the same pieces and seams. Piece identifiers become panel names. Names of edges, corners,
/// notches, grain and measurements are lost: the format cannot hold them.
pub fn document(style: &Style) -> Document {
    let style = &style.as_cut();
    let mut parts: Vec<Part> = Vec::new();
    let mut stitched = Vec::new();
    for seam in &style.seams {
        for pair in seam_parts(style, seam) {
            stitched.push((pair, seam.b_forwards));
            parts.extend(pair);
        }
    }
    let is_sewn = |edge: EdgeRef| parts.iter().any(|part| part.edge == edge);
    let free: Vec<EdgeRef> = all_edges(style).filter(|&edge| !is_sewn(edge)).collect();
    for edge in free {
        let whole = Part { edge, arcs: [0.0, style.edge(edge).line.length()] };
        parts.extend(fitted(style, &[whole], false).into_iter().flatten());
    }
    parts.sort_by(|a, b| a.edge.cmp(&b.edge).then(a.arcs[0].total_cmp(&b.arcs[0])));
    let mut left = 0.0;
    let mut panels = BTreeMap::new();
    for (index, piece) in style.pieces.iter().enumerate() {
        let own: Vec<Part> = parts.iter().copied().filter(|part| part.edge.piece == index).collect();
        panels.insert(piece.id.clone(), panel(style, &own, &mut left));
    }
    let side = |part: &Part| {
        let before = parts.iter().filter(|other| other.edge.piece == part.edge.piece);
        let edge = before.take_while(|&other| other != part).count();
        StitchItem::Side { panel: style.pieces[part.edge.piece].id.clone(), edge }
    };
    let stitches = stitched.iter().map(|(pair, same_direction)| {
        let mut items: Vec<StitchItem> = pair.iter().map(side).collect();
        items.extend(same_direction.then(|| StitchItem::Flag(super::RIGHT_WRONG.to_owned())));
        items
    });
    Document {
        pattern: Pattern { stitches: stitches.collect(), panel_order: panels.keys().cloned().collect(), panels },
        parameters: Map::new(),
        parameter_order: Vec::new(),
        properties: Properties {
            curvature_coords: "relative".to_owned(),
            units_in_meter: UNITS_IN_METER,
            normalize_panel_translation: false,
            normalized_edge_loops: true,
        },
    }
}

fn all_edges(style: &Style) -> impl Iterator<Item = EdgeRef> + '_ {
    let edges_of = |(piece, drawn): (usize, &crate::style::StylePiece)| {
        (0..drawn.edges.len()).map(move |edge| EdgeRef { piece, edge })
    };
    style.pieces.iter().enumerate().flat_map(edges_of)
}

fn seam_parts(style: &Style, seam: &Seam) -> Vec<[Part; 2]> {
    let (a, b) = (Side::new(style, &seam.a, true), Side::new(style, &seam.b, seam.b_forwards));
    let mut shares: Vec<f64> = a.shares.iter().chain(&b.shares).copied().collect();
    shares.sort_by(f64::total_cmp);
    // Where both sides have a joint at the same share up to rounding, one is kept.
    let shortest = SHORTEST_M / a.length.max(b.length);
    let mut distinct: Vec<f64> = Vec::new();
    for share in shares {
        if distinct.last().is_none_or(|last| share - last > shortest) {
            distinct.push(share);
        }
    }
    if let Some(last) = distinct.last_mut() {
        *last = 1.0;
    }
    let pairs = distinct.windows(2).map(|ends| [a.part(ends[0], ends[1]), b.part(ends[0], ends[1])]);
    pairs
        .flat_map(|pair| fitted(style, &pair, !seam.b_forwards))
        .filter_map(|pair| <[Part; 2]>::try_from(pair).ok())
        .collect()
}

/// Edges of one side of a seam end to end in walking order.
struct Side<'a> {
    style: &'a Style,
    chain: &'a [EdgeRef],
    is_forwards: bool,
    length: f64,
    /// Share of the length at which each edge begins, then 1.
    shares: Vec<f64>,
}

impl<'a> Side<'a> {
    fn new(style: &'a Style, chain: &'a [EdgeRef], is_forwards: bool) -> Self {
        let mut ends = vec![0.0];
        for &edge in chain {
            ends.push(ends[ends.len() - 1] + style.edge(edge).line.length());
        }
        let length = ends[ends.len() - 1];
        Self { style, chain, is_forwards, length, shares: ends.into_iter().map(|end| end / length).collect() }
    }

    /// Takes shares of the length, which must lie in one edge.
    fn part(&self, from: f64, to: f64) -> Part {
        let middle = 0.5 * (from + to);
        let k = self.shares.partition_point(|&share| share <= middle).clamp(1, self.chain.len()) - 1;
        let edge = self.chain[k];
        let length = self.style.edge(edge).line.length();
        let arc = |share: f64| {
            let along = ((share - self.shares[k]) * self.length).clamp(0.0, length);
            let along = if self.is_forwards { along } else { length - along };
            // A point near an end of the edge is moved to that end.
            if along < SHORTEST_M {
                0.0
            } else if along > length - SHORTEST_M {
                length
            } else {
                along
            }
        };
        let (first, second) = (arc(from), arc(to));
        Part { edge, arcs: [first.min(second), first.max(second)] }
    }
}

/// Bisects parts until each is straight, short or a cubic. `is_opposed` is true if the second part runs against the
/// first.
fn fitted(style: &Style, together: &[Part], is_opposed: bool) -> Vec<Vec<Part>> {
    let is_fine = |part: &Part| {
        let points = samples(style, *part);
        part.arcs[1] - part.arcs[0] < 2.0 * SHORTEST_M || cubic(&points).error_m < TOLERANCE_M
    };
    if together.iter().all(is_fine) {
        return vec![together.to_vec()];
    }
    // The order of the halves does not matter: the parts are sorted along their edges later.
    let half = |k: usize| -> Vec<Part> {
        let half_of = |(side, part): (usize, &Part)| {
            let middle = 0.5 * (part.arcs[0] + part.arcs[1]);
            let arcs = if (k + side * usize::from(is_opposed)).is_multiple_of(2) {
                [part.arcs[0], middle]
            } else {
                [middle, part.arcs[1]]
            };
            Part { arcs, ..*part }
        };
        together.iter().enumerate().map(half_of).collect()
    };
    [half(0), half(1)].iter().flat_map(|half| fitted(style, half, is_opposed)).collect()
}

fn samples(style: &Style, part: Part) -> Vec<V2> {
    let line: &Polyline = &style.edge(part.edge).line;
    let share = |k: usize| k as f64 / (SAMPLES - 1) as f64;
    (0..SAMPLES).map(|k| line.at(part.arcs[0] + (part.arcs[1] - part.arcs[0]) * share(k))).collect()
}

struct CubicFit {
    inner: [V2; 2],
    error_m: f64,
}

/// Least-squares Bezier curve between the ends of a line.
fn cubic(points: &[V2]) -> CubicFit {
    let (start, end) = (points[0], points[points.len() - 1]);
    let weights = |k: usize| {
        let t = k as f64 / (points.len() - 1) as f64;
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    };
    let (mut aa, mut ab, mut bb, mut a, mut b) = (0.0, 0.0, 0.0, V2::zeros(), V2::zeros());
    for (k, point) in points.iter().enumerate() {
        let w = weights(k);
        let rest = point - start * w[0] - end * w[3];
        (aa, ab, bb) = (aa + w[1] * w[1], ab + w[1] * w[2], bb + w[2] * w[2]);
        (a, b) = (a + rest * w[1], b + rest * w[2]);
    }
    let determinant = aa * bb - ab * ab;
    let inner = [(a * bb - b * ab) / determinant, (b * aa - a * ab) / determinant];
    let off = |(k, point): (usize, &V2)| {
        let w = weights(k);
        (start * w[0] + inner[0] * w[1] + inner[1] * w[2] + end * w[3] - point).norm()
    };
    CubicFit { inner, error_m: points.iter().enumerate().map(off).fold(0.0, f64::max) }
}

/// Panel in the order of the outline. `left` is the present end of the row, m.
fn panel(style: &Style, parts: &[Part], left: &mut f64) -> Panel {
    let starts: Vec<V2> = parts.iter().map(|part| style.edge(part.edge).line.at(part.arcs[0])).collect();
    let low = starts.iter().fold(f64::MAX, |low, p| low.min(p.x));
    let high = starts.iter().fold(f64::MIN, |high, p| high.max(p.x));
    let translation = [(*left - low) * UNITS_IN_METER, 0.0, 0.0];
    *left += high - low + GAP_M;
    let edge = |(k, part): (usize, &Part)| {
        let points = samples(style, *part);
        let (start, end) = (points[0], points[SAMPLES - 1]);
        let chord = end - start;
        let relative = |p: V2| [(p - start).dot(&chord), chord.perp(&(p - start))].map(|x| x / chord.norm_squared());
        let is_straight = points.iter().all(|p| (relative(*p)[1] * chord.norm()).abs() < 1e-7);
        let curvature = (!is_straight).then(|| Curvature::Typed(Curve::Cubic(cubic(&points).inner.map(relative))));
        PanelEdge { endpoints: [k, (k + 1) % parts.len()], curvature, label: None }
    };
    Panel {
        translation,
        rotation: [0.0; 3],
        vertices: starts.iter().map(|p| [p.x, p.y].map(|x| x * UNITS_IN_METER)).collect(),
        edges: parts.iter().enumerate().map(edge).collect(),
        label: String::new(),
    }
}
