//! The thread for what takes long and writes files: reports, new studies.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender};

use super::message::Message;
use study::{NewStudy, ReportRow, Workspace, reports};

/// What the thread is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Errand {
    /// List the reports there are.
    ListReports,
    /// Build the report of a study.
    BuildReport(String),
    /// Write a new study.
    CreateStudy(NewStudy),
}

/// Does what is asked until nobody asks or listens any more; reports lie in folders below `reports_folder`.
pub fn serve(
    database: &Path,
    readonly: bool,
    reports_folder: &Path,
    wanted: &Receiver<Errand>,
    sender: &Sender<Message>,
) {
    let mut workspace = Workspace::open(database, readonly).map_err(|error| error.to_string());
    while let Ok(errand) = wanted.recv() {
        let workspace = workspace.as_mut().map_err(|error| error.clone());
        let done = match errand {
            Errand::ListReports => Ok(Message::Reports(reports(reports_folder))),
            Errand::BuildReport(study) => {
                let page =
                    workspace.and_then(|it| it.build_report(&study, reports_folder).map_err(|error| error.to_string()));
                Ok(Message::ReportBuilt(page, reports(reports_folder)))
            }
            Errand::CreateStudy(new) => {
                let path = workspace.and_then(|it| it.create_study(&new).map_err(|error| error.to_string()));
                Ok(Message::StudyCreated(new.name, path))
            }
        };
        if sender.send(done.unwrap_or_else(Message::Failed)).is_err() {
            return;
        }
    }
}

/// Where the user is among reports.
#[derive(Debug, Default)]
pub struct Reports {
    /// Those there are; `None` until they were listed.
    pub rows: Option<Vec<ReportRow>>,
    /// The one selected.
    pub row: usize,
    /// The study whose report is being built.
    pub building: Option<String>,
}

/// A page as an address that a browser on this machine opens.
#[must_use]
pub fn address(page: &Path) -> String {
    let page: PathBuf = std::path::absolute(page).unwrap_or_else(|_| page.to_owned());
    format!("file://{}", page.display())
}
