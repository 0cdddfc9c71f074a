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
        let before = self.cells.focus.clone();
        let filter = self.nav.filters[Screen::Sql as usize].clone();
        let mut effects = match message {
            Message::Key(event) => self.key(&event),
            Message::Resize(width, height) => {
                self.terminal.size = Size::new(width, height);
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
                self.subjects.measured.insert(id, outcome);
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
                if self.running.watched == Some(frame.job) {
                    self.running.live = Some(frame);
                }
                vec![]
            }
            Message::Mouse(event) => self.mouse(&event),
            Message::RunEnded(outcome) => self.run_ended(outcome),
            Message::Hangup if self.running.target.is_some() => {
                self.terminal.detached = true;
                vec![]
            }
            Message::Hangup => vec![Effect::Quit],
            Message::Terminate => vec![Effect::StopRun, Effect::Quit],
        };
        if self.nav.filters[Screen::Sql as usize] != filter {
            self.arrange_sheet();
        }
        self.arrange_jobs();
        self.cells.focus.compare = if self.nav.screen == Screen::Compare { self.to_compare() } else { vec![] };
        if self.cells.focus != before {
            self.moved(&before);
            effects.push(Effect::Read(self.cells.focus.clone()));
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
            return action_of(self.setup.bindings, Key::of(event), self.screen_shown())
                .map_or(vec![], |action| self.act(action));
        };
        match overlay.key(event, &mut self.nav.filters[self.nav.screen as usize]) {
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
            let trace = self.jobs.traces.entry(job.id).or_default();
            if trace.last().is_some_and(|last| last.iteration > progress.step.iteration) {
                trace.clear();
            }
            if trace.last() != Some(&progress.step) && trace.len() < MAX_TRACE {
                trace.push(progress.step);
            }
        }
        let had_grid = self.grid().is_some();
        self.cells.focus.study = snapshot.study().map(|study| study.name.clone());
        self.cells.focus.garment = snapshot.grid.as_ref().map(|grid| grid.garment.clone());
        self.data = Some(snapshot);
        self.jobs.reads += 1;
        self.arrange_jobs();
        self.subjects.chosen = self.subject().map(|row| row.name.clone());
        self.fabrics.chosen = self.fabric().map(|row| row.fabric.name.clone());
        self.clamp_place();
        self.chi.row = self.chi.row.min(self.chi().len().saturating_sub(1));
        let known = self.cells.focus.job.filter(|id| self.data.as_ref().is_some_and(|data| data.job(*id).is_some()));
        match known.and_then(|id| self.place_of(id)) {
            Some(place) => self.cells.place = place,
            None if !had_grid || known.is_none() => {
                self.cells.focus.job = self.cell_at(self.cells.place).and_then(|cell| cell.job)
            }
            None => {}
        }
    }

    /// Keeps the place inside the grid.
    pub(super) fn clamp_place(&mut self) {
        let Some(grid) = self.grid() else { return };
        let clamp = |index: usize, len: usize| index.min(len.saturating_sub(1));
        self.cells.place = Place {
            size: clamp(self.cells.place.size, grid.sizes.len()),
            simulator: clamp(self.cells.place.simulator, grid.simulators.len()),
            subject: clamp(self.cells.place.subject, grid.subjects.len()),
        };
    }

    /// Resets what belongs to the job looked at before.
    fn moved(&mut self, before: &Focus) {
        if self.cells.focus.job == before.job {
            return;
        }
        self.jobs.log_up = 0;
        let garment = self.job().map(|job| job.garment.clone());
        if garment.is_some() {
            self.cells.focus.garment = garment;
        }
        if let Some(place) = self.cells.focus.job.and_then(|id| self.place_of(id)) {
            self.cells.place = place;
        }
    }

    /// Moves the selection to a row that the filter still shows.
    fn keep_selection_visible(&mut self) {
        self.arrange_jobs();
        if self.nav.screen == Screen::Jobs {
            let jobs = self.jobs();
            let is_hidden = !jobs.iter().any(|job| Some(job.id) == self.cells.focus.job);
            if let Some(first) = jobs.first().filter(|_| is_hidden).map(|job| job.id) {
                self.select(first);
            }
        }
        self.chi.row = self.chi.row.min(self.chi().len().saturating_sub(1));
    }

    fn run_ended(&mut self, outcome: Result<String, String>) -> Vec<Effect> {
        self.running.target = None;
        match outcome {
            Ok(text) => self.say(text),
            Err(text) => self.complain(text),
        }
        if self.terminal.detached { vec![Effect::Quit] } else { vec![] }
    }

    /// Asks for the pictures the screen has room for, where they are not those asked for already.
    fn ask_for_picture(&mut self) -> Option<Effect> {
        let mut wanted: Vec<Shot> = screens::picture_places(self)
            .into_iter()
            .map(|(of, size)| match of {
                Sitter::Drape(_) => {
                    Shot { of, look: self.drapes.look, map: self.drapes.map, columns: size.width, rows: size.height }
                }
                // Bodies have one view and no maps.
                Sitter::Body(_) => Shot { of, look: FRONT, map: Map::Plain, columns: size.width, rows: size.height },
            })
            .collect();
        if let (true, true, Some(row)) = (self.nav.screen == Screen::Subjects, wanted.is_empty(), self.subject()) {
            // A body is measured where there is no room for its picture, too.
            wanted = vec![Shot { of: Sitter::Body(row.id), look: FRONT, map: Map::Plain, columns: 0, rows: 0 }];
        }
        if wanted == self.drapes.shots {
            return None;
        }
        self.drapes.shots.clone_from(&wanted);
        (!wanted.is_empty()).then_some(Effect::Paint(wanted))
    }

    /// Takes in a picture that is still wanted, in the place of the one before of the same sitter.
    fn take_picture(&mut self, shot: Shot, drawn: Result<Drawn, String>) {
        if self.drapes.shots.contains(&shot) {
            let shots = &self.drapes.shots;
            self.drapes.pictures.retain(|(old, _)| old.of != shot.of && shots.iter().any(|one| one.of == old.of));
            self.drapes.pictures.push((shot, drawn));
        }
    }

    /// Watches the selected job while it runs here and is looked at.
    fn ask_to_watch(&mut self) -> Option<Effect> {
        let is_shown =
            matches!(self.nav.screen, Screen::Study | Screen::Jobs | Screen::Results) && self.running.target.is_some();
        let running = self.job().filter(|job| is_shown && job.status == Status::Running).map(|job| job.id);
        if running == self.running.watched {
            return None;
        }
        (self.running.watched, self.running.live) = (running, None);
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
