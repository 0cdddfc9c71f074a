//! The parts of a garment that handles move: side seams with their levels, armholes, sleeves, legs, darts, bands.

use super::Handle;
use super::plan::{along, end, start};
use crate::pom::anatomy::{Anatomy, BELOW_ARMHOLE_M, BESIDE_M, Chain, Part};
use crate::pom::legs::Legs;
use crate::pom::skirt;
use crate::pom::top::Trunk;
use crate::pom::{Point, PointOfMeasure};
use crate::propose::{Face, Hand};
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef, PathPart};
use geom::V2;

/// Distance within which two levels of a seam are one, and a point lies at a corner, m.
pub const NEAR_M: f64 = 3e-3;

/// Least distance of a waist within a side seam from its ends, m: nearer, the girth is narrowest where the seam ends, and there is no waist.
const WAIST_FROM_ENDS_M: f64 = 85e-3;

/// Least length of an underarm seam below the bicep for it to bend there, m: in less, 10 mm more width would be a corner.
const LEAST_BELOW_BICEP_M: f64 = 60e-3;

/// What a side seam belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limb {
    /// Trunk or bodice.
    Trunk,
    /// Skirt of a skirt or a dress.
    Skirt,
    /// The outseam of a leg.
    Outer(Hand),
    /// The inseam of a leg.
    Inner(Hand),
}

/// One side of a side seam, outseam or inseam, from above.
pub struct Side {
    /// What it belongs to.
    pub limb: Limb,
    /// Its edges, from above.
    pub chain: Chain,
    /// Levels along it with their distances from its start, m.
    pub levels: Vec<(f64, Handle)>,
    /// Unit vector out of the piece, level.
    pub out: V2,
}

/// One face's part of an armhole.
pub struct Armhole {
    /// Its edges, from the shoulder point to the underarm.
    pub edges: Vec<EdgeRef>,
    /// Its upper end, the shoulder point; none without a shoulder.
    pub tip: Option<EdgeEnd>,
    /// Its lower end.
    pub underarm: EdgeEnd,
    /// The side seam's edges from there down.
    pub side: Chain,
    /// Half of the sleeve's cap that is sewn to it; none where nothing or something else is.
    pub cap: Option<HalfCap>,
}

/// Half a sleeve: from the underarm up to the shoulder point, and the underarm seam on its side.
pub struct HalfCap {
    /// Index of the sleeve's piece.
    pub piece: usize,
    /// The corner at the underarm.
    pub underarm: EdgeEnd,
    /// Parts of edges from the underarm to the top.
    pub spans: Vec<(EdgeRef, [f64; 2])>,
    /// The point that is sewn to the shoulder point.
    pub top: EdgePoint,
    /// The underarm seam from above.
    pub seam: Chain,
    /// Unit vectors down the arm and out of the piece at the underarm.
    pub down: V2,
    /// Across the arm, out of the piece.
    pub out: V2,
}

/// A garment as handles see it: the parts that they move.
pub struct Body<'a> {
    /// What its seams are.
    pub anatomy: &'a Anatomy<'a>,
    /// Its trunk; `None` without side seams between a front and a back.
    pub trunk: Option<Trunk<'a>>,
    /// Its legs, the right one first; empty where it has none.
    pub legs: Vec<Legs<'a>>,
    /// Its side seams.
    pub sides: Vec<Side>,
    /// Its armholes, a face each.
    pub armholes: Vec<Armhole>,
}

impl<'a> Body<'a> {
    /// Finds the parts that handles move; `points` are the style's points of measure.
    pub fn of(anatomy: &'a Anatomy<'a>, points: &[PointOfMeasure]) -> Self {
        let trunk = Trunk::of(anatomy);
        let legs: Vec<Legs<'a>> = Hand::BOTH.into_iter().filter_map(|hand| Legs::of(anatomy, hand)).collect();
        let sides = sides(anatomy, trunk.as_ref(), &legs, points);
        let armholes = trunk.as_ref().map_or_else(Vec::new, |trunk| armholes(anatomy, trunk));
        Self { anatomy, trunk, legs, sides, armholes }
    }

