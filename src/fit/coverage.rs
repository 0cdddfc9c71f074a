//! Search for the sizes that fit the most people.
//!
//! A series of sizes is made by a few *parameters*, which all sizes share: how far the sample size departs from the
//! present pattern, and the steps from size to size. The *turn* of a parameter is the number of its steps. A size fits a
//! person if every length that the person asks for lies in its band. A series covers a person if one of its sizes fits.
//!
//! Lengths are linear in the turns. Along a line in the space of turns, a person is therefore fitted on a few
//! intervals, and the best point of the line is found exactly. The search optimises along many lines in turn, from
//! several starts and from perturbations of the best series (iterated local search [Lourenco 2003]).

use crate::Draw;

/// Length of a size that a person needs to lie in a band.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Change of the length with one step of each parameter.
    pub per_step: Vec<f64>,
    /// Least and greatest admissible change, from the length with no parameter turned.
    pub band: [f64; 2],
}

impl Asked {
    pub fn change(&self, turns: &[i32]) -> f64 {
        self.per_step.iter().zip(turns).map(|(a, turn)| a * f64::from(*turn)).sum()
    }
}

pub type Asks = Vec<Asked>;

#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    pub weights: Vec<f64>,
    pub between: [f64; 2],
}

#[derive(Clone, Debug)]
pub struct Search<'a> {
    /// Lengths that people ask of sizes, by size, then by person.
    pub asks: &'a [Vec<Asks>],
    pub bounds: &'a [Bound],
    /// Weighted sums of turns that are zero in a series of the default grade.
    pub habits: &'a [Vec<f64>],
    /// Number of further people that must be covered for each step by which such a sum departs from zero.
    pub price: f64,
}

pub type Turns = Vec<i32>;

#[derive(Clone)]
struct Candidate {
    worth: f64,
    turns: Turns,
}

/// Greatest number of passes over all lines. A pass without gain ends the search earlier.
const ROUNDS: usize = 40;
/// Number of perturbations of the best series from which the search starts again. Judgement.
const SHAKES: usize = 20;
/// Greatest perturbation of a turn, steps. Judgement: a smaller one may lead back to the same optimum.
const SHAKE: usize = 20;
/// Greatest number of steps along a line where no bound is nearer.
const FAR: i32 = 1000;

