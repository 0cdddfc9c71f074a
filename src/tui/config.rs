//! The user's own files in the config folder: their paths, how they are read, and their problems.

use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

/// Variables of the environment: name to value.
pub type Env<'a> = dyn Fn(&str) -> Option<String> + 'a;

/// All problems of one of the user's own files.
#[derive(Debug, thiserror::Error)]
#[error("{}", .0.join("\n"))]
pub struct ConfigError(Vec<String>);

/// Path of a file in `toile` of the config folder.
pub fn path(env: &Env<'_>, file: &str) -> Option<PathBuf> {
    let set = |name: &str| env(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = set("XDG_CONFIG_HOME").or_else(|| set("HOME").map(|home| home.join(".config")))?;
    Some(folder.join("toile").join(file))
}

/// Returns the default where there is no file.
pub fn read<T: Default>(
    path: Option<&Path>,
    take: impl Fn(&[Entry<'_>], &mut Problems) -> T,
) -> Result<T, ConfigError> {
    let Some(path) = path.filter(|path| path.exists()) else { return Ok(T::default()) };
    let text =
        std::fs::read_to_string(path).map_err(|error| ConfigError(vec![format!("{}: {error}", path.display())]))?;
    parse(&path.display().to_string(), &text, take)
}

/// Parses a text; messages give the name of its file.
pub fn parse<T>(name: &str, text: &str, take: impl FnOnce(&[Entry<'_>], &mut Problems) -> T) -> Result<T, ConfigError> {
    let line = |at: usize| 1 + text.as_bytes()[..at.min(text.len())].iter().filter(|&&byte| byte == b'\n').count();
    let (document, errors) = DeTable::parse_recoverable(text);
    let told = errors.iter().map(|error| {
        let at = error.span().unwrap_or_default().start;
        (line(at), error.message().to_owned())
    });
    let mut problems = Problems(told.collect());
    let entries: Vec<Entry<'_>> = document
        .get_ref()
        .iter()
        .map(|(key, value)| Entry { name: key.get_ref(), value: value.get_ref(), line: line(key.span().start) })
        .collect();
    let taken = take(&entries, &mut problems);
    let Problems(mut told) = problems;
    told.sort();
    told.dedup();
    match told.is_empty() {
        true => Ok(taken),
        false => Err(ConfigError(told.into_iter().map(|(line, what)| format!("{name}:{line}: {what}")).collect())),
    }
}

/// A line `name = value` of a file.
pub struct Entry<'a> {
    /// Key at the top level of the file.
    pub name: &'a str,
    pub value: &'a DeValue<'a>,
    /// Line of the file, from 1.
    pub line: usize,
}

pub struct Problems(Vec<(usize, String)>);

impl Problems {
    pub fn tell(&mut self, line: usize, what: String) {
        self.0.push((line, what));
    }

    /// Returns the value of an entry; reports an error and returns `None`.
    pub fn or_tell<T>(&mut self, entry: &Entry<'_>, value: Result<T, String>) -> Option<T> {
        value.map_err(|what| self.tell(entry.line, format!("{}: {what}", entry.name))).ok()
    }
}
