//! Alterations by the flat pattern alone: the effect of its handles on the ease, and the least movement of handles that
//! gives the target ease. A band is the range of ease that a target allows.

use std::collections::BTreeMap;

use crate::alteration::{AlteredLevel, SLACK_MM, STEP_M, Sensitivity, Wish};
use body::Body;
use engine::ease;
use fit::alter::{Goal, least_change};
use fit::target::Target;
use geom::units::{from_mm, mm};
use pattern::handle::HandleError;
use pattern::{Handle, Style};
use store::{InOrigin, Origin, Result};

/// Number of rounds of [`Bench::settled`]; each measures the true effect of the change and weights its squares again.
const ROUNDS: usize = 12;
/// Amount below which a handle costs as much as one that does not move, m.
const SMALL_M: f64 = 0.2e-3;
/// Squared miss of a level, already within its target, that is worth a metre of handle movement, m. So small that no
/// such level is sacrificed for another.
const KEPT_M: f64 = 1e-9;
/// Least amount of a handle that counts as chosen by soft goals, m, and the factor by which these goals are then
/// firmer.
const CHOSEN_M: f64 = 1e-3;
const FIRMER: f64 = 30.0;
/// Share of its limit that a handle keeps if it cannot move that far; and the limit below which it stays instead, m.
const TIGHTER: f64 = 0.6;
const LEAST_LIMIT_M: f64 = 2e-3;
/// Step of amounts in a pattern maker's drawing, mm.
const DRAWN_MM: f64 = 0.5;
/// Least amount of a handle that is worth making, mm: cutting and sewing err by as much.
const LEAST_MM: f64 = 1.0;
/// Distance inside its band at which an ease is aimed, m, so that rounding of amounts keeps it there.
const INSIDE_M: f64 = 0.002;
/// Least change of an ease per movement of a handle for which the handle is used. A weaker one would move more than 5
/// mm for 1 mm of ease, and would be driven to its limit by targets that nothing else reaches.
const LEAST_EFFECT: f64 = 0.2;

/// Amount of each handle of a bench, m.
pub type Amounts = Vec<f64>;
/// Value, or the handle that cannot move so far.
type Moved<T> = std::result::Result<T, HandleError>;

/// A style with its handles, the body that it is for, and its target ease.
pub struct Bench<'a> {
    /// Style before the change.
    pub style: &'a Style,
    /// Handles that may move; where amounts are given, the handles that have one.
    pub handles: Vec<Handle>,
    /// Reasons why the other handles cannot be moved.
    pub left_out: Vec<String>,
    /// Wish for the alteration.
    pub wish: &'a Wish,
    body: &'a Body,
    target: &'a Target,
    before: BTreeMap<String, f64>,
    /// Sensitivity of every level to each handle, in the order of `handles`; empty where amounts are given.
    changes: Vec<Sensitivity>,
}

impl<'a> Bench<'a> {
    /// Measures the ease of a style, and finds its handles and their effects.
    pub fn new(style: &'a Style, body: &'a Body, target: &'a Target, wish: &'a Wish) -> Self {
        let before = eases(style, body);
        let (handles, changes, left_out) = (Vec::new(), Vec::new(), Vec::new());
        let mut bench = Self { style, handles, left_out, wish, body, target, before, changes };
        if wish.moves_mm.is_empty() {
            bench.see_handles();
        } else {
            bench.handles = wish.moves_mm.iter().map(|(handle, _)| *handle).collect();
        }
        bench
    }

    /// True if the style has ease at a level.
    pub fn has_level(&self, level: &str) -> bool {
        self.before.contains_key(level)
    }

    /// The levels at which the style has ease.
    pub fn levels_known(&self) -> impl Iterator<Item = &String> {
        self.before.keys()
    }

    /// Least and greatest ease at a level, m; `None` without a target.
    fn band_m(&self, level: &str) -> Option<[f64; 2]> {
        let is_top = ["chest", "bust"].iter().any(|chest| self.has_level(chest));
        let own = self.wish.targets.get(level).map(|band| band.map(from_mm));
        own.or_else(|| self.target.band_m(level, is_top))
    }

