//! Errors of the store and of the crates above it.

use std::fmt;
use std::path::{Path, PathBuf};

use rusqlite::ErrorCode;
use sim::SimError;

#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    #[error("database: {}", database_error(.0))]
    Database(#[from] rusqlite::Error),
    #[error("{}: cannot open this database: {reason}", path.display())]
    Open { path: PathBuf, reason: String },
    #[error("database has schema version {found}, this program knows versions up to {known}; use the newer program")]
    TooNew { found: i64, known: i64 },
    #[error("the workspace is open read-only; start without --readonly to change it")]
    Readonly,
    #[error("{}: {source}", path.display())]
    Io { path: PathBuf, source: std::io::Error },
    /// Everything that is wrong with a study file.
    #[error("{}", Problem::listing(.0))]
    File(Vec<Problem>),
    /// Values that are not accepted for an entry of the catalogue.
    #[error("{what} {name}: {}", problems.join("; "))]
    Refused {
        /// Part of the catalogue, such as `subject`.
        what: &'static str,
        name: String,
        /// One problem for each value.
        problems: Vec<String>,
    },
    /// A study whose name is stored already for a study of another folder.
    #[error(
        "study `{name}`: found in {}, and its results are kept for {}; accepted: another name in the study file, a database \
         of its own (--db PATH), or --moved where it is the same study in a new place",
        found.display(),
        stored.display()
    )]
    HomeTaken {
        name: String,
        /// The study file that the results are kept for.
        stored: PathBuf,
        found: PathBuf,
    },
    #[error("there is a {what} `{name}` already; edit it, or take another name")]
    Exists { what: &'static str, name: String },
    #[error("no {what} `{name}`{}", suggestion(.known, .name))]
    NotFound {
        /// Kind of thing (`job`, `study`, ...).
        what: &'static str,
        name: String,
        known: Vec<String>,
    },
    #[error("which {what}? --{what} says it; there are: {}", .known.join(", "))]
    Unsaid {
        /// Kind of thing, and the flag that names it.
        what: &'static str,
        known: Vec<String>,
    },
    /// An entry of the catalogue that was removed; it stays stored for the results that use it.
    #[error("no {what} `{name}`; {}", hidden_hint(.what))]
    Hidden { what: &'static str, name: String },
    #[error("{origin}: {source}")]
    Refusal { origin: Origin, source: Box<dyn std::error::Error + Send + Sync> },
    /// Stored bytes are not what the program wrote.
    #[error("artefact {hash}: {message}")]
    Artefact { hash: String, message: String },
    /// A job failed on another machine.
    #[error("{message}")]
    Elsewhere { message: String },
    #[error("interrupted")]
    Interrupted,
}

impl StudyError {
    pub fn io(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { path, source }
    }

    /// Wraps the error of a simulator; [`Self::Interrupted`] where the simulator was asked to stop.
    pub fn sim(error: SimError) -> Self {
        match error {
            SimError::Cancelled => Self::Interrupted,
            other => Self::refused(Origin::Sim, other),
        }
    }

    pub fn refused(origin: Origin, source: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        Self::Refusal { origin, source: source.into() }
    }
}

/// Part of the program that an error comes from; the message begins with the name of the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    Alter,
    Audit,
    Body,
    Chance,
    /// Distance fields.
    Field,
    Grade,
    /// A job's process.
    Job,
    /// Limits of time and memory.
    Limit,
    Measure,
    /// Results merged from elsewhere.
    Merge,
    Mesh,
    Panic,
    Pattern,
    Queue,
    Render,
    Report,
    /// A run that is repeated.
    Rerun,
    Result,
    Sim,
    Slurm,
    Sql,
    Store,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Alter => "alter",
            Self::Audit => "audit",
            Self::Body => "body",
            Self::Chance => "chance",
            Self::Field => "field",
            Self::Grade => "grade",
            Self::Job => "job",
            Self::Limit => "limit",
            Self::Measure => "measure",
            Self::Merge => "merge",
            Self::Mesh => "mesh",
            Self::Panic => "panic",
            Self::Pattern => "pattern",
            Self::Queue => "queue",
            Self::Render => "render",
            Self::Report => "report",
            Self::Rerun => "rerun",
            Self::Result => "result",
            Self::Sim => "sim",
            Self::Slurm => "slurm",
            Self::Sql => "sql",
            Self::Store => "store",
        })
    }
}

/// Names the part of the program that an error comes from.
pub trait InOrigin<T> {
    fn origin(self, origin: Origin) -> Result<T>;
}

