//! Kinds of values that occur in several tables of a study file: numbers of an entry, unique names, references, files.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toml::Spanned;

use crate::entry::{Entry, is_absent};
use crate::file::reader::{Place, Reader};
use store::files::SourceFile;
use store::{StudyError, hidden_hint, nearest};

/// `None` where a number is wrong or missing, which is reported.
pub(super) fn numbers<T: Entry>(reader: &mut Reader<'_>, place: &Place<'_>, mut entry: T, wanted: &str) -> Option<T> {
    let before = reader.problems.len();
    for field in T::fields() {
        if place.table.contains_key(field.key) {
            if let Some(number) = reader.checked(place, field.key, |number| field.check(number)) {
                field.set(&mut entry, Some(number));
            }
        } else if is_absent(field, |key| place.table.contains_key(key)) {
            reader.missing(place, field.key, wanted);
        }
    }
    for sheet in T::sheets() {
        let key = sheet.field.key;
        let Some(number) = reader.checked(place, key, |number| sheet.field.check(number)) else { continue };
        let applied = sheet.apply(&mut entry, number);
        if let Err(problem) = sheet.doubled(|key| place.table.contains_key(key)).map_or(applied, Err) {
            reader.problem(&place.span, format!("{}: {problem}", place.name));
        }
    }
    if let Err((_, problem)) = entry.check() {
        reader.problem(&place.span, format!("{}: {problem}", place.name));
    }
    (reader.problems.len() == before).then_some(entry)
}

pub(super) fn unique<'t>(reader: &mut Reader<'_>, names: &mut BTreeSet<&'t str>, name: &Spanned<&'t str>, what: &str) {
    if !names.insert(name.get_ref()) {
        reader.problem(&name.span(), format!("{what} `{}` is there twice; names must differ", name.get_ref()));
    }
}

/// Returns an entry by name; reports a name that is missing, with a suggestion. `what` says the kind of entry; for
/// kinds that the catalogue has too, it begins with the part of the catalogue.
pub(super) fn lookup<'k, T>(
    reader: &mut Reader<'_>,
    known: &'k BTreeMap<String, T>,
    name: &Spanned<&str>,
    what: &str,
) -> Option<&'k T> {
    let found = known.get(*name.get_ref());
    if found.is_none() {
        let part = what.split(' ').next().unwrap_or_default();
        let hint = match nearest(name.get_ref(), known.keys().map(String::as_str)) {
            _ if reader.hidden.contains(&format!("{part} {}", name.get_ref())) => hidden_hint(part),
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are: {}", known.keys().cloned().collect::<Vec<_>>().join(", ")),
        };
        reader.problem(&name.span(), format!("no {what} `{}`; {hint}", name.get_ref()));
    }
    found
}

/// Reads a file beside the study file. Reports one that cannot be read, with a suggestion.
pub(super) fn source(
    reader: &mut Reader<'_>,
    place: &Place<'_>,
    file: &Spanned<&str>,
    folder: &Path,
    read: fn(&Path) -> Result<SourceFile, StudyError>,
) -> Option<SourceFile> {
    let path = folder.join(file.get_ref());
    match read(&path) {
        Ok(source) => Some(source),
        Err(error) => {
            let wanted = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let beside: Vec<String> = path.parent().map(file_names).unwrap_or_default();
            let hint = nearest(&wanted, beside.iter().map(String::as_str));
            let hint = hint.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            reader.problem(&file.span(), format!("{}: {error}{hint}", place.name));
            None
        }
    }
}

fn file_names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
