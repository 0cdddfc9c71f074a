//! The workbench: screens over a store that changes meanwhile.
//!
//! One event loop takes messages one at a time, lets `App::update` turn each into a new state and effects, and draws
//! when the state has changed. Everything that may take time (database, pictures, runs) is done by `threads`, which
//! answer with messages. The loop itself waits only for the next message.
//!
//! Folders, each of which uses only those after it:
//!
//! - `app`: the update loop and the frame around the screens;
//! - `screens`: a folder for each screen, with its state, actions and drawing; the state that screens share;
//! - `overlays`: lists, forms and questions that open above a screen;
//! - `threads`, `terminal`: work outside the loop, which knows no screen;
//! - `messages`: messages between threads and screens;
//! - `keys`: actions and the keys for them;
//! - `widgets`: tools for drawing and typing;
//! - `config`: the user's own files; `glossary`: explanations of numbers.
//!
//! *Invariant*: no SQL and no simulator is called here; the crates from `store` on answer.

mod app;
mod config;
mod glossary;
mod keys;
mod messages;
mod overlays;
mod screens;
mod terminal;
#[cfg(test)]
mod tests;
mod threads;
mod widgets;

use std::collections::VecDeque;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvError, RecvTimeoutError};
use std::time::Instant;

pub use app::headless::Headless;
pub use widgets::picture::Images;

use app::fading::Fading;
use app::session::{self, Keeper, Session};
use app::{App, frame};
use config::ConfigError;
use engine::notification;
use keys::file as keys_file;
use messages::effect::Effect;
use messages::message::Message;
use screens::state::{Abilities, Folders};
use store::owner::host;
use store::{Encoder, StudyError};
use terminal::Display;
use terminal::clipboard;
use threads::Threads;
use wardrobe::catalogue;
use widgets::picture::PictureEncoder;
use widgets::theme::{self, Colours, Theme};
use widgets::theme_file;

pub struct Options {
    pub database: PathBuf,
    /// True where the database was named by the user, so that commands shown must name it too.
    pub is_database_named: bool,
    pub readonly: bool,
    /// True where colours are off, whatever the environment says.
    pub no_color: bool,
    pub images: Images,
    /// Makers of files that need all rows at once, for exports, by the endings of the files.
    pub encoders: &'static [Encoder],
    /// Folder of the study that comes with the program. A database without studies is offered it; it is written when it
    /// is run.
    pub quickstart: PathBuf,
}

