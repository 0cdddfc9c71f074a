//! The threads behind the screens: keys, signals, database, pictures and runs have one each, and all answer with
//! messages. The workbench never waits for one of them while it is used.

pub mod alterations;
pub mod database;
pub mod files;
pub mod input;
mod pictures;
mod previews;
pub mod queries;
pub mod reading;
pub mod rounds;
mod run;
mod seams;
mod sections;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use crate::messages::alterations::AlterRequest;
use crate::messages::comments::RoundRequest;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::messages::requests::{FileTask, QueryRequest, Target};
use crate::messages::seams::{PreviewRequest, SeamTask};
use crate::messages::snapshot::Focus;
use crate::threads::database::Request;
use crate::threads::input::Keyboard;
use crate::threads::previews::Slot;
use crate::threads::queries::Canceller;
use crate::widgets::picture::{PictureEncoder, PictureRequest};
use store::{Encoder, JobId, Live, Store};

pub struct Threads {
    pub messages: Receiver<Message>,
    pub keyboard: Keyboard,
    sender: Sender<Message>,
    database: Sender<Request>,
    pictures: Sender<Vec<PictureRequest>>,
    sections: Sender<Vec<JobId>>,
    alterations: Sender<AlterRequest>,
    drapes: Sender<AlterRequest>,
    rounds: Sender<RoundRequest>,
    seams: Sender<SeamTask>,
    previews: Sender<PreviewRequest>,
    queries: Sender<QueryRequest>,
    canceller: Canceller,
    files: Sender<FileTask>,
    live: Arc<Live>,
    path: PathBuf,
    quickstart: PathBuf,
    stop: Arc<AtomicBool>,
    run: Mutex<Option<JoinHandle<()>>>,
}

impl Threads {
    /// Starts all threads except that of runs.
    pub fn start(
        store: Store,
        encoder: Option<PictureEncoder>,
        quickstart: PathBuf,
        reports: PathBuf,
        encoders: &'static [Encoder],
    ) -> Self {
        let (sender, messages) = mpsc::channel();
        let (path, readonly) = (store.path().to_owned(), store.is_readonly());
        let canceller = Canceller::default();
        let keyboard = Keyboard::default();
        let own = keyboard.clone();
        spawn(&sender, move |sender| input::read_keys(&own, sender));
        spawn(&sender, input::watch_signals);
        let (slot, cancelled) = (Slot::default(), canceller.clone());
        let shown = slot.clone();
        Self {
            database: serve(&sender, &path, |_, asked, sender| database::serve(store, asked, sender)),
            pictures: serve(&sender, &path, move |path, asked, sender| {
                pictures::serve(path, readonly, encoder.as_ref(), asked, &shown, sender);
            }),
            sections: serve(&sender, &path, move |path, asked, sender| sections::serve(path, readonly, asked, sender)),
            alterations: serve(&sender, &path, alterations::serve),
            drapes: serve(&sender, &path, alterations::serve),
            rounds: serve(&sender, &path, rounds::serve),
            seams: serve(&sender, &path, move |path, asked, sender| seams::serve(path, readonly, asked, sender)),
            previews: serve(&sender, &path, move |path, asked, sender| {
                previews::serve(path, readonly, asked, &slot, sender)
            }),
            queries: serve(&sender, &path, move |path, asked, sender| {
                queries::serve(path, &cancelled, encoders, asked, sender);
            }),
            files: serve(&sender, &path, move |path, asked, sender| {
                files::serve(path, readonly, &reports, asked, sender)
            }),
            messages,
            keyboard,
            sender,
            canceller,
            live: Arc::default(),
            path,
            quickstart,
            stop: Arc::default(),
            run: Mutex::default(),
        }
    }

    pub fn read(&self, focus: Focus) {
        self.carry_out(Effect::Read(focus));
    }

    /// Hands an effect to its thread. A thread that has ended has already said why.
    pub fn carry_out(&self, effect: Effect) {
        match effect {
            Effect::Read(focus) => drop(self.database.send(Request::Read(focus))),
            Effect::Do(command) => drop(self.database.send(Request::Do(command))),
            Effect::Seams(task) => drop(self.seams.send(task)),
            Effect::Preview(request) => drop(self.previews.send(request)),
            Effect::Cut(jobs) => drop(self.sections.send(jobs)),
            Effect::Alter(request) => {
                let thread = if request.is_draped { &self.drapes } else { &self.alterations };
                drop(thread.send(request));
            }
            Effect::Round(request) => drop(self.rounds.send(request)),
            Effect::Draw(requests) => drop(self.pictures.send(requests)),
            Effect::Query(query) => {
                self.canceller.reset();
                drop(self.queries.send(query));
            }
            Effect::StopQuery => self.canceller.cancel(),
            Effect::Files(task) => drop(self.files.send(task)),
            Effect::Watch(job) => self.live.watch(job),
            Effect::Run(target) => self.start_run(target),
            Effect::StopRun => self.stop.store(true, Ordering::Relaxed),
            Effect::Write(_) | Effect::Copy(_) | Effect::Clear | Effect::Mouse(_) | Effect::Quit => {}
            Effect::LeaveRunning(_) | Effect::Notify(_) | Effect::Suspend => {}
        }
    }

    pub fn path_of(&self, target: Target) -> PathBuf {
        match target {
            Target::Study(path) => path,
            Target::Quickstart => self.quickstart.clone(),
        }
    }

    fn start_run(&self, target: Target) {
        let is_quickstart = target == Target::Quickstart;
        let path = self.path_of(target);
        self.stop.store(false, Ordering::Relaxed);
        let (database, stop, live) = (self.path.clone(), self.stop.clone(), self.live.clone());
        let handle = spawn(&self.sender, move |sender| {
            let made = if is_quickstart { spec::write_quickstart(&path) } else { Ok(()) };
            let outcome = made.and_then(|()| run::follow(&database, &path, &stop, &live, sender));
            let _ = sender.send(Message::RunEnded(outcome.map_err(|error| error.to_string())));
        });
        *self.run.lock().unwrap_or_else(PoisonError::into_inner) = handle;
    }

    /// Stops a run that is in progress, and waits until its jobs are back in the queue.
    pub fn finish(self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(run) = self.run.into_inner().unwrap_or_else(PoisonError::into_inner) {
            // A panic of the run was reported already.
            let _ = run.join();
        }
    }
}

/// Starts a thread that opens the database at a path and answers requests. Returns the sender for requests.
fn serve<T: Send + 'static>(
    sender: &Sender<Message>,
    path: &Path,
    work: impl FnOnce(&Path, &Receiver<T>, &Sender<Message>) + Send + 'static,
) -> Sender<T> {
    let (asks, asked) = mpsc::channel();
    let path = path.to_owned();
    spawn(sender, move |sender| work(&path, &asked, sender));
    asks
}

/// Starts a thread that can send messages; reports an error of the system.
fn spawn(sender: &Sender<Message>, work: impl FnOnce(&Sender<Message>) + Send + 'static) -> Option<JoinHandle<()>> {
    let own = sender.clone();
    let guarded = move || {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| work(&own))) {
            let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
            // Fails if the workbench is ending, which is fine.
            let _ = own
                .send(Message::Failed(format!("part of the workbench broke, please leave and start it again: {text}")));
        }
    };
    let handle = thread::Builder::new().name("toile-tui".into()).spawn(guarded);
    handle.map_err(|error| sender.send(Message::Failed(format!("no thread could be started: {error}")))).ok()
}
