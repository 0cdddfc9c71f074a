//! Kind, face and side of panels by their place round the body, by the part that they cover and by their stitches.
//!
//! Programs that write GarmentCode place each panel about the body and label what it covers. That says more than names
//! such as `p1`, which may be anything. Names go first all the same: a panel called `skirt` is one.

use std::collections::{BTreeMap, BTreeSet};

use super::{Specification, Stitch};
use crate::trade::{Class, Face, Hand, Named};
use geom::{V2, V3};

/// Distance from the middle plane from which a panel lies in front or at the back.
const BEFORE_M: f64 = 0.02;
/// Component of the normal to the front below which a panel is turned to the side, as a hood is.
const TURNED: f64 = 0.7;
/// Distance of the middle from the plane of symmetry, over the width, up to which a panel covers both sides.
const BOTH_SIDES: f64 = 0.1;
/// Height over width up to which a panel from which a skirt hangs is a band. Bodices have 0.7 and more.
const BAND: f64 = 0.65;
/// Distance of a seam above the middle, over the height, from which it is an upper edge.
const UPPER: f64 = 0.25;
/// Greatest bounding box of a collar over that of the panel that it stands on.
const SMALLER: f64 = 0.6;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// `body`.
    Trunk,
    Arm,
    /// `leg`, and skirts.
    Leg,
}

impl Part {
    pub fn of_label(label: &str) -> Option<Self> {
        match label {
            "body" => Some(Self::Trunk),
            "arm" => Some(Self::Arm),
            "leg" => Some(Self::Leg),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Of the bounding box: to the wearer's left, up, to the front, m.
    pub middle: V3,
    /// In the same directions.
    pub normal: V3,
    /// Middle of the bounding box in the plane of the piece, seen from outside, m.
    pub centre: V2,
    /// Width and height, m.
    pub size: V2,
    pub part: Option<Part>,
}

impl Place {
    /// True if it stands between front and back.
    fn is_turned(&self) -> bool {
        self.normal.z.abs() < TURNED
    }

    fn face(&self) -> Option<Face> {
        match self.middle.z {
            _ if self.is_turned() => None,
            z if z > BEFORE_M => Some(Face::Front),
            z if z < -BEFORE_M => Some(Face::Back),
            _ => None,
        }
    }

    fn hand(&self) -> Option<Hand> {
        match self.middle.x / self.size.x {
            x if x > BOTH_SIDES => Some(Hand::Left),
            x if x < -BOTH_SIDES => Some(Hand::Right),
            _ => None,
        }
    }
}

/// Statements by name where the name says the kind, else by place.
pub fn told(specification: &Specification, named: &[Named]) -> Vec<Named> {
    let worn = Worn::new(specification, named);
    (0..named.len()).map(|panel| worn.told(panel)).collect()
}

struct Worn<'a> {
    named: &'a [Named],
    places: &'a [Place],
    /// Partners of each panel, with the places of its own seams from its middle, m.
    partners: Vec<BTreeMap<usize, Vec<V2>>>,
    legs: BTreeSet<usize>,
}

impl<'a> Worn<'a> {
    fn new(specification: &'a Specification, named: &'a [Named]) -> Self {
        let places = &specification.places[..];
        let mut partners = vec![BTreeMap::<usize, Vec<V2>>::new(); places.len()];
        for Stitch { sides: [a, b], .. } in &specification.stitches {
            for (own, other) in [(a, b), (b, a)].into_iter().filter(|(own, other)| own.piece != other.piece) {
                let line = &specification.edges[own.piece][own.edge];
                let seam = line.at(0.5 * line.length()) - places[own.piece].centre;
                partners[own.piece].entry(other.piece).or_default().push(seam);
            }
        }
        let mut worn = Self { named, places, partners, legs: BTreeSet::new() };
        worn.legs = (0..places.len()).filter(|&panel| worn.is_leg(panel)).collect();
        worn
    }

