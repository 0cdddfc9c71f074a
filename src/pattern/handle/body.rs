//! Parts of a garment that handles move: side seams with their levels, armholes, sleeve caps, legs and darts.

use super::Handle;
use super::plan::{Span, along, end, start};
use crate::pom::anatomy::{Anatomy, BELOW_ARMHOLE_M, BESIDE_M, Chain, Part};
use crate::pom::legs::Legs;
use crate::pom::skirt;
use crate::pom::top::Trunk;
use crate::pom::{Point, PointOfMeasure};
use crate::propose::{Face, Hand};
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef, PathPart};
use geom::V2;

/// Distance below which two levels of a seam are one, and a point is a corner.
pub const NEAR_M: f64 = 3e-3;

/// Least distance of a waist from both ends of its side seam. A narrowest girth nearer to an end is the taper of that
/// end.
const WAIST_FROM_ENDS_M: f64 = 85e-3;

/// Least length of the underarm seam below the bicep for the seam to bend there. In a shorter one, 10 mm of added width
/// would make a corner.
const LEAST_BELOW_BICEP_M: f64 = 60e-3;

/// Part of the garment that a side seam belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limb {
    /// Top, or bodice of a dress.
    Trunk,
    Skirt,
    /// Outseam.
    Outer(Hand),
    /// Inseam.
    Inner(Hand),
}

/// Place on a side seam at which a girth handle acts.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// Arc length from the upper end.
    pub at_m: f64,
    pub handle: Handle,
}

/// Side of a side seam, outseam or inseam, directed downwards.
pub struct Side {
    pub limb: Limb,
    pub chain: Chain,
    /// From top to bottom.
    pub levels: Vec<Level>,
    /// Horizontal unit vector out of the piece.
    pub out: V2,
}

/// Front or back part.
pub struct Armhole {
    pub edges: Vec<EdgeRef>,
    /// Shoulder point. `None` if the garment has no shoulder seam there.
    pub tip: Option<EdgeEnd>,
    pub underarm: EdgeEnd,
    /// Side seam from the underarm downwards.
    pub side: Chain,
    /// Half of the sleeve cap. `None` without a sleeve, or if it is not one piece.
    pub cap: Option<HalfCap>,
}

/// Sleeve cap from the underarm to the shoulder point, and the underarm seam below it.
pub struct HalfCap {
    pub piece: usize,
    pub underarm: EdgeEnd,
    /// From the underarm to the top.
    pub spans: Vec<Span>,
    /// Sewn to the shoulder point.
    pub top: EdgePoint,
    /// Underarm seam, directed downwards.
    pub seam: Chain,
    /// Unit vector along the arm.
    pub down: V2,
    /// Unit vector across the arm, out of the piece at the underarm.
    pub out: V2,
}

/// Parts of a garment that handles move.
pub struct Body<'a> {
    pub anatomy: &'a Anatomy<'a>,
    /// `None` without side seams between a front and a back.
    pub trunk: Option<Trunk<'a>>,
    /// Right one first. Empty without trousers.
    pub legs: Vec<Legs<'a>>,
    pub sides: Vec<Side>,
    /// Front and back of one, then of the other.
    pub armholes: Vec<Armhole>,
}

impl<'a> Body<'a> {
    pub fn of(anatomy: &'a Anatomy<'a>, points: &[PointOfMeasure]) -> Self {
        let trunk = Trunk::of(anatomy);
        let legs: Vec<Legs<'a>> = Hand::BOTH.into_iter().filter_map(|hand| Legs::of(anatomy, hand)).collect();
        let sides = sides(anatomy, trunk.as_ref(), &legs, points);
        let armholes = trunk.as_ref().map_or_else(Vec::new, |trunk| armholes(anatomy, trunk));
        Self { anatomy, trunk, legs, sides, armholes }
    }

    /// Edges of one piece that are sewn to each other. The first ends, and the second begins, at the tip.
    pub fn darts(&self) -> Vec<[EdgeRef; 2]> {
        let style = self.anatomy.style();
        let dart = |[a, b]: [EdgeRef; 2]| {
            let n = style.pieces[a.piece].edges.len();
            let follows = |edge: EdgeRef, next: EdgeRef| (edge.edge + 1) % n == next.edge;
            let is_dart = a.piece == b.piece && n > 2;
            (is_dart && follows(a, b)).then_some([a, b]).or_else(|| (is_dart && follows(b, a)).then_some([b, a]))
        };
        let seams = style.seams.iter().filter_map(|seam| match (seam.a.as_slice(), seam.b.as_slice()) {
            (&[a], &[b]) => dart([a, b]),
            _ => None,
        });
        seams.collect()
    }

