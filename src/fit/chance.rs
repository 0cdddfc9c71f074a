//! Probability that sizes fit, estimated from draws of uncertain measurements, with confidence intervals.

use super::resample::quantile;
use super::target::Band;

/// Confidence level of every interval in this module.
pub const TOLD: f64 = 0.8;
/// Standard normal quantile at (1 + [`TOLD`]) / 2 = 0.9, the upper end of such an interval.
const Z: f64 = 1.281_551_565_544_6;
/// Least departure from a band that counts, m. Any smaller one rounds to zero in millimetres.
const DEPARTURE_M: f64 = 0.5e-3;

/// Fit of a size, by its worst level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sitting {
    Fits,
    Tight,
    Loose,
}

pub fn sitting(ease_m: f64, band: &Band) -> Sitting {
    match band.off_m(ease_m) {
        off if off <= -DEPARTURE_M => Sitting::Tight,
        off if off >= DEPARTURE_M => Sitting::Loose,
        _ => Sitting::Fits,
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    pub sitting: Sitting,
    /// Index of the level farthest outside its band, tight departures doubled. `None` for a size that fits.
    pub decides: Option<usize>,
    /// Weighted departure of that level, m ([`Band::weight_m`]).
    pub weight_m: f64,
}

/// Ignores levels without a band.
pub fn verdict(eases_m: &[f64], bands: &[Option<Band>]) -> Verdict {
    let mut worst = Verdict { sitting: Sitting::Fits, decides: None, weight_m: 0.0 };
    for (level, (ease_m, band)) in eases_m.iter().zip(bands).enumerate() {
        let Some(band) = band else { continue };
        let weight_m = band.weight_m(*ease_m);
        if weight_m > worst.weight_m {
            let sitting = sitting(*ease_m, band);
            worst = Verdict { sitting, decides: (sitting != Sitting::Fits).then_some(level), weight_m };
        }
    }
    worst
}

/// Size whose worst level has the least weighted departure, or the first of equals.
pub fn to_wear(sizes: &[Verdict]) -> Option<usize> {
    // `min_by` returns the first of equals.
    (0..sizes.len()).min_by(|&a, &b| sizes[a].weight_m.total_cmp(&sizes[b].weight_m))
}

/// Share of draws, with the 80 % Wilson interval of the estimated probability [Wilson 1927].
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Share {
    pub share: f64,
    pub interval: [f64; 2],
}

impl Share {
    /// Share of `count` in `draws`. Without draws, NaN with the interval 0 to 1.
    pub fn of(count: usize, draws: usize) -> Self {
        if draws == 0 {
            return Self { share: f64::NAN, interval: [0.0, 1.0] };
        }
        let (n, share) = (draws as f64, count as f64 / draws as f64);
        let middle = (share + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
        Self { share, interval: [(middle - half).max(0.0), (middle + half).min(1.0)] }
    }
}

/// Lower end, median and upper end of the central 80 % of some values. NaN without values.
pub fn interval(values: &[f64]) -> [f64; 3] {
    if values.is_empty() {
        return [f64::NAN; 3];
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.5 - 0.5 * TOLD, 0.5, 0.5 + 0.5 * TOLD].map(|share| quantile(&sorted, share))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Draw;

    #[test]
    fn the_worst_level_judges_a_size_and_the_least_bad_is_worn() {
        let band = |ends_m| Some(Band { ends_m, must_close: false });
        let bands = [band([0.05, 0.12]), None, band([0.04, 0.12])];
        let check = |eases: [f64; 3], sitting, decides| {
            let found = verdict(&eases, &bands);
            assert_eq!((found.sitting, found.decides), (sitting, decides), "{eases:?}");
            found
        };
        let small = check([0.03, 0.0, 0.01], Sitting::Tight, Some(2));
        let good = check([0.06, -0.2, 0.1203], Sitting::Fits, None);
        let large = check([0.16, 0.0, 0.13], Sitting::Loose, Some(0));
        let tight_counts_double = check([0.035, 0.0, 0.14], Sitting::Tight, Some(0));
        assert_eq!(to_wear(&[small, large, good]), Some(2));
        assert_eq!(to_wear(&[tight_counts_double, large, small]), Some(0));
        assert_eq!(to_wear(&[good, good]), Some(0), "of two alike the smaller");
        assert_eq!(to_wear(&[]), None);
    }

    #[test]
    fn intervals_of_shares_are_wilsons() {
        let check = |count, draws, ends: [f64; 2]| {
            let found = Share::of(count, draws).interval;
            assert!((0..2).all(|k| (found[k] - ends[k]).abs() < 5e-4), "{count} of {draws}: {found:?}");
        };
        // By hand: (p + z2/2n -+ z sqrt(p(1-p)/n + z2/4n2)) / (1 + z2/n), z = 1.28155.
        check(5, 10, [0.3123, 0.6877]);
        check(0, 20, [0.0, 0.0759]);
        check(415, 500, [0.8074, 0.8504]);
        assert_eq!(Share::of(0, 0).interval, [0.0, 1.0]);
    }

    #[test]
    fn intervals_of_shares_hold_the_probability_as_often_as_they_say() {
        let mut draw = Draw::new(11);
        let (mut held, cases) = (0, 2000);
        for _ in 0..cases {
            let probability = 0.05 + 0.9 * draw.share();
            let count = (0..500).filter(|_| draw.share() < probability).count();
            let [low, high] = Share::of(count, 500).interval;
            held += usize::from((low..=high).contains(&probability));
        }
        let share = f64::from(held as u32) / f64::from(cases);
        assert!((0.77..0.83).contains(&share), "{share}");
    }
}
