//! Points of measure of legs.

use super::anatomy::{Anatomy, BESIDE_M, Chain, Part, path_along};
use super::ways::{Heading, PiecePoint};
use super::{Point, PointOfMeasure};
use crate::propose::{Face, Hand};
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef, PathPart};

const THIGH_BELOW_FORK_M: f64 = 0.025;
/// Height above the fork at which the hip is measured, as on a person of 1.7 m.
const HIP_ABOVE_FORK_M: f64 = 0.080;
const KNEE_ABOVE_MIDDLE_M: f64 = 0.050;
/// Length of the inseam from which a leg has a knee.
const LONG_M: f64 = 0.500;

/// One side of the outline of a leg piece, from the waist down to the hem.
pub struct Run {
    /// Seat seam, from the waist to the fork: sewn to the other leg, or open at a fly.
    pub crotch: Chain,
    /// Inseam, from the fork to the hem.
    pub seam: Chain,
}

pub struct LegFront {
    pub path: Vec<PathPart>,
    /// Height of the beginning of the path above the fork.
    pub above_fork_m: f64,
}

/// A leg that is sewn to another leg.
pub struct Legs<'a> {
    anatomy: &'a Anatomy<'a>,
    /// Upper edges of both legs.
    pub waist: Vec<EdgeRef>,
    hem: Vec<EdgeRef>,
    /// Front and back.
    pub inner: [Run; 2],
    /// Front and back. `None` for a leg in one piece.
    pub outer: Option<[Chain; 2]>,
}

impl<'a> Legs<'a> {
    /// Right leg of a style, or its left leg if it has no right one. `None` if no fork is found.
    pub fn of_either(anatomy: &'a Anatomy<'a>) -> Option<Self> {
        let is_there =
            |hand: &Hand| anatomy.parts.iter().any(|part| matches!(part, Part::Leg(side, _) if side == hand));
        Hand::BOTH.into_iter().find(is_there).and_then(|hand| Self::of(anatomy, hand))
    }

    /// `None` if no fork is found.
    pub fn of(anatomy: &'a Anatomy<'a>, hand: Hand) -> Option<Self> {
        let is_leg = |piece: usize| matches!(anatomy.parts[piece], Part::Leg(..));
        let openings = anatomy.style().openings(&is_leg);
        let waist = openings.iter().find(|opening| is_upper(anatomy, opening))?.clone();
        let own = |opening: &&Vec<EdgeRef>| {
            !is_upper(anatomy, opening)
                && opening.iter().all(|edge| matches!(anatomy.parts[edge.piece], Part::Leg(side, _) if side == hand))
        };
        let hem = openings.iter().find(own)?.clone();
        let pieces = |face: Option<Face>| (0..anatomy.parts.len()).find(|p| anatomy.parts[*p] == Part::Leg(hand, face));
        let runs = |piece: usize| runs(anatomy, piece, &waist, &hem);
        let (inner, outer) = if let Some(whole) = pieces(None) {
            let [first, second] = runs(whole)?;
            // Seen from outside, the front of a right leg lies on the right, that of a left leg on the left.
            let is_first_front = (mean_u(anatomy, &first) > mean_u(anatomy, &second)) == (hand == Hand::Right);
            let [front, back] = if is_first_front { [first, second] } else { [second, first] };
            ([split(anatomy, front), split(anatomy, back)], None)
        } else {
            let [front, back] = [pieces(Some(Face::Front))?, pieces(Some(Face::Back))?].map(runs);
            let [front, back] = [inner_first(anatomy, front?)?, inner_first(anatomy, back?)?];
            let [[front, outer_front], [back, outer_back]] = [front, back];
            ([split(anatomy, front), split(anatomy, back)], Some([outer_front, outer_back]))
        };
        inner.iter().all(|run| !run.crotch.is_empty() && !run.seam.is_empty()).then_some(Self {
            anatomy,
            waist,
            hem,
            inner,
            outer,
        })
    }

