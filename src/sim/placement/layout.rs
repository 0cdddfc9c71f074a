//! Pieces laid out flat, side by side as they are worn: the 2D arrangement that is then bent about a limb.

use std::collections::BTreeMap;

use geom::V2;
use pattern::{Garment, Role};

geom::constants! {
    "placement.layout",
    /// Space between parts of a sheet that no seam joins.
    const BESIDE_M: f64 = 0.01;
    /// Cosine of the angle, 30 degrees, up to which a direction of the grain counts as up.
    const NEAR_COSINE: f64 = 0.866;
}

pub struct Joins<'a> {
    pub garment: &'a Garment,
    pub piece_of: Vec<usize>,
    /// Vertex pairs by (lesser, greater) piece, the lesser piece's vertex first.
    pairs: BTreeMap<[usize; 2], Vec<[usize; 2]>>,
    /// Sewn length by (lesser, greater) piece, m.
    lengths: BTreeMap<[usize; 2], f64>,
}

impl<'a> Joins<'a> {
    pub fn of(garment: &'a Garment) -> Self {
        let mut piece_of = vec![0; garment.rest.len()];
        for (index, piece) in garment.pieces.iter().enumerate() {
            piece_of[piece.vertices.clone()].fill(index);
        }
        let mut pairs: BTreeMap<_, Vec<_>> = BTreeMap::new();
        let mut lengths: BTreeMap<_, f64> = BTreeMap::new();
        let key = |[a, b]: [usize; 2]| [piece_of[a].min(piece_of[b]), piece_of[a].max(piece_of[b])];
        for seam in &garment.seams {
            for &[a, b] in &seam.pairs {
                let pair = if piece_of[a] <= piece_of[b] { [a, b] } else { [b, a] };
                pairs.entry(key(pair)).or_default().push(pair);
            }
            for ends in seam.pairs.windows(2).filter(|ends| key(ends[0]) == key(ends[1])) {
                let length = (garment.rest[ends[1][0]] - garment.rest[ends[0][0]]).norm();
                *lengths.entry(key(ends[0])).or_default() += length;
            }
        }
        Self { garment, piece_of, pairs, lengths }
    }

    /// Vertex pairs that join two pieces, those of `one` first.
    pub fn between(&self, one: usize, other: usize) -> Vec<[usize; 2]> {
        let pairs = self.pairs.get(&[one.min(other), one.max(other)]);
        let turned = |&[a, b]: &[usize; 2]| if one <= other { [a, b] } else { [b, a] };
        pairs.map_or_else(Vec::new, |pairs| pairs.iter().map(turned).collect())
    }

    pub fn length_to_any(&self, piece: usize, others: &[usize]) -> f64 {
        let length = |&other: &usize| self.lengths.get(&[piece.min(other), piece.max(other)]);
        others.iter().filter_map(length).sum()
    }

    /// Vertex pairs that join a piece to any of `others`, its own vertex first.
    pub fn to_any(&self, piece: usize, others: &[usize]) -> Vec<[usize; 2]> {
        others.iter().filter(|&&other| other != piece).flat_map(|&other| self.between(piece, other)).collect()
    }

    pub fn worn_as(&self, roles: &[Role]) -> Vec<usize> {
        (0..self.garment.pieces.len()).filter(|&p| roles.contains(&self.garment.pieces[p].role)).collect()
    }

    /// Mean in the piece's plane.
    pub fn mean_rest(&self, vertices: impl Iterator<Item = usize>) -> Option<V2> {
        let (sum, n) = vertices.fold((V2::zeros(), 0.0), |(sum, n), v| (sum + self.garment.rest[v], n + 1.0));
        (n > 0.0).then(|| sum / n)
    }

    /// Nearest of the grain's four directions to `hint`; `hint` itself where the grain lies aslant.
    pub fn up(&self, piece: usize, hint: V2) -> V2 {
        let hint = hint.try_normalize(0.0).unwrap_or_else(V2::y);
        let grain = self.garment.pieces[piece].grain;
        let weft = V2::new(grain.y, -grain.x);
        let nearest = [grain, -grain, weft, -weft].into_iter().max_by(|a, b| a.dot(&hint).total_cmp(&b.dot(&hint)));
        nearest.filter(|up| up.dot(&hint) >= NEAR_COSINE).unwrap_or(hint)
    }
}

/// Piece turned upright and moved to its place in a sheet.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    pub piece: usize,
    up: V2,
    shift: V2,
}

impl Part {
    pub fn new(piece: usize, up: V2) -> Self {
        Self { piece, up, shift: V2::zeros() }
    }

