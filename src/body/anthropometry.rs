//! Filling in what was not measured: linear equations from the ANSUR II survey.
//!
//! Coefficients: least squares over 4,082 men and 1,986 women of the 2012 Anthropometric Survey of U.S. Army Personnel
//! [Gordon 2014], dimension in millimetres from stature in millimetres and mass in kilograms.

use std::ops::RangeInclusive;

use super::{BodyError, Measurements, Sex};
use crate::units::from_mm;

/// Accepted range of each measurement, SI units: name, least, greatest, and unit. Wider than any adult of the survey.
const RANGES: [(&str, f64, f64, &str); 7] = [
    ("stature_m", 1.30, 2.20, "m"),
    ("weight_kg", 30.0, 200.0, "kg"),
    ("chest_girth_m", 0.60, 1.60, "m"),
    ("waist_girth_m", 0.45, 1.60, "m"),
    ("hip_girth_m", 0.65, 1.70, "m"),
    ("neck_girth_m", 0.25, 0.55, "m"),
    ("across_shoulder_m", 0.30, 0.56, "m"),
];

/// The values of a measurement, named by its field of [`Measurements`] and in its unit, that a body can be built with.
#[must_use]
pub fn accepted_range(name: &str) -> Option<RangeInclusive<f64>> {
    RANGES.iter().find(|(known, ..)| *known == name).map(|(_, least, greatest, _)| *least..=*greatest)
}

/// A dimension as `constant + per_stature * stature + per_mass * mass` (mm, mm, kg).
#[derive(Clone, Copy, Debug)]
struct Line {
    constant: f64,
    per_stature: f64,
    per_mass: f64,
}

impl Line {
    const fn new(constant: f64, per_stature: f64, per_mass: f64) -> Self {
        Self { constant, per_stature, per_mass }
    }

    /// The dimension in metres.
    fn at(self, stature_m: f64, weight_kg: f64) -> f64 {
        from_mm(self.constant + self.per_stature * stature_m * 1e3 + self.per_mass * weight_kg)
    }

    /// The mass in kilograms at which the dimension is `value_m`.
    fn mass_for(self, value_m: f64, stature_m: f64) -> f64 {
        (value_m * 1e3 - self.constant - self.per_stature * stature_m * 1e3) / self.per_mass
    }
}

/// The equations of one sex.
struct Equations {
    /// Mean body mass index of the survey, kg/m^2.
    mass_index: f64,
    neck: Line,
    chest: Line,
    /// At the navel.
    waist: Line,
    hip: Line,
    biacromial: Line,
    bideltoid: Line,
    thigh: Line,
    lower_thigh: Line,
    calf: Line,
    ankle: Line,
    upper_arm_flexed: Line,
    forearm_flexed: Line,
    wrist: Line,
    foot_length: Line,
    /// Girth at the ISO 8559-1 waist over that at the navel: mean of three reference bodies.
    iso_waist_over_navel: f64,
    /// Tape over the back neck point over the straight distance of the shoulder points: mean of three bodies.
    tape_over_biacromial: f64,
}

const MALE: Equations = Equations {
    mass_index: 27.7,
    neck: Line::new(407.756, -0.08508, 1.62899),
    chest: Line::new(1036.434, -0.29094, 6.23488),
    waist: Line::new(1024.906, -0.43577, 7.96237),
    hip: Line::new(808.411, -0.14014, 5.34620),
    biacromial: Line::new(204.589, 0.09168, 0.58554),
    bideltoid: Line::new(433.461, -0.06100, 2.15262),
    thigh: Line::new(594.745, -0.18359, 4.12538),
    lower_thigh: Line::new(344.19, -0.06576, 2.11154),
    calf: Line::new(350.962, -0.06845, 1.88843),
    ankle: Line::new(153.091, 0.00791, 0.72914),
    upper_arm_flexed: Line::new(380.299, -0.12234, 2.25309),
    forearm_flexed: Line::new(252.737, -0.03150, 1.31715),
    wrist: Line::new(97.5, 0.02525, 0.39840),
    foot_length: Line::new(44.931, 0.12038, 0.17345),
    iso_waist_over_navel: 0.997,
    tape_over_biacromial: 1.066,
};

