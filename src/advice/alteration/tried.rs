//! A change that is tried on: foreseen from how the drape answers, draped, and corrected by what is read there.

use crate::alteration::bench::{Amounts, Bench};
use crate::alteration::fitting_room::{Answers, FittingRoom};
use crate::alteration::readings::Readings;
use crate::alteration::{AlteredReading, MOST_DRAPES, Redraped, Wish, within};
use fit::alter::Goal;
use store::{Result, StudyError};

/// Change that is made for a reading that is off by as much as it scatters, m.
const WORTH_M: f64 = 0.3e-3;

/// A change, and what was seen of it.
pub struct Tried {
    /// Of each handle of the bench, m.
    pub amounts: Amounts,
    /// Readings of the pattern as it is; empty where nothing is asked of the drape.
    before: Readings,
    /// What the change promises of them.
    promised: Readings,
    /// The changed pattern, draped.
    pub after: Option<(Redraped, Readings)>,
    /// How many times the garment was draped.
    pub drapes: usize,
    /// What is to be known of it.
    pub remarks: Vec<String>,
}

impl Tried {
    /// A change that the flat pattern tells by itself.
    ///
    /// # Errors
    /// When a handle cannot move.
    pub fn flat(bench: &Bench) -> Result<Self> {
        let (before, promised) = (Readings::new(), Readings::new());
        let amounts = bench.found(&[])?;
        Ok(Self { amounts, before, promised, after: None, drapes: 0, remarks: Vec::new() })
    }

    /// The same, draped; where that fails the change stays, and it is said.
    ///
    /// # Errors
    /// As [`Self::flat`].
    pub fn flat_and_draped(bench: &Bench, room: &FittingRoom) -> Result<Self> {
        let flat = Self::flat(bench)?;
        match room.drape(&bench.moved(&flat.amounts)?) {
            Ok(after) => Ok(Self { after: Some(after), drapes: 1, ..flat }),
            Err(error) => Ok(Self { remarks: vec![format!("the changed pattern is not draped: {error}")], ..flat }),
        }
    }

    /// A change that meets what is asked of the drape: foreseen, draped, and corrected until it does, or it has been draped often enough;
    /// of these the one that misses least.
    ///
    /// # Errors
    /// When something is asked that neither ease nor drape has; a handle that cannot move; what the simulator refuses.
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
        // What ease asks for is known exactly, what a drape answers is not: ease first, then what that leaves.
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
                let by = |(answer, change): (&crate::alteration::Sensitivity, f64)| {
                    answer.get(name).copied().unwrap_or(0.0) * change
                };
                let changes = next.iter().zip(&amounts).map(|(next, now)| next - now);
                reading.value += answers.of_handles.iter().zip(changes).map(by).sum::<f64>();
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

    /// What was asked of the drape, before and after.
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

/// What is said where the drape is no guide.
const UNSTABLE: &str =
    "the coarse drape is about to fold otherwise: what is foreseen of the drape is no guide, what is achieved is seen";

/// Refuses a target that is neither a level nor read off the drape.
fn known(bench: &Bench, readings: &Readings) -> Result<()> {
    let unknown = bench.wish.targets.keys().find(|name| !bench.has_level(name) && !readings.contains_key(*name));
    let known = || bench.levels_known().chain(readings.keys()).cloned().collect();
    match unknown {
        Some(name) => Err(StudyError::NotFound { what: "target", name: name.clone(), known: known() }),
        None => Ok(()),
    }
}

/// What is asked of the drape, from where it is `now` that the handles have moved by `amounts`. A reading counts by what it scatters.
fn goals(wish: &Wish, [now, scatter]: [&Readings; 2], answers: &Answers, amounts: &[f64]) -> Vec<Goal> {
    let goal = |(name, [least, most]): (&String, &[f64; 2])| {
        let value = now.get(name)?.value;
        let of = |answer: &crate::alteration::Sensitivity| answer.get(name).copied().unwrap_or(0.0);
        let sensitivity: Vec<f64> = answers.of_handles.iter().map(of).collect();
        let done: f64 = sensitivity.iter().zip(amounts).map(|(s, amount)| s * amount).sum();
        let inside = 0.25 * (most - least);
        // What the coarse drape does not have is answered by no handle, and asked for firmly: it is missed, and said so.
        let gives = scatter.get(name).map(|scatter| scatter.value.powi(2) / WORTH_M);
        Some(Goal { value: value - done, sensitivity, band: [least + inside, most - inside], gives })
    };
    wish.targets.iter().filter_map(goal).collect()
}

/// Sum over what is asked of the drape of how far it is missed, in widths of its band.
fn missed(wish: &Wish, readings: &Readings) -> f64 {
    let of = |(name, target): (&String, &[f64; 2])| {
        let value = readings.get(name)?.value;
        let [least, most] = *target;
        let off = (least - value).max(value - most).max(0.0);
        Some(if within(*target, value) { 0.0 } else { off / (most - least).max(1e-9) })
    };
    wish.targets.iter().filter_map(of).sum()
}
