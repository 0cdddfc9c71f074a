//! Quality validation curves: the curve that the writing program means, beside its turn and curve points.
//!
//! A program that draws a curve as few points writes the true curve on layer 84 (boundary) and 87 (sew line) [ASTM
//! D6673], so that a reader can check its own. It is sewn wherever it leaves the points by more than rounding.

use super::outline::{Line, chains};
use geom::V2;
use geom::polyline::{Polyline, segment_distance, signed_area};
use geom::units::mm;

/// Coordinates of files are rounded to 0.1 mm.
const SAME_M: f64 = 0.2e-3;
const AT_VERTEX_M: f64 = 0.5e-3;
/// Greatest distance of a curve from the points that it explains, as a share of its length. An arc over a right angle
/// bulges by a tenth.
const FARTHEST: f64 = 0.1;
/// Points taken between two vertices: the same number in every size, so that vertices of all sizes correspond. A chord
/// 5 mm off its arc becomes five that are 0.2 mm off.
const BETWEEN: usize = 4;

/// Replaces the parts of a closed line that quality curves draw again, and keeps its vertices. Returns the greatest
/// distance, m; `None` if it is below the rounding of files.
pub fn follow(line: &mut Vec<V2>, curves: &[Line]) -> Option<f64> {
    let mut farthest_m = 0.0_f64;
    for curve in chains(curves) {
        let section = if curve.closes() { whole(line, &curve) } else { part(line, &curve) };
        let Some(Section { from, steps, points }) = section else { continue };
        let n = line.len();
        let old: Vec<V2> = (0..=steps).map(|k| line[(from + k) % n]).collect();
        let away_m = away(&old, &points).max(away(&points, &old));
        let Some(inner) = between(&old, points).filter(|_| away_m <= FARTHEST * length(&old)) else { continue };
        let kept = (0..=n - steps).map(|k| line[(from + steps + k) % n]);
        *line = kept.chain(inner).collect();
        farthest_m = farthest_m.max(away_m);
    }
    (farthest_m > SAME_M).then_some(farthest_m)
}

pub fn remark(block: &str, what: &str, layer: &str, drawn: usize, away_m: f64) -> String {
    format!(
        "block `{block}`: its {what} is sewn along its quality curve (layer {layer}), up to {:.1} mm from the {drawn} points",
        mm(away_m)
    )
}

/// Part of a closed line that a curve draws again.
struct Section {
    from: usize,
    steps: usize,
    /// In the direction of the line.
    points: Vec<V2>,
}

/// Section of a closed curve, from the vertex nearest to its first point.
fn whole(line: &[V2], curve: &Line) -> Option<Section> {
    let mut points = curve.points.clone();
    if points.len() > 1 && curve.gap() < AT_VERTEX_M {
        points.pop();
    }
    let is_clockwise = |points: &[V2]| signed_area(points) < 0.0;
    if is_clockwise(&points) != is_clockwise(line) {
        points.reverse();
    }
    // The curve begins at the vertex of the line that it passes.
    let (from, start) = (0..points.len()).find_map(|start| Some((vertex_at(line, &points[start])?, start)))?;
    points.rotate_left(start);
    points.push(points[0]);
    Some(Section { from, steps: line.len(), points })
}

/// Section of an open curve: of both ways round, the one nearer to it in length.
fn part(line: &[V2], curve: &Line) -> Option<Section> {
    let n = line.len();
    let [a, b] = curve.ends().map(|end| vertex_at(line, &end));
    let (a, b) = (a?, b?);
    let way = |from: usize, to: usize| (to + n - from) % n;
    let length_of = |from: usize, steps: usize| -> f64 {
        (0..steps).map(|k| (line[(from + k + 1) % n] - line[(from + k) % n]).norm()).sum()
    };
    let own = length(&curve.points);
    let unlike = |from: usize, to: usize| (length_of(from, way(from, to)) - own).abs();
    let mut points = curve.points.clone();
    let (from, to) = if unlike(a, b) <= unlike(b, a) {
        (a, b)
    } else {
        points.reverse();
        (b, a)
    };
    (from != to).then(|| Section { from, steps: way(from, to), points })
}