const FEMALE: Equations = Equations {
    mass_index: 25.5,
    neck: Line::new(305.816, -0.04685, 1.47991),
    chest: Line::new(990.341, -0.32916, 7.26921),
    waist: Line::new(1014.124, -0.47172, 9.07584),
    hip: Line::new(846.892, -0.17841, 6.86093),
    biacromial: Line::new(131.989, 0.12829, 0.36067),
    bideltoid: Line::new(386.785, -0.06265, 2.44346),
    thigh: Line::new(584.014, -0.19423, 5.14231),
    lower_thigh: Line::new(350.163, -0.09112, 2.93581),
    calf: Line::new(305.854, -0.05141, 2.23044),
    ankle: Line::new(139.867, 0.01407, 0.78151),
    upper_arm_flexed: Line::new(341.408, -0.13988, 2.83313),
    forearm_flexed: Line::new(215.883, -0.03185, 1.47675),
    wrist: Line::new(80.862, 0.02795, 0.41945),
    foot_length: Line::new(37.855, 0.11804, 0.23932),
    iso_waist_over_navel: 0.968,
    tape_over_biacromial: 1.115,
};

/// Relaxed over flexed girth of the upper arm and of the forearm.
const RELAXED: [f64; 2] = [0.92, 0.95];

/// Change of the breadth over the upper arms with that of the shoulder points (coefficient of the survey's equations with
/// girths as further predictors, mean of both sexes).
const DELTOID_PER_ACROMION: f64 = 0.55;

/// Girth at the middle of the knee over the survey's lower thigh girth just above it.
const KNEE_OVER_LOWER_THIGH: f64 = 0.93;

/// Every dimension the figure is made from, metres: measured where known, estimated elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Profile {
    pub sex: Sex,
    pub stature: f64,
    pub neck: f64,
    pub chest: f64,
    pub waist: f64,
    pub hip: f64,
    pub across_shoulder: f64,
    /// Straight distance of the shoulder points that the tape length suggests.
    pub biacromial: f64,
    /// Breadth over the upper arms at the shoulders.
    pub bideltoid: f64,
    pub thigh: f64,
    pub knee: f64,
    pub calf: f64,
    pub ankle: f64,
    pub upper_arm: f64,
    pub forearm: f64,
    pub wrist: f64,
    pub foot_length: f64,
}

impl Profile {
    /// Checks the measurements and fills in the missing ones.
    ///
    /// # Errors
    /// [`BodyError::OutOfRange`] names the first measurement that no adult has.
    pub fn new(known: &Measurements) -> Result<Self, BodyError> {
        check_ranges(known)?;
        let equations = equations(known.sex);
        let stature = known.stature_m;
        let mass = known.weight_kg.unwrap_or_else(|| equations.mass(known));
        let estimate = |line: Line| line.at(stature, mass);
        let across_shoulder =
            known.across_shoulder_m.unwrap_or_else(|| estimate(equations.biacromial) * equations.tape_over_biacromial);
        let biacromial = across_shoulder / equations.tape_over_biacromial;
        let bideltoid =
            estimate(equations.bideltoid) + DELTOID_PER_ACROMION * (biacromial - estimate(equations.biacromial));
        Ok(Self {
            sex: known.sex,
            stature,
            neck: known.neck_girth_m.unwrap_or_else(|| estimate(equations.neck)),
            chest: known.chest_girth_m.unwrap_or_else(|| estimate(equations.chest)),
            waist: known.waist_girth_m.unwrap_or_else(|| estimate(equations.waist) * equations.iso_waist_over_navel),
            hip: known.hip_girth_m.unwrap_or_else(|| estimate(equations.hip)),
            across_shoulder,
            biacromial,
            bideltoid,
            thigh: estimate(equations.thigh),
            knee: estimate(equations.lower_thigh) * KNEE_OVER_LOWER_THIGH,
            calf: estimate(equations.calf),
            ankle: estimate(equations.ankle),
            upper_arm: estimate(equations.upper_arm_flexed) * RELAXED[0],
            forearm: estimate(equations.forearm_flexed) * RELAXED[1],
            wrist: estimate(equations.wrist),
            foot_length: estimate(equations.foot_length),
        })
    }
}

