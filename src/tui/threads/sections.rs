//! The thread that cuts body and cloth of results, which screens never read.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};

use crate::messages::message::Message;
use results::{CutAt, cross_section};
use store::JobId;
use wardrobe::catalogue;

/// Cuts requested results at all levels, skipping all requests but the latest, until nobody requests or listens any
/// more.
pub fn serve(database: &Path, readonly: bool, wanted: &Receiver<Vec<JobId>>, sender: &Sender<Message>) {
    let store = catalogue::open(database, readonly).map_err(|error| error.to_string());
    while let Ok(first) = wanted.recv() {
        let jobs = wanted.try_iter().last().unwrap_or(first);
        let store = store.as_ref().map_err(Clone::clone);
        let cut = store
            .and_then(|store| cross_section::sections(store, &jobs, &CutAt::Levels).map_err(|error| error.to_string()));
        if sender.send(Message::Cut(jobs, cut)).is_err() {
            return;
        }
    }
}