/// Vertices without the ends, with points of the curve between them. `None` if the curve does not pass them in order.
fn between(old: &[V2], curve: Vec<V2>) -> Option<Vec<V2>> {
    let curve = Polyline::new(curve)?;
    let mut arcs = vec![0.0];
    for vertex in &old[1..old.len() - 1] {
        let from = arcs[arcs.len() - 1];
        let sides = curve.points().windows(2).zip(curve.arcs());
        let near = sides.filter_map(|(ends, start)| {
            let along = ends[1] - ends[0];
            let share = ((vertex - ends[0]).dot(&along) / along.norm_squared().max(1e-18)).clamp(0.0, 1.0);
            let arc = start + share * along.norm();
            (arc > from && (ends[0] + along * share - vertex).norm() < AT_VERTEX_M).then_some(arc)
        });
        arcs.push(near.reduce(f64::min)?);
    }
    arcs.push(curve.length());
    let mut points = Vec::new();
    for (ends, k) in arcs.windows(2).zip(0..) {
        if k > 0 {
            points.push(old[k]);
        }
        let at = |step: usize| ends[0] + (ends[1] - ends[0]) * step as f64 / (BETWEEN + 1) as f64;
        points.extend((1..=BETWEEN).map(|step| curve.at(at(step))));
    }
    Some(points)
}

fn vertex_at(line: &[V2], place: &V2) -> Option<usize> {
    let distance = |k: &usize| (line[*k] - place).norm();
    (0..line.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).filter(|k| distance(k) < AT_VERTEX_M)
}

/// Greatest distance of `points` from another line, m.
fn away(points: &[V2], line: &[V2]) -> f64 {
    let distance = |point: &V2| {
        line.windows(2).map(|ends| segment_distance(&ends[0], &ends[1], point)).fold(f64::INFINITY, f64::min)
    };
    points.iter().map(distance).fold(0.0, f64::max)
}

fn length(points: &[V2]) -> f64 {
    points.windows(2).map(|ends| (ends[1] - ends[0]).norm()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::polyline::{crossing_sides, perimeter};

    fn capped(chords: u32) -> Vec<V2> {
        let cap = (0..=chords).map(|k| {
            let angle = std::f64::consts::PI * f64::from(k) / f64::from(chords);
            V2::new(0.15 + 0.15 * angle.cos(), 0.3 + 0.15 * angle.sin())
        });
        [V2::new(0.0, 0.0), V2::new(0.3, 0.0)].into_iter().chain(cap).collect()
    }

    #[test]
    fn a_line_follows_its_quality_curve_and_keeps_its_vertices() {
        let (drawn, curve) = (capped(4), capped(64));
        let cap = || curve[2..].to_vec();
        let turned = |points: Vec<V2>| points.into_iter().rev().collect::<Vec<_>>();
        let check = |curve: Vec<V2>, is_closed: bool, vertices: usize| {
            let mut line = drawn.clone();
            let away_m = follow(&mut line, &[Line { points: curve, is_closed }]).expect("a curve");
            assert!((0.011..0.012).contains(&away_m), "{away_m}");
            assert!((perimeter(&line) / perimeter(&capped(64)) - 1.0).abs() < 1e-3, "{}", perimeter(&line));
            assert!(signed_area(&line) > 0.0 && crossing_sides(&line).is_none());
            assert_eq!(line.len(), vertices);
            let is_kept = |vertex: &V2| line.iter().any(|point| (point - vertex).norm() < 1e-9);
            assert!(drawn.iter().all(is_kept));
        };
        check(curve.clone(), true, 7 * 5);
        check(turned(curve.clone()), true, 7 * 5);
        check(cap(), false, 7 + 4 * 4);
        check(turned(cap()), false, 7 + 4 * 4);
    }

    #[test]
    fn a_curve_that_draws_no_part_of_the_line_changes_nothing() {
        let check = |curve: Vec<V2>| {
            let mut line = capped(64);
            assert_eq!(follow(&mut line, &[Line { points: curve, is_closed: false }]), None);
            assert_eq!(line, capped(64));
        };
        // Ends nowhere on the line, and a chord across the piece.
        check(vec![V2::new(0.1, 0.1), V2::new(0.2, 0.2)]);
        check(vec![V2::new(0.0, 0.0), V2::new(0.15, 0.45)]);
    }
}
