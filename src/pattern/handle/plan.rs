//! What a handle does: the places that it moves, what gives way, and which lengths hold.

use crate::pom::anatomy::{Anatomy, Chain};
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef};
use geom::V2;

/// Displacement of a place of an outline, per metre of the handle's amount.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    /// Place that moves.
    pub at: EdgePoint,
    /// Displacement in the piece's plane, m per metre of amount.
    pub by: V2,
}

impl Move {
    /// A displacement of a place.
    pub fn new(at: EdgePoint, by: V2) -> Self {
        Self { at, by }
    }
}

/// Part of an edge between two arc lengths of the edge as it was.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Edge of the outline.
    pub edge: EdgeRef,
    /// From and to, m; beyond the ends means the whole edge.
    pub arcs_m: [f64; 2],
}

impl Span {
    /// The whole of an edge, however long.
    pub fn whole(edge: EdgeRef) -> Self {
        Self { edge, arcs_m: [0.0, f64::INFINITY] }
    }
}

/// A sum of lengths, each with its sign, that changes as is said.
#[derive(Clone, Debug)]
pub struct Condition {
    /// Parts of edges, each with the factor that its length counts with.
    pub spans: Vec<(Span, f64)>,
    /// Change of the sum per metre of the handle's amount.
    pub change: f64,
}

impl Condition {
    /// The edges of a chain change together by `change` per metre of amount.
    pub fn chain(chain: &Chain, change: f64) -> Self {
        Self::edges(&chain.iter().map(|(edge, _)| *edge).collect::<Vec<_>>(), change)
    }

    /// Some edges change together by `change` per metre of amount.
    pub fn edges(edges: &[EdgeRef], change: f64) -> Self {
        Self { spans: edges.iter().map(|edge| (Span::whole(*edge), 1.0)).collect(), change }
    }
}

/// What a handle does to a style.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// Places that move with the amount.
    pub moves: Vec<Move>,
    /// Groups of places that may move besides, each by one amount of its own: as little as the conditions ask.
    pub gives: Vec<Vec<Move>>,
    /// Lengths that hold, beside the seams, which all stay paired.
    pub conditions: Vec<Condition>,
}

impl Plan {
    /// Moves a place with the amount, by `by` per metre.
    pub fn drive(&mut self, at: EdgePoint, by: V2) {
        self.moves.push(Move::new(at, by));
    }

    /// Lets a place move in a direction.
    pub fn give(&mut self, at: EdgePoint, by: V2) {
        self.gives.push(vec![Move::new(at, by)]);
    }
}

/// The start of a chain.
pub fn start(chain: &Chain) -> EdgeEnd {
    (chain[0].0, !chain[0].1)
}

/// The end of a chain.
pub fn end(chain: &Chain) -> EdgeEnd {
    chain[chain.len() - 1]
}

/// Unit vector from the start of a chain to its end.
pub fn along(anatomy: &Anatomy<'_>, chain: &Chain) -> V2 {
    let way = anatomy.place(end(chain)) - anatomy.place(start(chain));
    way.try_normalize(0.0).unwrap_or_else(V2::zeros)
}

/// Corners of a piece, each as the start of an edge.
pub fn corners(anatomy: &Anatomy<'_>, piece: usize) -> Vec<EdgeEnd> {
    (0..anatomy.style().pieces[piece].edges.len()).map(|edge| (EdgeRef { piece, edge }, false)).collect()
}
