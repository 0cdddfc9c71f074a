//! Evidence for the network: what is seen of each stretch, and of each pair of stretches, as numbers near 1.

use geom::V2;
use geom::units::mm;

use super::stretch::{Part, SAMPLES, Stretch};
use super::symmetry::Symmetry;
use crate::trade::{Class, Face, Hand};

/// Numbers of a stretch that do not depend on how its part is turned or called.
pub const SHAPE: usize = 36;
/// Numbers that depend on how the part is turned: place of the middle, outward direction, height.
pub const PLACE: usize = 5;
/// Numbers of the name: faces, hands, classes.
pub const SAID: usize = 4 + CLASSES.len();
/// Numbers of a pair that do not depend on names.
pub const PAIR: usize = 30;

pub const CLASSES: [Class; 10] = [
    Class::Body,
    Class::SidePanel,
    Class::Leg,
    Class::Sleeve,
    Class::Skirt,
    Class::Yoke,
    Class::Waistband,
    Class::Cuff,
    Class::Collar,
    Class::Other,
];

/// Angle from 180 degrees within which an outline goes on without a corner.
const SMOOTH_DEG: f64 = 12.0;
/// Angle inside a part from which a corner may be the point of a dart.
const DART_DEG: f64 = 270.0;
/// Greatest difference of the legs of a dart.
const LEGS_M: f64 = 1.5e-3;

pub struct Evidence {
    pub shape: Vec<[f32; SHAPE]>,
    pub place: Vec<[f32; PLACE]>,
    pub said: Vec<[f32; SAID]>,
}

/// In mm.
struct Extent {
    area: f64,
    perimeter: f64,
    low: V2,
    size: V2,
}

fn flag(is: bool) -> f32 {
    f32::from(u8::from(is))
}

pub fn evidence(parts: &[Part], stretches: &[Stretch], symmetry: &Symmetry) -> Evidence {
    let extents: Vec<Extent> = parts.iter().map(extent).collect();
    let total: f64 = extents.iter().map(|extent| extent.area).sum();
    let largest = extents.iter().map(|extent| extent.area).fold(0.0, f64::max);
    let shape = |(index, stretch): (usize, &Stretch)| {
        let extent = &extents[stretch.part];
        let around = Around { stretches, symmetry, index };
        let mut numbers: Vec<f32> = around.numbers();
        numbers.extend([
            (mm(stretch.length) / extent.perimeter) as f32,
            ((extent.area / 1e5).ln() / 2.0) as f32,
            ((extent.perimeter / 1e3).ln()) as f32,
            (4.0 * std::f64::consts::PI * extent.area / extent.perimeter.powi(2)) as f32,
            (extent.area / largest) as f32,
            (extent.area / total) as f32,
            (parts[stretch.part].corners.len() as f32) / 8.0,
            (parts.len() as f32) / 16.0,
        ]);
        <[f32; SHAPE]>::try_from(numbers).expect("as many numbers as are named")
    };
    Evidence {
        shape: stretches.iter().enumerate().map(shape).collect(),
        place: stretches.iter().map(|stretch| place(stretch, &extents[stretch.part])).collect(),
        said: stretches.iter().map(|stretch| said(&parts[stretch.part])).collect(),
    }
}

fn extent(part: &Part) -> Extent {
    let points = || part.outline.iter().map(|point| point.map(mm));
    let low = points().fold(V2::repeat(f64::MAX), |low, p| low.inf(&p));
    let high = points().fold(V2::repeat(f64::MIN), |high, p| high.sup(&p));
    let outline: Vec<V2> = points().collect();
    Extent {
        area: geom::polyline::signed_area(&outline).abs(),
        perimeter: geom::polyline::perimeter(&outline),
        low,
        size: high - low,
    }
}

struct Around<'s> {
    stretches: &'s [Stretch],
    symmetry: &'s Symmetry,
    index: usize,
}

impl Around<'_> {
    fn numbers(&self) -> Vec<f32> {
        let stretch = &self.stretches[self.index];
        let bend = (0..SAMPLES / 2).map(|k| ((stretch.profile[2 * k] + stretch.profile[2 * k + 1]) / 180.0) as f32);
        let angles = [stretch.start_angle, stretch.end_angle].into_iter().flat_map(|angle| {
            [
                ((angle - 180.0) / 180.0) as f32,
                angle.to_radians().cos() as f32,
                flag((angle - 180.0).abs() < SMOOTH_DEG),
                flag(angle > DART_DEG),
            ]
        });
        let symmetry = [
            flag(self.symmetry.own[self.index] == Some(self.index)),
            flag(self.symmetry.own[self.index].is_some()),
            flag(self.symmetry.twin_part[stretch.part].is_some()),
            (self.symmetry.copies[stretch.part] - 1) as f32 / 3.0,
            flag(self.is_leg(stretch.next, stretch.end_angle)),
            flag(self.is_leg(stretch.previous, stretch.start_angle)),
        ];
        let notches = [
            (stretch.notches.len().min(3) as f32) / 3.0,
            stretch.notches.first().map_or(0.0, |arc| (arc / stretch.length) as f32),
        ];
        let own = [
            ((mm(stretch.length) / 100.0).ln() / 2.0) as f32,
            (mm(stretch.length) / 500.0) as f32,
            (stretch.chord / stretch.length) as f32,
            (stretch.turn / 180.0) as f32,
        ];
        own.into_iter().chain(bend).chain(angles).chain(symmetry).chain(notches).collect()
    }

    /// True if this and a neighbour around a corner of `angle` are as long as each other, around a reflex corner.
    fn is_leg(&self, neighbour: usize, angle: f64) -> bool {
        let difference = self.stretches[self.index].length - self.stretches[neighbour].length;
        angle > DART_DEG && difference.abs() < LEGS_M && neighbour != self.index
    }
}

