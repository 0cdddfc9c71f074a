//! The terminal: taken at the start, given back at the end, whatever the cause of the end.

pub mod clipboard;
pub mod editor;
pub mod framed;

use std::io::{self, IsTerminal, Stdout};
use std::os::unix::net::UnixStream;
use std::sync::Once;
use std::time::{Duration, Instant};
use std::{panic, thread};

use crossterm::event::{DisableMouseCapture, EnableMouseCapture};
use crossterm::{cursor, execute, terminal};
use ratatui::layout::Size;
use ratatui::{Frame, Terminal};
use rustix::process::{Signal, kill_current_process_group};

use crate::terminal::framed::{FramedBackend, Late};

/// Least time between two frames. Fast keys share a frame, and a slow line does not get more than it can take.
const PAUSE: Duration = Duration::from_millis(20);
/// Time without a key after which pictures are sent while keys follow each other, longer than the time between repeats of
/// a held key.
const REST: Duration = Duration::from_millis(80);
/// Greatest time between keys that follow each other. The picture of a single key is sent at once.
const FOLLOWING: Duration = Duration::from_millis(160);

/// The terminal while the workbench has it. Dropping this gives it back.
pub struct Display {
    terminal: Terminal<FramedBackend<Stdout>>,
    last_key: Option<Instant>,
    /// Time after that key for which pictures wait.
    rest: Duration,
    last_frame: Option<Instant>,
    /// True if the state has changed since the last drawing.
    is_stale: bool,
}

impl Display {
    /// Takes the terminal: raw keys, alternate screen, hidden cursor. A panic gives it back before the panic is
    /// reported.
    pub fn enter() -> io::Result<Self> {
        if !(io::stdin().is_terminal() && io::stdout().is_terminal()) {
            return Err(io::Error::other("standard input or output is none"));
        }
        static HOOK: Once = Once::new();
        HOOK.call_once(|| {
            let before = panic::take_hook();
            let screen_thread = thread::current().id();
            panic::set_hook(Box::new(move |info| {
                // A panic of another thread is reported on the screen, which stays.
                if thread::current().id() == screen_thread {
                    restore();
                    before(info);
                }
            }));
        });
        terminal::enable_raw_mode()?;
        let entered = execute!(io::stdout(), terminal::EnterAlternateScreen, cursor::Hide)
            .and_then(|()| Terminal::new(FramedBackend::new(io::stdout(), None)?));
        match entered {
            Ok(terminal) => {
                Ok(Self { terminal, last_key: None, rest: Duration::ZERO, last_frame: None, is_stale: false })
            }
            Err(error) => {
                restore();
                Err(error)
            }
        }
    }

    pub fn size(&self) -> io::Result<Size> {
        self.terminal.size()
    }

    /// Draws the screen, now or when the last frame is old enough.
    pub fn show(&mut self, draw: impl FnOnce(&mut Frame<'_>)) -> io::Result<()> {
        self.is_stale = true;
        self.go_on(draw)
    }

    /// Draws the screen if the state has changed, and sends the next frame, with pictures if no key was pressed lately.
    /// Does nothing while the last frame is too young.
    pub fn go_on(&mut self, draw: impl FnOnce(&mut Frame<'_>)) -> io::Result<()> {
        if !self.age_left().is_zero() {
            return Ok(());
        }
        if std::mem::take(&mut self.is_stale) {
            self.terminal.draw(draw)?;
        }
        let is_at_rest = self.rest_left().is_zero();
        if self.terminal.backend_mut().send(is_at_rest)? > 0 {
            self.last_frame = Some(Instant::now());
        }
        Ok(())
    }

    /// Time until the next frame is due; `None` if nothing waits to be sent.
    pub fn pause(&self) -> Option<Duration> {
        match self.terminal.backend().late() {
            Late::Nothing if !self.is_stale => None,
            Late::Pictures if !self.is_stale => Some(self.age_left().max(self.rest_left())),
            _ => Some(self.age_left()),
        }
    }

    /// Time until the last frame is old enough.
    fn age_left(&self) -> Duration {
        self.last_frame.map_or(Duration::ZERO, |frame| PAUSE.saturating_sub(frame.elapsed()))
    }

    /// Time until no key was pressed for long enough.
    fn rest_left(&self) -> Duration {
        self.last_key.map_or(Duration::ZERO, |key| self.rest.saturating_sub(key.elapsed()))
    }

    pub fn key_pressed(&mut self) {
        let follows = self.last_key.is_some_and(|last| last.elapsed() < FOLLOWING);
        self.rest = if follows { REST } else { Duration::ZERO };
        self.last_key = Some(Instant::now());
    }

    /// Lends the terminal to another program during `work`, and takes it again.
    pub fn lend<T>(&mut self, work: impl FnOnce() -> T) -> io::Result<T> {
        restore();
        let outcome = work();
        terminal::enable_raw_mode()?;
        execute!(io::stdout(), terminal::EnterAlternateScreen, cursor::Hide)?;
        self.terminal.clear()?;
        Ok(outcome)
    }

    /// Draws everything again.
    pub fn clear(&mut self) -> io::Result<()> {
        self.terminal.clear()
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        restore();
    }
}

pub fn take_mouse(is_taken: bool) -> io::Result<()> {
    if is_taken { execute!(io::stdout(), EnableMouseCapture) } else { execute!(io::stdout(), DisableMouseCapture) }
}

/// Stops this program and those of its process group, as Ctrl-Z does, until the shell continues them. Where no shell
/// could do that, the system ignores it.
pub fn stop() {
    // An error means that there is nothing to stop: the workbench goes on.
    let _ = kill_current_process_group(Signal::TSTP);
}

/// Replaces standard input by a silent socket once its terminal is gone. Otherwise crossterm would read the end of
/// input over and over and keep a core busy. The socket is silent while the returned end lives.
pub fn silence_input() -> io::Result<UnixStream> {
    let (ours, silent) = UnixStream::pair()?;
    silent.set_nonblocking(true)?;
    rustix::stdio::dup2_stdin(&silent)?;
    Ok(ours)
}

fn restore() {
    // Errors cannot be shown: the terminal is what failed.
    let _ = execute!(io::stdout(), DisableMouseCapture, terminal::LeaveAlternateScreen, cursor::Show);
    let _ = terminal::disable_raw_mode();
}
