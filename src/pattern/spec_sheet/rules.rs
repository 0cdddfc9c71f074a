//! Points of measure by the words of descriptions.
//!
//! A rule holds if a description has a word of each of its groups. It is sure if the description says nothing more: every
//! other word of it must be idle, or be one that the rule allows. So `chest pocket` is no chest, and `front rise excluding
//! waistband` no front rise.

use super::words::{Anchor, Place, Told};
use crate::dxf::Unit;
use crate::pom::{Measure, OwnKind, Point};
use geom::units::{from_mm, mm};

struct Rule {
    point: Point,
    /// One word of each group is needed.
    groups: &'static [&'static [&'static str]],
    /// Words that may be there too.
    allowed: &'static [&'static str],
}

const fn rule(point: Point, groups: &'static [&'static [&'static str]], allowed: &'static [&'static str]) -> Rule {
    Rule { point, groups, allowed }
}

/// Words that change nothing: a flat garment is measured relaxed, from edge to edge.
const IDLE: [&str; 17] = [
    "seam",
    "relaxed",
    "flat",
    "half",
    "circumference",
    "width",
    "opening",
    "body",
    "below",
    "above",
    "from",
    "down",
    "up",
    "natural",
    "mid",
    "curve",
    "centre",
];

/// If several hold, those with the most groups count.
const RULES: [Rule; 50] = [
    rule(Point::HalfChest, &[&["chest"]], &["armhole", "across"]),
    rule(Point::HalfChest, &[&["width"], &["armhole"]], &[]),
    rule(Point::HalfChest, &[&["body"], &["width"]], &[]),
    rule(Point::HalfWaist, &[&["waist"]], &["waistband", "straight"]),
    rule(Point::HalfWaist, &[&["waistband"], &["circumference", "opening", "length"]], &["straight"]),
    rule(Point::HalfHip, &[&["hip"]], &[]),
    rule(Point::HalfHem, &[&["hem"]], &["straight", "skirt"]),
    rule(Point::HalfLegOpening, &[&["hem"]], &["leg", "straight"]),
    rule(Point::HalfLegOpening, &[&["leg"], &["opening", "hem"]], &["straight"]),
    rule(Point::FrontLength, &[&["front"], &["length"]], &["hps", "hem"]),
    rule(Point::FrontLength, &[&["front"], &["hps"]], &["length", "hem"]),
    rule(Point::FrontLength, &[&["length"], &["hps"]], &["hem"]),
    rule(Point::FrontLength, &[&["body"], &["length"]], &["hps", "hem"]),
    rule(Point::BackLength, &[&["back"], &["length"]], &["hps", "hem"]),
    rule(Point::BackLength, &[&["back"], &["hps"]], &["length", "hem"]),
    rule(Point::BackLength, &[&["length"], &["hps"]], &["hem"]),
    rule(Point::BackLength, &[&["body"], &["length"]], &["hps", "hem"]),
    rule(Point::CentreFrontLength, &[&["cf"], &["length"]], &["neck", "hem", "waist", "front", "skirt"]),
    rule(Point::CentreFrontLength, &[&["front"], &["length"]], &["hem", "waist", "skirt"]),
    rule(Point::CentreFrontLength, &[&["body"], &["length"]], &["hem"]),
    rule(Point::CentreFrontLength, &[&["skirt"], &["length"]], &["hem", "waist"]),
    rule(Point::CentreBackLength, &[&["cb"], &["length"]], &["neck", "hem", "waist", "back", "skirt"]),
    rule(Point::CentreBackLength, &[&["back"], &["length"]], &["hem", "waist", "skirt", "neck"]),
    rule(Point::CentreBackLength, &[&["body"], &["length"]], &["hem"]),
    rule(Point::CentreBackLength, &[&["skirt"], &["length"]], &["hem", "waist"]),
    rule(Point::AcrossFront, &[&["across"], &["front", "chest"]], &["armhole", "front"]),
    rule(Point::AcrossFront, &[&["front"], &["width"]], &["armhole"]),
    rule(Point::AcrossBack, &[&["across"], &["back"]], &["armhole"]),
    rule(Point::AcrossBack, &[&["back"], &["width"]], &["armhole"]),
    rule(Point::AcrossShoulder, &[&["across"], &["shoulder"]], &["back"]),
    rule(Point::AcrossShoulder, &[&["shoulder"], &["width"]], &["back"]),
    rule(Point::AcrossShoulder, &[&["shoulder"]], &[]),
    rule(Point::Shoulder, &[&["shoulder"], &["length", "seam", "width"]], &["hps", "neck", "armhole"]),
    rule(Point::Shoulder, &[&["shoulder"]], &[]),
    rule(Point::Armhole, &[&["armhole"]], &[]),
    rule(Point::SleeveLength, &[&["sleeve"], &["length"]], &["hps", "shoulder", "hem", "cuff"]),
    rule(Point::HalfBicep, &[&["bicep"]], &["sleeve", "armhole"]),
    rule(Point::HalfBicep, &[&["sleeve"], &["width"]], &["armhole"]),
    rule(Point::HalfCuff, &[&["cuff"]], &["sleeve", "hem", "straight"]),
    rule(Point::HalfCuff, &[&["sleeve"], &["opening", "hem", "width"]], &["cuff", "straight"]),
    rule(Point::NeckWidth, &[&["neck"], &["width", "opening", "across"]], &["hps", "back", "shoulder"]),
    rule(Point::FrontNeckDrop, &[&["neck"], &["drop", "depth"]], &["hps", "front", "cf"]),
    rule(Point::BackNeckDrop, &[&["neck"], &["drop", "depth"]], &["hps", "back", "cb"]),
    rule(Point::Neck, &[&["neck"], &["circumference", "length", "opening", "seam", "curve"]], &[]),
    rule(Point::FrontRise, &[&["rise", "crotch"]], &["front", "cf", "length", "depth", "waistband", "waist", "crotch"]),
    rule(Point::BackRise, &[&["rise", "crotch"]], &["back", "cb", "length", "depth", "waistband", "waist", "crotch"]),
    rule(Point::Inseam, &[&["inseam"]], &["leg", "length", "crotch", "hem"]),
    rule(Point::Outseam, &[&["outseam"]], &["leg", "length", "waist", "waistband", "hem"]),
    rule(Point::HalfThigh, &[&["thigh"]], &["leg"]),
    rule(Point::HalfKnee, &[&["knee"]], &["leg"]),
];

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Meant {
    /// Points by all words, in the order of [`Point::ALL`].
    pub sure: Vec<Measure>,
    pub partly: Vec<Measure>,
}

/// `unit` is that of distances without one.
pub fn meant(told: &Told, unit: Unit) -> Meant {
    if let Some(place) = told.place {
        return at_place(told, place, unit);
    }
    let holds = |rule: &&Rule| rule.groups.iter().all(|group| group.iter().any(|word| told.has(word)));
    let is_sure = |rule: &&Rule| {
        let is_said = |word: &&str| rule.groups.iter().any(|group| group.contains(word));
        told.words.iter().all(|word| is_said(word) || IDLE.contains(word) || rule.allowed.contains(word))
    };
    let sure: Vec<&Rule> = RULES.iter().filter(holds).filter(is_sure).collect();
    let most = sure.iter().map(|rule| rule.groups.len()).max().unwrap_or_default();
    let points = |rules: &[&Rule]| {
        let mut points: Vec<Point> = rules.iter().map(|rule| rule.point).collect();
        points.sort_unstable();
        points.dedup();
        points.into_iter().map(Measure::Point).collect()
    };
    let best: Vec<&Rule> = sure.into_iter().filter(|rule| rule.groups.len() == most).collect();
    Meant { sure: points(&best), partly: points(&RULES.iter().filter(holds).collect::<Vec<_>>()) }
}

/// Point at a place.
struct Placed {
    anchor: Anchor,
    is_above: bool,
    /// Words of which one is needed.
    needs: &'static [&'static str],
    allowed: &'static [&'static str],
    kind: OwnKind,
    /// Point whose place is defined so, and its distance, mm.
    point: Option<(Point, f64)>,
}

