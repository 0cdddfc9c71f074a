//! Choosing runs for the comparison.

use crate::keys::screen::Screen;
use crate::messages::snapshot::Compared;
use crate::screens::compare::comparison::{ComparisonRow, MOST, comparison_rows, labels};
use crate::screens::compare::state::CompareScreen;
use crate::screens::state::State;
use crate::widgets::text;
use store::{JobId, JobRow, RecommendationRow};

/// Runs to compare: those marked; without marks, the shown job and that of the same cell by the other simulator.
pub fn to_compare(state: &State) -> Vec<JobId> {
    if state.marks.len() > 1 {
        return state.marks.iter().copied().take(MOST).collect();
    }
    let (Some(data), Some(job)) = (&state.data, state.job()) else { return vec![] };
    let mut pair: Vec<&JobRow> = [job].into_iter().chain(data.same_by_other(job)).collect();
    pair.sort_by_key(|job| job.simulator);
    pair.into_iter().map(|job| job.id).collect()
}

pub fn compared(state: &State) -> &[Compared] {
    state.data.as_ref().map_or(&[], |data| &data.compared)
}

/// Recommendation for the garment and fit class of the first run.
pub fn recommended(state: &State) -> Option<&RecommendationRow> {
    let data = state.data.as_ref()?;
    let job = &data.compared.first()?.job;
    let class = data.ease_of(job)?.fit.class;
    data.recommendations.iter().find(|row| row.garment == job.garment && row.class == class)
}

/// Marks a run, or takes the mark away.
pub fn mark_run(state: &mut State) {
    let Some(id) = state.job().map(|job| job.id) else { return state.say("no job is selected") };
    begin_marking(state);
    state.marks.toggle(id);
    tell_marks(state);
}

/// Marks the shown runs from the one that was marked last to the selected one.
pub fn mark_range(state: &mut State, shown: &[JobId]) {
    let Some(id) = state.job().map(|job| job.id) else { return state.say("no job is selected") };
    begin_marking(state);
    state.marks.extend_to(shown, id);
    tell_marks(state);
}

/// Marks all shown runs, or takes their marks away.
pub fn mark_all(state: &mut State, shown: &[JobId]) {
    begin_marking(state);
    state.marks.toggle_all(shown);
    tell_marks(state);
}

/// Remembers the list in which runs are marked: their marks go where it is left.
fn begin_marking(state: &mut State) {
    if state.marks.is_empty() {
        state.nav.marked_on = state.nav.screen;
    }
}

fn tell_marks(state: &mut State) {
    state.say(match state.marks.len() {
        0 => "no run is selected".to_owned(),
        1 => "1 run is selected; another, then c compares, x cancels, r retries".to_owned(),
        n if n > MOST => {
            format!("{n} runs are selected; x cancels, r retries, c compares the first {MOST}, u takes all back")
        }
        n => format!("{n} runs are selected; c compares, x cancels, r retries, u takes all back"),
    });
}

pub fn unmark_runs(state: &mut State) {
    state.say(format!("{} runs were selected, none is now", state.marks.len()));
    state.marks.clear();
}

impl CompareScreen {
    /// Rows that are shown: all measurements, or those in which the runs differ.
    pub fn rows(&self, state: &State) -> Vec<ComparisonRow> {
        let filter = state.filter_of(Screen::Compare);
        let mut rows = comparison_rows(compared(state));
        rows.retain(|row| !self.differences_only || row.differs());
        rows.retain(|row| row.words().to_lowercase().contains(&filter));
        if self.sorts_by_difference {
            let spread = |row: &ComparisonRow| {
                let known = || row.chi.iter().flatten();
                known().fold(f64::MIN, |a, b| a.max(*b)) - known().fold(f64::MAX, |a, b| a.min(*b))
            };
            rows.sort_by(|a, b| spread(b).total_cmp(&spread(a)));
        }
        rows
    }

    /// Comparison as text, separated by tabs.
    pub fn table(&self, state: &State) -> Option<String> {
        let jobs: Vec<&JobRow> = compared(state).iter().map(|run| &run.job).collect();
        if jobs.is_empty() {
            return None;
        }
        let mut table = format!("no\tmeasurement\tl2d_mm\t{}\n", labels(&jobs).join("\t"));
        for row in self.rows(state) {
            let chi =
                row.chi.iter().map(|chi| chi.map_or(String::new(), |chi| format!("{chi:.6}"))).collect::<Vec<_>>();
            table += &format!("{}\t{}\t{}\t{}\n", row.no, row.name, text::mm(row.l2d_m), chi.join("\t"));
        }
        Some(table)
    }
}
