//! The thread for what takes long and writes files: reports, new studies.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};

use crate::messages::message::Message;
use crate::messages::requests::FileTask;
use study::{Workspace, reports};

/// Does what is asked until nobody asks or listens any more; reports lie in folders below `reports_folder`.
pub fn serve(
    database: &Path,
    readonly: bool,
    reports_folder: &Path,
    wanted: &Receiver<FileTask>,
    sender: &Sender<Message>,
) {
    let mut workspace = Workspace::open(database, readonly).map_err(|error| error.to_string());
    while let Ok(task) = wanted.recv() {
        let workspace = workspace.as_mut().map_err(|error| error.clone());
        let done = match task {
            FileTask::ListReports => Ok(Message::Reports(reports(reports_folder))),
            FileTask::BuildReport(study) => {
                let page =
                    workspace.and_then(|it| it.build_report(&study, reports_folder).map_err(|error| error.to_string()));
                Ok(Message::ReportBuilt(page, reports(reports_folder)))
            }
            FileTask::CreateStudy(new) => {
                let path = workspace.and_then(|it| it.create_study(&new).map_err(|error| error.to_string()));
                Ok(Message::StudyCreated(new.name, path))
            }
        };
        if sender.send(done.unwrap_or_else(Message::Failed)).is_err() {
            return;
        }
    }
}
