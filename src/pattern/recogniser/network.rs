//! Network that weighs the evidence: for each stretch, the likelihood of each partner and of staying free.
//!
//! Stretches pass what they know along their outline, to their mirror images and to the whole garment. In each round all
//! pairs are scored, with what the round before found of them, of their neighbours and of their rivals, and each
//! stretch hears of its likely partners. `examples/recogniser/fit.py` fits the weights.

use std::sync::LazyLock;

use super::evidence::{self, CLASSES, Evidence, PAIR, PLACE, SAID, SHAPE};
use super::facts::Facts;
use super::joints::{JOINTS, Joints};
use super::stretch::{Part, Stretch, stretches};
use super::symmetry::{Symmetry, symmetry};
use crate::trade::{Class, Face};

const WIDTH: usize = 48;
const RANK: usize = 16;
const ROUNDS: usize = 3;
/// Width of the first layer that scores a pair.
const SCORE: usize = 32;
const SECOND: usize = 16;
/// Numbers of a pair that a round hands to the next.
const HANDED: usize = 9;

/// Half floats, in the order in which [`Network::read`] takes them.
const WEIGHTS: &[u8] = include_bytes!("weights.bin");
static NETWORK: LazyLock<Network> = LazyLock::new(|| Network::read(WEIGHTS));

/// Likelihoods of the partners of each stretch.
#[derive(Clone, Debug, PartialEq)]
pub struct Likelihoods {
    count: usize,
    /// For each stretch, each other one, then free. A row sums to 1.
    rows: Vec<f32>,
    /// Of each part.
    pub kinds: Vec<Kind>,
}

/// Likelihoods of what a part is.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// In the order of [`CLASSES`].
    classes: Vec<f32>,
    /// Front, back, neither.
    faces: Vec<f32>,
    /// Right, left, both.
    hands: Vec<f32>,
}

impl Kind {
    fn of(scores: &[f32]) -> Self {
        let (classes, rest) = scores.split_at(CLASSES.len());
        Self { classes: shares(classes), faces: shares(&rest[..3]), hands: shares(&rest[3..]) }
    }

    /// Likeliest class, with its likelihood.
    pub fn class(&self) -> (Class, f64) {
        let (best, likelihood) = likeliest(&self.classes);
        (CLASSES[best], likelihood)
    }

    pub fn face(&self) -> (Option<Face>, f64) {
        let (best, likelihood) = likeliest(&self.faces);
        (Face::BOTH.get(best).copied(), likelihood)
    }

    /// Of the right hand less that of the left.
    pub fn rightness(&self) -> f64 {
        f64::from(self.hands[0] - self.hands[1])
    }

    /// Of covering both sides.
    pub fn bothness(&self) -> f64 {
        f64::from(self.hands[2])
    }
}

fn likeliest(shares: &[f32]) -> (usize, f64) {
    let best = (0..shares.len()).rev().max_by(|&a, &b| shares[a].total_cmp(&shares[b])).unwrap_or(0);
    (best, f64::from(shares[best]))
}

/// Exponentials as shares of their sum.
fn shares(scores: &[f32]) -> Vec<f32> {
    let most = scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let sum: f32 = scores.iter().map(|score| (score - most).exp()).sum();
    scores.iter().map(|score| (score - most).exp() / sum).collect()
}

impl Likelihoods {
    pub fn of(&self, from: usize, to: usize) -> f64 {
        f64::from(self.rows[from * (self.count + 1) + to])
    }

    pub fn free(&self, from: usize) -> f64 {
        self.of(from, self.count)
    }
}

/// Garment as the network sees it.
pub struct Garment {
    pub stretches: Vec<Stretch>,
    pub symmetry: Symmetry,
    seen: Evidence,
    pairs: Vec<[f32; PAIR]>,
}

impl Garment {
    pub fn of(parts: &[Part]) -> Self {
        let stretches = stretches(parts);
        let symmetry = symmetry(parts, &stretches);
        let seen = evidence::evidence(parts, &stretches, &symmetry);
        let count = stretches.len();
        let pairs = (0..count * count).map(|k| evidence::pair(&stretches, &symmetry, k / count, k % count)).collect();
        Self { stretches, symmetry, seen, pairs }
    }

    /// Likelihoods of what is not stated, given what is.
    pub fn likelihoods(&self, facts: &Facts) -> Likelihoods {
        NETWORK.likelihoods(self, facts)
    }
}

