//! Choosing a result, a stage and a measurement.

use crate::keys::screen::Screen;
use crate::screens::movement::{Movement, stepped};
use crate::screens::results::state::ChiOrder;
use crate::screens::state::State;
use crate::widgets::text;
use store::{ChiRow, JobId};

impl State {
    /// Stages of the selected result, in the order they are made.
    #[must_use]
    pub fn stages(&self) -> Vec<&str> {
        let Some(detail) = self.detail() else { return vec![] };
        ["sewn", "popup", "drape"]
            .into_iter()
            .filter(|stage| detail.chi.iter().any(|row| row.stage == *stage))
            .collect()
    }

    /// The stage whose measurements are shown: the one wanted, or the last there is.
    #[must_use]
    pub fn stage(&self) -> Option<&str> {
        let stages = self.stages();
        stages.iter().copied().find(|stage| Some(*stage) == self.results.stage.as_deref()).or(stages.last().copied())
    }

    /// Measurements of the selected result that pass the filter of the Results screen, in its order.
    #[must_use]
    pub fn chi(&self) -> Vec<&ChiRow> {
        let (Some(detail), Some(stage)) = (self.detail(), self.stage()) else { return vec![] };
        let filter = self.nav.filters[Screen::Results as usize].to_lowercase();
        let matches = |row: &ChiRow| format!("#{} {}", row.no, row.name).to_lowercase().contains(&filter);
        let mut rows: Vec<&ChiRow> = detail.chi.iter().filter(|row| row.stage == stage && matches(row)).collect();
        if self.results.order.by == ChiOrder::Error {
            let error = |row: &ChiRow| (row.chi() - 1.0).abs();
            rows.sort_by(|a, b| error(b).total_cmp(&error(a)));
        }
        if self.results.order.reversed {
            rows.reverse();
        }
        rows
    }

    /// Goes to the next or previous job that has a result.
    pub fn step_result(&mut self, step: isize) {
        let is_shown = |job: &&store::JobRow| job.status.has_result() || Some(job.id) == self.focus.job;
        let Some(data) = &self.data else { return };
        let jobs: Vec<JobId> = data.jobs.iter().filter(is_shown).map(|job| job.id).collect();
        let at = jobs.iter().position(|id| Some(*id) == self.focus.job).unwrap_or(0);
        if let Some(next) = stepped(at, step, jobs.len()) {
            self.select(jobs[next]);
        }
    }

    /// Goes to the same size and subject by the other simulator.
    pub fn other_simulator(&mut self) {
        let Some(job) = self.job() else { return };
        match self.same_by_other(job).map(|other| other.id) {
            Some(id) => self.focus.job = Some(id),
            None => self.say("the study has no job of the other simulator here"),
        }
    }

    /// Shows the measurements of the next stage.
    pub fn next_stage(&mut self) {
        let stages = self.stages();
        let at = stages.iter().position(|stage| Some(*stage) == self.stage()).unwrap_or(0);
        let next = stepped(at, 1, stages.len()).map(|next| stages[next].to_owned());
        let is_only = stages.len() < 2;
        self.results.stage = next.or(self.results.stage.take());
        if is_only {
            self.say("this result was measured at one stage only");
        }
    }

    /// Moves in the table of measurements.
    pub fn go_in_measurements(&mut self, movement: Movement) {
        self.results.row = movement.from(self.results.row, self.chi().len());
    }
}

/// The table of measurements, tab-separated.
pub fn chi_table(state: &State) -> Option<String> {
    let rows = state.chi();
    if rows.is_empty() {
        return None;
    }
    let mut table = String::from("no\tmeasurement\tl2d_mm\tl3d_mm\tchi\n");
    for row in rows {
        let (l2d, l3d) = (text::mm(row.l2d_m), text::mm(row.l3d_m));
        table += &format!("{}\t{}\t{l2d}\t{l3d}\t{:.6}\n", row.no, row.name, row.chi());
    }
    Some(table)
}