impl Equations {
    /// Mass in kilograms that the known girths suggest (the mean over them), or the survey's mean at this stature.
    fn mass(&self, known: &Measurements) -> f64 {
        let girths = [
            (known.chest_girth_m, self.chest),
            (known.waist_girth_m.map(|girth| girth / self.iso_waist_over_navel), self.waist),
            (known.hip_girth_m, self.hip),
        ];
        let guesses: Vec<f64> =
            girths.iter().filter_map(|&(girth, line)| girth.map(|g| line.mass_for(g, known.stature_m))).collect();
        let (_, least, greatest, _) = RANGES[1];
        if guesses.is_empty() {
            return (self.mass_index * known.stature_m * known.stature_m).clamp(least, greatest);
        }
        (guesses.iter().sum::<f64>() / guesses.len() as f64).clamp(least, greatest)
    }
}

fn equations(sex: Sex) -> &'static Equations {
    match sex {
        Sex::Male => &MALE,
        Sex::Female => &FEMALE,
    }
}

fn check_ranges(known: &Measurements) -> Result<(), BodyError> {
    let values = [
        Some(known.stature_m),
        known.weight_kg,
        known.chest_girth_m,
        known.waist_girth_m,
        known.hip_girth_m,
        known.neck_girth_m,
        known.across_shoulder_m,
    ];
    for (value, (name, least, greatest, unit)) in values.into_iter().zip(RANGES) {
        if let Some(value) = value.filter(|value| !(least..=greatest).contains(value)) {
            return Err(BodyError::OutOfRange { name, value, least, greatest, unit });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn only_stature(sex: Sex, stature_m: f64) -> Measurements {
        Measurements {
            sex,
            stature_m,
            weight_kg: None,
            chest_girth_m: None,
            waist_girth_m: None,
            hip_girth_m: None,
            neck_girth_m: None,
            across_shoulder_m: None,
        }
    }

    /// Survey means (men and women): the equations pass through them.
    #[test]
    fn the_mean_soldier_is_found_again() {
        let check = |sex, stature_m, weight_kg, chest: f64, hip: f64| {
            let known = Measurements { weight_kg: Some(weight_kg), ..only_stature(sex, stature_m) };
            let profile = Profile::new(&known).expect("an ordinary person");
            assert!((profile.chest - chest).abs() < 2e-3, "{sex:?} chest {}", profile.chest);
            assert!((profile.hip - hip).abs() < 2e-3, "{sex:?} hip {}", profile.hip);
        };
        check(Sex::Male, 1.7562, 85.5, 1.0587, 1.0195);
        check(Sex::Female, 1.6285, 67.8, 0.947, 1.0215);
    }

    #[test]
    fn girths_tell_the_mass() {
        let known =
            Measurements { chest_girth_m: Some(1.0587), hip_girth_m: Some(1.0195), ..only_stature(Sex::Male, 1.7562) };
        assert!((MALE.mass(&known) - 85.5).abs() < 0.5, "{}", MALE.mass(&known));
    }

    #[test]
    fn impossible_people_are_refused_by_name() {
        let refused = Measurements { waist_girth_m: Some(89.0), ..only_stature(Sex::Male, 1.7) };
        let error = Profile::new(&refused).expect_err("89 m of waist").to_string();
        assert!(error.contains("waist_girth_m") && error.contains("89") && error.contains("1.6"), "{error}");
        assert!(Profile::new(&only_stature(Sex::Female, f64::NAN)).is_err());
        assert!(Profile::new(&only_stature(Sex::Female, 0.0)).is_err());
    }
}
