//! Ease above which FEM-GS is the truer simulator, by linear regression over the cases.

use std::collections::BTreeMap;

use super::ALPHA;
use super::pair::Pair;
use super::resample::{bootstrap, quantile, share};

/// Ease at which the EI difference is 0, with its interval at 95 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossoverEase {
    pub at_m: f64,
    pub low_m: f64,
    pub high_m: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossover {
    /// EI difference at zero ease.
    pub at_zero: f64,
    /// Change of the EI difference with ease, 1/m. Negative if FEM-GS gains with ease.
    pub slope_per_m: f64,
    /// Bootstrap interval of the slope over subjects at 95 %.
    pub slope_interval: (f64, f64),
    /// Ease above which FEM-GS is truer. `None` if the slope's interval contains 0: the zero is then undetermined.
    pub ease: Option<CrossoverEase>,
    /// Least and greatest ease of the cases.
    pub range_m: (f64, f64),
}

impl std::fmt::Display for Crossover {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (low, high) = self.slope_interval;
        let mm = |metres: f64| 1e3 * metres;
        match self.ease {
            Some(CrossoverEase { at_m: at, low_m: from, high_m: to }) => {
                write!(f, "FEM-GS is the truer above {:+.0} mm of ease ({:+.0} to {:+.0})", mm(at), mm(from), mm(to))?;
                if !(self.range_m.0..=self.range_m.1).contains(&at) {
                    let (least, most) = (mm(self.range_m.0), mm(self.range_m.1));
                    write!(f, ", which is outside the eases seen, {least:+.0} to {most:+.0}")?;
                }
                Ok(())
            }
            None => {
                let slope = 0.01 * self.slope_per_m;
                write!(
                    f,
                    "none: the EI difference changes by {slope:+.4} a centimetre ({:+.4} to {:+.4})",
                    0.01 * low,
                    0.01 * high
                )
            }
        }
    }
}

/// Least-squares line over the cases, bootstrapped over subjects. `None` for under three subjects or equal eases.
pub fn crossover(pairs: &[&Pair]) -> Option<Crossover> {
    let mut cases: BTreeMap<&str, Vec<(f64, f64)>> = BTreeMap::new();
    for pair in pairs {
        cases.entry(&pair.subject).or_default().extend(pair.d_ei(|_| true).map(|d| (pair.ease_m, d)));
    }
    let subjects: Vec<Vec<(f64, f64)>> = cases.into_values().filter(|cases| !cases.is_empty()).collect();
    if subjects.len() < 3 {
        return None;
    }
    let (at_zero, slope_per_m) = line(subjects.iter().flatten())?;
    let share = share(subjects.len(), ALPHA)?;
    let mut crossings = Vec::new();
    let mut slopes = bootstrap(subjects.len(), |drawn| {
        let (at_zero, slope) = line(drawn.iter().flat_map(|&k| &subjects[k])).unwrap_or((at_zero, slope_per_m));
        crossings.push(-at_zero / slope);
        slope
    });
    slopes.sort_by(f64::total_cmp);
    crossings.sort_by(f64::total_cmp);
    let ends = |sorted: &[f64]| (quantile(sorted, share), quantile(sorted, 1.0 - share));
    let slope_interval = ends(&slopes);
    let (low, high) = ends(&crossings);
    let eases = || pairs.iter().map(|pair| pair.ease_m);
    Some(Crossover {
        at_zero,
        slope_per_m,
        slope_interval,
        ease: (slope_interval.1 < 0.0).then_some(CrossoverEase {
            at_m: -at_zero / slope_per_m,
            low_m: low,
            high_m: high,
        }),
        range_m: (eases().fold(f64::INFINITY, f64::min), eases().fold(f64::NEG_INFINITY, f64::max)),
    })
}

/// Intercept and slope of the least-squares line. `None` if all abscissae are equal.
fn line<'a>(points: impl Iterator<Item = &'a (f64, f64)> + Clone) -> Option<(f64, f64)> {
    let n = points.clone().count() as f64;
    let sums = points.clone().fold((0.0, 0.0), |s, p| (s.0 + p.0, s.1 + p.1));
    let (x, y) = (sums.0 / n, sums.1 / n);
    let (mut xx, mut xy) = (0.0, 0.0);
    for p in points {
        xx += (p.0 - x).powi(2);
        xy += (p.0 - x) * (p.1 - y);
    }
    let slope = xy / xx;
    (xx > 1e-12 && slope.is_finite()).then_some((y - slope * x, slope))
}

#[cfg(test)]
mod tests {
    use super::super::{Errors, FitClass};
    use super::*;

    fn pair(subject: usize, ease_m: f64, difference: f64) -> Pair {
        let errors = Errors {
            no: 1,
            name: "hem".into(),
            fem: 0.05 + difference,
            hybrid: 0.05,
            free_edge: false,
            controlled: false,
        };
        let (garment, size) = ("tee".into(), "S".into());
        Pair { garment, size, subject: subject.to_string(), class: FitClass::Just, ease_m, errors: vec![errors] }
    }

    #[test]
    fn the_line_of_the_cases_is_found() {
        let wobble = |k: usize| if [0, 3].contains(&(k % 4)) { 0.002 } else { -0.002 };
        let ease = |k: usize| 0.02 * k as f64;
        let pairs: Vec<Pair> = (0..10).map(|k| pair(k, ease(k), 0.02 - 0.25 * ease(k) + wobble(k))).collect();
        let found = crossover(&pairs.iter().collect::<Vec<_>>()).expect("ten subjects");
        let CrossoverEase { at_m: at, low_m: low, high_m: high } = found.ease.expect("a sure slope");
        assert!((at - 0.08).abs() < 0.01 && low < at && at < high && high - low < 0.04, "{found:?}");
        assert!(found.slope_interval.0 < -0.25 && -0.25 < found.slope_interval.1, "{found:?}");
        assert_eq!(found.range_m, (0.0, 0.18));
    }

    #[test]
    fn no_slope_is_no_crossover() {
        let pairs: Vec<Pair> =
            (0..10).map(|k| pair(k, 0.02 * k as f64, if [0, 3].contains(&(k % 4)) { 0.01 } else { -0.01 })).collect();
        assert_eq!(crossover(&pairs.iter().collect::<Vec<_>>()).expect("ten subjects").ease, None);
        let same: Vec<Pair> = (0..5).map(|k| pair(k, 0.05, 0.01)).collect();
        assert_eq!(crossover(&same.iter().collect::<Vec<_>>()), None);
    }
}
