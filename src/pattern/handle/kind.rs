//! Handles by name: definition of each, the point of measure that it changes, and the bounds within which it is cut.

use crate::pom::Point;

/// The amount is the change of the length that the variant names, m.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Handle {
    /// Half of the girth at the chest.
    Chest,
    /// Half of the waist, at the side seams.
    Waist,
    /// Half of the waist, at the darts.
    Darts,
    /// Half of the waist, at the seat seam.
    CentreBack,
    /// Half of the girth at the hip.
    Hip,
    /// Half of the lower edge.
    Hem,
    /// Half of the girth of a leg at the thigh, by its outseam.
    Thigh,
    /// Half of the girth of a leg at the knee.
    Knee,
    /// Half of the lower edge of a leg.
    LegOpening,
    /// Half of the girth of a leg at the fork, by its inseam.
    Fork,
    /// Prominence of the seat: the wedge at the seat line of the back legs.
    Seat,
    /// Prominence of the abdomen: the wedge in the front legs.
    Abdomen,
    /// Depth from waist to fork.
    Rise,
    /// Length of the seat seam in front.
    FrontRise,
    /// Length of the seat seam behind.
    BackRise,
    /// Length of the inseam.
    LegLength,
    /// Slope of the shoulder: the depth of the shoulder point.
    ShoulderSlope,
    /// Position of the shoulder seam: that of the shoulder point.
    ForwardShoulder,
    ShoulderLength,
    /// Half of the width across the front.
    FrontWidth,
    /// Half of the width across the back.
    BackWidth,
    /// Roundness of the upper back: the length of the centre back above the blades.
    UpperBack,
    /// Fullness of the bust: the width of half a front at the chest.
    Bust,
    /// Length of the back bodice at its centre.
    SwayBack,
    FrontNeckDepth,
    BackNeckDepth,
    NeckWidth,
    ArmholeDepth,
    /// Half of the girth of the sleeve at the bicep.
    Bicep,
    /// Half of the lower edge of the sleeve.
    Cuff,
    CapHeight,
    SleeveLength,
    BodyLength,
    /// Length of the front at its centre.
    FrontLength,
    /// Length of the back at its centre.
    BackLength,
    SkirtLength,
}

struct Entry {
    name: &'static str,
    most_mm: f64,
    is_half_girth: bool,
    /// Effect of a positive amount.
    definition: &'static str,
}

impl Handle {
    pub const ALL: [Self; 36] = [
        Self::Chest,
        Self::Waist,
        Self::Darts,
        Self::CentreBack,
        Self::Hip,
        Self::Hem,
        Self::Thigh,
        Self::Knee,
        Self::LegOpening,
        Self::Fork,
        Self::Seat,
        Self::Abdomen,
        Self::Rise,
        Self::FrontRise,
        Self::BackRise,
        Self::LegLength,
        Self::ShoulderSlope,
        Self::ForwardShoulder,
        Self::ShoulderLength,
        Self::FrontWidth,
        Self::BackWidth,
        Self::UpperBack,
        Self::Bust,
        Self::SwayBack,
        Self::FrontNeckDepth,
        Self::BackNeckDepth,
        Self::NeckWidth,
        Self::ArmholeDepth,
        Self::Bicep,
        Self::Cuff,
        Self::CapHeight,
        Self::SleeveLength,
        Self::BodyLength,
        Self::FrontLength,
        Self::BackLength,
        Self::SkirtLength,
    ];

