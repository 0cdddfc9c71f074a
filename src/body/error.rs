//! Errors of making and measuring bodies.

use geom::units::mm;

/// Reason for which no body could be made or measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// A measurement is outside the range of adults.
    #[error("{name} = {value} {unit} is impossible; accepted: {least} to {greatest} {unit}")]
    OutOfRange {
        /// Key of the measurement.
        name: &'static str,
        /// Given value.
        value: f64,
        /// Least accepted value.
        least: f64,
        /// Greatest accepted value.
        greatest: f64,
        /// Unit of the numbers.
        unit: &'static str,
    },
    /// The mesh has no section at the height of a body part.
    #[error(
        "no {part} found at a height of {:.0} mm: is this a standing person, z up, with the feet on z = 0?",
        mm(*height_m)
    )]
    MissingPart {
        /// Name of the body part, such as `chest`.
        part: &'static str,
        /// Height that was searched, m.
        height_m: f64,
    },
    /// Two measurements do not occur together in an adult.
    #[error("{found} does not go with {with}: no adult has both; accepted with it: {least:.0} to {greatest:.0} {unit}")]
    Contradiction {
        /// One measurement, with its value.
        found: String,
        /// The other measurement, with its value.
        with: String,
        /// Least accepted value.
        least: f64,
        /// Greatest accepted value.
        greatest: f64,
        /// Unit of the numbers.
        unit: &'static str,
    },
    /// Measurements are each possible, but not together in one body.
    #[error("these measurements do not make one body ({reason}); accepted: girths that one adult has together")]
    Inconsistent {
        /// Part that cannot be formed, or measurement that is not reached.
        reason: String,
    },
    /// A figure that a body cannot have.
    #[error("figure `{figure}`: {problem}; accepted: {accepted}")]
    Figure {
        /// Figure as given.
        figure: String,
        /// Problem of its name, its amount or its body.
        problem: String,
        /// Content that would be accepted.
        accepted: String,
    },
    /// A file of measurements cannot be used.
    #[error("found {found}; accepted: {accepted}")]
    Measurements {
        /// Content that was found.
        found: String,
        /// Content that would be accepted.
        accepted: String,
    },
    /// A mesh file cannot be read.
    #[error("{format}, {place}: {problem}; accepted: OBJ, PLY, STL or GLB with triangles or polygons")]
    File {
        /// Format of the file.
        format: &'static str,
        /// Line, vertex or face of the error.
        place: String,
        /// Problem at that place.
        problem: String,
    },
    /// A picture is in a format that is not read.
    #[error("the {view} picture is {format}; accepted: JPEG or PNG")]
    PictureFormat {
        /// View: front or side.
        view: &'static str,
        /// Format of the picture.
        format: &'static str,
    },
    /// No body can be read from a picture.
    #[error(
        "the {view} picture cannot be used: {problem}; accepted: one standing person, arms off the trunk, wholly seen before a plain background"
    )]
    Picture {
        /// View: front or side.
        view: &'static str,
        /// Problem of the picture.
        problem: String,
    },
    /// The limbs cannot take a pose.
    #[error("no such pose: {problem}")]
    Pose {
        /// Refused angle or contact, and what is accepted.
        problem: String,
    },
    /// A surface does not bound a solid body.
    #[error("the surface does not close: {problem}; accepted: one whole body, its holes under 0.9 m round")]
    Open {
        /// Description of the opening.
        problem: String,
    },
    /// A scan lacks a foot.
    #[error(
        "a foot is missing, and a body that wears garments stands on both; accepted: a scan with its feet, or the girths that are read on \
         this one, given as measurements with the stature (--stature-mm)"
    )]
    Feet,
    /// A mesh has more than one body.
    #[error(
        "two pieces of a like size: several bodies, or halves that are not joined; accepted: one body in one piece"
    )]
    Several,
    /// The height of a mesh, in the given unit, is not that of an adult.
    #[error("the body is {} {unit} high, which is no adult; accepted: 1.2 to 2.4 m; is the unit right?", short(.extent))]
    WrongUnit {
        /// Height in the given unit.
        extent: f64,
        /// Symbol of the given unit.
        unit: &'static str,
    },
    /// The height of a mesh is that of an adult in none of the units.
    #[error(
        "the body is {} high, which is no adult in mm, cm, dm, m or inches; accepted: 1.2 to 2.4 m, or say the unit",
        short(.extent)
    )]
    Unit {
        /// Height in the file's unit.
        extent: f64,
    },
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
