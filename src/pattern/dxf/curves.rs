//! Flattening of curved entities into chains of chords: bulges, arcs, ellipses and splines [DXF reference].
//!
//! Chords stay within [`CHORD_ERROR_M`] of the curve and turn so little that the length of a flattened arc is accurate
//! to 0.004 %.

use std::f64::consts::{FRAC_PI_2, TAU};

use geom::V2;

pub const CHORD_ERROR_M: f64 = 0.01e-3;
/// Greatest turning angle of a chord, radians. The relative error of its length is the squared angle divided by 24.
const MOST_TURN: f64 = 0.03;
const MOST_HALVINGS: usize = 10;
/// DXF writers use 3, and the cost of de Boor's algorithm is quadratic in the degree.
const MOST_DEGREE: usize = 25;

/// Points after `start` up to and including `end`. `bulge` is 2 * sagitta / chord, the tangent of a quarter of the
/// included angle, negative for an arc to the left of the chord [DXF reference, LWPOLYLINE].
pub fn bulge(start: V2, end: V2, bulge: f64, tolerance: f64) -> Vec<V2> {
    let turn = 4.0 * bulge.atan();
    let chord = end - start;
    let half_sine = (0.5 * turn).sin();
    if half_sine == 0.0 || chord.norm() == 0.0 {
        return vec![end];
    }
    // The centre lies on the perpendicular bisector of the chord.
    let left = V2::new(-chord.y, chord.x);
    let centre = start + chord * 0.5 + left * (0.5 / (0.5 * turn).tan());
    let from = start - centre;
    let count = steps(turn, from.norm(), tolerance);
    let mut points: Vec<V2> = (1..count).map(|k| centre + rotated(from, turn * k as f64 / count as f64)).collect();
    points.push(end);
    points
}

/// Counter-clockwise from one direction to another. Equal directions give a full circle.
pub fn arc(centre: V2, radius: f64, degrees: [f64; 2], tolerance: f64) -> Vec<V2> {
    let [from, to] = degrees.map(f64::to_radians);
    let turn = full_turn(to - from);
    let count = steps(turn, radius, tolerance);
    let start = rotated(V2::new(radius, 0.0), from);
    (0..=count).map(|k| centre + rotated(start, turn * k as f64 / count as f64)).collect()
}

/// The first point is not repeated.
pub fn circle(centre: V2, radius: f64, tolerance: f64) -> Vec<V2> {
    let mut points = arc(centre, radius, [0.0, 0.0], tolerance);
    points.pop();
    points
}

/// Arc between two parameters, radians. `major` is the semi-major axis, `ratio` the minor axis divided by the major
/// axis.
pub fn ellipse(centre: V2, major: V2, ratio: f64, parameters: [f64; 2], tolerance: f64) -> Vec<V2> {
    let minor = V2::new(-major.y, major.x) * ratio;
    let turn = full_turn(parameters[1] - parameters[0]);
    // The curvature is greatest at the ends of the longer axis. Steps that are fine enough there are fine enough
    // elsewhere.
    let longest = major.norm().max(minor.norm());
    let eccentric = ratio.abs().max(1.0 / ratio.abs()).min(1.0 / MOST_TURN);
    let count = (steps(turn, longest, tolerance) as f64 * eccentric).ceil() as usize;
    let parameter_at = |k: usize| parameters[0] + turn * k as f64 / count as f64;
    (0..=count).map(|k| centre + major * parameter_at(k).cos() + minor * parameter_at(k).sin()).collect()
}

/// Counter-clockwise angle in radians, a full turn instead of 0.
fn full_turn(turn: f64) -> f64 {
    let turn = turn.rem_euclid(TAU);
    if turn < 1e-9 { TAU } else { turn }
}

fn steps(turn: f64, radius: f64, tolerance: f64) -> usize {
    let by_chord = if radius > 2.0 * tolerance { 2.0 * (1.0 - tolerance / radius).acos() } else { FRAC_PI_2 };
    ((turn.abs() / by_chord.min(MOST_TURN)).ceil() as usize).clamp(1, 20_000)
}

fn rotated(vector: V2, angle: f64) -> V2 {
    let (sine, cosine) = angle.sin_cos();
    V2::new(cosine * vector.x - sine * vector.y, sine * vector.x + cosine * vector.y)
}

/// Rational if it has weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    degree: usize,
    knots: Vec<f64>,
    /// Homogeneous: each point times its weight, and the weight.
    control: Vec<(V2, f64)>,
}