    #[rustfmt::skip]
    const fn entry(self) -> Entry {
        let (name, most_mm, is_half_girth, definition) = match self {
            Self::Chest => ("chest", 20.0, true,
                "half of the girth 25 mm below the armhole wider: both side seams out from there up to the underarm \
                 points; armholes lengthen below their middle and sleeves follow at the underarm"),
            Self::Waist => ("waist", 20.0, true,
                "half of the waist wider: side seams or outseams out there; of a dress bodice and skirt alike; a \
                 waistband follows"),
            Self::Darts => ("darts", 20.0, true,
                "half of the waist wider: darts on it smaller, all by the same; a waistband follows"),
            Self::CentreBack => ("centre_back", 15.0, true,
                "half of the waist wider: the seat seam out behind at its upper end, and not at the hip; a waistband \
                 follows"),
            Self::Hip => ("hip", 20.0, true,
                "half of the girth at the hip wider: side seams or outseams out there"),
            Self::Hem => ("hem", 30.0, true,
                "half of the lower edge wider: both side seams out there"),
            Self::Thigh => ("thigh", 15.0, true,
                "half of the leg 25 mm below the fork wider: outseams out there"),
            Self::Knee => ("knee", 15.0, true,
                "half of the leg at the knee wider: inseams and outseams out there"),
            Self::LegOpening => ("leg_opening", 30.0, true,
                "half of the leg's lower edge wider: inseams and outseams out there"),
            Self::Fork => ("fork", 15.0, true,
                "half of the leg at the fork wider: forks of front and back out, inseams with them down to the thigh; \
                 the seat seams lengthen by it"),
            Self::Seat => ("seat", 25.0, false,
                "a wedge opened at the hip line of the back legs, full at the seat seam, to nothing at the outseam; \
                 the back fork out by half of it"),
            Self::Abdomen => ("abdomen", 20.0, false,
                "a wedge opened in the front legs half-way from hip to waist, full at the front seat seam, to nothing \
                 at the outseam"),
            Self::Rise => ("rise", 25.0, false,
                "front and back legs longer between waist and hip, level all round"),
            Self::FrontRise => ("front_rise", 25.0, false,
                "upper edge of legs or skirt higher at the centre front, as before at the sides, and as long"),
            Self::BackRise => ("back_rise", 25.0, false,
                "upper edge of legs or skirt higher at the centre back, as before at the sides, and as long"),
            Self::LegLength => ("leg_length", 80.0, false,
                "inseam longer: legs lengthen evenly between fork and lower edge, outseams with them"),
            Self::ShoulderSlope => ("shoulder_slope", 15.0, false,
                "shoulder points lower, front and back: the shoulder keeps its length, the armhole keeps its own and \
                 sinks with it"),
            Self::ForwardShoulder => ("forward_shoulder", 12.0, false,
                "front shoulder points lower and back ones as much higher; shoulder and armhole keep their lengths"),
            Self::ShoulderLength => ("shoulder_length", 15.0, false,
                "shoulder longer: shoulder points outwards along it; the armhole keeps its length"),
            Self::FrontWidth => ("front_width", 15.0, false,
                "front armholes out at half their height; sleeves follow at the underarm"),
            Self::BackWidth => ("back_width", 15.0, false,
                "back armholes out at half their height; sleeves follow at the underarm"),
            Self::UpperBack => ("upper_back", 20.0, false,
                "back neckline higher at its centre and, less, at the shoulders; neckline and shoulder keep their \
                 lengths, the armhole stays"),
            Self::Bust => ("bust", 25.0, false,
                "front alone wider at the chest by as much at each side, and longer in its middle; its armholes keep \
                 their lengths"),
            Self::SwayBack => ("sway_back", 20.0, false,
                "back bodice longer at its centre: the waist seam falls there, and not at the side seams"),
            Self::FrontNeckDepth => ("front_neck_depth", 30.0, false,
                "neckline lower at centre front"),
            Self::BackNeckDepth => ("back_neck_depth", 15.0, false,
                "neckline lower at centre back"),
            Self::NeckWidth => ("neck_width", 20.0, false,
                "neck wider: high points of the shoulder outwards along it, each by half; the shoulder shortens"),
            Self::ArmholeDepth => ("armhole_depth", 15.0, false,
                "underarm points lower along the side seam; the sleeve's underarm points as far down the arm, and \
                 across it until the cap fits"),
            Self::Bicep => ("bicep", 20.0, true,
                "half of the sleeve 25 mm below the armhole wider: its underarm points out, and up until the cap is \
                 as long as before"),
            Self::Cuff => ("cuff", 20.0, true,
                "half of the sleeve's lower edge wider: the underarm seam out there"),
            Self::CapHeight => ("cap_height", 15.0, false,
                "cap higher: the sleeve's underarm points down the arm, and inwards until the cap is as long as \
                 before"),
            Self::SleeveLength => ("sleeve_length", 60.0, false,
                "sleeve longer, evenly between underarm and lower edge"),
            Self::BodyLength => ("body_length", 60.0, false,
                "front and back longer: slashed straight across below the armhole, side seams with them"),
            Self::FrontLength => ("front_length", 20.0, false,
                "front longer in its middle: the lower edge falls between the high points of the shoulder, and not at \
                 the side seams"),
            Self::BackLength => ("back_length", 20.0, false,
                "back longer in its middle: the lower edge falls between the high points of the shoulder, and not at \
                 the side seams"),
            Self::SkirtLength => ("skirt_length", 80.0, false,
                "skirt longer: slashed straight across below the hip, side seams with it"),
        };
        Entry { name, most_mm, is_half_girth, definition }
    }

    pub const fn as_str(self) -> &'static str {
        self.entry().name
    }

    pub const fn definition(self) -> &'static str {
        self.entry().definition
    }

    /// Greatest amount either way that is cut without drawing the pattern anew: of a girth 20 mm at a seam [Liechty10,
    /// Armstrong10]; of what is no seam of the trunk, that of a neighbouring size.
    pub const fn most_mm(self) -> f64 {
        self.entry().most_mm
    }

    /// The girth changes by twice the amount.
    pub const fn is_half_girth(self) -> bool {
        self.entry().is_half_girth
    }

    /// True if no girth tells it: it is no remedy for a girth by itself.
    pub const fn is_for_figure(self) -> bool {
        use Handle::*;
        matches!(
            self,
            Seat | Abdomen
                | Rise
                | FrontRise
                | BackRise
                | ShoulderSlope
                | ForwardShoulder
                | FrontWidth
                | BackWidth
                | UpperBack
                | Bust
                | SwayBack
                | FrontLength
                | BackLength
                | ArmholeDepth
        )
    }

    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|handle| handle.as_str() == name)
    }

    /// Point of measure that changes by exactly the amount.
    pub const fn changes(self) -> Option<Point> {
        Some(match self {
            Self::Chest => Point::HalfChest,
            Self::Waist | Self::Darts | Self::CentreBack => Point::HalfWaist,
            Self::Hip => Point::HalfHip,
            Self::Hem => Point::HalfHem,
            Self::Thigh => Point::HalfThigh,
            Self::Knee => Point::HalfKnee,
            Self::LegOpening => Point::HalfLegOpening,
            Self::FrontRise => Point::FrontRise,
            Self::BackRise => Point::BackRise,
            Self::LegLength => Point::Inseam,
            Self::ShoulderLength => Point::Shoulder,
            Self::FrontNeckDepth => Point::FrontNeckDrop,
            Self::BackNeckDepth => Point::BackNeckDrop,
            Self::NeckWidth => Point::NeckWidth,
            Self::Bicep => Point::HalfBicep,
            Self::Cuff => Point::HalfCuff,
            Self::SleeveLength => Point::SleeveLength,
            Self::BodyLength | Self::SkirtLength => Point::CentreBackLength,
            _ => return None,
        })
    }
}
