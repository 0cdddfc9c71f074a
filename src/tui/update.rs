//! The one place where messages change the state: `(state, message) -> (state, effects)`, without waiting for anything.

use crossterm::event::{KeyEvent, KeyEventKind, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Size;

use super::action::{Action, Key, Screen, action_of};
use super::feed::{Focus, Snapshot};
use super::message::{Effect, Message};
use super::overlay::Outcome;
use super::picture::{Drawn, FRONT, Shot, Sitter};
use super::screens;
use super::state::{Place, State};
use study::{Map, Status};

/// Steps of a running job that are kept for its curves.
const MAX_TRACE: usize = 4096;

impl State {
    /// Takes in a message; returns what others have to do.
    pub fn update(&mut self, message: Message) -> Vec<Effect> {
        let before = self.focus.clone();
        let filter = self.filters[Screen::Sql as usize].clone();
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
                self.take_picture(shot, drawn);
                vec![]
            }
            Message::Names(relations, saved) => {
                (self.sql.relations, self.sql.saved) = (Some(relations), saved);
                vec![]
            }
            Message::Answered(ms, outcome) => {
                self.answered(ms, outcome);
                vec![]
            }
            Message::Reports(rows) => {
                self.reports.rows = Some(rows);
                vec![]
            }
            Message::ReportBuilt(page, rows) => {
                self.report_built(page, rows);
                vec![]
            }
            Message::StudyCreated(name, outcome) => {
                self.study_created(&name, outcome);
                vec![]
            }
            Message::Live(frame) => {
                if self.watched == Some(frame.job) {
                    self.live = Some(frame);
                }
                vec![]
            }
            Message::Mouse(event) => self.mouse(&event),
            Message::RunEnded(outcome) => self.run_ended(outcome),
            Message::Hangup if self.run.is_some() => {
                self.detached = true;
                vec![]
            }
            Message::Hangup => vec![Effect::Quit],
            Message::Terminate => vec![Effect::StopRun, Effect::Quit],
        };
        if self.filters[Screen::Sql as usize] != filter {
            self.arrange_sheet();
        }
        self.arrange_jobs();
        self.focus.compare = if self.screen == Screen::Compare { self.to_compare() } else { vec![] };
        if self.focus != before {
            self.moved(&before);
            effects.push(Effect::Read(self.focus.clone()));
        }
        effects.extend(self.ask_for_picture());
        effects.extend(self.ask_for_desk());
        effects.extend(self.ask_for_names());
        effects.extend(self.ask_for_reports());
        effects.extend(self.ask_to_watch());
        effects
    }

    fn key(&mut self, event: &KeyEvent) -> Vec<Effect> {
        if event.kind == KeyEventKind::Release {
            return vec![];
        }
        let Some(mut overlay) = self.overlay.take() else {
            self.notice = None;
            if self.is_editing() && self.edit_query(event) {
                return vec![];
            }
            return action_of(self.bindings, Key::of(event), self.screen_shown())
                .map_or(vec![], |action| self.act(action));
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
            Outcome::Query(text) => {
                self.take_query(&text);
                vec![]
            }
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
        self.reads += 1;
        self.arrange_jobs();
        self.subject = self.subject().map(|row| row.name.clone());
        self.fabric = self.fabric().map(|row| row.fabric.name.clone());
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
        self.arrange_jobs();
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

    /// Asks for the pictures the screen has room for, where they are not those asked for already.
    fn ask_for_picture(&mut self) -> Option<Effect> {
        let mut wanted: Vec<Shot> = screens::picture_places(self)
            .into_iter()
            .map(|(of, size)| match of {
                Sitter::Drape(_) => Shot { of, look: self.look, map: self.map, columns: size.width, rows: size.height },
                // Bodies have one view and no maps.
                Sitter::Body(_) => Shot { of, look: FRONT, map: Map::Plain, columns: size.width, rows: size.height },
            })
            .collect();
        if let (true, true, Some(row)) = (self.screen == Screen::Subjects, wanted.is_empty(), self.subject()) {
            // A body is measured where there is no room for its picture, too.
            wanted = vec![Shot { of: Sitter::Body(row.id), look: FRONT, map: Map::Plain, columns: 0, rows: 0 }];
        }
        if wanted == self.shots {
            return None;
        }
        self.shots.clone_from(&wanted);
        (!wanted.is_empty()).then_some(Effect::Paint(wanted))
    }

    /// Takes in a picture that is still wanted, in the place of the one before of the same sitter.
    fn take_picture(&mut self, shot: Shot, drawn: Result<Drawn, String>) {
        if self.shots.contains(&shot) {
            let shots = &self.shots;
            self.pictures.retain(|(old, _)| old.of != shot.of && shots.iter().any(|one| one.of == old.of));
            self.pictures.push((shot, drawn));
        }
    }

    /// Watches the selected job while it runs here and is looked at.
    fn ask_to_watch(&mut self) -> Option<Effect> {
        let is_shown = matches!(self.screen, Screen::Study | Screen::Jobs | Screen::Results) && self.run.is_some();
        let running = self.job().filter(|job| is_shown && job.status == Status::Running).map(|job| job.id);
        if running == self.watched {
            return None;
        }
        (self.watched, self.live) = (running, None);
        Some(Effect::Watch(running))
    }

    /// What the mouse does: tabs show screens, the wheel scrolls.
    fn mouse(&mut self, event: &MouseEvent) -> Vec<Effect> {
        match event.kind {
            _ if self.overlay.is_some() => vec![],
            MouseEventKind::ScrollUp => self.act(Action::Up),
            MouseEventKind::ScrollDown => self.act(Action::Down),
            MouseEventKind::Down(MouseButton::Left) if event.row == 0 => {
                screens::tab_at(self, event.column).map_or(vec![], |screen| self.act(Action::Show(screen)))
            }
            _ => vec![],
        }
    }
}
