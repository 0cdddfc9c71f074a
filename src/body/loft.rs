//! Lofted body parts: star-shaped cross-sections on parallel planes along an axis, and the distance-like field of the
//! surface through them.

use super::interpolate::Monotone;
use crate::geom::{V2, V3, hull};

/// Cosine coefficients of a section's shape, harmonics 0 to 8.
pub(super) type Shape = [f64; 9];

/// Directions in which a section is tabulated.
const DIRECTIONS: usize = 96;

/// Steepest outline slope along the axis that the field still divides by.
const MAX_SLOPE: f64 = 4.0;

/// Greatest relative change of the radius with the angle that the field still divides by.
const MAX_TURN: f64 = 2.0;

/// Half of the angle over which that change is taken, radians.
const TURN_PROBE: f64 = 0.02;

/// One cross-section: an ellipse whose radius is multiplied by `1 + sum shape[k] cos(k phi)`, `phi` from the front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Station {
    /// Place along the axis, metres.
    pub at: f64,
    /// Centre in the section plane, metres.
    pub centre: V2,
    /// Half of the extent along the first axis of the section plane, metres.
    pub half_width: f64,
    /// Half of the extent along the second axis, metres.
    pub half_depth: f64,
    /// Departure from the ellipse.
    pub shape: Shape,
}

impl Station {
    /// Distance from the centre to the outline in the direction `angle`, radians from the first axis.
    pub fn radius(&self, angle: f64) -> f64 {
        let (sin, cos) = angle.sin_cos();
        let ellipse =
            self.half_width * self.half_depth / (self.half_depth * cos).hypot(self.half_width * sin).max(1e-12);
        let phi = angle - std::f64::consts::FRAC_PI_2;
        let departure: f64 = self.shape.iter().enumerate().map(|(k, c)| c * (k as f64 * phi).cos()).sum();
        ellipse * (1.0 + departure)
    }

    /// Points of the outline in the section plane, counter-clockwise from the first axis.
    pub fn outline(&self, count: usize) -> Vec<V2> {
        let point = |i: usize| {
            let angle = i as f64 / count as f64 * std::f64::consts::TAU;
            self.centre + V2::new(angle.cos(), angle.sin()) * self.radius(angle)
        };
        (0..count).map(point).collect()
    }

    /// Tape girth of the section, metres.
    pub fn girth(&self) -> f64 {
        hull::tape_girth(&self.outline(DIRECTIONS))
    }

    /// The same shape enlarged about its centre to a tape girth in metres.
    pub fn with_girth(mut self, girth: f64) -> Self {
        let factor = girth / self.girth();
        self.half_width *= factor;
        self.half_depth *= factor;
        self
    }
}

/// Value of a part's field with the direction in which it grows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// About the distance from the surface, metres; negative inside.
    pub distance: f64,
    /// Unit outward direction.
    pub outward: V3,
}

/// One row of the table of a loft.
#[derive(Clone, Debug)]
struct Row {
    centre: V2,
    /// Radius, its slope along the axis (the drift of the centre included) and its relative change with the angle, for each
    /// direction.
    radii: Vec<[f64; 3]>,
}

/// A body part: sections along an axis, tabulated.
#[derive(Clone, Debug)]
pub(super) struct Loft {
    origin: V3,
    /// Section axes `u`, `v`, and the loft axis.
    axes: [V3; 3],
    start: f64,
    step: f64,
    rows: Vec<Row>,
    greatest_radius: f64,
}

impl Loft {
    /// A part through `stations` (two at least, ordered along the axis) in the frame `axes = [u, v, along]` at `origin`.
    pub fn new(origin: V3, axes: [V3; 3], stations: &[Station], step: f64) -> Self {
        let (start, end) = (stations[0].at, stations[stations.len() - 1].at);
        let count = ((end - start) / step).ceil().max(2.0) as usize;
        let step = (end - start) / count as f64;
        let curves = Curves::new(stations);
        let sections: Vec<Station> = (0..=count).map(|i| curves.at(start + step * i as f64)).collect();
        let rows =
            (0..=count).map(|i| Row::new(&sections[i.saturating_sub(1)..=(i + 1).min(count)], &sections[i])).collect();
        let greatest_radius =
            sections.iter().map(|s| s.half_width.max(s.half_depth) * 1.2 + s.centre.norm()).fold(0.0, f64::max);
        Self { origin, axes, start, step, rows, greatest_radius }
    }

    /// Place of a point along the axis, metres.
    pub fn along(&self, point: V3) -> f64 {
        (point - self.origin).dot(&self.axes[2])
    }

    /// Field at a point of space.
    ///
    /// Far from the part, where only the order of magnitude matters, the distance of a bounding cylinder stands in.
    pub fn sample(&self, point: V3, near: f64) -> Sample {
        let offset = point - self.origin;
        let [u, v, along] = self.axes;
        let local = V2::new(offset.dot(&u), offset.dot(&v));
        let place = (offset.dot(&along) - self.start) / self.step;
        let last = (self.rows.len() - 1) as f64;
        let beyond = (-place).max(place - last) * self.step;
        let clearance = beyond.max(local.norm() - self.greatest_radius);
        if clearance > near {
            return Sample { distance: clearance, outward: offset.try_normalize(1e-12).unwrap_or(along) };
        }
        let (radial, normal, slope) = self.radial(local, place.clamp(0.0, last));
        let side = u * normal.x + v * normal.y;
        if beyond <= 0.0 {
            let gradient = side - along * slope;
            let steepness = gradient.norm();
            return Sample { distance: radial / steepness, outward: gradient / steepness };
        }
        let (side, radial) = (side / normal.norm(), radial / normal.norm());
        let end = if place < 0.0 { -along } else { along };
        if radial <= 0.0 {
            return Sample { distance: beyond, outward: end };
        }
        let distance = beyond.hypot(radial);
        Sample { distance, outward: (side * radial + end * beyond) / distance }
    }