impl Search<'_> {
    pub fn covered(&self, turns: &[i32]) -> usize {
        (0..self.people()).filter(|&person| self.asks.iter().any(|size| is_met(&size[person], turns))).count()
    }

    /// Objective: number of people that a series covers, less the price of its departures from the default grade.
    fn worth(&self, turns: &[i32]) -> f64 {
        self.covered(turns) as f64 - self.price * self.departure(turns)
    }

    /// Sum of the departures from the default grade, steps.
    fn departure(&self, turns: &[i32]) -> f64 {
        self.habits.iter().map(|weights| sum(weights, turns).abs()).sum()
    }

    pub fn best(&self, starts: &[Turns], seed: u64) -> Turns {
        let mut random = Draw::new(seed);
        let mut best = starts.iter().map(|start| self.improved(start.clone())).fold(None, better);
        for _ in 0..SHAKES {
            let Some(Candidate { turns, .. }) = &best else { break };
            best = better(best.clone(), self.improved(self.shaken(turns, &mut random)));
        }
        best.map_or_else(Vec::new, |best| best.turns)
    }

    pub fn near(&self, turns: &[i32]) -> (f64, Turns) {
        let Candidate { worth, turns } = self.improved(turns.to_vec());
        (worth, turns)
    }

    fn people(&self) -> usize {
        self.asks.first().map_or(0, Vec::len)
    }

    /// Perturbs every turn of a series at random, one after the other, as far as the bounds let it.
    fn shaken(&self, turns: &[i32], random: &mut Draw) -> Turns {
        let mut shaken = turns.to_vec();
        for parameter in 0..turns.len() {
            let mut line = vec![0; turns.len()];
            line[parameter] = 1;
            let [least, most] = self.reach(&shaken, &line);
            let by = random.below(2 * SHAKE + 1) as i32 - SHAKE as i32;
            shaken[parameter] += by.clamp(least.min(0), most.max(0));
        }
        shaken
    }

    fn improved(&self, mut turns: Turns) -> Candidate {
        let lines = lines(turns.len());
        let mut worth = self.worth(&turns);
        for _ in 0..ROUNDS {
            let before = worth;
            for line in &lines {
                let (most, by) = self.along(&turns, line);
                if most >= worth {
                    worth = most;
                    turns.iter_mut().zip(line).for_each(|(turn, way)| *turn += by * way);
                }
            }
            if worth <= before {
                break;
            }
        }
        // Evaluated again: at the very end of an interval, a person may be fitted by rounding alone.
        Candidate { worth: self.worth(&turns), turns }
    }

    /// Greatest objective along a line, and steps to it: among equals, to the middle of the longest interval.
    fn along(&self, turns: &[i32], line: &[i32]) -> (f64, i32) {
        let [least, most] = self.reach(turns, line);
        let mut steps = vec![0; (most - least + 2) as usize];
        let mut intervals: Vec<[i32; 2]> = Vec::with_capacity(self.asks.len());
        for person in 0..self.people() {
            intervals.clear();
            for size in self.asks {
                let mut interval = [least, most];
                for asked in &size[person] {
                    narrow(&mut interval, asked, turns, line);
                    if interval[0] > interval[1] {
                        break;
                    }
                }
                if interval[0] <= interval[1] {
                    intervals.push(interval);
                }
            }
            // Each person counts once, even if intervals overlap.
            intervals.sort_unstable();
            let mut end = least - 1;
            for &[from, to] in &intervals {
                let from = from.max(end + 1);
                if from <= to {
                    steps[(from - least) as usize] += 1;
                    steps[(to - least + 1) as usize] -= 1;
                    end = to;
                }
            }
        }
        let mut people = 0;
        let worths = (least..=most).zip(&steps).map(|(by, step)| {
            people += step;
            let moved: Turns = turns.iter().zip(line).map(|(turn, way)| turn + by * way).collect();
            f64::from(people) - self.price * self.departure(&moved)
        });
        let (worth, by) = longest_best(worths);
        (worth, least + by)
    }

    fn reach(&self, turns: &[i32], line: &[i32]) -> [i32; 2] {
        let mut reach = [-FAR, FAR];
        for Bound { weights, between: [least, most] } in self.bounds {
            let (at, way) = (sum(weights, turns), sum(weights, line));
            if way == 0.0 {
                continue;
            }
            // Where a bound is not kept, no step leads further away from it.
            let ends = [(at - least).max(0.0) / way, (most - at).max(0.0) / way];
            let [back, on] = if way > 0.0 { [-ends[0], ends[1]] } else { [ends[1], -ends[0]] };
            reach = [reach[0].max((back - SLIGHT).ceil() as i32), reach[1].min((on + SLIGHT).floor() as i32)];
        }
        [reach[0].min(0), reach[1].max(0)]
    }
}

/// Share of a step by which a bound may be missed by rounding.
const SLIGHT: f64 = 1e-9;

fn sum(weights: &[f64], turns: &[i32]) -> f64 {
    weights.iter().zip(turns).map(|(weight, turn)| weight * f64::from(*turn)).sum()
}

/// Search directions: one parameter, or two of them, alike or against each other.
fn lines(parameters: usize) -> Vec<Turns> {
    let mut lines = Vec::new();
    for parameter in 0..parameters {
        let mut line = vec![0; parameters];
        line[parameter] = 1;
        lines.push(line.clone());
        for (other, sign) in (0..parameter).flat_map(|other| [(other, 1), (other, -1)]) {
            let mut both = line.clone();
            both[other] = sign;
            lines.push(both);
        }
    }
    lines
}

pub fn is_met(asks: &Asks, turns: &[i32]) -> bool {
    asks.iter().all(|asked| (asked.band[0]..=asked.band[1]).contains(&asked.change(turns)))
}

/// Better of two candidates, or the first of equals.
fn better(best: Option<Candidate>, next: Candidate) -> Option<Candidate> {
    best.filter(|best| best.worth >= next.worth).or(Some(next))
}

