//! Parameters of a grade: how far the sample size departs from the base at each level, and the steps of the leading
//! girths from size to size, with which all other lengths grow.

use crate::error::AdviceError;
use crate::grading::people::{self, Figure};
use crate::grading::shares::{self, GIRTH_M, RATIO};
use body::Sex;
use fit::coverage::{Asked, Asks, Bound};
use fit::target;
use pattern::grade::{Growth, GrowthError};
use pattern::{Handle, Style};
use store::{InOrigin, Origin, Result};

/// Step of parameters in which sizes are sought.
pub const STEP_M: f64 = 1e-3;
/// Movement of a handle by which its effect is found.
const TRIED_M: f64 = 5e-3;
/// Least change of a level, m per m, by a handle that may be chosen for the level.
const STRONG: f64 = 0.3;
/// Shares of the greatest amount, tried in turn where a handle cannot move so far.
const LIMITS: [f64; 5] = [1.0, 0.75, 0.5, 0.35, 0.2];
/// Least and greatest step of half the leading girth: sizes of published charts are 25 mm to 120 mm of girth apart [EN
/// 13402-3, ASTM D5585]; the least leaves room for half sizes.
const STEPS_MM: [f64; 2] = [6.0, 60.0];
/// Steps of half the leading girth from which the search starts.
const STARTS_MM: [i32; 5] = [10, 15, 20, 30, 45];

/// Handles that change a width; only these may be chosen for a level. Shortening a garment until it
/// no longer reaches a level is no way to fit it.
const WIDTHS: [Handle; 10] = [
    Handle::Chest,
    Handle::Waist,
    Handle::Hip,
    Handle::Hem,
    Handle::Thigh,
    Handle::Knee,
    Handle::LegOpening,
    Handle::ShoulderLength,
    Handle::Bicep,
    Handle::Cuff,
];
/// Bound that stands for none.
const ANY_M: f64 = 1e3;

#[derive(Clone, Debug)]
pub struct Band {
    pub level: String,
    /// Least and greatest ease.
    pub band_m: [f64; 2],
    /// Ease that decides whether a size fits: there is no greatest where the garment hangs free.
    pub decides: target::Band,
}

#[derive(Clone, Debug)]
pub struct Lead {
    pub handle: Handle,
    /// Lengths that grow with it, with their growth in 40 mm of the girth, m.
    pub told: Vec<(Handle, f64)>,
    /// Amounts of the handles that make these lengths grow so, m per m of the handle.
    moves: Vec<(Handle, f64)>,
}

pub struct Knobs {
    pub growth: Growth,
    /// Handles by which the sample size departs from the base, one for each level.
    pub handles: Vec<Handle>,
    pub leads: Vec<Lead>,
    /// Least and greatest departure of each handle, steps.
    limits: Vec<[i32; 2]>,
}

/// Sizes of a series: how many, which is the sample, and at which the steps change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    pub count: usize,
    /// First size of the second group of steps; `None` for even steps.
    pub split: Option<usize>,
}

impl Run {
    /// Lower one, where two are in the middle.
    pub fn sample(self) -> usize {
        self.count.saturating_sub(1) / 2
    }

    pub fn groups(self) -> usize {
        1 + usize::from(self.split.is_some())
    }

    /// Steps of a group from the sample size to a size.
    pub fn steps(self, size: usize, group: usize) -> f64 {
        let within = |size: usize| match (self.split, group) {
            (None, _) => size,
            (Some(split), 0) => size.min(split),
            (Some(split), _) => size.saturating_sub(split),
        };
        within(size) as f64 - within(self.sample()) as f64
    }
}

impl Knobs {
    /// Chooses the handles that change the levels on `somebody`, and the girths that lead.
    pub fn of(growth: Growth, somebody: &Figure, bands: &[Band], sexes: &[Sex], limit_m: f64) -> Result<Self> {
        let levels: Vec<String> = bands.iter().map(|band| band.level.clone()).collect();
        let all: Vec<Handle> = growth.handles().collect();
        let changes: Vec<Vec<f64>> = all.iter().map(|handle| changes(&growth, *handle, somebody, &levels)).collect();
        let handles = chosen(&all, &changes);
        let growing = shares::growing(&handles, &all, sexes);
        if growing.is_empty() {
            return Err(no_lead(&growth, &all).into());
        }
        let leads: Vec<Handle> = growing.iter().map(|told| told[0].0).collect();
        let lead = |told: Vec<(Handle, f64)>| -> Result<Lead> {
            let still = leads.iter().filter(|lead| **lead != told[0].0).map(|lead| (*lead, 0.0));
            let aims: Vec<(Handle, f64)> = told.iter().copied().chain(still).collect();
            let moves = growth.aimed(&aims).origin(Origin::Grade)?;
            let moves = moves.into_iter().map(|(handle, amount_m)| (handle, amount_m / (0.5 * GIRTH_M))).collect();
            Ok(Lead { handle: told[0].0, told, moves })
        };
        let leads = growing.into_iter().map(lead).collect::<Result<Vec<Lead>>>()?;
        let mut knobs = Self { growth, handles, leads, limits: Vec::new() };
        knobs.limits = (0..knobs.handles.len()).map(|knob| knobs.limit(knob, limit_m)).collect();
        Ok(knobs)
    }