    /// Distance beyond the outline along the ray from the centre, its gradient within the section plane, and the outline's
    /// slope along the axis.
    fn radial(&self, local: V2, place: f64) -> (f64, V2, f64) {
        let row = (place as usize).min(self.rows.len() - 2);
        let share = place - row as f64;
        let (low, high) = (&self.rows[row], &self.rows[row + 1]);
        let from_centre = local - low.centre.lerp(&high.centre, share);
        let distance = from_centre.norm();
        let direction = if distance > 1e-9 { from_centre / distance } else { V2::x() };
        let turn = from_centre.y.atan2(from_centre.x).rem_euclid(std::f64::consts::TAU);
        let column = turn / std::f64::consts::TAU * DIRECTIONS as f64;
        let left = column as usize % DIRECTIONS;
        let right = (left + 1) % DIRECTIONS;
        let across = column - column.floor();
        let blend = |i: usize| {
            let at = |row: &Row| row.radii[left][i] + (row.radii[right][i] - row.radii[left][i]) * across;
            at(low) + (at(high) - at(low)) * share
        };
        let sideways = V2::new(-direction.y, direction.x);
        let gradient = direction - sideways * blend(2).clamp(-MAX_TURN, MAX_TURN);
        (distance - blend(0), gradient, blend(1).clamp(-MAX_SLOPE, MAX_SLOPE))
    }
}

impl Row {
    /// Radii of `section`, slopes from its neighbours (first and last of `around`).
    fn new(around: &[Station], section: &Station) -> Self {
        let (before, after) = (around[0], around[around.len() - 1]);
        let length = (after.at - before.at).max(1e-12);
        let drift = (after.centre - before.centre) / length;
        let radii = (0..DIRECTIONS).map(|i| {
            let angle = i as f64 / DIRECTIONS as f64 * std::f64::consts::TAU;
            let slope =
                (after.radius(angle) - before.radius(angle)) / length + drift.dot(&V2::new(angle.cos(), angle.sin()));
            let radius = section.radius(angle);
            let turn =
                (section.radius(angle + TURN_PROBE) - section.radius(angle - TURN_PROBE)) / (2.0 * TURN_PROBE * radius);
            [radius, slope, turn]
        });
        Self { centre: section.centre, radii: radii.collect() }
    }
}

/// Every number of a station as a smooth function of the place along the axis.
struct Curves {
    numbers: [Monotone; 13],
}

impl Curves {
    fn new(stations: &[Station]) -> Self {
        let at: Vec<f64> = stations.iter().map(|s| s.at).collect();
        let number = |s: &Station, i: usize| match i {
            0 => s.centre.x,
            1 => s.centre.y,
            2 => s.half_width,
            3 => s.half_depth,
            k => s.shape[k - 4],
        };
        Self {
            numbers: std::array::from_fn(|i| {
                Monotone::new(&at, &stations.iter().map(|s| number(s, i)).collect::<Vec<_>>())
            }),
        }
    }

    fn at(&self, at: f64) -> Station {
        let n = |i: usize| self.numbers[i].at(at);
        Station {
            at,
            centre: V2::new(n(0), n(1)),
            half_width: n(2),
            half_depth: n(3),
            shape: std::array::from_fn(|k| n(k + 4)),
        }
    }
}

/// Stations that close a part with a dome of the given `length` beyond `end`, in the direction of `sign`.
///
/// They stand in order of increasing distance from `end`; the last has (almost) no extent.
pub(super) fn dome(end: &Station, length: f64, sign: f64) -> Vec<Station> {
    let ring = |share: &f64| {
        let factor = (1.0 - share * share).sqrt().max(0.01);
        Station {
            at: end.at + sign * length * share,
            half_width: end.half_width * factor,
            half_depth: end.half_depth * factor,
            ..*end
        }
    };
    [0.2, 0.4, 0.6, 0.75, 0.87, 0.94, 0.98, 1.0].iter().map(ring).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball() -> Loft {
        let equator = Station { at: 0.0, centre: V2::zeros(), half_width: 0.1, half_depth: 0.1, shape: [0.0; 9] };
        let mut stations = dome(&equator, 0.1, -1.0);
        stations.reverse();
        stations.push(equator);
        stations.extend(dome(&equator, 0.1, 1.0));
        Loft::new(V3::zeros(), [V3::x(), V3::y(), V3::z()], &stations, 0.001)
    }

    #[test]
    fn two_domes_make_a_ball() {
        let ball = ball();
        for direction in [V3::x(), V3::y(), V3::new(1.0, 1.0, 1.0), V3::new(0.3, -0.2, -0.8)] {
            let on_surface = direction.normalize() * 0.1;
            let sample = ball.sample(on_surface, 1.0);
            assert!(sample.distance.abs() < 1.5e-3, "{direction:?}: {}", sample.distance);
            assert!(ball.sample(on_surface * 0.8, 1.0).distance < 0.0);
            assert!(sample.outward.dot(&on_surface) > 0.09);
        }
    }

    #[test]
    fn a_station_takes_the_girth_asked_for() {
        let shape = [0.03, -0.01, -0.01, 0.0, -0.07, -0.01, 0.0, 0.0, 0.0];
        let station = Station { at: 0.0, centre: V2::zeros(), half_width: 0.17, half_depth: 0.12, shape };
        assert!((station.with_girth(0.93).girth() - 0.93).abs() < 1e-12);
    }
}
