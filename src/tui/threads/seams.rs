//! The thread that works on seams: lays pieces out, changes seam files. Patterns are read there, never by the screens.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};

use crate::messages::message::Message;
use crate::messages::seams::{Laid, Laying, Task};
use study::files::SourceFile;
use study::seams::{SeamStep, Workpiece, seam_home};
use study::{StudyError, Workspace};

/// Does what is asked until nobody asks or listens any more; of sizes to lay out, the latest only.
pub fn serve(database: &Path, readonly: bool, wanted: &Receiver<Task>, sender: &Sender<Message>) {
    let workspace = Workspace::open(database, readonly).map_err(|error| error.to_string());
    while let Ok(task) = wanted.recv() {
        let tasks: Vec<Task> = std::iter::once(task).chain(wanted.try_iter()).collect();
        let last = tasks.iter().rposition(|task| matches!(task, Task::LayOut(_)));
        for (k, task) in tasks.into_iter().enumerate() {
            let workspace = workspace.as_ref().map_err(Clone::clone);
            let message = match task {
                Task::LayOut(_) if Some(k) != last => continue,
                Task::LayOut(laying) => {
                    let laid = workspace.and_then(|it| lay_out(it, &laying).map_err(|error| error.to_string()));
                    Message::LaidOut(Box::new(laying), laid.map(Box::new))
                }
                Task::Sew(laying, step) => {
                    let seams = workspace.and_then(|it| sew(it, &laying, &step).map_err(|error| error.to_string()));
                    Message::Sewn(laying.style, seams)
                }
            };
            if sender.send(message).is_err() {
                return;
            }
        }
    }
}

/// The workpiece of a size, and its seam file as stored.
fn workpiece(workspace: &Workspace, laying: &Laying) -> Result<(Workpiece, Option<SourceFile>), StudyError> {
    let stored = workspace.workpiece(laying.key)?;
    let seams = laying.seams.clone().or(stored.seams.clone());
    Ok((Workpiece { seams, ..stored.clone() }, stored.seams))
}

pub fn lay_out(workspace: &Workspace, laying: &Laying) -> Result<Laid, StudyError> {
    let (piece, stored) = workpiece(workspace, laying)?;
    let study = laying.study.as_deref();
    let home = study.zip(stored.as_ref()).and_then(|(study, stored)| seam_home(study, &laying.style, stored));
    Ok(Laid { out: piece.laid_out()?, stored, home })
}

pub fn sew(workspace: &Workspace, laying: &Laying, step: &SeamStep) -> Result<SourceFile, StudyError> {
    workpiece(workspace, laying)?.0.after(step)
}