    fn told(&self, panel: usize) -> Named {
        let named = self.named[panel];
        let place = &self.places[panel];
        let Some(class) = self.class(panel).filter(|_| named.class.is_none()) else { return named };
        let is_open_ring = class == Class::Skirt && self.goes_round(panel);
        let face = named.face.or_else(|| place.face().filter(|_| !is_open_ring));
        Named { class: Some(class), face, hand: named.hand.or_else(|| place.hand()), ..named }
    }

    /// `None` where the place does not tell.
    fn class(&self, panel: usize) -> Option<Class> {
        let is_sewn_to = |part: Part| self.partners[panel].keys().any(|&other| self.places[other].part == Some(part));
        match self.places[panel].part {
            Some(Part::Arm) if is_sewn_to(Part::Trunk) => Some(Class::Sleeve),
            Some(Part::Arm) => Some(Class::Cuff),
            Some(Part::Leg) if self.legs.contains(&panel) => Some(Class::Leg),
            Some(Part::Leg) if !self.legs.is_empty() => Some(Class::Cuff),
            Some(Part::Leg) => Some(Class::Skirt),
            Some(Part::Trunk) if self.is_band(panel) => Some(Class::Waistband),
            Some(Part::Trunk) if self.is_collar(panel) => Some(Class::Other),
            Some(Part::Trunk) => Some(Class::Body),
            None if self.hangs_from_a_waistband(panel) => Some(Class::Skirt),
            None => None,
        }
    }

    /// Sewn to its other half by both sides, and to the other leg.
    fn is_leg(&self, panel: usize) -> bool {
        let place = &self.places[panel];
        let is_on_both_sides = |seams: &[V2]| seams.iter().any(|s| s.x < 0.0) && seams.iter().any(|s| s.x > 0.0);
        let of = |is_other: &dyn Fn(&Place, &[V2]) -> bool| {
            let mut partners = self.partners[panel].iter();
            partners.any(|(&other, seams)| {
                self.places[other].part == Some(Part::Leg) && is_other(&self.places[other], seams)
            })
        };
        place.part == Some(Part::Leg)
            && place.hand().is_some()
            && of(&|other, seams| {
                other.hand() == place.hand() && other.face() != place.face() && is_on_both_sides(seams)
            })
            && of(&|other, _| other.hand().is_some() && other.hand() != place.hand() && other.face() == place.face())
    }

    /// True for a panel that covers both sides, is sewn to its other half at the sides alone, and hangs from the trunk,
    /// or is low and something of the leg hangs from it.
    fn is_band(&self, panel: usize) -> bool {
        let place = &self.places[panel];
        let is_low = place.size.y < BAND * place.size.x;
        let hangs = |other: &Place| match other.part {
            Some(Part::Leg) => is_low,
            Some(Part::Trunk) => other.middle.y > place.middle.y && other.face() == place.face(),
            _ => false,
        };
        let partners = || self.partners[panel].iter().map(|(&other, seams)| (&self.places[other], seams));
        let is_other_half = |other: &Place| other.part == Some(Part::Trunk) && other.face() != place.face();
        let closing: usize = partners().filter(|(other, _)| is_other_half(other)).map(|(_, seams)| seams.len()).sum();
        place.hand().is_none() && !place.is_turned() && closing <= 2 && partners().any(|(other, _)| hangs(other))
    }

    /// True also for a hood: turned, or on a larger panel of the trunk and without a limb.
    fn is_collar(&self, panel: usize) -> bool {
        let place = &self.places[panel];
        let area = |place: &Place| place.size.x * place.size.y;
        let stands_on = |&other: &usize| {
            let below = &self.places[other];
            below.part == Some(Part::Trunk)
                && below.face() == place.face()
                && below.middle.y + UPPER * below.size.y < place.middle.y
                && area(place) < SMALLER * area(below)
                && !self.is_band(other)
        };
        let mut partners = self.partners[panel].keys();
        let takes_a_limb =
            partners.clone().any(|&other| matches!(self.places[other].part, Some(Part::Arm | Part::Leg)));
        place.is_turned() || !takes_a_limb && partners.any(stands_on)
    }

