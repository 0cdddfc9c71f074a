//! Identification of the seams and openings of a style, by the roles of its pieces.

use super::ways::{Heading, Ways};
use super::{Point, PointOfMeasure};
use crate::garment::Role;
use crate::propose::{Face, Hand};
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef, PathPart, Style};
use geom::V2;

/// Distance below the armhole at which chest and bicep are measured.
pub const BELOW_ARMHOLE_M: f64 = 0.025;

/// Distance from a corner at which the adjoining piece is looked up. At the corner itself, pieces may end.
pub const BESIDE_M: f64 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Trunk(Face),
    Sleeve(Hand),
    /// Side of the wearer, and front or back. `None` for a leg in one piece.
    Leg(Hand, Option<Face>),
    Skirt(Face),
    /// Anything else, including waistbands.
    Other,
}

impl Part {
    fn of(role: Role) -> Self {
        match role {
            Role::Front | Role::BodiceFront => Self::Trunk(Face::Front),
            Role::Back | Role::BodiceBack => Self::Trunk(Face::Back),
            Role::SleeveRight => Self::Sleeve(Hand::Right),
            Role::SleeveLeft => Self::Sleeve(Hand::Left),
            Role::LegFrontRight => Self::Leg(Hand::Right, Some(Face::Front)),
            Role::LegFrontLeft => Self::Leg(Hand::Left, Some(Face::Front)),
            Role::LegBackRight => Self::Leg(Hand::Right, Some(Face::Back)),
            Role::LegBackLeft => Self::Leg(Hand::Left, Some(Face::Back)),
            Role::LegRight => Self::Leg(Hand::Right, None),
            Role::LegLeft => Self::Leg(Hand::Left, None),
            Role::SkirtFront => Self::Skirt(Face::Front),
            Role::SkirtBack => Self::Skirt(Face::Back),
            Role::Waistband | Role::Other => Self::Other,
        }
    }
}

/// Edges, each given by the end that it is walked to.
pub type Chain = Vec<EdgeEnd>;

/// A style with the parts that its pieces belong to.
pub struct Anatomy<'a> {
    pub ways: Ways<'a>,
    pub parts: Vec<Part>,
}

impl<'a> Anatomy<'a> {
    /// Identifies the parts of a style whose pieces are upright.
    pub fn of(style: &'a Style) -> Self {
        let parts: Vec<Part> = style.pieces.iter().map(|piece| Part::of(piece.role)).collect();
        let down = parts.iter().map(|part| (*part != Part::Other).then(|| -V2::y())).collect();
        let mut anatomy = Self { ways: Ways::new(style, down), parts };
        let down = (0..anatomy.parts.len()).map(|piece| anatomy.down(piece)).collect();
        anatomy.ways = Ways::new(style, down);
        anatomy
    }

