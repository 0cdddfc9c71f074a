//! Ease of all sizes on a subject whose dimensions are uncertain: linear about the median body, from bodies in which
//! one dimension differs.

use std::collections::BTreeMap;

use crate::chance::Question;
use body::{Body, Dimension, Likely, Measurements};
use engine::ease;
use fit::Draw;
use fit::target::{Band, Target};
use geom::units::from_mm;
use pattern::Style;
use spec::bodies;
use store::{InOrigin, Origin, Result};

/// Standard deviations from the mean of a normal distribution to an end of its 80 % interval.
const REACH: f64 = 1.281_551_565_544_6;

pub(super) struct Level {
    pub name: String,
    /// Ease that is meant; `None` without a target.
    pub band: Option<Band>,
    /// Ease on the median body.
    middle_m: f64,
    /// Derivative of the ease with respect to the logarithm of each dimension, m, in the order of
    /// the bench's `dimensions`.
    slopes: Vec<f64>,
    /// Index of the part of the garment to which the level belongs.
    part: usize,
    /// Standard deviation of the garment's length at the level.
    made_m: f64,
}

pub(super) struct Sized {
    pub size: String,
    pub levels: Vec<Level>,
}

impl Sized {
    pub fn bands(&self) -> Vec<Option<Band>> {
        self.levels.iter().map(|level| level.band).collect()
    }

    /// Draws how far a made garment is off its pattern at each level. Levels of the same part share one draw.
    pub fn made_m(&self, draw: &mut Draw) -> Vec<f64> {
        let made: [f64; PARTS] = std::array::from_fn(|_| draw.normal());
        self.levels.iter().map(|level| level.made_m * made[level.part]).collect()
    }
}

pub(super) struct Bench {
    pub readings: Measurements,
    pub sizes: Vec<Sized>,
    likely: Likely,
    middle: Measurements,
    error_factor: f64,
    /// Dimensions that are not known exactly.
    dimensions: Vec<Dimension>,
}

/// Ease by level, m.
type Eases = Vec<(String, f64)>;

/// Number of parts of a garment that err independently: trunk, sleeves, legs, shoulders, neck.
const PARTS: usize = 5;

/// Part that a level belongs to, and the standard deviation of its length divided by the tolerance of half a girth. One
/// of twenty garments lies outside its tolerance, which is therefore two deviations. The tolerance of a girth is twice
/// that of its half, and that of sleeves and legs three quarters of the trunk's, as makers allow [Proper Cloth].
fn part(level: &str) -> (usize, f64) {
    match level {
        "across_shoulder" => (3, 0.5),
        "neck" => (4, 0.5),
        "upper_arm" | "forearm" | "wrist" => (1, 0.75),
        "thigh" | "knee" => (2, 0.75),
        _ => (0, 1.0),
    }
}

impl Bench {
    /// On a scan the tape reads more.
    pub fn new(
        styles: &[(String, Style)],
        target: &Target,
        measurements: &Measurements,
        scanned: Option<&Body>,
        question: &Question,
    ) -> Result<Self> {
        let readings = scanned.map_or_else(|| measurements.clone(), |body| read_on(body, measurements));
        let error_factor = question.error_factor;
        let error = |dimension: Dimension| error_factor * dimension.reading_error();
        let likely = Likely::of(&readings, error).origin(Origin::Body)?;
        let middle = likely.median();
        let is_open = |dimension: &Dimension| likely.spread(*dimension) > 1e-6;
        let dimensions: Vec<Dimension> = Dimension::ALL.into_iter().filter(is_open).collect();
        let mut bench = Self { readings, sizes: Vec::new(), likely, middle, error_factor, dimensions };
        let built = bodies::build_body(&bench.middle)?;
        let moved: Vec<[Option<Body>; 2]> = bench.dimensions.iter().map(|dimension| bench.moved(*dimension)).collect();
        let tolerance_m = from_mm(question.tolerance_mm);
        let size = |(size, style): &(String, Style)| Sized {
            size: size.clone(),
            levels: bench.levels(style, target, &built, &moved, scanned, tolerance_m),
        };
        bench.sizes = styles.iter().map(size).collect();
        Ok(bench)
    }

    /// Standard deviation of the error of a reading, m or kg.
    pub fn error(&self, dimension: Dimension) -> f64 {
        self.error_factor * dimension.reading_error()
    }

    /// Ends of the 80 % interval of a dimension, with its median between them, m or kg.
    pub fn likely_at(&self, dimension: Dimension) -> Option<[f64; 3]> {
        let (middle, spread) = (self.middle.get(dimension)?, self.likely.spread(dimension));
        Some([-REACH, 0.0, REACH].map(|score| middle * (score * spread).exp()))
    }