impl<T, E: Into<Box<dyn std::error::Error + Send + Sync>>> InOrigin<T> for std::result::Result<T, E> {
    fn origin(self, origin: Origin) -> Result<T> {
        self.map_err(|error| StudyError::refused(origin, error))
    }
}

#[derive(Debug, thiserror::Error)]
#[error("{file}: {source}")]
pub struct InFile<E: std::error::Error + 'static> {
    pub file: String,
    pub source: E,
}

#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    #[error(
        "{}: a folder with no DXF file and {patterns} patterns as JSON; accepted: DXF files, or one pattern as JSON",
        folder.display()
    )]
    NoPattern {
        folder: PathBuf,
        /// Number of its JSON files that are patterns.
        patterns: usize,
    },
    /// A file to be written whose name leads out of its folder.
    #[error("{}: file `{name}` would not lie in it; accepted: names below the folder", folder.display())]
    Outside { folder: PathBuf, name: String },
    #[error("{}: found {found}; accepted: {accepted}", path.display())]
    Format {
        path: PathBuf,
        /// Ending of the file's name, in words.
        found: String,
        /// Names with the endings that are accepted.
        accepted: String,
    },
    /// A name that no saved query can have.
    #[error("`{name}` is no name of a query; accepted: letters, digits, - _ . and blanks")]
    QueryName { name: String },
}

/// One error in a study file, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    pub file: PathBuf,
    /// Counts from 1.
    pub line: Option<usize>,
    /// Counts characters from 1.
    pub column: Option<usize>,
    /// Value that was found, and the values that are accepted.
    pub message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file.display())?;
        for place in [self.line, self.column].into_iter().flatten() {
            write!(f, "{place}:")?;
        }
        write!(f, " {}", self.message)
    }
}

impl Problem {
    /// A problem of a whole file.
    pub fn of(file: &Path, message: impl Into<String>) -> Self {
        Self { file: file.to_owned(), line: None, column: None, message: message.into() }
    }

    pub fn at(file: &Path, line: usize, message: impl Into<String>) -> Self {
        Self { line: Some(line), ..Self::of(file, message) }
    }

    /// One problem a line.
    pub fn listing(problems: &[Self]) -> String {
        problems.iter().map(Self::to_string).collect::<Vec<_>>().join("\n")
    }
}

pub type Result<T> = std::result::Result<T, StudyError>;

/// Message of SQLite, with a remedy.
pub fn database_error(error: &rusqlite::Error) -> String {
    let advice = match error.sqlite_error_code() {
        Some(ErrorCode::DiskFull) => "; make room and start again: nothing finished is lost",
        Some(ErrorCode::SystemIoFailure) => {
            "; a full disk, a quota or a limit on file sizes does this: make room and start again, nothing finished is lost"
        }
        Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => {
            "; another process keeps it to itself: wait for that one or end it, then start again"
        }
        Some(ErrorCode::ReadOnly) => "; the file or its folder may not be written to: --readonly reads it as it is",
        Some(ErrorCode::CannotOpen) => {
            "; it, its folder or its log may not be read, or not be written: --readonly needs no writing"
        }
        Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase) => "; `toile doctor` looks closer, a copy helps",
        _ => "",
    };
    format!("{error}{advice}")
}

/// Returns `; did you mean ...?` or `; there are: ...`; empty where no name is known.
fn suggestion(known: &[String], name: &str) -> String {
    match nearest(name, known.iter().map(String::as_str)) {
        Some(near) => format!("; did you mean `{near}`?"),
        None if known.is_empty() => String::new(),
        None => format!("; there are: {}", known.join(", ")),
    }
}

/// Advice for an entry that was removed from a part of the catalogue.
pub fn hidden_hint(part: &str) -> String {
    format!("it is hidden: it was removed, and stays for its results; `toile {part} add` or `import` brings it back")
}

/// Candidate nearest to a misspelt name, if their edit distance is at most a third of the longer name's length.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= candidate.chars().count().max(name.chars().count()) / 3)
        .min()
        .map(|(_, candidate)| candidate)
}

/// Levenshtein distance in characters.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_suggested_and_far_ones_are_not() {
        let check = |name: &str, expected: Option<&str>| {
            assert_eq!(nearest(name, ["cotton_shirting_light", "denim", "rib_knit"]), expected, "{name}");
        };
        check("cotton_shirting_ligth", Some("cotton_shirting_light"));
        check("demin", None);
        check("denin", Some("denim"));
        check("silk", None);
    }
}
