//! The thread for slow work that writes files: reports, new studies, altered patterns.

use std::path::Path;
use std::sync::mpsc::{Receiver, Sender};

use crate::messages::message::Message;
use crate::messages::requests::FileTask;
use engine::compose;
use results::reporting::Part;
use results::reports;
use store::files::write_files;
use wardrobe::catalogue;

/// Answers requests until nobody requests or listens any more. Reports go into folders below `reports_folder`.
pub fn serve(
    database: &Path,
    readonly: bool,
    reports_folder: &Path,
    wanted: &Receiver<FileTask>,
    sender: &Sender<Message>,
) {
    let mut store = catalogue::open(database, readonly).map_err(|error| error.to_string());
    while let Ok(task) = wanted.recv() {
        let store = store.as_mut().map_err(|error| error.clone());
        let done = match task {
            FileTask::ListReports => Ok(Message::Reports(reports(reports_folder))),
            FileTask::BuildReport(study) => {
                let page = store.and_then(|store| {
                    let tell = |part: Part| {
                        // Without a receiver the thread ends at its next answer.
                        let _ = sender.send(Message::ReportPart(part.to_string()));
                    };
                    reports::build_report(store, &study, reports_folder, &tell).map_err(|error| error.to_string())
                });
                Ok(Message::ReportBuilt(page, reports(reports_folder)))
            }
            FileTask::CreateStudy(new) => {
                let path =
                    store.and_then(|store| compose::create_study(store, &new).map_err(|error| error.to_string()));
                Ok(Message::StudyCreated(new.name, path))
            }
            FileTask::Write(folder, files) => Ok(Message::Saved(write(&folder, &files))),
        };
        if sender.send(done.unwrap_or_else(Message::Failed)).is_err() {
            return;
        }
    }
}

/// Writes files into a folder, refusing to replace any. Returns a line about them.
pub fn write(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<String, String> {
    if let Some((name, _)) = files.iter().find(|(name, _)| folder.join(name).exists()) {
        return Err(format!("{} is there already; accepted: a folder without it", folder.join(name).display()));
    }
    write_files(folder, files).map_err(|error| error.to_string())?;
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    Ok(format!("{} has {}", folder.display(), names.join(", ")))
}
