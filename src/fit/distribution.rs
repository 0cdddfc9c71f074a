//! Normal and Student's t distribution.

/// Standard normal distribution function: a series near 0 [Marsaglia 2004], a continued fraction in the tails.
pub(super) fn normal(x: f64) -> f64 {
    let density = (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
    if x.abs() < 3.5 {
        let (mut term, mut sum, mut k) = (x, x, 1.0);
        while term.abs() > 1e-17 * sum.abs() {
            k += 2.0;
            term *= x * x / k;
            sum += term;
        }
        return 0.5 + density * sum;
    }
    let tail = (1..=80).rev().fold(x.abs(), |below, k| x.abs() + f64::from(k) / below);
    if x > 0.0 { 1.0 - density / tail } else { density / tail }
}

/// Distribution function of Student's t with whole degrees of freedom, 1 or more [Abramowitz & Stegun 26.7.3, 26.7.4].
pub(super) fn student(t: f64, dof: usize) -> f64 {
    let angle = (t / (dof as f64).sqrt()).atan();
    let square = angle.cos().powi(2);
    let odd = dof % 2 == 1;
    // Powers of the cosine below `dof - 1`, from the first (odd `dof`) or zeroth (even).
    let (mut term, mut sum) = (if odd { angle.cos() } else { 1.0 }, 0.0);
    for k in (if odd { 1 } else { 0 }..dof.saturating_sub(1)).step_by(2) {
        sum += term;
        term *= square * (k + 1) as f64 / (k + 2) as f64;
    }
    let between = if odd { 2.0 / std::f64::consts::PI * (angle + angle.sin() * sum) } else { angle.sin() * sum };
    0.5 + 0.5 * between
}

/// Quantile of Student's t at the share `p` of the distribution, by bisection.
pub(super) fn student_quantile(p: f64, dof: usize) -> f64 {
    let (mut low, mut high) = (-1.0, 1.0);
    while student(low, dof) > p && low > -1e12 {
        low *= 2.0;
    }
    while student(high, dof) < p && high < 1e12 {
        high *= 2.0;
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if student(middle, dof) < p { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

    #[test]
    fn values_are_those_of_the_tables() {
        let check =
            |found: f64, table: f64, half_digit: f64| assert!((found - table).abs() < half_digit, "{found}, {table}");
        // [Abramowitz & Stegun, tables 26.1 and 26.2].
        check(normal(1.0), 0.841_344_746_068_543, 1e-14);
        check(normal(1.96), 0.975_002_104_851_780, 1e-14);
        check(normal(-4.0), 3.167_124_183e-5, 1e-13);
        check(normal(3.4999) - normal(3.5001), -2.0e-4 * 8.726_8e-4, 1e-9);
        // [Abramowitz & Stegun, table 26.10]: two-sided 5 % points of Student's t.
        for (dof, table) in [(1, 12.706), (2, 4.303), (3, 3.182), (5, 2.571), (10, 2.228), (29, 2.045), (120, 1.980)] {
            check(student_quantile(0.975, dof), table, 5e-4);
            check(student(-table, dof), 0.025, 5e-5);
        }
        assert!(student(0.0, 4) == 0.5 && student_quantile(0.5, 7).abs() < 1e-12);
    }

    #[test]
    fn values_are_those_of_statrs() {
        let check = |what: &str, ours: f64, theirs: f64, most: f64| {
            assert!((ours - theirs).abs() < most, "{what}: {ours:e}, {theirs:e}");
        };
        let standard = Normal::standard();
        for x in (-320..=320).map(|k| 0.025 * f64::from(k)) {
            // Its error function has ten digits; ours agrees with the printed tables to fourteen.
            check(&format!("normal({x})"), normal(x), standard.cdf(x), 1e-10);
        }
        for dof in [1, 2, 3, 4, 5, 7, 10, 11, 29, 53, 120] {
            let theirs = StudentsT::new(0.0, 1.0, dof as f64).expect("a distribution");
            for t in (-80..=80).map(|k| 0.1 * f64::from(k)) {
                check(&format!("student({t}, {dof})"), student(t, dof), theirs.cdf(t), 1e-13);
            }
            for p in [0.9, 0.95, 0.975, 0.995] {
                check(&format!("quantile({p}, {dof})"), student_quantile(p, dof), theirs.inverse_cdf(p), 1e-10);
            }
        }
    }
}
