//! Reports in a folder, for a screen that lists and builds them.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use crate::reporting::{self, Tell};
use store::{Result, Store, files};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReportRow {
    /// Name of the report's folder: that of its study, unless it was built elsewhere.
    pub name: String,
    pub page: PathBuf,
    pub bytes: u64,
    /// Since 1970 (UTC).
    pub written_ms: i64,
    /// Number of files beside the page, those in folders included.
    pub files: usize,
}

/// Reports in the subfolders of a folder, by name; empty where the folder cannot be read.
pub fn reports(folder: &Path) -> Vec<ReportRow> {
    let folders = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut found: Vec<ReportRow> = folders.filter_map(|folder| report(&folder)).collect();
    found.sort_by(|a, b| a.name.cmp(&b.name));
    found
}

fn report(folder: &Path) -> Option<ReportRow> {
    let page = folder.join("index.html");
    let facts = fs::metadata(&page).ok()?;
    let age = facts.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    Some(ReportRow {
        name: folder.file_name()?.to_string_lossy().into_owned(),
        page,
        bytes: facts.len(),
        written_ms: age.as_millis() as i64,
        files: count(folder).saturating_sub(1),
    })
}

fn count(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| if entry.path().is_dir() { count(&entry.path()) } else { 1 }).sum()
}

/// Builds the report in a folder of its own below `folder`. Returns the path of its page.
pub fn build_report(store: &Store, study: &str, folder: &Path, tell: Tell<'_>) -> Result<PathBuf> {
    let folder = folder.join(files::study_folder(study));
    files::write_files(&folder, &reporting::report(store, study, None, tell)?)?;
    Ok(folder.join("index.html"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_with_a_page_are_reports() {
        let folder = tempfile::tempdir().expect("a folder");
        for file in ["b/index.html", "b/charts/x.svg", "b/chi.csv", "a/index.html", "c/notes.txt"] {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
            fs::write(path, "x").expect("writable");
        }
        let found = reports(folder.path());
        assert_eq!(found.iter().map(|row| (row.name.as_str(), row.files)).collect::<Vec<_>>(), [("a", 0), ("b", 2)]);
        assert!(found[0].written_ms > 1_600_000_000_000 && found[0].bytes == 1);
        assert!(reports(&folder.path().join("none")).is_empty());
    }
}
