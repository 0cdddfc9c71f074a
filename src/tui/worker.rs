//! The threads behind the screens: keys, signals, the database, pictures and runs, each on its own, all answering with
//! messages. None of them is waited for while the workbench is used.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crossterm::event::{self, Event};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::feed::{self, Focus};
use super::message::{Act, Effect, Message, Target};
use super::painter;
use super::picture::{Canvas, Shot};
use super::tailor::{self, Task};
use crate::study::tools::write_seams;
use crate::study::{Deed, Mode, Part, RunOptions, Saved, StudyError, StyleGiven, Workspace};

/// Time between two looks at whether the database has changed; a look costs microseconds.
const LOOK: Duration = Duration::from_millis(250);
/// Time between two looks at whether a run has ended or is to stop.
const RUN_LOOK: Duration = Duration::from_millis(100);

/// What the thread of the database is asked for.
enum Request {
    Read(Focus),
    Do(Act),
}

/// The threads, and what they say.
pub struct Workers {
    /// What they say.
    pub messages: Receiver<Message>,
    sender: Sender<Message>,
    requests: Sender<Request>,
    shots: Sender<Shot>,
    tasks: Sender<Task>,
    database: PathBuf,
    quickstart: Option<PathBuf>,
    stop: Arc<AtomicBool>,
    run: Mutex<Option<JoinHandle<()>>>,
}

impl Workers {
    /// Starts all threads but that of runs.
    #[must_use]
    pub fn start(workspace: Workspace, canvas: Option<Canvas>, quickstart: Option<PathBuf>) -> Self {
        let (sender, messages) = mpsc::channel();
        let (requests, asked) = mpsc::channel();
        let (shots, wanted) = mpsc::channel();
        let (tasks, work) = mpsc::channel();
        let (database, workspace_is_readonly) = (workspace.path().to_owned(), workspace.is_readonly());
        spawn(&sender, read_keys);
        spawn(&sender, watch_signals);
        spawn(&sender, move |sender| serve_database(workspace, &asked, sender));
        let (path, readonly) = (database.clone(), workspace_is_readonly);
        spawn(&sender, move |sender| painter::serve(&path, readonly, canvas.as_ref(), &wanted, sender));
        let (path, readonly) = (database.clone(), workspace_is_readonly);
        spawn(&sender, move |sender| tailor::serve(&path, readonly, &work, sender));
        let stop = Arc::new(AtomicBool::new(false));
        Self { messages, sender, requests, shots, tasks, database, quickstart, stop, run: Mutex::new(None) }
    }

    /// Has the database read.
    pub fn read(&self, focus: Focus) {
        self.carry_out(Effect::Read(focus));
    }

    /// Hands an effect to the thread it concerns; a thread that has ended has said why.
    pub fn carry_out(&self, effect: Effect) {
        match effect {
            Effect::Read(focus) => drop(self.requests.send(Request::Read(focus))),
            Effect::Do(act) => drop(self.requests.send(Request::Do(act))),
            Effect::Desk(task) => drop(self.tasks.send(task)),
            Effect::Paint(shot) => drop(self.shots.send(shot)),
            Effect::Run(target) => self.start_run(target),
            Effect::StopRun => self.stop.store(true, Ordering::Relaxed),
            Effect::Copy(_) | Effect::Clear | Effect::Quit => {}
        }
    }

    fn start_run(&self, target: Target) {
        let path = match target {
            Target::Study(path) => path,
            Target::Quickstart => self.quickstart.clone().unwrap_or_default(),
        };
        self.stop.store(false, Ordering::Relaxed);
        let (database, stop) = (self.database.clone(), self.stop.clone());
        let handle = spawn(&self.sender, move |sender| {
            let outcome = follow_run(&database, &path, &stop);
            let _ = sender.send(Message::RunEnded(outcome.map_err(|error| error.to_string())));
        });
        *self.run.lock().unwrap_or_else(PoisonError::into_inner) = handle;
    }

    /// Stops a run that still goes on and waits until its jobs are back in the queue.
    pub fn finish(self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(run) = self.run.into_inner().unwrap_or_else(PoisonError::into_inner) {
            // A panic of the run was reported when it happened.
            let _ = run.join();
        }
    }
}

/// Starts a thread with a way to answer; says so where the system refuses one.
fn spawn(sender: &Sender<Message>, work: impl FnOnce(&Sender<Message>) + Send + 'static) -> Option<JoinHandle<()>> {
    let own = sender.clone();
    let handle = thread::Builder::new().name("toile-tui".into()).spawn(move || work(&own));
    handle.map_err(|error| sender.send(Message::Failed(format!("no thread could be started: {error}")))).ok()
}

fn read_keys(sender: &Sender<Message>) {
    loop {
        let message = match event::read() {
            Ok(Event::Key(key)) => Message::Key(key),
            Ok(Event::Resize(width, height)) => Message::Resize(width, height),
            Ok(_) => continue,
            Err(_) => Message::Hangup,
        };
        let is_last = matches!(message, Message::Hangup);
        if sender.send(message).is_err() || is_last {
            return;
        }
    }
}

fn watch_signals(sender: &Sender<Message>) {
    let mut signals = match Signals::new([SIGTERM, SIGHUP, SIGINT]) {
        Ok(signals) => signals,
        Err(error) => return drop(sender.send(Message::Failed(format!("signals: {error}")))),
    };
    for signal in signals.forever() {
        let message = if signal == SIGHUP { Message::Hangup } else { Message::Terminate };
        if sender.send(message).is_err() {
            return;
        }
    }
}

