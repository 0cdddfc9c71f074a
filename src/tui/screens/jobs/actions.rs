//! Choosing jobs and changing the queue.

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::{Command, Target};
use crate::screens::jobs::state::JobsScreen;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::widgets::text;
use engine::why_no_retry;
use sim::Step;
use store::{JobId, JobRow};

/// Message where there is no job to act on.
const NO_JOB: &str = "no job is selected";

impl JobsScreen {
    /// Jobs that pass the filter, in the order of the list.
    #[must_use]
    pub fn shown<'a>(&self, state: &'a State) -> Vec<&'a JobRow> {
        let Some(data) = &state.data else { return vec![] };
        self.rows().iter().filter_map(|row| data.jobs.get(*row)).collect()
    }

    /// Filters and sorts the jobs.
    pub fn arrange(&mut self, state: &State) {
        let Some(data) = &state.data else { return };
        self.arrange_rows(&data.jobs, state.filter_of(Screen::Jobs));
    }

    /// Selects the first job if the selected one does not pass the filter.
    pub fn keep_visible(&self, state: &mut State) {
        let jobs = self.shown(state);
        let is_hidden = !jobs.iter().any(|job| Some(job.id) == state.focus.job);
        if let Some(first) = jobs.first().filter(|_| is_hidden).map(|job| job.id) {
            state.focus.job = Some(first);
        }
    }

    /// Steps of the selected job: stored ones, or those seen while it runs.
    #[must_use]
    pub fn steps<'a>(&'a self, state: &'a State) -> &'a [Step] {
        let stored = state.detail().map(|detail| detail.history.as_slice()).filter(|steps| !steps.is_empty());
        let seen = || state.focus.job.and_then(|id| self.traces.get(&id)).map(Vec::as_slice);
        stored.or_else(seen).unwrap_or_default()
    }

    /// Moves the selection in the list of jobs.
    pub fn go_in_list(&self, state: &mut State, movement: Movement) {
        let jobs: Vec<JobId> = self.shown(state).iter().map(|job| job.id).collect();
        let at = jobs.iter().position(|id| Some(*id) == state.focus.job);
        let next = at.map_or(0, |at| movement.from(at, jobs.len()));
        if let Some(id) = jobs.get(next) {
            state.focus.job = Some(*id);
        }
    }

    /// Scrolls the log.
    pub fn go_in_log(&mut self, state: &State, movement: Movement) {
        let lines = state.detail().map_or(0, |detail| detail.log.len());
        let from_top = lines.saturating_sub(1 + self.log_up);
        self.log_up = lines.saturating_sub(1 + movement.from(from_top, lines));
    }
}

/// Pauses the study, or ends its pause.
pub fn pause(state: &State) -> Vec<Effect> {
    let Some(study) = state.study() else { return vec![] };
    let name = study.name.clone();
    vec![Effect::Do(if study.paused { Command::Resume(name) } else { Command::Pause(name) })]
}

/// Cancels the selected job, after a question.
pub fn cancel(state: &mut State) -> Vec<Effect> {
    let Some(job) = state.job() else { return state.reply(NO_JOB) };
    if job.status.is_final() {
        return state.reply(format!("job {} has ended ({}): nothing to cancel", job.id, text::status(job.status)));
    }
    let JobRow { id, garment, size, subject, .. } = job;
    let text = format!("Cancel job {id}, {garment} {size} on {subject} by {}?", text::sim(job.simulator));
    let effects = vec![Effect::Do(Command::Cancel(*id))];
    state.ask(text, effects);
    vec![]
}

/// Queues the selected job again.
pub fn retry(state: &mut State) -> Vec<Effect> {
    let Some(job) = state.job() else { return state.reply(NO_JOB) };
    let id = job.id;
    if let Some(reason) = why_no_retry(job.status) {
        return state.reply(format!("job {id} is not run again: {reason}"));
    }
    vec![Effect::Do(Command::Retry(id))]
}

/// Adds a step to the priority of the selected job.
pub fn prioritise(state: &mut State, step: i64) -> Vec<Effect> {
    let Some(job) = state.job() else { return state.reply(NO_JOB) };
    vec![Effect::Do(Command::Prioritise(job.id, job.priority + step))]
}

/// Runs the study; without a study, the quickstart.
pub fn start_run(state: &mut State) -> Vec<Effect> {
    if state.is_first_start() {
        return state.run(Target::Quickstart);
    }
    let Some(study) = state.study() else { return vec![] };
    let target = Target::Study(study.path.clone());
    state.run(target)
}

/// Stops the run, after a question.
pub fn stop_run(state: &mut State) -> Vec<Effect> {
    if state.running.target.is_none() {
        state.say("no run goes on here");
    } else {
        state.ask("Stop the run? Unfinished jobs go back to the queue.", vec![Effect::StopRun]);
    }
    vec![]
}

/// Selected job as text, separated by tabs.
#[must_use]
pub fn job_line(state: &State) -> Option<String> {
    let job = state.job()?;
    let ei = job.ei.map_or(String::new(), |ei| format!("{ei:.6}"));
    Some(format!(
        "{}\t{}\t{}\t{}\t{}\t{}\t{}\t{ei}\t{}",
        job.id,
        job.study,
        job.garment,
        job.size,
        job.subject,
        job.simulator.as_str(),
        job.status.as_str(),
        job.error.as_deref().unwrap_or_default()
    ))
}
