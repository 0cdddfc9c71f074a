//! Edges and seams from stretches that were divided: parts of an edge that are sewn on are one edge of a seam file again.

use crate::recogniser::network::Garment;
use crate::recogniser::settle::{Found, Settled};

/// Edge of a part: stretches that follow each other, counter-clockwise.
pub struct Edge {
    pub part: usize,
    pub stretches: Vec<usize>,
}

/// Seam between chains of edges: `a` in order along it, `b` against its own order.
pub struct Chain {
    pub a: Vec<usize>,
    pub b: Vec<usize>,
    pub confidence: f64,
}

pub struct Chains {
    /// In the order of the parts.
    pub edges: Vec<Edge>,
    /// For each stretch, its edge.
    pub edge_of: Vec<usize>,
    pub seams: Vec<Chain>,
    /// Seams that cannot be drawn: an edge would have to be divided where it has no vertex.
    pub dropped: Vec<Found>,
}

/// Share of an edge that stays free, below which all of it is sewn where it cannot be divided: a lap that is eased in.
const EASED: f64 = 0.15;

struct Sewn<'s> {
    garment: &'s Garment,
    partner: Vec<Option<usize>>,
    /// True if an edge ends behind this stretch.
    is_last: Vec<bool>,
}

/// `whole` gives for each stretch the undivided one, `may_end` whether an edge may end behind a stretch that was divided.
pub fn chains(garment: &Garment, whole: &[usize], settled: &Settled, may_end: impl Fn(usize) -> bool) -> Chains {
    let count = whole.len();
    let next = |k: usize| garment.stretches[k].next;
    let goes_on = |k: usize| whole[next(k)] == whole[k] && next(k) == k + 1;
    let partner = (0..count).map(|k| settled.partner(k)).collect();
    let mut sewn = Sewn { garment, partner, is_last: (0..count).map(|k| !goes_on(k)).collect() };
    let (mut dropped, mut eased) = (Vec::new(), vec![false; count]);
    while let Some(k) = (0..count).find(|&k| !sewn.is_last[k] && !eased[k] && sewn.breaks(k)) {
        if may_end(k) {
            sewn.is_last[k] = true;
            continue;
        }
        let rest = [k, next(k)].into_iter().find(|&part| sewn.partner[part].is_none());
        if rest.is_some_and(|part| sewn.share(part, whole) < EASED) {
            eased[k] = true;
            continue;
        }
        let of = |k: usize| sewn.partner[k].map(|other| (k, other));
        let seam = |(a, b): (usize, usize)| settled.seams.iter().find(|seam| seam.joins(a, b)).copied();
        let weaker = [of(k), of(next(k))].into_iter().flatten().filter_map(seam);
        let Some(seam) = weaker.min_by(|a, b| a.confidence.total_cmp(&b.confidence)) else {
            sewn.is_last[k] = true;
            continue;
        };
        (sewn.partner[seam.a], sewn.partner[seam.b]) = (None, None);
        dropped.push(seam);
    }
    let (mut edges, mut edge_of): (Vec<Edge>, Vec<usize>) = (Vec::new(), Vec::new());
    for k in 0..count {
        match edges.last_mut() {
            Some(edge) if k > 0 && !sewn.is_last[k - 1] => edge.stretches.push(k),
            _ => edges.push(Edge { part: garment.stretches[k].part, stretches: vec![k] }),
        }
        edge_of.push(edges.len() - 1);
    }
    let seams = sewn.chained(settled, &edge_of);
    Chains { edges, edge_of, seams, dropped }
}

