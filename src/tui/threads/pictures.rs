//! The thread that makes pictures: drapes of results, bodies of subjects. The body shown last is kept ready.

use std::path::Path;
use std::sync::mpsc::{Receiver, SendError, Sender};

use image::RgbaImage;

use crate::messages::message::Message;
use crate::widgets::picture::{Canvas, Shot, Sitter};
use study::{Figure, SubjectId, Workspace};

/// Makes the pictures asked for, those of the latest request only, until nobody asks or listens any more. Bodies are
/// measured where there is no canvas, too.
pub fn serve(
    database: &Path,
    readonly: bool,
    canvas: Option<&Canvas>,
    wanted: &Receiver<Vec<Shot>>,
    sender: &Sender<Message>,
) {
    let workspace = Workspace::open(database, readonly).map_err(|error| error.to_string());
    let mut painter = Painter { workspace, ready: None, sender };
    while let Ok(request) = wanted.recv() {
        let mut shots = wanted.try_iter().last().unwrap_or(request).into_iter();
        while let Some(shot) = shots.next() {
            if painter.show(&shot, canvas).is_err() {
                return;
            }
            // A newer request makes what is left of this one needless.
            if let Some(newer) = wanted.try_iter().last() {
                shots = newer.into_iter();
            }
        }
    }
}

struct Painter<'a> {
    workspace: Result<Workspace, String>,
    /// The body shown last, or why there is none.
    ready: Option<(SubjectId, Result<Figure, String>)>,
    sender: &'a Sender<Message>,
}

impl Painter<'_> {
    /// Makes a picture and sends it; an error when nobody listens.
    fn show(&mut self, shot: &Shot, canvas: Option<&Canvas>) -> Result<(), SendError<Message>> {
        if let Sitter::Body(id) = shot.of {
            self.measure(id)?;
        }
        let Some(canvas) = canvas.filter(|_| shot.columns > 0 && shot.rows > 0) else { return Ok(()) };
        let drawn = self.picture(shot, canvas.pixels(shot)).and_then(|picture| canvas.draw(&picture, shot));
        self.sender.send(Message::Picture(*shot, drawn))
    }

    /// Makes a body ready and tells its measurements, unless it was shown last.
    fn measure(&mut self, id: SubjectId) -> Result<(), SendError<Message>> {
        if self.ready.as_ref().is_some_and(|(ready, _)| *ready == id) {
            return Ok(());
        }
        let workspace = self.workspace.as_ref().map_err(Clone::clone);
        let figure = workspace.and_then(|workspace| workspace.figure(id).map_err(|error| error.to_string()));
        let girths = figure.as_ref().map(|figure| Box::new(figure.girths().clone()));
        let told = Message::Measured(id, girths.map_err(Clone::clone));
        self.ready = Some((id, figure));
        self.sender.send(told)
    }

    /// The pixels of a picture.
    fn picture(&self, shot: &Shot, (width, height): (u32, u32)) -> Result<RgbaImage, String> {
        match (shot.of, &self.ready) {
            (Sitter::Drape(job), _) => {
                let workspace = self.workspace.as_ref().map_err(Clone::clone)?;
                workspace.look(job, shot.look, width, height, shot.map).map_err(|error| error.to_string())
            }
            (Sitter::Body(_), Some((_, Ok(figure)))) => {
                figure.picture(width, height).map_err(|error| error.to_string())
            }
            (Sitter::Body(_), Some((_, Err(error)))) => Err(error.clone()),
            (Sitter::Body(_), None) => Err("its body is not built yet".to_owned()),
        }
    }
}