    pub fn caps(&self) -> impl Iterator<Item = &HalfCap> {
        self.armholes.iter().filter_map(|armhole| armhole.cap.as_ref())
    }

    pub fn point(&self, end: EdgeEnd) -> EdgePoint {
        self.anatomy.point(end)
    }
}

/// Arc length along a chain at which a line of a path ends, m. `None` if none does.
pub fn met(anatomy: &Anatomy<'_>, chain: &Chain, path: &[PathPart]) -> Option<f64> {
    let mut before_m = 0.0;
    for &EdgeEnd { edge, is_last: is_forwards } in chain {
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

/// Horizontal unit vector.
fn out_of(anatomy: &Anatomy<'_>, chain: &Chain) -> V2 {
    let outline = anatomy.style().pieces[chain[0].edge.piece].outline();
    let (low, high) = outline.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.x), high.max(p.x)));
    let middle = 0.5 * (anatomy.place(start(chain)).x + anatomy.place(end(chain)).x);
    V2::x() * (middle - 0.5 * (low + high)).signum()
}

fn sides(anatomy: &Anatomy<'_>, trunk: Option<&Trunk<'_>>, legs: &[Legs<'_>], points: &[PointOfMeasure]) -> Vec<Side> {
    use Handle::{Chest, Fork, Hem, Hip, Knee, LegOpening, Thigh, Waist};
    let path = |points: &[PointOfMeasure], point: Point| {
        points.iter().find(|measure| measure.point == point).map(|measure| measure.path.clone()).unwrap_or_default()
    };
    let side =
        |limb: Limb, chain: &Chain, ends: [Option<Handle>; 2], own: &[PointOfMeasure], within: &[(Point, Handle)]| {
            let length_m: f64 = chain.iter().map(|step| anatomy.length_m(&[step.edge])).sum();
            let mut levels: Vec<Level> = within
                .iter()
                .filter_map(|(point, handle)| {
                    Some(Level { at_m: met(anatomy, chain, &path(own, *point))?, handle: *handle })
                })
                .filter(|level| (NEAR_M..length_m - NEAR_M).contains(&level.at_m))
                .collect();
            levels.retain(|level| {
                level.handle != Waist || (WAIST_FROM_ENDS_M..length_m - WAIST_FROM_ENDS_M).contains(&level.at_m)
            });
            levels.extend(ends[0].map(|handle| Level { at_m: 0.0, handle }));
            levels.extend(ends[1].map(|handle| Level { at_m: length_m, handle }));
            levels.sort_by(|level, other| level.at_m.total_cmp(&other.at_m));
            levels.dedup_by(|later, earlier| later.at_m - earlier.at_m < NEAR_M);
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

/// Front and back, directed downwards from the upper edge.
fn skirt_sides(anatomy: &Anatomy<'_>) -> Vec<[Chain; 2]> {
    let all = skirt::side_seams(anatomy);
    // A side seam sewn in parts begins at its uppermost part.
    let begins = |[front, _]: &&[Chain; 2]| {
        let before = anatomy.style().over_corner(start(front));
        !all.iter().any(|[other, _]| end(other) == before)
    };
    all.iter().filter(begins).map(|sides| anatomy.over_darts(sides, &all)).collect()
}

fn hand_of(anatomy: &Anatomy<'_>, leg: &Legs<'_>) -> Option<Hand> {
    match anatomy.parts[leg.inner[0].seam[0].edge.piece] {
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

fn half_cap(anatomy: &Anatomy<'_>, armhole: &[EdgeRef], tip: EdgeEnd, underarm: EdgeEnd) -> Option<HalfCap> {
    let style = anatomy.style();
    // The partner is looked up a little inside the armhole: beyond its ends, another piece may be sewn on.
    let inside = |corner: EdgeEnd, in_m: f64| {
        let EdgeEnd { edge, is_last } = style.over_corner(corner);
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
        let ends = [false, true].map(|is_last| EdgeEnd::new(at.edge, is_last));
        ends.into_iter().find(|end| (anatomy.point(*end).arc_m - at.arc_m).abs() < NEAR_M)
    };
    let corner = corner_near(low)?;
    // The panels of a two-piece sleeve meet at the shoulder point, which is then the end of the cap of each panel.
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
    // The vector out of the piece points away from the rest of it.
    let across = V2::new(-down.y, down.x);
    let inwards = (style.place(top) - anatomy.place(corner)).dot(&across);
    Some(HalfCap { piece, underarm: corner, spans, top, seam, down, out: across * -inwards.signum() })
}

/// Upper end of the cap: the end of the last edge sewn to the trunk.
fn cap_end(anatomy: &Anatomy<'_>, corner: EdgeEnd) -> Option<EdgeEnd> {
    let is_cap = |edge: EdgeRef| {
        anatomy.ways.partners(edge).iter().any(|other| matches!(anatomy.parts[other.piece], Part::Trunk(_)))
    };
    let mut at = corner.other();
    for _ in 0..anatomy.style().pieces[corner.edge.piece].edges.len() {
        let next = anatomy.style().over_corner(at);
        if !is_cap(next.edge) {
            return Some(at);
        }
        at = next.other();
    }
    None
}

/// `None` if the point is not on the piece.
fn spans(anatomy: &Anatomy<'_>, from: EdgeEnd, to: EdgePoint) -> Option<Vec<Span>> {
    let mut found = Vec::new();
    let EdgeEnd { mut edge, mut is_last } = from;
    for _ in 0..anatomy.style().pieces[edge.piece].edges.len() {
        let length_m = anatomy.length_m(&[edge]);
        if edge == to.edge {
            found.push(Span { edge, arcs_m: if is_last { [to.arc_m, length_m] } else { [0.0, to.arc_m] } });
            return Some(found);
        }
        found.push(Span { edge, arcs_m: [0.0, length_m] });
        EdgeEnd { edge, is_last } = anatomy.style().over_corner(EdgeEnd::new(edge, !is_last));
    }
    None
}

/// Edges from `from` onwards that are sewn within their own sleeve. `None` if the first is not.
fn own_seam(anatomy: &Anatomy<'_>, from: EdgeEnd) -> Option<Chain> {
    let part = anatomy.parts[from.edge.piece];
    let is_own = |edge: EdgeRef| {
        let partners = anatomy.ways.partners(edge);
        !partners.is_empty() && partners.iter().all(|other| anatomy.parts[other.piece] == part)
    };
    let mut chain: Chain = Vec::new();
    let mut at = from.other();
    while is_own(at.edge) && !chain.iter().any(|step| step.edge == at.edge) {
        chain.push(at);
        let next = anatomy.style().over_corner(at);
        at = next.other();
    }
    (!chain.is_empty()).then_some(chain)
}

impl HalfCap {
    fn seam_m(&self, anatomy: &Anatomy<'_>) -> f64 {
        self.seam.iter().map(|step| anatomy.length_m(&[step.edge])).sum()
    }

    /// Point of the underarm seam. `None` for a short sleeve, whose underarm seam stays straight.
    pub fn bicep(&self, anatomy: &Anatomy<'_>) -> Option<EdgePoint> {
        let is_long = self.seam_m(anatomy) > BELOW_ARMHOLE_M + LEAST_BELOW_BICEP_M;
        is_long.then(|| anatomy.along(&self.seam, BELOW_ARMHOLE_M)).flatten()
    }

    /// Displacement of the underarm point over that of the bicep: 1 where the underarm seam bends, else L / (L - b) for
    /// a seam of length L with the bicep at b from the top. `None` for a sleeve that ends above the bicep.
    pub fn widening(&self, anatomy: &Anatomy<'_>) -> Option<f64> {
        let seam_m = self.seam_m(anatomy);
        match self.bicep(anatomy) {
            Some(_) => Some(1.0),
            None => (seam_m > BELOW_ARMHOLE_M + NEAR_M).then(|| seam_m / (seam_m - BELOW_ARMHOLE_M)),
        }
    }

    pub fn along(&self, anatomy: &Anatomy<'_>) -> V2 {
        along(anatomy, &self.seam)
    }
}
