//! Choosing runs to compare.

use crate::keys::screen::Screen;
use crate::messages::snapshot::Compared;
use crate::screens::compare::comparison::{ComparisonRow, MOST, comparison_rows, labels};
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::widgets::text;
use store::{JobId, JobRow, RecommendationRow};

impl State {
    /// The runs to compare: those selected; else the job looked at and its cell by the other simulator.
    #[must_use]
    pub fn to_compare(&self) -> Vec<JobId> {
        if self.compare.marks.len() > 1 {
            return self.compare.marks.iter().copied().take(MOST).collect();
        }
        let Some(job) = self.job() else { return vec![] };
        let mut pair = vec![job.id];
        pair.extend(self.same_by_other(job).map(|other| other.id));
        pair.sort_by_key(|id| self.data.as_ref().and_then(|data| data.job(*id)).map(|job| job.simulator));
        pair
    }

    /// The runs compared, as they were read.
    #[must_use]
    pub fn compared(&self) -> &[Compared] {
        self.data.as_ref().map_or(&[], |data| &data.compared)
    }

    /// The measurements shown: all, or those in which the runs differ.
    #[must_use]
    pub fn comparison_rows(&self) -> Vec<ComparisonRow> {
        let filter = self.nav.filters[Screen::Compare as usize].to_lowercase();
        let mut rows = comparison_rows(self.compared());
        rows.retain(|row| !self.compare.differences_only || row.differs());
        rows.retain(|row| format!("#{} {}", row.no, row.name).to_lowercase().contains(&filter));
        if self.compare.sorts_by_difference {
            let spread = |row: &ComparisonRow| {
                let known = || row.chi.iter().flatten();
                known().fold(f64::MIN, |a, b| a.max(*b)) - known().fold(f64::MAX, |a, b| a.min(*b))
            };
            rows.sort_by(|a, b| spread(b).total_cmp(&spread(a)));
        }
        rows
    }

    /// The recommendation that stands beside the comparison: that of the first run's garment and fit class.
    #[must_use]
    pub fn recommended(&self) -> Option<&RecommendationRow> {
        let job = &self.compared().first()?.job;
        let class = self.ease(job)?.fit.class;
        let of_class = |row: &&RecommendationRow| row.garment == job.garment && row.class == class;
        self.data.as_ref()?.recommendations.iter().find(of_class)
    }

    /// Moves in the table of the comparison.
    pub fn go_in_comparison(&mut self, movement: Movement) {
        self.compare.row = movement.from(self.compare.row, self.comparison_rows().len());
    }

    /// Selects a run for a comparison, or no longer.
    pub fn mark_run(&mut self) {
        let Some(job) = self.job() else {
            self.say("no job is selected");
            return;
        };
        let id = job.id;
        if !self.compare.marks.remove(&id) {
            if self.compare.marks.len() == MOST {
                self.say(format!("{MOST} runs are selected already; u takes all back"));
                return;
            }
            self.compare.marks.insert(id);
        }
        self.say(match self.compare.marks.len() {
            0 => "no run is selected".to_owned(),
            1 => "1 run is selected; another, then c compares".to_owned(),
            n => format!("{n} runs are selected; c compares, u takes all back"),
        });
    }

    /// Takes all selections back.
    pub fn unmark_runs(&mut self) {
        self.say(format!("{} runs were selected, none is now", self.compare.marks.len()));
        self.compare.marks.clear();
    }
}

/// The comparison, tab-separated.
pub fn comparison_table(state: &State) -> Option<String> {
    let jobs: Vec<&JobRow> = state.compared().iter().map(|run| &run.job).collect();
    if jobs.is_empty() {
        return None;
    }
    let mut table = format!("no\tmeasurement\tl2d_mm\t{}\n", labels(&jobs).join("\t"));
    for row in state.comparison_rows() {
        let chi = row.chi.iter().map(|chi| chi.map_or(String::new(), |chi| format!("{chi:.6}"))).collect::<Vec<_>>();
        table += &format!("{}\t{}\t{}\t{}\n", row.no, row.name, text::mm(row.l2d_m), chi.join("\t"));
    }
    Some(table)
}
