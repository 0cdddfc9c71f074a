//! The audit of the thesis's tables: each kind of check over all of them.

use crate::answers::audit::tables::Tables;
use crate::answers::audit::{Audit, Finding, claims, equations, metrics, ratios, references, structure};

/// How far a recomputed number may lie from one printed with three decimals: half of the last digit.
const HALF_DIGIT: f64 = 0.0005 + 1e-6;

/// One kind of check: how many numbers it recomputed, and what it found.
type Check = fn(&Tables) -> (usize, Vec<Finding>);

/// Every kind of check, in the order of its findings.
const CHECKS: [Check; 7] =
    [ratios::check, metrics::check, structure::check, metrics::subjects, references::check, claims::check, |_| {
        equations::check()
    }];

/// Recomputes every printed number and statement.
pub(super) fn audit(tables: &Tables) -> Audit {
    let mut audit = Audit { recomputed: 0, findings: Vec::new() };
    for check in CHECKS {
        let (recomputed, findings) = check(tables);
        audit.recomputed += recomputed;
        audit.findings.extend(findings);
    }
    audit
}

/// Half of the last digit of a printed length, mm.
const HALF_DIGIT_MM: f64 = 0.005;

/// Whether a printed number is a recomputed one, rounded; `blur` is what the roundings of its parts add.
pub(super) fn prints_as(recomputed: f64, printed: f64, blur: f64) -> bool {
    (recomputed - printed).abs() <= HALF_DIGIT + blur
}

/// How far a ratio of two printed lengths may be from that of the lengths themselves: `ratio` over `below_mm`.
pub(super) fn blur(ratio: f64, below_mm: f64) -> f64 {
    HALF_DIGIT_MM * (1.0 + ratio) / below_mm
}

/// Mean of numbers.
pub(super) fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

/// Variance of numbers with divisor `n - less`.
pub(super) fn variance(numbers: &[f64], less: f64) -> f64 {
    let mean = mean(numbers);
    numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (numbers.len() as f64 - less)
}