/// Greatest difference of a distance from that of a defined point: an inch is 25 mm to those who measure.
const SAME_PLACE_MM: f64 = 2.0;
const GIRTHS: &[&str] = &["chest", "waist", "hip", "width", "hem", "circumference"];
const NAMES: &[&str] = &["chest", "waist", "hip", "high", "low", "upper", "skirt", "front", "back"];

const fn placed(
    anchor: Anchor,
    is_above: bool,
    needs: &'static [&'static str],
    allowed: &'static [&'static str],
    kind: OwnKind,
    point: Option<(Point, f64)>,
) -> Placed {
    Placed { anchor, is_above, needs, allowed, kind, point }
}

const CHEST: Option<(Point, f64)> = Some((Point::HalfChest, 25.0));
const BICEP: Option<(Point, f64)> = Some((Point::HalfBicep, 25.0));
const HIP: Option<(Point, f64)> = Some((Point::HalfHip, 80.0));
const THIGH: Option<(Point, f64)> = Some((Point::HalfThigh, 25.0));

/// First that fits counts.
const PLACES: [Placed; 12] = [
    placed(Anchor::Armhole, false, &["bicep"], &["sleeve"], OwnKind::SleeveBelowArmhole, BICEP),
    placed(Anchor::Armhole, false, &["sleeve"], &["width", "bicep"], OwnKind::SleeveBelowArmhole, BICEP),
    placed(
        Anchor::Armhole,
        false,
        &["chest", "waist", "width", "circumference", "hip"],
        &["across"],
        OwnKind::HalfBelowArmhole,
        CHEST,
    ),
    placed(Anchor::HighPoint, false, &["front"], &["across", "chest"], OwnKind::AcrossFront, None),
    placed(Anchor::HighPoint, false, &["back"], &["across"], OwnKind::AcrossBack, None),
    placed(Anchor::HighPoint, false, &["across"], &["chest"], OwnKind::AcrossFront, None),
    placed(
        Anchor::HighPoint,
        false,
        GIRTHS,
        &["chest", "waist", "hip", "high", "low", "upper"],
        OwnKind::HalfBelowHps,
        None,
    ),
    placed(Anchor::Hem, true, GIRTHS, &["chest", "waist", "hip", "skirt"], OwnKind::HalfAboveHem, None),
    placed(Anchor::Waist, false, &["hip", "width", "circumference"], NAMES, OwnKind::HalfBelowWaist, None),
    placed(Anchor::Crotch, true, &["hip", "width"], &["high", "low", "upper"], OwnKind::HalfAboveFork, HIP),
    placed(
        Anchor::Crotch,
        false,
        &["thigh", "knee", "leg", "width"],
        &["thigh", "knee", "leg", "calf"],
        OwnKind::HalfBelowFork,
        THIGH,
    ),
    placed(
        Anchor::Cuff,
        true,
        &["forearm", "sleeve", "elbow", "width"],
        &["forearm", "sleeve", "elbow"],
        OwnKind::SleeveAboveCuff,
        None,
    ),
];

