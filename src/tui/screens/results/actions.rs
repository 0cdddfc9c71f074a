//! Choosing a result and one of its stages.

use crate::screens::measurements;
use crate::screens::measurements::state::stages;
use crate::screens::movement::stepped;
use crate::screens::state::State;
use crate::widgets::text;
use store::{JobId, JobRow};

/// Selects the next or previous job that has a result.
pub fn step_result(state: &mut State, step: isize) {
    let is_shown = |job: &&JobRow| job.status.has_result() || Some(job.id) == state.focus.job;
    let Some(data) = &state.data else { return };
    let jobs: Vec<JobId> = data.jobs.iter().filter(is_shown).map(|job| job.id).collect();
    let at = jobs.iter().position(|id| Some(*id) == state.focus.job).unwrap_or(0);
    if let Some(next) = stepped(at, step, jobs.len()) {
        state.focus.job = Some(jobs[next]);
    }
}

/// Selects the job of the same size and subject by the other simulator.
pub fn other_simulator(state: &mut State) {
    let (Some(data), Some(job)) = (&state.data, state.job()) else { return };
    match data.same_by_other(job).map(|other| other.id) {
        Some(id) => state.focus.job = Some(id),
        None => state.say("the study has no job of the other simulator here"),
    }
}

pub fn next_stage(state: &mut State) {
    let detail = state.detail();
    let stages = detail.map_or(vec![], stages);
    let shown = detail.and_then(|detail| state.measurements.stage(detail));
    let at = stages.iter().position(|stage| Some(*stage) == shown).unwrap_or(0);
    let next = stepped(at, 1, stages.len()).map(|next| stages[next].to_owned());
    let is_only = stages.len() < 2;
    state.measurements.stage = next.or(state.measurements.stage.take());
    if is_only {
        state.say("this result was measured at one stage only");
    }
}

/// Table of measurements as text, separated by tabs.
pub fn chi_table(state: &State) -> Option<String> {
    let rows = measurements::rows(state);
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
