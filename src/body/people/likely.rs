//! Posterior distribution of the dimensions of a person, given readings with errors. The survey is the prior [Gordon
//! 2014].

use super::dimension::{COUNT, Dimension};
use super::profile::Profile;
use super::survey::Survey;
use crate::{BodyError, Measurements, Sex};
use nalgebra::{DMatrix, DVector};

/// Standard deviations of a reading by a trained measurer, m: of small girths and heights, large girths, lengths, the
/// foot. Mean differences that ISO 20685-1 accepts from a scan [ISO 20685-1; Kouchi 2020].
const SMALL_M: f64 = 4e-3;
const LARGE_M: f64 = 9e-3;
const LENGTH_M: f64 = 5e-3;
const FOOT_M: f64 = 2e-3;
/// Standard deviation of a weight, kg.
const WEIGHT_KG: f64 = 0.5;

impl Dimension {
    /// Standard deviation of a reading by a trained measurer, by tape or on a scan, m or kg [ISO 20685-1].
    pub fn reading_error(self) -> f64 {
        use Dimension::*;
        match self {
            Weight => WEIGHT_KG,
            ChestGirth | WaistGirth | HipGirth | UnderbustGirth | ThighGirth => LARGE_M,
            AcrossShoulder | ArmLength | ShoulderBreadth => LENGTH_M,
            FootLength => FOOT_M,
            Stature | Inseam | NeckGirth | KneeGirth | CalfGirth | AnkleGirth | UpperArmGirth | ForearmGirth
            | WristGirth => SMALL_M,
        }
    }
}

/// Distribution of the true dimensions of a person, normal in their logarithms.
#[derive(Clone, Debug)]
pub struct Likely {
    sex: Sex,
    mean: DVector<f64>,
    /// Symmetric square root of the covariance.
    root: DMatrix<f64>,
}

/// Measured value, and standard deviation of its error, m or kg.
#[derive(Clone, Copy)]
struct Reading {
    dimension: Dimension,
    value: f64,
    error: f64,
}

impl Likely {
    pub const SCORES: usize = COUNT;

    pub fn anybody(sex: Sex) -> Self {
        Self::seen(sex, &[])
    }

    /// Distribution of a person with these readings, whose errors have the standard deviations `error` (m, kg). The
    /// posterior mean lies between a reading and its expectation by the others, nearer to the more certain one.
    pub fn of(readings: &Measurements, error: impl Fn(Dimension) -> f64) -> Result<Self, BodyError> {
        Profile::new(readings)?;
        let reading = |(dimension, value)| Reading { dimension, value, error: error(dimension) };
        let seen: Vec<Reading> = readings.known().map(reading).collect();
        Ok(Self::seen(readings.sex, &seen))
    }

    fn seen(sex: Sex, seen: &[Reading]) -> Self {
        let (before, covariance) = Survey::of(sex).logarithms();
        let row = |k: usize| covariance.row(seen[k].dimension as usize);
        // The standard error of a logarithm is the relative error.
        let of_readings = DMatrix::from_fn(seen.len(), seen.len(), |i, j| {
            let own = if i == j { (seen[i].error / seen[i].value).powi(2) } else { 0.0 };
            row(i)[seen[j].dimension as usize] + own
        });
        let solver =
            of_readings.cholesky().expect("the survey's covariance is positive definite, and each is seen once");
        let with = DMatrix::from_fn(seen.len(), COUNT, |i, j| row(i)[j]);
        let off = DVector::from_fn(seen.len(), |i, _| seen[i].value.ln() - before[seen[i].dimension as usize]);
        let mean = before + with.transpose() * solver.solve(&off);
        let left = covariance - with.transpose() * solver.solve(&with);
        Self { sex, mean, root: root(left) }
    }

    pub fn median(&self) -> Measurements {
        self.person(&[0.0; COUNT])
    }

    pub fn person(&self, scores: &[f64; Self::SCORES]) -> Measurements {
        let off = &self.root * DVector::from_column_slice(scores);
        let mut person = Measurements::of(self.sex, f64::NAN);
        for dimension in Dimension::ALL {
            let at = dimension as usize;
            person.set(dimension, (self.mean[at] + off[at]).exp());
        }
        person
    }

    /// Standard deviation of the logarithm of a dimension.
    pub fn spread(&self, dimension: Dimension) -> f64 {
        self.root.row(dimension as usize).norm()
    }
}

