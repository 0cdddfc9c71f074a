//! Lofted body parts: star-shaped sections on parallel planes along an axis, and a field that approximates the signed
//! distance from the surface through these sections.

use super::interpolate::Monotone;
use geom::{V2, V3, hull, smooth_step};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::LazyLock;

/// Cosine coefficients of the radius of a section, harmonics 0 to 8.
pub(super) type Shape = [f64; 9];

/// Number of tabulated directions of a section: twelve per period of the highest harmonic.
pub(super) const DIRECTIONS: usize = 96;

/// Bound on the slope of the outline along the axis, by which the field is divided. Judgement.
const MAX_SLOPE: f64 = 4.0;

/// Bound on the relative change of the radius with the angle, by which the field is divided. Judgement.
const MAX_TURN: f64 = 2.0;

/// A tabulated direction, with the cosines of the harmonics of its angle from the front.
struct Direction {
    along: V2,
    harmonics: Shape,
}

static COMPASS: LazyLock<Vec<Direction>> = LazyLock::new(|| {
    let direction = |i: usize| {
        let angle = i as f64 / DIRECTIONS as f64 * TAU;
        let harmonics = std::array::from_fn(|k| (k as f64 * (angle - FRAC_PI_2)).cos());
        Direction { along: V2::new(angle.cos(), angle.sin()), harmonics }
    };
    (0..DIRECTIONS).map(direction).collect()
});

/// A section: an ellipse with its radius multiplied by `1 + sum shape[k] cos(k phi)`, where `phi` is the angle from the
/// front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Station {
    /// Position along the axis, m.
    pub at: f64,
    /// Centre in the plane of the section, m.
    pub centre: V2,
    /// Half of the extent along the first axis of the plane, m.
    pub half_width: f64,
    /// Half of the extent along the second axis of the plane, m.
    pub half_depth: f64,
    pub shape: Shape,
}

impl Station {
    /// Radii in the tabulated directions, m.
    pub fn radii(&self) -> Vec<f64> {
        let radius = |direction: &Direction| {
            let (cos, sin) = (direction.along.x, direction.along.y);
            let across = (self.half_depth * cos).powi(2) + (self.half_width * sin).powi(2);
            let ellipse = self.half_width * self.half_depth / across.sqrt().max(1e-12);
            let departure: f64 = self.shape.iter().zip(&direction.harmonics).map(|(c, cosine)| c * cosine).sum();
            ellipse * (1.0 + departure)
        };
        // The shape is symmetric: the directions from the front through the left to the back give the others.
        let [front, back] = [DIRECTIONS / 4, 3 * DIRECTIONS / 4];
        let half: Vec<f64> = COMPASS[front..=back].iter().map(radius).collect();
        let mirrored = |i: usize| (DIRECTIONS + DIRECTIONS / 2 - i) % DIRECTIONS;
        let place = |i: usize| if (front..=back).contains(&i) { i } else { mirrored(i) };
        (0..DIRECTIONS).map(|i| half[place(i) - front]).collect()
    }

    /// Tape girth of the section, m.
    pub fn girth(&self) -> f64 {
        let point = |(direction, radius): (&Direction, f64)| direction.along * radius;
        hull::tape_girth(&COMPASS.iter().zip(self.radii()).map(point).collect::<Vec<_>>())
    }

    /// Scales the section about its centre to a tape girth, m.
    pub fn with_girth(mut self, girth: f64) -> Self {
        let factor = girth / self.girth();
        self.half_width *= factor;
        self.half_depth *= factor;
        self
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// Approximate signed distance from the surface, m, negative inside.
    pub distance: f64,
    /// Unit vector outwards.
    pub outward: V3,
}

/// Body part: sections in order along an axis, in the frame `axes = [u, v, along]` at `origin`.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub origin: V3,
    pub axes: [V3; 3],
    pub stations: Vec<Station>,
    /// Positions along the axis between which the weight of the part rises from 0 to 1, because its neighbours take its
    /// place before. The end of the part before the first position lies inside these and is not skin.
    pub root: Option<[f64; 2]>,
}

