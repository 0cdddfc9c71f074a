//! All dimensions of a figure from the measured ones, and a check of their consistency.

use super::dimension::{COUNT, Dimension};
use super::survey::{Expected, Survey};
use crate::{BodyError, Measurements, Sex};

/// Standard deviations from the conditional expectation beyond which girths and lengths are refused. Judgement.
const IMPOSSIBLE_GIRTH: f64 = 8.0;
const IMPOSSIBLE_LENGTH: f64 = 5.0;

/// Two-sided 99 % quantile of the normal distribution, beyond which a measurement is doubtful: one person in a hundred.
const DOUBTFUL: f64 = 2.576;

/// All dimensions of a figure in SI units: measured if known, otherwise estimated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Profile {
    pub sex: Sex,
    values: [f64; COUNT],
    given: [bool; COUNT],
}

impl Profile {
    /// Estimates missing measurements as the median of the people of the survey who share all that is known.
    pub fn new(known: &Measurements) -> Result<Self, BodyError> {
        check_ranges(known)?;
        check_pairs(known)?;
        let measured: Vec<(Dimension, f64)> = known.known().collect();
        let every: Vec<Dimension> = Dimension::ALL.into_iter().chain([Dimension::ShoulderBreadth]).collect();
        let expected = Survey::of(known.sex).expect(&every, &measured);
        let mut profile = Self { sex: known.sex, values: [0.0; COUNT], given: [false; COUNT] };
        for (dimension, expected) in every.into_iter().zip(expected) {
            profile.values[dimension as usize] = known.get(dimension).unwrap_or(expected.median());
            profile.given[dimension as usize] = known.get(dimension).is_some();
        }
        Ok(profile)
    }

    pub fn at(&self, dimension: Dimension) -> f64 {
        self.values[dimension as usize]
    }

    /// Adds an amount to an estimate, m, and holds it as if it were measured.
    pub fn depart(&mut self, dimension: Dimension, amount: f64) {
        self.values[dimension as usize] += amount;
        self.given[dimension as usize] = true;
    }

    pub fn is_given(&self, dimension: Dimension) -> bool {
        self.given[dimension as usize]
    }
}

fn check_ranges(known: &Measurements) -> Result<(), BodyError> {
    let outside = |&(dimension, value): &(Dimension, f64)| {
        let [least, greatest] = dimension.range();
        !(least..=greatest).contains(&value)
    };
    let Some((dimension, value)) = known.known().find(outside) else { return Ok(()) };
    let [least, greatest] = dimension.range().map(|bound| bound * dimension.per_si());
    let (name, unit) = (dimension.key(), dimension.unit());
    Err(BodyError::OutOfRange { name, value: value * dimension.per_si(), least, greatest, unit })
}

struct Misfit {
    /// Deviation from the expectation, divided by the accepted deviation.
    excess: f64,
    dimension: Dimension,
    partner: Dimension,
    expected: Expected,
}

fn check_pairs(known: &Measurements) -> Result<(), BodyError> {
    let survey = Survey::of(known.sex);
    let stature = (Dimension::Stature, known.stature_m());
    let others: Vec<(Dimension, f64)> = known.known().filter(|(dimension, _)| *dimension != stature.0).collect();
    let mut worst: Option<Misfit> = None;
    for &(dimension, value) in &others {
        for &partner in std::iter::once(&stature).chain(others.iter().filter(|other| other.0 != dimension)) {
            let given = if partner == stature { vec![stature] } else { vec![stature, partner] };
            let expected = survey.expect(&[dimension], &given)[0];
            let excess = expected.score(value).abs() / limit(dimension);
            if excess > worst.as_ref().map_or(1.0, |worst| worst.excess) {
                worst = Some(Misfit { excess, dimension, partner: partner.0, expected });
            }
        }
    }
    let Some(Misfit { dimension, partner, expected, .. }) = worst else { return Ok(()) };
    let shown = |dimension: Dimension, value: f64| {
        format!("{} {:.0} {}", dimension.name(), value * dimension.per_si(), dimension.unit())
    };
    let told = |dimension: Dimension| shown(dimension, known.get(dimension).unwrap_or_default());
    let [least, greatest] = [-1.0, 1.0].map(|side| expected.at(side * limit(dimension)) * dimension.per_si());
    let with = if partner == Dimension::Stature {
        told(partner)
    } else {
        format!("{} at {}", told(partner), told(Dimension::Stature))
    };
    Err(BodyError::Contradiction { found: told(dimension), with, least, greatest, unit: dimension.unit() })
}