impl Spline {
    pub fn new(degree: i32, knots: &[f64], control: &[V2], weights: &[f64]) -> Result<Self, String> {
        let of_degree = usize::try_from(degree).ok().filter(|degree| (1..=MOST_DEGREE).contains(degree));
        let Some(degree) = of_degree else {
            return Err(format!("a spline of degree {degree}; accepted: 1 to {MOST_DEGREE}"));
        };
        if control.len() <= degree || knots.len() != control.len() + degree + 1 {
            return Err(format!(
                "a spline of degree {degree} with {} control points and {} knots; accepted: control points, and as \
                 many knots as they and the degree and one",
                control.len(),
                knots.len()
            ));
        }
        let is_rising = knots.windows(2).all(|pair| pair[0] <= pair[1]);
        if !is_rising || knots[degree] >= knots[control.len()] {
            return Err("a spline whose knots do not rise; accepted: knots in order".to_owned());
        }
        if !weights.is_empty() && (weights.len() != control.len() || weights.iter().any(|&w| w <= 0.0)) {
            return Err(format!(
                "a spline of {} control points with {} weights; accepted: one above 0 each",
                control.len(),
                weights.len()
            ));
        }
        let weight = |k: usize| weights.get(k).copied().unwrap_or(1.0);
        let control = control.iter().enumerate().map(|(k, &point)| (point * weight(k), weight(k))).collect();
        Ok(Self { degree, knots: knots.to_vec(), control })
    }

    /// Point at `u` in a knot span, by de Boor's algorithm [de Boor].
    fn at(&self, span: usize, u: f64) -> V2 {
        let p = self.degree;
        let mut points = self.control[span - p..=span].to_vec();
        for level in 1..=p {
            for j in (level..=p).rev() {
                let (low, high) = (self.knots[span - p + j], self.knots[span + 1 + j - level]);
                let share = if high > low { (u - low) / (high - low) } else { 0.0 };
                let (before, here) = (points[j - 1], points[j]);
                points[j] = (before.0 * (1.0 - share) + here.0 * share, before.1 * (1.0 - share) + here.1 * share);
            }
        }
        points[p].0 / points[p].1
    }

    pub fn flattened(&self, tolerance: f64) -> Vec<V2> {
        let mut points = Vec::new();
        for span in self.degree..self.control.len() {
            let (from, to) = (self.knots[span], self.knots[span + 1]);
            if to <= from {
                continue;
            }
            let start = self.at(span, from);
            if points.is_empty() {
                points.push(start);
            }
            let ends = [(from, start), (to, self.at(span, to))];
            self.halve(span, ends, tolerance, MOST_HALVINGS, &mut points);
        }
        points
    }