impl Part {
    /// Weight of the part at a position along the axis, above 0 and at most 1.
    pub fn own(&self, at: f64) -> f64 {
        self.root.map_or(1.0, |[none, all]| smooth_step(((at - none) / (all - none)).max(1e-3)))
    }

    fn rings(&self, places: impl Iterator<Item = f64>) -> Vec<Ring> {
        let curves = Curves::new(&self.stations);
        places.map(|place| Ring::new(&curves.at(place))).collect()
    }

    /// Tabulates the part at the positions that correspond to `rings` of the part `other` of another figure: at the
    /// same shares of the distances between sections.
    pub fn like(&self, other: &Self, rings: &[Ring]) -> Vec<Ring> {
        let places = |part: &Self| part.stations.iter().map(|station| station.at).collect::<Vec<_>>();
        let course = Monotone::new(&places(other), &places(self));
        self.rings(rings.iter().map(|ring| course.at(ring.at)))
    }

    pub fn lift(&self, local: V2, along: f64) -> V3 {
        let [u, v, w] = self.axes;
        self.origin + u * local.x + v * local.y + w * along
    }
}

/// Tabulated section, in metres.
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    pub at: f64,
    pub centre: V2,
    pub radii: Vec<f64>,
}

impl Ring {
    fn new(section: &Station) -> Self {
        Self { at: section.at, centre: section.centre, radii: section.radii() }
    }

    /// Radius in a direction, by linear interpolation. `column` is the number of the tabulated direction.
    pub fn radius(&self, column: f64) -> f64 {
        let left = column as usize % DIRECTIONS;
        let across = column - column.floor();
        self.radii[left] + (self.radii[(left + 1) % DIRECTIONS] - self.radii[left]) * across
    }
}

/// Slope of the outline along the axis (with the drift of the centre), and relative derivative of the radius by the
/// angle, in each tabulated direction.
type Slopes = Vec<[f64; 2]>;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Position along the axis as a number of tabulated sections, clamped to the part.
    pub ring: f64,
    /// Distance along the axis past the ends of the part, m.
    pub past: f64,
    pub local: V2,
}

/// Field in a section, apart from the ends of the part.
struct Radial {
    /// Distance from the outline along the ray from the centre, m.
    distance: f64,
    gradient: V2,
    /// Slope of the outline along the axis.
    slope: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Loft {
    part: Part,
    start: f64,
    step: f64,
    rings: Vec<Ring>,
    slopes: Vec<Slopes>,
    greatest_radius: f64,
}

impl Loft {
    /// Tabulates the field of a part at intervals of about `step`, m.
    pub fn new(part: Part, step: f64) -> Self {
        let stations = &part.stations;
        let (start, end) = (stations[0].at, stations[stations.len() - 1].at);
        let count = ((end - start) / step).ceil().max(2.0) as usize;
        let step = (end - start) / count as f64;
        let rings = part.rings((0..=count).map(|i| start + step * i as f64));
        let slopes = (0..=count).map(|i| slopes(&rings[i.saturating_sub(1)..=(i + 1).min(count)], &rings[i])).collect();
        let reach = |ring: &Ring| ring.centre.norm() + ring.radii.iter().copied().fold(0.0, f64::max);
        let greatest_radius = rings.iter().map(reach).fold(0.0, f64::max);
        Self { part, start, step, rings, slopes, greatest_radius }
    }

    pub fn own(&self, point: V3) -> f64 {
        self.part.own(self.along(point))
    }

    pub fn rings(&self) -> &[Ring] {
        &self.rings
    }

    pub fn locate(&self, point: V3) -> Place {
        let offset = point - self.part.origin;
        let [u, v, along] = self.part.axes;
        let place = (offset.dot(&along) - self.start) / self.step;
        let within = place.clamp(0.0, (self.rings.len() - 1) as f64);
        Place { ring: within, past: (place - within) * self.step, local: V2::new(offset.dot(&u), offset.dot(&v)) }
    }