/// Counts eigenvalues that rounding made negative as zero.
fn root(covariance: DMatrix<f64>) -> DMatrix<f64> {
    let turned = (0.5 * (&covariance + covariance.transpose())).symmetric_eigen();
    let lengths = DMatrix::from_diagonal(&turned.eigenvalues.map(|value| value.max(0.0).sqrt()));
    &turned.eigenvectors * lengths * turned.eigenvectors.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Noise;
    use Dimension::{ChestGirth, HipGirth, Stature, WaistGirth, Weight};

    fn man() -> Measurements {
        Measurements::of(Sex::Male, 1.76).with(Weight, 85.0).with(ChestGirth, 1.06).with(WaistGirth, 0.95)
    }

    #[test]
    fn readings_without_error_are_kept_and_the_rest_is_the_surveys() {
        let likely = Likely::of(&man(), |_| 0.0).expect("a person");
        let median = likely.median();
        let profile = Profile::new(&man()).expect("a person");
        for dimension in Dimension::ALL {
            let found = median.get(dimension).expect("every dimension");
            // A thousandth of each variance of the survey is independent.
            assert!(
                (found / profile.at(dimension) - 1.0).abs() < 2e-3,
                "{dimension:?} {found} {}",
                profile.at(dimension)
            );
        }
        assert!(likely.spread(ChestGirth) < 1e-6 && likely.spread(HipGirth) > 0.01);
    }

    #[test]
    fn a_reading_that_errs_is_drawn_towards_people_alike() {
        let odd = man().with(HipGirth, 1.15);
        let hip = |error_m: f64| {
            let error = |dimension| if dimension == HipGirth { error_m } else { 0.0 };
            let likely = Likely::of(&odd, error).expect("a person");
            (likely.median().get(HipGirth).expect("known"), likely.spread(HipGirth))
        };
        let expected = Profile::new(&man()).expect("a person").at(HipGirth);
        let [exact, taped, guessed] = [0.0, 0.009, 0.5].map(hip);
        assert!((exact.0 - 1.15).abs() < 1e-9);
        assert!(taped.0 < 1.145 && taped.0 > 1.10, "{taped:?}");
        assert!((guessed.0 - expected).abs() < 5e-3, "{guessed:?}, {expected}");
        assert!(exact.1 < taped.1 && taped.1 < guessed.1);
    }

    /// Share of random people whose hip girth lies in the 80 % interval from readings, whose errors are so many times
    /// those that are assumed.
    fn held(read: &[Dimension], error_factor: f64) -> f64 {
        let mut noise = Noise(7);
        let mut normal = || noise.normal();
        let (mut held, people) = (0, 2000);
        for number in 0..people {
            let sex = if number % 2 == 0 { Sex::Female } else { Sex::Male };
            let person = Likely::anybody(sex).person(&std::array::from_fn(|_| normal()));
            let value = |dimension: Dimension| person.get(dimension).expect("every dimension");
            let seen: Vec<_> = read
                .iter()
                .map(|&dimension| {
                    let error = dimension.reading_error();
                    Reading { dimension, value: value(dimension) + error_factor * error * normal(), error }
                })
                .collect();
            let likely = Likely::seen(sex, &seen);
            let off = (value(HipGirth) / likely.median().get(HipGirth).expect("every dimension")).ln();
            held += usize::from((off / likely.spread(HipGirth)).abs() < 1.281_55);
        }
        held as f64 / f64::from(people)
    }

    #[test]
    fn intervals_hold_as_many_people_as_they_say_and_errors_that_are_not_told_break_them() {
        let girths = [Stature, Weight, ChestGirth, WaistGirth, HipGirth];
        for read in [&[][..], &[Stature, Weight], &girths] {
            let share = held(read, 1.0);
            assert!((0.77..0.83).contains(&share), "{read:?}: {share}");
        }
        assert!(held(&girths, 2.0) < 0.70, "{}", held(&girths, 2.0));
        assert!(held(&girths, 0.0) > 0.85, "{}", held(&girths, 0.0));
    }

    #[test]
    fn one_dimension_is_weighed_as_a_textbook_weighs_it() {
        // With a reading of the stature alone, precisions add.
        let (sd, error) = (0.0390_f64, 0.02_f64);
        let likely = Likely::of(&Measurements::of(Sex::Male, 1.9), |_| error).expect("a person");
        let relative = error / 1.9;
        let weight = sd.powi(2) / (sd.powi(2) + relative.powi(2));
        let mean = 0.5624 + weight * (1.9_f64.ln() - 0.5624);
        assert!((likely.median().stature_m().ln() - mean).abs() < 1e-9);
        assert!((likely.spread(Stature) - sd * (1.0 - weight).sqrt()).abs() < 1e-9);
    }
}
