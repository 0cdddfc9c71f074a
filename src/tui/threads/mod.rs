//! The threads behind the screens: keys, signals, the database, pictures and runs, each on its own, all answering with
//! messages. None of them is waited for while the workbench is used.

pub mod database;
mod files;
mod input;
mod pictures;
pub mod queries;
pub mod reading;
mod run;
mod seams;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread;
use std::thread::JoinHandle;

use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::requests::{Errand, Question, Target};
use crate::messages::seams::Task;
use crate::messages::snapshot::Focus;
use crate::threads::database::Request;
use crate::threads::queries::Brake;
use crate::widgets::picture::{Canvas, Shot};
use study::{Live, Workspace};

/// The threads, and what they say.
pub struct Threads {
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

impl Threads {
    /// Starts all threads but that of runs.
    #[must_use]
    pub fn start(workspace: Workspace, canvas: Option<Canvas>, quickstart: Option<PathBuf>, reports: PathBuf) -> Self {
        let (sender, messages) = mpsc::channel();
        let (requests, asked) = mpsc::channel();
        let (shots, wanted) = mpsc::channel();
        let (tasks, work) = mpsc::channel();
        let (database, workspace_is_readonly) = (workspace.path().to_owned(), workspace.is_readonly());
        spawn(&sender, input::read_keys);
        spawn(&sender, input::watch_signals);
        spawn(&sender, move |sender| database::serve(workspace, &asked, sender));
        let (path, readonly) = (database.clone(), workspace_is_readonly);
        spawn(&sender, move |sender| pictures::serve(&path, readonly, canvas.as_ref(), &wanted, sender));
        let (path, readonly) = (database.clone(), workspace_is_readonly);
        spawn(&sender, move |sender| seams::serve(&path, readonly, &work, sender));
        let (questions, to_ask) = mpsc::channel();
        let brake = Brake::default();
        let (path, own_brake) = (database.clone(), brake.clone());
        spawn(&sender, move |sender| queries::serve(&path, &own_brake, &to_ask, sender));
        let (errands, to_run) = mpsc::channel();
        let (path, readonly) = (database.clone(), workspace_is_readonly);
        spawn(&sender, move |sender| files::serve(&path, readonly, &reports, &to_run, sender));
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
            let outcome = run::follow_run(&database, &path, &stop, &live, sender);
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
