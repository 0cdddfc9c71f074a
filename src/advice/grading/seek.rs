//! Search for the parameters of a grade: even steps first, then steps that change at one size where that fits more
//! people.

use crate::grading::Crowd;
use crate::grading::knobs::{self, Effects, Knobs, Run};
use crate::grading::people;
use fit::coverage::{Asks, Search, Turns, is_met};
use pattern::Style;
use store::Result;

/// Share of the people that a size must win for each step by which it departs from the base, or a girth from growing as
/// the first does.
const PRICE: f64 = 5e-5;
/// Share of the people that a change of steps must win.
const SPLIT_WINS: f64 = 0.005;
/// Least number of sizes whose steps may change: a group of one step is none.
const LEAST_TO_SPLIT: usize = 5;
/// Shares of the greatest amounts, tried in turn where a size cannot be drawn.
const LIMITS: [f64; 4] = [1.0, 0.75, 0.5, 0.35];
/// Greatest number of rounds in which sizes are measured as drawn and sought again.
const ROUNDS: usize = 4;

/// Tightens all limits where a size cannot be drawn, since its seams come apart so far from the base.
pub(super) fn sizes(knobs: &Knobs, crowd: Crowd<'_>, even: Run, is_even: bool, seed: u64) -> Result<(Run, Turns)> {
    let effects = knobs.asks(crowd.figures, crowd.bands)?;
    let price = PRICE * crowd.figures.len() as f64;
    let mut refused = None;
    for share in LIMITS {
        let turns = {
            let asks = effects.asks(even, crowd.bands);
            let (bounds, habits) = (knobs.bounds(even, share), knobs.habits(even));
            let search = Search { asks: &asks, bounds: &bounds, habits: &habits, price };
            search.best(&knobs.starts(even), seed)
        };
        let (run, turns) = if is_even { (even, turns) } else { split(knobs, crowd, &effects, (even, turns), share) };
        match as_drawn(knobs, crowd, &effects, (run, turns), share) {
            Ok(turns) => return Ok((run, turns)),
            Err(error) => refused = Some(error),
        }
    }
    refused.map_or(Ok((even, Vec::new())), Err)
}

/// Series whose steps change at the size where that wins most, or the even one where no change wins enough.
fn split(knobs: &Knobs, crowd: Crowd<'_>, effects: &Effects, even: (Run, Turns), share: f64) -> (Run, Turns) {
    let price = PRICE * crowd.figures.len() as f64;
    let (Run { count, .. }, turns) = &even;
    let worth = |run: Run, turns: &[i32]| {
        let (asks, bounds, habits) = (effects.asks(run, crowd.bands), knobs.bounds(run, share), knobs.habits(run));
        Search { asks: &asks, bounds: &bounds, habits: &habits, price }.near(turns)
    };
    if *count < LEAST_TO_SPLIT {
        return even;
    }
    let mut best = (worth(even.0, turns).0 + SPLIT_WINS * crowd.figures.len() as f64, even.clone());
    // Each group has two steps or more.
    for size in 2..=count - 3 {
        let run = Run { count: *count, split: Some(size) };
        let (worth, turns) = worth(run, &knobs.in_groups(turns));
        if worth > best.0 {
            best = (worth, (run, turns));
        }
    }
    best.1
}

/// Measures sizes as drawn, and seeks again near them with the measured eases. Returns the best sizes.
fn as_drawn(
    knobs: &Knobs,
    crowd: Crowd<'_>,
    effects: &Effects,
    (run, mut turns): (Run, Turns),
    share: f64,
) -> Result<Turns> {
    let Crowd { figures, bands } = crowd;
    let levels: Vec<String> = bands.iter().map(|band| band.level.clone()).collect();
    let mut asks: Vec<Vec<Asks>> = effects.asks(run, bands);
    let (bounds, habits) = (knobs.bounds(run, share), knobs.habits(run));
    let mut best: Option<(usize, Turns)> = None;
    for _ in 0..ROUNDS {
        let styles = (0..run.count).map(|size| knobs.drawn(&turns, run, size)).collect::<Result<Vec<Style>>>()?;
        let mut fitted = vec![false; figures.len()];
        for (style, asks) in styles.iter().zip(&mut asks) {
            let eases = people::eases(style, figures, &levels);
            knobs::correct(asks, &eases, &turns, bands);
            for (person, asks) in asks.iter().enumerate() {
                fitted[person] |= is_met(asks, &turns);
            }
        }
        let covered = fitted.into_iter().filter(|fitted| *fitted).count();
        if best.as_ref().is_some_and(|(most, _)| covered <= *most) {
            break;
        }
        best = Some((covered, turns.clone()));
        let price = PRICE * figures.len() as f64;
        turns = Search { asks: &asks, bounds: &bounds, habits: &habits, price }.near(&turns).1;
    }
    Ok(best.map_or(turns, |(_, turns)| turns))
}