    pub fn points(&self) -> Vec<PointOfMeasure> {
        let anatomy = self.anatomy;
        let is_leg = |piece: usize| matches!(anatomy.parts[piece], Part::Leg(..));
        let mut found = Vec::new();
        let ends = [(Point::HalfWaist, &self.waist), (Point::HalfLegOpening, &self.hem)];
        for (point, opening) in ends {
            let end = anatomy.beyond(opening, is_leg);
            found.extend(end.map(|edges| anatomy.along_edges(point, &edges, 0.5)));
        }
        let [front, back] = &self.inner;
        for (point, run) in [(Point::FrontRise, front), (Point::BackRise, back)] {
            found.push(anatomy.along_path(point, self.up_to_edge(&run.crotch), 1.0));
        }
        found.push(anatomy.along_path(Point::Inseam, path_along(&front.seam), 1.0));
        if let Some([outer, _]) = &self.outer {
            found.push(anatomy.along_path(Point::Outseam, self.up_to_edge(outer), 1.0));
        }
        let inseam_m: f64 = front.seam.iter().map(|step| anatomy.length_m(&[step.edge])).sum();
        let round = |below_m: f64| self.round_below_fork(below_m);
        found.extend(round(THIGH_BELOW_FORK_M).map(|path| anatomy.along_path(Point::HalfThigh, path, 0.5)));
        if inseam_m >= LONG_M {
            let knee = round(0.5 * inseam_m - KNEE_ABOVE_MIDDLE_M);
            found.extend(knee.map(|path| anatomy.along_path(Point::HalfKnee, path, 0.5)));
        }
        found.extend(self.hip());
        found
    }

    /// Path round the leg at a distance below the fork along the inseam of the front, m. `None` past the end of the seam.
    pub fn round_below_fork(&self, below_m: f64) -> Option<Vec<PathPart>> {
        let anatomy = self.anatomy;
        anatomy.along(&self.inner[0].seam, below_m).and_then(|at| anatomy.ways.round(at))
    }

    /// Outseam of the front, from its upper end. `None` for a leg in one piece.
    pub fn side_seam(&self) -> Option<Chain> {
        self.outer.clone().map(|[front, _]| front)
    }

    fn fork(&self) -> PiecePoint {
        let fork = self.inner[0].seam[0].other();
        PiecePoint { piece: fork.edge.piece, at: self.anatomy.place(fork) }
    }

    /// Path down the front, half-way between fork and outseam.
    pub fn way_down(&self) -> Option<LegFront> {
        let anatomy = self.anatomy;
        let PiecePoint { piece, at: fork } = self.fork();
        let outline = anatomy.style().pieces[piece].outline();
        let farthest = outline.iter().map(|p| p.x).max_by(|a, b| (a - fork.x).abs().total_cmp(&(b - fork.x).abs()))?;
        let waist: Vec<EdgeRef> = self.waist.iter().copied().filter(|edge| edge.piece == piece).collect();
        let top = anatomy.meeting(&waist, |p| p.x - 0.5 * (fork.x + farthest))?;
        let way = anatomy.ways.walk(top, Heading::Down, |_| false)?;
        Some(LegFront { path: way.parts, above_fork_m: anatomy.style().place(top).y - fork.y })
    }

    /// Height of the upper edge above the fork in front, with yoke and waistband.
    pub fn top_above_fork_m(&self) -> f64 {
        self.run_above_fork_m(&self.inner[0])
    }

    /// Height of the upper edge at centre front above that at centre back, as the pieces are drawn.
    pub fn front_over_back_m(&self) -> f64 {
        let [front, back] = &self.inner;
        self.run_above_fork_m(front) - self.run_above_fork_m(back)
    }

    /// Height of the upper end of an inner side, with yoke and waistband.
    fn run_above_fork_m(&self, run: &Run) -> f64 {
        let anatomy = self.anatomy;
        let on_leg_m: f64 = run.crotch.iter().map(|step| anatomy.length_m(&[step.edge])).sum();
        let above_m = anatomy.style().path_length_m(&self.up_to_edge(&run.crotch)) - on_leg_m;
        anatomy.place(run.crotch[0].other()).y - anatomy.place(run.seam[0].other()).y + above_m
    }

    /// Negative heights, m, lie below the fork. `None` if the leg does not reach that height.
    pub fn round(&self, above_fork_m: f64) -> Option<Vec<PathPart>> {
        let down = self.way_down()?;
        let ways = &self.anatomy.ways;
        ways.round_through(ways.along(&down.path, down.above_fork_m - above_fork_m)?)
    }

    /// Half of the hip girth: the girth of one leg there.
    fn hip(&self) -> Option<PointOfMeasure> {
        let anatomy = self.anatomy;
        let [front, back] = &self.inner;
        let crotch: Vec<EdgeRef> = front.crotch.iter().map(|step| step.edge).collect();
        let fork = self.fork().at;
        let from = anatomy.meeting(&crotch, |p| p.y - fork.y - HIP_ABOVE_FORK_M)?;
        let is_back = |at: EdgePoint| back.crotch.iter().any(|step| step.edge == at.edge);
        let way = anatomy.ways.walk(from, Heading::Level, is_back)?;
        is_back(way.end).then(|| anatomy.along_path(Point::HalfHip, way.parts, 1.0))
    }