    pub fn style(&self) -> &'a Style {
        self.ways.style
    }

    /// Unit vector downwards, or in a sleeve, away from the trunk. `None` for a piece of unknown part.
    fn down(&self, piece: usize) -> Option<V2> {
        match self.parts[piece] {
            Part::Other => None,
            Part::Sleeve(_) => {
                let edges = (0..self.style().pieces[piece].edges.len()).map(|edge| EdgeRef { piece, edge });
                let (caps, others): (Vec<EdgeRef>, Vec<EdgeRef>) = edges.partition(|edge| {
                    self.ways.partners(*edge).iter().any(|other| matches!(self.parts[other.piece], Part::Trunk(_)))
                });
                let is_lower = |edge: &EdgeRef| {
                    !self.ways.partners(*edge).iter().any(|other| self.parts[other.piece] == self.parts[piece])
                };
                let lower: Vec<EdgeRef> = others.into_iter().filter(is_lower).collect();
                let way = self.middle(&lower)? - self.middle(&caps)?;
                Some(if way.x.abs() > way.y.abs() { V2::x() * way.x.signum() } else { V2::y() * way.y.signum() })
            }
            _ => Some(-V2::y()),
        }
    }

    /// Mean of the midpoints of the chords. `None` without edges.
    fn middle(&self, edges: &[EdgeRef]) -> Option<V2> {
        let middles = edges.iter().map(|edge| {
            let points = self.style().edge(*edge).line.points();
            points[0].lerp(&points[points.len() - 1], 0.5)
        });
        (!edges.is_empty()).then(|| middles.sum::<V2>() / edges.len() as f64)
    }

    pub fn place(&self, EdgeEnd { edge, is_last }: EdgeEnd) -> V2 {
        let points = self.style().edge(edge).line.points();
        if is_last { points[points.len() - 1] } else { points[0] }
    }

    pub fn point(&self, EdgeEnd { edge, is_last }: EdgeEnd) -> EdgePoint {
        EdgePoint { edge, arc_m: if is_last { self.length_m(&[edge]) } else { 0.0 } }
    }

    pub fn length_m(&self, edges: &[EdgeRef]) -> f64 {
        edges.iter().map(|edge| self.style().edge(*edge).line.length()).sum()
    }

    /// Both sides of a seam between two kinds of pieces, in the direction of sewing, the side of the first kind first.
    /// `None` for a seam between other kinds.
    pub fn between(
        &self,
        seam: usize,
        is_first: impl Fn(Part) -> bool,
        is_second: impl Fn(Part) -> bool,
    ) -> Option<[Chain; 2]> {
        let seam = &self.style().seams[seam];
        let a: Chain = seam.a.iter().map(|edge| EdgeEnd::new(*edge, true)).collect();
        let b: Chain = seam.b.iter().map(|edge| EdgeEnd::new(*edge, seam.b_forwards)).collect();
        let all = |chain: &Chain, is: &dyn Fn(Part) -> bool| chain.iter().all(|step| is(self.parts[step.edge.piece]));
        if all(&a, &is_first) && all(&b, &is_second) {
            Some([a, b])
        } else {
            (all(&b, &is_first) && all(&a, &is_second)).then_some([b, a])
        }
    }

    /// True if the chords of a chain run more vertically than horizontally.
    pub fn is_upright(&self, chain: &Chain) -> bool {
        let chord = |step: &EdgeEnd| self.place(*step) - self.place(step.other());
        let way: V2 = chain.iter().map(chord).sum();
        way.y.abs() > way.x.abs()
    }

    /// Both sides of a seam, directed so that the first one runs downwards.
    pub fn turned_down(&self, sides: [Chain; 2]) -> [Chain; 2] {
        let runs_down = match (sides[0].first(), sides[0].last()) {
            (Some(first), Some(last)) => self.place(first.other()).y >= self.place(*last).y,
            _ => true,
        };
        if runs_down { sides } else { sides.map(|chain| chain.into_iter().rev().map(|step| step.other()).collect()) }
    }

    /// Both sides of a seam that runs downwards, extended by those seams of `others` that continue it below a dart.
    pub fn over_darts(&self, sides: &[Chain; 2], others: &[[Chain; 2]]) -> [Chain; 2] {
        let [mut front, mut back] = sides.clone();
        while let Some(&last) = front.last() {
            let mut next = self.style().over_corner(last);
            let is_dart = |edge: EdgeRef| self.ways.partners(edge).iter().any(|other| other.piece == edge.piece);
            while is_dart(next.edge) && next.edge != last.edge {
                next = self.style().over_corner(next.other());
            }
            let goes_on = |other: &&[Chain; 2]| other[0].first().is_some_and(|first| *first == next.other());
            let Some([below, behind]) =
                others.iter().find(goes_on).filter(|_| !front.iter().any(|step| step.edge == next.edge))
            else {
                break;
            };
            front.extend(below);
            back.extend(behind);
        }
        [front, back]
    }

    /// `None` past the end of the chain.
    pub fn along(&self, chain: &Chain, distance_m: f64) -> Option<EdgePoint> {
        let mut rest_m = distance_m;
        for &EdgeEnd { edge, is_last: is_forwards } in chain {
            let length_m = self.length_m(&[edge]);
            if rest_m <= length_m {
                return Some(EdgePoint { edge, arc_m: if is_forwards { rest_m } else { length_m - rest_m } });
            }
            rest_m -= length_m;
        }
        None
    }

    /// Index of the opening along which the outline of a piece continues at the end of an edge.
    pub fn opening_at(&self, openings: &[Vec<EdgeRef>], end: EdgeEnd) -> Option<usize> {
        let next = self.style().over_corner(end).edge;
        openings.iter().position(|opening| opening.contains(&next))
    }

    /// Free edges at the end of everything that is sewn to an opening: the opening itself if nothing is, otherwise the
    /// opening of the attached pieces (a cuff, a waistband, a skirt). `None` if the attached pieces have several
    /// openings, or none. `is_there` is true for the pieces of the opening.
    pub fn beyond(&self, opening: &[EdgeRef], is_there: impl Fn(usize) -> bool) -> Option<Vec<EdgeRef>> {
        if opening.iter().all(|edge| self.ways.is_free(*edge)) {
            return Some(opening.to_vec());
        }
        let mut attached: Vec<usize> = Vec::new();
        let mut ahead: Vec<EdgeRef> = opening.to_vec();
        while let Some(edge) = ahead.pop() {
            for other in self.ways.partners(edge).iter().filter(|other| !is_there(other.piece)) {
                if !attached.contains(&other.piece) {
                    attached.push(other.piece);
                    let edges = 0..self.style().pieces[other.piece].edges.len();
                    ahead.extend(edges.map(|edge| EdgeRef { piece: other.piece, edge }));
                }
            }
        }
        let ends = self.style().openings(&|_| true);
        let mut ends = ends.into_iter().filter(|end| end.iter().all(|edge| attached.contains(&edge.piece)));
        let end = ends.next()?;
        ends.next().is_none().then_some(end)
    }

    /// First intersection of a line with some edges of a piece, in the order of the edges. `value` is zero on the line.
    pub fn meeting(&self, edges: &[EdgeRef], value: impl Fn(V2) -> f64) -> Option<EdgePoint> {
        self.meetings(edges, value).into_iter().next()
    }

    /// Lowest intersection of edges with the line on which `value` is zero.
    pub fn lowest_meeting(&self, edges: &[EdgeRef], value: impl Fn(V2) -> f64) -> Option<EdgePoint> {
        let height = |at: &EdgePoint| self.style().place(*at).y;
        self.meetings(edges, value).into_iter().min_by(|point, other| height(point).total_cmp(&height(other)))
    }

    fn meetings(&self, edges: &[EdgeRef], value: impl Fn(V2) -> f64) -> Vec<EdgePoint> {
        let mut found = Vec::new();
        for &edge in edges {
            let line = &self.style().edge(edge).line;
            for (ends, arcs) in line.points().windows(2).zip(line.arcs().windows(2)) {
                let [from, to] = [value(ends[0]), value(ends[1])];
                if (from <= 0.0) != (to <= 0.0) {
                    found.push(EdgePoint { edge, arc_m: arcs[0] + (arcs[1] - arcs[0]) * from / (from - to) });
                }
            }
        }
        found
    }

    pub fn along_path(&self, point: Point, path: Vec<PathPart>, share: f64) -> PointOfMeasure {
        PointOfMeasure { point, length_m: share * self.style().path_length_m(&path), path, share }
    }

    pub fn along_edges(&self, point: Point, edges: &[EdgeRef], share: f64) -> PointOfMeasure {
        self.along_path(point, edges.iter().copied().map(PathPart::Edge).collect(), share)
    }

    /// Path down the centre of half a front or back, from the end of an edge that runs across its top. It follows
    /// vertical edges of the outline, and continues over the pieces sewn to their lower end: along the centre of
    /// halves, or straight down a piece that spans both sides.
    pub fn down_centre(&self, end: EdgeEnd) -> Vec<PathPart> {
        let mut path = Vec::new();
        let mut at = end;
        loop {
            let before = path.len();
            let mut next = self.style().over_corner(at);
            while self.is_centre(next.edge) && !path.contains(&PathPart::Edge(next.edge)) {
                path.push(PathPart::Edge(next.edge));
                at = next.other();
                next = self.style().over_corner(at);
            }
            let length_m = self.length_m(&[next.edge]);
            let beside =
                EdgePoint { edge: next.edge, arc_m: if next.is_last { length_m - BESIDE_M } else { BESIDE_M } };
            let Some(below) = self.ways.across(beside).filter(|_| path.len() > before) else { return path };
            let ends = [false, true].map(|is_last| EdgeEnd::new(below.edge, is_last));
            let corner = ends.into_iter().find(|end| (self.point(*end).arc_m - below.arc_m).abs() < 2.0 * BESIDE_M);
            match corner.filter(|corner| self.is_centre(self.style().over_corner(*corner).edge)) {
                Some(corner) => at = corner,
                None => {
                    let way = self.ways.walk(below, Heading::Down, |_| false);
                    path.extend(way.into_iter().flat_map(|way| way.parts));
                    return path;
                }
            }
        }
    }

    /// True if an edge may be the centre of half a piece: vertical, and free or sewn to the other half.
    fn is_centre(&self, edge: EdgeRef) -> bool {
        let is_half = |other: &EdgeRef| other.piece != edge.piece && self.parts[other.piece] == self.parts[edge.piece];
        self.is_upright(&vec![EdgeEnd::new(edge, true)]) && self.ways.partners(edge).iter().all(is_half)
    }

    /// True if a skirt or legs hang from some edges, with or without a waistband between.
    pub fn has_below(&self, edges: &[EdgeRef]) -> bool {
        let is_below = |piece: usize| matches!(self.parts[piece], Part::Skirt(_) | Part::Leg(..));
        let partners = |edge: EdgeRef| self.ways.partners(edge).iter().map(|other| other.piece);
        let edges_of =
            |piece: usize| (0..self.style().pieces[piece].edges.len()).map(move |edge| EdgeRef { piece, edge });
        let is_band =
            |piece: usize| self.parts[piece] == Part::Other && edges_of(piece).flat_map(partners).any(is_below);
        edges.iter().flat_map(|edge| partners(*edge)).any(|piece| is_below(piece) || is_band(piece))
    }
}

pub fn path_along(chain: &Chain) -> Vec<PathPart> {
    chain.iter().map(|step| PathPart::Edge(step.edge)).collect()
}

pub fn distance(point: Point, length_m: f64) -> PointOfMeasure {
    PointOfMeasure { point, length_m, path: Vec::new(), share: 1.0 }
}
