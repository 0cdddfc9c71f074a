//! The thread that lays out pieces and edits seam files. It reads the patterns, which screens never do.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};

use crate::messages::message::Message;
use crate::messages::seams::{LayoutRequest, SeamTask, SizeLayout};
use store::files::SourceFile;
use store::{Store, StudyError};
use wardrobe::catalogue;
use wardrobe::seams::{SeamStep, Workpiece, seam_home};

/// Answers requests until nobody requests or listens any more. Of sizes to lay out, only the latest counts.
pub fn serve(database: &Path, readonly: bool, wanted: &Receiver<SeamTask>, sender: &Sender<Message>) {
    let store = catalogue::open(database, readonly).map_err(|error| error.to_string());
    while let Ok(task) = wanted.recv() {
        let tasks: Vec<SeamTask> = std::iter::once(task).chain(wanted.try_iter()).collect();
        let last = tasks.iter().rposition(|task| matches!(task, SeamTask::LayOut(_)));
        for (k, task) in tasks.into_iter().enumerate() {
            let store = store.as_ref().map_err(Clone::clone);
            let message = match task {
                SeamTask::LayOut(_) if Some(k) != last => continue,
                SeamTask::LayOut(request) => {
                    let layout = store.and_then(|it| lay_out(it, &request).map_err(|error| error.to_string()));
                    Message::LaidOut(Box::new(request), layout.map(Box::new))
                }
                SeamTask::Sew(work) => {
                    let seams = store.and_then(|it| sew(it, &work.size, &work.step).map_err(|error| error.to_string()));
                    Message::Sewn(Box::new(work), seams)
                }
            };
            if sender.send(message).is_err() {
                return;
            }
        }
    }
}

fn workpiece(store: &Store, request: &LayoutRequest) -> Result<(Workpiece, Option<SourceFile>), StudyError> {
    let stored = catalogue::workpiece(store, request.key)?;
    let seams = request.seams.clone().or(stored.seams.clone());
    Ok((Workpiece { seams, ..stored.clone() }, stored.seams))
}

pub fn lay_out(store: &Store, request: &LayoutRequest) -> Result<SizeLayout, StudyError> {
    let (piece, stored) = workpiece(store, request)?;
    let study = request.study.as_deref();
    let home = study.zip(stored.as_ref()).and_then(|(study, stored)| seam_home(study, &request.style, stored));
    Ok(SizeLayout { out: piece.laid_out()?, stored, home })
}

pub fn sew(store: &Store, request: &LayoutRequest, step: &SeamStep) -> Result<SourceFile, StudyError> {
    workpiece(store, request)?.0.after(step)
}
