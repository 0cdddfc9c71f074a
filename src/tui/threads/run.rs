//! The thread that follows a run.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::thread;
use std::time::Duration;

use crate::messages::message::Message;
use engine::{RunOptions, run};
use store::{Live, StudyError};
use wardrobe::catalogue;

/// Time between two looks at whether a run has ended or is to stop, and at the garment that is watched.
const POLL: Duration = Duration::from_millis(200);

/// Starts a run and waits for its end or for the order to stop it; says how it ended.
pub fn follow(
    database: &Path,
    study: &Path,
    stop: &AtomicBool,
    live: &Arc<Live>,
    sender: &Sender<Message>,
) -> Result<String, StudyError> {
    let mut store = catalogue::open(database, false)?;
    let study = run::load_study(&store, study)?;
    let run = run::start(&mut store, &study, &RunOptions { live: live.clone(), ..RunOptions::default() })?;
    while !run.is_finished() {
        if stop.load(Ordering::Relaxed) {
            run.stop();
            break;
        }
        if let Some(frame) = live.take() {
            // Nobody listens any more when the terminal is gone; the run goes on.
            let _ = sender.send(Message::Live(frame));
        }
        thread::sleep(POLL);
    }
    let is_stopped = stop.load(Ordering::Relaxed);
    run.join()?;
    let end = if is_stopped { "is stopped" } else { "has ended" };
    Ok(format!("the run of {} {end}", study.name))
}
