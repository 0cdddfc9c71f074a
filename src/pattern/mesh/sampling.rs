//! Sampling of the outlines: both sides of a seam get equally many vertices, at equal shares of their lengths.
//!
//! An edge must have a vertex at each of its corners and at each end of a straight measurement: its *marks*. The marks
//! of one side of a seam are carried over to the other. Each interval between marks is divided evenly [T 5.1].

use crate::style::{EdgePoint, EdgeRef, PathPart, Seam, Style};

/// Distance in target edge lengths below which marks of both sides of a seam become one vertex pair.
const MERGE_SHARE: f64 = 0.25;
const SAME_M: f64 = 1e-9;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgeSamples {
    /// Increasing, both ends included.
    pub arcs: Vec<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    pub edges: Vec<Vec<EdgeSamples>>,
    /// In order along the seam.
    pub seams: Vec<Vec<[EdgeSample; 2]>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeSample {
    pub edge: EdgeRef,
    /// Into [`EdgeSamples::arcs`].
    pub index: usize,
}

/// Divides all edges into segments of about `h`, m.
pub fn sample(style: &Style, h: f64) -> Samples {
    let marks = marks(style);
    let mut edges: Vec<Vec<EdgeSamples>> =
        marks.iter().map(|piece| vec![EdgeSamples::default(); piece.len()]).collect();
    let mut placed_seams = Vec::new();
    for seam in &style.seams {
        let pairs = seam_pairs(style, seam, &marks, h);
        for &EdgePoint { edge, arc_m } in pairs.iter().flatten() {
            edges[edge.piece][edge.edge].arcs.push(arc_m);
        }
        placed_seams.push(pairs);
    }
    for (piece, piece_edges) in edges.iter_mut().enumerate() {
        for (edge, samples) in piece_edges.iter_mut().enumerate() {
            if samples.arcs.is_empty() {
                samples.arcs = divide(&marks[piece][edge], h);
            }
            samples.arcs.sort_by(f64::total_cmp);
            samples.arcs.dedup_by(|later, earlier| *later - *earlier < SAME_M);
        }
    }
    let sample_at = |EdgePoint { edge, arc_m }: EdgePoint| {
        let arcs = &edges[edge.piece][edge.edge].arcs;
        EdgeSample { edge, index: arcs.partition_point(|&arc| arc < arc_m - SAME_M) }
    };
    let seams =
        placed_seams.into_iter().map(|pairs| pairs.into_iter().map(|pair| pair.map(sample_at)).collect()).collect();
    Samples { edges, seams }
}

/// Arc lengths at which each edge must have a vertex, both ends included.
fn marks(style: &Style) -> Vec<Vec<Vec<f64>>> {
    let edge_marks = |line: &geom::polyline::Polyline, corners: &[f64]| {
        let mut marks = vec![0.0];
        marks.extend(corners);
        marks.push(line.length());
        marks
    };
    let mut marks: Vec<Vec<Vec<f64>>> = style
        .pieces
        .iter()
        .map(|piece| piece.edges.iter().map(|edge| edge_marks(&edge.line, &edge.corners)).collect())
        .collect();
    let paths = style.measurements.iter().map(|m| &m.path).chain(style.fit_levels.iter().map(|(_, path)| path));
    for part in paths.flatten() {
        if let PathPart::Line(ends) = part {
            for end in ends {
                marks[end.edge.piece][end.edge.edge].push(end.arc_m);
            }
        }
    }
    for edge in marks.iter_mut().flatten() {
        edge.sort_by(f64::total_cmp);
        edge.dedup_by(|later, earlier| *later - *earlier < SAME_M);
    }
    marks
}

fn divide(marks: &[f64], h: f64) -> Vec<f64> {
    let mut arcs = vec![marks[0]];
    for ends in marks.windows(2) {
        let parts = parts(ends[1] - ends[0], h);
        arcs.extend((1..=parts).map(|k| ends[0] + (ends[1] - ends[0]) * k as f64 / parts as f64));
    }
    arcs
}

fn parts(length: f64, h: f64) -> usize {
    ((length / h).round() as usize).max(1)
}

/// Edges of one side of a seam, end to end in walking order.
struct Side<'a> {
    style: &'a Style,
    chain: &'a [EdgeRef],
    is_forwards: bool,
    /// Start of each edge along the side, then the length of the side, m.
    joints: Vec<f64>,
}

