//! The outline of a piece as the mapping sees it: stretches that are sewn to one other piece, or free.

use std::collections::BTreeMap;

use geom::V2;
use pattern::{Garment, PieceMesh};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Partner {
    Free,
    Piece(usize),
}

#[derive(Clone, Debug)]
pub struct Chain {
    pub partner: Partner,
    /// Counter-clockwise, both ends included.
    pub vertices: Vec<usize>,
}

impl Chain {
    pub fn chord(&self, garment: &Garment) -> V2 {
        garment.rest[self.last()] - garment.rest[self.first()]
    }

    pub fn first(&self) -> usize {
        self.vertices[0]
    }

    pub fn last(&self) -> usize {
        self.vertices[self.vertices.len() - 1]
    }

    /// In the piece's plane.
    pub fn length_m(&self, garment: &Garment) -> f64 {
        length_m(garment, &self.vertices)
    }
}

/// In the piece's plane.
pub fn length_m(garment: &Garment, vertices: &[usize]) -> f64 {
    vertices.windows(2).map(|ends| (garment.rest[ends[1]] - garment.rest[ends[0]]).norm()).sum()
}

/// Partner piece of each boundary edge, by its sorted ends.
pub fn partners(garment: &Garment) -> BTreeMap<[usize; 2], usize> {
    let piece_of = |v: usize| garment.pieces.iter().position(|p| p.vertices.contains(&v)).unwrap_or(usize::MAX);
    let mut partners = BTreeMap::new();
    for seam in &garment.seams {
        for step in seam.pairs.windows(2) {
            for (own, other) in [(0, 1), (1, 0)] {
                let [a, b] = [step[0][own], step[1][own]];
                if a != b {
                    partners.insert([a.min(b), a.max(b)], piece_of(step[0][other]));
                }
            }
        }
    }
    partners
}

/// Counter-clockwise; `None` when the outline is not one loop.
pub fn boundary(garment: &Garment, piece: &PieceMesh) -> Option<Vec<usize>> {
    // Inner edges are traversed once in each direction and cancel.
    let mut edges: BTreeMap<[usize; 2], i32> = BTreeMap::new();
    for t in &garment.triangles[piece.triangles.clone()] {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    let next: BTreeMap<usize, usize> = edges
        .iter()
        .filter(|(_, turn)| **turn != 0)
        .map(|(&[a, b], turn)| if *turn > 0 { (a, b) } else { (b, a) })
        .collect();
    let (&start, _) = next.first_key_value()?;
    let mut ring = vec![start];
    let mut vertex = *next.get(&start)?;
    while vertex != start {
        ring.push(vertex);
        vertex = *next.get(&vertex)?;
        if ring.len() > next.len() {
            return None;
        }
    }
    (ring.len() == next.len()).then_some(ring)
}

/// Counter-clockwise.
pub fn chains(ring: &[usize], partners: &BTreeMap<[usize; 2], usize>) -> Vec<Chain> {
    let n = ring.len();
    let partner = |i: usize| {
        let (a, b) = (ring[i % n], ring[(i + 1) % n]);
        partners.get(&[a.min(b), a.max(b)]).map_or(Partner::Free, |&p| Partner::Piece(p))
    };
    let ends = |i: usize| partner(i) != partner(i + n - 1);
    let Some(start) = (0..n).find(|&i| ends(i)) else {
        return vec![];
    };
    let mut chains: Vec<Chain> = Vec::new();
    for i in start..start + n {
        if i == start || ends(i) {
            chains.push(Chain { partner: partner(i), vertices: vec![ring[i % n]] });
        }
        if let Some(chain) = chains.last_mut() {
            chain.vertices.push(ring[(i + 1) % n]);
        }
    }
    chains
}