fn narrow(interval: &mut [i32; 2], asked: &Asked, turns: &[i32], way: &[i32]) {
    let (value, by) = (asked.change(turns), asked.change(way));
    let [least, most] = asked.band.map(|bound| bound - value);
    if by == 0.0 {
        if least > 0.0 || most < 0.0 {
            *interval = [1, 0];
        }
        return;
    }
    let [from, to] = if by > 0.0 { [least / by, most / by] } else { [most / by, least / by] };
    // Casts saturate, and the interval is bounded.
    *interval = [interval[0].max(from.ceil() as i32), interval[1].min(to.floor() as i32)];
}

/// Greatest of some values, and the index at the middle of the longest run of that value.
fn longest_best(values: impl Iterator<Item = f64>) -> (f64, i32) {
    let (mut best, mut run, mut length) = (f64::NEG_INFINITY, 0, 0);
    let mut open: Option<usize> = None;
    for (place, value) in values.enumerate() {
        if value > best {
            (best, run, length, open) = (value, place, 1, Some(place));
        } else if value == best {
            let from = *open.get_or_insert(place);
            if place + 1 - from > length {
                (run, length) = (from, place + 1 - from);
            }
        } else {
            open = None;
        }
    }
    (best, (run + length.saturating_sub(1) / 2) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_a_line(bands: &[[f64; 2]]) -> Vec<Asks> {
        bands.iter().map(|band| vec![Asked { per_step: vec![1.0], band: *band }]).collect()
    }

    /// The most people that `count` places on a line can stand for, by dynamic programming over the ends of their bands.
    fn most(bands: &[[f64; 2]], count: usize) -> usize {
        let mut bands: Vec<[i32; 2]> = bands.iter().map(|[a, b]| [a.ceil() as i32, b.floor() as i32]).collect();
        bands.sort_unstable();
        let places: Vec<i32> = bands.iter().map(|band| band[1]).collect();
        // By the last place chosen: people fitted so far.
        let fitted = |place: i32, last: Option<i32>| {
            let is_new = |band: &&[i32; 2]| {
                (band[0]..=band[1]).contains(&place) && last.is_none_or(|last| !(band[0]..=band[1]).contains(&last))
            };
            bands.iter().filter(is_new).count()
        };
        let mut best: Vec<usize> = places.iter().map(|place| fitted(*place, None)).collect();
        for _ in 1..count {
            let next = |place: &i32| {
                let before = places.iter().zip(&best).filter(|(last, _)| *last <= place);
                before.map(|(last, best)| best + fitted(*place, Some(*last))).max().unwrap_or(0)
            };
            best = places.iter().map(next).collect();
        }
        best.into_iter().max().unwrap_or(0)
    }

    fn within(parameters: usize, between: [f64; 2]) -> Vec<Bound> {
        let one = |k: usize| Bound { weights: (0..parameters).map(|j| f64::from(u8::from(j == k))).collect(), between };
        (0..parameters).map(one).collect()
    }

    #[test]
    fn on_a_line_no_series_fits_more() {
        let mut random = Draw::new(7);
        for count in 1..=4 {
            let mut band = || {
                let middle = 80.0 * random.normal();
                [middle - 15.0 - 10.0 * random.share(), middle + 20.0]
            };
            let bands: Vec<[f64; 2]> = (0..150).map(|_| band()).collect();
            // A parameter for each size.
            let size = |size: usize| {
                let person = |asks: Asks| -> Asks {
                    let own = |asked: Asked| Asked {
                        per_step: (0..count).map(|k| if k == size { 1.0 } else { 0.0 }).collect(),
                        ..asked
                    };
                    asks.into_iter().map(own).collect()
                };
                on_a_line(&bands).into_iter().map(person).collect()
            };
            let asks: Vec<Vec<Asks>> = (0..count).map(size).collect();
            let bounds = within(count, [-300.0, 300.0]);
            let search = Search { asks: &asks, bounds: &bounds, habits: &[], price: 0.0 };
            let spread = |step: i32| (0..count as i32).map(|k| step * (2 * k + 1 - count as i32)).collect();
            let starts: Vec<Turns> = [10, 20, 40].map(spread).to_vec();
            let found = search.best(&starts, 1);
            assert_eq!(search.covered(&found), most(&bands, count), "{count} sizes: {found:?}");
            assert_eq!(found, search.best(&starts, 1), "the same seed, the same sizes");
        }
    }

    /// People in groups about places on a line, and sizes at even steps from a middle: parameters are middle and step.
    fn even(places: &[f64], count: usize, half: f64) -> Vec<Vec<Asks>> {
        let mut random = Draw::new(3);
        let people: Vec<f64> =
            places.iter().flat_map(|place| (0..40).map(|_| place + random.share() - 0.5).collect::<Vec<_>>()).collect();
        let size = |size: usize| {
            let step = size as f64 - (count - 1) as f64 / 2.0;
            let asks = |place: &f64| vec![Asked { per_step: vec![1.0, step], band: [place - half, place + half] }];
            people.iter().map(asks).collect()
        };
        (0..count).map(size).collect()
    }

    #[test]
    fn groups_at_even_steps_are_all_fitted_and_others_are_not() {
        let check = |places: &[f64], count: usize, expect: usize| {
            let asks = even(places, count, 6.0);
            let search = Search { asks: &asks, bounds: &within(2, [-200.0, 200.0]), habits: &[], price: 0.0 };
            let found = search.best(&[vec![0, 20], vec![0, 40]], 5);
            assert_eq!(search.covered(&found), expect, "{found:?}");
        };
        check(&[-60.0, 0.0, 60.0], 3, 120);
        // No even steps meet groups that lie at uneven ones, and two sizes no three groups.
        check(&[-60.0, -20.0, 70.0], 3, 80);
        check(&[-60.0, 0.0, 60.0], 2, 80);
        check(&[-60.0, 0.0, 60.0], 1, 40);
    }

    #[test]
    fn a_parameter_keeps_its_habit_and_its_bound() {
        // The second length may be anything between wide bounds, but for a few people who ask for more.
        let person = |place: f64, more: f64| -> Asks {
            vec![
                Asked { per_step: vec![1.0, 0.0], band: [place - 5.0, place + 5.0] },
                Asked { per_step: vec![0.0, 1.0], band: [more, 100.0] },
            ]
        };
        let check = |eager: usize, price: f64, most: f64, expect: i32| {
            let people = (0..40).map(|k| person(30.0, if k < eager { 40.0 } else { -50.0 })).collect();
            let asks = vec![people];
            let mut bounds = within(2, [-100.0, 100.0]);
            // The second is at most `most` times the first.
            bounds.push(Bound { weights: vec![most, -1.0], between: [0.0, 1e9] });
            let habits = [vec![-0.5, 1.0]];
            let search = Search { asks: &asks, bounds: &bounds, habits: &habits, price };
            let found = search.best(&[vec![0, 0]], 1);
            assert!((25..=35).contains(&found[0]), "{found:?}");
            assert!((found[1] - expect).abs() <= 3, "{found:?}, not {expect}");
        };
        check(0, 0.1, 9.0, 15);
        // 23 steps off its habit cost 2.3 people of those 3, and 23 of them.
        check(3, 0.1, 9.0, 40);
        check(3, 1.0, 9.0, 15);
        check(3, 0.1, 1.0, 15);
    }

    #[test]
    fn what_no_size_can_have_is_not_counted() {
        let impossible =
            vec![Asked { per_step: vec![1.0], band: [5.0, 6.0] }, Asked { per_step: vec![0.0], band: [1.0, 2.0] }];
        let possible = vec![Asked { per_step: vec![1.0], band: [4.0, 9.0] }];
        let asks = vec![vec![impossible, possible]];
        let bounds = within(1, [0.0, 8.0]);
        let search = Search { asks: &asks, bounds: &bounds, habits: &[], price: 0.0 };
        let found = search.best(&[vec![0]], 1);
        // The middle of the interval that the bound leaves.
        assert_eq!((search.covered(&found), found), (1, vec![6]));
    }
}
