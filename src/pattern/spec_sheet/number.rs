//! Lengths as people write them: decimals with point or comma, and fractions of an inch (`22 1/2`, `22-1/2`, `22½`).

use crate::dxf::Unit;

/// Greatest denominator of a fraction: rulers are divided to 1/64 of an inch.
const FINEST: u32 = 64;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Written {
    pub value: f64,
    /// `None` for a plain number.
    pub unit: Option<Unit>,
    pub is_fraction: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenTolerance {
    /// Greatest excess over the specification.
    pub plus: Written,
    /// Greatest shortfall, not negative.
    pub minus: Written,
}

pub fn length(cell: &str) -> Option<Written> {
    let cell = cell.trim();
    let (written, rest) = leading(cell)?;
    rest.trim().is_empty().then_some(written)
}

/// Reads a tolerance: `1/2`, `±0.5`, `+/- 1/4"`, `+1/2 -1/4`. A single number holds both ways.
pub fn tolerance(cell: &str) -> Option<WrittenTolerance> {
    let is_sign = |c: char| matches!(c, '+' | '-' | '\u{2212}' | '\u{2013}' | '±' | '/' | ',' | ';' | ' ' | '(' | ')');
    let cell = cell.trim();
    let from = cell.find(|c| !is_sign(c))?;
    let (first, rest) = leading(&cell[from..])?;
    let is_minus = |signs: &str| signs.contains(['-', '\u{2212}', '\u{2013}']) && !signs.contains(['+', '±']);
    let first_is_minus = is_minus(&cell[..from]);
    let Some(next) = rest.find(|c| !is_sign(c)) else {
        return Some(WrittenTolerance { plus: first, minus: first });
    };
    let (second, end) = leading(&rest[next..])?;
    let second_is_minus = is_minus(&rest[..next]);
    if !end.trim_matches(is_sign).is_empty() || first_is_minus == second_is_minus {
        return None;
    }
    let [plus, minus] = if first_is_minus { [second, first] } else { [first, second] };
    Some(WrittenTolerance { plus, minus })
}

/// Reads number and unit. `None` if no number begins there, or one that can be read in two ways, as `1,000`.
pub fn leading(text: &str) -> Option<(Written, &str)> {
    let (value, is_fraction, rest) = number(text)?;
    let (unit, rest) = unit(rest);
    Some((Written { value, unit, is_fraction }, rest))
}

fn number(text: &str) -> Option<(f64, bool, &str)> {
    if let Some((share, rest)) = vulgar(text) {
        return Some((share, true, rest));
    }
    let (whole, rest) = digits(text);
    if let Some(decimals) = rest.strip_prefix(['.', ',']) {
        let (part, after) = digits(decimals);
        if !part.is_empty() {
            let is_thousand = rest.starts_with(',') && part.len() == 3;
            let goes_on = after.strip_prefix(['.', ',', '/']).is_some_and(|more| !digits(more).0.is_empty());
            let value = format!("{whole}.{part}").parse().ok()?;
            return (!is_thousand && !goes_on).then_some((value, false, after));
        }
    }
    let value: f64 = whole.parse().ok()?;
    if let Some((share, after)) = fraction(whole, rest) {
        return Some((share, true, after));
    }
    // A fraction may follow after a space or a hyphen.
    let after = rest.trim_start();
    let after =
        after.strip_prefix(['-', '\u{2010}', '\u{2011}']).filter(|_| after.len() == rest.len()).unwrap_or(after);
    if let Some((share, rest)) = vulgar(after) {
        return Some((value + share, true, rest));
    }
    let (top, bottom) = digits(after);
    match fraction(top, bottom) {
        Some((share, rest)) if share < 1.0 => Some((value + share, true, rest)),
        _ => Some((value, false, rest)),
    }
}

fn digits(text: &str) -> (&str, &str) {
    text.split_at(text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()))
}

/// Reads on from the numerator `top`. The denominator is a power of two.
fn fraction<'t>(top: &str, rest: &'t str) -> Option<(f64, &'t str)> {
    let (bottom, rest) = digits(rest.strip_prefix(['/', '\u{2044}'])?);
    let (top, bottom): (u32, u32) = (top.parse().ok()?, bottom.parse().ok()?);
    let is_ruled = bottom.is_power_of_two() && (2..=FINEST).contains(&bottom);
    // A date such as 1/2/26 is no fraction.
    (is_ruled && !rest.starts_with('/')).then(|| (f64::from(top) / f64::from(bottom), rest))
}

