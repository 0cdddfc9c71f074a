//! Search for an alteration: predicted by the response of the drape, draped, and corrected by the readings.

use crate::alteration::bench::{Amounts, Bench};
use crate::alteration::fitting_room::{Answers, FittingRoom};
use crate::alteration::readings::Readings;
use crate::alteration::{AlteredReading, MOST_DRAPES, Redraped, Wish, within};
use fit::alter::Goal;
use store::{Result, StudyError};

/// Cost of missing a reading by its scatter, where a handle costs 1. A handle for one reading is worth while if that is
/// missed by more than twice its scatter, which seldom happens by chance.
const PER_SCATTER: f64 = 0.25;

pub struct Tried {
    /// Amounts of the bench's handles, m.
    pub amounts: Amounts,
    /// Readings of the unchanged pattern; empty where no reading has a target.
    before: Readings,
    promised: Readings,
    pub after: Option<(Redraped, Readings)>,
    pub drapes: usize,
    pub remarks: Vec<String>,
}

impl Tried {
    pub fn flat(bench: &Bench) -> Result<Self> {
        let (before, promised) = (Readings::new(), Readings::new());
        let amounts = bench.found(&[])?;
        Ok(Self { amounts, before, promised, after: None, drapes: 0, remarks: Vec::new() })
    }

    /// Change as by [`Self::flat`], draped. A failure to drape becomes a remark.
    pub fn flat_and_draped(bench: &Bench, room: &FittingRoom) -> Result<Self> {
        let flat = Self::flat(bench)?;
        match room.drape(&bench.moved(&flat.amounts)?) {
            Ok(after) => Ok(Self { after: Some(after), drapes: 1, ..flat }),
            Err(error) => Ok(Self { remarks: vec![format!("the changed pattern is not draped: {error}")], ..flat }),
        }
    }

    /// Finds a change that meets the targets of readings: predicts, drapes and corrects until they are met, or
    /// [`MOST_DRAPES`] is reached. Returns the change that misses least.
    pub fn on(room: &FittingRoom, bench: &Bench) -> Result<Self> {
        let (redraped, before) = room.drape(bench.style)?;
        known(bench, &before)?;
        let mut answers = room.answers(bench.style, &bench.handles)?;
        let scatter = room.scatter(bench.style)?;
        let at_start = vec![0.0; bench.handles.len()];
        let remarks = if answers.is_stable { vec![] } else { vec![UNSTABLE.to_owned()] };
        let mut now = before.clone();
        let mut best = Self { amounts: at_start, promised: before.clone(), before, after: None, drapes: 1, remarks };
        best.after = Some((redraped, now.clone()));
        let mut amounts = best.amounts.clone();
        // Ease is known exactly, readings are not. So ease comes first, and readings correct the rest.
        let mut by_ease = Some(bench.found(&[])?).filter(|found| *found != amounts);
        for drapes in 2..=MOST_DRAPES {
            let next = match by_ease.take() {
                Some(found) => found,
                None => bench.found(&goals(bench.wish, [&now, &scatter], &answers, &amounts))?,
            };
            if next == amounts {
                break;
            }
            let mut promised = now.clone();
            for (name, reading) in &mut promised {
                let changes = next.iter().zip(&amounts).map(|(next, now)| next - now);
                let answers = answers.of_handles.iter().map(|answer| answer.get(name).copied().unwrap_or(0.0));
                reading.value += answers.zip(changes).map(|(answer, change)| answer * change).sum::<f64>();
            }
            let changed = bench.moved(&next)?;
            let after = room.drape(&changed)?;
            now = after.1.clone();
            amounts = next;
            let has_moved = best.amounts.iter().any(|amount| *amount != 0.0);
            best.drapes = drapes;
            if !has_moved || missed(bench.wish, &now) < best.missed(bench.wish) {
                (best.amounts, best.promised, best.after) = (amounts.clone(), promised, Some(after));
            }
            if missed(bench.wish, &now) == 0.0 || drapes == MOST_DRAPES {
                break;
            }
            answers = room.answers(&changed, &bench.handles)?;
        }
        Ok(best)
    }

    fn missed(&self, wish: &Wish) -> f64 {
        self.after.as_ref().map_or(f64::MAX, |(_, readings)| missed(wish, readings))
    }

    pub fn readings(&self, wish: &Wish) -> Vec<AlteredReading> {
        let Some((_, after)) = &self.after else { return Vec::new() };
        let reading = |(name, target): (&String, &[f64; 2])| {
            Some(AlteredReading {
                reading: name.clone(),
                unit: self.before.get(name)?.unit,
                target: *target,
                before: self.before.get(name)?.value,
                promised: self.promised.get(name)?.value,
                achieved: after.get(name)?.value,
            })
        };
        wish.targets.iter().filter_map(reading).collect()
    }
}

const UNSTABLE: &str =
    "the coarse drape is about to fold otherwise: what is foreseen of the drape is no guide, what is achieved is seen";

/// Refuses a target that is neither a level nor a reading.
fn known(bench: &Bench, readings: &Readings) -> Result<()> {
    let unknown = bench.wish.targets.keys().find(|name| !bench.has_level(name) && !readings.contains_key(*name));
    let known = || bench.levels_known().chain(readings.keys()).cloned().collect();
    match unknown {
        Some(name) => Err(StudyError::NotFound { what: "target", name: name.clone(), known: known() }),
        None => Ok(()),
    }
}

/// Goals for the readings, linear in the amounts about the drape `now`, whose handles are at `amounts`. The weight of a
/// reading depends on its scatter.
fn goals(wish: &Wish, [now, scatter]: [&Readings; 2], answers: &Answers, amounts: &[f64]) -> Vec<Goal> {
    let goal = |(name, [least, most]): (&String, &[f64; 2])| {
        let value = now.get(name)?.value;
        let of_handles = answers.of_handles.iter();
        let sensitivity: Vec<f64> = of_handles.map(|answer| answer.get(name).copied().unwrap_or(0.0)).collect();
        let done: f64 = sensitivity.iter().zip(amounts).map(|(s, amount)| s * amount).sum();
        let inside = 0.25 * (most - least);
        // A reading that the coarse drape lacks is a firm goal that no handle serves: it is missed, and reported.
        let gives = scatter.get(name).map(|scatter| scatter.value.powi(2) / PER_SCATTER);
        Some(Goal { value: value - done, sensitivity, band: [least + inside, most - inside], gives })
    };
    wish.targets.iter().filter_map(goal).collect()
}

/// Sum of the departures of readings from their targets, each divided by the width of its target.
fn missed(wish: &Wish, readings: &Readings) -> f64 {
    let departure = |(name, target): (&String, &[f64; 2])| {
        let value = readings.get(name)?.value;
        let [least, most] = *target;
        let off = (least - value).max(value - most).max(0.0);
        Some(if within(*target, value) { 0.0 } else { off / (most - least).max(1e-9) })
    };
    wish.targets.iter().filter_map(departure).sum()
}