/// Affine map, row-major by input.
struct Layer {
    inputs: usize,
    outputs: usize,
    weights: Vec<f32>,
    offsets: Vec<f32>,
}

struct Round {
    rank: Vec<Layer>,
    own: Vec<Layer>,
    score: Vec<Layer>,
    second: Vec<Layer>,
    free: Vec<Layer>,
    message: Vec<Layer>,
    update: Vec<Layer>,
}

struct Network {
    enter: Vec<Layer>,
    kind: Vec<Layer>,
    around: Vec<Vec<Layer>>,
    rounds: Vec<Round>,
}

struct Reader<'w> {
    weights: &'w [u8],
}

impl Reader<'_> {
    fn numbers(&mut self, count: usize) -> Vec<f32> {
        let (taken, rest) = self.weights.split_at(2 * count);
        self.weights = rest;
        taken.chunks_exact(2).map(|bytes| half::f16::from_le_bytes([bytes[0], bytes[1]]).to_f32()).collect()
    }

    fn layers(&mut self, sizes: &[usize]) -> Vec<Layer> {
        let layer = |ends: &[usize]| {
            let (inputs, outputs) = (ends[0], ends[1]);
            Layer { inputs, outputs, weights: self.numbers(inputs * outputs), offsets: self.numbers(outputs) }
        };
        sizes.windows(2).map(layer).collect()
    }
}

impl Network {
    fn read(weights: &[u8]) -> Self {
        let mut reader = Reader { weights };
        let around = (0..2).map(|_| reader.layers(&[7 * WIDTH, 64, WIDTH])).collect();
        let enter = reader.layers(&[SHAPE + PLACE + SAID, 64, WIDTH]);
        let kind = reader.layers(&[WIDTH, 32, CLASSES.len() + 6]);
        let round = |_| Round {
            free: reader.layers(&[WIDTH + 2, 16, 1]),
            message: reader.layers(&[WIDTH, WIDTH]),
            rank: reader.layers(&[WIDTH, 2 * RANK]),
            score: reader.layers(&[PAIR + RANK + HANDED + JOINTS, SCORE]),
            second: reader.layers(&[SCORE, SECOND, 1]),
            own: reader.layers(&[WIDTH, SCORE]),
            update: reader.layers(&[8 * WIDTH + 1, 64, WIDTH]),
        };
        let rounds = (0..ROUNDS).map(round).collect();
        assert!(reader.weights.is_empty(), "as many weights as layers need");
        Self { enter, kind, around, rounds }
    }

    fn likelihoods(&self, garment: &Garment, facts: &Facts) -> Likelihoods {
        let Garment { stretches, symmetry, seen, pairs } = garment;
        let count = stretches.len();
        let enter = |k: usize| {
            let inputs = seen.shape[k].iter().chain(&seen.place[k]).chain(&seen.said[k]);
            dense(&self.enter, inputs.copied().collect())
        };
        let mut state = State { rows: (0..count).map(enter).collect(), stretches, symmetry };
        for block in &self.around {
            state.add(block, |_| Vec::new());
        }
        let joints = Joints::of(stretches, facts);
        let stated = |k: usize| facts.row(k, count).unwrap_or_else(|| vec![0.0; count + 1]);
        let mut found = Found { rows: (0..count).flat_map(stated).collect(), count };
        let mut handed = found.handed(&vec![0.0; count * count], stretches, symmetry);
        for round in &self.rounds {
            let scores = round.scores(&state, &Pairs { drawn: pairs, handed: &handed, joints: &joints, facts });
            found = Found { rows: round.rows(&state, &scores, &found, facts), count };
            handed = found.handed(&scores, stretches, symmetry);
            let messages: Vec<Vec<f32>> = state.rows.iter().map(|row| dense(&round.message, row.clone())).collect();
            state.add(&round.update, |k| {
                let mut heard = vec![0.0; WIDTH];
                for (other, message) in messages.iter().enumerate() {
                    let share = found.of(k, other);
                    heard.iter_mut().zip(message).for_each(|(sum, number)| *sum += share * number);
                }
                heard.push(found.free(k));
                heard
            });
        }
        let kinds = state.of_parts().into_iter().map(|row| Kind::of(&dense(&self.kind, row))).collect();
        Likelihoods { count, rows: found.rows, kinds }
    }
}

