//! Errors of making and measuring bodies.

use geom::units::mm;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    #[error("{name} = {value} {unit} is impossible; accepted: {least} to {greatest} {unit}")]
    OutOfRange { name: &'static str, value: f64, least: f64, greatest: f64, unit: &'static str },
    #[error(
        "no {part} found at a height of {:.0} mm: is this a standing person, z up, with the feet on z = 0?",
        mm(*height_m)
    )]
    MissingPart {
        /// Body part, such as `chest`.
        part: &'static str,
        height_m: f64,
    },
    #[error("{found} does not go with {with}: no adult has both; accepted with it: {least:.0} to {greatest:.0} {unit}")]
    Contradiction { found: String, with: String, least: f64, greatest: f64, unit: &'static str },
    #[error("these measurements do not make one body ({reason}); accepted: girths that one adult has together")]
    Inconsistent { reason: String },
    #[error("figure `{figure}`: {problem}; accepted: {accepted}")]
    Figure { figure: String, problem: String, accepted: String },
    #[error("found {found}; accepted: {accepted}")]
    Measurements { found: String, accepted: String },
    #[error("{format}, {place}: {problem}; accepted: OBJ, PLY, STL or GLB with triangles or polygons")]
    File { format: &'static str, place: String, problem: String },
    #[error("the {view} picture is {format}; accepted: JPEG or PNG")]
    PictureFormat {
        /// Front or side.
        view: &'static str,
        format: &'static str,
    },
    #[error(
        "the {view} picture cannot be used: {problem}; accepted: one standing person, arms off the trunk, wholly seen before a plain background"
    )]
    Picture {
        /// Front or side.
        view: &'static str,
        problem: String,
    },
    #[error("no such pose: {problem}")]
    Pose { problem: String },
    #[error("the surface does not close: {problem}; accepted: one whole body, its holes under 0.9 m round")]
    Open { problem: String },
    #[error(
        "a foot is missing, and a body that wears garments stands on both; accepted: a scan with its feet, or the girths that are read on \
         this one, given as measurements with the stature (--stature-mm)"
    )]
    Feet,
    #[error(
        "two pieces of a like size: several bodies, or halves that are not joined; accepted: one body in one piece"
    )]
    Several,
    #[error("the body is {} {unit} high, which is no adult; accepted: 1.2 to 2.4 m; is the unit right?", short(.extent))]
    WrongUnit { extent: f64, unit: &'static str },
    #[error(
        "the body is {} high, which is no adult in mm, cm, dm, m or inches; accepted: 1.2 to 2.4 m, or say the unit",
        short(.extent)
    )]
    Unit { extent: f64 },
}

/// Formats a length of unknown unit with five significant digits and at most four decimals.
fn short(length: &f64) -> String {
    let decimals = 4.0 - length.abs().max(1.0).log10().floor();
    format!("{length:.*}", decimals.clamp(0.0, 4.0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_told_in_few_digits() {
        let check = |length: f64, expect: &str| assert_eq!(short(&length), expect);
        check(1738.6642, "1738.7");
        check(173.86642, "173.87");
        check(1.7386642, "1.7387");
        check(0.0173866, "0.0174");
        check(1234567.8, "1234568");
        check(0.0, "0.0000");
    }
}