#[derive(Debug, thiserror::Error)]
pub enum TuiError {
    #[error(transparent)]
    Study(#[from] StudyError),
    /// One of the user's own files, with keys or colours, is wrong.
    #[error(transparent)]
    Config(#[from] ConfigError),
    #[error("the workbench needs a terminal: {0}; `toile --help` lists commands that do not")]
    Terminal(#[from] io::Error),
}

/// Work that is left when the workbench was left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Left {
    Nothing,
    /// The study at a path is to be run on by another process, as the user wished.
    Run(PathBuf),
}

/// Runs the workbench until the user leaves it. A run that was started in it is then stopped, and its unfinished jobs
/// go back into the queue. When the terminal is lost, the run is waited for instead.
pub fn run(options: Options) -> Result<Left, TuiError> {
    let env = |name: &str| std::env::var(name).ok();
    let keys = keys_file::read(config::path(&env, keys_file::FILE).as_deref())?;
    let store = catalogue::open(&options.database, options.readonly)?;
    let roles = config::read(config::path(&env, theme_file::FILE).as_deref(), theme_file::taken)?;
    let colours = Colours::detect(options.no_color, &env);
    let theme = Theme { roles, ..Theme::new(colours, theme::wants_ascii(&env)) };
    let encoder = PictureEncoder::new(options.images, theme.colours, &env);
    let folders = folders(&options);
    let abilities = Abilities { run: !options.readonly, pictures: encoder.is_some() };

    let mut display = Display::enter()?;
    let size = display.size()?;
    let mut app = App::new(theme, abilities, size);
    (app.state.setup.bindings, app.state.setup.folders) = (keys.bindings, folders);
    app.screens.sql.editor.edit_as(keys.editing);
    let named = options.is_database_named.then(|| std::path::absolute(&options.database)).transpose()?;
    app.state.setup.database = named;
    let user = env("USER").or_else(|| env("LOGNAME")).filter(|user| !user.is_empty());
    app.state.setup.login = user.map_or_else(host, |user| format!("{user}@{}", host()));
    // Over SSH the terminal is elsewhere, and its own selection of text matters more.
    app.state.terminal.has_mouse = env("SSH_TTY").is_none_or(|terminal| terminal.is_empty());
    let path = session::path(&options.database, &env);
    let session = path.as_deref().map(Session::read).unwrap_or_default();
    session.clone().restore(&mut app);
    let mut keeper = Keeper::new(path, session);
    let threads =
        Threads::start(store, encoder, options.quickstart, app.state.setup.folders.reports.clone(), options.encoders);
    let outcome = event_loop(&mut display, &mut app, &threads, &mut keeper);
    drop(display);
    keeper.keep(&app);
    threads.finish();
    Ok(outcome?)
}

/// Folders for new studies and reports, beside the study that comes with the program.
fn folders(options: &Options) -> Folders {
    let home = options.quickstart.parent().and_then(Path::parent).unwrap_or(Path::new(""));
    Folders { studies: home.join("studies"), reports: home.join("reports") }
}

fn event_loop(display: &mut Display, app: &mut App, threads: &Threads, keeper: &mut Keeper) -> io::Result<Left> {
    let mut silence = None;
    let mut fading = Fading::default();
    threads.read(app.state.focus.clone());
    terminal::take_mouse(app.state.terminal.has_mouse)?;
    display.show(|frame| frame::draw(frame, app))?;
    loop {
        fading.follow(app.state.told.notice.as_ref(), Instant::now());
        let due = [display.pause(), fading.left(Instant::now()), keeper.left()].into_iter().flatten().min();
        let message = match due.filter(|_| !app.state.terminal.detached) {
            None => threads.messages.recv(),
            Some(due) => match threads.messages.recv_timeout(due) {
                Err(RecvTimeoutError::Timeout) if fading.is_over(Instant::now()) => Ok(Message::Faded),
                Err(RecvTimeoutError::Timeout) => {
                    keeper.keep_in_time(app);
                    // A lost terminal is noticed at the next message.
                    let _ = display.go_on(|frame| frame::draw(frame, app));
                    continue;
                }
                Err(RecvTimeoutError::Disconnected) => Err(RecvError),
                Ok(message) => Ok(message),
            },
        };
        let Ok(message) = message else { return Ok(Left::Nothing) };
        // Handles all waiting messages before the next frame, so that a flood of keys or progress costs one frame.
        let mut waiting: VecDeque<Message> = std::iter::once(message).chain(threads.messages.try_iter()).collect();
        while let Some(message) = waiting.pop_front() {
            if matches!(message, Message::Key(_) | Message::Mouse(_)) {
                display.key_pressed();
                keeper.touch();
            }
            if cfg!(debug_assertions) && matches!(message, Message::Key(_)) && std::env::var_os("TOILE_BREAK").is_some()
            {
                panic!("a key was pressed and TOILE_BREAK is set");
            }
            for effect in app.update(message) {
                match effect {
                    Effect::Quit => return Ok(Left::Nothing),
                    Effect::LeaveRunning(target) => return Ok(Left::Run(threads.path_of(target))),
                    effect => waiting.extend(carry_out(effect, display, app, threads, keeper)?),
                }
            }
        }
        keeper.keep_in_time(app);
        if !app.state.terminal.detached
            && let Err(error) = display.show(|frame| frame::draw(frame, app))
            && app.update(Message::Hangup).contains(&Effect::Quit)
        {
            return Err(error);
        }
        if app.state.terminal.detached && silence.is_none() {
            silence = Some(terminal::silence_input()?);
        }
    }
}

/// Returns a message about the outcome, if that is known at once.
fn carry_out(
    effect: Effect,
    display: &mut Display,
    app: &App,
    threads: &Threads,
    keeper: &Keeper,
) -> io::Result<Option<Message>> {
    let has_mouse = app.state.terminal.has_mouse;
    match effect {
        Effect::Copy(text) => {
            let env = |name: &str| std::env::var(name).ok();
            let file = keeper.folder().map(|folder| folder.join("copied.txt"));
            return Ok(Some(Message::Copied(clipboard::copy(&text, &env, &mut io::stdout(), file.as_deref()))));
        }
        Effect::Notify(text) => print_raw(&notification(&text))?,
        Effect::Clear => display.clear()?,
        Effect::Suspend => {
            threads.keyboard.lend(|| display.lend(terminal::stop))?;
            terminal::take_mouse(has_mouse)?;
        }
        Effect::Write(what) => {
            let text = threads.keyboard.lend(|| display.lend(|| terminal::editor::edit(&what)))?;
            terminal::take_mouse(has_mouse)?;
            return Ok(Some(Message::Written(Box::new(what), text)));
        }
        Effect::Mouse(is_taken) => terminal::take_mouse(is_taken)?,
        other => threads.carry_out(other),
    }
    Ok(None)
}

fn print_raw(sequence: &str) -> io::Result<()> {
    let mut out = io::stdout();
    out.write_all(sequence.as_bytes())?;
    out.flush()
}
