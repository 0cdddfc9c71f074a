//! Check of the unit by the size of the pieces: in a wrong unit they would fit a doll or a giant.

use super::dxf::Unit;
use geom::V2;

/// Accepted length of the longest piece of a garment, m. A collar alone has 0.3, the train of a wedding dress 4.
const WORN_M: std::ops::RangeInclusive<f64> = 0.08..=6.0;
/// Length of the longest piece of most garments, m.
const USUAL_M: std::ops::RangeInclusive<f64> = 0.2..=3.0;

/// Greatest side of the bounding box of an outline, m.
#[must_use]
pub fn extent_m(outline: &[V2]) -> f64 {
    let low = outline.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
    let high = outline.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
    if outline.is_empty() { 0.0 } else { (high - low).max() }
}

/// Objection to a unit in which the longest piece is `longest_m` long, with the units that would fit. `None` if a
/// person could wear it.
#[must_use]
pub fn doubt(longest_m: f64, unit: Unit) -> Option<String> {
    if WORN_M.contains(&longest_m) {
        return None;
    }
    let per_number = longest_m / unit.mm_per_unit();
    let others = Unit::ALL.into_iter().filter(|other| *other != unit);
    let fitting = others.filter(|other| USUAL_M.contains(&(per_number * other.mm_per_unit())));
    let fitting: Vec<String> =
        fitting.map(|other| format!("{} m in {}", rounded(per_number * other.mm_per_unit()), other.as_str())).collect();
    let instead = if fitting.is_empty() { String::new() } else { format!("; it would be {}", fitting.join(", ")) };
    Some(format!("the longest piece is {} m long in {}{instead}", rounded(longest_m), unit.as_str()))
}

/// Formats a length, m, for messages.
fn rounded(length_m: f64) -> String {
    if length_m >= 10.0 { format!("{length_m:.0}") } else { format!("{length_m:.2}") }
}

/// Text for messages: the accepted length of the longest piece, and the option that sets the unit.
pub const ACCEPTED: &str = "0.08 to 6 m for a person; say the unit with --unit mm, cm, in or m";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_unit_is_told_with_those_that_would_do() {
        let check = |longest_m: f64, unit: Unit, expect: Option<&str>| {
            assert_eq!(doubt(longest_m, unit).as_deref(), expect, "{longest_m}");
        };
        check(0.71, Unit::Mm, None);
        let said = "the longest piece is 0.07 m long in mm; it would be 0.71 m in cm, 1.80 m in in";
        check(0.071, Unit::Mm, Some(said));
        check(18.0, Unit::In, Some("the longest piece is 18 m long in in; it would be 0.71 m in mm"));
        check(710.0, Unit::M, Some("the longest piece is 710 m long in m; it would be 0.71 m in mm"));
        check(4.0, Unit::Mm, None);
    }
}
