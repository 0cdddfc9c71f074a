//! The thread that draws pictures of drapes and bodies. The latest body is kept ready.

use std::path::Path;
use std::sync::PoisonError;
use std::sync::mpsc::{Receiver, SendError, Sender};

use image::RgbaImage;

use crate::messages::message::Message;
use crate::threads::previews::Slot;
use crate::widgets::picture::{PictureEncoder, PictureRequest, Pictured};
use results::picture::Scenes;
use results::{Figure, figure};
use store::{Store, SubjectId};
use wardrobe::catalogue;

/// Draws requested pictures, skipping all requests but the latest, until nobody requests or listens any more. Without
/// an encoder it still measures bodies.
pub fn serve(
    database: &Path,
    readonly: bool,
    encoder: Option<&PictureEncoder>,
    wanted: &Receiver<Vec<PictureRequest>>,
    previews: &Slot,
    sender: &Sender<Message>,
) {
    let store = catalogue::open(database, readonly).map_err(|error| error.to_string());
    let mut renderer = Renderer { store, scenes: Scenes::default(), ready: None, previews, sender };
    while let Ok(first) = wanted.recv() {
        let mut requests = wanted.try_iter().last().unwrap_or(first).into_iter();
        while let Some(request) = requests.next() {
            if renderer.show(&request, encoder).is_err() {
                return;
            }
            // A newer request replaces the rest of this one.
            if let Some(newer) = wanted.try_iter().last() {
                requests = newer.into_iter();
            }
        }
    }
}

struct Renderer<'a> {
    store: Result<Store, String>,
    scenes: Scenes,
    ready: Option<(SubjectId, Result<Figure, String>)>,
    previews: &'a Slot,
    sender: &'a Sender<Message>,
}

impl Renderer<'_> {
    /// Draws a picture and sends it; an error if nobody listens.
    fn show(&mut self, request: &PictureRequest, encoder: Option<&PictureEncoder>) -> Result<(), SendError<Message>> {
        if let Pictured::Body(id) = request.of {
            self.measure(id)?;
        }
        let Some(encoder) = encoder.filter(|_| request.columns > 0 && request.rows > 0) else { return Ok(()) };
        let drawn = self.picture(request, encoder.pixels(request)).and_then(|picture| encoder.draw(&picture, request));
        self.sender.send(Message::Picture(*request, drawn))
    }

    /// Builds a body and sends its measurements, unless it is the latest one.
    fn measure(&mut self, id: SubjectId) -> Result<(), SendError<Message>> {
        if self.ready.as_ref().is_some_and(|(ready, _)| *ready == id) {
            return Ok(());
        }
        let store = self.store.as_ref().map_err(Clone::clone);
        let figure = store.and_then(|store| figure::figure(store, id).map_err(|error| error.to_string()));
        let girths = figure.as_ref().map(|figure| Box::new(figure.girths().clone()));
        let told = Message::Measured(id, girths.map_err(Clone::clone));
        self.ready = Some((id, figure));
        self.sender.send(told)
    }

    fn picture(&mut self, request: &PictureRequest, (width, height): (u32, u32)) -> Result<RgbaImage, String> {
        match (request.of, &self.ready) {
            (Pictured::Drape(job), _) => {
                let store = self.store.as_ref().map_err(Clone::clone)?;
                self.scenes
                    .look(store, job, request.look, [width, height], request.map)
                    .map_err(|error| error.to_string())
            }
            (Pictured::Body(_), Some((_, Ok(figure)))) => {
                figure.picture(width, height).map_err(|error| error.to_string())
            }
            (Pictured::Body(_), Some((_, Err(error)))) => Err(error.clone()),
            (Pictured::Preview(number), _) => {
                let slot = self.previews.lock().unwrap_or_else(PoisonError::into_inner);
                let preview = slot.as_ref().filter(|(shown, _)| *shown == number).map(|(_, preview)| preview);
                let preview = preview.ok_or_else(|| "it is being sewn".to_owned())?;
                preview.picture(request.look, width, height).map_err(|error| error.to_string())
            }
            (Pictured::Body(_), None) => Err("its body is not built yet".to_owned()),
        }
    }
}
