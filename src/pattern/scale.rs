//! Check of the unit by the size of the pieces: in a wrong unit they would fit a doll or a giant.

use super::dxf::Unit;
use geom::V2;

/// Accepted length of the longest piece of a garment. A collar alone has 0.3, the train of a wedding dress 4.
const WORN_M: std::ops::RangeInclusive<f64> = 0.08..=6.0;
/// Length of the longest piece of most garments.
const USUAL_M: std::ops::RangeInclusive<f64> = 0.2..=3.0;

/// Length over width from which a piece is a strip. A ruffle of 10 m or a binding says nothing about the unit, since it
/// is gathered or goes round; legs of trousers have less.
const STRIP: f64 = 4.0;

/// Length of the longest piece that says something about the unit: the greatest side of its bounding box. Strips count
/// only where there is nothing else. 0 without an outline.
pub fn longest_m<'a>(outlines: impl Iterator<Item = &'a [V2]>) -> f64 {
    let (mut longest, mut longest_strip) = (0.0_f64, 0.0_f64);
    for outline in outlines.filter(|outline| !outline.is_empty()) {
        let low = outline.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
        let high = outline.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
        let (length, width) = ((high - low).max(), (high - low).min());
        let kind = if length < STRIP * width { &mut longest } else { &mut longest_strip };
        *kind = kind.max(length);
    }
    if longest > 0.0 { longest } else { longest_strip }
}

/// `None` if a person could wear a garment whose longest piece has this length. Names the units that would fit.
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

fn rounded(length_m: f64) -> String {
    if length_m >= 10.0 { format!("{length_m:.0}") } else { format!("{length_m:.2}") }
}

/// Accepted length of the longest piece, and the option that sets the unit, for messages.
pub const ACCEPTED: &str = "0.08 to 6 m for a person; say the unit with --unit mm, cm, in or m";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_say_nothing_of_the_unit_beside_other_pieces() {
        let piece = |length: f64, width: f64| {
            [V2::new(0.0, 0.0), V2::new(length, 0.0), V2::new(length, width), V2::new(0.0, width)]
        };
        let check = |pieces: &[[V2; 4]], expect: f64| {
            assert_eq!(longest_m(pieces.iter().map(|outline| &outline[..])), expect);
        };
        check(&[piece(0.7, 0.5), piece(0.2, 9.85)], 0.7);
        check(&[piece(0.2, 9.85)], 9.85);
        check(&[piece(7.0, 5.0), piece(9.0, 0.5)], 7.0);
        check(&[], 0.0);
    }

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
