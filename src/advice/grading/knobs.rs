//! Handles by which a pattern is graded (knobs): one for each level that has a band. Other handles follow the first of
//! them, as in the pattern's own grade.

use crate::error::AdviceError;
use crate::grading::people::{self, Figure};
use fit::coverage::{Asked, Asks};
use pattern::{Handle, Style};
use store::{InOrigin, Origin, Result};

/// Step of amounts in which sizes are drawn, m.
pub const STEP_M: f64 = 1e-3;
/// Movement of a handle by which its effect is found, m.
const TRIED_M: f64 = 5e-3;
/// Least change of a level, m per m, by a handle that may be chosen for the level.
const STRONG: f64 = 0.3;
/// Shares of the greatest amount, tried in turn where a handle cannot move so far.
const LIMITS: [f64; 5] = [1.0, 0.75, 0.5, 0.35, 0.2];

/// Slope below which a handle does not follow: over the whole range it would move by less than a step.
const SLIGHT: f64 = 0.01;
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
/// Handles of girths of the trunk, which grow alike where the pattern has no grade.
const ALIKE: [Handle; 4] = [Handle::Chest, Handle::Waist, Handle::Hip, Handle::Hem];
/// Bound that stands for none, m.
const ANY_M: f64 = 1e3;

/// A level with its target ease.
#[derive(Clone, Debug)]
pub struct Band {
    /// Level of the body, such as `chest`.
    pub level: String,
    /// Least and greatest ease, m.
    pub band_m: [f64; 2],
}

/// A pattern with the handles that change from size to size.
pub struct Knobs<'a> {
    style: &'a Style,
    /// Handles that are turned, one for each level.
    pub handles: Vec<Handle>,
    /// Handles that follow the first of these, with their slopes, m per m.
    pub followers: Vec<(Handle, f64)>,
    /// Amount of each handle per amount of the first, m per m, in the pattern's own grade.
    pub habits: Vec<f64>,
    /// Least and greatest amount of each handle, steps.
    pub limits: Vec<[i32; 2]>,
}

impl<'a> Knobs<'a> {
    /// Chooses the handles of a style that change the levels on `somebody`. `own` are the pattern's own sizes, of which
    /// the style is one.
    ///
    /// # Errors
    /// When no handle changes a level.
    pub fn of(style: &'a Style, own: &[Style], somebody: &Figure, bands: &[Band], limit_m: f64) -> Result<Self> {
        let levels: Vec<String> = bands.iter().map(|band| band.level.clone()).collect();
        let all = style.handles();
        let changes: Vec<Vec<f64>> = all.iter().map(|handle| changes(style, *handle, somebody, &levels)).collect();
        let handles = chosen(&all, &changes);
        let no_handle = || AdviceError::NoHandle {
            style: style.name.clone(),
            handles: all.iter().map(|handle| handle.as_str()).collect::<Vec<_>>().join(", "),
        };
        let lead = *handles.first().ok_or_else(no_handle)?;
        let slope = |handle: Handle| slope(own, lead, handle);
        let others = all.iter().copied().filter(|handle| !handles.contains(handle));
        let follower = |handle: Handle| Some((handle, slope(handle).filter(|slope| slope.abs() > SLIGHT)?));
        let followers = others.filter_map(follower).collect();
        // Without a grade to learn from, girths of the trunk grow alike.
        let alike = |handle: &Handle| if ALIKE.contains(handle) { 1.0 } else { 0.0 };
        let habits = handles.iter().map(|handle| slope(*handle).unwrap_or_else(|| alike(handle))).collect();
        let mut knobs = Self { style, handles, followers, habits, limits: Vec::new() };
        knobs.limits = (0..knobs.handles.len()).map(|knob| knobs.limit(knob, limit_m)).collect();
        Ok(knobs)
    }

    /// Greatest amounts of a handle in both directions, steps.
    fn limit(&self, knob: usize, limit_m: f64) -> [i32; 2] {
        let steps = |sign: f64| {
            let turned = |share: &f64| {
                let turn = (sign * share * limit_m / STEP_M).round() as i32;
                let mut turns = vec![0; self.handles.len()];
                turns[knob] = turn;
                self.drawn(&turns).is_ok().then_some(turn)
            };
            LIMITS.iter().find_map(turned).unwrap_or(0)
        };
        [steps(-1.0), steps(1.0)]
    }