fn at_place(told: &Told, place: Place, unit: Unit) -> Meant {
    let at_m = from_mm(place.distance * place.unit.unwrap_or(unit).mm_per_unit());
    let fits = |placed: &&Placed| {
        placed.anchor == place.anchor
            && placed.is_above == place.is_above
            && placed.needs.iter().any(|word| told.has(word))
    };
    let is_sure = |placed: &&Placed| {
        let is_said = |word: &&str| placed.needs.contains(word) || placed.allowed.contains(word);
        told.words.iter().all(|word| is_said(word) || IDLE.contains(word))
    };
    let measure = |placed: &Placed| match placed.point {
        Some((point, at_mm)) if (mm(at_m) - at_mm).abs() <= SAME_PLACE_MM => Measure::Point(point),
        _ => Measure::Own { kind: placed.kind, at_m },
    };
    let found: Vec<&Placed> = PLACES.iter().filter(fits).collect();
    let sure = found.iter().copied().find(is_sure).map(measure);
    Meant { sure: sure.into_iter().collect(), partly: found.into_iter().map(measure).collect() }
}

#[cfg(test)]
mod tests {
    use super::super::words;
    use super::*;

    #[test]
    fn a_description_means_what_all_its_words_say() {
        let check = |description: &str, expect: &[&str]| {
            let found = meant(&words::read(description), Unit::Cm).sure;
            let names: Vec<String> = found.iter().map(ToString::to_string).collect();
            assert_eq!(names, expect, "{description}");
        };
        check("Thigh", &["half_thigh"]);
        check("Thigh at crotch", &[]);
        check("Thigh 2.5 cm below crotch", &["half_thigh"]);
        check("Thigh 5 cm below crotch", &["half_below_fork@50"]);
        check("Sleeve length (shoulder to hem)", &["sleeve_length"]);
        check("Front rise excl. waistband", &[]);
        check("Rise", &["front_rise", "back_rise"]);
        check("Sleeve width", &["half_bicep", "half_cuff"]);
        check("Sleeve width 2.5 cm below armhole", &["half_bicep"]);
        check("Hip 18 cm below waistband", &[]);
        check("Seat, 20 cm below waist", &["half_below_waist@200"]);
        check("Width 10 cm up from bottom", &["half_above_hem@100"]);
        check("X-chest 13 cm below HPS", &["across_front_below_hps@130"]);
        check("Pocket placement from HPS", &[]);
    }
}
