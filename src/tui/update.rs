//! The one place where messages change the state: `(state, message) -> (state, effects)`, without waiting for anything.

use crossterm::event::{KeyEvent, KeyEventKind};
use ratatui::layout::Size;

use super::action::{Key, Screen, action_of};
use super::feed::{Focus, Snapshot};
use super::message::{Effect, Message};
use super::overlay::Outcome;
use super::picture::{Shot, Sitter};
use super::screens;
use super::state::{Place, State};
use crate::study::{JobId, Map, Status, View};

/// Steps of a running job that are kept for its curves.
const MAX_TRACE: usize = 4096;

impl State {
    /// Takes in a message; returns what others have to do.
    pub fn update(&mut self, message: Message) -> Vec<Effect> {
        let before = self.focus.clone();
        let mut effects = match message {
            Message::Key(event) => self.key(&event),
            Message::Resize(width, height) => {
                self.size = Size::new(width, height);
                vec![]
            }
            Message::Data(snapshot) => {
                self.receive(snapshot);
                vec![]
            }
            Message::Acted(text) => {
                self.say(text);
                vec![]
            }
            Message::Saved(outcome) => {
                self.saved(outcome);
                vec![]
            }
            Message::LaidOut(laying, outcome) => {
                self.laid_out(*laying, outcome);
                vec![]
            }
            Message::Sewn(style, outcome) => {
                self.sewn(style, outcome);
                vec![]
            }
            Message::SeamsSaved(style, seams, outcome) => {
                self.seams_saved(&style, &seams, outcome);
                vec![]
            }
            Message::Measured(id, outcome) => {
                self.measured.insert(id, outcome);
                vec![]
            }
            Message::Failed(text) => {
                self.complain(text);
                vec![]
            }
            Message::Picture(shot, drawn) => {
                if self.shot == Some(shot) {
                    self.picture = Some((shot, drawn));
                }
                vec![]
            }
            Message::RunEnded(outcome) => self.run_ended(outcome),
            Message::Hangup if self.run.is_some() => {
                self.detached = true;
                vec![]
            }
            Message::Hangup => vec![Effect::Quit],
            Message::Terminate => vec![Effect::StopRun, Effect::Quit],
        };
        if self.focus != before {
            self.moved(&before);
            effects.push(Effect::Read(self.focus.clone()));
        }
        effects.extend(self.ask_for_picture());
        effects.extend(self.ask_for_desk());
        effects
    }

    fn key(&mut self, event: &KeyEvent) -> Vec<Effect> {
        if event.kind == KeyEventKind::Release {
            return vec![];
        }
        let Some(mut overlay) = self.overlay.take() else {
            self.notice = None;
            return action_of(self.bindings, Key::of(event), self.screen).map_or(vec![], |action| self.act(action));
        };
        match overlay.key(event, &mut self.filters[self.screen as usize]) {
            Outcome::Open => {
                self.overlay = Some(overlay);
                self.keep_selection_visible();
                vec![]
            }
            Outcome::Closed => vec![],
            Outcome::Act(action) => self.act(action),
            Outcome::Effects(effects) => effects,
            Outcome::Sent(effects) => {
                self.overlay = Some(overlay);
                effects
            }
        }
    }

    /// Takes in what was read of the database.
    fn receive(&mut self, snapshot: Box<Snapshot>) {
        for job in snapshot.jobs.iter().filter(|job| job.status == Status::Running) {
            let Some(progress) = &job.progress else { continue };
            let trace = self.traces.entry(job.id).or_default();
            if trace.last().is_some_and(|last| last.iteration > progress.step.iteration) {
                trace.clear();
            }
            if trace.last() != Some(&progress.step) && trace.len() < MAX_TRACE {
                trace.push(progress.step);
            }
        }
        let had_grid = self.grid().is_some();
        self.focus.study = snapshot.study().map(|study| study.name.clone());
        self.focus.garment = snapshot.grid.as_ref().map(|grid| grid.garment.clone());
        self.data = Some(snapshot);
        self.subject = self.subject().map(|row| row.name.clone());
        self.clamp_place();
        self.chi_row = self.chi_row.min(self.chi().len().saturating_sub(1));
        let known = self.focus.job.filter(|id| self.data.as_ref().is_some_and(|data| data.job(*id).is_some()));
        match known.and_then(|id| self.place_of(id)) {
            Some(place) => self.place = place,
            None if !had_grid || known.is_none() => self.focus.job = self.cell_at(self.place).and_then(|cell| cell.job),
            None => {}
        }
    }

    /// Keeps the place inside the grid.
    pub(super) fn clamp_place(&mut self) {
        let Some(grid) = self.grid() else { return };
        let clamp = |index: usize, len: usize| index.min(len.saturating_sub(1));
        self.place = Place {
            size: clamp(self.place.size, grid.sizes.len()),
            simulator: clamp(self.place.simulator, grid.simulators.len()),
            subject: clamp(self.place.subject, grid.subjects.len()),
        };
    }

    /// Resets what belongs to the job looked at before.
    fn moved(&mut self, before: &Focus) {
        if self.focus.job == before.job {
            return;
        }
        self.log_up = 0;
        let garment = self.job().map(|job| job.garment.clone());
        if garment.is_some() {
            self.focus.garment = garment;
        }
        if let Some(place) = self.focus.job.and_then(|id| self.place_of(id)) {
            self.place = place;
        }
    }

    /// Moves the selection to a row that the filter still shows.
    fn keep_selection_visible(&mut self) {
        if self.screen == Screen::Jobs {
            let jobs = self.jobs();
            let is_hidden = !jobs.iter().any(|job| Some(job.id) == self.focus.job);
            if let Some(first) = jobs.first().filter(|_| is_hidden).map(|job| job.id) {
                self.select(first);
            }
        }
        self.chi_row = self.chi_row.min(self.chi().len().saturating_sub(1));
    }

    fn run_ended(&mut self, outcome: Result<String, String>) -> Vec<Effect> {
        self.run = None;
        match outcome {
            Ok(text) => self.say(text),
            Err(text) => self.complain(text),
        }
        if self.detached { vec![Effect::Quit] } else { vec![] }
    }

    /// Asks for the picture the screen has room for, where it is not the one asked for already.
    fn ask_for_picture(&mut self) -> Option<Effect> {
        let size = screens::picture_size(self);
        let wanted = if self.screen == Screen::Subjects {
            // A body is measured where there is no room for its picture, too.
            self.subject().map(|row| self.shot_of(Sitter::Body(row.id), size.unwrap_or_default()))
        } else {
            size.zip(self.job_with_drape()).map(|(size, job)| self.shot_of(Sitter::Drape(job), size))
        };
        if wanted == self.shot {
            return None;
        }
        self.shot = wanted;
        wanted.map(Effect::Paint)
    }

    /// A picture as it is wanted now; bodies have one view and no maps.
    fn shot_of(&self, of: Sitter, size: Size) -> Shot {
        let (view, map) = match of {
            Sitter::Drape(_) => (self.view, self.map),
            Sitter::Body(_) => (View::Front, Map::Plain),
        };
        Shot { of, view, map, columns: size.width, rows: size.height }
    }

    /// The selected job, where it has a drape to show.
    fn job_with_drape(&self) -> Option<JobId> {
        self.job().filter(|job| job.status.has_result()).map(|job| job.id)
    }
}
