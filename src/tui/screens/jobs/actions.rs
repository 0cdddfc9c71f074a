//! Finding jobs and acting on the queue.

use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::requests::Command;
use crate::screens::movement::Movement;
use crate::screens::state::State;
use crate::widgets::text;
use engine::why_no_retry;
use sim::Step;
use store::{JobId, JobRow};

impl State {
    /// Jobs that pass the filter of the Jobs screen, in its order.
    #[must_use]
    pub fn jobs(&self) -> Vec<&JobRow> {
        let Some(data) = &self.data else { return vec![] };
        self.jobs.rows().iter().filter_map(|row| data.jobs.get(*row)).collect()
    }

    /// Finds which jobs are shown.
    pub fn arrange_jobs(&mut self) {
        let Some(data) = &self.data else { return };
        self.jobs.arrange(&data.jobs, self.nav.filters[Screen::Jobs as usize].to_lowercase());
    }

    /// Steps of the selected job: those stored, or those seen while it runs.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        let stored = self.detail().map(|detail| detail.history.as_slice()).filter(|steps| !steps.is_empty());
        let seen = || self.focus.job.and_then(|id| self.jobs.traces.get(&id)).map(Vec::as_slice);
        stored.or_else(seen).unwrap_or_default()
    }

    /// Moves in the list of jobs.
    pub fn go_in_jobs(&mut self, movement: Movement) {
        let jobs: Vec<JobId> = self.jobs().iter().map(|job| job.id).collect();
        let at = jobs.iter().position(|id| Some(*id) == self.focus.job);
        let next = at.map_or(0, |at| movement.from(at, jobs.len()));
        if let Some(id) = jobs.get(next) {
            self.select(*id);
        }
    }

    /// Scrolls the log.
    pub fn go_in_log(&mut self, movement: Movement) {
        let lines = self.detail().map_or(0, |detail| detail.log.len());
        let from_top = lines.saturating_sub(1 + self.jobs.log_up);
        self.jobs.log_up = lines.saturating_sub(1 + movement.from(from_top, lines));
    }

    /// Pauses the study, or has it go on.
    pub fn pause(&mut self) -> Vec<Effect> {
        let Some(study) = self.data.as_ref().and_then(|data| data.study()) else { return vec![] };
        let name = study.name.clone();
        vec![Effect::Do(if study.paused { Command::Resume(name) } else { Command::Pause(name) })]
    }

    /// Asks whether the selected job is to be cancelled.
    pub fn cancel(&mut self) -> Vec<Effect> {
        let Some(job) = self.job() else { return self.no_job() };
        if job.status.is_final() {
            let text = format!("job {} has ended ({}): nothing to cancel", job.id, text::status(job.status));
            self.say(text);
            return vec![];
        }
        let text = format!(
            "Cancel job {}, {} {} on {} by {}?",
            job.id,
            job.garment,
            job.size,
            job.subject,
            text::sim(job.simulator)
        );
        let effects = vec![Effect::Do(Command::Cancel(job.id))];
        self.ask(text, effects);
        vec![]
    }

    /// Queues the selected job again.
    pub fn retry(&mut self) -> Vec<Effect> {
        let Some(job) = self.job() else { return self.no_job() };
        let id = job.id;
        if let Some(reason) = why_no_retry(job.status) {
            self.say(format!("job {id} is not run again: {reason}"));
            return vec![];
        }
        vec![Effect::Do(Command::Retry(id))]
    }

    /// Runs the selected job so much earlier.
    pub fn prioritise(&mut self, step: i64) -> Vec<Effect> {
        let Some(job) = self.job() else { return self.no_job() };
        vec![Effect::Do(Command::Prioritise(job.id, job.priority + step))]
    }

    /// The selected job, tab-separated.
    #[must_use]
    pub fn job_line(&self) -> Option<String> {
        let job = self.job()?;
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

    fn no_job(&mut self) -> Vec<Effect> {
        self.say("no job is selected");
        vec![]
    }
}
