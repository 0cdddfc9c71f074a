//! The thread that begins rounds of fitting, whose proposals may take seconds.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};

use crate::messages::comments::{FittingOf, RoundRequest};
use crate::messages::message::Message;
use advice::comments::fitted;
use engine::run;
use results::assessment;
use store::comments::{Fitting, begin_round};
use store::{Store, StudyError};
use wardrobe::catalogue;

pub fn serve(database: &Path, wanted: &Receiver<RoundRequest>, sender: &Sender<Message>) {
    while let Ok(request) = wanted.recv() {
        let FittingOf { garment, subject, .. } = &request.of;
        let text = format!("{garment} on {subject}: what was measured is looked through…");
        if sender.send(Message::Done(text)).is_err() {
            return;
        }
        let told = catalogue::open(database, false).and_then(|mut store| begin(&mut store, &request));
        let message = told.map_or_else(|error| Message::Failed(error.to_string()), Message::Done);
        if sender.send(message).is_err() {
            return;
        }
    }
}

/// Begins the next round of a fitting, with the study file as it is now. Returns a line about it.
pub fn begin(store: &mut Store, request: &RoundRequest) -> Result<String, StudyError> {
    let FittingOf { study: name, garment, subject } = &request.of;
    let study = run::load_study(store, &request.study)?;
    run::update_ease(store, &study)?;
    let worn = assessment::worn(store, name, Some(garment), Some(subject))?;
    let Some(worn) = worn.first() else { return Ok(format!("{garment} on {subject}: no ease is known")) };
    let Some(fitted) = fitted(&study, worn)? else {
        return Ok(format!("{garment} on {subject}: {}", worn.card.verdict()));
    };
    let of = Fitting { study: name, garment, subject };
    let untold = fitted.untold.map_or_else(String::new, |reason| format!("; no action is proposed: {reason}"));
    Ok(match begin_round(store, of, &fitted.size, &fitted.basis, &fitted.found)? {
        Some(round) => format!("{garment} on {subject}: round {round}, size {}{untold}", fitted.size),
        None => format!("{garment} on {subject}: nothing has changed since the last round"),
    })
}
