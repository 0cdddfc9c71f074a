//! The workbench from outside: keys go in, screens and effects come out; no terminal, no threads.

mod alter;
mod behaviour;
mod comments;
mod explanation;
mod fabrics;
mod fit;
mod fixture;
mod jumps;
mod looks;
mod outfits;
mod protocols;
mod questions;
mod styles;
mod subjects;
mod workspace;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::layout::Size;

use crate::app::{App, frame};
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::seams::SizeLayout;
use crate::messages::snapshot::Snapshot;
use crate::screens::state::Abilities;
use crate::widgets::picture::{PictureRequest, Pictured};
use crate::widgets::theme::{Colours, Theme};

/// A workbench without a terminal.
struct Bench {
    app: App,
    /// Effects since the last call of [`Bench::asked`].
    effects: Vec<Effect>,
}

impl Bench {
    fn new(width: u16, height: u16, data: Snapshot) -> Self {
        let abilities = Abilities { run: true, pictures: true };
        let app = App::new(Theme::new(Colours::True, false), abilities, Size::new(width, height));
        let mut bench = Self { app, effects: vec![] };
        bench.send(Message::Data(Box::new(data)));
        bench
    }

    /// The workbench of the example study, with the details of any selected job.
    fn example(width: u16, height: u16) -> Self {
        Self::new(width, height, fixture::snapshot())
    }

    /// Sends a message and answers its requests for data at once.
    fn send(&mut self, message: Message) {
        let mut effects = self.app.update(message);
        let mut further = vec![];
        for effect in &effects {
            if let (Effect::Read(focus), Some(data)) = (effect, &self.app.state.data) {
                let mut next = data.clone();
                next.detail = focus.job.map(fixture::detail);
                next.compared = focus.compare.iter().map(|id| fixture::compared(*id)).collect();
                next.recommendations = fixture::recommendations();
                next.worn = focus.wearer.as_deref().map(fit::worn);
                further = self.app.update(Message::Data(next));
                assert!(further.iter().all(|e| !matches!(e, Effect::Read(_))));
            }
            if let Effect::Draw(requests) = effect
                && let [PictureRequest { of: Pictured::Body(id), .. }] = requests[..]
            {
                self.app.update(Message::Measured(id, Ok(Box::new(fixture::girths()))));
            }
        }
        effects.extend(further.into_iter().filter(|e| matches!(e, Effect::Cut(_) | Effect::Alter(_))));
        for effect in &effects {
            if let Effect::Cut(jobs) = effect {
                self.app.update(Message::Cut(jobs.clone(), Ok(fit::sections(jobs))));
            }
        }
        let asked =
            effects.iter().filter_map(|e| if let Effect::Alter(request) = e { Some(request.clone()) } else { None });
        for request in asked.collect::<Vec<_>>() {
            let found = Ok(Box::new(alter::found(&request)));
            self.app.update(Message::Altered(Box::new(request), found));
        }
        let tasks: Vec<_> = effects
            .iter()
            .filter_map(|e| if let Effect::Seams(task) = e { Some(task.clone()) } else { None })
            .collect();
        self.effects.extend(effects);
        for task in tasks {
            self.send(fixture::work(task));
        }
    }

    /// Presses keys: letters as they are, others by name in angle brackets (`<Enter>`).
    fn press(&mut self, keys: &str) -> &mut Self {
        let mut rest = keys;
        while let Some(first) = rest.chars().next() {
            let named = rest.strip_prefix('<').and_then(|tail| tail.split_once('>'));
            let (name, tail) = named.unwrap_or(("", &rest[first.len_utf8()..]));
            let (code, modifiers) = match name.strip_prefix("C-").and_then(|letter| letter.chars().next()) {
                Some(letter) => (KeyCode::Char(letter), KeyModifiers::CONTROL),
                None if name.is_empty() => (KeyCode::Char(first), KeyModifiers::NONE),
                None => (code_of(name), KeyModifiers::NONE),
            };
            self.send(Message::Key(KeyEvent::new(code, modifiers)));
            rest = tail;
        }
        self
    }

    /// Returns effects, except those that the bench answers itself: reads, pictures, sections, alterations, work on
    /// seams.
    fn asked(&mut self) -> Vec<Effect> {
        let effects = std::mem::take(&mut self.effects);
        let is_done = |e: &Effect| {
            matches!(
                e,
                Effect::Read(_)
                    | Effect::Draw(_)
                    | Effect::Cut(_)
                    | Effect::Alter(_)
                    | Effect::Seams(_)
                    | Effect::Preview(_)
            )
        };
        effects.into_iter().filter(|e| !is_done(e)).collect()
    }

    fn drawn(&self) -> TestBackend {
        let Size { width, height } = self.app.state.terminal.size;
        let mut terminal = Terminal::new(TestBackend::new(width, height)).expect("a test backend never fails");
        terminal.draw(|frame| frame::draw(frame, &self.app)).expect("a test backend never fails");
        terminal.backend().clone()
    }

    fn layout(&self) -> &SizeLayout {
        self.app.screens.styles.laid_out(&self.app.state).expect("laid out")
    }

    fn screen(&self) -> String {
        self.drawn().to_string()
    }

    fn status(&self) -> String {
        self.screen().lines().last().unwrap_or_default().trim_matches('"').trim().to_owned()
    }
}

fn code_of(name: &str) -> KeyCode {
    match name {
        "Enter" => KeyCode::Enter,
        "Esc" => KeyCode::Esc,
        "Tab" => KeyCode::Tab,
        "S-Tab" => KeyCode::BackTab,
        "Right" => KeyCode::Right,
        "PgDn" => KeyCode::PageDown,
        "Left" => KeyCode::Left,
        "Up" => KeyCode::Up,
        "Down" => KeyCode::Down,
        "F2" => KeyCode::F(2),
        "F5" => KeyCode::F(5),
        "Backspace" => KeyCode::Backspace,
        other => panic!("no key `{other}`"),
    }
}
