//! Search for the sizes that fit the most people.
//!
//! A pattern is graded by some of its parameters, here called *knobs*. The *turn* of a knob is the number of its steps
//! away from the present pattern, and a size is the turns of all knobs. A size fits a person if every length that the
//! person asks for lies in its band. A series covers a person if one of its sizes fits.
//!
//! Lengths are linear in the turns. Along a line in the space of turns, a person is therefore fitted on a few
//! intervals, and the best point of the line is found exactly. The search optimises along many lines in turn, from many
//! starts and from perturbations of the best series (iterated local search [Lourenco 2003]).

use crate::Draw;

/// Length of a size that a person needs to lie in a band.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Change of the length with one step of each knob.
    pub per_step: Vec<f64>,
    /// Least and greatest admissible change, from the length with no knob turned.
    pub band: [f64; 2],
}

impl Asked {
    /// Change of the length at some turns.
    #[must_use]
    pub fn change(&self, turns: &[i32]) -> f64 {
        self.per_step.iter().zip(turns).map(|(a, turn)| a * f64::from(*turn)).sum()
    }
}

/// All lengths that a person asks of a size.
pub type Asks = Vec<Asked>;

/// Rule for the steps from size to size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Series {
    /// Steps may differ, but no knob turns back from one size to the next.
    #[default]
    Rising,
    /// All steps are equal.
    Even,
}

/// Problem of the search.
#[derive(Clone, Debug)]
pub struct Search<'a> {
    /// Lengths that people ask of sizes, by size, then by person.
    pub asks: &'a [Vec<Asks>],
    /// Least and greatest turn of each knob.
    pub limits: &'a [[i32; 2]],
    /// Default grade: steps of each knob per step of the first knob.
    pub habits: &'a [f64],
    /// Number of further people that must be covered for each step by which a knob departs from its default grade.
    pub price: f64,
    /// Rule for the steps from size to size.
    pub series: Series,
}

/// Turns of the knobs of every size, the smallest size first.
pub type Turns = Vec<Vec<i32>>;

/// A series with the value of its objective.
#[derive(Clone)]
struct Candidate {
    worth: f64,
    turns: Turns,
}

/// Greatest number of passes over all lines. A pass without gain ends the search earlier.
const ROUNDS: usize = 40;
/// Shares of the people left out at either end for a start, %: large ones gather the sizes round the middle.
const TAILS: [usize; 4] = [0, 10, 20, 30];
/// Number of perturbations of the best series from which the search starts again. Judgement.
const SHAKES: usize = 30;
/// Greatest perturbation of a turn, steps. Judgement: a smaller one may lead back to the same optimum.
const SHAKE: usize = 25;
/// Number of sweeps of coordinate descent for the turns that suit one person. Judgement.
const SWEEPS: usize = 60;

