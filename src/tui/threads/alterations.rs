//! The threads that find what to change of a pattern: one for the flat pattern, one that drapes and may take minutes.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};

use crate::messages::alterations::AlterRequest;
use crate::messages::message::Message;
use advice::{Alteration, Wish, alter};
use engine::run;
use store::{Store, StudyError};
use wardrobe::catalogue;

/// Finds the changes asked for, that of the latest request only, until nobody asks or listens any more. Nothing is written.
pub fn serve(database: &Path, wanted: &Receiver<AlterRequest>, sender: &Sender<Message>) {
    while let Ok(first) = wanted.recv() {
        let request = wanted.try_iter().last().unwrap_or(first);
        let found = catalogue::open(database, true).and_then(|store| alteration(&store, &request));
        let found = found.map(Box::new).map_err(|error| error.to_string());
        if sender.send(Message::Altered(Box::new(request), found)).is_err() {
            return;
        }
    }
}

/// The change of a size, as the study's file has it now.
pub fn alteration(store: &Store, request: &AlterRequest) -> Result<Alteration, StudyError> {
    let study = run::load_study(store, &request.study)?;
    let wish = Wish::of(&request.garment, &request.subject, &request.size);
    alter(&study, &Wish { is_draped: request.is_draped, ..wish })
}
