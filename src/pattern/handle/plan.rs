//! Plan of a handle: the points that it moves, the points that give way, and the lengths that are kept.

use crate::pom::anatomy::{Anatomy, Chain};
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef};
use geom::V2;

/// Displacement of a point of an outline, per metre of the amount.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    /// Point that moves.
    pub at: EdgePoint,
    /// Displacement in the plane of the piece, m per metre of amount.
    pub by: V2,
}

impl Move {
    /// Makes a displacement of a point.
    pub fn new(at: EdgePoint, by: V2) -> Self {
        Self { at, by }
    }
}

/// Part of an edge between two arc lengths, before the change.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Edge of the outline.
    pub edge: EdgeRef,
    /// Arc lengths of its ends, m. They are clamped to the edge.
    pub arcs_m: [f64; 2],
}

impl Span {
    /// The whole of an edge.
    pub fn whole(edge: EdgeRef) -> Self {
        Self { edge, arcs_m: [0.0, f64::INFINITY] }
    }
}

/// A length in a sum.
#[derive(Clone, Copy, Debug)]
pub struct Term {
    /// Part of an edge whose length counts.
    pub span: Span,
    /// Weight of the length in the sum.
    pub factor: f64,
}

impl Term {
    /// The whole length of an edge, with a weight.
    pub fn whole(edge: EdgeRef, factor: f64) -> Self {
        Self { span: Span::whole(edge), factor }
    }
}

/// A condition on the change of a weighted sum of lengths.
#[derive(Clone, Debug)]
pub struct Condition {
    /// Terms of the sum.
    pub terms: Vec<Term>,
    /// Change of the sum per metre of the amount.
    pub change: f64,
}

impl Condition {
    /// Condition that the length of a chain changes by `change` per metre of amount.
    pub fn chain(chain: &Chain, change: f64) -> Self {
        Self::edges(&chain.iter().map(|step| step.edge).collect::<Vec<_>>(), change)
    }

    /// Condition that the total length of some edges changes by `change` per metre of amount.
    pub fn edges(edges: &[EdgeRef], change: f64) -> Self {
        Self { terms: edges.iter().map(|edge| Term::whole(*edge, 1.0)).collect(), change }
    }
}

/// Plan of the change of a style by a handle.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Points that move with the amount.
    pub moves: Vec<Move>,
    /// Groups of points that give way, each by one unknown factor: as little as the conditions require.
    pub gives: Vec<Vec<Move>>,
    /// Conditions on lengths, besides those of the seams, whose sides all stay paired.
    pub conditions: Vec<Condition>,
}

impl Plan {
    /// Moves a point with the amount, by `by` per metre.
    pub fn drive(&mut self, at: EdgePoint, by: V2) {
        self.moves.push(Move::new(at, by));
    }

    /// Lets a point give way in a direction.
    pub fn give(&mut self, at: EdgePoint, by: V2) {
        self.gives.push(vec![Move::new(at, by)]);
    }

    /// Holds the corners between the edges of a chain in place.
    pub fn hold(&mut self, anatomy: &Anatomy<'_>, chain: &Chain) {
        let corners = chain.windows(2).flat_map(|pair| ends_between(anatomy, pair));
        self.moves.extend(corners.map(|at| Move::new(at, V2::zeros())));
    }

    /// Lets the lower end of every edge of a chain give way along the edge.
    pub fn yield_ends(&mut self, anatomy: &Anatomy<'_>, chain: &Chain) {
        for (k, edge) in chain.iter().enumerate() {
            let down = along(anatomy, &vec![*edge]);
            let ends =
                chain.get(k..k + 2).map_or_else(|| vec![anatomy.point(*edge)], |pair| ends_between(anatomy, pair));
            self.gives.push(ends.into_iter().map(|at| Move::new(at, down)).collect());
        }
    }
}

/// Start of a chain.
pub fn start(chain: &Chain) -> EdgeEnd {
    chain[0].other()
}

/// End of a chain.
pub fn end(chain: &Chain) -> EdgeEnd {
    chain[chain.len() - 1]
}

/// Unit vector from the start of a chain to its end.
pub fn along(anatomy: &Anatomy<'_>, chain: &Chain) -> V2 {
    let way = anatomy.place(end(chain)) - anatomy.place(start(chain));
    way.try_normalize(0.0).unwrap_or_else(V2::zeros)
}

/// Corner between two edges of a chain. If a dart lies between, it has two ends.
pub fn ends_between(anatomy: &Anatomy<'_>, pair: &[EdgeEnd]) -> Vec<EdgePoint> {
    let below = pair[1].other();
    let is_one = anatomy.style().over_corner(pair[0]) == below;
    [Some(pair[0]), Some(below).filter(|_| !is_one)].into_iter().flatten().map(|end| anatomy.point(end)).collect()
}

/// Corners of a piece, each as the start of an edge.
pub fn corners(anatomy: &Anatomy<'_>, piece: usize) -> Vec<EdgeEnd> {
    (0..anatomy.style().pieces[piece].edges.len()).map(|edge| EdgeEnd::new(EdgeRef { piece, edge }, false)).collect()
}