impl Search<'_> {
    /// Number of people that at least one size of a series fits.
    #[must_use]
    pub fn covered(&self, turns: &Turns) -> usize {
        (0..self.people()).filter(|&person| (0..turns.len()).any(|size| self.fits(size, person, &turns[size]))).count()
    }

    /// Objective: number of people that a series covers, less the price of its departures from the default grade.
    fn worth(&self, turns: &Turns) -> f64 {
        self.covered(turns) as f64 - self.price * turns.iter().map(|size| self.departure(size)).sum::<f64>()
    }

    /// Sum of the departures of the knobs of a size from the default grade, steps.
    fn departure(&self, size: &[i32]) -> f64 {
        let first = size.first().map_or(0.0, |turn| f64::from(*turn));
        size.iter().zip(self.habits).skip(1).map(|(turn, habit)| (f64::from(*turn) - habit * first).abs()).sum()
    }

    /// Best series found, with as many sizes as [`Search::asks`] has.
    #[must_use]
    pub fn best(&self, seed: u64) -> Turns {
        let mut random = Draw::new(seed);
        let mut best = self.starts().into_iter().map(|start| self.improved(start)).fold(None, better);
        for _ in 0..SHAKES {
            let Some(Candidate { turns, .. }) = &best else { break };
            best = better(best.clone(), self.improved(self.shaken(turns, &mut random)));
        }
        best.map_or_else(Vec::new, |best| best.turns)
    }

    /// Local optimum that the search reaches from a series.
    #[must_use]
    pub fn near(&self, turns: &Turns) -> Turns {
        self.improved(turns.clone()).turns
    }

    fn people(&self) -> usize {
        self.asks.first().map_or(0, Vec::len)
    }

    fn fits(&self, size: usize, person: usize, turns: &[i32]) -> bool {
        is_met(&self.asks[size][person], turns)
    }

    /// Turns, within the limits, that bring the lengths of a person nearest to the middles of their bands: least
    /// squares in units of the widths of the bands.
    fn ideal(&self, person: usize) -> Vec<f64> {
        let mut turns = vec![0.0; self.limits.len()];
        for _ in 0..SWEEPS {
            for knob in 0..turns.len() {
                let (mut slope, mut off) = (1e-9, 0.0);
                for asked in &self.asks[0][person] {
                    let weight = (asked.band[1] - asked.band[0]).max(1e-9).powi(-2);
                    let value: f64 = asked.per_step.iter().zip(&turns).map(|(a, turn)| a * turn).sum();
                    let by = asked.per_step[knob];
                    slope += weight * by * by;
                    off += weight * by * (0.5 * (asked.band[0] + asked.band[1]) - value);
                }
                let [least, most] = self.limits[knob].map(f64::from);
                turns[knob] = (turns[knob] + off / slope).clamp(least, most);
            }
        }
        turns
    }

    /// Initial series: people sorted by their ideal turn of the first knob, a share left out at either end, and the
    /// rest in as many groups as there are sizes.
    fn starts(&self) -> Vec<Turns> {
        let count = self.asks.len();
        let mut ideals: Vec<Vec<f64>> = (0..self.people()).map(|person| self.ideal(person)).collect();
        ideals.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        let start = |tail: usize| -> Turns {
            let cut = ideals.len() * tail / 100;
            let kept = &ideals[cut..ideals.len() - cut];
            let group = |size: usize| &kept[kept.len() * size / count..kept.len() * (size + 1) / count];
            let mean = |group: &[Vec<f64>], knob: usize| {
                let sum: f64 = group.iter().map(|ideal| ideal[knob]).sum();
                (sum / group.len().max(1) as f64).round() as i32
            };
            (0..count).map(|size| (0..self.limits.len()).map(|knob| mean(group(size), knob)).collect()).collect()
        };
        TAILS.into_iter().map(|tail| self.ordered(start(tail))).collect()
    }

    /// Sorts a series. In an even series also makes the steps equal, as nearly as whole steps allow.
    fn ordered(&self, mut turns: Turns) -> Turns {
        let count = turns.len();
        for knob in 0..self.limits.len() {
            let mut all: Vec<i32> = turns.iter().map(|size| size[knob]).collect();
            all.sort_unstable();
            if self.series == Series::Even && count > 1 {
                let [first, last] = [all[0], all[count - 1]];
                let step = (last - first) / (count as i32 - 1);
                all = (0..count as i32).map(|size| first + size * step).collect();
            }
            turns.iter_mut().zip(all).for_each(|(size, turn)| size[knob] = turn);
        }
        turns
    }

    /// Perturbs every turn of a series at random.
    fn shaken(&self, turns: &Turns, random: &mut Draw) -> Turns {
        let by = |turn: i32, knob: usize, random: &mut Draw| {
            let [least, most] = self.limits[knob];
            (turn + random.below(2 * SHAKE + 1) as i32 - SHAKE as i32).clamp(least, most)
        };
        let shaken = turns.iter().map(|size| size.iter().enumerate().map(|(k, turn)| by(*turn, k, random)).collect());
        self.ordered(shaken.collect())
    }

    /// Optimises along all lines until a pass brings no gain.
    fn improved(&self, mut turns: Turns) -> Candidate {
        let lines = self.lines(turns.len());
        let mut worth = self.worth(&turns);
        for _ in 0..ROUNDS {
            let before = worth;
            for line in &lines {
                let (most, by) = self.along(&turns, line);
                if most >= worth {
                    worth = most;
                    let knobs = turns.iter_mut().zip(line).flat_map(|(size, way)| size.iter_mut().zip(way));
                    knobs.for_each(|(turn, way)| *turn += by * way);
                }
            }
            if worth <= before {
                break;
            }
        }
        // Evaluated again: at the very end of an interval, a person may be fitted by rounding alone.
        Candidate { worth: self.worth(&turns), turns }
    }

    /// Search directions. In a rising series: one or two knobs of one size, and one knob of all sizes from a size
    /// upwards. In an even series: one knob of all sizes, and the step of one knob with one of the sizes fixed.
    fn lines(&self, count: usize) -> Vec<Turns> {
        let knobs = self.limits.len();
        let still = vec![vec![0; knobs]; count];
        let mut lines = Vec::new();
        for knob in 0..knobs {
            for size in 0..count {
                let mut line = still.clone();
                match self.series {
                    Series::Rising => line[size][knob] = 1,
                    Series::Even => (0..count).for_each(|k| line[k][knob] = k as i32 - size as i32),
                }
                lines.push(line.clone());
                if self.series == Series::Rising {
                    for (other, sign) in (0..knob).flat_map(|other| [(other, 1), (other, -1)]) {
                        let mut both = line.clone();
                        both[size][other] = sign;
                        lines.push(both);
                    }
                }
                let mut from = still.clone();
                let first = if self.series == Series::Rising { size } else { 0 };
                from[first..].iter_mut().for_each(|size| size[knob] = 1);
                lines.push(from);
            }
        }
        lines.retain(|line| line.iter().flatten().any(|by| *by != 0));
        lines
    }

    /// Greatest objective along a line, and the number of steps to it: among equal points, to the middle of the longest
    /// interval.
    fn along(&self, turns: &Turns, line: &Turns) -> (f64, i32) {
        let [least, most] = self.reach(turns, line);
        let mut steps = vec![0; (most - least + 2) as usize];
        let moves: Vec<bool> = line.iter().map(|way| way.iter().any(|by| *by != 0)).collect();
        let mut always = 0;
        let mut intervals: Vec<[i32; 2]> = Vec::with_capacity(turns.len());
        for person in 0..self.people() {
            if (0..turns.len()).any(|size| !moves[size] && self.fits(size, person, &turns[size])) {
                always += 1;
                continue;
            }
            intervals.clear();
            for size in (0..turns.len()).filter(|size| moves[*size]) {
                let mut interval = [least, most];
                for asked in &self.asks[size][person] {
                    narrow(&mut interval, asked, &turns[size], &line[size]);
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
        let mut people = always;
        let worths = (least..=most).zip(&steps).map(|(by, step)| {
            people += step;
            let moved = |(turns, way): (&Vec<i32>, &Vec<i32>)| -> Vec<i32> {
                turns.iter().zip(way).map(|(turn, way)| turn + by * way).collect()
            };
            let departure: f64 = turns.iter().zip(line).map(moved).map(|size| self.departure(&size)).sum();
            f64::from(people) - self.price * departure
        });
        let (worth, by) = longest_best(worths);
        (worth, least + by)
    }

    /// Least and greatest number of steps along a line, such that turns stay within the limits and no knob turns back
    /// from size to size.
    fn reach(&self, turns: &Turns, line: &Turns) -> [i32; 2] {
        let mut reach = [i32::MIN, i32::MAX];
        let mut keep = |room: i32, way: i32| match way.signum() {
            // `room + t way >= 0` must hold.
            1 => reach[0] = reach[0].max(-(room.max(0) / way)),
            -1 => reach[1] = reach[1].min(room.max(0) / -way),
            _ => {}
        };
        for (size, (at, way)) in turns.iter().zip(line).enumerate() {
            for knob in 0..at.len() {
                let [least, most] = self.limits[knob];
                keep(at[knob] - least, way[knob]);
                keep(most - at[knob], -way[knob]);
                if size > 0 {
                    keep(at[knob] - turns[size - 1][knob], way[knob] - line[size - 1][knob]);
                }
            }
        }
        reach
    }
}

/// True if a size has every length in its band.
#[must_use]
pub fn is_met(asks: &Asks, turns: &[i32]) -> bool {
    asks.iter().all(|asked| (asked.band[0]..=asked.band[1]).contains(&asked.change(turns)))
}

/// Better of two candidates, or the first of equals.
fn better(best: Option<Candidate>, next: Candidate) -> Option<Candidate> {
    best.filter(|best| best.worth >= next.worth).or(Some(next))
}

/// Intersects an interval of steps along a line with those for which a length stays in its band.
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

    /// People who each need one length between two places.
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

    #[test]
    fn on_a_line_no_series_fits_more() {
        let mut random = Draw::new(7);
        for count in 1..=4 {
            let mut band = || {
                let middle = 80.0 * random.normal();
                [middle - 15.0 - 10.0 * random.share(), middle + 20.0]
            };
            let bands: Vec<[f64; 2]> = (0..150).map(|_| band()).collect();
            let asks = vec![on_a_line(&bands); count];
            let search =
                Search { asks: &asks, limits: &[[-300, 300]], habits: &[1.0], price: 0.0, series: Series::Rising };
            let found = search.best(1);
            assert_eq!(search.covered(&found), most(&bands, count), "{count} sizes: {found:?}");
            assert_eq!(found, search.best(1), "the same seed, the same sizes");
        }
    }

    /// People in groups, each about its own turns of two knobs, which both change both lengths.
    fn groups(middles: &[[f64; 2]], half: f64) -> Vec<Asks> {
        let mut random = Draw::new(3);
        let mut person = |middle: &[f64; 2]| -> Asks {
            let [a, b] = [random.share() - 0.5, random.share() - 0.5].map(|off| 2.0 * off);
            let asked = |per_step: [f64; 2], off: f64| {
                let value = per_step[0] * middle[0] + per_step[1] * middle[1] + off;
                Asked { per_step: per_step.to_vec(), band: [value - half, value + half] }
            };
            vec![asked([1.0, 0.2], a), asked([0.1, 1.0], b)]
        };
        middles.iter().flat_map(|middle| (0..40).map(|_| person(middle)).collect::<Vec<_>>()).collect()
    }

    #[test]
    fn groups_that_sizes_can_fit_are_all_fitted() {
        let check = |series, middles: &[[f64; 2]], count: usize, expect: usize| {
            let asks = vec![groups(middles, 6.0); count];
            let search = Search { asks: &asks, limits: &[[-200, 200]; 2], habits: &[1.0; 2], price: 0.0, series };
            let found = search.best(5);
            assert_eq!(search.covered(&found), expect, "{series:?}: {found:?}");
            let rises = |pair: &[Vec<i32>]| pair[0].iter().zip(&pair[1]).all(|(a, b)| a <= b);
            assert!(found.windows(2).all(rises), "{found:?}");
        };
        let steps_differ = [[-60.0, -50.0], [-10.0, -30.0], [70.0, 20.0]];
        let steps_alike = [[-60.0, -20.0], [0.0, 10.0], [60.0, 40.0]];
        check(Series::Rising, &steps_differ, 3, 120);
        check(Series::Even, &steps_alike, 3, 120);
        // No even steps meet groups that lie at uneven ones, and two sizes no three groups.
        check(Series::Even, &steps_differ, 3, 80);
        check(Series::Rising, &steps_differ, 2, 80);
        check(Series::Rising, &steps_alike, 1, 40);
        check(Series::Even, &steps_alike, 1, 40);
    }

    #[test]
    fn a_knob_keeps_its_habit_unless_people_pay() {
        // The second length may be anything between wide bounds, but for a few people who ask for more.
        let person = |place: f64, more: f64| -> Asks {
            vec![
                Asked { per_step: vec![1.0, 0.0], band: [place - 5.0, place + 5.0] },
                Asked { per_step: vec![0.0, 1.0], band: [more, 100.0] },
            ]
        };
        let check = |eager: usize, price: f64, expect: i32| {
            let people = (0..40).map(|k| person(30.0, if k < eager { 40.0 } else { -50.0 })).collect();
            let asks = vec![people];
            let search =
                Search { asks: &asks, limits: &[[-100, 100]; 2], habits: &[1.0, 0.5], price, series: Series::Rising };
            let found = search.best(1);
            assert!((25..=35).contains(&found[0][0]), "{found:?}");
            assert!((found[0][1] - expect).abs() <= 3, "{found:?}, not {expect}");
        };
        check(0, 0.1, 15);
        // 23 steps off its habit cost 2.3 people of those 3, and 23 of them.
        check(3, 0.1, 40);
        check(3, 1.0, 15);
    }

    #[test]
    fn what_no_size_can_have_is_not_counted() {
        let impossible =
            vec![Asked { per_step: vec![1.0], band: [5.0, 6.0] }, Asked { per_step: vec![0.0], band: [1.0, 2.0] }];
        let possible = vec![Asked { per_step: vec![1.0], band: [4.0, 9.0] }];
        let asks = vec![vec![impossible, possible]];
        let search = Search { asks: &asks, limits: &[[0, 8]], habits: &[1.0], price: 0.0, series: Series::Rising };
        let found = search.best(1);
        // The middle of the interval that the limit leaves.
        assert_eq!((search.covered(&found), found), (1, vec![vec![6]]));
    }
}
