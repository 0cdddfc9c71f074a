//! Quality validation curves: the curve that the writing program means, beside its turn and curve points.
//!
//! A program that draws a curve as few points writes the true curve on layer 84 (boundary) and 87 (sew line) [ASTM
//! D6673], so that a reader can check its own. It is sewn wherever it leaves the points by more than rounding.

use super::outline::{Line, chains};
use geom::V2;
use geom::polyline::{segment_distance, signed_area};
use geom::units::mm;

/// Distance below which curve and points are the same line, m: coordinates of files are rounded to 0.1 mm.
const SAME_M: f64 = 0.2e-3;
/// Distance below which a curve ends at a vertex, or passes through one, m.
const AT_VERTEX_M: f64 = 0.5e-3;
/// Greatest distance of a curve from the points that it explains, as a share of its length. The arc over a chord of a
/// right angle bulges by a tenth.
const FARTHEST: f64 = 0.1;

/// Replaces the parts of a closed line that its quality curves draw otherwise. Returns the greatest distance between
/// them, m. `None` if nothing was replaced.
pub fn follow(line: &mut Vec<V2>, curves: &[Line]) -> Option<f64> {
    let mut farthest_m: Option<f64> = None;
    for curve in chains(curves) {
        let section = if curve.closes() { whole(line, &curve) } else { part(line, &curve) };
        let Some(Section { from, steps, points }) = section else { continue };
        let n = line.len();
        let old: Vec<V2> = (0..=steps).map(|k| line[(from + k) % n]).collect();
        let away_m = away(&old, &points).max(away(&points, &old));
        if away_m <= SAME_M || away_m > FARTHEST * length(&points) {
            continue;
        }
        let kept = (0..=n - steps).map(|k| line[(from + steps + k) % n]);
        let inner = through(&old, points);
        *line = kept.chain(inner[1..inner.len() - 1].iter().copied()).collect();
        farthest_m = Some(farthest_m.unwrap_or(0.0).max(away_m));
    }
    farthest_m
}

/// Remark on a line that follows its quality curve. `drawn` is its number of vertices before.
pub fn remark(block: &str, what: &str, layer: &str, drawn: usize, away_m: f64) -> String {
    format!(
        "block `{block}`: its {what} is sewn along its quality curve (layer {layer}), up to {:.1} mm from the {drawn} points",
        mm(away_m)
    )
}

/// Part of a closed line that a curve draws again.
struct Section {
    /// Index of the first vertex.
    from: usize,
    /// Number of sides.
    steps: usize,
    /// Points of the curve, in the direction of the line.
    points: Vec<V2>,
}

/// Section of a closed curve: the whole line, from its vertex nearest to the first point of the curve.
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

/// Section of an open curve between two vertices of the line: of both ways round, the one nearer to it in length.
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

/// Points of a curve, and the vertices of the old line that lie on it: marks refer to them.
fn through(old: &[V2], curve: Vec<V2>) -> Vec<V2> {
    let mut points = curve;
    for vertex in &old[1..old.len().max(2) - 1] {
        if points.iter().any(|point| (point - vertex).norm() < AT_VERTEX_M) {
            continue;
        }
        let on = points.windows(2).position(|ends| segment_distance(&ends[0], &ends[1], vertex) < AT_VERTEX_M);
        if let Some(side) = on {
            points.insert(side + 1, *vertex);
        }
    }
    points
}

fn vertex_at(line: &[V2], place: &V2) -> Option<usize> {
    let distance = |k: &usize| (line[*k] - place).norm();
    (0..line.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).filter(|k| distance(k) < AT_VERTEX_M)
}

/// Greatest distance of the points of a line from another line, m.
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
    use geom::polyline::{boundary_distance, perimeter};

    /// Rectangle with a cap of `chords` over its upper side, counter-clockwise.
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
        let check = |curve: Vec<V2>, is_closed: bool| {
            let mut line = drawn.clone();
            let away_m = follow(&mut line, &[Line { points: curve, is_closed }]).expect("the curve is another");
            assert!((0.011..0.012).contains(&away_m), "{away_m}");
            assert!((perimeter(&line) - perimeter(&capped(64))).abs() < 1e-9, "{}", perimeter(&line));
            let is_kept = |vertex: &V2| line.iter().any(|point| (point - vertex).norm() < 1e-9);
            assert!(drawn.iter().all(is_kept));
            assert!(line.iter().all(|point| boundary_distance(&line, point) < 1e-12));
        };
        check(curve.clone(), true);
        check(turned(curve.clone()), true);
        check(cap(), false);
        check(turned(cap()), false);
    }

    #[test]
    fn a_curve_that_is_the_same_line_or_another_one_changes_nothing() {
        let check = |curve: Vec<V2>| {
            let mut line = capped(64);
            assert_eq!(follow(&mut line, &[Line { points: curve, is_closed: false }]), None);
            assert_eq!(line, capped(64));
        };
        check(capped(64)[2..].to_vec());
        // Ends nowhere on the line, and a chord across the piece.
        check(vec![V2::new(0.1, 0.1), V2::new(0.2, 0.2)]);
        check(vec![V2::new(0.0, 0.0), V2::new(0.15, 0.45)]);
    }
}
