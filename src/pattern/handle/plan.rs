//! Plan of a handle. A point is *driven* (moves with the amount), *held* (driven by zero), or *gives* way along a
//! direction by a factor that `solve` finds so that the conditions on lengths hold.

use crate::pom::anatomy::{Anatomy, Chain};
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef};
use geom::V2;

/// Displacement of a point per unit of amount.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    pub at: EdgePoint,
    /// In the plane of the piece, m/m. For a point that gives way, its direction.
    pub by: V2,
    /// True where a nearly straight edge may turn.
    pub turns: bool,
}

impl Move {
    pub fn new(at: EdgePoint, by: V2) -> Self {
        Self { at, by, turns: false }
    }

    /// Stays, and lets a nearly straight edge turn there.
    pub fn turning(at: EdgePoint) -> Self {
        Self { at, by: V2::zeros(), turns: true }
    }
}

/// Part of an edge, by arc lengths of the unchanged edge.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    pub edge: EdgeRef,
    /// Both ends, clamped to the edge.
    pub arcs_m: [f64; 2],
}

impl Span {
    pub fn whole(edge: EdgeRef) -> Self {
        Self { edge, arcs_m: [0.0, f64::INFINITY] }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Term {
    pub span: Span,
    pub factor: f64,
}

impl Term {
    pub fn whole(edge: EdgeRef, factor: f64) -> Self {
        Self { span: Span::whole(edge), factor }
    }
}

/// Fulfilled if sum(factor * change of length) = `change` * amount.
#[derive(Clone, Debug)]
pub struct Condition {
    pub terms: Vec<Term>,
    /// In m/m of amount.
    pub change: f64,
}

impl Condition {
    /// The length of a chain changes by `change` m/m of amount.
    pub fn chain(chain: &Chain, change: f64) -> Self {
        Self::edges(&chain.iter().map(|step| step.edge).collect::<Vec<_>>(), change)
    }

    pub fn edges(edges: &[EdgeRef], change: f64) -> Self {
        Self { terms: edges.iter().map(|edge| Term::whole(*edge, 1.0)).collect(), change }
    }
}

#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Driven and held points.
    pub moves: Vec<Move>,
    /// Groups that share one unknown factor, as small as the conditions permit.
    pub gives: Vec<Vec<Move>>,
    /// `solve` adds one for each seam, whose two sides keep their length difference.
    pub conditions: Vec<Condition>,
}

impl Plan {
    /// `by` is in m/m of amount.
    pub fn drive(&mut self, at: EdgePoint, by: V2) {
        self.moves.push(Move::new(at, by));
    }

    pub fn give(&mut self, at: EdgePoint, by: V2) {
        self.gives.push(vec![Move::new(at, by)]);
    }

    /// Holds the corners between the edges of a chain.
    pub fn hold(&mut self, anatomy: &Anatomy<'_>, chain: &Chain) {
        let corners = chain.windows(2).flat_map(|pair| ends_between(anatomy, pair));
        self.moves.extend(corners.map(|at| Move::new(at, V2::zeros())));
    }

    /// Lets the lower end of every edge give way along its edge.
    pub fn yield_ends(&mut self, anatomy: &Anatomy<'_>, chain: &Chain) {
        for (k, edge) in chain.iter().enumerate() {
            let down = along(anatomy, &vec![*edge]);
            let ends =
                chain.get(k..k + 2).map_or_else(|| vec![anatomy.point(*edge)], |pair| ends_between(anatomy, pair));
            self.gives.push(ends.into_iter().map(|at| Move::new(at, down)).collect());
        }
    }
}

pub fn start(chain: &Chain) -> EdgeEnd {
    chain[0].other()
}

pub fn end(chain: &Chain) -> EdgeEnd {
    chain[chain.len() - 1]
}

/// Unit vector from start to end.
pub fn along(anatomy: &Anatomy<'_>, chain: &Chain) -> V2 {
    let way = anatomy.place(end(chain)) - anatomy.place(start(chain));
    way.try_normalize(0.0).unwrap_or_else(V2::zeros)
}

/// Corner between two successive edges of a chain: one point, or two where a dart lies between the edges.
pub fn ends_between(anatomy: &Anatomy<'_>, pair: &[EdgeEnd]) -> Vec<EdgePoint> {
    let below = pair[1].other();
    let is_one = anatomy.style().over_corner(pair[0]) == below;
    [Some(pair[0]), Some(below).filter(|_| !is_one)].into_iter().flatten().map(|end| anatomy.point(end)).collect()
}

/// Each as the start of an edge.
pub fn corners(anatomy: &Anatomy<'_>, piece: usize) -> Vec<EdgeEnd> {
    (0..anatomy.style().pieces[piece].edges.len()).map(|edge| EdgeEnd::new(EdgeRef { piece, edge }, false)).collect()
}