    /// Position of a point along the axis, m.
    pub fn along(&self, point: V3) -> f64 {
        (point - self.part.origin).dot(&self.part.axes[2])
    }

    /// Distance from a bounding cylinder farther away than `near`, where only the order of magnitude matters.
    pub fn sample(&self, point: V3, near: f64) -> Sample {
        let [u, v, along] = self.part.axes;
        let Place { ring: place, past, local } = self.locate(point);
        let beyond = past.abs();
        let clearance = beyond.max(local.norm() - self.greatest_radius);
        if clearance > near {
            let offset = point - self.part.origin;
            return Sample { distance: clearance, outward: offset.try_normalize(1e-12).unwrap_or(along) };
        }
        let Radial { distance: radial, gradient: normal, slope } = self.radial(local, place);
        let side = u * normal.x + v * normal.y;
        if beyond <= 0.0 {
            let gradient = side - along * slope;
            let steepness = gradient.norm();
            return Sample { distance: radial / steepness, outward: gradient / steepness };
        }
        let (side, radial) = (side / normal.norm(), radial / normal.norm());
        let end = if past < 0.0 { -along } else { along };
        if radial <= 0.0 {
            return Sample { distance: beyond, outward: end };
        }
        let distance = beyond.hypot(radial);
        Sample { distance, outward: (side * radial + end * beyond) / distance }
    }

    fn radial(&self, local: V2, place: f64) -> Radial {
        let row = (place as usize).min(self.rings.len() - 2);
        let share = place - row as f64;
        let (low, high) = (&self.rings[row], &self.rings[row + 1]);
        let from_centre = local - low.centre.lerp(&high.centre, share);
        let distance = from_centre.norm();
        let direction = if distance > 1e-9 { from_centre / distance } else { V2::x() };
        let column = column(from_centre);
        let (left, across) = (column as usize % DIRECTIONS, column - column.floor());
        let right = (left + 1) % DIRECTIONS;
        let radius = low.radius(column) + (high.radius(column) - low.radius(column)) * share;
        let [slope, turn] = std::array::from_fn(|i| {
            let interpolated = |slopes: &Slopes| slopes[left][i] + (slopes[right][i] - slopes[left][i]) * across;
            let (low, high) = (interpolated(&self.slopes[row]), interpolated(&self.slopes[row + 1]));
            low + (high - low) * share
        });
        let sideways = V2::new(-direction.y, direction.x);
        let gradient = direction - sideways * turn.clamp(-MAX_TURN, MAX_TURN);
        Radial { distance: distance - radius, gradient, slope: slope.clamp(-MAX_SLOPE, MAX_SLOPE) }
    }
}

/// Direction of a vector in the plane of a section, as a number of tabulated directions.
pub(crate) fn column(vector: V2) -> f64 {
    vector.y.atan2(vector.x).rem_euclid(TAU) / TAU * DIRECTIONS as f64
}

/// Slopes of a section by the difference of its neighbours, which are the first and the last of `around`.
fn slopes(around: &[Ring], ring: &Ring) -> Slopes {
    let (before, after) = (&around[0], &around[around.len() - 1]);
    let length = (after.at - before.at).max(1e-12);
    let drift = (after.centre - before.centre) / length;
    let spacing = TAU / DIRECTIONS as f64;
    let slope = |i: usize| {
        let (left, right) = ((i + DIRECTIONS - 1) % DIRECTIONS, (i + 1) % DIRECTIONS);
        let turn = (ring.radii[right] - ring.radii[left]) / (2.0 * spacing * ring.radii[i]);
        [(after.radii[i] - before.radii[i]) / length + drift.dot(&COMPASS[i].along), turn]
    };
    (0..DIRECTIONS).map(slope).collect()
}

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

/// Sections that close a part with an elliptic dome of a `length` past `end` in the direction of `sign`, in the order
/// of their distance from `end`. The last has almost no extent.
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
        Loft::new(Part { origin: V3::zeros(), axes: [V3::x(), V3::y(), V3::z()], stations, root: None }, 0.001)
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
