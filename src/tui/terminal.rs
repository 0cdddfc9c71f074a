//! The terminal: taken at the start, given back at the end, however that comes.

use std::io::{self, IsTerminal, Stdout};
use std::os::unix::net::UnixStream;
use std::panic;
use std::sync::Once;
use std::thread;
use std::time::{Duration, Instant};

use crossterm::event::{DisableMouseCapture, EnableMouseCapture};
use crossterm::{cursor, execute, terminal};
use ratatui::Terminal;
use ratatui::layout::Size;

use super::line::{Late, Line};
use super::screens;
use super::state::State;

/// Time between two frames of what was drawn at once.
const PAUSE: Duration = Duration::from_millis(25);
/// Time without a key after which pictures are sent: longer than between two repeats of a key that is held.
const REST: Duration = Duration::from_millis(80);

/// The terminal while the workbench has it; dropping it gives it back.
pub struct Screen {
    terminal: Terminal<Line<Stdout>>,
    /// When a key was pressed last.
    last_key: Option<Instant>,
}

impl Screen {
    /// Takes the terminal: raw keys, the alternate screen, no cursor. A panic gives it back before it is reported.
    ///
    /// # Errors
    /// When standard input or output is no terminal.
    pub fn enter() -> io::Result<Self> {
        if !(io::stdin().is_terminal() && io::stdout().is_terminal()) {
            return Err(io::Error::other("standard input or output is none"));
        }
        static HOOK: Once = Once::new();
        HOOK.call_once(|| {
            let before = panic::take_hook();
            let screen_thread = thread::current().id();
            panic::set_hook(Box::new(move |info| {
                // A panic of another thread is told on the screen, which goes on; here it would be written over it.
                if thread::current().id() == screen_thread {
                    restore();
                    before(info);
                }
            }));
        });
        terminal::enable_raw_mode()?;
        let entered = execute!(io::stdout(), terminal::EnterAlternateScreen, cursor::Hide)
            .and_then(|()| Terminal::new(Line::new(io::stdout(), None)?));
        match entered {
            Ok(terminal) => Ok(Self { terminal, last_key: None }),
            Err(error) => {
                restore();
                Err(error)
            }
        }
    }

    /// Size of the terminal.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub fn size(&self) -> io::Result<Size> {
        self.terminal.size()
    }

    /// Draws the state and sends a frame of what has changed.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub fn draw(&mut self, state: &State) -> io::Result<()> {
        self.terminal.draw(|frame| screens::draw(frame, state))?;
        self.go_on()
    }

    /// Sends the next frame of what is drawn: pictures too, once the keys rest.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub fn go_on(&mut self) -> io::Result<()> {
        let is_at_rest = self.last_key.is_none_or(|key| key.elapsed() >= REST);
        self.terminal.backend_mut().send(is_at_rest).map(|_| ())
    }

    /// Time until the next frame is sent; `None` where all is sent.
    #[must_use]
    pub fn pause(&self) -> Option<Duration> {
        let rest = self.last_key.map_or(Duration::ZERO, |key| REST.saturating_sub(key.elapsed()));
        match self.terminal.backend().late() {
            Late::Nothing => None,
            Late::Texts => Some(PAUSE),
            Late::Pictures => Some(PAUSE.max(rest)),
        }
    }

    /// Takes note that a key was pressed.
    pub fn key_pressed(&mut self) {
        self.last_key = Some(Instant::now());
    }

    /// Has everything drawn anew.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub fn clear(&mut self) -> io::Result<()> {
        self.terminal.clear()
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        restore();
    }
}

/// Takes the mouse, or leaves it to the terminal.
///
/// # Errors
/// When the terminal is gone.
pub fn take_mouse(is_taken: bool) -> io::Result<()> {
    if is_taken { execute!(io::stdout(), EnableMouseCapture) } else { execute!(io::stdout(), DisableMouseCapture) }
}

/// Puts a silent socket in the place of standard input once its terminal is gone: crossterm's reader would otherwise read
/// the end of it over and over, a whole core's worth. Silence lasts as long as the returned end lives.
///
/// # Errors
/// When the system has no sockets or descriptors left.
pub fn silence_input() -> io::Result<UnixStream> {
    let (ours, silent) = UnixStream::pair()?;
    silent.set_nonblocking(true)?;
    rustix::stdio::dup2_stdin(&silent)?;
    Ok(ours)
}

/// Gives the terminal back, as far as it is still there.
fn restore() {
    // Errors have nowhere to go: the terminal that would show them is what failed.
    let _ = execute!(io::stdout(), DisableMouseCapture, terminal::LeaveAlternateScreen, cursor::Show);
    let _ = terminal::disable_raw_mode();
}
