//! The threads behind the screens: keys, signals, the database, pictures and runs, each on its own, all answering with
//! messages. None of them is waited for while the workbench is used.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crossterm::event::{self, Event};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::asker::{self, Brake, Question};
use super::clerk::{self, Errand};
use super::feed::{self, Focus, Snapshot};
use super::message::{Act, Effect, Message, Target};
use super::painter;
use super::picture::{Canvas, Shot};
use super::tailor::{self, Task};
use study::seams::write_seams;
use study::{Deed, Live, Mode, Part, RunOptions, Saved, StudyError, StyleGiven, Workspace};

/// Time between two looks at whether the database has changed; a look costs microseconds.
const LOOK: Duration = Duration::from_millis(250);
/// Time between two looks at whether a run has ended or is to stop, and at the garment that is watched.
const RUN_LOOK: Duration = Duration::from_millis(200);

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
    shots: Sender<Vec<Shot>>,
    tasks: Sender<Task>,
    questions: Sender<Question>,
    brake: Brake,
    errands: Sender<Errand>,
    live: Arc<Live>,
    database: PathBuf,
    quickstart: Option<PathBuf>,
    stop: Arc<AtomicBool>,
    run: Mutex<Option<JoinHandle<()>>>,
}

impl Workers {
    /// Starts all threads but that of runs.
    #[must_use]
    pub fn start(workspace: Workspace, canvas: Option<Canvas>, quickstart: Option<PathBuf>, reports: PathBuf) -> Self {
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
        let (questions, to_ask) = mpsc::channel();
        let brake = Brake::default();
        let (path, own_brake) = (database.clone(), brake.clone());
        spawn(&sender, move |sender| asker::serve(&path, &own_brake, &to_ask, sender));
        let (errands, to_run) = mpsc::channel();
        let (path, readonly) = (database.clone(), workspace_is_readonly);
        spawn(&sender, move |sender| clerk::serve(&path, readonly, &reports, &to_run, sender));
        let stop = Arc::new(AtomicBool::new(false));
        let (live, run) = (Arc::default(), Mutex::new(None));
        Self {
            messages,
            sender,
            requests,
            shots,
            tasks,
            questions,
            brake,
            errands,
            live,
            database,
            quickstart,
            stop,
            run,
        }
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
            Effect::Paint(shots) => drop(self.shots.send(shots)),
            Effect::Ask(question) => {
                self.brake.release();
                drop(self.questions.send(question));
            }
            Effect::StopAsking => self.brake.pull(),
            Effect::Errand(errand) => drop(self.errands.send(errand)),
            Effect::Watch(job) => self.live.watch(job),
            Effect::Run(target) => self.start_run(target),
            Effect::StopRun => self.stop.store(true, Ordering::Relaxed),
            Effect::Copy(_) | Effect::Clear | Effect::Mouse(_) | Effect::Quit => {}
        }
    }

    fn start_run(&self, target: Target) {
        let path = match target {
            Target::Study(path) => path,
            Target::Quickstart => self.quickstart.clone().unwrap_or_default(),
        };
        self.stop.store(false, Ordering::Relaxed);
        let (database, stop, live) = (self.database.clone(), self.stop.clone(), self.live.clone());
        let handle = spawn(&self.sender, move |sender| {
            let outcome = follow_run(&database, &path, &stop, &live, sender);
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
    let guarded = move || {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| work(&own))) {
            let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
            // Nobody listens any more when the workbench is being left.
            let _ = own
                .send(Message::Failed(format!("part of the workbench broke, please leave and start it again: {text}")));
        }
    };
    let handle = thread::Builder::new().name("toile-tui".into()).spawn(guarded);
    handle.map_err(|error| sender.send(Message::Failed(format!("no thread could be started: {error}")))).ok()
}