    fn hangs_from_a_waistband(&self, panel: usize) -> bool {
        let Named { face, hand, .. } = self.named[panel];
        let high = UPPER * self.places[panel].size.y;
        let hangs = |(&band, seams): (&usize, &Vec<V2>)| {
            self.named[band].class == Some(Class::Waistband)
                && seams.iter().all(|seam| seam.y > high)
                && self.partners[band].get(&panel).is_some_and(|lower| lower.iter().all(|seam| seam.y < 0.0))
        };
        face.is_some() && hand.is_none() && self.partners[panel].iter().any(hangs)
    }

    /// True for a skirt of which some panels are turned to the side.
    fn goes_round(&self, panel: usize) -> bool {
        let beside = self.partners[panel].keys().chain([&panel]);
        let mut skirts = beside.filter(|&&other| self.places[other].part == Some(Part::Leg));
        skirts.any(|&other| self.places[other].is_turned())
    }
}

#[cfg(test)]
mod tests {
    use crate::garment::Role;
    use crate::garmentcode;

    /// Rectangles: name, label, place (left, up, front), width and height, cm. Stitches are pairs of (panel, edge):
    /// edge 0 below, 1 right, 2 above, 3 left.
    fn specification(panels: &[(&str, &str, [f64; 3], [f64; 2])], stitches: &[[(&str, usize); 2]]) -> Vec<u8> {
        let panel = |(name, label, at, [w, h]): &(&str, &str, [f64; 3], [f64; 2])| {
            let edges: Vec<String> = (0..4).map(|k| format!(r#"{{"endpoints":[{k},{}]}}"#, (k + 1) % 4)).collect();
            let vertices = format!(
                "[[{},{}],[{},{}],[{},{}],[{},{}]]",
                -w / 2.0,
                -h / 2.0,
                w / 2.0,
                -h / 2.0,
                w / 2.0,
                h / 2.0,
                -w / 2.0,
                h / 2.0
            );
            format!(
                r#""{name}":{{"translation":{at:?},"rotation":[0,0,0],"label":"{label}","vertices":{vertices},
                "edges":[{}]}}"#,
                edges.join(",")
            )
        };
        let side = |(panel, edge): &(&str, usize)| format!(r#"{{"panel":"{panel}","edge":{edge}}}"#);
        let stitch = |[a, b]: &[(&str, usize); 2]| format!("[{},{}]", side(a), side(b));
        let panels: Vec<String> = panels.iter().map(panel).collect();
        let stitches: Vec<String> = stitches.iter().map(stitch).collect();
        format!(
            r#"{{"pattern":{{"panels":{{{}}},"stitches":[{}]}},
            "properties":{{"curvature_coords":"relative","units_in_meter":100}}}}"#,
            panels.join(","),
            stitches.join(",")
        )
        .into_bytes()
    }

    fn roles(bytes: &[u8]) -> Vec<(String, Role)> {
        let style = garmentcode::read(bytes, "worn.json").expect("sound").style();
        style.pieces.into_iter().map(|piece| (piece.id, piece.role)).collect()
    }

    #[track_caller]
    fn check(bytes: &[u8], expect: &[(&str, Role)]) {
        let found = roles(bytes);
        let found: Vec<(&str, Role)> = found.iter().map(|(id, role)| (id.as_str(), *role)).collect();
        assert_eq!(found, expect);
    }