/// Applies layers, with rectified outputs between them.
fn dense(layers: &[Layer], mut row: Vec<f32>) -> Vec<f32> {
    for (k, layer) in layers.iter().enumerate() {
        row = layer.of(&row);
        if k + 1 < layers.len() {
            rectify(&mut row);
        }
    }
    row
}

fn rectify(row: &mut [f32]) {
    row.iter_mut().for_each(|number| *number = number.max(0.0));
}

impl Layer {
    fn of(&self, row: &[f32]) -> Vec<f32> {
        let mut sums = self.offsets.clone();
        self.add(row, &mut sums);
        sums
    }

    fn add(&self, row: &[f32], sums: &mut [f32]) {
        debug_assert_eq!(row.len(), self.inputs);
        for (&number, weights) in row.iter().zip(self.weights.chunks_exact(self.outputs)) {
            if number != 0.0 {
                sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += number * weight);
            }
        }
    }
}

/// State of each stretch.
struct State<'s> {
    rows: Vec<Vec<f32>>,
    stretches: &'s [Stretch],
    symmetry: &'s Symmetry,
}

impl State<'_> {
    /// Mean of the states of each part.
    fn of_parts(&self) -> Vec<Vec<f32>> {
        let parts = self.stretches.last().map_or(0, |last| last.part + 1);
        let (mut sums, mut members) = (vec![vec![0.0; WIDTH]; parts], vec![0.0_f32; parts]);
        for (row, stretch) in self.rows.iter().zip(self.stretches) {
            sums[stretch.part].iter_mut().zip(row).for_each(|(sum, number)| *sum += number);
            members[stretch.part] += 1.0;
        }
        for (sum, members) in sums.iter_mut().zip(members) {
            sum.iter_mut().for_each(|sum| *sum /= members);
        }
        sums
    }

    /// Adds to each state what a block makes of it, its surroundings and `more`.
    fn add(&mut self, block: &[Layer], more: impl Fn(usize) -> Vec<f32>) {
        let of_part = self.of_parts();
        let mut whole = vec![0.0; WIDTH];
        for row in &self.rows {
            whole.iter_mut().zip(row).for_each(|(sum, number)| *sum += number);
        }
        whole.iter_mut().for_each(|sum| *sum /= self.rows.len() as f32);
        let nothing = vec![0.0; WIDTH];
        let change = |k: usize| {
            let stretch = &self.stretches[k];
            let of = |index: Option<usize>| index.map_or(&nothing, |index| &self.rows[index]);
            let mut inputs: Vec<f32> = Vec::with_capacity(8 * WIDTH + 1);
            for row in [
                &self.rows[k],
                &self.rows[stretch.next],
                &self.rows[stretch.previous],
                of(self.symmetry.own[k]),
                of(self.symmetry.twin[k]),
            ] {
                inputs.extend(row);
            }
            inputs.extend(&of_part[stretch.part]);
            inputs.extend(&whole);
            inputs.extend(more(k));
            dense(block, inputs)
        };
        let changes: Vec<Vec<f32>> = (0..self.rows.len()).map(change).collect();
        for (row, change) in self.rows.iter_mut().zip(&changes) {
            row.iter_mut().zip(change).for_each(|(number, change)| *number += change);
        }
    }
}

/// Evidence of all pairs in a round.
struct Pairs<'p> {
    drawn: &'p [[f32; PAIR]],
    handed: &'p [[f32; HANDED]],
    joints: &'p Joints,
    facts: &'p Facts,
}

