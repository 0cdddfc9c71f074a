//! Comparison of recomputed numbers with printed ones.

/// Greatest difference between a number and its print with three decimals: half a unit of the last digit.
const HALF_DIGIT: f64 = 0.0005 + 1e-6;

/// Half a unit of the last digit of a printed length.
const HALF_DIGIT_MM: f64 = 0.005;

/// True if a printed number is the recomputed one, rounded. `blur` is the error from rounding in its parts.
pub(super) fn prints_as(recomputed: f64, printed: f64, blur: f64) -> bool {
    (recomputed - printed).abs() <= HALF_DIGIT + blur
}

/// Error of a ratio of two printed lengths that their rounding causes. `below_mm` is the denominator.
pub(super) fn blur(ratio: f64, below_mm: f64) -> f64 {
    HALF_DIGIT_MM * (1.0 + ratio) / below_mm
}

pub(super) fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

/// Variance of numbers, with divisor `n - less`.
pub(super) fn variance(numbers: &[f64], less: f64) -> f64 {
    let mean = mean(numbers);
    numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (numbers.len() as f64 - less)
}
