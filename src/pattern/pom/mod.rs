//! Points of measure (POM): the lengths by which a garment is specified and checked, located on its pieces.
//!
//! They are measured on the flat pieces [ISO 18890]. No seam file names them: `anatomy` identifies seams and openings
//! by the roles of the pieces, and `top`, `sleeve`, `legs` and `skirt` find each point. `ways` makes straight paths
//! across pieces and through their seams.

pub(crate) mod anatomy;
mod body_levels;
mod hang;
pub(crate) mod legs;
mod own;
pub(crate) mod skirt;
mod sleeve;
#[cfg(test)]
mod tests;
pub(crate) mod top;
pub(crate) mod ways;

use self::anatomy::Anatomy;
pub use self::body_levels::{Stand, WornLength};
pub use self::hang::HangLines;
use self::legs::Legs;
pub use self::own::{Measure, OwnKind};
use self::sleeve::Sleeve;
use self::top::Trunk;
use super::style::{PathPart, Style};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Point {
    HalfChest,
    HalfWaist,
    HalfHip,
    HalfHem,
    FrontLength,
    BackLength,
    CentreFrontLength,
    CentreBackLength,
    AcrossFront,
    AcrossBack,
    AcrossShoulder,
    Shoulder,
    Armhole,
    SleeveLength,
    HalfBicep,
    HalfCuff,
    NeckWidth,
    FrontNeckDrop,
    BackNeckDrop,
    Neck,
    FrontRise,
    BackRise,
    Inseam,
    Outseam,
    HalfThigh,
    HalfKnee,
    HalfLegOpening,
}

impl Point {
    /// All points, in the order of a specification sheet.
    pub const ALL: [Self; 27] = [
        Self::HalfChest,
        Self::HalfWaist,
        Self::HalfHip,
        Self::HalfHem,
        Self::FrontLength,
        Self::BackLength,
        Self::CentreFrontLength,
        Self::CentreBackLength,
        Self::AcrossFront,
        Self::AcrossBack,
        Self::AcrossShoulder,
        Self::Shoulder,
        Self::Armhole,
        Self::SleeveLength,
        Self::HalfBicep,
        Self::HalfCuff,
        Self::NeckWidth,
        Self::FrontNeckDrop,
        Self::BackNeckDrop,
        Self::Neck,
        Self::FrontRise,
        Self::BackRise,
        Self::Inseam,
        Self::Outseam,
        Self::HalfThigh,
        Self::HalfKnee,
        Self::HalfLegOpening,
    ];