impl<'a> Side<'a> {
    fn new(style: &'a Style, chain: &'a [EdgeRef], is_forwards: bool) -> Self {
        let mut joints = vec![0.0];
        let mut total = 0.0;
        for &edge in chain {
            total += style.edge(edge).line.length();
            joints.push(total);
        }
        Self { style, chain, is_forwards, joints }
    }

    fn length(&self) -> f64 {
        self.joints[self.joints.len() - 1]
    }

    fn marks(&self, marks: &[Vec<Vec<f64>>]) -> Vec<f64> {
        let on_edge = |(k, edge): (usize, &EdgeRef)| {
            let length = self.style.edge(*edge).line.length();
            let along = move |arc: f64| if self.is_forwards { arc } else { length - arc };
            marks[edge.piece][edge.edge].iter().map(move |&arc| self.joints[k] + along(arc))
        };
        let mut all: Vec<f64> = self.chain.iter().enumerate().flat_map(on_edge).collect();
        all.sort_by(f64::total_cmp);
        all.dedup_by(|later, earlier| *later - *earlier < SAME_M);
        all
    }

    /// Points on the edge at the distance `middle` along the side.
    fn on_edge(&self, middle: f64, distances: &[f64]) -> Vec<EdgePoint> {
        let k = self.joints.partition_point(|&joint| joint <= middle).clamp(1, self.chain.len()) - 1;
        let edge = self.chain[k];
        let length = self.style.edge(edge).line.length();
        let arc_at = |distance: f64| {
            let along = (distance - self.joints[k]).clamp(0.0, length);
            if self.is_forwards { along } else { length - along }
        };
        distances.iter().map(|&distance| EdgePoint { edge, arc_m: arc_at(distance) }).collect()
    }
}

/// Position at which both sides of a seam must have a vertex: distance along each, and true for a side that marks it.
#[derive(Clone, Copy)]
struct Mark {
    on: [f64; 2],
    is_of: [bool; 2],
}

fn seam_pairs(style: &Style, seam: &Seam, marks: &[Vec<Vec<f64>>], h: f64) -> Vec<[EdgePoint; 2]> {
    let sides = [Side::new(style, &seam.a, true), Side::new(style, &seam.b, seam.b_forwards)];
    let mut pairs: Vec<[EdgePoint; 2]> = Vec::new();
    let common = common_marks(&sides, marks, h);
    for ends in common.windows(2) {
        let stretch = |side: usize| ends[1].on[side] - ends[0].on[side];
        let parts = parts(stretch(0).max(stretch(1)), h);
        let placed = [0, 1].map(|side| {
            let distance_at = |share: f64| ends[0].on[side] + stretch(side) * share;
            let distances: Vec<f64> = (0..=parts).map(|k| distance_at(k as f64 / parts as f64)).collect();
            sides[side].on_edge(distance_at(0.5), &distances)
        });
        for (&a, &b) in placed[0].iter().zip(&placed[1]) {
            // The last pair of one interval is the first of the next, unless an edge ends there.
            if pairs.last().is_none_or(|&[last_a, last_b]| !(is_same(last_a, a) && is_same(last_b, b))) {
                pairs.push([a, b]);
            }
        }
    }
    pairs
}

fn is_same(p: EdgePoint, q: EdgePoint) -> bool {
    p.edge == q.edge && (p.arc_m - q.arc_m).abs() < SAME_M
}

/// In order. Marks of different sides that nearly coincide become one.
fn common_marks(sides: &[Side<'_>; 2], marks: &[Vec<Vec<f64>>], h: f64) -> Vec<Mark> {
    let ratio = sides[1].length() / sides[0].length();
    let of_a = sides[0].marks(marks).into_iter().map(|s| Mark { on: [s, s * ratio], is_of: [true, false] });
    let of_b = sides[1].marks(marks).into_iter().map(|s| Mark { on: [s / ratio, s], is_of: [false, true] });
    let mut all: Vec<Mark> = of_a.chain(of_b).collect();
    all.sort_by(|p, q| p.on[0].total_cmp(&q.on[0]));
    let mut common: Vec<Mark> = Vec::new();
    for mark in all {
        match common.last_mut() {
            Some(last)
                if mark.on[0] - last.on[0] < MERGE_SHARE * h && !(0..2).any(|s| mark.is_of[s] && last.is_of[s]) =>
            {
                let b = usize::from(mark.is_of[1]);
                last.on[b] = mark.on[b];
                last.is_of = [true, true];
            }
            _ => common.push(mark),
        }
    }
    common
}