    /// Greatest amounts of a handle in both directions, steps.
    fn limit(&self, knob: usize, limit_m: f64) -> [i32; 2] {
        let steps = |sign: f64| {
            let turned = |share: &f64| {
                let turn = (sign * share * limit_m / STEP_M).round();
                self.growth.sized(&[(self.handles[knob], turn * STEP_M)]).is_ok().then_some(turn as i32)
            };
            LIMITS.iter().find_map(turned).unwrap_or(0)
        };
        [steps(-1.0), steps(1.0)]
    }

    /// Parameters are a departure for each handle, and in each group a step for each lead.
    fn parameters(&self, run: Run) -> usize {
        self.handles.len() + run.groups() * self.leads.len()
    }

    fn step_of(&self, group: usize, lead: usize) -> usize {
        self.handles.len() + group * self.leads.len() + lead
    }

    /// Departures of the sample size from the base, m.
    fn departures(&self, turns: &[i32]) -> Vec<(Handle, f64)> {
        self.handles.iter().zip(turns).map(|(handle, turn)| (*handle, f64::from(*turn) * STEP_M)).collect()
    }

    /// Step of half the lead's girth.
    pub fn step_m(&self, turns: &[i32], group: usize, lead: usize) -> f64 {
        f64::from(turns[self.step_of(group, lead)]) * STEP_M
    }

    /// Amounts of the handles that make a size of a run from the base, m.
    pub fn amounts(&self, turns: &[i32], run: Run, size: usize) -> Vec<(Handle, f64)> {
        let mut amounts = self.departures(turns);
        for (group, lead) in (0..run.groups()).flat_map(|group| (0..self.leads.len()).map(move |lead| (group, lead))) {
            let amount_m = run.steps(size, group) * self.step_m(turns, group, lead);
            for (handle, by) in &self.leads[lead].moves {
                match amounts.iter_mut().find(|(known, _)| known == handle) {
                    Some((_, sum_m)) => *sum_m += by * amount_m,
                    None => amounts.push((*handle, by * amount_m)),
                }
            }
        }
        amounts.sort_by_key(|(handle, _)| *handle);
        amounts
    }

    pub fn drawn(&self, turns: &[i32], run: Run, size: usize) -> Result<Style> {
        self.growth.sized(&self.amounts(turns, run, size)).origin(Origin::Grade)
    }

    /// Checks the seams of the outer sizes of a run whose steps are the least. Fails with the seam that comes apart.
    pub fn check(&self, run: Run) -> Result<()> {
        let turns = self.start(run, (STEPS_MM[0] * 1e-3 / STEP_M) as i32);
        self.drawn(&turns, run, 0)?;
        self.drawn(&turns, run, run.count - 1)?;
        Ok(())
    }

    /// Series whose sample size is the base and whose steps are alike.
    fn start(&self, run: Run, step: i32) -> Vec<i32> {
        let departures = self.handles.len();
        (0..self.parameters(run)).map(|parameter| if parameter < departures { 0 } else { step }).collect()
    }

    pub fn starts(&self, run: Run) -> Vec<Vec<i32>> {
        STARTS_MM.iter().map(|step| self.start(run, *step)).collect()
    }

    /// Series of a run in two groups that has the sizes of an even one.
    pub fn in_groups(&self, turns: &[i32]) -> Vec<i32> {
        turns.iter().chain(&turns[self.handles.len()..]).copied().collect()
    }

