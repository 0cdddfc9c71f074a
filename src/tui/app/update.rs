//! The one place where messages change the state: `(state, message) -> (state, effects)`, without waiting for anything.

use crossterm::event::{KeyEvent, KeyEventKind, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Size;

use crate::app::frame::{keys_of, tab_at};
use crate::keys::action::Action;
use crate::keys::binding::{Key, action_of};
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::snapshot::{Focus, Snapshot};
use crate::messages::taught;
use crate::overlays::Overlay;
use crate::overlays::outcome::Outcome;
use crate::overlays::path_prompt::PathPrompt;
use crate::screens;
use crate::screens::state::State;

impl State {
    /// Takes in a message; returns what others have to do.
    pub fn update(&mut self, message: Message) -> Vec<Effect> {
        let before = self.focus.clone();
        let filter = self.nav.filters[Screen::Sql as usize].clone();
        let mut effects = vec![];
        match message {
            Message::Key(event) => effects = self.key(&event),
            Message::Mouse(event) => effects = self.mouse(&event),
            Message::Resize(width, height) => self.terminal.size = Size::new(width, height),
            Message::Data(snapshot) => self.receive(snapshot),
            Message::Done(text) => self.say(text),
            Message::Failed(text) => self.complain(text),
            Message::Saved(outcome) => self.saved(outcome),
            Message::Measured(id, outcome) => drop(self.subjects.measured.insert(id, outcome)),
            Message::LaidOut(request, outcome) => self.take_layout(*request, outcome),
            Message::Sewn(work, outcome) => self.sewn(*work, outcome),
            Message::Written(what, text) => effects = self.written(*what, text),
            Message::Previewed(request, outcome) => self.take_preview(*request, outcome),
            Message::SeamsSaved(style, seams, outcome) => self.seams_saved(&style, &seams, outcome),
            Message::Picture(request, drawn) => self.take_picture(request, drawn),
            Message::Cut(jobs, sections) => self.take_sections(jobs, sections),
            Message::Altered(request, found) => self.take_alteration(&request, found),
            Message::Names(relations, saved) => (self.sql.relations, self.sql.saved) = (Some(relations), saved),
            Message::Answered(ms, outcome) => self.answered(ms, outcome),
            Message::Reports(rows) => self.reports.rows = Some(rows),
            Message::ReportBuilt(page, rows) => self.report_built(page, rows),
            Message::StudyCreated(name, outcome) => self.study_created(&name, outcome),
            Message::Live(frame) if self.running.watched == Some(frame.job) => self.running.live = Some(frame),
            Message::Live(_) => {}
            Message::RunEnded(outcome) => effects = self.run_ended(outcome),
            Message::Hangup if self.running.target.is_some() => self.terminal.detached = true,
            Message::Hangup => effects = vec![Effect::Quit],
            Message::Terminate => effects = vec![Effect::StopRun, Effect::Quit],
        }
        if self.nav.filters[Screen::Sql as usize] != filter {
            self.arrange_rows();
        }
        self.arrange_jobs();
        self.focus.compare = if self.nav.screen == Screen::Compare { self.to_compare() } else { vec![] };
        self.focus.wearer = self.wearer().filter(|_| self.nav.screen == Screen::Fit);
        if self.focus != before {
            self.moved(&before);
            effects.push(Effect::Read(self.focus.clone()));
        }
        let page = screens::page(self.nav.screen);
        effects.extend(self.ask_for_pictures(page.pictures(self, self.body())));
        effects.extend(page.wanted(self));
        effects.extend(self.ask_to_watch());
        for effect in &effects {
            match taught::command(effect) {
                command if taught::is_awaited(effect) => self.told.awaited = command,
                command => self.told.commands.extend(command),
            }
        }
        effects
    }

    fn key(&mut self, event: &KeyEvent) -> Vec<Effect> {
        if event.kind == KeyEventKind::Release {
            return vec![];
        }
        let Some(mut overlay) = self.overlay.take() else {
            self.told.notice = None;
            if let Some(effects) = screens::page(self.nav.screen).take_key(self, event) {
                return effects;
            }
            return action_of(self.setup.bindings, Key::of(event), keys_of(self))
                .map_or(vec![], |action| self.act(action));
        };
        match overlay.key(event, &mut self.nav.filters[self.nav.screen as usize]) {
            Outcome::Open => {
                self.overlay = Some(overlay);
                self.keep_selection_visible();
                vec![]
            }
            Outcome::Closed => vec![],
            Outcome::Action(action) => self.act(action),
            Outcome::Effects(effects) => {
                if effects.iter().any(|effect| matches!(effect, Effect::Copy(_))) {
                    self.say("copied");
                }
                effects
            }
            Outcome::Thing(thing) => {
                self.look_at(thing);
                vec![]
            }
            Outcome::Jump(goal) => {
                self.jump(goal);
                vec![]
            }
            Outcome::Tour(step) => {
                self.tour(step);
                vec![]
            }
            Outcome::Query(text) => {
                self.take_query(&text);
                vec![]
            }
            Outcome::Rename(name) => {
                self.overlay = Some(Overlay::Path(PathPrompt::rename_query(name)));
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
        self.jobs.receive(&snapshot.jobs);
        let had_grid = self.grid().is_some();
        self.focus.study = snapshot.study().map(|study| study.name.clone());
        self.focus.garment = snapshot.grid.as_ref().map(|grid| grid.garment.clone());
        self.data = Some(snapshot);
        self.arrange_jobs();
        self.subjects.chosen = self.subject().map(|row| row.name.clone());
        self.fabrics.chosen = self.fabric().map(|row| row.fabric.name.clone());
        self.clamp_place();
        self.results.row = self.results.row.min(self.chi().len().saturating_sub(1));
        let known = self.focus.job.filter(|id| self.data.as_ref().is_some_and(|data| data.job(*id).is_some()));
        match known.and_then(|id| self.place_of(id)) {
            Some(place) => self.study.place = place,
            None if !had_grid || known.is_none() => {
                self.focus.job = self.cell_at(self.study.place).and_then(|cell| cell.job)
            }
            None => {}
        }
    }

    /// Resets what belongs to the job looked at before.
    fn moved(&mut self, before: &Focus) {
        if self.focus.job == before.job {
            return;
        }
        self.jobs.log_up = 0;
        let garment = self.job().map(|job| job.garment.clone());
        if garment.is_some() {
            self.focus.garment = garment;
        }
        if let Some(place) = self.focus.job.and_then(|id| self.place_of(id)) {
            self.study.place = place;
        }
    }

    /// Moves the selection to a row that the filter still shows.
    fn keep_selection_visible(&mut self) {
        self.arrange_jobs();
        if self.nav.screen == Screen::Jobs {
            let jobs = self.jobs();
            let is_hidden = !jobs.iter().any(|job| Some(job.id) == self.focus.job);
            if let Some(first) = jobs.first().filter(|_| is_hidden).map(|job| job.id) {
                self.select(first);
            }
        }
        self.results.row = self.results.row.min(self.chi().len().saturating_sub(1));
    }

    fn run_ended(&mut self, outcome: Result<String, String>) -> Vec<Effect> {
        self.running.target = None;
        match outcome {
            Ok(text) => self.say(text),
            Err(text) => self.complain(text),
        }
        if self.terminal.detached { vec![Effect::Quit] } else { vec![] }
    }

    /// What the mouse does: tabs show screens, the wheel scrolls.
    fn mouse(&mut self, event: &MouseEvent) -> Vec<Effect> {
        match event.kind {
            _ if self.overlay.is_some() => vec![],
            MouseEventKind::ScrollUp => self.act(Action::Up),
            MouseEventKind::ScrollDown => self.act(Action::Down),
            MouseEventKind::Down(MouseButton::Left) if event.row == 0 => {
                tab_at(self, event.column).map_or(vec![], |screen| self.act(Action::Show(screen)))
            }
            _ => vec![],
        }
    }
}
