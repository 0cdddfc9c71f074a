//! Alterations by the flat pattern alone: the effect of its handles on the ease, and the least movement of handles that
//! gives the target ease. A band is the range of ease that a target allows.

use std::collections::{BTreeMap, BTreeSet};

use crate::alteration::{AlteredLevel, SLACK_MM, STEP_M, Sensitivity, Wish};
use body::Body;
use engine::ease;
use fit::alter::{Goal, fewest};
use fit::target::Target;
use geom::units::{from_mm, mm};
use pattern::handle::HandleError;
use pattern::style::StylePiece;
use pattern::{Handle, Style};
use store::{InOrigin, Origin, Result};

/// Greatest number of rounds of [`Bench::within`]; each measures the true effect of the change.
const ROUNDS: usize = 6;
/// Compliance of a level that is within its target, m^2: so small that no such level is sacrificed for another.
const KEPT_M2: f64 = 1e-9;
/// Cost of a drawn piece that a handle changes, as a share of the cost of the handle itself.
const PER_PIECE: f64 = 0.25;
/// Step of the lengths of outlines by which a piece is told from its mirror image.
const ALIKE_M: f64 = 0.1e-3;
/// Share of its limit that a handle keeps if it cannot move that far; and the limit below which it stays instead, m.
const TIGHTER: f64 = 0.6;
const LEAST_LIMIT_M: f64 = 2e-3;
/// Share of its limit from which a handle counts as at it: a tenth of what it could do may be spared.
const AT_LIMIT: f64 = 0.85;
/// Step of amounts in a pattern maker's drawing.
const DRAWN_MM: f64 = 0.5;
/// Distance inside its band at which an ease is aimed, so that rounding of amounts keeps it there.
const INSIDE_M: f64 = 0.002;
/// Least change of an ease per movement of a handle for which the handle is used. A weaker one would move more than 5
/// mm for 1 mm of ease, and would be driven to its limit by targets that nothing else reaches.
const LEAST_EFFECT: f64 = 0.2;

/// Amount of each handle of a bench, m.
pub type Amounts = Vec<f64>;
type Moved<T> = std::result::Result<T, HandleError>;

pub struct Bench<'a> {
    pub style: &'a Style,
    /// Handles that may move; where amounts are given, the handles that have one.
    pub handles: Vec<Handle>,
    /// Reasons why the other handles cannot be moved.
    pub left_out: Vec<String>,
    pub wish: &'a Wish,
    body: &'a Body,
    target: &'a Target,
    /// Ease at every level: of the style as it is, and with the given moves.
    before: BTreeMap<String, f64>,
    free: BTreeSet<String>,
    given: Vec<(Handle, f64)>,
    fitted: BTreeMap<String, f64>,
    /// Sensitivity of every level to each handle, and the cost of the handle, in the order of `handles`; empty where
    /// amounts are given.
    changes: Vec<Sensitivity>,
    costs: Vec<f64>,
}

