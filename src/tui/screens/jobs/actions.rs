//! Choosing jobs and changing the queue.

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::{Command, Target};
use crate::screens::catalogue::hidden_words;
use crate::screens::jobs::state::JobsScreen;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::screens::study::actions::grid_jobs;
use crate::widgets::text;
use engine::why_no_retry;
use sim::Step;
use store::owner::Runner;
use store::{JobId, JobRow, Status};

impl JobsScreen {
    pub fn shown<'a>(&self, state: &'a State) -> Vec<&'a JobRow> {
        let Some(data) = &state.data else { return vec![] };
        self.rows().iter().filter_map(|row| data.jobs.get(*row)).collect()
    }

    pub fn shown_ids(&self, state: &State) -> Vec<JobId> {
        self.shown(state).iter().map(|job| job.id).collect()
    }

    pub fn arrange(&mut self, state: &State) {
        let Some(data) = &state.data else { return };
        let is_paused = state.study().is_some_and(|study| study.paused);
        self.arrange_rows(&data.jobs, state.filter_of(Screen::Jobs), is_paused);
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
    pub fn steps<'a>(&'a self, state: &'a State) -> &'a [Step] {
        let stored = state.detail().map(|detail| detail.history.as_slice()).filter(|steps| !steps.is_empty());
        let seen = || state.focus.job.and_then(|id| self.traces.get(&id)).map(Vec::as_slice);
        stored.or_else(seen).unwrap_or_default()
    }

    pub fn go_in_list(&self, state: &mut State, movement: Movement) {
        let jobs = self.shown_ids(state);
        let at = jobs.iter().position(|id| Some(*id) == state.focus.job);
        let next = at.map_or(0, |at| movement.from(at, jobs.len()));
        if let Some(id) = jobs.get(next) {
            state.focus.job = Some(*id);
        }
    }

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

/// Jobs to act on, and the number of marked ones that are not seen and stay as they are.
struct ActedOn<'a> {
    jobs: Vec<&'a JobRow>,
    hidden: usize,
}

impl ActedOn<'_> {
    /// Sentence about the marked jobs that stay as they are; empty without any.
    fn rest(&self) -> String {
        if self.hidden > 0 { format!(" {}: not touched.", hidden_words(self.hidden)) } else { String::new() }
    }
}

impl JobsScreen {
    /// Jobs that the shown screen shows: those of its list or grid, or the one result.
    fn seen(&self, state: &State) -> Vec<JobId> {
        match state.nav.screen {
            Screen::Jobs => self.shown_ids(state),
            Screen::Study => grid_jobs(state),
            _ => state.focus.job.into_iter().collect(),
        }
    }

