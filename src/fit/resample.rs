//! Distribution-free tests and intervals: the sign-flip test and the bootstrap over subjects.

use super::distribution::{normal, student_quantile};

/// Greatest number of subjects for which all assignments of signs are enumerated. For more, [`DRAWS`] are drawn.
const EXACT: usize = 20;
/// Number of random draws of signs or subjects: 10,000 with the observed sample.
const DRAWS: usize = 9999;

/// Pseudo-random numbers, the same for the same seed [Steele 2014: SplitMix64].
#[derive(Clone, Debug)]
pub struct Draw(u64);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// Uniform number between 0 and 1, both excluded.
    pub fn share(&mut self) -> f64 {
        ((self.bits() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// Standard normal number [Box and Muller 1958].
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.share().ln()).sqrt();
        radius * (std::f64::consts::TAU * self.share()).cos()
    }
}

/// Two-sided p of the sign-flip test [Fisher 1935, section 21].
///
/// Share of all assignments of signs to the differences whose absolute sum is at least that of the differences: exact
/// for up to 20 differences, estimated by seeded draws for more. Without differences, 1.
pub fn sign_flip(differences: &[f64]) -> f64 {
    let n = differences.len();
    let sum: f64 = differences.iter().sum();
    // Sums that are equal up to rounding count as equal.
    let reached = sum.abs() - 1e-9 * differences.iter().map(|d| d.abs()).sum::<f64>();
    if n > EXACT {
        let mut draw = Draw::new(0x5167);
        let flipped = |_: &usize| {
            let sign = |d: &f64| if draw.bits() >> 63 == 1 { *d } else { -d };
            differences.iter().map(sign).sum::<f64>().abs() >= reached
        };
        return (1 + (0..DRAWS).filter(flipped).count()) as f64 / (1 + DRAWS) as f64;
    }
    let assignments = 1_u64 << n;
    let mut turned = sum;
    let mut extreme = u64::from(turned.abs() >= reached);
    // In a Gray code each assignment differs from the preceding one in one sign.
    for step in 1..assignments {
        let place = step.trailing_zeros() as usize;
        let now_negative = (step ^ (step >> 1)) >> place & 1 == 1;
        turned += if now_negative { -2.0 } else { 2.0 } * differences[place];
        extreme += u64::from(turned.abs() >= reached);
    }
    extreme as f64 / assignments as f64
}

/// Bootstrap interval of the mean with coverage `1 - alpha`: expanded percentiles of the means of subjects drawn with
/// replacement [Hesterberg 2015]. Seeded, so the same values give the same interval. `None` for fewer than two values.
pub fn interval(values: &[f64], alpha: f64) -> Option<(f64, f64)> {
    let share = share(values.len(), alpha)?;
    let mut means = bootstrap(values.len(), |drawn| drawn.iter().map(|&k| values[k]).sum::<f64>() / drawn.len() as f64);
    means.sort_by(f64::total_cmp);
    Some((quantile(&means, share), quantile(&means, 1.0 - share)))
}

/// Expanded percentile in place of `alpha / 2` for a sample of `n`, which corrects for Student's t and for the divisor
/// n - 1. `None` for fewer than two values.
pub(super) fn share(n: usize, alpha: f64) -> Option<f64> {
    let dof = n.checked_sub(1).filter(|&dof| dof > 0)?;
    let expand = (n as f64 / dof as f64).sqrt();
    Some(normal(expand * student_quantile(alpha / 2.0, dof)))
}

/// Values of a statistic for [`DRAWS`] samples, each given as the indices of `n` subjects drawn with replacement.
pub(super) fn bootstrap(n: usize, mut statistic: impl FnMut(&[usize]) -> f64) -> Vec<f64> {
    let mut draw = Draw::new(0xb007);
    let mut drawn = vec![0; n];
    let once = |_| {
        drawn.iter_mut().for_each(|k| *k = draw.below(n));
        statistic(&drawn)
    };
    (0..DRAWS).map(once).collect()
}

