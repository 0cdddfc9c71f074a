//! Outlines divided into stretches between corners, each with its geometry. Angles are in degrees.

use geom::V2;
use geom::polyline::{Polyline, boundary_distance};

use crate::trade::Named;

/// Number of directions that describe how a stretch bends.
pub const SAMPLES: usize = 16;
/// Length over which the direction at a corner is taken: shorter than the smallest rounding that is no corner.
const TANGENT_M: f64 = 4e-3;
/// Greatest distance of a notch from the stretch that it marks.
const ON_EDGE_M: f64 = 12e-3;

/// Piece as worn, seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Counter-clockwise, m.
    pub outline: Vec<V2>,
    /// Vertex indices, increasing.
    pub corners: Vec<usize>,
    /// Marks on the outline, m.
    pub notches: Vec<V2>,
    pub said: Named,
}

impl Part {
    /// Worn as the mirror image. Corner `k` from the first becomes corner `k` from the last.
    pub fn mirrored(&self) -> Self {
        let turned = |point: &V2| V2::new(-point.x, point.y);
        let last = self.outline.len() - 1;
        Self {
            outline: self.outline.iter().rev().map(turned).collect(),
            corners: self.corners.iter().rev().map(|corner| last - corner).collect(),
            notches: self.notches.iter().map(turned).collect(),
            said: self.said,
        }
    }
}

/// Difference of distances that counts as none.
const SAME_PLACE_M: f64 = 0.5e-3;

/// Part of an outline between two corners, run counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    pub part: usize,
    /// Index among the stretches of its part.
    pub at: usize,
    pub next: usize,
    pub previous: usize,
    /// m.
    pub length: f64,
    /// m.
    pub chord: f64,
    /// Directions at equal steps, less their mean.
    pub profile: [f64; SAMPLES],
    /// From the first direction to the last, positive to the left: a stretch that bulges outwards.
    pub turn: f64,
    /// Angle inside the part at the corner where the stretch begins.
    pub start_angle: f64,
    /// Angle inside the part at the corner where it ends.
    pub end_angle: f64,
    /// m.
    pub middle: V2,
    /// Unit vector to the right of the chord: out of the part.
    pub outward: V2,
    /// Arc lengths of notches, m.
    pub notches: Vec<f64>,
}

/// In the order of the parts, and of the corners in each.
pub fn stretches(parts: &[Part]) -> Vec<Stretch> {
    let mut all = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        let first = all.len();
        all.extend(of_part(part, index, first));
    }
    all
}

fn of_part(part: &Part, index: usize, first: usize) -> Vec<Stretch> {
    let count = part.corners.len();
    let lines: Vec<Polyline> = (0..count).filter_map(|at| line(part, at)).collect();
    let angles: Vec<f64> = (0..count).map(|at| inner_angle(&lines[(at + count - 1) % count], &lines[at])).collect();
    let one = |(at, line): (usize, &Polyline)| {
        let (profile, turn) = profile(line);
        let points = line.points();
        let chord = points[points.len() - 1] - points[0];
        let along = chord / chord.norm().max(f64::MIN_POSITIVE);
        Stretch {
            part: index,
            at,
            next: first + (at + 1) % count,
            previous: first + (at + count - 1) % count,
            length: line.length(),
            chord: chord.norm(),
            profile,
            turn,
            start_angle: angles[at],
            end_angle: angles[(at + 1) % count],
            middle: line.at(0.5 * line.length()),
            outward: V2::new(along.y, -along.x),
            notches: notches(part, line),
        }
    };
    lines.iter().enumerate().map(one).collect()
}

fn line(part: &Part, at: usize) -> Option<Polyline> {
    let n = part.outline.len();
    let (from, to) = (part.corners[at], part.corners[(at + 1) % part.corners.len()]);
    let steps = match (to + n - from) % n {
        0 => n,
        steps => steps,
    };
    Polyline::new((0..=steps).map(|step| part.outline[(from + step) % n]).collect())
}

fn direction(line: &Polyline, from: f64, to: f64) -> V2 {
    line.at(to) - line.at(from)
}

/// From `u` to `v`, degrees, positive to the left.
fn turn(u: &V2, v: &V2) -> f64 {
    u.perp(v).atan2(u.dot(v)).to_degrees()
}

fn inner_angle(before: &Polyline, after: &Polyline) -> f64 {
    let step = |line: &Polyline| TANGENT_M.min(0.5 * line.length());
    let arriving = direction(before, before.length() - step(before), before.length());
    180.0 - turn(&arriving, &direction(after, 0.0, step(after)))
}

fn profile(line: &Polyline) -> ([f64; SAMPLES], f64) {
    let place = |k: usize| line.length() * k as f64 / SAMPLES as f64;
    let directions: Vec<V2> = (0..SAMPLES).map(|k| direction(line, place(k), place(k + 1))).collect();
    let mut profile = [0.0; SAMPLES];
    for k in 1..SAMPLES {
        profile[k] = profile[k - 1] + turn(&directions[k - 1], &directions[k]);
    }
    let (turn, mean) = (profile[SAMPLES - 1], profile.iter().sum::<f64>() / SAMPLES as f64);
    (profile.map(|angle| angle - mean), turn)
}

/// Without notches at the ends.
fn notches(part: &Part, line: &Polyline) -> Vec<f64> {
    let nearest = |at: V2| {
        let sides = line.points().windows(2).zip(line.arcs()).map(|(ends, arc)| {
            let along = ends[1] - ends[0];
            let share = ((at - ends[0]).dot(&along) / along.norm_squared().max(1e-18)).clamp(0.0, 1.0);
            ((ends[0] + along * share - at).norm(), arc + share * along.norm())
        });
        sides.min_by(|p, q| p.0.total_cmp(&q.0))
    };
    let of_line = part.notches.iter().filter_map(|&at| {
        let (distance, arc) = nearest(at)?;
        let is_here = distance < ON_EDGE_M && distance < boundary_distance(&part.outline, &at) + SAME_PLACE_M;
        let is_inside = (ON_EDGE_M..line.length() - ON_EDGE_M).contains(&arc);
        (is_here && is_inside).then_some(arc)
    });
    let mut arcs: Vec<f64> = of_line.collect();
    arcs.sort_by(f64::total_cmp);
    arcs
}
