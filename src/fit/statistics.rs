//! Statistics of paired differences: effect size, multiple tests, equivalence.

use super::distribution::student;

/// Mean. NaN without values.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Sample standard deviation (n - 1). NaN for fewer than two values.
pub(super) fn sd(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (values.len() as f64 - 1.0)).sqrt()
}

/// Paired effect size: mean difference / its standard deviation (Cohen's d_z) [Cohen 1988], corrected for small samples
/// by `1 - 3 / (4 (n - 1) - 1)` [Hedges 1981]. `None` for fewer than three values, or equal values.
pub fn effect_size(differences: &[f64]) -> Option<f64> {
    let dof = differences.len().checked_sub(1).filter(|&dof| dof > 1)? as f64;
    let size = mean(differences) / sd(differences) * (1.0 - 3.0 / (4.0 * dof - 1.0));
    size.is_finite().then_some(size)
}

/// Holm's step-down adjustment of the p values of several tests, in the given order. It keeps the probability of any
/// false rejection among them below the level of one test [Holm 1979].
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut adjusted = vec![1.0; p.len()];
    let mut least = 0.0_f64;
    for (rank, &test) in order.iter().enumerate() {
        least = least.max((p.len() - rank) as f64 * p[test]).min(1.0);
        adjusted[test] = least;
    }
    adjusted
}

/// p of the two one-sided t tests that a mean lies within `margin` of 0, the greater of both [Schuirmann 1987]. `error`
/// is the standard error of the mean with `dof` degrees of freedom, 1 or more.
pub fn equivalence(mean: f64, error: f64, dof: usize, margin: f64) -> f64 {
    if error <= 0.0 {
        return if mean.abs() < margin { 0.0 } else { 1.0 };
    }
    student((mean.abs() - margin) / error, dof)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holm_is_that_of_the_textbook() {
        let check = |p: &[f64], adjusted: &[f64]| {
            let found = holm(p);
            assert!(found.iter().zip(adjusted).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        };
        // The worked example of "Holm-Bonferroni method" (Wikipedia): H4 and H1 are rejected at 5 %, H3 and H2 are not.
        check(&[0.01, 0.04, 0.03, 0.005], &[0.03, 0.06, 0.06, 0.02]);
        check(&[0.6, 0.7], &[1.0, 1.0]);
        check(&[], &[]);
    }

    #[test]
    fn equivalence_is_that_of_the_replication() {
        // The example of Lakens's package TOSTER (TOSTtwo.raw): 5.25 (SD 0.95, 95 people) and 5.22 (0.83, 89), bounds of
        // 0.384: "t(182) = -2.69, p = 0.004".
        let error = (0.95f64.powi(2) / 95.0 + 0.83f64.powi(2) / 89.0).sqrt();
        let t = (0.03 - 0.384) / error;
        assert!((t + 2.69).abs() < 0.01, "{t}");
        let p = equivalence(5.25 - 5.22, error, 182, 0.384);
        assert!((p - 0.004).abs() < 5e-4, "{p}");
        assert_eq!(equivalence(-0.03, error, 182, 0.384), equivalence(0.03, error, 182, 0.384));
        assert!(equivalence(0.5, error, 182, 0.384) > 0.5);
        assert_eq!((equivalence(0.0, 0.0, 3, 0.01), equivalence(0.02, 0.0, 3, 0.01)), (0.0, 1.0));
    }

    #[test]
    fn effect_size_is_the_mean_in_deviations() {
        // d_z = 2 / 1 = 2 of five differences, times 1 - 3 / 15.
        let differences = [1.0, 1.5, 2.0, 2.5, 3.0].map(|d| 2.0 + (d - 2.0) / 0.625f64.sqrt());
        let found = effect_size(&differences).expect("five");
        assert!((found - 1.6).abs() < 1e-12, "{found}");
        assert_eq!((effect_size(&[1.0, 1.0, 1.0]), effect_size(&[1.0, 2.0])), (None, None));
    }
}