    /// Place in the sheet: `x` to the right seen from outside, `y` up.
    pub fn at(&self, p: V2) -> V2 {
        V2::new(p.x * self.up.y - p.y * self.up.x, p.dot(&self.up)) + self.shift
    }
}

#[derive(Clone, Debug, Default)]
pub struct Sheet {
    pub parts: Vec<Part>,
}

impl Sheet {
    /// Lays out pieces: each joined to one already there by moving its seam onto the other's, the longest seams first.
    /// Pieces that no seam connects come in sheets of their own.
    pub fn lay(joins: &Joins, mut loose: Vec<Part>) -> Vec<Self> {
        let mut sheets: Vec<Self> = Vec::new();
        while !loose.is_empty() {
            let mut sheet = Self { parts: vec![loose.remove(0)] };
            while let Some((index, onto)) = sheet.longest_seam(joins, &loose) {
                let mut part = loose.remove(index);
                let pairs = joins.between(part.piece, sheet.parts[onto].piece);
                let rest = &joins.garment.rest;
                let gap = |&[a, b]: &[usize; 2]| sheet.parts[onto].at(rest[b]) - part.at(rest[a]);
                part.shift += pairs.iter().map(gap).sum::<V2>() / pairs.len() as f64;
                sheet.parts.push(part);
            }
            sheets.push(sheet);
        }
        sheets
    }

    fn longest_seam(&self, joins: &Joins, loose: &[Part]) -> Option<(usize, usize)> {
        // From behind, because of equals `max_by_key` takes the last.
        let candidates = (0..loose.len()).rev().flat_map(|i| (0..self.parts.len()).rev().map(move |k| (i, k)));
        let length = |&(i, k): &(usize, usize)| joins.between(loose[i].piece, self.parts[k].piece).len();
        candidates
            .map(|pair| (length(&pair), pair))
            .filter(|(n, _)| *n > 0)
            .max_by_key(|(n, _)| *n)
            .map(|(_, pair)| pair)
    }

    pub fn pieces(&self) -> Vec<usize> {
        self.parts.iter().map(|part| part.piece).collect()
    }

    pub fn points<'s>(&'s self, garment: &'s Garment) -> impl Iterator<Item = (usize, V2)> + 's {
        let places_of = move |part: &'s Part| {
            garment.pieces[part.piece].vertices.clone().map(move |v| (v, part.at(garment.rest[v])))
        };
        self.parts.iter().flat_map(places_of)
    }

    pub fn bounds(&self, garment: &Garment) -> (V2, V2) {
        let start = (V2::repeat(f64::MAX), V2::repeat(f64::MIN));
        self.points(garment).fold(start, |(low, high), (_, p)| (low.inf(&p), high.sup(&p)))
    }

    /// Least and greatest `x` of the cloth at a height; `None` above and below it.
    pub fn row(&self, garment: &Garment, height: f64) -> Option<(f64, f64)> {
        let crossings = self.parts.iter().flat_map(|part| {
            let sides = garment.triangles[garment.pieces[part.piece].triangles.clone()].iter();
            let sides = sides.flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            sides.filter_map(move |side| {
                // In one order, whichever way the triangle goes round.
                let [p, q] = [side[0].min(side[1]), side[0].max(side[1])].map(|v| part.at(garment.rest[v]));
                let within = (p.y.min(q.y)..=p.y.max(q.y)).contains(&height);
                let share = if p.y == q.y { 0.0 } else { (height - p.y) / (q.y - p.y) };
                within.then(|| p.x + share * (q.x - p.x))
            })
        });
        crossings.fold(None, |row, x| {
            let (low, high) = row.unwrap_or((x, x));
            Some((low.min(x), high.max(x)))
        })
    }

    pub fn shift(&mut self, by: V2) {
        self.parts.iter_mut().for_each(|part| part.shift += by);
    }

    /// Puts sheets side by side from left to right, their upper edges at the same height, the middle at 0.
    pub fn beside(sheets: Vec<Self>, garment: &Garment) -> Self {
        let bounds: Vec<(V2, V2)> = sheets.iter().map(|sheet| sheet.bounds(garment)).collect();
        let taken = |(low, high): &(V2, V2)| high.x - low.x + BESIDE_M;
        let mut all = Self::default();
        for (k, mut sheet) in sheets.into_iter().enumerate() {
            let (low, high) = bounds[k];
            // Widths to the left and to the right, each summed from here outwards.
            let [left, right]: [f64; 2] =
                [bounds[..k].iter().rev().map(taken).sum(), bounds[k + 1..].iter().map(taken).sum()];
            sheet.shift(V2::new(0.5 * (left - right) - 0.5 * (low.x + high.x), -high.y));
            all.parts.extend(sheet.parts);
        }
        all
    }
}
