//! Stretches that several others share: divided where one partner ends and the next begins.
//!
//! A cap is sewn to two armholes, a waistband to a front and two backs. The network says of each stretch which one it
//! wants; a stretch that several want, or that a shorter one does not fill, is tried in parts.

use super::facts::Facts;
use super::network::{Garment, Likelihoods};
use super::stretch::Part;

/// Rounds of division: a part may be shared again.
const ROUNDS: usize = 2;
/// Likelihood from which a stretch wants another.
const WANTED: f64 = 0.5;
/// Share of a stretch that its partners fill if nothing is left free.
const FILLED: f64 = 0.95;
/// Greatest sum of the partners, as a share of the stretch.
const OVERFULL: f64 = 1.1;
/// Greatest difference in length of a partner that fills a stretch by itself.
const EVEN: f64 = 0.03;
/// Length of a rest below which it is none.
const LEAST_REST_M: f64 = 8e-3;
/// Most ways in which a stretch is tried.
const MOST_WAYS: usize = 4;
const LEAST: f64 = 1e-6;

/// Garment with stretches in parts.
pub struct Divided {
    pub parts: Vec<Part>,
    pub garment: Garment,
    /// For each stretch, that of the undivided garment which it is part of.
    pub whole: Vec<usize>,
}

/// Partner along part of a stretch, or `None` for a rest that stays free.
#[derive(Clone, Copy, Debug)]
struct Link {
    partner: Option<usize>,
    length: f64,
}

/// Ways to divide a stretch, each in order along it.
struct Chain {
    stretch: usize,
    ways: Vec<Vec<Link>>,
}

pub fn divided(parts: Vec<Part>) -> Divided {
    let garment = Garment::of(&parts);
    let whole = (0..garment.stretches.len()).collect();
    let mut best = Divided { parts, garment, whole };
    for _ in 0..ROUNDS {
        let chains = chains(&best.garment, &best.garment.likelihoods(&Facts::default()));
        let most = chains.iter().map(|chain| chain.ways.len()).max().unwrap_or(0);
        if most == 0 {
            break;
        }
        let tried: Vec<Vec<f64>> = (0..most).map(|way| best.weighed(&chains, way)).collect();
        let likeliest = |(k, chain): (usize, &Chain)| {
            let ways = 0..chain.ways.len();
            ways.reduce(|best, way| if tried[way][k] > tried[best][k] { way } else { best }).unwrap_or(0)
        };
        let chosen: Vec<usize> = chains.iter().enumerate().map(likeliest).collect();
        best = best.with(&chains, &chosen);
    }
    best
}

impl Divided {
    /// Evidence of each chain in one of its ways.
    fn weighed(&self, chains: &[Chain], way: usize) -> Vec<f64> {
        let chosen: Vec<usize> = chains.iter().map(|chain| way % chain.ways.len()).collect();
        let tried = self.with(chains, &chosen);
        let likely = tried.garment.likelihoods(&Facts::default());
        let mut first = vec![0; self.garment.stretches.len()];
        let parts_of = |k: usize| {
            let chain = chains.iter().zip(&chosen).find(|(chain, _)| chain.stretch == k);
            chain.map_or(1, |(chain, &way)| chain.ways[way].len())
        };
        for k in 1..first.len() {
            first[k] = first[k - 1] + parts_of(k - 1);
        }
        let log = |likelihood: f64| likelihood.max(LEAST).ln();
        let of_chain = |(chain, &way): (&Chain, &usize)| -> f64 {
            let of_link = |(at, link): (usize, &Link)| match link.partner.map(|partner| first[partner]) {
                Some(partner) => {
                    let part = first[chain.stretch] + at;
                    0.5 * (log(likely.of(part, partner)) + log(likely.of(partner, part)))
                }
                None => log(likely.free(first[chain.stretch] + at)),
            };
            chain.ways[way].iter().enumerate().map(of_link).sum()
        };
        chains.iter().zip(&chosen).map(of_chain).collect()
    }

    fn with(&self, chains: &[Chain], chosen: &[usize]) -> Self {
        let (mut parts, mut whole) = (self.parts.clone(), Vec::new());
        // From the last: a corner that is added moves the stretches behind it.
        for (k, stretch) in self.garment.stretches.iter().enumerate().rev() {
            let chain = chains.iter().zip(chosen).find(|(chain, _)| chain.stretch == k);
            let links = chain.map_or(&[][..], |(chain, &way)| &chain.ways[way]);
            let mut arcs: Vec<f64> = Vec::new();
            for link in links.iter().take(links.len().saturating_sub(1)) {
                arcs.push(arcs.last().copied().unwrap_or(0.0) + link.length);
            }
            whole.extend(std::iter::repeat_n(self.whole[k], arcs.len() + 1));
            parts[stretch.part].divide(stretch.at, &arcs);
        }
        whole.reverse();
        Self { garment: Garment::of(&parts), parts, whole }
    }
}