fn vulgar(text: &str) -> Option<(f64, &str)> {
    let first = text.chars().next()?;
    let eighths = match first {
        '⅛' => 1,
        '¼' => 2,
        '⅜' => 3,
        '½' => 4,
        '⅝' => 5,
        '¾' => 6,
        '⅞' => 7,
        _ => return None,
    };
    Some((f64::from(eighths) / 8.0, &text[first.len_utf8()..]))
}

fn unit(text: &str) -> (Option<Unit>, &str) {
    let rest = text.trim_start();
    for (mark, unit) in [("\"", Unit::In), ("\u{201d}", Unit::In), ("\u{2033}", Unit::In), ("''", Unit::In)] {
        if let Some(rest) = rest.strip_prefix(mark) {
            return (Some(unit), rest);
        }
    }
    let end = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
    match unit_of_word(&rest[..end]) {
        Some(unit) => (Some(unit), rest[end..].strip_prefix('.').unwrap_or(&rest[end..])),
        None => (None, text),
    }
}

pub fn unit_of_word(word: &str) -> Option<Unit> {
    match word.to_lowercase().as_str() {
        "in" | "ins" | "inch" | "inches" | "zoll" | "pouces" | "pulgadas" | "pollici" => Some(Unit::In),
        "cm" | "cms" | "centimeter" | "centimeters" | "centimetre" | "centimetres" | "zentimeter" => Some(Unit::Cm),
        "mm" | "mms" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => Some(Unit::Mm),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_read_as_people_write_them() {
        let check = |cell: &str, expect: Option<(f64, Option<Unit>, bool)>| {
            let found = length(cell).map(|written| (written.value, written.unit, written.is_fraction));
            assert_eq!(found, expect, "{cell}");
        };
        let inch = Some(Unit::In);
        check("22.5", Some((22.5, None, false)));
        check("22,5", Some((22.5, None, false)));
        check(".5", Some((0.5, None, false)));
        check("22", Some((22.0, None, false)));
        check("22 1/2", Some((22.5, None, true)));
        check("22-1/2", Some((22.5, None, true)));
        check("22½\"", Some((22.5, inch, true)));
        check("22 ⅝ in.", Some((22.625, inch, true)));
        check("1/4\"", Some((0.25, inch, true)));
        check("3/16 inch", Some((0.1875, inch, true)));
        check("57 cm", Some((57.0, Some(Unit::Cm), false)));
        check("570mm", Some((570.0, Some(Unit::Mm), false)));
        for other in ["", "-", "tbd", "1/2/26", "1,000", "22 3/3", "1/7", "22 x 4", "#REF!", "5'", "1.5.2", "22 -"] {
            check(other, None);
        }
    }

    #[test]
    fn tolerances_are_read_one_way_and_both_ways() {
        let check = |cell: &str, expect: Option<[f64; 2]>| {
            let found = tolerance(cell).map(|found| [found.plus.value, found.minus.value]);
            assert_eq!(found, expect, "{cell}");
        };
        check("1/2", Some([0.5, 0.5]));
        check("+/- 1/4\"", Some([0.25, 0.25]));
        check("±0,5", Some([0.5, 0.5]));
        check("-1/4", Some([0.25, 0.25]));
        check("+1/2 -1/4", Some([0.5, 0.25]));
        check("+1/-0.5", Some([1.0, 0.5]));
        check("-1/4\" / +1/2\"", Some([0.5, 0.25]));
        check("+1 +2", None);
        check("2 %", None);
        check("", None);
    }

    proptest::proptest! {
        #![proptest_config(proptest::prelude::ProptestConfig::with_cases(512))]

        #[test]
        fn every_fraction_is_the_number_that_was_written(
            whole in 0..200_u32, top in 1..16_u32, between in 0..3_usize, mark in 0..4_usize,
        ) {
            let (mut top, mut bottom) = (top, 16);
            while top.is_multiple_of(2) {
                (top, bottom) = (top / 2, bottom / 2);
            }
            let expect = f64::from(whole) + f64::from(top) / f64::from(bottom);
            let between = [" ", "-", "  "][between];
            let before = if whole == 0 { String::new() } else { format!("{whole}{between}") };
            let mark = ["", "\"", " in", " inches"][mark];
            let found = length(&format!("{before}{top}/{bottom}{mark}")).expect("a length");
            proptest::prop_assert_eq!(found.value, expect);
            proptest::prop_assert_eq!(found.unit, (!mark.is_empty()).then_some(Unit::In));
            let decimal = length(&format!("{expect}")).expect("a length");
            proptest::prop_assert_eq!((decimal.value, decimal.is_fraction), (expect, false));
        }

        #[test]
        fn no_text_panics(text in "\\PC*") {
            let _ = (length(&text), tolerance(&text));
        }
    }
}