    /// Handles of a size with their amounts, m, in the order in which they move. `turns` are in steps.
    pub fn moves(&self, turns: &[i32]) -> Vec<(Handle, f64)> {
        let amounts_m: Vec<f64> = turns.iter().map(|turn| f64::from(*turn) * STEP_M).collect();
        let mut moves = self.moves_by(&amounts_m);
        moves.iter_mut().for_each(|(_, amount_m)| *amount_m = (*amount_m / STEP_M).round() * STEP_M);
        moves.retain(|(_, amount_m)| *amount_m != 0.0);
        moves
    }

    /// Moves as [`Self::moves`] does, for amounts of the knobs in m, without rounding.
    fn moves_by(&self, amounts_m: &[f64]) -> Vec<(Handle, f64)> {
        let lead_m = amounts_m.first().copied().unwrap_or(0.0);
        let followers = self.followers.iter().map(|(handle, slope)| (*handle, slope * lead_m));
        let mut moves: Vec<(Handle, f64)> = self.handles.iter().copied().zip(amounts_m.iter().copied()).collect();
        moves.extend(followers);
        moves.retain(|(_, amount_m)| *amount_m != 0.0);
        moves.sort_by_key(|(handle, _)| *handle);
        moves
    }

    /// Returns the style of a size.
    ///
    /// # Errors
    /// When a handle cannot move so far.
    pub fn drawn(&self, turns: &[i32]) -> Result<Style> {
        self.style.moved(&self.moves(turns)).origin(Origin::Grade)
    }

    /// Requirements of every person on a size at each level, linear in the turns: the ease on the base, plus the effect
    /// of each knob. A level that the base does not cover on a person requires nothing.
    ///
    /// # Errors
    /// When a knob cannot turn at all.
    pub fn asks(&self, figures: &[Figure], bands: &[Band]) -> Result<Vec<Asks>> {
        let levels: Vec<String> = bands.iter().map(|band| band.level.clone()).collect();
        let base = people::eases(self.style, figures, &levels);
        let mut tried = Vec::new();
        for knob in 0..self.handles.len() {
            let turned = |by_m: f64| -> Result<Vec<Vec<Option<f64>>>> {
                let amounts_m: Vec<f64> = (0..self.handles.len()).map(|k| if k == knob { by_m } else { 0.0 }).collect();
                let style = self.style.moved(&self.moves_by(&amounts_m)).origin(Origin::Grade)?;
                Ok(people::eases(&style, figures, &levels))
            };
            tried.push([turned(-TRIED_M)?, turned(TRIED_M)?]);
        }
        let asked = |person: usize, level: usize| -> Asked {
            let Some(ease_m) = base[person][level] else {
                return Asked { per_step: vec![0.0; self.handles.len()], band: [-ANY_M, ANY_M] };
            };
            let per_step = tried.iter().map(|[less, more]| {
                let both = less[person][level].zip(more[person][level]);
                both.map_or(0.0, |(less, more)| STEP_M * (more - less) / (2.0 * TRIED_M))
            });
            Asked { per_step: per_step.collect(), band: bands[level].band_m.map(|bound| bound - ease_m) }
        };
        let asks = (0..figures.len()).map(|person| (0..levels.len()).map(|level| asked(person, level)).collect());
        Ok(asks.collect())
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
fn changes(style: &Style, handle: Handle, somebody: &Figure, levels: &[String]) -> Vec<f64> {
    let moved = |by_m: f64| style.moved(&[(handle, by_m)]).map(|style| somebody.eases(&style, levels));
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

/// Change of the point of measure of `handle` per change of that of `lead` in the pattern's own grade, by least squares
/// over its sizes. `None` where the grade does not tell.
fn slope(own: &[Style], lead: Handle, handle: Handle) -> Option<f64> {
    let lengths = |handle: Handle| -> Option<Vec<f64>> {
        let point = handle.changes()?;
        let length_m = |style: &Style| {
            style.points_of_measure().iter().find(|found| found.point == point).map(|found| found.length_m)
        };
        let lengths = own.iter().map(length_m).collect::<Option<Vec<f64>>>()?;
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        Some(lengths.iter().map(|length| length - mean).collect())
    };
    let (leading, other) = (lengths(lead)?, lengths(handle)?);
    let spread: f64 = leading.iter().map(|x| x * x).sum();
    (spread > STEP_M * STEP_M).then(|| leading.iter().zip(&other).map(|(x, y)| x * y).sum::<f64>() / spread)
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
}
