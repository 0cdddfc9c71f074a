//! The only place where messages change the state: `(state, message) -> (state, effects)`. Nothing here waits.

use crossterm::event::{KeyEvent, KeyEventKind, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::{Position, Size};

use crate::app::App;
use crate::app::frame::{keys_of, tab_at};
use crate::keys::action::Action;
use crate::keys::binding::{Key, action_of};
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::snapshot::Focus;
use crate::messages::taught;
use crate::overlays::Overlay;
use crate::overlays::outcome::Outcome;
use crate::overlays::path_prompt::{PathPrompt, Purpose};
use crate::screens::compare::actions::to_compare;
use crate::screens::fit::actions::wearer;
use crate::screens::measurements;
use crate::screens::picture_pane::actions::watch;
use crate::screens::study::actions::study_created;
use crate::widgets::jump::hit;

impl App {
    pub fn update(&mut self, message: Message) -> Vec<Effect> {
        let (before, screen) = (self.state.focus.clone(), self.state.nav.screen);
        let filter = self.state.nav.filters[Screen::Sql as usize].clone();
        let mut effects = self.take(message);
        if self.state.nav.filters[Screen::Sql as usize] != filter {
            self.screens.sql.arrange_rows(&self.state);
        }
        self.screens.jobs.arrange(&self.state);
        self.take_marks_away(screen, &before);
        self.share();
        if self.state.focus != before {
            self.moved(&before);
            effects.push(Effect::Read(self.state.focus.clone()));
        }
        let Self { state, screens } = self;
        let page = screens.page_mut(state.nav.screen);
        let pictures = page.pictures(state, state.body());
        effects.extend(state.pictures.ask_for(pictures));
        effects.extend(page.wanted(state));
        effects.extend(watch(state));
        for effect in &effects {
            match taught::command(effect) {
                command if taught::is_awaited(effect) => state.told.awaited = command,
                command => state.told.commands.extend(command),
            }
        }
        effects
    }

    /// Handles a message; [`App::update`] does what every message needs after it.
    fn take(&mut self, message: Message) -> Vec<Effect> {
        let Self { state, screens } = self;
        match message {
            Message::Key(event) => return self.key(&event),
            Message::Mouse(event) => return self.mouse(&event),
            Message::Resize(width, height) => state.terminal.size = Size::new(width, height),
            Message::Data(snapshot) => return self.receive(snapshot),
            Message::Done(text) => state.say(text),
            Message::Failed(text) => state.complain(text),
            Message::Saved(outcome) => self.saved(outcome),
            Message::Commented(of, change, text) => {
                screens.fit.comments.changed(of, *change);
                self.saved(Ok(text));
            }
            Message::Measured(id, outcome) => drop(screens.subjects.measured.insert(id, outcome)),
            Message::LaidOut(request, outcome) => screens.styles.take_layout(state, *request, outcome),
            Message::Sewn(work, outcome) => screens.styles.sewn(state, *work, outcome),
            Message::Written(writing, text) => return self.written(*writing, text),
            Message::Previewed(request, outcome) => screens.styles.take_preview(state, *request, outcome),
            Message::SeamsSaved(style, seams, outcome) => screens.styles.seams_saved(state, &style, &seams, outcome),
            Message::Picture(request, drawn) => state.pictures.take(request, drawn),
            Message::Cut(jobs, sections) => screens.fit.take_sections(jobs, sections),
            Message::Altered(request, found) => screens.fit.alter.take(state, &request, found),
            Message::Names(relations, saved) => {
                (screens.sql.relations, screens.sql.saved) = (Some(relations), saved);
            }
            Message::Answered(ms, outcome) => screens.sql.answered(state, ms, outcome),
            Message::Reports(rows) => screens.reports.rows = Some(rows),
            Message::ReportPart(part) => screens.reports.part = part,
            Message::ReportBuilt(page, rows) => screens.reports.built(state, page, rows),
            Message::StudyCreated(name, outcome) => study_created(state, &name, outcome),
            Message::Live(frame) if state.running.watched == Some(frame.job) => state.running.live = Some(frame),
            Message::Live(_) => {}
            Message::Copied(Ok(place)) => {
                let text = format!("copied {}: {place}", state.told.copying);
                state.say(text);
            }
            Message::Copied(Err(text)) => state.complain(text),
            Message::Faded => state.told.notice = None,
            Message::RunEnded(outcome) => return self.run_ended(outcome),
            Message::Hangup if state.running.target.is_some() => state.terminal.detached = true,
            Message::Hangup => return vec![Effect::Quit],
            Message::Terminate => return vec![Effect::StopRun, Effect::Quit],
        }
        vec![]
    }

    /// Takes marks away whose list is left: nobody should act on rows that are not seen. Results and comparisons keep
    /// those of the runs they show.
    fn take_marks_away(&mut self, screen: Screen, before: &Focus) {
        let Self { state, screens } = self;
        let shown = state.nav.screen;
        if shown != screen {
            screens.page_mut(screen).left();
        }
        let keeps = shown == state.nav.marked_on || matches!(shown, Screen::Results | Screen::Compare);
        let is_other = before.study.is_some() && before.study != state.focus.study;
        if !keeps && shown != screen || is_other {
            state.marks.clear();
        }
    }

    /// Copies choices of screens into the state, for threads and other screens.
    fn share(&mut self) {
        let Self { state, screens } = self;
        let screen = state.nav.screen;
        state.focus.compare = if screen == Screen::Compare { to_compare(state) } else { vec![] };
        state.focus.wearer = wearer(state).filter(|_| screen == Screen::Fit).cloned();
        state.in_hand.subject = screens.subjects.selected(state).map(|row| row.id);
        state.in_hand.fabric = screens.styles.cloth(state).cloned();
        if screens.fabrics.is_picked {
            state.in_hand.fabric.clone_from(&screens.fabrics.chosen);
        }
    }

    fn key(&mut self, event: &KeyEvent) -> Vec<Effect> {
        if event.kind == KeyEventKind::Release {
            return vec![];
        }
        // Ctrl-Z means the same everywhere, as in every program of a shell.
        if action_of(self.state.setup.bindings, Key::of(event), keys_of(self)) == Some(Action::Suspend) {
            return self.act(Action::Suspend);
        }
        let Self { state, screens } = self;
        let Some(mut overlay) = state.overlay.take() else {
            state.told.notice = None;
            if let Some(effects) = screens.page_mut(state.nav.screen).take_key(state, event) {
                return effects;
            }
            let action = action_of(state.setup.bindings, Key::of(event), keys_of(self));
            return action.map_or(vec![], |action| self.act(action));
        };
        match overlay.key(event, &mut state.nav.filters[state.nav.screen as usize]) {
            Outcome::Open => {
                state.overlay = Some(overlay);
                self.keep_selection_visible();
            }
            Outcome::Closed => {}
            Outcome::Action(action) => return self.act(action),
            Outcome::Effects(effects) => {
                state.told.copying = "what was done".to_owned();
                return effects;
            }
            Outcome::Thing(thing) => self.look_at(thing),
            Outcome::Jump(goal) => self.jump(goal),
            Outcome::Tour(step) => self.tour(step),
            Outcome::Query(text) => screens.sql.take_query(state, &text),
            Outcome::Rename(name) => {
                let prompt = PathPrompt::new(Purpose::RenameQuery(name.clone()), name);
                state.overlay = Some(Overlay::Path(prompt));
            }
            Outcome::Sent(effects) => {
                state.overlay = Some(overlay);
                return effects;
            }
        }
        vec![]
    }

    /// Resets what belonged to the job shown before.
    fn moved(&mut self, before: &Focus) {
        let Self { state, screens } = self;
        if state.focus.job == before.job {
            return;
        }
        screens.jobs.log_up = 0;
        let garment = state.job().map(|job| job.garment.clone());
        if garment.is_some() {
            state.focus.garment = garment;
        }
        let place = state.data.as_ref().zip(state.focus.job).and_then(|(data, id)| data.place_of(id));
        state.place = place.unwrap_or(state.place);
    }

    fn keep_selection_visible(&mut self) {
        let Self { state, screens } = self;
        screens.jobs.arrange(state);
        if state.nav.screen == Screen::Jobs {
            screens.jobs.keep_visible(state);
        }
        measurements::clamp(state);
    }

    /// Handles the mouse: a click on a tab shows its screen, on a row, cell or pane goes there; the wheel scrolls.
    fn mouse(&mut self, event: &MouseEvent) -> Vec<Effect> {
        match event.kind {
            _ if self.state.overlay.is_some() => vec![],
            MouseEventKind::ScrollUp => self.act(Action::Up),
            MouseEventKind::ScrollDown => self.act(Action::Down),
            MouseEventKind::Down(MouseButton::Left) if event.row == 0 => {
                tab_at(&self.state, event.column).map_or(vec![], |screen| self.act(Action::Show(screen)))
            }
            MouseEventKind::Down(MouseButton::Left) => {
                let Self { state, screens } = self;
                let targets = screens.page(state.nav.screen).targets(state, state.body());
                if let Some(goal) = hit(&targets, Position::new(event.column, event.row)) {
                    self.jump(goal);
                }
                vec![]
            }
            _ => vec![],
        }
    }
}