    #[test]
    fn panels_without_a_name_are_what_their_place_and_label_say() {
        let dress = specification(
            &[
                ("p1", "body", [12.0, 120.0, 30.0], [24.0, 40.0]),
                ("p2", "body", [-12.0, 120.0, 30.0], [24.0, 40.0]),
                ("p3", "body", [0.0, 95.0, 20.0], [48.0, 8.0]),
                ("p4", "body", [0.0, 95.0, -15.0], [48.0, 8.0]),
                ("p5", "leg", [0.0, 60.0, 25.0], [60.0, 50.0]),
                ("p6", "leg", [0.0, 60.0, -20.0], [60.0, 50.0]),
                ("p7", "arm", [40.0, 130.0, 17.0], [30.0, 20.0]),
                ("p8", "body", [10.0, 145.0, 10.0], [15.0, 8.0]),
            ],
            &[
                [("p1", 3), ("p2", 1)],
                [("p1", 0), ("p3", 2)],
                [("p3", 1), ("p4", 3)],
                [("p3", 3), ("p4", 1)],
                [("p3", 0), ("p5", 2)],
                [("p4", 0), ("p6", 2)],
                [("p5", 1), ("p6", 3)],
                [("p5", 3), ("p6", 1)],
                [("p1", 1), ("p7", 3)],
                [("p1", 2), ("p8", 0)],
            ],
        );
        use Role::{
            BodiceFront, LegBackLeft, LegFrontLeft, LegFrontRight, Other, SkirtBack, SkirtFront, SleeveLeft, Waistband,
        };
        let expect = [
            ("p1", BodiceFront),
            ("p2", BodiceFront),
            ("p3", Waistband),
            ("p4", Waistband),
            ("p5", SkirtFront),
            ("p6", SkirtBack),
            ("p7", SleeveLeft),
            ("p8", Other),
        ];
        check(&dress, &expect);
        let trousers = specification(
            &[
                ("p1", "leg", [15.0, 50.0, 25.0], [25.0, 100.0]),
                ("p2", "leg", [15.0, 50.0, -20.0], [25.0, 100.0]),
                ("p3", "leg", [-15.0, 50.0, 25.0], [25.0, 100.0]),
                ("p4", "leg", [15.0, -5.0, 25.0], [25.0, 8.0]),
            ],
            &[[("p1", 1), ("p2", 3)], [("p1", 3), ("p2", 1)], [("p1", 2), ("p3", 2)], [("p1", 0), ("p4", 2)]],
        );
        let found = roles(&trousers);
        assert_eq!((found[0].1, found[3].1), (LegFrontLeft, Other));
        assert!(![LegBackLeft, LegFrontRight].contains(&found[3].1));
    }

    #[test]
    fn what_hangs_from_a_waistband_is_a_skirt_whatever_its_name() {
        let skirt = |top: Option<(&'static str, usize)>| {
            let mut panels = vec![
                ("front", "", [0.0, -35.0, 19.0], [60.0, 60.0]),
                ("back", "", [0.0, -35.0, -16.0], [60.0, 60.0]),
                ("wb_back", "", [0.0, -2.0, -16.0], [35.0, 4.0]),
                ("wb_front", "", [0.0, -2.0, 19.0], [35.0, 4.0]),
            ];
            let mut stitches = vec![
                [("front", 1), ("back", 3)],
                [("front", 3), ("back", 1)],
                [("front", 2), ("wb_front", 0)],
                [("back", 2), ("wb_back", 0)],
                [("wb_front", 1), ("wb_back", 3)],
                [("wb_front", 3), ("wb_back", 1)],
            ];
            if let Some((name, edge)) = top {
                panels.push((name, "", [0.0, 20.0, 19.0], [50.0, 40.0]));
                stitches.push([(name, edge), ("wb_front", 2)]);
            }
            specification(&panels, &stitches)
        };
        use Role::{BodiceFront, SkirtBack, SkirtFront, Waistband};
        let expect = [("back", SkirtBack), ("front", SkirtFront), ("wb_back", Waistband), ("wb_front", Waistband)];
        check(&skirt(None), &expect);
        assert_eq!(roles(&skirt(Some(("top_front", 0))))[1].1, SkirtFront);
        assert!(roles(&skirt(Some(("top_front", 0)))).contains(&("top_front".to_owned(), BodiceFront)));
    }
}