    /// Jobs to act on: the marked ones that are seen; without marks, the selected one.
    fn acted_on<'a>(&self, state: &'a State) -> ActedOn<'a> {
        let Some(data) = &state.data else { return ActedOn { jobs: vec![], hidden: 0 } };
        if state.marks.is_empty() {
            return ActedOn { jobs: state.job().into_iter().collect(), hidden: 0 };
        }
        let (seen, hidden) = state.marks.seen(&self.seen(state));
        ActedOn { jobs: data.jobs_of(seen.iter()), hidden }
    }

    /// Cancels the marked jobs or the selected one, after a question.
    pub fn cancel(&self, state: &mut State) -> Vec<Effect> {
        let acted_on = self.acted_on(state);
        let (jobs, rest) = (&acted_on.jobs, acted_on.rest());
        let open: Vec<&JobRow> = jobs.iter().copied().filter(|job| !job.status.is_final()).collect();
        let text = match (&jobs[..], &open[..]) {
            ([], _) => return state.reply(nothing(&rest)),
            ([job], []) => {
                let status = text::status(job.status);
                return state.reply(format!("job {} has ended ({status}): nothing to cancel.{rest}", job.id));
            }
            (_, []) => {
                return state.reply(format!("all {} selected jobs have ended: nothing to cancel.{rest}", jobs.len()));
            }
            ([job], _) => {
                let JobRow { id, garment, size, subject, .. } = job;
                format!("Cancel job {id}, {garment} {size} on {subject} by {}?", text::sim(job.simulator))
            }
            _ if open.len() == jobs.len() => format!("Cancel the {} selected jobs?", jobs.len()),
            _ => format!("Cancel {} of the {} selected jobs? The others have ended.", open.len(), jobs.len()),
        };
        let effects = vec![Effect::Do(Command::Cancel(open.iter().map(|job| job.id).collect()))];
        state.ask(text + &rest, effects);
        vec![]
    }

    /// Queues the marked jobs or the selected one again; asks where marked ones are not seen.
    pub fn retry(&self, state: &mut State) -> Vec<Effect> {
        let acted_on = self.acted_on(state);
        let (jobs, rest) = (&acted_on.jobs, acted_on.rest());
        let ended: Vec<JobId> =
            jobs.iter().filter(|job| why_no_retry(job.status).is_none()).map(|job| job.id).collect();
        match (&jobs[..], ended.is_empty()) {
            ([], _) => state.reply(nothing(&rest)),
            ([job], true) => {
                let reason = why_no_retry(job.status).unwrap_or_default();
                state.reply(format!("job {} is not run again: {reason}.{rest}", job.id))
            }
            (_, true) => state.reply(format!(
                "none of the {} selected jobs failed or was cancelled; u takes the selection back.{rest}",
                jobs.len()
            )),
            (_, false) if !rest.is_empty() => {
                let text = format!("Queue {} selected jobs again?{rest}", ended.len());
                state.ask(text, vec![Effect::Do(Command::Retry(ended))]);
                vec![]
            }
            (_, false) => vec![Effect::Do(Command::Retry(ended))],
        }
    }

    /// Adds a step to the priority of the marked jobs that are seen, or of the selected one.
    pub fn prioritise(&self, state: &mut State, step: i64) -> Vec<Effect> {
        let acted_on = self.acted_on(state);
        if acted_on.jobs.is_empty() {
            let text = nothing(&acted_on.rest());
            return state.reply(text);
        }
        acted_on.jobs.iter().map(|job| Effect::Do(Command::Prioritise(job.id, job.priority + step))).collect()
    }
}

fn nothing(rest: &str) -> String {
    format!("no job is selected here.{rest}")
}

pub fn retry_failed(state: &mut State) -> Vec<Effect> {
    let study = state.focus.study.as_deref().or(state.study().map(|study| study.name.as_str()));
    let jobs = state.data.iter().flat_map(|data| &data.jobs);
    let is_failed = |job: &&JobRow| job.status == Status::Failed && Some(job.study.as_str()) == study;
    let failed: Vec<JobId> = jobs.filter(is_failed).map(|job| job.id).collect();
    match (failed.is_empty(), study) {
        (false, _) => vec![Effect::Do(Command::Retry(failed))],
        (true, Some(study)) => {
            let text = format!("no job of {study} has failed");
            state.reply(text)
        }
        (true, None) => state.reply("there is no study yet"),
    }
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
    let others: &[Runner] = state.data.as_ref().map_or(&[], |data| &data.runners);
    if state.running.target.is_none() {
        let of = |runner: &Runner| {
            let jobs = if runner.jobs == 1 { "1 job".to_owned() } else { format!("{} jobs", runner.jobs) };
            let stop = runner.pid.map_or("it is stopped there".to_owned(), |pid| format!("`kill {pid}` stops it"));
            format!("{} runs {jobs}: {stop}", runner.name)
        };
        let others: Vec<String> = others.iter().map(of).collect();
        let text = if others.is_empty() { "no job of it runs anywhere".to_owned() } else { others.join("; ") };
        state.say(format!("no run goes on here; {text}"));
    } else {
        state.ask("Stop the run? Unfinished jobs go back to the queue.", vec![Effect::StopRun]);
    }
    vec![]
}

/// Selected job as text, separated by tabs.
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