    /// Returns the given amounts; where none are given, the least change that brings every level into its band and
    /// meets `goals`. A handle that cannot move as far as the change asks gets a tighter limit, in the end 0.
    ///
    /// # Errors
    /// When the given amounts cannot be applied.
    pub fn found(&self, goals: &[Goal]) -> Result<Amounts> {
        if !self.wish.moves_mm.is_empty() {
            return Ok(self.wish.moves_mm.iter().map(|(_, amount_mm)| from_mm(*amount_mm)).collect());
        }
        let as_it_is_m = self.missed_m(&vec![0.0; self.handles.len()])?;
        let mut limits_m = vec![from_mm(self.wish.limit_mm); self.handles.len()];
        loop {
            let refused = match self.within(&limits_m, goals) {
                Ok(amounts) if self.missed_m(&amounts)? <= as_it_is_m => return Ok(amounts),
                Ok(amounts) => {
                    // Moved so far, the handle makes another garment, in which a level lies elsewhere.
                    let Some(place) = self.misleading(&amounts, &limits_m, goals)? else {
                        return Ok(vec![0.0; limits_m.len()]);
                    };
                    limits_m[place] = 0.0;
                    continue;
                }
                Err(refused) => refused,
            };
            let place = self.handles.iter().position(|handle| Some(*handle) == refused.handle());
            let Some(place) = place.filter(|place| limits_m[*place] > 0.0) else {
                return Err(refused).origin(Origin::Alter);
            };
            limits_m[place] = if limits_m[place] > LEAST_LIMIT_M { TIGHTER * limits_m[place] } else { 0.0 };
        }
    }

    /// Of the handles that move, the one without which the levels miss least; `None` where none moves.
    fn misleading(&self, amounts: &[f64], limits_m: &[f64], goals: &[Goal]) -> Result<Option<usize>> {
        let mut least: Option<(f64, usize)> = None;
        for place in (0..amounts.len()).filter(|place| amounts[*place] != 0.0) {
            let mut without = limits_m.to_vec();
            without[place] = 0.0;
            let Ok(amounts) = self.within(&without, goals) else { continue };
            let missed_m = self.missed_m(&amounts)?;
            if least.is_none_or(|(least_m, _)| missed_m < least_m) {
                least = Some((missed_m, place));
            }
        }
        Ok(least.map(|(_, place)| place))
    }

    /// Least change within a limit for each handle, m. Soft goals shrink all amounts. So they are met a second time,
    /// more firmly, by only those handles that the first time chose.
    fn within(&self, limits_m: &[f64], others: &[Goal]) -> Moved<Amounts> {
        let mut limits: Vec<[f64; 2]> = limits_m.iter().map(|limit_m| [-limit_m, *limit_m]).collect();
        let mut amounts = self.settled(vec![0.0; limits.len()], &limits, others)?;
        if !others.is_empty() {
            let chosen = |amount: &f64| amount.abs() >= CHOSEN_M;
            limits
                .iter_mut()
                .zip(&amounts)
                .filter(|(_, amount)| !chosen(amount))
                .for_each(|(limit, _)| *limit = [0.0; 2]);
            let firm = |goal: &Goal| Goal { gives: goal.gives.map(|gives| gives / FIRMER), ..goal.clone() };
            amounts = self.settled(amounts, &limits, &others.iter().map(firm).collect::<Vec<_>>())?;
        }
        // Amounts too small to cut are set to 0, the least first, and the other handles make up for them.
        while let Some(place) = least_noise(&amounts) {
            (limits[place], amounts[place]) = ([0.0; 2], 0.0);
            amounts = self.settled(amounts, &limits, others)?;
        }
        let drawn: Vec<f64> = amounts.iter().map(|m| from_mm(drawn_mm(*m))).collect();
        self.style.moved(&self.moves(&drawn))?;
        Ok(drawn)
    }