    const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::HalfChest => ("half_chest", "half of the girth 25 mm below the armhole, along the side seam"),
            Self::HalfWaist => (
                "half_waist",
                "half of the waist: the upper edge of trousers and skirts, relaxed; the waist seam; of other tops the narrowest \
                 girth below the armhole, or 180 mm below it where the sides are straight",
            ),
            Self::HalfHip => (
                "half_hip",
                "half of the girth 80 mm above the fork of trousers, 200 mm below the waist of skirts and dresses",
            ),
            Self::HalfHem => ("half_hem", "half of the lower edge, along the edge"),
            Self::FrontLength => {
                ("front_length", "from the high point of the shoulder straight down the front to the hem")
            }
            Self::BackLength => {
                ("back_length", "from the high point of the shoulder straight down the back to the hem")
            }
            Self::CentreFrontLength => (
                "centre_front_length",
                "along the centre of the front from the neck to the hem; of skirts from the waist, without a waistband",
            ),
            Self::CentreBackLength => (
                "centre_back_length",
                "along the centre of the back from the neck to the hem; of skirts from the waist, without a waistband",
            ),
            Self::AcrossFront => ("across_front", "from armhole to armhole across the front, half-way up the armhole"),
            Self::AcrossBack => ("across_back", "from armhole to armhole across the back, half-way up the armhole"),
            Self::AcrossShoulder => ("across_shoulder", "from shoulder point to shoulder point across the back"),
            Self::Shoulder => ("shoulder", "along the shoulder seam from the neck to the armhole"),
            Self::Armhole => ("armhole", "all round the armhole, along its seam"),
            Self::SleeveLength => {
                ("sleeve_length", "from the shoulder point straight down the sleeve to its lower edge")
            }
            Self::HalfBicep => {
                ("half_bicep", "half of the sleeve's girth 25 mm below the armhole, along the underarm seam")
            }
            Self::HalfCuff => ("half_cuff", "half of the sleeve's lower edge, along the edge"),
            Self::NeckWidth => ("neck_width", "between the high points of the shoulder, straight"),
            Self::FrontNeckDrop => (
                "front_neck_drop",
                "from the level of the high point of the shoulder down to the neckline at centre front",
            ),
            Self::BackNeckDrop => (
                "back_neck_drop",
                "from the level of the high point of the shoulder down to the neckline at centre back",
            ),
            Self::Neck => ("neck", "all round the neckline, along its edge or seam"),
            Self::FrontRise => ("front_rise", "along the front seat seam from the fork to the upper edge"),
            Self::BackRise => ("back_rise", "along the back seat seam from the fork to the upper edge"),
            Self::Inseam => ("inseam", "along the inseam of the front from the fork to the hem"),
            Self::Outseam => ("outseam", "along the outseam of the front from the upper edge to the hem"),
            Self::HalfThigh => ("half_thigh", "half of the leg's girth 25 mm below the fork, along the inseam"),
            Self::HalfKnee => {
                ("half_knee", "half of the leg's girth 50 mm above the middle of the inseam; of long legs only")
            }
            Self::HalfLegOpening => ("half_leg_opening", "half of the leg's lower edge, along the edge"),
        }
    }

    /// Name in tables and SQL.
    pub const fn as_str(self) -> &'static str {
        self.words().0
    }

    pub const fn definition(self) -> &'static str {
        self.words().1
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct PointOfMeasure {
    pub point: Point,
    /// `share` of the length of the path. Plus the distance from the high point of the shoulder to the path, if the
    /// length is measured from there.
    pub length_m: f64,
    /// Path on the cloth. Empty for a distance through the air, such as the width of a neck.
    pub path: Vec<PathPart>,
    /// Share of the length of the path that counts: one half for a girth, because it is measured flat.
    pub share: f64,
}

impl Style {
    /// Points of measure that the roles of the pieces show, in the order of [`Point::ALL`].
    pub fn points_of_measure(&self) -> Vec<PointOfMeasure> {
        let anatomy = Anatomy::of(self);
        Garb::of(&anatomy).points()
    }
}

struct Garb<'a> {
    anatomy: &'a Anatomy<'a>,
    trunk: Option<Trunk<'a>>,
    sleeve: Option<Sleeve<'a>>,
    legs: Option<Legs<'a>>,
}

impl<'a> Garb<'a> {
    fn of(anatomy: &'a Anatomy<'a>) -> Self {
        let trunk = Trunk::of(anatomy);
        let sleeve = trunk.as_ref().and_then(|trunk| Sleeve::of(anatomy, &trunk.shoulder_points()));
        Self { anatomy, trunk, sleeve, legs: Legs::of_either(anatomy) }
    }

    /// All points of measure, in the order of [`Point::ALL`], each once.
    fn points(&self) -> Vec<PointOfMeasure> {
        let mut found = self.trunk.as_ref().map_or_else(Vec::new, Trunk::points);
        found.extend(self.sleeve.iter().flat_map(Sleeve::points));
        found.extend(self.legs.iter().flat_map(Legs::points));
        found.extend(skirt::points(self.anatomy));
        found.sort_by_key(|measure| measure.point);
        // A jumpsuit has the waist of its top.
        found.dedup_by_key(|measure| measure.point);
        found
    }
}
