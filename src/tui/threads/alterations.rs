//! The threads that find alterations: one for the flat pattern; one that drapes, which may take minutes.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};

use crate::messages::alterations::AlterRequest;
use crate::messages::message::Message;
use advice::{Alteration, Wish, alter};
use engine::run;
use store::{Store, StudyError};
use wardrobe::catalogue;

/// Answers requests, skipping all but the latest, until nobody requests or listens any more. Writes nothing.
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

/// Finds the alteration of a size, with the study file as it is now.
pub fn alteration(store: &Store, request: &AlterRequest) -> Result<Alteration, StudyError> {
    let study = run::load_study(store, &request.study)?;
    let wish = Wish::of(&request.garment, &request.subject, &request.size);
    alter(&study, &Wish { is_draped: request.is_draped, ..wish })
}