    /// Least change within limits for each handle, m, starting from `amounts`. It minimises the sum of magnitudes, so
    /// that few handles move, by iteratively reweighted least squares: the weights come from the amounts of the round
    /// before.
    fn settled(&self, mut amounts: Amounts, limits: &[[f64; 2]], others: &[Goal]) -> Moved<Amounts> {
        for _ in 0..ROUNDS {
            let now = eases(&self.style.moved(&self.moves(&amounts))?, self.body);
            let goal = |(level, ease_m): (&String, &f64)| {
                let [least, most] = self.band_m(level)?;
                let inside = INSIDE_M.min(0.25 * (most - least));
                let sensitivity: Vec<f64> =
                    self.changes.iter().map(|change| change.get(level).copied().unwrap_or(0.0)).collect();
                let done: f64 = sensitivity.iter().zip(&amounts).map(|(s, amount)| s * amount).sum();
                let is_met = self.before.get(level).is_some_and(|before_m| (least..=most).contains(before_m));
                let band = [least + inside, most - inside];
                Some(Goal { value: ease_m - done, sensitivity, band, gives: is_met.then_some(KEPT_M) })
            };
            let goals: Vec<Goal> = now.iter().filter_map(goal).chain(others.iter().cloned()).collect();
            let scale: Vec<f64> = amounts.iter().map(|amount| (amount.abs() + SMALL_M).sqrt()).collect();
            amounts = least_change(&goals, limits, &scale).amounts;
        }
        Ok(amounts)
    }

    /// Sum over the levels of their departures from the bands, m, after handles move by `amounts`. Departures within
    /// the rounding of amounts count as 0.
    fn missed_m(&self, amounts: &[f64]) -> Result<f64> {
        let now = eases(&self.moved(amounts)?, self.body);
        let missed = |level: &String| {
            let [least, most] = self.band_m(level)?;
            let ease_m = now.get(level).copied().unwrap_or(f64::NEG_INFINITY);
            let off_m = (least - ease_m).max(ease_m - most);
            Some(if off_m > from_mm(SLACK_MM) { off_m } else { 0.0 })
        };
        Ok(self.before.keys().filter_map(missed).sum())
    }

    /// Handles that move, with their amounts, m.
    pub fn moves(&self, amounts: &[f64]) -> Vec<(Handle, f64)> {
        let all = self.handles.iter().copied().zip(amounts.iter().copied());
        all.filter(|(_, amount_m)| amount_m.abs() > 1e-6).collect()
    }

    /// Returns the style with its handles moved by their amounts, m.
    ///
    /// # Errors
    /// When a handle cannot move so far.
    pub fn moved(&self, amounts: &[f64]) -> Result<Style> {
        self.style.moved(&self.moves(amounts)).origin(Origin::Alter)
    }

    /// Finds the handles that can move, with their sensitivities, and the reasons why others cannot.
    fn see_handles(&mut self) {
        let asks_else = self.wish.targets.keys().any(|name| !self.has_level(name));
        for handle in self.style.handles().into_iter().filter(|handle| !self.wish.without.contains(handle)) {
            let moved = |by_m: f64| self.style.moved(&[(handle, by_m)]).map(|style| eases(&style, self.body));
            match (moved(STEP_M), moved(-STEP_M)) {
                (Ok(more), Ok(less)) => {
                    let change = |(level, more_m): (&String, &f64)| {
                        Some((level.clone(), (more_m - less.get(level)?) / (2.0 * STEP_M)))
                    };
                    let changes: Sensitivity = more.iter().filter_map(change).collect();
                    let is_meant = |level: &str| self.band_m(level).is_some();
                    if asks_else || changes.iter().any(|(level, by)| is_meant(level) && by.abs() >= LEAST_EFFECT) {
                        self.changes.push(changes);
                        self.handles.push(handle);
                    }
                }
                (Err(error), _) | (_, Err(error)) => self.left_out.push(error.to_string()),
            }
        }
    }

    /// Reasons why levels are missed, a sentence for each.
    pub fn reasons(&self, amounts: &[f64], levels: &[AlteredLevel]) -> Vec<String> {
        let limit_mm = self.wish.limit_mm;
        let reason = |missed: &AlteredLevel| {
            let level = missed.level.replace('_', " ");
            let helps = |change: &Sensitivity| change.get(&missed.level).is_some_and(|by| by.abs() >= LEAST_EFFECT);
            let own = self.changes.iter().zip(self.handles.iter().zip(amounts)).filter(|(change, _)| helps(change));
            let own: Vec<(&Handle, f64)> = own.map(|(_, (handle, amount_m))| (handle, mm(*amount_m).abs())).collect();
            let names = |moved: &[(&Handle, f64)]| {
                moved.iter().map(|(handle, _)| format!("`{}`", handle.as_str())).collect::<Vec<_>>().join(", ")
            };
            let at_limit: Vec<_> = own.iter().copied().filter(|(_, by_mm)| *by_mm >= limit_mm - DRAWN_MM).collect();
            match (own.is_empty(), at_limit.is_empty()) {
                (true, _) => format!("{level} is missed: no handle of this style changes it"),
                (_, false) => format!(
                    "{level} is missed: at the limit of {limit_mm} mm: {} (--limit-mm allows more; another size may be nearer)",
                    names(&at_limit)
                ),
                _ => format!(
                    "{level} is missed: what changes it cannot move further, or takes other levels out of their bands: {}",
                    names(&own)
                ),
            }
        };
        levels.iter().filter(|level| !level.is_met()).map(reason).collect()
    }

