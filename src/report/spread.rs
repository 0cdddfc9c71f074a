//! Spread between the results of cases that were simulated more than once.

use super::data::{Measured, TryOn, measurements};
use fit::Simulator;

/// A case that was simulated more than once.
pub(super) struct Repeats {
    pub garment: String,
    pub place: String,
    pub simulator: Simulator,
    pub runs: usize,
    /// Least and greatest EI.
    pub ei: [f64; 2],
    pub spreads: Vec<Spread>,
}

/// Range of one measurement over the repeats of a case.
pub(super) struct Spread {
    pub no: u32,
    pub name: String,
    /// Greatest minus least chi.
    pub chi: f64,
}

impl Repeats {
    pub fn widest(&self) -> Option<&Spread> {
        self.spreads.iter().max_by(|a, b| a.chi.total_cmp(&b.chi))
    }
}

/// Garment, place (size, subject and fabric) and simulator.
#[derive(PartialEq)]
struct Case {
    garment: String,
    place: String,
    simulator: Simulator,
}

/// Cases with two results or more, in the order of their first appearance.
pub(super) fn repeats(runs: &[TryOn]) -> Vec<Repeats> {
    let case_of = |run: &TryOn| Case {
        garment: run.case.clone(),
        place: format!("{} on {}, {}", run.size, run.subject, run.fabric),
        simulator: run.simulator,
    };
    let mut cases: Vec<(Case, Vec<&TryOn>)> = Vec::new();
    for run in runs.iter().filter(|run| !run.measured.is_empty()) {
        let case = case_of(run);
        match cases.iter_mut().find(|(known, _)| *known == case) {
            Some((_, same)) => same.push(run),
            None => cases.push((case, vec![run])),
        }
    }
    cases.into_iter().filter(|(_, same)| same.len() > 1).map(|(case, same)| repeats_of(case, &same)).collect()
}

fn repeats_of(Case { garment, place, simulator }: Case, runs: &[&TryOn]) -> Repeats {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    };
    let spread = |measured: &Measured| {
        let no = measured.chi.no;
        let [low, high] =
            range(&mut runs.iter().filter_map(|run| run.measurement(no)).map(|measured| measured.chi.chi()));
        Spread { no, name: measured.name.clone(), chi: high - low }
    };
    let ei = range(&mut runs.iter().filter_map(|run| run.metrics(|_| true)).map(|metrics| metrics.ei));
    let spreads = measurements(runs).into_iter().map(spread).collect();
    Repeats { garment, place, simulator, runs: runs.len(), ei, spreads }
}
