//! Saved queries.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::{FileError, Origin, Result, StudyError};
use crate::files::write_files;

/// Queries that come with the program: name and SQL.
const SAVED: [(&str, &str); 8] = [
    ("against_thesis", include_str!("../../db/queries/against_thesis.sql")),
    ("attention", include_str!("../../db/queries/attention.sql")),
    ("ease_and_error", include_str!("../../db/queries/ease_and_error.sql")),
    ("measurements", include_str!("../../db/queries/measurements.sql")),
    ("preposition", include_str!("../../db/queries/preposition.sql")),
    ("sizes", include_str!("../../db/queries/sizes.sql")),
    ("thesis_table", include_str!("../../db/queries/thesis_table.sql")),
    ("times", include_str!("../../db/queries/times.sql")),
];

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedQuery {
    pub name: String,
    /// Purpose of the query: its first line, where that is a comment.
    pub about: String,
    pub sql: String,
}

/// Saved queries by name: those of the program, and those of the files NAME.sql in a folder. Of two with the same name
/// the folder's counts.
pub fn saved_queries(folder: Option<&Path>) -> Result<Vec<SavedQuery>> {
    let mut found: BTreeMap<String, String> = BTreeMap::new();
    found.extend(SAVED.iter().map(|(name, sql)| ((*name).to_owned(), (*sql).to_owned())));
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
    for path in entries.into_iter().flatten().flatten().map(|entry| entry.path()) {
        if path.extension().is_some_and(|extension| extension == "sql") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            found.insert(name, std::fs::read_to_string(&path).map_err(StudyError::io(&path))?);
        }
    }
    let about = |sql: &str| sql.lines().next().and_then(|line| line.strip_prefix("-- ")).unwrap_or_default().to_owned();
    Ok(found.into_iter().map(|(name, sql)| SavedQuery { about: about(&sql), name, sql }).collect())
}

/// Saves as NAME.sql, replacing a query of that name.
pub fn save_query(folder: &Path, name: &str, sql: &str) -> Result<()> {
    let is_plain = |c: char| c.is_alphanumeric() || "-_ .".contains(c);
    if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
        return Err(StudyError::refused(Origin::Sql, FileError::QueryName { name: name.to_owned() }));
    }
    write_files(folder, &[(format!("{name}.sql"), format!("{}\n", sql.trim_end()).into_bytes())]).map(drop)
}

pub fn saved_query(folder: Option<&Path>, name: &str) -> Result<String> {
    let saved = saved_queries(folder)?;
    let known = saved.iter().map(|saved| saved.name.clone()).collect();
    let found = saved.into_iter().find(|saved| saved.name == name);
    found.map(|saved| saved.sql).ok_or_else(|| StudyError::NotFound {
        what: "saved query",
        name: name.to_owned(),
        known,
    })
}