fn read_keys(sender: &Sender<Message>) {
    loop {
        let message = match event::read() {
            Ok(Event::Key(key)) => Message::Key(key),
            Ok(Event::Resize(width, height)) => Message::Resize(width, height),
            Ok(Event::Mouse(event)) => Message::Mouse(event),
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
fn serve_database(workspace: Workspace, asked: &Receiver<Request>, sender: &Sender<Message>) {
    let mut reader = Reader { workspace, focus: Focus::default(), last: None, rest: LOOK };
    loop {
        let first = match asked.recv_timeout(reader.rest) {
            Ok(request) => Some(request),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        let is_wanted = first.is_some();
        // Of what was looked at meanwhile, only the latest is read.
        for request in first.into_iter().chain(asked.try_iter()) {
            match request {
                Request::Read(wanted) => reader.focus = wanted,
                Request::Do(act) => {
                    if sender.send(reader.do_act(act)).is_err() {
                        return;
                    }
                }
            }
        }
        let message = match reader.read(is_wanted) {
            Ok(None) => continue,
            Ok(Some(data)) => Message::Data(Box::new(data)),
            Err(error) => Message::Failed(error.to_string()),
        };
        if sender.send(message).is_err() {
            return;
        }
    }
}

/// What the thread of the database keeps.
struct Reader {
    workspace: Workspace,
    focus: Focus,
    /// What was read last: of which version of the database, and of which focus.
    last: Option<(i64, Focus, Snapshot)>,
    /// Time to the next look.
    rest: Duration,
}

impl Reader {
    /// Reads what is shown, where it is wanted or anything was written; after a long read the next look comes later.
    fn read(&mut self, is_wanted: bool) -> Result<Option<Snapshot>, StudyError> {
        let version = self.workspace.version()?;
        if !is_wanted && self.last.as_ref().is_some_and(|(of, ..)| *of == version) {
            return Ok(None);
        }
        let known = self.last.take().filter(|(of, ..)| *of == version);
        let start = Instant::now();
        let is_same = |focus: &Focus| (&focus.study, &focus.garment) == (&self.focus.study, &self.focus.garment);
        let data = match known.filter(|(_, focus, _)| is_same(focus)) {
            Some((.., before)) => feed::refocused(&self.workspace, before, &self.focus)?,
            None => feed::snapshot(&self.workspace, &self.focus)?,
        };
        self.rest = LOOK.max(2 * start.elapsed());
        let shown = Focus {
            study: data.study().map(|study| study.name.clone()),
            garment: data.grid.as_ref().map(|grid| grid.garment.clone()),
            ..self.focus.clone()
        };
        self.last = Some((version, shown, data.clone()));
        Ok(Some(data))
    }

    /// Acts, and says what came of it.
    fn do_act(&mut self, act: Act) -> Message {
        let done = do_act(&mut self.workspace, &act).map_err(|error| error.to_string());
        match (act, done) {
            (Act::SaveSeams(style, seams), done) => Message::SeamsSaved(style, seams, done),
            (act, done) if act.is_filled_in() => Message::Saved(done),
            (_, Ok(text)) => Message::Acted(text),
            (_, Err(text)) => Message::Failed(text),
        }
    }
}

/// Acts on the queue or the catalogue; says what was done.
pub(super) fn do_act(workspace: &mut Workspace, act: &Act) -> Result<String, StudyError> {
    match act {
        Act::Save(part, mode, name, given) => {
            let saved = match part {
                Part::Fabric => workspace.save_fabric(*mode, name, None, given)?,
                _ => workspace.save_subject(*mode, name, given)?,
            };
            Ok(format!("{saved}{}", saved.doubts.iter().map(|doubt| format!("; {doubt}")).collect::<String>()))
        }
        Act::Import(part, path) => {
            let saved = workspace.import(*part, std::slice::from_ref(path))?;
            let count = |deed: Deed| saved.iter().filter(|saved| saved.deed == deed).count();
            let changed = count(Deed::Revised) + count(Deed::Restored);
            let doubts = saved.iter().filter(|saved| !saved.doubts.is_empty()).count();
            let doubts = if doubts > 0 { format!("; {doubts} with doubtful values (!)") } else { String::new() };
            Ok(format!(
                "{} {part}s: {} added, {changed} changed, {} as before{doubts}",
                saved.len(),
                count(Deed::Added),
                count(Deed::Unchanged)
            ))
        }
        Act::Remove(part, name) => Ok(workspace.remove(*part, name)?.to_string()),
        Act::ImportStyle(name, given) => import_style(workspace, name, given),
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
fn follow_run(
    database: &Path,
    study: &Path,
    stop: &AtomicBool,
    live: &Arc<Live>,
    sender: &Sender<Message>,
) -> Result<String, StudyError> {
    let mut workspace = Workspace::open(database, false)?;
    let study = workspace.load_study(study)?;
    let run = workspace.start(&study, &RunOptions { live: live.clone(), ..RunOptions::default() })?;
    while !run.is_finished() {
        if stop.load(Ordering::Relaxed) {
            run.stop();
            break;
        }
        if let Some(frame) = live.take() {
            // Nobody listens any more when the terminal is gone; the run goes on.
            let _ = sender.send(Message::Live(frame));
        }
        thread::sleep(RUN_LOOK);
    }
    let is_stopped = stop.load(Ordering::Relaxed);
    run.join()?;
    let end = if is_stopped { "is stopped" } else { "has ended" };
    Ok(format!("the run of {} {end}", study.name))
}