impl Round {
    /// Of each pair that may be sewn, the same in both directions.
    fn scores(&self, state: &State<'_>, pairs: &Pairs<'_>) -> Vec<f32> {
        let count = state.rows.len();
        let ranks: Vec<Vec<f32>> = state.rows.iter().map(|row| dense(&self.rank, row.clone())).collect();
        let own: Vec<Vec<f32>> = state.rows.iter().map(|row| dense(&self.own, row.clone())).collect();
        let mut inputs = [0.0; PAIR + RANK + HANDED + JOINTS];
        let mut directed = |i: usize, j: usize| {
            let at = i * count + j;
            inputs[..PAIR].copy_from_slice(&pairs.drawn[at]);
            for k in 0..RANK {
                inputs[PAIR + k] = ranks[i][k] * ranks[j][RANK + k] + ranks[i][RANK + k] * ranks[j][k];
            }
            inputs[PAIR + RANK..PAIR + RANK + HANDED].copy_from_slice(&pairs.handed[at]);
            inputs[PAIR + RANK + HANDED..].copy_from_slice(&pairs.joints.of_pair(i, j));
            let mut first = [0.0; SCORE];
            for (k, sum) in first.iter_mut().enumerate() {
                *sum = self.score[0].offsets[k] + own[i][k] + own[j][k];
            }
            self.score[0].add(&inputs, &mut first);
            rectify(&mut first);
            let mut second = [0.0; SECOND];
            second.copy_from_slice(&self.second[0].offsets);
            self.second[0].add(&first, &mut second);
            rectify(&mut second);
            let mut last = [self.second[1].offsets[0]];
            self.second[1].add(&second, &mut last);
            last[0]
        };
        let mut scores = vec![0.0; count * count];
        for i in 0..count {
            for j in (i + 1..count).filter(|&j| pairs.facts.may_be_sewn(i, j)) {
                let score = 0.5 * (directed(i, j) + directed(j, i));
                (scores[i * count + j], scores[j * count + i]) = (score, score);
            }
        }
        scores
    }

    /// Likelihoods by the scores of the partners and of staying free.
    fn rows(&self, state: &State<'_>, scores: &[f32], before: &Found, facts: &Facts) -> Vec<f32> {
        let count = state.rows.len();
        let mut rows = Vec::with_capacity(count * (count + 1));
        for (k, row) in state.rows.iter().enumerate() {
            if let Some(stated) = facts.row(k, count) {
                rows.extend(stated);
                continue;
            }
            let doubt = [before.free(k), before.best(k)[1]];
            let free = dense(&self.free, row.iter().chain(&doubt).copied().collect())[0];
            let score = |other: usize| match facts.may_be_sewn(k, other) {
                true => scores[k * count + other],
                false => f32::NEG_INFINITY,
            };
            let own = (0..count).map(score);
            rows.extend(shares(&own.chain([free]).collect::<Vec<f32>>()));
        }
        rows
    }
}

struct Found {
    rows: Vec<f32>,
    count: usize,
}

impl Found {
    fn of(&self, from: usize, to: usize) -> f32 {
        if from == to { 0.0 } else { self.rows[from * (self.count + 1) + to] }
    }

    fn free(&self, from: usize) -> f32 {
        self.rows[from * (self.count + 1) + self.count]
    }

    /// Second-best likelihood, then the best.
    fn best(&self, from: usize) -> [f32; 2] {
        (0..self.count).map(|to| self.of(from, to)).fold([0.0; 2], |[second, best], found| match found {
            found if found > best => [best, found],
            found => [second.max(found), best],
        })
    }

    /// Geometric mean of both directions.
    fn both(&self, pair: Option<(usize, usize)>) -> f32 {
        let of_pair = |(i, j): (usize, usize)| (self.of(i, j) * self.of(j, i) + 1e-9).sqrt();
        pair.filter(|(i, j)| i != j).map_or(0.0, of_pair)
    }

    fn handed(&self, scores: &[f32], stretches: &[Stretch], symmetry: &Symmetry) -> Vec<[f32; HANDED]> {
        let best: Vec<[f32; 2]> = (0..self.count).map(|k| self.best(k)).collect();
        let of_pair = |at: usize| {
            let (i, j) = (at / self.count, at % self.count);
            let (a, b) = (self.of(i, j), self.of(j, i));
            let [p, q] = [i, j].map(|k| &stretches[k]);
            let rival = |from: usize, own: f32| if own >= best[from][1] { best[from][0] } else { best[from][1] };
            [
                self.both(Some((i, j))),
                self.both(Some((p.previous, q.next))),
                self.both(Some((p.next, q.previous))),
                self.both(symmetry.twin[i].zip(symmetry.twin[j])),
                self.both(symmetry.own[i].zip(symmetry.own[j])),
                (scores[at] / 10.0).clamp(-2.0, 2.0),
                rival(i, a) + rival(j, b),
                self.both(symmetry.own[i].zip(symmetry.twin[j])) + self.both(symmetry.twin[i].zip(symmetry.own[j])),
                a * (1.0 - b) + b * (1.0 - a),
            ]
        };
        (0..self.count * self.count).map(of_pair).collect()
    }
}