impl<'a> Bench<'a> {
    /// Measures the ease of a style, and finds its handles and their effects. `given` moves are no part of the search.
    pub fn new(
        style: &'a Style,
        given: Vec<(Handle, f64)>,
        (body, target, wish): (&'a Body, &'a Target, &'a Wish),
    ) -> Result<Self> {
        let on_body = ease::on(style, body).into_iter();
        let free = on_body.filter(|ease| !ease.is_held).map(|ease| ease.level).collect();
        let before = eases(style, body);
        let fitted = eases(&style.moved(&given).origin(Origin::Alter)?, body);
        let (handles, changes, costs, left_out) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut bench =
            Self { style, handles, left_out, wish, body, target, before, free, given, fitted, changes, costs };
        if wish.moves_mm.is_empty() {
            bench.see_handles();
        } else {
            bench.handles = wish.moves_mm.iter().map(|(handle, _)| *handle).collect();
        }
        Ok(bench)
    }

    pub fn has_level(&self, level: &str) -> bool {
        self.before.contains_key(level)
    }

    pub fn levels_known(&self) -> impl Iterator<Item = &String> {
        self.before.keys()
    }

    /// Least and greatest ease; `None` without a target.
    fn band_m(&self, level: &str) -> Option<[f64; 2]> {
        let is_top = ["chest", "bust"].iter().any(|chest| self.has_level(chest));
        let own = self.wish.targets.get(level).map(|band| band.map(from_mm));
        own.or_else(|| self.target.band(level, is_top, !self.free.contains(level)).map(|band| band.ends_m))
    }

    fn limit_m(&self, handle: Handle) -> f64 {
        from_mm(self.wish.limit_mm.unwrap_or_else(|| handle.most_mm()))
    }

    /// Returns the given amounts; where none are given, the cheapest change that brings every level into its band and
    /// meets `goals`. A handle that cannot move as far as the change asks gets a tighter limit, in the end 0.
    pub fn found(&self, goals: &[Goal]) -> Result<Amounts> {
        if !self.wish.moves_mm.is_empty() {
            return Ok(self.wish.moves_mm.iter().map(|(_, amount_mm)| from_mm(*amount_mm)).collect());
        }
        let as_it_is_m = self.missed_m(&vec![0.0; self.handles.len()])?;
        let mut limits_m: Vec<f64> = self.handles.iter().map(|handle| self.limit_m(*handle)).collect();
        loop {
            let refused = match self.within(&limits_m, goals) {
                Ok(amounts) if self.missed_m(&amounts)? <= as_it_is_m && goals.is_empty() => {
                    return self.thrifty(amounts, limits_m);
                }
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

    /// Leaves out handles without which the levels are met as well at less cost, the one that saves most first. The
    /// search within a round knows the effect of handles by a step alone.
    fn thrifty(&self, mut amounts: Amounts, mut limits_m: Vec<f64>) -> Result<Amounts> {
        let limits: Vec<[f64; 2]> =
            self.handles.iter().map(|handle| [-self.limit_m(*handle), self.limit_m(*handle)]).collect();
        let cost = |amounts: &[f64]| fit::alter::cost(&[], &limits, &self.costs, amounts);
        loop {
            let most_m = self.missed_m(&amounts)? + from_mm(SLACK_MM);
            let mut best: Option<(usize, Amounts)> = None;
            for place in (0..amounts.len()).filter(|place| amounts[*place] != 0.0) {
                let mut without = limits_m.clone();
                without[place] = 0.0;
                let Ok(other) = self.within(&without, &[]) else { continue };
                let least = cost(best.as_ref().map_or(&amounts, |(_, best)| best));
                if cost(&other) < least && self.missed_m(&other)? <= most_m {
                    best = Some((place, other));
                }
            }
            let Some((place, fewer)) = best else { return Ok(amounts) };
            limits_m[place] = 0.0;
            amounts = fewer;
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

    /// Cheapest change within a limit for each handle, m, in steps of a drawing. The effect of handles is linear but for
    /// a little, by which each round corrects the goals.
    fn within(&self, limits_m: &[f64], others: &[Goal]) -> Moved<Amounts> {
        let limits: Vec<[f64; 2]> = limits_m.iter().map(|limit_m| [-limit_m, *limit_m]).collect();
        let mut amounts = vec![0.0; limits.len()];
        for _ in 0..ROUNDS {
            let goals = self.goals(&amounts)?.into_iter().chain(others.iter().cloned()).collect::<Vec<_>>();
            let next: Amounts = fewest(&goals, &limits, &self.costs).amounts.iter().map(|m| drawn_m(*m)).collect();
            let is_same = next == amounts;
            amounts = next;
            if is_same {
                break;
            }
        }
        self.style.moved(&self.moves(&amounts))?;
        Ok(amounts)
    }

    /// Goals for the ease at every level with a target, linear in the amounts about `amounts`.
    fn goals(&self, amounts: &[f64]) -> Moved<Vec<Goal>> {
        let now = eases(&self.style.moved(&self.moves(amounts))?, self.body);
        let goal = |(level, ease_m): (&String, &f64)| {
            let [least, most] = self.band_m(level)?;
            let inside = INSIDE_M.min(0.25 * (most - least));
            let is_met = self.fitted.get(level).is_some_and(|before_m| (least..=most).contains(before_m));
            // A level is no reason to move a handle that hardly changes it.
            let counts = |by: &f64| is_met || by.abs() >= LEAST_EFFECT;
            let change = |change: &Sensitivity| change.get(level).copied().filter(counts).unwrap_or(0.0);
            let sensitivity: Vec<f64> = self.changes.iter().map(change).collect();
            let done: f64 = sensitivity.iter().zip(amounts).map(|(s, amount)| s * amount).sum();
            let kept = 0.5 * from_mm(SLACK_MM);
            let band = if is_met { [least - kept, most + kept] } else { [least + inside, most - inside] };
            Some(Goal { value: ease_m - done, sensitivity, band, gives: is_met.then_some(KEPT_M2) })
        };
        Ok(now.iter().filter_map(goal).collect())
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

    /// Handles that move, with their amounts, m: the given ones, then those of the search.
    pub fn moves(&self, amounts: &[f64]) -> Vec<(Handle, f64)> {
        let all = self.handles.iter().copied().zip(amounts.iter().copied());
        self.given.iter().copied().chain(all.filter(|(_, amount_m)| amount_m.abs() > 1e-6)).collect()
    }

    /// Levels that a handle brings into their targets: those missed without it that it changes.
    pub fn serves(&self, handle: Handle) -> Vec<String> {
        let Some(place) = self.handles.iter().position(|other| *other == handle) else { return Vec::new() };
        let Some(changes) = self.changes.get(place) else { return Vec::new() };
        let is_missed = |level: &&String| {
            let band = self.band_m(level).zip(self.fitted.get(*level));
            band.is_some_and(|([least, most], ease_m)| !(least..=most).contains(ease_m))
        };
        let does = |level: &&String| changes.get(*level).is_some_and(|by| by.abs() >= LEAST_EFFECT);
        self.before.keys().filter(is_missed).filter(does).cloned().collect()
    }

    /// Amounts in m.
    pub fn moved(&self, amounts: &[f64]) -> Result<Style> {
        self.style.moved(&self.moves(amounts)).origin(Origin::Alter)
    }

    fn see_handles(&mut self) {
        let asks_else = self.wish.targets.keys().any(|name| !self.has_level(name));
        let is_free = |handle: &Handle| {
            !self.wish.without.contains(handle) && !self.given.iter().any(|(given, _)| given == handle)
        };
        for handle in self.style.handles().into_iter().filter(is_free) {
            let moved_style = |by_m: f64| self.style.moved(&[self.given.as_slice(), &[(handle, by_m)]].concat());
            let moved = |by_m: f64| moved_style(by_m).map(|style| eases(&style, self.body));
            match (moved(STEP_M), moved(-STEP_M)) {
                (Ok(more), Ok(less)) => {
                    let change = |(level, more_m): (&String, &f64)| {
                        Some((level.clone(), (more_m - less.get(level)?) / (2.0 * STEP_M)))
                    };
                    let changes: Sensitivity = more.iter().filter_map(change).collect();
                    let is_meant = |level: &str| self.band_m(level).is_some();
                    let pieces =
                        self.style.moved(&[(handle, STEP_M)]).map_or(0, |moved| drawn_pieces(self.style, &moved));
                    let is_for_ease = !handle.is_for_figure();
                    if asks_else
                        || is_for_ease && changes.iter().any(|(level, by)| is_meant(level) && by.abs() >= LEAST_EFFECT)
                    {
                        self.changes.push(changes);
                        self.costs.push(1.0 + PER_PIECE * pieces as f64);
                        self.handles.push(handle);
                    }
                }
                (Err(error), _) | (_, Err(error)) => self.left_out.push(error.to_string()),
            }
        }
    }

    pub fn reasons(&self, amounts: &[f64], levels: &[AlteredLevel]) -> Vec<String> {
        let reason = |missed: &AlteredLevel| {
            let level = missed.level.replace('_', " ");
            let helps = |change: &Sensitivity| change.get(&missed.level).is_some_and(|by| by.abs() >= LEAST_EFFECT);
            let own = self.changes.iter().zip(self.handles.iter().zip(amounts)).filter(|(change, _)| helps(change));
            let own: Vec<(&Handle, f64)> = own.map(|(_, (handle, amount_m))| (handle, mm(*amount_m).abs())).collect();
            let names = |moved: &[(&Handle, f64)]| {
                moved.iter().map(|(handle, _)| format!("`{}`", handle.as_str())).collect::<Vec<_>>().join(", ")
            };
            let is_at_limit = |(handle, by_mm): &(&Handle, f64)| *by_mm >= AT_LIMIT * mm(self.limit_m(**handle));
            let at_limit: Vec<_> = own.iter().copied().filter(is_at_limit).collect();
            match (own.is_empty(), at_limit.is_empty()) {
                (true, _) => format!("{level} is missed: no handle of this style changes it"),
                (_, false) => format!(
                    "{level} is missed: another size is needed; as far as this one can be cut: {} (--limit-mm allows more)",
                    at_limit
                        .iter()
                        .map(|(handle, by_mm)| format!("`{}` {by_mm:.1} mm", handle.as_str()))
                        .collect::<Vec<_>>()
                        .join(", ")
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

/// Rounds an amount, m, to the steps of a pattern maker.
fn drawn_m(amount_m: f64) -> f64 {
    from_mm((mm(amount_m) / DRAWN_MM).round() * DRAWN_MM)
}

/// Number of drawn pieces whose outlines differ. A piece and its mirror image are drawn once.
fn drawn_pieces(style: &Style, changed: &Style) -> usize {
    let differs = |(was, is): (&StylePiece, &StylePiece)| was.outline() != is.outline();
    let round_m = |piece: &StylePiece| piece.edges.iter().map(|edge| edge.line.length()).sum::<f64>();
    // A piece is its image if their outlines are equally long.
    let drawn = |piece: &StylePiece| (piece.edges.len(), (round_m(piece) / ALIKE_M).round() as i64);
    let pairs = style.pieces.iter().zip(&changed.pieces);
    pairs.filter(|pair| differs(*pair)).map(|(was, _)| drawn(was)).collect::<BTreeSet<_>>().len()
}

/// Ease by level, m.
fn eases(style: &Style, body: &Body) -> BTreeMap<String, f64> {
    ease::on(style, body).into_iter().map(|ease| (ease.level.clone(), ease.ease_m())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::draft::{Model, TSHIRT_SEAMS, TshirtSize, tshirt};
    use spec::bodies::{Dimension, Measurements, Sex, build_body};

    #[test]
    fn a_change_has_no_amount_below_what_is_made() {
        let style = Style::read(&tshirt(TshirtSize::S).pieces, TSHIRT_SEAMS, "a.toml").expect("a style");
        let wish = Wish { limit_mm: Some(60.0), ..Wish::of("tshirt", "a", "S") };
        let check = |[stature_m, chest_m, waist_m, hip_m]: [f64; 4]| {
            let person = Measurements::of(Sex::Male, stature_m)
                .with(Dimension::ChestGirth, chest_m)
                .with(Dimension::WaistGirth, waist_m)
                .with(Dimension::HipGirth, hip_m);
            let (body, target) = (build_body(&person).expect("a body"), Target::default());
            let bench = Bench::new(&style, Vec::new(), (&body, &target, &wish)).expect("a bench");
            let amounts = bench.found(&[]).expect("handles that move");
            let moves = bench.moves(&amounts);
            assert!(moves.iter().all(|(_, by_m)| mm(by_m.abs()) > DRAWN_MM - 1e-6), "{chest_m}: {moves:?}");
            assert_eq!(bench.missed_m(&amounts).expect("it moves"), 0.0, "{chest_m}: {moves:?}");
        };
        check([1.78, 0.98, 0.85, 1.00]);
        check([1.75, 0.94, 0.84, 0.97]);
        check([1.70, 0.90, 0.80, 0.93]);
    }

    /// Random targets: each level asked for another ease, by up to 25 mm either way, with a chance of a half.
    fn asked(style: &Style, body: &Body, random: &mut impl FnMut() -> f64) -> BTreeMap<String, [f64; 2]> {
        let mut band = |ease_m: f64| {
            let at_mm = mm(ease_m) + if random() < 0.5 { 50.0 * (random() - 0.5) } else { 0.0 };
            [at_mm - 5.0, at_mm + 5.0]
        };
        eases(style, body).into_iter().map(|(level, ease_m)| (level, band(ease_m))).collect()
    }

    #[test]
    fn no_handle_or_pair_of_a_change_can_be_spared_for_a_cheaper_one() {
        const GOALS: usize = 4;
        let mut state = 20_260_330_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1u32 << 31)
        };
        let person =
            Measurements::of(Sex::Male, 1.76).with(Dimension::ChestGirth, 0.96).with(Dimension::WaistGirth, 0.85);
        let (body, target) = (build_body(&person).expect("a body"), Target::default());
        for goal in 0..GOALS {
            let model = [Model::Tshirt, Model::Trousers][goal % 2];
            let style = Style::read(&model.drafts()[1].pieces, model.seams(), "a.toml").expect("a style");
            let wish = Wish { targets: asked(&style, &body, &mut random), ..Wish::of("a", "a", "M") };
            let bench = Bench::new(&style, Vec::new(), (&body, &target, &wish)).expect("a bench");
            let amounts = bench.found(&[]).expect("handles that move");
            let limits: Vec<[f64; 2]> =
                bench.handles.iter().map(|handle| [-bench.limit_m(*handle), bench.limit_m(*handle)]).collect();
            let cost = |amounts: &[f64]| fit::alter::cost(&[], &limits, &bench.costs, amounts);
            let missed_m = bench.missed_m(&amounts).expect("it moves");
            let used: Vec<usize> = (0..amounts.len()).filter(|k| amounts[*k] != 0.0).collect();
            for (a, b) in used.iter().flat_map(|a| used.iter().map(move |b| (*a, *b))).filter(|(a, b)| a <= b) {
                let limits_m = (0..limits.len()).map(|k| if k == a || k == b { 0.0 } else { limits[k][1] });
                let Ok(other) = bench.within(&limits_m.collect::<Vec<_>>(), &[]) else { continue };
                let is_as_good = bench.missed_m(&other).expect("it moves") <= missed_m + from_mm(SLACK_MM);
                let (own, other) = (cost(&amounts), cost(&other));
                assert!(!is_as_good || other >= 0.9 * own, "goal {goal}: without {a} and {b} {other:.2}, not {own:.2}");
            }
        }
    }
}