/// Deviation beyond which a dimension is refused, in standard deviations.
fn limit(dimension: Dimension) -> f64 {
    match dimension {
        Dimension::Inseam | Dimension::ArmLength | Dimension::FootLength | Dimension::AcrossShoulder => {
            IMPOSSIBLE_LENGTH
        }
        _ => IMPOSSIBLE_GIRTH,
    }
}

/// Measurement that few people have.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Doubt {
    pub measurement: &'static str,
    /// Given value, mm or kg.
    pub value: f64,
    /// Percentile among all adults of the sex.
    pub percentile: f64,
    /// Percentile among people of the same stature and, if known, weight.
    pub percentile_alike: f64,
    /// Range that contains 98 % of these people, mm or kg.
    pub usual: [f64; 2],
}

impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { measurement, value, percentile, percentile_alike, usual: [least, greatest] } = self;
        write!(
            f,
            "{measurement} = {value:.0} is doubtful: percentile {percentile:.1} of the sex, {percentile_alike:.1} of those \
             with this stature and weight, of whom 98 % have {least:.0} to {greatest:.0}"
        )
    }
}

/// Possible measurements that fewer than one in a hundred people of the same stature and weight have.
pub fn plausibility(known: &Measurements) -> Vec<Doubt> {
    let finite = known.known().all(|(_, value)| value.is_finite() && value > 0.0);
    if !finite {
        return Vec::new();
    }
    let doubt = |(dimension, value): (Dimension, f64)| {
        let expected = alike(known.sex, dimension, Some(known.stature_m()), known.get(Dimension::Weight));
        let score = expected.score(value);
        (score.abs() > DOUBTFUL).then(|| Doubt {
            measurement: dimension.key(),
            value: value * dimension.per_si(),
            percentile: percentile(known.sex, dimension, value, None, None),
            percentile_alike: 100.0 * share_below(score),
            usual: [-2.326, 2.326].map(|score| expected.at(score) * dimension.per_si()),
        })
    };
    known.known().filter_map(doubt).collect()
}

/// Mean density of a body with half-filled lungs, kg/l.
const DENSITY: f64 = 1.01;

/// Greatest relative difference between weight and mass from volume that is not reported. Judgement.
const UNEXPLAINED: f64 = 0.10;

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Mass {
    /// Volume times 1.01 kg/l.
    pub mass_from_volume_kg: f64,
    pub weight_asked_kg: Option<f64>,
    /// Difference between mass and weight, relative to the requested weight.
    pub mass_off_percent: Option<f64>,
}

impl Mass {
    pub fn of(volume_l: f64, weight_kg: Option<f64>) -> Self {
        let mass = DENSITY * volume_l;
        let off = weight_kg.map(|weight| 100.0 * (mass / weight - 1.0));
        Self { mass_from_volume_kg: mass, weight_asked_kg: weight_kg, mass_off_percent: off }
    }
}

impl std::fmt::Display for Mass {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "volume x {DENSITY} kg/l: {:.1} kg", self.mass_from_volume_kg)?;
        let (Some(weight), Some(off)) = (self.weight_asked_kg, self.mass_off_percent) else { return Ok(()) };
        write!(f, ", {off:+.0} % from the weight of {weight:.1} kg")?;
        if off.abs() > 100.0 * UNEXPLAINED {
            let than = if off > 0.0 { "larger" } else { "smaller" };
            write!(
                f,
                ": the girths asked are {than} than people of this stature and weight have; they are kept, the weight is not"
            )?;
        }
        Ok(())
    }
}

/// Percentile (0 to 100) of a value (m or kg) among the adults of a sex [Gordon 2014], of the given stature (m) and
/// weight (kg). `None` for any stature or weight.
pub fn percentile(sex: Sex, dimension: Dimension, value: f64, stature_m: Option<f64>, weight_kg: Option<f64>) -> f64 {
    100.0 * share_below(alike(sex, dimension, stature_m, weight_kg).score(value))
}

fn alike(sex: Sex, dimension: Dimension, stature_m: Option<f64>, weight_kg: Option<f64>) -> Expected {
    let given: Vec<(Dimension, f64)> = [(Dimension::Stature, stature_m), (Dimension::Weight, weight_kg)]
        .into_iter()
        .filter(|(known, _)| *known != dimension && dimension != Dimension::Stature)
        .filter_map(|(known, value)| value.map(|value| (known, value)))
        .collect();
    Survey::of(sex).expect(&[dimension], &given)[0]
}

