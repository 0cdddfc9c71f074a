//! Import of entries from files: all entries or, where one has a problem, none, unless only the good ones are asked
//! for.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::catalogue::format::{Format, format_of, text_of, unknown_format};
use crate::catalogue::table::{self, Read};
use crate::catalogue::{Mode, Part, Saved, Stored, check_name, known, save, style};
use body::Measurements;
use sim::Fabric;
use spec::Person;
use spec::entry::Entry;
use spec::file::{self, Placed, ScanFile, ScannedPerson};
use store::files::SourceFile;
use store::{Problem, Result, Store, StudyError};

/// Treatment of files with problems.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strictness {
    /// No entry is imported where one has a problem.
    AllOrNone,
    /// Rows without a problem are imported, the others reported. A table that cannot be read at all is refused.
    GoodRows,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Imported {
    pub saved: Vec<Saved>,
    pub left_out: Vec<Problem>,
}

/// Imports all entries of some files into the catalogue. A file is a study file, TOML with tables of a study file or,
/// for subjects and fabrics, CSV with the same keys. A scan becomes a subject named after its file. `strictness`
/// decides about files with problems.
pub fn import(store: &mut Store, part: Part, files: &[PathBuf], strictness: Strictness) -> Result<Imported> {
    match part {
        Part::Subject => {
            let known = known(Some(&store.reader))?;
            let notes = RefCell::new(BTreeMap::new());
            let mut imported = import_entries(store, files, strictness, |path, bytes| match format_of(path) {
                Some(Format::Csv) => read_rows::<Measurements, Person>(path, part, bytes),
                Some(Format::Toml) => {
                    let subjects = file::subjects(path, text_of(path, bytes)?, &known)?;
                    all_good(subjects.into_iter().map(|placed| placed.map(|subject| subject.person)).collect())
                }
                Some(Format::Mesh) => {
                    let scanned = scanned(path, bytes)?;
                    notes.borrow_mut().insert(scanned.name.clone(), scanned.entry.notes.clone());
                    all_good(vec![scanned.map(|read| read.person)])
                }
                None => Err(vec![unknown_format(path, "CSV (.csv), TOML (.toml) or a scan (.obj, .ply, .stl, .glb)")]),
            })?;
            for saved in &mut imported.saved {
                saved.notes = notes.borrow_mut().remove(&saved.name).unwrap_or_default();
            }
            Ok(imported)
        }
        Part::Fabric => import_entries(store, files, strictness, |path, bytes| match format_of(path) {
            Some(Format::Csv) => read_rows::<Fabric, Fabric>(path, part, bytes),
            Some(Format::Toml) => all_good(file::fabrics(path, text_of(path, bytes)?)?),
            Some(Format::Mesh) | None => Err(vec![unknown_format(path, "CSV (.csv) or TOML (.toml)")]),
        }),
        Part::Style | Part::Size => {
            Ok(Imported { saved: style::import_styles(store, part, files)?, left_out: Vec::new() })
        }
    }
}

/// Refuses a file that cannot be read at all.
fn import_entries<T: Stored>(
    store: &mut Store,
    files: &[PathBuf],
    strictness: Strictness,
    read: impl Fn(&Path, &[u8]) -> std::result::Result<Read<T>, Vec<Problem>>,
) -> Result<Imported> {
    let (mut entries, mut wrong, mut unusable) = (Vec::new(), Vec::new(), Vec::new());
    for path in files {
        let bytes = std::fs::read(path).map_err(StudyError::io(path))?;
        match read(path, &bytes) {
            Ok(Read { entries: read, problems }) if read.is_empty() && problems.is_empty() => {
                unusable.push(Problem::of(path, format!("no {} in it", T::PART)));
            }
            Ok(Read { entries: read, problems }) => {
                entries.extend(read);
                wrong.extend(problems);
            }
            Err(problems) => unusable.extend(problems),
        }
    }
    let checked = verified(&entries);
    let mut good = Vec::new();
    for (placed, outcome) in entries.into_iter().zip(checked) {
        match check_name(&placed.name).and(outcome) {
            Ok(doubts) => good.push((placed, doubts)),
            Err(problem) => wrong.push(placed.problem(format!("{} {}: {problem}", T::PART, placed.name))),
        }
    }
    if !unusable.is_empty() || !wrong.is_empty() && (strictness == Strictness::AllOrNone || good.is_empty()) {
        unusable.extend(wrong);
        return Err(StudyError::File(unusable));
    }
    let transaction = store::write(store.writer()?)?;
    let mut saved = Vec::new();
    for (Placed { name, entry, .. }, doubts) in good {
        let done = save(&transaction, T::PART, &name, Mode::Import, || entry.store(&transaction, &name))?;
        saved.push(Saved { doubts, ..done });
    }
    transaction.commit()?;
    Ok(Imported { saved, left_out: wrong })
}

fn all_good<T>(entries: Vec<Placed<T>>) -> std::result::Result<Read<T>, Vec<Problem>> {
    Ok(Read { entries, problems: Vec::new() })
}

fn read_rows<R: Entry, T: From<R>>(
    path: &Path,
    part: Part,
    bytes: &[u8],
) -> std::result::Result<Read<T>, Vec<Problem>> {
    let Read { entries, problems } = table::read::<R>(path, part, bytes)?;
    Ok(Read { entries: entries.into_iter().map(|placed| placed.map(T::from)).collect(), problems })
}

/// Name is that of the file.
fn scanned(path: &Path, bytes: &[u8]) -> std::result::Result<Placed<ScannedPerson>, Vec<Problem>> {
    let name = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let scan = ScanFile { file: SourceFile { name: name(path.file_name()), bytes: bytes.into() }, unit: None };
    let entry = scan.read(None).map_err(|error| vec![Problem::of(path, error.to_string())])?;
    Ok(Placed { file: path.to_owned(), line: 1, name: name(path.file_stem()), entry })
}

/// Uses all cores, since building a body takes long.
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
