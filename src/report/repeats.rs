//! Section of the page on cases that were simulated more than once.

use super::ReportError;
use super::chart::{Chart, repeat_chart};
use super::data::TryOn;
use super::spread::{Repeats, repeats};
use super::text::{count, distinct, number, simulator_name};

pub(super) struct RepeatPart {
    pub words: String,
    /// Name of a case, and its cells: simulator, number of repeats, greatest range of chi, measurement that has this
    /// range, least and greatest EI.
    pub rows: Vec<(String, Vec<String>)>,
    /// One for each garment.
    pub charts: Vec<Chart>,
}

impl RepeatPart {
    /// `None` if no case was simulated twice.
    pub fn new(runs: &[TryOn]) -> Result<Option<Self>, ReportError> {
        let cases = repeats(runs);
        if cases.is_empty() {
            return Ok(None);
        }
        let same = cases.iter().filter(|case| case.widest().is_none_or(|spread| spread.chi == 0.0)).count();
        let chart = |garment: &str| {
            let of_garment: Vec<&Repeats> = cases.iter().filter(|case| case.garment == garment).collect();
            repeat_chart(garment, &of_garment)
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
