//! Pieces that are folded onto the garment along their seam: lapels, collars that are turned down.
//!
//! Both sides of such a seam run the same way round. Sewn together with all other pieces it would slip under a shoulder
//! seam that is still open. The garment is therefore sewn without it. The piece then begins turned up, as a
//! continuation of the sewn cloth beyond the seam. If it began folded, flat on the cloth, it would end within that
//! cloth.

use std::collections::BTreeSet;

use nalgebra::Point2;

use super::attachment::Similarity;
use super::layout::Joins;
use geom::{V2, V3, triangle};
use pattern::{Garment, Role};

geom::constants! {
    "placement.folded",
    const ABOVE_M: f64 = 0.01;
}

pub struct Folded {
    pub pieces: Vec<usize>,
}

impl Folded {
    pub fn of(garment: &Garment) -> Option<Self> {
        let joins = Joins::of(garment);
        let is_loose = |piece: usize| garment.pieces[piece].role == Role::Other;
        let turned = Turned::of(garment);
        let is_folded = |&piece: &usize| {
            let partners = (0..garment.pieces.len()).filter(|&other| !is_loose(other));
            is_loose(piece) && partners.into_iter().any(|other| turned.is_folded(&joins.between(piece, other)))
        };
        let pieces: Vec<usize> = (0..garment.pieces.len()).filter(is_folded).collect();
        (!pieces.is_empty()).then_some(Self { pieces })
    }

    pub fn turn_up(&self, garment: &Garment, x: &mut [V3]) {
        let joins = Joins::of(garment);
        for &piece in &self.pieces {
            let others = (0..garment.pieces.len()).filter(|other| !self.pieces.contains(other));
            let onto = others.map(|other| (other, joins.between(piece, other))).max_by_key(|(_, pairs)| pairs.len());
            let Some((onto, pairs)) = onto.filter(|(_, pairs)| !pairs.is_empty()) else { continue };
            let own: Vec<V2> = pairs.iter().map(|pair| over(garment.rest[pair[0]])).collect();
            let seam: Vec<V2> = pairs.iter().map(|pair| garment.rest[pair[1]]).collect();
            let motion = Similarity::of(&own, &seam).motion();
            let under = &garment.triangles[garment.pieces[onto].triangles.clone()];
            for v in garment.pieces[piece].vertices.clone() {
                let p = motion * Point2::from(over(garment.rest[v]));
                if let Some(place) = above(&garment.rest, under, p.coords, x) {
                    x[v] = place;
                }
            }
        }
    }
}

/// Point of a piece that is seen from its other side, so that its seam runs against that which it is sewn to.
fn over(p: V2) -> V2 {
    V2::new(-p.x, p.y)
}

/// Place above a point of a piece whose triangles are at `x`; beyond its edge as the nearest of them goes on.
fn above(rest: &[V2], triangles: &[[usize; 3]], p: V2, x: &[V3]) -> Option<V3> {
    let flat = |p: V2| V3::new(p.x, p.y, 0.0);
    let distance = |corners: &[usize; 3]| {
        let places = corners.map(|v| flat(rest[v]));
        let weights = triangle::nearest(&flat(p), &places);
        (places.iter().zip(weights).map(|(q, w)| q * w).sum::<V3>() - flat(p)).norm()
    };
    let nearest = triangles.iter().min_by(|s, t| distance(s).total_cmp(&distance(t)))?;
    let [a, b, c] = nearest.map(|v| rest[v]);
    let area = (b - a).perp(&(c - a));
    let (second, third) = ((p - a).perp(&(c - a)) / area, (b - a).perp(&(p - a)) / area);
    let [a, b, c] = nearest.map(|v| x[v]);
    let outwards = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    Some(a + (b - a) * second + (c - a) * third + outwards * ABOVE_M)
}

/// Sides of triangles, as they run counter-clockwise.
struct Turned(BTreeSet<[usize; 2]>);

impl Turned {
    fn of(garment: &Garment) -> Self {
        Self(garment.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect())
    }

    fn is_folded(&self, pairs: &[[usize; 2]]) -> bool {
        let side = |ends: &[[usize; 2]], k: usize| {
            let [from, to] = [ends[0][k], ends[1][k]];
            (self.0.contains(&[from, to]) != self.0.contains(&[to, from])).then_some(self.0.contains(&[from, to]))
        };
        let ways = pairs.windows(2).filter_map(|ends| Some(side(ends, 0)? == side(ends, 1)?));
        ways.map(|is_same| if is_same { 1 } else { -1 }).sum::<i32>() > 0
    }
}