    /// Ease at every level: before, promised by `changed`, and achieved by `again`, which is read from the written
    /// files.
    pub fn levels(&self, changed: &Style, again: &Style) -> Vec<AlteredLevel> {
        let (promised, achieved) = (eases(changed, self.body), eases(again, self.body));
        let level = |(level, before_m): (&String, &f64)| {
            Some(AlteredLevel {
                level: level.clone(),
                target_mm: self.band_m(level).map(|band| band.map(mm)),
                before_mm: mm(*before_m),
                promised_mm: mm(*promised.get(level)?),
                achieved_mm: mm(*achieved.get(level)?),
            })
        };
        self.before.iter().filter_map(level).collect()
    }
}

/// Rounds an amount, m, to the steps of a pattern maker, mm.
fn drawn_mm(amount_m: f64) -> f64 {
    (mm(amount_m) / DRAWN_MM).round() * DRAWN_MM
}

/// Handle with the least amount among those whose drawn amount is not 0 but less than is worth making.
fn least_noise(amounts: &[f64]) -> Option<usize> {
    let is_noise = |place: &usize| {
        let drawn_mm = drawn_mm(amounts[*place]).abs();
        drawn_mm > 0.0 && drawn_mm < LEAST_MM
    };
    (0..amounts.len()).filter(is_noise).min_by(|a, b| amounts[*a].abs().total_cmp(&amounts[*b].abs()))
}

/// Ease at every level of a style on a body, m.
fn eases(style: &Style, body: &Body) -> BTreeMap<String, f64> {
    ease::on(style, body).into_iter().map(|ease| (ease.level.clone(), ease.ease_m())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::draft::{TSHIRT_SEAMS, TshirtSize, tshirt};
    use spec::bodies::{Dimension, Measurements, Sex, build_body};

    #[test]
    fn the_least_amount_that_is_less_than_is_made_is_left_out() {
        let check = |amounts_mm: &[f64], expect: Option<usize>| {
            let amounts: Vec<f64> = amounts_mm.iter().copied().map(from_mm).collect();
            assert_eq!(least_noise(&amounts), expect, "{amounts_mm:?}");
        };
        check(&[], None);
        check(&[0.0, 0.2, -0.1], None);
        check(&[17.0, 0.6, -0.5, 1.0], Some(2));
        check(&[-0.4, 0.6, 12.0], Some(0));
        check(&[0.8, -1.2], None);
    }

    #[test]
    fn a_change_has_no_amount_below_what_is_made() {
        let style = Style::read(&tshirt(TshirtSize::S).pieces, TSHIRT_SEAMS, "a.toml").expect("a style");
        let wish = Wish::of("tshirt", "a", "S");
        let check = |[stature_m, chest_m, waist_m, hip_m]: [f64; 4]| {
            let person = Measurements::of(Sex::Male, stature_m)
                .with(Dimension::ChestGirth, chest_m)
                .with(Dimension::WaistGirth, waist_m)
                .with(Dimension::HipGirth, hip_m);
            let (body, target) = (build_body(&person).expect("a body"), Target::default());
            let bench = Bench::new(&style, &body, &target, &wish);
            let amounts = bench.found(&[]).expect("handles that move");
            let moves = bench.moves(&amounts);
            assert!(moves.iter().all(|(_, by_m)| mm(by_m.abs()) > LEAST_MM - 1e-6), "{chest_m}: {moves:?}");
            assert_eq!(bench.missed_m(&amounts).expect("it moves"), 0.0, "{chest_m}: {moves:?}");
        };
        check([1.78, 0.98, 0.85, 1.00]);
        check([1.75, 0.94, 0.84, 0.97]);
        check([1.70, 0.90, 0.80, 0.93]);
    }
}