    /// Bounds of the parameters, with the greatest step as a share of that of published charts.
    pub fn bounds(&self, run: Run, share: f64) -> Vec<Bound> {
        let parameters = self.parameters(run);
        let weights = |own: &[(usize, f64)]| {
            let mut weights = vec![0.0; parameters];
            own.iter().for_each(|(parameter, weight)| weights[*parameter] = *weight);
            weights
        };
        let limit = |(knob, limit): (usize, &[i32; 2])| Bound {
            weights: weights(&[(knob, 1.0)]),
            between: limit.map(|turn| (f64::from(turn) * share).round()),
        };
        let mut bounds: Vec<Bound> = self.limits.iter().enumerate().map(limit).collect();
        let [least, most] = STEPS_MM.map(|step_mm| step_mm * 1e-3 / STEP_M);
        for group in 0..run.groups() {
            let first = self.step_of(group, 0);
            bounds.push(Bound { weights: weights(&[(first, 1.0)]), between: [least, least + (most - least) * share] });
            for lead in 1..self.leads.len() {
                let own = self.step_of(group, lead);
                bounds.push(Bound {
                    weights: weights(&[(own, 1.0), (first, -RATIO[0])]),
                    between: [0.0, ANY_M / STEP_M],
                });
                bounds.push(Bound {
                    weights: weights(&[(own, -1.0), (first, RATIO[1])]),
                    between: [0.0, ANY_M / STEP_M],
                });
            }
        }
        bounds
    }

    /// Sums of parameters that are zero where the sample size is the base and girths grow alike.
    pub fn habits(&self, run: Run) -> Vec<Vec<f64>> {
        let one = |parameter: usize, less: Option<usize>| {
            let weight = |k: usize| f64::from(u8::from(k == parameter)) - f64::from(u8::from(Some(k) == less));
            (0..self.parameters(run)).map(weight).collect()
        };
        let departures = (0..self.handles.len()).map(|knob| one(knob, None));
        let steps = (0..run.groups()).flat_map(|group| (1..self.leads.len()).map(move |lead| (group, lead)));
        let steps = steps.map(|(group, lead)| one(self.step_of(group, lead), Some(self.step_of(group, 0))));
        departures.chain(steps).collect()
    }

    /// Requirements of every person on every size of a run at each level, linear in the parameters: the ease on the
    /// base, plus the effect of each parameter. A level that the base does not cover on a person requires nothing.
    pub fn asks(&self, figures: &[Figure], bands: &[Band]) -> Result<Effects> {
        let levels: Vec<String> = bands.iter().map(|band| band.level.clone()).collect();
        let tried = |moves: &[(Handle, f64)]| -> Result<Vec<Vec<f64>>> {
            let turned = |by_m: f64| -> Result<Vec<Vec<Option<f64>>>> {
                let amounts: Vec<(Handle, f64)> = moves.iter().map(|(handle, by)| (*handle, by * by_m)).collect();
                let style = self.growth.sized(&amounts).origin(Origin::Grade)?;
                Ok(people::eases(&style, figures, &levels))
            };
            let per_step = |(less, more): (&Option<f64>, &Option<f64>)| {
                less.zip(*more).map_or(0.0, |(less, more)| STEP_M * (more - less) / (2.0 * TRIED_M))
            };
            let (less, more) = (turned(-TRIED_M)?, turned(TRIED_M)?);
            Ok(less.iter().zip(&more).map(|(less, more)| less.iter().zip(more).map(per_step).collect()).collect())
        };
        let departures = self.handles.iter().map(|handle| tried(&[(*handle, 1.0)])).collect::<Result<Vec<_>>>()?;
        let leads = self.leads.iter().map(|lead| tried(&lead.moves)).collect::<Result<Vec<_>>>()?;
        Ok(Effects { base: people::eases(self.growth.style(), figures, &levels), departures, leads })
    }
}

/// Eases of everybody on the base, and the effect of a step of each parameter on them, by person and level, m.
pub struct Effects {
    base: Vec<Vec<Option<f64>>>,
    departures: Vec<Vec<Vec<f64>>>,
    leads: Vec<Vec<Vec<f64>>>,
}

impl Effects {
    pub fn asks(&self, run: Run, bands: &[Band]) -> Vec<Vec<Asks>> {
        let asked = |size: usize, person: usize, level: usize| -> Asked {
            let departures = self.departures.iter().map(|by| by[person][level]);
            let steps = (0..run.groups())
                .flat_map(|group| self.leads.iter().map(move |by| run.steps(size, group) * by[person][level]));
            match self.base[person][level] {
                None => Asked { per_step: departures.chain(steps).map(|_| 0.0).collect(), band: [-ANY_M, ANY_M] },
                Some(ease_m) => Asked {
                    per_step: departures.chain(steps).collect(),
                    band: bands[level].band_m.map(|bound| bound - ease_m),
                },
            }
        };
        let person = |size: usize, person: usize| (0..bands.len()).map(|level| asked(size, person, level)).collect();
        (0..run.count).map(|size| (0..self.base.len()).map(|who| person(size, who)).collect()).collect()
    }
}