/// Reads what the screens show when asked to and whenever the database has changed, and acts on the queue.
fn serve_database(mut workspace: Workspace, asked: &Receiver<Request>, sender: &Sender<Message>) {
    let mut focus = Focus::default();
    let mut seen = None;
    loop {
        let is_wanted = match asked.recv_timeout(LOOK) {
            Ok(Request::Read(wanted)) => {
                focus = wanted;
                true
            }
            Ok(Request::Do(act)) => {
                let done = do_act(&mut workspace, &act).map_err(|error| error.to_string());
                let message = match (act, done) {
                    (Act::SaveSeams(style, seams), done) => Message::SeamsSaved(style, seams, done),
                    (act, done) if act.is_filled_in() => Message::Saved(done),
                    (_, Ok(text)) => Message::Acted(text),
                    (_, Err(text)) => Message::Failed(text),
                };
                if sender.send(message).is_err() {
                    return;
                }
                true
            }
            Err(RecvTimeoutError::Timeout) => false,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        let message = match workspace.version() {
            Ok(version) if !is_wanted && seen == Some(version) => continue,
            Ok(version) => {
                seen = Some(version);
                feed::snapshot(&workspace, &focus).map(|data| Message::Data(Box::new(data)))
            }
            Err(error) => Err(error),
        };
        if sender.send(message.unwrap_or_else(|error| Message::Failed(error.to_string()))).is_err() {
            return;
        }
    }
}

/// Acts on the queue or the catalogue; says what was done.
pub(super) fn do_act(workspace: &mut Workspace, act: &Act) -> Result<String, StudyError> {
    match act {
        Act::SaveSubject(mode, name, given) => {
            let saved = workspace.save_subject(*mode, name, given)?;
            Ok(format!("{saved}{}", saved.doubts.iter().map(|doubt| format!("; {doubt}")).collect::<String>()))
        }
        Act::ImportSubjects(path) => {
            let saved = workspace.import(Part::Subject, std::slice::from_ref(path))?;
            let count = |deed: Deed| saved.iter().filter(|saved| saved.deed == deed).count();
            let changed = count(Deed::Revised) + count(Deed::Restored);
            let doubts = saved.iter().filter(|saved| !saved.doubts.is_empty()).count();
            let doubts = if doubts > 0 { format!("; {doubts} with doubtful values (!)") } else { String::new() };
            Ok(format!(
                "{} subjects: {} added, {changed} changed, {} as before{doubts}",
                saved.len(),
                count(Deed::Added),
                count(Deed::Unchanged)
            ))
        }
        Act::RemoveSubject(name) => Ok(workspace.remove(Part::Subject, name)?.to_string()),
        Act::ImportStyle(name, given) => import_style(workspace, name, given),
        Act::RemoveStyle(part, name) => Ok(workspace.remove(*part, name)?.to_string()),
        Act::SaveSeams(style, seams) => Ok(said(&workspace.save_seams(style, seams)?)),
        Act::WriteSeams(path, before, after) => {
            write_seams(path, before, after)?;
            Ok(format!("{} is written", path.display()))
        }
        Act::Cancel(id) => match workspace.cancel(&[*id])? {
            0 => Ok(format!("job {id} had ended already")),
            _ => Ok(format!("job {id} is cancelled; r queues it again")),
        },
        Act::Retry(id) => match workspace.retry(&[*id])? {
            0 => Ok(format!("job {id} is not run again")),
            _ => Ok(format!("job {id} is queued again")),
        },
        Act::Prioritise(id, priority) => {
            workspace.set_priority(&[*id], *priority)?;
            Ok(format!("job {id} has priority {priority}"))
        }
        Act::Pause(study) => {
            workspace.pause(study)?;
            Ok(format!("{study} is paused: no new jobs start, running ones go on"))
        }
        Act::Resume(study) => {
            workspace.resume(study)?;
            Ok(format!("{study} goes on"))
        }
    }
}

/// Adds the styles of a study file; or a style, whose seams are proposed where none are given; or sizes to one.
fn import_style(workspace: &mut Workspace, name: &str, given: &StyleGiven) -> Result<String, StudyError> {
    if let [(_, path)] = given.patterns.as_slice()
        && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
    {
        return Ok(said(&workspace.import(Part::Style, std::slice::from_ref(path))?));
    }
    let is_known = workspace.sizes()?.iter().any(|row| row.style == name);
    let saved = workspace.save_style(if is_known { Mode::Edit } else { Mode::Add }, name, given)?;
    let unsure = workspace.sizes()?.iter().find(|row| row.style == name).map_or(0, |row| row.unconfirmed);
    let proposed = if unsure > 0 { format!("; {unsure} seams are proposed: confirm them") } else { String::new() };
    Ok(said(&saved) + &proposed)
}

/// What was saved, in a line.
fn said(saved: &[Saved]) -> String {
    match saved {
        [first, _, _, _, ..] => format!("{first}, and {} more", saved.len() - 1),
        _ => saved.iter().map(Saved::to_string).collect::<Vec<_>>().join(", "),
    }
}

/// Starts a run and waits for its end or for the order to stop it; says how it ended.
fn follow_run(database: &Path, study: &Path, stop: &AtomicBool) -> Result<String, StudyError> {
    let mut workspace = Workspace::open(database, false)?;
    let study = workspace.load_study(study)?;
    let run = workspace.start(&study, &RunOptions::default())?;
    while !run.is_finished() {
        if stop.load(Ordering::Relaxed) {
            run.stop();
            break;
        }
        thread::sleep(RUN_LOOK);
    }
    let is_stopped = stop.load(Ordering::Relaxed);
    run.join()?;
    let end = if is_stopped { "is stopped" } else { "has ended" };
    Ok(format!("the run of {} {end}", study.name))
}
