//! Conversions at the edges of the program, and standard gravity. Inside, all is in SI units. Users read and write
//! millimetres, degrees and milliseconds.

/// Standard gravity, m/s2.
pub const GRAVITY: f64 = 9.80665;

pub fn mm(metres: f64) -> f64 {
    metres * 1e3
}

pub fn from_mm(millimetres: f64) -> f64 {
    millimetres * 1e-3
}

/// Formats with at most `digits` significant digits and no trailing zeros. Very small and very large numbers get an
/// exponent.
pub fn significant(number: f64, digits: i32) -> String {
    if number == 0.0 || !number.is_finite() {
        return number.to_string();
    }
    let magnitude = number.abs().log10().floor() as i32;
    if !(-5..15).contains(&magnitude) {
        return format!("{number:.*e}", (digits - 1).max(0) as usize);
    }
    let decimals = (digits - 1 - magnitude).max(0) as usize;
    let text = format!("{number:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Formats with sign and one decimal. A number that rounds to 0 is `+0.0`.
pub fn signed_tenths(number: f64) -> String {
    // `-0.0` becomes `0.0`.
    format!("{:+.1}", (number * 10.0).round() / 10.0 + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_negative_by_less_than_is_shown() {
        let check = |number: f64, expected: &str| assert_eq!(signed_tenths(number), expected);
        check(-0.04, "+0.0");
        check(-0.06, "-0.1");
        check(12.34, "+12.3");
    }

    #[test]
    fn numbers_are_short_for_reading() {
        let check = |number: f64, expected: &str| assert_eq!(significant(number, 6), expected);
        check(0.0, "0");
        check(1.0, "1");
        check(974.1, "974.1");
        check(0.012_345_678, "0.0123457");
        check(1_234_567.8, "1234568");
        check(1.5e-9, "1.50000e-9");
        check(-0.25, "-0.25");
        assert_eq!([significant(7.204e-6, 2), significant(3801.4, 2)], ["7.2e-6", "3801"]);
    }
}
