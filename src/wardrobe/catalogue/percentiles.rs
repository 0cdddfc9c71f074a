//! Percentiles of measurements among adults of the same sex, and doubts about rare ones.

use body::{self, Dimension, Measurements, Sex};

/// Percentiles between which a measurement is not doubted.
const ORDINARY: (f64, f64) = (1.0, 99.0);

/// Percentile, 0 to 100, of a value among adults of a sex [Gordon 2014]. The value is in the unit of its key; `None`
/// for a key that is no measurement of a subject.
pub fn percentile(sex: Sex, key: &str, value: f64) -> Option<f64> {
    let dimension = Dimension::ALL.into_iter().find(|dimension| dimension.key() == key)?;
    Some(body::percentile(sex, dimension, value / dimension.per_si(), None, None))
}

pub fn is_doubtful(percentile: f64) -> bool {
    !(ORDINARY.0..=ORDINARY.1).contains(&percentile)
}

/// A percentile in at most four characters: `P63`, `<P1`, `>P99`.
pub fn percentile_text(percentile: f64) -> String {
    if percentile < ORDINARY.0 {
        "<P1".to_owned()
    } else if percentile > ORDINARY.1 {
        ">P99".to_owned()
    } else {
        format!("P{percentile:.0}")
    }
}

pub fn doubts(subject: &Measurements) -> Vec<String> {
    body::plausibility(subject).iter().map(ToString::to_string).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let ordinary = Measurements::of(Sex::Female, 1.63).with(Dimension::Weight, 60.0);
        assert_eq!(doubts(&ordinary), [""; 0]);
        let rare = ordinary.with(Dimension::ChestGirth, 1.5);
        let told = doubts(&rare);
        assert_eq!(told.len(), 1);
        assert!(told[0].starts_with("chest_girth_mm = 1500 is doubtful"), "{told:?}");
        assert_eq!([0.3, 63.2, 99.7].map(percentile_text), ["<P1", "P63", ">P99"]);
    }
}
