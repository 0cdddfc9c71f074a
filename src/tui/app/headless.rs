//! The workbench without a terminal or threads, for benchmarks: it waits for every answer.

use std::cell::Cell;
use std::io;
use std::path::Path;
use std::rc::Rc;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::layout::{Rect, Size};
use ratatui::{Terminal, TerminalOptions, Viewport};

use crate::app::{App, frame};
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::screens::state::Abilities;
use crate::terminal::framed::FramedBackend;
use crate::threads::reading;
use crate::widgets::theme::{Colours, Theme};
use store::{Result, Store};
use wardrobe::catalogue;

/// Writer that counts bytes.
struct Counter(Rc<Cell<usize>>);

impl io::Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.set(self.0.get() + bytes.len());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

pub struct Headless {
    store: Store,
    app: App,
    sent: Rc<Cell<usize>>,
    terminal: Terminal<FramedBackend<Counter>>,
}

impl Headless {
    pub fn new(database: &Path, width: u16, height: u16) -> Result<Self> {
        let store = catalogue::open(database, true)?;
        let abilities = Abilities { run: false, pictures: false };
        let app = App::new(Theme::new(Colours::Indexed, false), abilities, Size::new(width, height));
        let options = TerminalOptions { viewport: Viewport::Fixed(Rect::new(0, 0, width, height)) };
        let sent = Rc::new(Cell::new(0));
        let line = FramedBackend::new(Counter(sent.clone()), Some(Size::new(width, height)));
        let terminal = line
            .and_then(|line| Terminal::with_options(line, options))
            .map_err(store::StudyError::io("a screen in memory"))?;
        let mut headless = Self { store, app, sent, terminal };
        headless.read()?;
        Ok(headless)
    }

    pub fn read(&mut self) -> Result<()> {
        let data = reading::snapshot(&self.store, &self.app.state.focus)?;
        self.app.update(Message::Data(Box::new(data)));
        Ok(())
    }

    /// Returns true if the key asks for data to be read.
    pub fn press(&mut self, code: KeyCode) -> bool {
        let effects = self.app.update(Message::Key(KeyEvent::new(code, KeyModifiers::NONE)));
        effects.iter().any(|effect| matches!(effect, Effect::Read(_)))
    }

    /// Returns the number of bytes in the first frame for a terminal.
    pub fn draw(&mut self) -> usize {
        let Self { terminal, app, sent, .. } = self;
        // Drawing to memory does not fail.
        let _ = terminal.draw(|frame| frame::draw(frame, app));
        let _ = terminal.backend_mut().send(true);
        sent.take()
    }
}
