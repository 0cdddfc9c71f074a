//! Seams of a garment, the surest first: what is sure is stated to the network, which then weighs the rest anew.

use super::facts::{Fact, Facts};
use super::network::{Garment, Likelihoods};

/// Likelihood from which a seam is stated at once. Below it, the likeliest are stated first.
const SURE: f64 = 0.95;
/// Share of the greatest likelihood that is stated together with it.
const TOGETHER: f64 = 0.8;
/// Most seams that are tried to join what falls apart, and most that are taken.
const MOST_BRIDGES: usize = 6;
/// Greatest difference in length of a seam that is tried to join parts: what is sewn plain.
const EVEN: f64 = 0.02;
/// Likelihood below which a pair is not looked at.
const LEAST: f64 = 1e-6;
/// Likelihood from which a pair is compared with what exchanges of equal parts would make of it.
const WEIGHED: f64 = 0.01;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    pub a: usize,
    pub b: usize,
    /// Likelihood when it was stated.
    pub likelihood: f64,
    /// The same, or that of any seam which differs by an exchange of equal parts.
    pub confidence: f64,
}

impl Found {
    fn is_of(&self, a: usize, b: usize) -> bool {
        (self.a, self.b) == (a, b) || (self.a, self.b) == (b, a)
    }
}

pub struct Settled {
    /// The surest first. Stated ones have likelihood 1.
    pub seams: Vec<Found>,
    /// Likelihood of staying free, of each stretch in no seam. 0 for the others.
    pub free: Vec<f64>,
}

/// Seams of the garment. It hangs together: where it falls apart, the likeliest seams that join it are tried.
pub fn seams(garment: &Garment, facts: &Facts) -> Settled {
    let mut best = settled(garment, facts);
    let (mut facts, first) = (facts.clone(), garment.likelihoods(facts));
    for _ in 0..MOST_BRIDGES {
        let apart = best.components(garment);
        if apart == 1 {
            break;
        }
        let joined = Joined::of(garment, &best.seams);
        let left: Vec<usize> = (0..garment.stretches.len()).filter(|&k| facts.of(k).is_none()).collect();
        let mut bridges = pairs(garment, &facts, &left, &first);
        let length = |k: usize| garment.stretches[k].length;
        let is_even = |a: f64, b: f64| (a - b).abs() < EVEN * a.max(b);
        bridges.retain(|bridge| joined.joins(bridge) && is_even(length(bridge.a), length(bridge.b)));
        bridges.truncate(MOST_BRIDGES);
        let tried = bridges.iter().map(|bridge| {
            let mut facts = facts.clone();
            facts.sew(bridge.a, bridge.b);
            let twins = garment.symmetry.twin[bridge.a].zip(garment.symmetry.twin[bridge.b]);
            let twins = twins.filter(|&(a, b)| facts.may_be_sewn(a, b));
            twins.into_iter().for_each(|(a, b)| facts.sew(a, b));
            let mut tried = settled(garment, &facts);
            let is_tried =
                |seam: &Found| seam.is_of(bridge.a, bridge.b) || twins.is_some_and(|(a, b)| seam.is_of(a, b));
            for seam in tried.seams.iter_mut().filter(|seam| is_tried(seam)) {
                (seam.likelihood, seam.confidence) = (bridge.likelihood, bridge.likelihood);
            }
            (tried, facts)
        });
        let better = tried.filter(|(tried, _)| tried.components(garment) < apart);
        let Some((next, with)) = better.max_by(|(p, _), (q, _)| p.evidence().total_cmp(&q.evidence())) else { break };
        (best, facts) = (next, with);
    }
    best
}

fn settled(garment: &Garment, facts: &Facts) -> Settled {
    let count = garment.stretches.len();
    let mut settled = Settled { seams: Vec::new(), free: vec![0.0; count] };
    for k in 0..count {
        match facts.of(k) {
            Some(Fact::Sewn(other)) if k < other => {
                settled.seams.push(Found { a: k, b: other, likelihood: 1.0, confidence: 1.0 })
            }
            Some(Fact::Free) => settled.free[k] = 1.0,
            _ => {}
        }
    }
    let (mut facts, mut least, mut joined) = (facts.clone(), SURE, Joined::of(garment, &settled.seams));
    loop {
        let left: Vec<usize> = (0..count).filter(|&k| facts.of(k).is_none()).collect();
        if left.is_empty() {
            return settled;
        }
        let likely = garment.likelihoods(&facts);
        let mut pairs = pairs(garment, &facts, &left, &likely);
        let most = pairs.first().map_or(0.0, |pair| pair.likelihood);
        let most = left.iter().map(|&k| likely.free(k)).fold(most, f64::max);
        least = f64::min(least, TOGETHER * most);
        pairs.retain(|pair| pair.likelihood >= least);
        for pair in &pairs {
            let is_left = |pair: &Found| facts.of(pair.a).is_none() && facts.of(pair.b).is_none();
            if is_left(pair) && !pairs.iter().any(|other| is_left(other) && joined.prefers(other, pair)) {
                facts.sew(pair.a, pair.b);
                joined.join(pair);
                settled.seams.push(*pair);
            }
        }
        for &k in left.iter().filter(|&&k| likely.free(k) >= least) {
            if facts.of(k).is_none() {
                facts.free(k);
                settled.free[k] = likely.free(k);
            }
        }
    }
}