    /// Draws a person whom the subject may be.
    pub fn person(&self, draw: &mut Draw) -> Measurements {
        self.likely.person(&std::array::from_fn(|_| draw.normal()))
    }

    /// Draws the ease of a size at every level on a person, with the errors of a made garment.
    pub fn eases_m(&self, size: &Sized, person: &Measurements, draw: &mut Draw) -> Vec<f64> {
        let off = self.off(&self.middle, person);
        size.levels.iter().zip(size.made_m(draw)).map(|(level, made_m)| level.on(&off) + made_m).collect()
    }

    /// Differences between two people in the logarithms of the uncertain dimensions; 0 for a dimension that either
    /// lacks.
    fn off(&self, from: &Measurements, to: &Measurements) -> Vec<f64> {
        let difference = |dimension: &Dimension| Some((to.get(*dimension)? / from.get(*dimension)?).ln());
        self.dimensions.iter().map(|dimension| difference(dimension).unwrap_or(0.0)).collect()
    }

    /// Median body with a dimension one standard deviation less, and more; `None` where no such body can be built.
    fn moved(&self, dimension: Dimension) -> [Option<Body>; 2] {
        [-1.0, 1.0].map(|side| {
            let value = self.middle.get(dimension).map(|value| value * (side * self.likely.spread(dimension)).exp());
            bodies::build_body(&self.middle.clone().with(dimension, value)).ok()
        })
    }

    /// Levels on the median body. For a scan they are corrected by the ease on the scan.
    fn levels(
        &self,
        style: &Style,
        target: &Target,
        built: &Body,
        moved: &[[Option<Body>; 2]],
        scanned: Option<&Body>,
        tolerance_m: f64,
    ) -> Vec<Level> {
        let ease_at = |eases: &Eases, level: &str| eases.iter().find(|(name, _)| name == level).map(|(_, m)| *m);
        let bodies = [Some(built), scanned].into_iter().chain(moved.iter().flatten().map(Option::as_ref));
        let all: Vec<&Body> = bodies.clone().flatten().collect();
        let found = ease::on_all(style, &all);
        let held: BTreeMap<String, bool> =
            found.iter().flatten().map(|ease| (ease.level.clone(), ease.is_held)).rev().collect();
        let mut found = found.into_iter();
        let next = |body: Option<&Body>| -> Option<Eases> {
            let eases = body.and_then(|_| found.next())?;
            Some(eases.into_iter().map(|ease| (ease.level.clone(), ease.ease_m())).collect())
        };
        let mut eases = bodies.map(next);
        let middle = eases.next().flatten().unwrap_or_default();
        let own = eases.next().flatten();
        let moved: Vec<[Option<Eases>; 2]> =
            (0..moved.len()).map(|_| [eases.next().flatten(), eases.next().flatten()]).collect();
        let slope = |level: &str, here: f64, (dimension, [less, more]): (&Dimension, &[Option<Eases>; 2])| {
            let [less, more] = [less, more].map(|eases| eases.as_ref().and_then(|eases| ease_at(eases, level)));
            let sides = f64::from(u8::from(less.is_some()) + u8::from(more.is_some()));
            let change = more.unwrap_or(here) - less.unwrap_or(here);
            if sides > 0.0 { change / (sides * self.likely.spread(*dimension)) } else { 0.0 }
        };
        let is_top = middle.iter().any(|(level, _)| level == "chest" || level == "bust");
        let level = |(name, here): &(String, f64)| {
            let (part, share) = part(name);
            let slopes = self.dimensions.iter().zip(&moved).map(|moved| slope(name, *here, moved)).collect();
            let found = Level {
                name: name.clone(),
                band: target.band(name, is_top, held.get(name).copied().unwrap_or(true)),
                middle_m: *here,
                slopes,
                part,
                made_m: share * tolerance_m,
            };
            // A scan has its own shape. So the ease measured on it replaces that of the model, shifted to the median
            // person.
            let own = own.as_ref().and_then(|eases| ease_at(eases, name));
            let middle_m = own.map_or(*here, |own| own + found.on(&self.off(&self.readings, &self.middle)) - *here);
            Level { middle_m, ..found }
        };
        middle.iter().map(level).collect()
    }
}

impl Level {
    /// Ease on a person with these differences from the median body, m.
    fn on(&self, off: &[f64]) -> f64 {
        self.middle_m + self.slopes.iter().zip(off).map(|(slope, off)| slope * off).sum::<f64>()
    }
}

fn read_on(body: &Body, measurements: &Measurements) -> Measurements {
    let mut read = measurements.clone();
    for dimension in Dimension::ALL {
        read.set(dimension, body.girths.get(dimension).or_else(|| measurements.get(dimension)));
    }
    read
}
