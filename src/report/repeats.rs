//! Cases that were simulated more than once: how far their results lie apart.

use super::ReportError;
use super::chart::{Chart, repeat_chart};
use super::data::TryOn;
use super::text::{count, distinct, number, simulator_name};
use fit::Simulator;

/// One case and what its repeats measured.
pub(super) struct Repeats {
    garment: String,
    place: String,
    pub simulator: Simulator,
    runs: usize,
    /// Least and greatest EI.
    ei: [f64; 2],
    pub spreads: Vec<Spread>,
}

/// How far the repeats of a case lie apart in one measurement.
pub(super) struct Spread {
    pub no: u32,
    pub name: String,
    /// Greatest less least chi.
    pub chi: f64,
}

/// The section on repeats.
pub(super) struct RepeatPart {
    pub words: String,
    /// Case, simulator, repeats, greatest spread of chi, where, least and greatest EI.
    pub rows: Vec<(String, Vec<String>)>,
    /// One a garment.
    pub charts: Vec<Chart>,
}

impl RepeatPart {
    /// The section; `None` where nothing was simulated twice.
    pub fn new(runs: &[TryOn]) -> Result<Option<Self>, ReportError> {
        let cases = repeats(runs);
        if cases.is_empty() {
            return Ok(None);
        }
        let same = cases.iter().filter(|case| case.widest().is_none_or(|spread| spread.chi == 0.0)).count();
        let chart = |garment: &str| {
            let of: Vec<&Repeats> = cases.iter().filter(|case| case.garment == garment).collect();
            repeat_chart(garment, &of)
        };
        let garments = distinct(cases.iter().map(|case| case.garment.as_str()));
        Ok(Some(Self {
            words: format!(
                "{} simulated more than once, from the same inputs or from starts that a seed varies; {same} of them \
                 gave the same lengths each time.",
                if cases.len() == 1 { "1 case was".to_owned() } else { count(cases.len(), "case") + " were" }
            ),
            rows: cases.iter().map(Repeats::row).collect(),
            charts: garments.into_iter().map(chart).collect::<Result<_, _>>()?,
        }))
    }
}

impl Repeats {
    fn widest(&self) -> Option<&Spread> {
        self.spreads.iter().max_by(|a, b| a.chi.total_cmp(&b.chi))
    }

    fn row(&self) -> (String, Vec<String>) {
        let widest = self.widest();
        let cells = vec![
            simulator_name(self.simulator).to_owned(),
            self.runs.to_string(),
            number(widest.map_or(f64::NAN, |spread| spread.chi), 4),
            widest.map_or_else(|| "–".to_owned(), |spread| format!("#{} {}", spread.no, spread.name)),
            number(self.ei[0], 4),
            number(self.ei[1], 4),
        ];
        (format!("{}, {}", self.garment, self.place), cells)
    }
}

/// Garment, place and simulator of a case.
type Case = (String, String, Simulator);

/// The cases with two results or more, in the order in which they first appear.
fn repeats(runs: &[TryOn]) -> Vec<Repeats> {
    let key =
        |run: &TryOn| (run.case.clone(), format!("{} on {}, {}", run.size, run.subject, run.fabric), run.simulator);
    let mut cases: Vec<(Case, Vec<&TryOn>)> = Vec::new();
    for run in runs.iter().filter(|run| !run.measured.is_empty()) {
        let key = key(run);
        match cases.iter_mut().find(|(known, _)| *known == key) {
            Some((_, same)) => same.push(run),
            None => cases.push((key, vec![run])),
        }
    }
    cases.into_iter().filter(|(_, same)| same.len() > 1).map(|(key, same)| repeats_of(key, &same)).collect()
}

fn repeats_of((garment, place, simulator): Case, runs: &[&TryOn]) -> Repeats {
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
    };
    let spread = |measured: &super::data::Measured| {
        let no = measured.chi.no;
        let [low, high] =
            range(&mut runs.iter().filter_map(|run| run.measurement(no)).map(|measured| measured.chi.chi()));
        Spread { no, name: measured.name.clone(), chi: high - low }
    };
    let ei = range(&mut runs.iter().filter_map(|run| run.metrics(|_| true)).map(|metrics| metrics.ei));
    let spreads = super::data::measurements(runs).into_iter().map(spread).collect();
    Repeats { garment, place, simulator, runs: runs.len(), ei, spreads }
}