    /// Darts as their legs: a seam of two neighbouring edges of one piece, whose common corner is the tip.
    pub fn darts(&self) -> Vec<[EdgeRef; 2]> {
        let style = self.anatomy.style();
        let dart = |[a, b]: [EdgeRef; 2]| {
            let n = style.pieces[a.piece].edges.len();
            let follows = |one: EdgeRef, other: EdgeRef| (one.edge + 1) % n == other.edge;
            let is_dart = a.piece == b.piece && n > 2;
            (is_dart && follows(a, b)).then_some([a, b]).or_else(|| (is_dart && follows(b, a)).then_some([b, a]))
        };
        let seams = style.seams.iter().filter_map(|seam| match (seam.a.as_slice(), seam.b.as_slice()) {
            (&[a], &[b]) => dart([a, b]),
            _ => None,
        });
        seams.collect()
    }

    /// The half caps of all sleeves.
    pub fn caps(&self) -> impl Iterator<Item = &HalfCap> {
        self.armholes.iter().filter_map(|armhole| armhole.cap.as_ref())
    }

    /// Corners of a piece's outline at the end of an edge as its point.
    pub fn point(&self, end: EdgeEnd) -> EdgePoint {
        self.anatomy.point(end)
    }
}

/// Distance along a chain of the end of a path that lies on it, m.
pub fn met(anatomy: &Anatomy<'_>, chain: &Chain, path: &[PathPart]) -> Option<f64> {
    let mut before_m = 0.0;
    for &(edge, is_forwards) in chain {
        let length_m = anatomy.length_m(&[edge]);
        let ends = path.iter().filter_map(|part| match part {
            PathPart::Line(ends) => Some(ends),
            PathPart::Edge(_) => None,
        });
        if let Some(at) = ends.flatten().find(|at| at.edge == edge) {
            return Some(before_m + if is_forwards { at.arc_m } else { length_m - at.arc_m });
        }
        before_m += length_m;
    }
    None
}

/// Level vector out of the piece of a chain.
fn out_of(anatomy: &Anatomy<'_>, chain: &Chain) -> V2 {
    let outline = anatomy.style().pieces[chain[0].0.piece].outline();
    let (low, high) = outline.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.x), high.max(p.x)));
    let middle = 0.5 * (anatomy.place(start(chain)).x + anatomy.place(end(chain)).x);
    V2::x() * (middle - 0.5 * (low + high)).signum()
}

