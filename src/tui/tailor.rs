//! The thread that works on seams: lays pieces out, changes seam files. Patterns are read there, never by the screens.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender};

use super::message::Message;
use study::files::SourceFile;
use study::seams::{LaidOut, SeamStep, Workpiece, seam_home};
use study::{SizeKey, StudyError, Workspace};

/// What is wanted on the desk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Laying {
    /// Style.
    pub style: String,
    /// Its revision and the size.
    pub key: SizeKey,
    /// The seam file as edited and not saved; `None` where it is as stored.
    pub seams: Option<SourceFile>,
    /// File of the study that wears the style.
    pub study: Option<PathBuf>,
}

/// What the thread is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Task {
    /// Lay a size out.
    LayOut(Laying),
    /// Do a step of work on its seams.
    Sew(Laying, SeamStep),
}

/// A size on the desk.
#[derive(Clone, Debug, PartialEq)]
pub struct Laid {
    /// Pieces, seams, measurements, questions.
    pub out: LaidOut,
    /// The seam file as stored.
    pub stored: Option<SourceFile>,
    /// Where it lies in the folder of the study, if it says the same there.
    pub home: Option<PathBuf>,
}

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

pub(super) fn lay_out(workspace: &Workspace, laying: &Laying) -> Result<Laid, StudyError> {
    let (piece, stored) = workpiece(workspace, laying)?;
    let study = laying.study.as_deref();
    let home = study.zip(stored.as_ref()).and_then(|(study, stored)| seam_home(study, &laying.style, stored));
    Ok(Laid { out: piece.laid_out()?, stored, home })
}

pub(super) fn sew(workspace: &Workspace, laying: &Laying, step: &SeamStep) -> Result<SourceFile, StudyError> {
    workpiece(workspace, laying)?.0.after(step)
}