    /// Path along a chain that begins at the waist, extended upwards across yoke and waistband.
    fn up_to_edge(&self, chain: &Chain) -> Vec<PathPart> {
        let anatomy = self.anatomy;
        let mut path = path_along(chain);
        let Some(first) = chain.first() else { return path };
        let EdgeEnd { edge: top, is_last } = anatomy.style().over_corner(first.other());
        let beside_m = if is_last { anatomy.length_m(&[top]) - BESIDE_M } else { BESIDE_M };
        let above = anatomy.ways.across(EdgePoint { edge: top, arc_m: beside_m });
        let above = above.filter(|above| !matches!(anatomy.parts[above.edge.piece], Part::Leg(..) | Part::Trunk(_)));
        path.extend(
            above.and_then(|at| anatomy.ways.walk(at, Heading::Down, |_| false)).into_iter().flat_map(|way| way.parts),
        );
        path
    }
}

fn is_upper(anatomy: &Anatomy<'_>, opening: &[EdgeRef]) -> bool {
    let above = |edge: &EdgeRef| {
        let outline = anatomy.style().pieces[edge.piece].outline();
        let (low, high) = outline.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.y), high.max(p.y)));
        let [from, to] = [false, true].map(|is_last| anatomy.place(EdgeEnd::new(*edge, is_last)).y);
        0.5 * (from + to) - 0.5 * (low + high)
    };
    opening.iter().map(above).sum::<f64>() > 0.0
}

/// Both sides of the outline, from waist to hem; the one that precedes the waist in the outline comes first.
fn runs(anatomy: &Anatomy<'_>, piece: usize, waist: &[EdgeRef], hem: &[EdgeRef]) -> Option<[Chain; 2]> {
    let n = anatomy.style().pieces[piece].edges.len();
    let edge = |k: usize| EdgeRef { piece, edge: k % n };
    // A fly belongs to the opening and not to the waist edge.
    let is_waist = |e: EdgeRef| waist.contains(&e) && !anatomy.is_upright(&vec![EdgeEnd::new(e, true)]);
    let first_hem = (0..n).find(|k| hem.contains(&edge(*k)) && !hem.contains(&edge(k + n - 1)))?;
    let all: Vec<EdgeRef> = (0..n).map(|k| edge(first_hem + k)).filter(|e| !hem.contains(e)).collect();
    let first = all.iter().position(|e| is_waist(*e))?;
    let last = all.iter().rposition(|e| is_waist(*e))?;
    let up: Chain = all[..first].iter().rev().map(|edge| EdgeEnd::new(*edge, false)).collect();
    let down: Chain = all[last + 1..].iter().map(|edge| EdgeEnd::new(*edge, true)).collect();
    Some([up, down])
}

/// True if an edge of a leg is sewn to the other leg.
fn is_crotch(anatomy: &Anatomy<'_>, edge: EdgeRef) -> bool {
    let Part::Leg(hand, _) = anatomy.parts[edge.piece] else { return false };
    let is_other = |other: &EdgeRef| matches!(anatomy.parts[other.piece], Part::Leg(side, _) if side != hand);
    anatomy.ways.partners(edge).iter().any(is_other)
}

/// Inner and outer one of two sides. `None` if both or neither are sewn to the other leg.
fn inner_first(anatomy: &Anatomy<'_>, [first, second]: [Chain; 2]) -> Option<[Chain; 2]> {
    let is_inner = |run: &Chain| run.iter().any(|step| is_crotch(anatomy, step.edge));
    match (is_inner(&first), is_inner(&second)) {
        (true, false) => Some([first, second]),
        (false, true) => Some([second, first]),
        _ => None,
    }
}

/// Divides an inner side at the fork, after the last edge that is sewn to the other leg.
fn split(anatomy: &Anatomy<'_>, run: Chain) -> Run {
    let fork = run.iter().rposition(|step| is_crotch(anatomy, step.edge)).map_or(0, |last| last + 1);
    let (crotch, seam) = run.split_at(fork);
    Run { crotch: crotch.to_vec(), seam: seam.to_vec() }
}

fn mean_u(anatomy: &Anatomy<'_>, run: &Chain) -> f64 {
    run.iter().map(|end: &EdgeEnd| anatomy.place(*end).x).sum::<f64>() / run.len().max(1) as f64
}
