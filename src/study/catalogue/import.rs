//! Entries of the catalogue from files: all of them, or none where anything is wrong with one.

use std::path::{Path, PathBuf};

use crate::catalogue::format::{Format, format_of, text_of, unknown_format};
use crate::catalogue::{Mode, Part, Saved, Stored, check_name, known, save, style, table};
use crate::error::{Problem, Result, StudyError};
use crate::spec::file::{self, Placed};
use crate::store::{self, Store};

/// Brings all entries of some files into the catalogue, or none where anything is wrong with one of them: TOML with
/// the tables of a study file (a study file itself will do), or, for subjects and fabrics, CSV with the same keys.
///
/// # Errors
/// Everything that is wrong with the files, each with its line.
pub fn import(store: &mut Store, part: Part, files: &[PathBuf]) -> Result<Vec<Saved>> {
    match part {
        Part::Subject => {
            let known = known(Some(&store.reader))?;
            import_entries(store, files, |path, text| {
                let subjects = file::subjects(path, text, &known)?;
                Ok(subjects.into_iter().map(|placed| placed.map(|subject| subject.measurements)).collect())
            })
        }
        Part::Fabric => import_entries(store, files, file::fabrics),
        Part::Style | Part::Size => style::import_styles(store, part, files),
    }
}

fn import_entries<T: Stored>(
    store: &mut Store,
    files: &[PathBuf],
    of_toml: impl Fn(&Path, &str) -> std::result::Result<Vec<Placed<T>>, Vec<Problem>>,
) -> Result<Vec<Saved>> {
    let mut entries = Vec::new();
    let mut problems = Vec::new();
    for path in files {
        let bytes = std::fs::read(path).map_err(StudyError::io(path))?;
        let read = match format_of(path) {
            Some(Format::Csv) => table::read::<T>(path, T::PART, &bytes),
            Some(Format::Toml) => text_of(path, &bytes).and_then(|text| of_toml(path, text)),
            None => Err(vec![unknown_format(path, "CSV (.csv) or TOML (.toml)")]),
        };
        match read {
            Ok(read) if read.is_empty() => problems.push(Problem::of(path, format!("no {} in it", T::PART))),
            Ok(read) => entries.extend(read),
            Err(found) => problems.extend(found),
        }
    }
    let checked = verified(&entries);
    let wrong = entries.iter().zip(&checked).filter_map(|(placed, outcome)| {
        let named = check_name(&placed.name);
        let problem = outcome.as_ref().err().or(named.as_ref().err())?;
        Some(placed.problem(format!("{} {}: {problem}", T::PART, placed.name)))
    });
    problems.extend(wrong);
    if !problems.is_empty() {
        return Err(StudyError::File(problems));
    }
    let transaction = store::write(store.writer()?)?;
    let mut saved = Vec::new();
    for (Placed { name, entry, .. }, doubts) in entries.iter().zip(checked) {
        let done = save(&transaction, T::PART, name, Mode::Import, || entry.store(&transaction, name))?;
        saved.push(Saved { doubts: doubts.unwrap_or_default(), ..done });
    }
    transaction.commit()?;
    Ok(saved)
}

/// Verifies entries on all cores: a body takes a while to build.
fn verified<T: Stored>(entries: &[Placed<T>]) -> Vec<std::result::Result<Vec<String>, String>> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let share = entries.len().div_ceil(threads).max(1);
    let check = |chunk: &[Placed<T>]| chunk.iter().map(|placed| placed.entry.verify()).collect::<Vec<_>>();
    std::thread::scope(|scope| {
        let workers: Vec<_> = entries.chunks(share).map(|chunk| scope.spawn(move || check(chunk))).collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}