/// Corrects the requirements of every person by their true ease on a size as drawn with `turns`, which differs from the
/// linear prediction. Where the base covers a level and the size does not, the size does not fit.
pub fn correct(asks: &mut [Asks], eases: &[Vec<Option<f64>>], turns: &[i32], bands: &[Band]) {
    for (asks, eases) in asks.iter_mut().zip(eases) {
        for ((asked, ease_m), band) in asks.iter_mut().zip(eases).zip(bands) {
            let is_any = asked.band[1] >= ANY_M;
            match ease_m {
                _ if is_any => {}
                Some(ease_m) => {
                    let unturned_m = ease_m - asked.change(turns);
                    asked.band = band.band_m.map(|bound| bound - unturned_m);
                }
                None => asked.band = [ANY_M - 1.0, -ANY_M],
            }
        }
    }
}

fn no_lead(growth: &Growth, all: &[Handle]) -> AdviceError {
    let handles: Vec<&str> = all.iter().map(|handle| handle.as_str()).collect();
    let refused: Vec<String> = growth.refused().iter().map(|(_, reason)| format!("; {reason}")).collect();
    AdviceError::NoHandle { style: growth.style().name.clone(), handles: handles.join(", ") + &refused.concat() }
}

/// Chooses a handle for each level, where there is one: the strongest pairs first, no handle for two levels.
fn chosen(all: &[Handle], changes: &[Vec<f64>]) -> Vec<Handle> {
    let levels = changes.first().map_or(0, Vec::len);
    let wide = (0..all.len()).filter(|k| WIDTHS.contains(&all[*k]));
    let mut pairs: Vec<(usize, usize)> = wide.flat_map(|k| (0..levels).map(move |level| (k, level))).collect();
    let strength = |(k, level): &(usize, usize)| changes[*k][*level].abs();
    pairs.retain(|pair| strength(pair) > STRONG);
    pairs.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
    let mut taken: Vec<(usize, usize)> = Vec::new();
    for (k, level) in pairs {
        if taken.iter().all(|(handle, taken_level)| *handle != k && *taken_level != level) {
            taken.push((k, level));
        }
    }
    taken.sort_unstable();
    taken.into_iter().map(|(k, _)| all[k]).collect()
}

/// Change of each level on somebody by a handle, m per m; 0 where the handle cannot move.
fn changes(growth: &Growth, handle: Handle, somebody: &Figure, levels: &[String]) -> Vec<f64> {
    let moved = |by_m: f64| -> std::result::Result<Vec<Option<f64>>, GrowthError> {
        growth.sized(&[(handle, by_m)]).map(|style| somebody.eases(&style, levels))
    };
    match (moved(-TRIED_M), moved(TRIED_M)) {
        (Ok(less), Ok(more)) => {
            let change = |(less, more): (&Option<f64>, &Option<f64>)| {
                less.zip(*more).map_or(0.0, |(less, more)| (more - less) / (2.0 * TRIED_M))
            };
            less.iter().zip(&more).map(change).collect()
        }
        _ => vec![0.0; levels.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_has_a_handle_of_its_own_and_no_length_is_one() {
        let all = [Handle::Chest, Handle::Waist, Handle::Hem, Handle::ArmholeDepth, Handle::BodyLength];
        let check = |changes: &[[f64; 3]], expect: &[Handle]| {
            let changes: Vec<Vec<f64>> = changes.iter().map(|levels| levels.to_vec()).collect();
            assert_eq!(chosen(&all, &changes), expect);
        };
        // Levels: chest, waist, and a hip that the waist's handle changes more than the hem's.
        let tee = [[2.0, 0.3, 0.0], [0.0, 2.0, 1.2], [0.0, 0.1, 0.8], [0.9, 0.0, 0.0], [0.0, 0.5, 2.5]];
        check(&tee, &[Handle::Chest, Handle::Waist, Handle::Hem]);
        let weak = [[2.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.2, 0.1], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
        check(&weak, &[Handle::Chest]);
    }

    #[test]
    fn steps_are_counted_from_the_sample_and_change_at_the_split() {
        let check = |count: usize, split: Option<usize>, expect: &[[f64; 2]]| {
            let run = Run { count, split };
            let found: Vec<[f64; 2]> = (0..count).map(|size| [0, 1].map(|group| run.steps(size, group))).collect();
            assert_eq!(found, expect, "{run:?}");
        };
        check(3, None, &[[-1.0, -1.0], [0.0, 0.0], [1.0, 1.0]]);
        check(5, Some(3), &[[-2.0, 0.0], [-1.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
        check(5, Some(1), &[[-1.0, -1.0], [0.0, -1.0], [0.0, 0.0], [0.0, 1.0], [0.0, 2.0]]);
    }
}
