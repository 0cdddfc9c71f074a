//! The thread that follows a run.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::thread;
use std::time::Duration;

use crate::messages::message::Message;
use engine::{Ending, RunOptions, run};
use store::{Live, StudyError};
use wardrobe::catalogue;

/// Time between two checks of a run: if it has ended, if it must stop, and for the garment that is watched.
const POLL: Duration = Duration::from_millis(200);

/// Starts a run and waits until it ends or must stop. Returns the numbers of its jobs by their states then.
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
            // Fails if the terminal is gone; the run goes on.
            let _ = sender.send(Message::Live(frame));
        }
        thread::sleep(POLL);
    }
    let planned = run.planned.clone();
    run.join()?;
    Ok(Ending::of(&store, &study.name, &planned)?.to_string())
}