/// As the part is drawn. Another turn of the part swaps or negates these.
fn place(stretch: &Stretch, extent: &Extent) -> [f32; PLACE] {
    let longer = extent.size.max().max(f64::MIN_POSITIVE);
    let middle = (stretch.middle.map(mm) - extent.low - 0.5 * extent.size) * 2.0 / longer;
    [
        middle.x as f32,
        middle.y as f32,
        stretch.outward.x as f32,
        stretch.outward.y as f32,
        ((extent.size.y - extent.size.x) / longer) as f32,
    ]
}

fn said(part: &Part) -> [f32; SAID] {
    let mut numbers = [0.0; SAID];
    for (k, face) in Face::BOTH.into_iter().enumerate() {
        numbers[k] = flag(part.said.face == Some(face));
    }
    for (k, hand) in Hand::BOTH.into_iter().enumerate() {
        numbers[2 + k] = flag(part.said.hand == Some(hand));
    }
    for (k, class) in CLASSES.into_iter().enumerate() {
        numbers[4 + k] = flag(part.said.class == Some(class));
    }
    numbers
}

/// Symmetric but for the order of the two: `pair(a, b)` and `pair(b, a)` are averaged by the network.
pub fn pair(stretches: &[Stretch], symmetry: &Symmetry, i: usize, j: usize) -> [f32; PAIR] {
    let (a, b) = (&stretches[i], &stretches[j]);
    let (difference, mean) = (mm((a.length - b.length).abs()), mm(0.5 * (a.length + b.length)));
    let ratio = (a.length / b.length).ln();
    let [mirror, complement] = profile_distances(a, b);
    let near = |value: f64, scale: f64| (-value / scale).exp() as f32;
    let sums = [a.start_angle + b.end_angle - 180.0, a.end_angle + b.start_angle - 180.0];
    let is_same = a.part == b.part;
    let is_next = a.next == j;
    let is_before = b.next == i;
    let around = if is_next { a.end_angle } else { a.start_angle };
    let is_adjacent = is_same && (is_next || is_before) && i != j;
    let kinds = [symmetry.kind[a.part], symmetry.kind[b.part]];
    let [matched, marked] = notches(a, b);
    [
        near(difference, 0.3),
        near(difference, 2.0),
        near(difference, 10.0),
        near(difference / mean, 0.05),
        near(difference / mean, 0.2),
        (ratio.abs().min(2.0)) as f32,
        (ratio.clamp(-2.0, 2.0)) as f32,
        ((mean / 100.0).ln() / 2.0) as f32,
        near(mirror, 2.0),
        near(mirror, 10.0),
        near(complement, 2.0),
        near(complement, 10.0),
        ((mirror - complement) / 30.0).clamp(-2.0, 2.0) as f32,
        ((a.turn + b.turn) / 90.0).clamp(-3.0, 3.0) as f32,
        ((a.turn - b.turn).abs() / 90.0).min(3.0) as f32,
        (sums[0] / 90.0).clamp(-2.0, 2.0) as f32,
        (sums[1] / 90.0).clamp(-2.0, 2.0) as f32,
        near(sums[0].abs(), 8.0),
        near(sums[1].abs(), 8.0),
        near((a.start_angle - b.end_angle).abs(), 4.0) + near((a.end_angle - b.start_angle).abs(), 4.0),
        flag(is_same),
        flag(is_adjacent),
        flag(is_adjacent && around > DART_DEG),
        flag(is_same && !is_adjacent),
        flag(symmetry.own[i] == Some(j)),
        flag(symmetry.twin[i] == Some(j)),
        flag(symmetry.twin_part[a.part] == Some(b.part)),
        flag(!is_same && kinds[0] == kinds[1]),
        matched,
        marked,
    ]
}

/// Root mean square differences of the directions of `b`, run backwards, from those of `a`: as mirror images bend, and
/// as edges that are drawn along one line do.
fn profile_distances(a: &Stretch, b: &Stretch) -> [f64; 2] {
    let sum = |sign: f64| -> f64 {
        let differences = a.profile.iter().zip(b.profile.iter().rev()).map(|(x, y)| (x - sign * y).powi(2));
        (differences.sum::<f64>() / SAMPLES as f64).sqrt()
    };
    [sum(-1.0), sum(1.0)]
}

/// Greatest distance of matched notches. Of twenty notches nineteen lie within half a millimetre of their partner.
const MATCHED_M: f64 = 2e-3;

/// Share of the notches of both that lie as far from one end as one of the other, and their number in thirds.
fn notches(a: &Stretch, b: &Stretch) -> [f32; 2] {
    let count = a.notches.len() + b.notches.len();
    if count == 0 {
        return [0.0; 2];
    }
    let is_matched = |arc: f64, length: f64, other: &Stretch| {
        let is_near = |from_start: f64| {
            let from_end = other.length - from_start;
            (arc - from_end).abs().min((length - arc - from_start).abs()) < MATCHED_M
        };
        other.notches.iter().any(|&from_start| is_near(from_start))
    };
    let of_a = a.notches.iter().filter(|&&arc| is_matched(arc, a.length, b)).count();
    let of_b = b.notches.iter().filter(|&&arc| is_matched(arc, b.length, a)).count();
    [(of_a + of_b) as f32 / count as f32, (count.min(6) as f32) / 6.0]
}