fn sides(anatomy: &Anatomy<'_>, trunk: Option<&Trunk<'_>>, legs: &[Legs<'_>], points: &[PointOfMeasure]) -> Vec<Side> {
    use Handle::{Chest, Fork, Hem, Hip, Knee, LegOpening, Thigh, Waist};
    let path = |points: &[PointOfMeasure], point: Point| {
        points.iter().find(|one| one.point == point).map(|one| one.path.clone()).unwrap_or_default()
    };
    let side =
        |limb: Limb, chain: &Chain, ends: [Option<Handle>; 2], own: &[PointOfMeasure], within: &[(Point, Handle)]| {
            let length_m: f64 = chain.iter().map(|(edge, _)| anatomy.length_m(&[*edge])).sum();
            let mut levels: Vec<(f64, Handle)> = within
                .iter()
                .filter_map(|(point, handle)| Some((met(anatomy, chain, &path(own, *point))?, *handle)))
                .filter(|(at, _)| (NEAR_M..length_m - NEAR_M).contains(at))
                .collect();
            levels.retain(|(at, handle)| {
                *handle != Waist || (WAIST_FROM_ENDS_M..length_m - WAIST_FROM_ENDS_M).contains(at)
            });
            levels.extend(ends[0].map(|handle| (0.0, handle)));
            levels.extend(ends[1].map(|handle| (length_m, handle)));
            levels.sort_by(|one, other| one.0.total_cmp(&other.0));
            levels.dedup_by(|later, earlier| later.0 - earlier.0 < NEAR_M);
            Side { limb, chain: chain.clone(), levels, out: out_of(anatomy, chain) }
        };
    let mut found = Vec::new();
    if let Some(trunk) = trunk {
        let has_below = anatomy.has_below(&trunk.bottom);
        let low = if has_below { Waist } else { Hem };
        let within = [(Point::HalfChest, Chest), (Point::HalfWaist, Waist)];
        let all = trunk.sides.iter().flatten();
        found.extend(all.map(|chain| side(Limb::Trunk, chain, [Some(Chest), Some(low)], points, &within)));
    }
    for chain in skirt_sides(anatomy).iter().flatten() {
        found.push(side(Limb::Skirt, chain, [Some(Waist), Some(Hem)], points, &[(Point::HalfHip, Hip)]));
    }
    for (leg, hand) in legs.iter().filter_map(|leg| Some((leg, hand_of(anatomy, leg)?))) {
        let own = leg.points();
        let within = [(Point::HalfHip, Hip), (Point::HalfThigh, Thigh), (Point::HalfKnee, Knee)];
        for chain in leg.outer.iter().flatten() {
            found.push(side(Limb::Outer(hand), chain, [Some(Waist), Some(LegOpening)], &own, &within));
        }
        for run in &leg.inner {
            found.push(side(Limb::Inner(hand), &run.seam, [Some(Fork), Some(LegOpening)], &own, &within));
        }
    }
    found
}

/// Both sides of each side seam of a skirt from its upper edge down, front and back.
fn skirt_sides(anatomy: &Anatomy<'_>) -> Vec<[Chain; 2]> {
    let all = skirt::side_seams(anatomy);
    // A side seam may be sewn in several parts.
    let begins = |[front, _]: &&[Chain; 2]| {
        let before = anatomy.style().over_corner(start(front));
        !all.iter().any(|[other, _]| end(other) == before)
    };
    all.iter().filter(begins).map(|sides| anatomy.over_darts(sides, &all)).collect()
}

fn hand_of(anatomy: &Anatomy<'_>, leg: &Legs<'_>) -> Option<Hand> {
    match anatomy.parts[leg.inner[0].seam[0].0.piece] {
        Part::Leg(hand, _) => Some(hand),
        _ => None,
    }
}

fn armholes(anatomy: &Anatomy<'_>, trunk: &Trunk<'_>) -> Vec<Armhole> {
    let mut found = Vec::new();
    for side in &trunk.sides {
        let Some(hole) = anatomy.opening_at(&trunk.openings, start(&side[0])).filter(|k| trunk.armholes.contains(k))
        else {
            continue;
        };
        let at_shoulder = |[front, _]: &&[Chain; 2]| anatomy.opening_at(&trunk.openings, end(front)) == Some(hole);
        let shoulder = trunk.shoulders.iter().find(at_shoulder);
        for (k, face) in [Face::Front, Face::Back].into_iter().enumerate() {
            let is_own = |edge: &&EdgeRef| anatomy.parts[edge.piece] == Part::Trunk(face);
            let edges: Vec<EdgeRef> = trunk.openings[hole].iter().filter(is_own).copied().collect();
            let tip = shoulder.map(|shoulder| end(&shoulder[k]));
            let underarm = start(&side[k]);
            let cap = tip.and_then(|tip| half_cap(anatomy, &edges, tip, underarm));
            found.push(Armhole { edges, tip, underarm, side: side[k].clone(), cap });
        }
    }
    found
}

/// The half of a sleeve that is sewn to a face's part of an armhole; `None` where it is not in one piece.
fn half_cap(anatomy: &Anatomy<'_>, armhole: &[EdgeRef], tip: EdgeEnd, underarm: EdgeEnd) -> Option<HalfCap> {
    let style = anatomy.style();
    // A little way into the armhole: what is sewn on beyond its ends may be another piece.
    let inside = |corner: EdgeEnd, in_m: f64| {
        let (edge, is_last) = style.over_corner(corner);
        let arc_m = if is_last { anatomy.length_m(&[edge]) - in_m } else { in_m };
        armhole.contains(&edge).then(|| anatomy.ways.across(EdgePoint { edge, arc_m })).flatten()
    };
    let low = inside(underarm, BESIDE_M)?;
    let piece = low.edge.piece;
    let down = anatomy.ways.down(piece)?;
    if !matches!(anatomy.parts[piece], Part::Sleeve(_)) {
        return None;
    }
    let corner_near = |at: EdgePoint| {
        let ends = [false, true].map(|is_last| (at.edge, is_last));
        ends.into_iter().find(|end| (anatomy.point(*end).arc_m - at.arc_m).abs() < NEAR_M)
    };
    let corner = corner_near(low)?;
    // A sleeve in two panels has its shoulder point at the end of the panel's cap.
    let high = inside(tip, BESIDE_M).filter(|high| high.edge.piece == piece);
    let top = match high {
        Some(high) => match corner_near(high) {
            Some(corner) => anatomy.point(corner),
            None => inside(tip, 0.0).filter(|at| at.edge == high.edge).unwrap_or(high),
        },
        None => anatomy.point(cap_end(anatomy, corner)?),
    };
    let spans = spans(anatomy, corner, top)?;
    let seam = own_seam(anatomy, style.over_corner(corner))?;
    // Out of the piece: against the direction from the underarm to the rest of it.
    let across = V2::new(-down.y, down.x);
    let inwards = (style.place(top) - anatomy.place(corner)).dot(&across);
    Some(HalfCap { piece, underarm: corner, spans, top, seam, down, out: across * -inwards.signum() })
}

/// From the underarm corner of a sleeve along its cap to where the trunk's armhole leaves it.
fn cap_end(anatomy: &Anatomy<'_>, corner: EdgeEnd) -> Option<EdgeEnd> {
    let is_cap = |edge: EdgeRef| {
        anatomy.ways.partners(edge).iter().any(|other| matches!(anatomy.parts[other.piece], Part::Trunk(_)))
    };
    let mut at = (corner.0, !corner.1);
    for _ in 0..anatomy.style().pieces[corner.0.piece].edges.len() {
        let next = anatomy.style().over_corner(at);
        if !is_cap(next.0) {
            return Some(at);
        }
        at = (next.0, !next.1);
    }
    None
}

/// Parts of the outline from an end of an edge along it to a point.
fn spans(anatomy: &Anatomy<'_>, from: EdgeEnd, to: EdgePoint) -> Option<Vec<(EdgeRef, [f64; 2])>> {
    let mut found = Vec::new();
    let (mut edge, mut is_last) = from;
    for _ in 0..anatomy.style().pieces[edge.piece].edges.len() {
        let length_m = anatomy.length_m(&[edge]);
        if edge == to.edge {
            found.push((edge, if is_last { [to.arc_m, length_m] } else { [0.0, to.arc_m] }));
            return Some(found);
        }
        found.push((edge, [0.0, length_m]));
        (edge, is_last) = anatomy.style().over_corner((edge, !is_last));
    }
    None
}

/// The edges from an end on that are sewn within the same sleeve.
fn own_seam(anatomy: &Anatomy<'_>, (first, is_last): EdgeEnd) -> Option<Chain> {
    let part = anatomy.parts[first.piece];
    let is_own = |edge: EdgeRef| {
        let partners = anatomy.ways.partners(edge);
        !partners.is_empty() && partners.iter().all(|other| anatomy.parts[other.piece] == part)
    };
    let mut chain: Chain = Vec::new();
    let mut at = (first, !is_last);
    while is_own(at.0) && !chain.iter().any(|(edge, _)| *edge == at.0) {
        chain.push(at);
        let next = anatomy.style().over_corner(at);
        at = (next.0, !next.1);
    }
    (!chain.is_empty()).then_some(chain)
}

impl HalfCap {
    fn seam_m(&self, anatomy: &Anatomy<'_>) -> f64 {
        self.seam.iter().map(|(edge, _)| anatomy.length_m(&[*edge])).sum()
    }

    /// The point of the underarm seam where the bicep is measured; none of a short sleeve, whose seam stays straight.
    pub fn bicep(&self, anatomy: &Anatomy<'_>) -> Option<EdgePoint> {
        let is_long = self.seam_m(anatomy) > BELOW_ARMHOLE_M + LEAST_BELOW_BICEP_M;
        is_long.then(|| anatomy.along(&self.seam, BELOW_ARMHOLE_M)).flatten()
    }

    /// How far the underarm point moves for the sleeve to widen by one where the bicep is measured; none of a sleeve that ends above.
    pub fn widening(&self, anatomy: &Anatomy<'_>) -> Option<f64> {
        let seam_m = self.seam_m(anatomy);
        match self.bicep(anatomy) {
            Some(_) => Some(1.0),
            None => (seam_m > BELOW_ARMHOLE_M + NEAR_M).then(|| seam_m / (seam_m - BELOW_ARMHOLE_M)),
        }
    }

    /// Unit vector down its underarm seam.
    pub fn along(&self, anatomy: &Anatomy<'_>) -> V2 {
        along(anatomy, &self.seam)
    }
}
