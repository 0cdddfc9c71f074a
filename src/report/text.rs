//! Formats of numbers and names, and the mean and standard deviation of values.

use fit::{Ease, Finding, FitClass, Simulator};

pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// One decimal.
pub(super) fn mm(metres: f64) -> String {
    number(metres * 1e3, 1)
}

/// Formats a number with U+2212 as its minus sign; a dash for a number that is not finite.
pub(super) fn number(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let text = format!("{value:.decimals$}");
    // Readers take "-0.0" for an error, so zero has no sign.
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().any(|b| (b'1'..=b'9').contains(&b)) => format!("\u{2212}{rest}"),
        Some(rest) => rest.into(),
        None => text,
    }
}

pub(super) fn signed_mm(metres: f64) -> String {
    signed(metres * 1e3, 1)
}

pub(super) fn signed(value: f64, decimals: usize) -> String {
    let text = number(value, decimals);
    let is_nought = !text.bytes().any(|b| (b'1'..=b'9').contains(&b));
    if value > 0.0 && !is_nought { format!("+{text}") } else { text }
}

pub(super) fn duration(seconds: f64) -> String {
    if seconds < 1.0 {
        format!("{:.0} ms", seconds * 1e3)
    } else if seconds < 120.0 {
        format!("{seconds:.1} s")
    } else {
        format!("{:.1} min", seconds / 60.0)
    }
}

pub(super) fn simulator_name(simulator: Simulator) -> &'static str {
    match simulator {
        Simulator::Fem => "FEM-GS",
        Simulator::Hybrid => "Hybrid-GS",
    }
}

pub(super) fn finding_words(finding: Finding) -> &'static str {
    match finding {
        Finding::Fem => "FEM-GS is truer",
        Finding::Hybrid => "Hybrid-GS is truer",
        Finding::NoDifference => "no practical difference",
        Finding::InsufficientEvidence => "insufficient evidence",
    }
}

/// Symbol of a fit class: a circle, filled more the tighter the fit is.
pub(super) fn fit_glyph(class: FitClass) -> &'static str {
    match class {
        FitClass::Tight => "●",
        FitClass::Just => "◐",
        FitClass::Loose => "○",
    }
}

pub(super) fn fit_words(ease: &Ease) -> String {
    let mark = match (ease.is_undersized(), ease.borderline) {
        (true, _) => ", undersized",
        (false, true) => ", borderline",
        (false, false) => "",
    };
    format!("{}{mark}", ease.class.as_str())
}

/// Counts a word: "1 run", "3 runs".
pub(super) fn count(n: usize, word: &str) -> String {
    if n == 1 { format!("1 {word}") } else { format!("{n} {word}s") }
}

/// Order is that of their first appearance.
pub(super) fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen = Vec::new();
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}

/// Mean and sample standard deviation (n-1; 0 for a single value); NaN without values.
pub(super) fn mean_sd(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let values: Vec<f64> = values.collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    (mean, if values.len() > 1 { (squares / (n - 1.0)).sqrt() } else { 0.0 * mean })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_people_write_them() {
        assert_eq!(mm(0.5601), "560.1");
        assert_eq!(number(-4.6, 1), "\u{2212}4.6");
        assert_eq!(number(-0.04, 1), "0.0");
        assert_eq!(number(f64::NAN, 3), "–");
        assert_eq!(signed_mm(0.0666), "+66.6");
        assert_eq!(signed_mm(-0.0461), "\u{2212}46.1");
        assert_eq!(duration(0.25), "250 ms");
        assert_eq!(duration(125.0), "2.1 min");
        assert_eq!(count(1, "run"), "1 run");
        assert_eq!(escape("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
    }

    #[test]
    fn statistics_use_the_sample_divisor() {
        let (mean, sd) = mean_sd([1.0, 2.0, 4.0].into_iter());
        assert!((mean - 7.0 / 3.0).abs() < 1e-12 && (sd - 1.527_525_231_65).abs() < 1e-9, "{mean} {sd}");
        assert_eq!(mean_sd([2.0].into_iter()), (2.0, 0.0));
        assert!(mean_sd(std::iter::empty()).0.is_nan());
    }
}