impl Sewn<'_> {
    /// Of the undivided stretch.
    fn share(&self, part: usize, whole: &[usize]) -> f64 {
        let length = |k: usize| self.garment.stretches[k].length;
        let all = (0..whole.len()).filter(|&k| whole[k] == whole[part]);
        length(part) / all.map(length).sum::<f64>()
    }

    /// Next sewn stretch of the same edge.
    fn ahead(&self, mut k: usize) -> Option<usize> {
        while !self.is_last[k] {
            k += 1;
            if self.partner[k].is_some() {
                return Some(k);
            }
        }
        None
    }

    fn behind(&self, mut k: usize) -> Option<usize> {
        while k > 0 && !self.is_last[k - 1] && self.garment.stretches[k - 1].part == self.garment.stretches[k].part {
            k -= 1;
            if self.partner[k].is_some() {
                return Some(k);
            }
        }
        None
    }

    /// True if the edge cannot go on behind a stretch: what is free is sewn on, or the partners do not follow each other.
    fn breaks(&self, k: usize) -> bool {
        match (self.partner[k], self.partner[k + 1]) {
            (Some(x), Some(y)) => !match (self.behind(x), self.ahead(y)) {
                (None, None) => true,
                (Some(before), _) => before == y,
                _ => false,
            },
            (None, None) => false,
            _ => true,
        }
    }

    /// Pair of stretches that follows in the same seam.
    fn following(&self, (a, b): (usize, usize)) -> Option<(usize, usize)> {
        let of = |k: usize| self.partner[k];
        match (self.ahead(a), self.behind(b)) {
            (Some(a), _) => Some((a, of(a)?)),
            (None, Some(b)) => Some((of(b)?, b)),
            (None, None) => None,
        }
    }

    fn chained(&self, settled: &Settled, edge_of: &[usize]) -> Vec<Chain> {
        let mut is_used = vec![false; self.partner.len()];
        let mut chains = Vec::new();
        for a in 0..self.partner.len() {
            let Some(b) = self.partner[a].filter(|_| !is_used[a]) else { continue };
            // Back to where the seam begins: seen from the other side it goes on there.
            let (mut first, mut steps) = ((a, b), 0);
            while let Some((b, a)) = self.following((first.1, first.0)).filter(|_| steps < self.partner.len()) {
                (first, steps) = ((a, b), steps + 1);
            }
            let (mut pairs, mut last) = (vec![first], first);
            while let Some(pair) = self.following(last).filter(|pair| !pairs.contains(pair)) {
                pairs.push(pair);
                last = pair;
            }
            pairs.iter().for_each(|&(a, b)| (is_used[a], is_used[b]) = (true, true));
            let side = |of: fn(&(usize, usize)) -> usize| {
                let mut edges: Vec<usize> = pairs.iter().map(|pair| edge_of[of(pair)]).collect();
                edges.dedup();
                edges
            };
            let confidence = |&(a, b): &(usize, usize)| {
                settled.seams.iter().find(|seam| seam.joins(a, b)).map_or(0.0, |seam| seam.confidence)
            };
            let least = pairs.iter().map(confidence).fold(1.0, f64::min);
            chains.push(Chain { a: side(|pair| pair.0), b: side(|pair| pair.1), confidence: least });
        }
        chains
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recogniser::Part;
    use crate::trade::Named;
    use geom::V2;

    /// Edges of the seams, as counts of stretches, and the number of seams that were dropped.
    type Expect<'e> = (&'e [(&'e [usize], &'e [usize])], usize);

    #[test]
    fn parts_that_follow_each_other_are_one_edge() {
        // A band whose lower edge is divided in two, and two panels: lower, right, upper, left.
        let part = |width: f64, lower: &[f64]| {
            let mut outline: Vec<V2> = lower.iter().map(|&at| V2::new(at, 0.0)).collect();
            outline.extend([[width, 0.0], [width, 0.3], [0.0, 0.3]].map(V2::from));
            let corners = (0..outline.len()).collect();
            Part { outline, corners, notches: Vec::new(), said: Named::default() }
        };
        let garment = Garment::of(&[part(0.85, &[0.0, 0.05, 0.45]), part(0.4, &[0.0]), part(0.4, &[0.0])]);
        let whole = [0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
        let check = |seams: &[(usize, usize)], may_end: bool, (expect, dropped): Expect<'_>| {
            let found = |(k, &(a, b)): (usize, &(usize, usize))| Found {
                a,
                b,
                likelihood: 1.0,
                confidence: 1.0 - 0.1 * k as f64,
            };
            let seams = seams.iter().enumerate().map(found).collect();
            let settled = Settled { seams, free: vec![0.0; whole.len()] };
            let found = chains(&garment, &whole, &settled, |_| may_end);
            let side = |edges: &[usize]| -> Vec<usize> {
                edges.iter().map(|&index| found.edges[index].stretches[0]).collect()
            };
            let chains: Vec<_> = found.seams.iter().map(|seam| (side(&seam.a), side(&seam.b))).collect();
            let expect: Vec<_> = expect.iter().map(|(a, b)| (a.to_vec(), b.to_vec())).collect();
            assert_eq!((chains, found.dropped.len()), (expect, dropped));
        };
        // The band runs against the panels: its parts meet the upper edge of the second and of the first.
        check(&[(1, 12), (2, 8)], true, (&[(&[1], &[12, 8])], 0));
        check(&[(3, 5)], true, (&[(&[3], &[5])], 0));
        // A lap stays free or, where the edge cannot end, is eased in. Half of an edge is not.
        check(&[(1, 12), (2, 8)], false, (&[(&[0], &[12, 8])], 0));
        check(&[(2, 8)], true, (&[(&[2], &[8])], 0));
        check(&[(2, 8)], false, (&[], 1));
    }
}