    /// Adds the points after the first end, bisecting until the chords follow the curve.
    fn halve(&self, span: usize, ends: [(f64, V2); 2], tolerance: f64, halvings: usize, points: &mut Vec<V2>) {
        let [(from, start), (to, end)] = ends;
        let middle = 0.5 * (from + to);
        let inner = [0.25, 0.5, 0.75].map(|share| self.at(span, from + (to - from) * share));
        let chain = [start, inner[0], inner[1], inner[2], end];
        let off = |point: &V2| geom::polyline::segment_distance(&start, &end, point);
        let turn = |k: usize| (chain[k + 1] - chain[k]).angle(&(chain[k + 2] - chain[k + 1]));
        let is_straight = inner.iter().all(|point| off(point) <= tolerance)
            && ((end - start).norm() <= tolerance || (0..3).map(turn).sum::<f64>() <= MOST_TURN);
        // At least one bisection is made, because a curve with an inflection may cross its chord at the middle.
        if (is_straight && halvings < MOST_HALVINGS) || halvings == 0 {
            return points.push(end);
        }
        let half = (middle, inner[1]);
        self.halve(span, [ends[0], half], tolerance, halvings - 1, points);
        self.halve(span, [half, ends[1]], tolerance, halvings - 1, points);
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::curve::length;

    fn close(found: f64, expect: f64, share: f64) {
        assert!((found / expect - 1.0).abs() < share, "{found} for {expect}");
    }

    fn lie_on_circle(points: &[V2], centre: V2, radius: f64) {
        assert!(points.iter().all(|p| ((p - centre).norm() - radius).abs() < 1e-12), "{points:?}");
    }

    #[test]
    fn bulges_are_arcs() {
        let check = |value: f64, centre: V2, radius: f64, turn: f64| {
            let start = V2::new(0.0, 0.0);
            let mut points = vec![start];
            points.extend(bulge(start, V2::new(0.2, 0.0), value, CHORD_ERROR_M));
            lie_on_circle(&points, centre, radius);
            close(length(&points), radius * turn, 5e-5);
            assert_eq!(points.last(), Some(&V2::new(0.2, 0.0)));
        };
        check(1.0, V2::new(0.1, 0.0), 0.1, PI);
        check(-1.0, V2::new(0.1, 0.0), 0.1, PI);
        let quarter = (PI / 8.0).tan();
        check(quarter, V2::new(0.1, 0.1), 0.1 * 2.0_f64.sqrt(), PI / 2.0);
        check(-quarter, V2::new(0.1, -0.1), 0.1 * 2.0_f64.sqrt(), PI / 2.0);
        // A positive bulge runs counter-clockwise: below a chord to the right.
        assert!(bulge(V2::zeros(), V2::new(0.2, 0.0), 1.0, CHORD_ERROR_M)[3].y < 0.0);
        assert_eq!(bulge(V2::zeros(), V2::new(0.2, 0.0), 0.0, CHORD_ERROR_M), [V2::new(0.2, 0.0)]);
    }

    #[test]
    fn chords_stay_near_their_arc() {
        for radius in [0.5e-3, 0.02, 0.3, 5.0] {
            let points = arc(V2::new(0.1, 0.2), radius, [350.0, 80.0], CHORD_ERROR_M);
            lie_on_circle(&points, V2::new(0.1, 0.2), radius);
            close(length(&points), radius * PI / 2.0, 5e-5);
            let sagitta = |ends: &[V2]| radius - (0.5 * (ends[0] + ends[1]) - V2::new(0.1, 0.2)).norm();
            assert!(points.windows(2).map(sagitta).fold(0.0, f64::max) <= CHORD_ERROR_M * 1.001);
        }
        close(geom::polyline::perimeter(&circle(V2::zeros(), 0.05, CHORD_ERROR_M)), 0.1 * PI, 5e-5);
    }

    #[test]
    fn a_half_ellipse_has_its_length() {
        let points = ellipse(V2::zeros(), V2::new(0.0, 0.2), 0.5, [0.0, PI], CHORD_ERROR_M);
        assert!((points[0] - V2::new(0.0, 0.2)).norm() < 1e-12);
        assert!((points[points.len() / 2] - V2::new(-0.1, 0.0)).norm() < 1e-3);
        // Half the perimeter of an ellipse of half axes 2 and 1 is 4.844224.
        close(length(&points), 0.484_422_4, 5e-5);
    }

    #[test]
    fn splines_are_curves_of_de_boor() {
        let control = [(0.0, 0.0), (0.1, 0.2), (0.3, -0.1), (0.4, 0.1)].map(|(x, y)| V2::new(x, y));
        let spline = Spline::new(3, &[0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], &control, &[]).expect("a Bezier curve");
        let points = spline.flattened(CHORD_ERROR_M);
        close(length(&points), length(&crate::curve::bezier(control)), 2e-4);
        assert_eq!((points[0], points[points.len() - 1]), (control[0], control[3]));
        // A rational quadratic of weight cos 45 is a quarter circle.
        let control = [(0.1, 0.0), (0.1, 0.1), (0.0, 0.1)].map(|(x, y)| V2::new(x, y));
        let weights = [1.0, 0.5_f64.sqrt(), 1.0];
        let quarter = Spline::new(2, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &control, &weights).expect("a quarter circle");
        let points = quarter.flattened(CHORD_ERROR_M);
        lie_on_circle(&points, V2::zeros(), 0.1);
        close(length(&points), 0.05 * PI, 5e-5);
    }

    #[test]
    fn a_uniform_spline_counts_only_between_its_inner_knots() {
        let control: Vec<V2> = (0..6).map(|k| V2::new(0.1 * f64::from(k), 0.0)).collect();
        let knots: Vec<f64> = (0..10).map(f64::from).collect();
        let points = Spline::new(3, &knots, &control, &[]).expect("uniform").flattened(CHORD_ERROR_M);
        close(points[0].x, 0.1, 1e-12);
        close(points[points.len() - 1].x, 0.4, 1e-12);
    }

    #[test]
    fn impossible_splines_are_refused() {
        let two = [V2::zeros(), V2::new(1.0, 0.0)];
        let check = |degree: i32, knots: &[f64], weights: &[f64], expect: &str| {
            let error = Spline::new(degree, knots, &two, weights).expect_err(expect);
            assert!(error.contains(expect) && error.contains("accepted"), "{error}");
        };
        check(0, &[0.0, 1.0], &[], "degree 0");
        check(3, &[0.0, 1.0], &[], "2 control points and 2 knots");
        check(1, &[0.0, 0.0, 1.0], &[], "3 knots");
        check(1, &[1.0, 1.0, 0.0, 0.0], &[], "do not rise");
        check(1, &[0.0, 0.0, 0.0, 0.0], &[], "do not rise");
        check(1, &[0.0, 0.0, 1.0, 1.0], &[1.0, 0.0], "weights");
    }
}
