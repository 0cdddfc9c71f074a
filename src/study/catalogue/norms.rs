//! Where a measurement stands among adults of the same sex, and which are so rare that they may be mistakes.

use super::fields::MEASUREMENTS;
use crate::body::{Measurements, Sex};

/// Percentiles below the first and above the second of these are doubted.
const ORDINARY: (f64, f64) = (1.0, 99.0);

/// Mean and standard deviation of a measurement over men and over women, in the unit of its key: 4,082 men and 1,986
/// women of the 2012 Anthropometric Survey of U.S. Army Personnel [Gordon 2014]. The survey's waist is at the navel: here
/// times 0.997 (men) and 0.968 (women), the ISO 8559-1 waist over it. The width across the shoulders is its biacromial
/// breadth times 1.066 and 1.115, the tape over it.
const NORMS: [(&str, [(f64, f64); 2]); 7] = [
    ("stature_mm", [(1756.2, 68.6), (1628.5, 64.2)]),
    ("weight_kg", [(85.5, 14.2), (67.8, 11.0)]),
    ("chest_girth_mm", [(1058.7, 87.4), (946.9, 82.7)]),
    ("waist_girth_mm", [(937.8, 111.4), (833.4, 96.7)]),
    ("hip_girth_mm", [(1019.5, 76.7), (1021.2, 75.9)]),
    ("neck_girth_mm", [(397.6, 25.8), (329.8, 19.2)]),
    ("across_shoulder_mm", [(443.1, 20.5), (407.3, 20.4)]),
];

/// The percentile of a value among adults of a sex, 0 to 100, were it spread normally; `None` for measurements the
/// survey does not have.
#[must_use]
pub fn percentile(sex: Sex, key: &str, value: f64) -> Option<f64> {
    let (_, norms) = NORMS.iter().find(|(name, _)| *name == key)?;
    let (mean, deviation) = norms[usize::from(sex == Sex::Female)];
    Some(100.0 * normal_below((value - mean) / deviation))
}

/// Share of a normal distribution below `z` standard deviations: Abramowitz and Stegun 26.2.17, error below 1e-7.
fn normal_below(z: f64) -> f64 {
    const TERMS: [f64; 5] = [0.319_381_530, -0.356_563_782, 1.781_477_937, -1.821_255_978, 1.330_274_429];
    let t = 1.0 / (1.0 + 0.231_641_9 * z.abs());
    let series = TERMS.iter().rev().fold(0.0, |sum, term| (sum + term) * t);
    let above = (-z * z / 2.0).exp() / (2.0 * std::f64::consts::PI).sqrt() * series;
    if z < 0.0 { above } else { 1.0 - above }
}

/// Whether a percentile is so rare that the value may be a mistake.
#[must_use]
pub fn is_doubtful(percentile: f64) -> bool {
    !(ORDINARY.0..=ORDINARY.1).contains(&percentile)
}

/// A percentile in at most four characters: `P63`, `<P1`, `>P99`.
#[must_use]
pub fn percentile_text(percentile: f64) -> String {
    if percentile < ORDINARY.0 {
        "<P1".to_owned()
    } else if percentile > ORDINARY.1 {
        ">P99".to_owned()
    } else {
        format!("P{percentile:.0}")
    }
}

/// The measurements of a subject that are possible but rare, each with its percentile.
#[must_use]
pub fn doubts(subject: &Measurements) -> Vec<String> {
    let people = if subject.sex == Sex::Female { "women" } else { "men" };
    let doubt = |key: &str, value: f64| {
        let percentile = percentile(subject.sex, key, value).filter(|percentile| is_doubtful(*percentile))?;
        let which = if percentile < ORDINARY.0 { "less" } else { "more" };
        Some(format!("{key} {value} is doubtful: less than 1 % of {people} have {which}"))
    };
    MEASUREMENTS.iter().filter_map(|field| doubt(field.key, field.get(subject)?)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::fields::Entry;
    use super::*;

    #[test]
    fn percentiles_are_those_of_a_normal_distribution() {
        let check = |z: f64, share: f64| assert!((normal_below(z) - share).abs() < 1e-6, "{z}: {}", normal_below(z));
        check(0.0, 0.5);
        check(1.0, 0.841_344_7);
        check(-1.0, 0.158_655_3);
        check(-2.326_347_9, 0.01);
        check(6.0, 1.0);
    }

    /// The survey's own 5th and 95th percentiles of stature and of the men's weight.
    #[test]
    fn the_survey_is_found_again() {
        let check = |sex, key, value, expected: f64| {
            let found = percentile(sex, key, value).expect("in the survey");
            assert!((found - expected).abs() < 1.6, "{key} {value}: {found}");
        };
        check(Sex::Male, "stature_mm", 1648.0, 5.0);
        check(Sex::Male, "stature_mm", 1870.0, 95.0);
        check(Sex::Female, "stature_mm", 1525.0, 5.0);
        check(Sex::Female, "stature_mm", 1740.0, 95.0);
        check(Sex::Male, "weight_kg", 110.7, 95.0);
        assert_eq!(percentile(Sex::Male, "shoe_size", 43.0), None);
    }

    #[test]
    fn the_rare_is_doubted_and_the_ordinary_is_not() {
        let ordinary = Measurements { stature_m: 1.63, weight_kg: Some(60.0), ..Measurements::blank("") };
        assert_eq!(doubts(&ordinary), [""; 0]);
        let rare = Measurements { stature_m: 1.35, chest_girth_m: Some(1.5), ..ordinary };
        let told = doubts(&rare);
        assert_eq!(told[0], "stature_mm 1350 is doubtful: less than 1 % of women have less");
        assert_eq!(told[1], "chest_girth_mm 1500 is doubtful: less than 1 % of women have more");
        assert_eq!(told.len(), 2);
        assert_eq!([0.3, 63.2, 99.7].map(percentile_text), ["<P1", "P63", ">P99"]);
    }

    #[test]
    fn every_measurement_has_its_norm() {
        for field in &MEASUREMENTS {
            assert!(percentile(Sex::Female, field.key, 1.0).is_some(), "{}", field.key);
        }
    }
}
