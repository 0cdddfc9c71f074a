//! Points of measure of one's own: a girth or a width at a distance from a part of the garment, as buyers define them.

use std::fmt;
use std::str::FromStr;

use super::anatomy::{Anatomy, Part};
use super::{Garb, Point, skirt};
use crate::propose::Face;
use crate::style::{PathPart, Style};
use geom::units::{from_mm, mm};

/// Part of the garment from which the place of a point is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum OwnKind {
    /// Along the side seam.
    HalfBelowArmhole,
    /// Straight down the front.
    HalfBelowHps,
    /// Along the side seam.
    HalfAboveHem,
    HalfBelowWaist,
    HalfAboveFork,
    /// Along the inseam.
    HalfBelowFork,
    /// Along the underarm seam.
    SleeveBelowArmhole,
    /// Along the sleeve.
    SleeveAboveCuff,
    /// Between the armholes, below the high point of the shoulder.
    AcrossFront,
    /// Between the armholes, below the high point of the shoulder.
    AcrossBack,
}

impl OwnKind {
    pub const ALL: [(Self, &'static str); 10] = [
        (Self::HalfBelowArmhole, "half_below_armhole"),
        (Self::HalfBelowHps, "half_below_hps"),
        (Self::HalfAboveHem, "half_above_hem"),
        (Self::HalfBelowWaist, "half_below_waist"),
        (Self::HalfAboveFork, "half_above_fork"),
        (Self::HalfBelowFork, "half_below_fork"),
        (Self::SleeveBelowArmhole, "half_sleeve_below_armhole"),
        (Self::SleeveAboveCuff, "half_sleeve_above_cuff"),
        (Self::AcrossFront, "across_front_below_hps"),
        (Self::AcrossBack, "across_back_below_hps"),
    ];
}

const MOST_MM: f64 = 2000.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    Point(Point),
    Own { kind: OwnKind, at_m: f64 },
}

impl Measure {
    pub fn is_half(self) -> bool {
        match self {
            Self::Point(point) => point.as_str().starts_with("half"),
            Self::Own { kind, .. } => !matches!(kind, OwnKind::AcrossFront | OwnKind::AcrossBack),
        }
    }

    /// True if the length goes all round, and is often specified as half of that.
    pub fn is_round(self) -> bool {
        matches!(self, Self::Point(Point::Armhole | Point::Neck))
    }
}

impl fmt::Display for Measure {
    /// Name in tables and SQL: `half_chest`, or `half_below_armhole@100` with the distance in mm.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Point(point) => f.write_str(point.as_str()),
            Self::Own { kind, at_m } => {
                let name = OwnKind::ALL.iter().find(|(known, _)| known == kind).map_or("", |(_, name)| *name);
                write!(f, "{name}@{}", (mm(*at_m) * 10.0).round() / 10.0)
            }
        }
    }
}

impl FromStr for Measure {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, at) = text.split_once('@').map_or((text, None), |(name, at)| (name, Some(at)));
        let name = name.trim();
        if let Some(at) = at {
            let kind = OwnKind::ALL.iter().find(|(_, known)| name.eq_ignore_ascii_case(known)).map(|(kind, _)| *kind);
            let at_mm = at.trim().parse::<f64>().ok().filter(|at_mm| (0.0..=MOST_MM).contains(at_mm));
            let own = kind.zip(at_mm).map(|(kind, at_mm)| Self::Own { kind, at_m: from_mm(at_mm) });
            let names = || OwnKind::ALL.iter().map(|(_, name)| *name).collect::<Vec<_>>().join(", ");
            return own.ok_or_else(|| format!("a distance of 0 to {MOST_MM} mm from one of {}", names()));
        }
        let point = Point::ALL.into_iter().find(|point| name.eq_ignore_ascii_case(point.as_str()));
        let names = || Point::ALL.map(Point::as_str).join(", ");
        point.map(Self::Point).ok_or_else(|| format!("{}; or a distance, such as half_below_armhole@100", names()))
    }
}

impl Style {
    /// Lengths of the flat pieces, m. `None` for a length that the style does not have.
    pub fn lengths_of(&self, measures: &[Measure]) -> Vec<Option<f64>> {
        let anatomy = Anatomy::of(self);
        let garb = Garb::of(&anatomy);
        let points = garb.points();
        let length = |measure: &Measure| match measure {
            Measure::Point(point) => points.iter().find(|found| found.point == *point).map(|found| found.length_m),
            Measure::Own { kind, at_m } => garb.own_m(*kind, *at_m),
        };
        measures.iter().map(length).collect()
    }
}

impl Garb<'_> {
    fn own_m(&self, kind: OwnKind, at_m: f64) -> Option<f64> {
        let anatomy = self.anatomy;
        let half = |path: Vec<PathPart>| 0.5 * anatomy.style().path_length_m(&path);
        match kind {
            OwnKind::HalfBelowArmhole => self.trunk.as_ref()?.round_below_armhole(at_m).map(half),
            OwnKind::HalfBelowHps => self.trunk.as_ref()?.round_below_neck(at_m).map(half),
            OwnKind::HalfAboveHem => self.above_hem(at_m).map(half),
            OwnKind::HalfBelowWaist => self.below_waist(at_m).map(half),
            OwnKind::HalfAboveFork => self.legs.as_ref()?.round(at_m).map(half),
            OwnKind::HalfBelowFork => self.legs.as_ref()?.round_below_fork(at_m).map(half),
            OwnKind::SleeveBelowArmhole => self.sleeve.as_ref()?.round_below_armhole(at_m).map(half),
            OwnKind::SleeveAboveCuff => self.sleeve.as_ref()?.round_above_cuff(at_m).map(half),
            OwnKind::AcrossFront => self.trunk.as_ref()?.across_below_neck_m(Face::Front, at_m),
            OwnKind::AcrossBack => self.trunk.as_ref()?.across_below_neck_m(Face::Back, at_m),
        }
    }

    /// Path round the body above the lower edge of a trunk or a skirt, along the side seam. `None` if the seam ends at
    /// something that is sewn on.
    fn above_hem(&self, at_m: f64) -> Option<Vec<PathPart>> {
        let anatomy = self.anatomy;
        let of_skirt = skirt::side_seams(anatomy).into_iter().next().map(|[front, _]| front);
        let side = of_skirt.or_else(|| self.trunk.as_ref()?.sides.first().map(|[front, _]| front.clone()))?;
        let below = anatomy.style().over_corner(*side.last()?);
        if !anatomy.ways.is_free(below.edge) {
            return None;
        }
        let length_m: f64 = side.iter().map(|step| anatomy.length_m(&[step.edge])).sum();
        anatomy.ways.round(anatomy.along(&side, length_m - at_m)?)
    }

    /// Path round the body below the upper edge of trousers, or of a skirt along its side seam.
    fn below_waist(&self, at_m: f64) -> Option<Vec<PathPart>> {
        let anatomy = self.anatomy;
        if let Some(legs) = &self.legs {
            return legs.round(legs.top_above_fork_m() - at_m);
        }
        if anatomy.parts.iter().any(|part| matches!(part, Part::Trunk(_))) {
            return None;
        }
        let [side, _] = skirt::side_seams(anatomy).into_iter().next()?;
        // With a band, the upper edge is that of the band.
        let above = anatomy.style().over_corner(side.first()?.other());
        anatomy.ways.is_free(above.edge).then_some(())?;
        anatomy.ways.round(anatomy.along(&side, at_m)?)
    }
}