/// Longest stretches first. A stretch is shared, or shares, not both.
fn chains(garment: &Garment, likely: &Likelihoods) -> Vec<Chain> {
    let stretches = &garment.stretches;
    let mut order: Vec<usize> = (0..stretches.len()).collect();
    order.sort_by(|&a, &b| stretches[b].length.total_cmp(&stretches[a].length).then(a.cmp(&b)));
    let (mut chains, mut is_taken): (Vec<Chain>, _) = (Vec::new(), vec![false; stretches.len()]);
    for k in order {
        let sharing = Sharing { garment, likely, stretch: k };
        let members: Vec<usize> = sharing.members().into_iter().filter(|&j| !is_taken[j]).collect();
        if is_taken[k] || members.iter().any(|&j| chains.iter().any(|chain| chain.stretch == j)) {
            continue;
        }
        let ways = sharing.ways(&members);
        if !ways.is_empty() {
            members.iter().for_each(|&j| is_taken[j] = true);
            chains.push(Chain { stretch: k, ways });
        }
    }
    chains
}

/// A stretch, and those that want it.
struct Sharing<'g> {
    garment: &'g Garment,
    likely: &'g Likelihoods,
    stretch: usize,
}

impl Sharing<'_> {
    fn length(&self, k: usize) -> f64 {
        self.garment.stretches[k].length
    }

    /// Stretches that are alike: equal copies of the part, and the mirror image in the same part.
    fn alike(&self) -> Vec<usize> {
        let like = &self.garment.symmetry.like;
        (0..like.len()).filter(|&k| like[k] == like[self.stretch]).collect()
    }

    /// Shorter ones that want this stretch or an equal copy of it.
    fn members(&self) -> Vec<usize> {
        let alike = self.alike();
        let wants = |j: &usize| {
            let sum: f64 = alike.iter().filter(|&&k| k != *j).map(|&k| self.likely.of(*j, k)).sum();
            *j != self.stretch && sum >= WANTED && self.length(*j) < FILLED * self.length(self.stretch)
        };
        (0..self.garment.stretches.len()).filter(wants).collect()
    }

    /// Likelihood that `b` goes on where `a` begins, both run against the stretch.
    fn goes_on(&self, a: usize, b: usize) -> f64 {
        let (before, behind) = (self.garment.stretches[a].previous, self.garment.stretches[b].next);
        if before == b {
            return 1.0;
        }
        (self.likely.of(before, behind) * self.likely.of(behind, before)).sqrt()
    }

    /// True if another stretch as long as this one is likely sewn to it.
    fn has_its_own(&self) -> bool {
        let (k, length) = (self.stretch, self.length(self.stretch));
        let is_even = |j: &usize| (self.length(*j) - length).abs() < EVEN * length;
        let sum: f64 = (0..self.garment.stretches.len()).filter(is_even).map(|j| self.likely.of(k, j)).sum();
        sum > WANTED
    }

    /// Each begins with another member and goes on with the likeliest next one.
    fn ways(&self, members: &[usize]) -> Vec<Vec<Link>> {
        if self.has_its_own() {
            return Vec::new();
        }
        let quota = members.len().div_ceil(self.alike().len());
        let path = |&start: &usize| {
            let (mut path, mut left) = (vec![start], members.to_vec());
            left.retain(|&j| j != start);
            while path.len() < quota {
                let last = path[path.len() - 1];
                let next = left
                    .iter()
                    .copied()
                    .reduce(|best, j| if self.goes_on(last, j) > self.goes_on(last, best) { j } else { best });
                let Some(next) = next else { break };
                left.retain(|&j| j != next);
                path.push(next);
            }
            path
        };
        let paths = members.iter().take(MOST_WAYS).map(path);
        paths.flat_map(|path| self.links(&path)).take(MOST_WAYS).collect()
    }

    /// Lengths along the stretch of a path of partners: as they are, with a rest at the end or the beginning, or scaled.
    /// Without any where they do not fit.
    fn links(&self, path: &[usize]) -> Vec<Vec<Link>> {
        let whole = self.length(self.stretch);
        let sum: f64 = path.iter().map(|&j| self.length(j)).sum();
        if sum > OVERFULL * whole {
            return Vec::new();
        }
        let rest = whole - sum;
        let has_rest =
            rest > (1.0 - FILLED) * whole && rest > LEAST_REST_M && self.likely.free(self.stretch) > 0.5 * rest / whole;
        let scale = if has_rest { 1.0 } else { whole / sum };
        let links = |path: &[usize]| -> Vec<Link> {
            path.iter().map(|&j| Link { partner: Some(j), length: scale * self.length(j) }).collect()
        };
        if has_rest {
            let free = Link { partner: None, length: rest };
            let (mut first, mut last) = (vec![free], links(path));
            first.extend(last.clone());
            last.push(free);
            vec![last, first]
        } else if path.len() > 1 {
            vec![links(path)]
        } else {
            Vec::new()
        }
    }
}
