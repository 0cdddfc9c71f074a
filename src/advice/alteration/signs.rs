//! Signs that a fitter reads off a drape, with their likely causes and the handles for them [Liechty10, Armstrong10].

use serde::Serialize;

use crate::alteration::readings::Readings;
use geom::units::mm;
use pattern::{Handle, Style};

/// One side of a reading, beyond which it is a sign.
struct Sign {
    reading: &'static str,
    /// Value in the unit of the reading beyond which it is a sign: above, or below where it is negative.
    beyond: f64,
    words: &'static str,
    cause: &'static str,
    handles: &'static [Handle],
}

/// Difference of heights of an edge that the eye sees on a standing figure: 20 mm over half a girth is a slope of 3
/// degrees, as is that of a side seam.
const SLANT_MM: f64 = 20.0;
const LEAN_DEG: f64 = 3.0;
/// Distance from the skin at which the end of a shoulder seam no longer rests on it: cloth, and a layer below it.
const OFF_MM: f64 = 12.0;

const SIGNS: [Sign; 8] = {
    use Handle::*;
    [
        sign(
            "hem_front_over_back",
            SLANT_MM,
            "hem rises in front",
            "full bust or prominent abdomen",
            &[Bust, Abdomen, FrontLength, FrontRise],
        ),
        sign(
            "hem_front_over_back",
            -SLANT_MM,
            "hem rises behind",
            "round back or prominent seat",
            &[UpperBack, Seat, BackLength],
        ),
        sign("waist_front_over_back", SLANT_MM, "waist pulled down behind", "prominent seat", &[Seat, BackRise]),
        sign(
            "waist_front_over_back",
            -SLANT_MM,
            "waist pulled down in front",
            "prominent abdomen",
            &[Abdomen, FrontRise],
        ),
        sign(
            "side_seam_lean_right",
            LEAN_DEG,
            "side seam swings forward",
            "full bust or prominent abdomen",
            &[Bust, Abdomen, FrontLength],
        ),
        sign(
            "side_seam_lean_right",
            -LEAN_DEG,
            "side seam swings back",
            "round back or prominent seat",
            &[UpperBack, Seat, BackLength],
        ),
        sign("off_shoulder_point", OFF_MM, "shoulder stands off at its tip", "sloping shoulders", &[ShoulderSlope]),
        sign("off_neck_side", OFF_MM, "shoulder stands off at the neck", "square shoulders", &[ShoulderSlope]),
    ]
};

const fn sign(
    reading: &'static str,
    beyond: f64,
    words: &'static str,
    cause: &'static str,
    handles: &'static [Handle],
) -> Sign {
    Sign { reading, beyond, words, cause, handles }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SignRead {
    pub sign: &'static str,
    pub reading: &'static str,
    /// Value of the reading, less that which the pattern is drawn with.
    pub value: f64,
    pub unit: &'static str,
    /// Magnitude of the reading beyond which it is a sign.
    pub beyond: f64,
    pub cause: &'static str,
    pub handles: Vec<&'static str>,
}

/// An edge that is drawn lower behind, as that of trousers, is no sign.
pub fn read(readings: &Readings, style: &Style) -> Vec<SignRead> {
    let lines = style.hang_lines();
    let drawn_mm = |reading: &str| match reading {
        "hem_front_over_back" => mm(lines.drawn_hem_m),
        "waist_front_over_back" => mm(lines.drawn_waist_m),
        _ => 0.0,
    };
    beyond(readings, drawn_mm, &style.handles())
}

/// Signs of readings less what the pattern is drawn with, for a style with the handles `known`.
fn beyond(readings: &Readings, drawn_mm: impl Fn(&str) -> f64, known: &[Handle]) -> Vec<SignRead> {
    let seen = |sign: &Sign| {
        let reading = readings.get(sign.reading)?;
        let value = reading.value - drawn_mm(sign.reading);
        let is_beyond = value * sign.beyond.signum() > sign.beyond.abs();
        let own = sign.handles.iter().filter(|handle| known.contains(handle)).map(|handle| handle.as_str());
        is_beyond.then(|| SignRead {
            sign: sign.words,
            reading: sign.reading,
            value,
            unit: reading.unit,
            beyond: sign.beyond.abs(),
            cause: sign.cause,
            handles: own.collect(),
        })
    };
    SIGNS.iter().filter_map(seen).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::alteration::readings::Reading;

    #[test]
    fn what_lies_beyond_is_a_sign_with_the_handles_that_there_are() {
        let known = [Handle::FrontLength, Handle::BackLength, Handle::ShoulderSlope];
        let check = |name: &str, value: f64, unit: &'static str, expect: &[(&str, &[&str])]| {
            let readings = Readings::from([(name.to_owned(), Reading { value, unit })]);
            let found = beyond(&readings, |reading| if reading.starts_with("waist") { -60.0 } else { 0.0 }, &known);
            let found: Vec<(&str, &[&str])> = found.iter().map(|one| (one.sign, one.handles.as_slice())).collect();
            assert_eq!(found, expect, "{name} {value}");
        };
        check("hem_front_over_back", 24.0, "mm", &[("hem rises in front", &["front_length"])]);
        check("hem_front_over_back", -24.0, "mm", &[("hem rises behind", &["back_length"])]);
        check("hem_front_over_back", 19.0, "mm", &[]);
        check("waist_front_over_back", -79.0, "mm", &[]);
        check("waist_front_over_back", -81.0, "mm", &[("waist pulled down in front", &[])]);
        check("off_neck_side", 13.0, "mm", &[("shoulder stands off at the neck", &["shoulder_slope"])]);
        check("off_neck_side", -3.0, "mm", &[]);
        check("side_seam_lean_right", -3.5, "deg", &[("side seam swings back", &["back_length"])]);
    }
}