impl Settled {
    pub fn partner(&self, stretch: usize) -> Option<usize> {
        self.seams.iter().find_map(|seam| match stretch {
            k if k == seam.a => Some(seam.b),
            k if k == seam.b => Some(seam.a),
            _ => None,
        })
    }

    /// Of each stretch: of its seam, or of staying free.
    pub fn confidences(&self) -> Vec<f64> {
        let mut sure = self.free.clone();
        for seam in &self.seams {
            (sure[seam.a], sure[seam.b]) = (seam.confidence, seam.confidence);
        }
        sure
    }

    /// Number of groups of parts that nothing joins.
    fn components(&self, garment: &Garment) -> usize {
        let joined = Joined::of(garment, &self.seams);
        (0..joined.heads.len()).filter(|&part| joined.heads[part] == part).count()
    }

    /// Sum of the logarithms of the likelihoods of all stretches.
    pub fn evidence(&self) -> f64 {
        let sewn = self.seams.iter().map(|seam| 2.0 * seam.likelihood.max(LEAST).ln());
        sewn.chain(self.free.iter().filter(|free| **free > 0.0).map(|free| free.ln())).sum()
    }
}

/// Parts that seams join.
struct Joined {
    part_of: Vec<usize>,
    /// For each part, the first one that it is joined to.
    heads: Vec<usize>,
}

impl Joined {
    fn of(garment: &Garment, seams: &[Found]) -> Self {
        let part_of: Vec<usize> = garment.stretches.iter().map(|stretch| stretch.part).collect();
        let heads = (0..part_of.last().map_or(0, |last| last + 1)).collect();
        let mut joined = Self { part_of, heads };
        seams.iter().for_each(|seam| joined.join(seam));
        joined
    }

    fn join(&mut self, seam: &Found) {
        let [a, b] = [seam.a, seam.b].map(|k| self.heads[self.part_of[k]]);
        self.heads.iter_mut().filter(|head| **head == a.max(b)).for_each(|head| *head = a.min(b));
    }

    fn joins(&self, seam: &Found) -> bool {
        self.heads[self.part_of[seam.a]] != self.heads[self.part_of[seam.b]]
    }

    /// True if another seam of a stretch is nearly as likely, and joins what is not joined: a garment hangs together.
    fn prefers(&self, other: &Found, seam: &Found) -> bool {
        let is_rival = (other.a == seam.a) != (other.b == seam.b) || other.a == seam.b || other.b == seam.a;
        is_rival && other.likelihood >= TOGETHER * seam.likelihood && self.joins(other) && !self.joins(seam)
    }
}

/// The likeliest first.
fn pairs(garment: &Garment, facts: &Facts, left: &[usize], likely: &Likelihoods) -> Vec<Found> {
    let Garment { stretches, symmetry, .. } = garment;
    let mut is_placed = vec![false; symmetry.kind.len()];
    for k in (0..stretches.len()).filter(|&k| matches!(facts.of(k), Some(Fact::Sewn(_)))) {
        is_placed[stretches[k].part] = true;
    }
    // What is sewn to something already can no more be exchanged for its like.
    let is_free = |k: usize| !is_placed[stretches[k].part];
    let is_like = |k: usize, to: usize| k == to || symmetry.like[k] == symmetry.like[to] && is_free(k) && is_free(to);
    let of_like = |from: usize, to: usize| -> f64 {
        left.iter().filter(|&&k| k != from && is_like(k, to)).map(|&k| likely.of(from, k)).sum()
    };
    let mut pairs: Vec<Found> = Vec::new();
    for (at, &a) in left.iter().enumerate() {
        for &b in &left[at + 1..] {
            let likelihood = (likely.of(a, b) * likely.of(b, a)).sqrt();
            if likelihood > LEAST {
                let exchanged = if likelihood > WEIGHED { of_like(a, b).max(of_like(b, a)) } else { 0.0 };
                pairs.push(Found { a, b, likelihood, confidence: exchanged.max(likelihood) });
            }
        }
    }
    pairs.sort_by(|p, q| q.likelihood.total_cmp(&p.likelihood).then((p.a, p.b).cmp(&(q.a, q.b))));
    pairs
}