/// Standard normal distribution function [Abramowitz & Stegun 7.1.26], error below 1e-7.
fn share_below(score: f64) -> f64 {
    let x = score.abs() / std::f64::consts::SQRT_2;
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let series =
        ((((1.061_405_429 * t - 1.453_152_027) * t + 1.421_413_741) * t - 0.284_496_736) * t + 0.254_829_592) * t;
    let tail = series * (-x * x).exp() / 2.0;
    if score > 0.0 { 1.0 - tail } else { tail }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_soldier_is_found_again() {
        let check = |sex, stature_m, weight_kg, chest: f64, hip: f64| {
            let known = Measurements::of(sex, stature_m).with(Dimension::Weight, weight_kg);
            let profile = Profile::new(&known).expect("an ordinary person");
            let [found_chest, found_hip] = [Dimension::ChestGirth, Dimension::HipGirth].map(|d| profile.at(d));
            assert!((found_chest - chest).abs() < 5e-3, "{sex:?} chest {found_chest}");
            assert!((found_hip - hip).abs() < 5e-3, "{sex:?} hip {found_hip}");
        };
        check(Sex::Male, 1.7562, 85.5, 1.0587, 1.0195);
        check(Sex::Female, 1.6285, 67.8, 0.947, 1.0215);
    }

    #[test]
    fn what_is_given_stays_and_moves_the_rest() {
        let plain = Measurements::of(Sex::Male, 1.75).with(Dimension::Weight, 80.0);
        let given = plain.clone().with(Dimension::ThighGirth, 0.66).with(Dimension::Inseam, 0.88);
        let [plain, given] = [plain, given].map(|known| Profile::new(&known).expect("a person"));
        assert_eq!((given.at(Dimension::ThighGirth), given.at(Dimension::Inseam)), (0.66, 0.88));
        assert!(given.at(Dimension::KneeGirth) > plain.at(Dimension::KneeGirth) + 5e-3);
        assert!(given.at(Dimension::ArmLength) > plain.at(Dimension::ArmLength) + 5e-3);
    }

    #[test]
    fn impossible_people_are_refused_by_name() {
        let refused = |known: &Measurements, words: &[&str]| {
            let error = Profile::new(known).expect_err("no such person").to_string();
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        };
        let person = Measurements::of(Sex::Male, 1.7);
        refused(&person.clone().with(Dimension::WaistGirth, 89.0), &["waist_girth_mm", "89000", "1700"]);
        refused(&Measurements::of(Sex::Female, f64::NAN), &["stature"]);
        refused(&Measurements::of(Sex::Female, 0.0), &["stature", "1300"]);
        let odd = person.clone().with(Dimension::WaistGirth, 0.58).with(Dimension::HipGirth, 1.5);
        refused(&odd, &["waist girth 580 mm", "hip girth 1500 mm", "stature 1700 mm"]);
        let long_legs = person.with(Dimension::Inseam, 1.05);
        refused(&long_legs, &["inseam 1050 mm", "stature 1700 mm"]);
    }

    #[test]
    fn doubts_name_their_percentile() {
        let ordinary =
            Measurements::of(Sex::Male, 1.75).with(Dimension::Weight, 70.0).with(Dimension::WaistGirth, 0.84);
        assert_eq!(plausibility(&ordinary), []);
        let odd = ordinary.with(Dimension::NeckGirth, 0.46);
        let doubts = plausibility(&odd);
        assert_eq!(doubts.len(), 1);
        assert_eq!(doubts[0].measurement, "neck_girth_mm");
        assert!(doubts[0].percentile > 95.0 && doubts[0].percentile_alike > 99.5, "{}", doubts[0]);
        let of_stature = |stature_m: f64| {
            plausibility(&Measurements::of(Sex::Male, stature_m).with(Dimension::NeckGirth, 0.49)).swap_remove(0)
        };
        let [short, tall] = [1.65, 1.85].map(of_stature);
        assert_eq!(short.percentile, tall.percentile, "that among all of the sex");
        assert!(short.percentile_alike > tall.percentile_alike, "{short}, {tall}");
        let median = percentile(Sex::Male, Dimension::Stature, 0.5624_f64.exp(), None, None);
        assert!((median - 50.0).abs() < 1e-3, "{median}");
        let tall = percentile(Sex::Female, Dimension::Stature, (0.4869 + 1.6449 * 0.0394_f64).exp(), Some(1.6), None);
        assert!((tall - 95.0).abs() < 0.01, "{tall}");
    }
}