/// Quantile of sorted values by linear interpolation.
pub(super) fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share.clamp(0.0, 1.0) * (sorted.len().saturating_sub(1)) as f64;
    let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    low + (high - low) * place.fract()
}

#[cfg(test)]
mod tests {
    use super::super::statistics::{mean, sd};
    use super::*;

    /// Darwin's maize: excess height of the crossed plant of each pair, eighths of an inch [Fisher 1935].
    const MAIZE: [f64; 15] = [49.0, -67.0, 8.0, 16.0, 6.0, 23.0, 28.0, 41.0, 14.0, 29.0, 56.0, 24.0, 75.0, 60.0, -48.0];

    #[test]
    fn sign_flips_give_fishers_number_for_darwins_maize() {
        // 863 of 32,768 assignments reach the observed sum on its side, as many on the other: 5.267 % [Fisher 1935; Ernst
        // 2004].
        assert_eq!(sign_flip(&MAIZE) * 32_768.0, 2.0 * 863.0);
        assert!((100.0 * sign_flip(&MAIZE) - 5.267).abs() < 5e-4);
        // Twice as many plants, so that signs are drawn. The p is that of the normal approximation.
        let twice: Vec<f64> = MAIZE.iter().chain(&MAIZE).copied().collect();
        let spread = (2.0 * MAIZE.iter().map(|d| d * d).sum::<f64>()).sqrt();
        let near = 2.0 * normal(-twice.iter().sum::<f64>() / spread);
        assert!((sign_flip(&twice) - near).abs() < 0.003, "{} {near}", sign_flip(&twice));
    }

    #[test]
    fn few_subjects_cannot_reach_small_p() {
        let check = |n: usize, p: f64| assert_eq!(sign_flip(&vec![0.013; n]), p, "{n}");
        check(0, 1.0);
        check(1, 1.0);
        check(5, 0.0625);
        check(6, 0.03125);
        assert_eq!(sign_flip(&[0.1, -0.1]), 1.0);
    }

    /// Survival of seven treated mice, days [Efron & Tibshirani 1993, tables 2.1 and 2.2].
    const MICE: [f64; 7] = [94.0, 197.0, 16.0, 38.0, 99.0, 141.0, 23.0];

    #[test]
    fn the_bootstrap_gives_the_published_error_of_the_mice() {
        let means = bootstrap(MICE.len(), |drawn| drawn.iter().map(|&k| MICE[k]).sum::<f64>() / 7.0);
        assert!((mean(&MICE) - 86.86).abs() < 0.005);
        // 23.36 with endlessly many draws.
        assert!((sd(&means) - 23.36).abs() < 0.4, "{}", sd(&means));
        // Table 13.1: of 1000 draws 2.5 % lie below 45.9 and above 135.4; such a percentile has a standard error of 2 days.
        let mut sorted = means;
        sorted.sort_by(f64::total_cmp);
        for (share, table) in [(0.025, 45.9), (0.975, 135.4)] {
            let found = quantile(&sorted, share);
            assert!((found - table).abs() < 4.0, "{share}: {found}, {table}");
        }
        let t = 2.447 * sd(&MICE) / 7f64.sqrt();
        let (low, high) = interval(&MICE, 0.05).expect("seven mice");
        assert!((high - low - 2.0 * t).abs() < 0.1 * t, "as wide as Student's: {low} {high}, {t}");
        assert!(mean(&MICE) - low < high - mean(&MICE), "skewed as the mice are");
        assert_eq!(interval(&MICE, 0.05), Some((low, high)));
        assert_eq!(interval(&[1.0], 0.05), None);
    }

    #[test]
    fn percentiles_are_expanded_as_published() {
        // [Hesterberg 2015], adjusted quantile for a nominal 2.5 %: n = 5, 10, 20.
        for (n, table) in [(5, 0.0010), (10, 0.0086), (20, 0.0158)] {
            let found = share(n, 0.05).expect("enough");
            assert!((found - table).abs() < 1e-4, "{n}: {found}");
        }
    }
}
