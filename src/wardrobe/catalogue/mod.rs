//! The catalogue: subjects, styles, sizes and fabrics with revisions. An edit adds a revision, or makes an earlier one
//! with the same content current. Revisions never change, since results refer to them. Removing an entry that results
//! use only hides it.

mod fabrics;
mod format;
mod import;
mod known;
mod numbers;
mod percentiles;
pub mod revision;
mod sizes;
mod spec_sheet;
#[cfg(test)]
mod spec_tests;
mod style;
mod table;
#[cfg(test)]
mod tests;

use std::fmt;
use std::path::{Path, PathBuf};

use rusqlite::Transaction;

use self::revision::By;

use body::{LengthUnit, Sex};
use sim::Fabric;
use sim::fabric::USUAL;
use spec::entry::{Entry, filled};
use spec::file::{ScanFile, ScannedPerson};
use spec::{Given, Person};
use store::files::SourceFile;
use store::{Result, Store, StudyError};

pub use fabrics::{FabricRow, fabrics, with_bending};
pub use import::{Imported, Strictness, import};
pub use known::{StyleFiles, SubjectRow, known, person, read_fabric, read_style, subject, subject_revision, subjects};
pub use percentiles::{doubts, is_doubtful, percentile, percentile_text};
pub use sizes::{SizeRow, sizes, style_of, workpiece, workpiece_of};
pub use spec_sheet::{SpecGiven, keep_spec, spec};
pub use style::{StyleGiven, save_seams, save_size, save_style};

/// Opens a database with a catalogue. Creates it and adds the built-in fabrics and subjects where they are missing,
/// unless `readonly`.
pub fn open(path: &Path, readonly: bool) -> Result<Store> {
    let mut store = Store::open(path, readonly)?;
    if !readonly {
        known::add_builtin(store.writer()?)?;
    }
    Ok(store)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Bodies: measurements or a scan.
    Subject,
    /// Seams and measurements of a garment.
    Style,
    /// A pattern of a style; named `STYLE/SIZE`.
    Size,
    Fabric,
}

impl Part {
    /// Name in SQL and in messages.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Subject => "subject",
            Self::Style => "style",
            Self::Size => "size",
            Self::Fabric => "fabric",
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Condition for saving an entry: its name is free, taken, or either.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    Add,
    Edit,
    Import,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Saved {
    pub part: Part,
    pub name: String,
    pub revision: i64,
    pub deed: Deed,
    /// Values that are possible but rare.
    pub doubts: Vec<String>,
    /// Remarks on guesses and repairs of a scan.
    pub notes: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deed {
    /// The entry is new, or was removed before.
    Added,
    Revised,
    /// An earlier revision has the same content and is current again.
    Restored,
    Unchanged,
}

impl fmt::Display for Saved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { part, name, revision, .. } = self;
        match self.deed {
            Deed::Added => write!(f, "{part} {name} is added"),
            Deed::Revised => write!(f, "{part} {name} has revision {revision}; results keep theirs"),
            Deed::Restored => write!(f, "{part} {name} is as in revision {revision} again"),
            Deed::Unchanged => write!(f, "{part} {name} is unchanged"),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Removed {
    pub part: Part,
    pub name: String,
    pub jobs: i64,
    /// Hidden entries stay stored.
    pub is_hidden: bool,
}

impl fmt::Display for Removed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { part, name, jobs, is_hidden } = self;
        match (is_hidden, jobs) {
            (false, _) => write!(f, "{part} {name} is gone"),
            (true, 0) => write!(f, "{part} {name} is hidden; it is built in"),
            (true, jobs) => write!(f, "{part} {name} is hidden; {jobs} job(s) use it and keep it"),
        }
    }
}

/// An entry that can be saved by itself.
trait Stored: Sync {
    const PART: Part;

    /// Checks that the entry is possible. Returns doubts about rare values.
    fn verify(&self) -> std::result::Result<Vec<String>, String>;

    fn store(&self, transaction: &Transaction<'_>, name: &str) -> Result<revision::Revision>;
}

impl Stored for Person {
    const PART: Part = Part::Subject;

    /// Builds the body: only that shows if a person can have the measurements, and if a scan can wear garments.
    fn verify(&self) -> std::result::Result<Vec<String>, String> {
        self.body().map_err(|error| error.to_string())?;
        Ok(doubts(&self.measurements))
    }

    fn store(&self, transaction: &Transaction<'_>, name: &str) -> Result<revision::Revision> {
        revision::subject(transaction, name, self, By::User)
    }
}

impl Stored for Fabric {
    const PART: Part = Part::Fabric;

    fn verify(&self) -> std::result::Result<Vec<String>, String> {
        let (warp, weft) = (self.membrane_warp_n_m, self.membrane_weft_n_m);
        if self.membrane_coupling_n_m.powi(2) < warp * weft {
            return Ok(vec![]);
        }
        let most = (warp * weft).sqrt();
        Err(format!("`membrane_coupling_n_m` is {}; accepted: below {most:.1}", self.membrane_coupling_n_m))
    }

    fn store(&self, transaction: &Transaction<'_>, _: &str) -> Result<revision::Revision> {
        revision::fabric(transaction, self, By::User)
    }
}

fn refused(part: Part, name: &str, problems: Vec<String>) -> StudyError {
    StudyError::Refused { what: part.as_str(), name: name.to_owned(), problems }
}

fn check_name(name: &str) -> std::result::Result<(), String> {
    if is_line(name) && !name.contains('/') {
        return Ok(());
    }
    Err("its name; accepted: 1 to 64 characters, no `/`, no space at either end".to_owned())
}

/// Checks the name of a size, which may be double (`XS/S`, `34 1/2`): what follows the first `/` of `STYLE/SIZE`.
fn check_size_name(name: &str) -> std::result::Result<(), String> {
    if is_line(name) {
        return Ok(());
    }
    Err("its name; accepted: 1 to 64 characters, no space at either end".to_owned())
}

/// True for up to 64 characters in a line, without space at either end.
fn is_line(name: &str) -> bool {
    !name.is_empty() && name.trim() == name && name.chars().count() <= 64 && !name.chars().any(char::is_control)
}

fn save(
    transaction: &Transaction<'_>,
    part: Part,
    name: &str,
    mode: Mode,
    store: impl FnOnce() -> Result<revision::Revision>,
) -> Result<Saved> {
    let before = revision::current(transaction, part, name)?.filter(|current| !current.is_retired);
    match mode {
        Mode::Add if before.is_some() => {
            return Err(StudyError::Exists { what: part.as_str(), name: name.to_owned() });
        }
        Mode::Edit if before.is_none() => return Err(known::missing(transaction, part, name)?),
        _ => {}
    }
    let after = store()?;
    let deed = match before {
        None => Deed::Added,
        Some(current) if current.number == after.number => Deed::Unchanged,
        Some(_) if after.is_new => Deed::Revised,
        Some(_) => Deed::Restored,
    };
    Ok(Saved { part, name: name.to_owned(), revision: after.number, deed, doubts: vec![], notes: vec![] })
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScanGiven {
    /// OBJ, PLY, STL or GLB.
    pub file: PathBuf,
    /// `None` to infer it from the height.
    pub unit: Option<LengthUnit>,
    /// `None` to infer it from the shape.
    pub sex: Option<Sex>,
}

/// Given values replace those that the subject has. The body is built, to check that it is possible. Fails for a
/// subject that is a scan.
pub fn save_subject(store: &mut Store, mode: Mode, name: &str, given: &[Given]) -> Result<Saved> {
    let base = match mode {
        Mode::Edit => Some(subject(store, name)?),
        _ => None,
    };
    if base.as_ref().is_some_and(|person| person.scan.is_some()) {
        let problem = "its body is a scan, on which it is measured; accepted: another scan";
        return Err(refused(Part::Subject, name, vec![problem.to_owned()]));
    }
    let measurements = entry_of(Part::Subject, name, base.map(|person| person.measurements).as_ref(), given)?;
    save_entry(store, mode, name, &Person::from(measurements))
}

pub fn save_scan(store: &mut Store, mode: Mode, name: &str, given: &ScanGiven) -> Result<Saved> {
    let ScanGiven { file, unit, sex } = given;
    let scan = ScanFile { file: SourceFile::read(file)?, unit: *unit };
    let ScannedPerson { person, notes } = scan.read(*sex)?;
    Ok(Saved { notes, ..save_entry(store, mode, name, &person)? })
}

/// Given values replace those that the fabric has, or else those of the fabric `like`.
pub fn save_fabric(store: &mut Store, mode: Mode, name: &str, like: Option<&str>, given: &[Given]) -> Result<Saved> {
    let base = match (like, mode) {
        (Some(like), _) => Some(Fabric { name: name.to_owned(), ..cloth(store, Some(like))? }),
        (None, Mode::Edit) => Some(cloth(store, Some(name))?),
        _ => None,
    };
    save_entry(store, mode, name, &entry_of(Part::Fabric, name, base.as_ref(), given)?)
}

/// Current revision; that of the default fabric where none is named.
pub fn cloth(store: &Store, name: Option<&str>) -> Result<Fabric> {
    let name = name.unwrap_or(USUAL);
    match known(Some(&store.reader))?.fabrics.remove(name) {
        Some(fabric) => Ok(fabric),
        None => Err(known::missing(&store.reader, Part::Fabric, name)?),
    }
}

fn entry_of<T: Entry>(part: Part, name: &str, base: Option<&T>, given: &[Given]) -> Result<T> {
    let texts = |problems: Vec<Given>| problems.into_iter().map(|(_, problem)| problem).collect();
    filled(base, name, given).map_err(|problems| refused(part, name, texts(problems)))
}

fn save_entry<T: Stored>(store: &mut Store, mode: Mode, name: &str, entry: &T) -> Result<Saved> {
    let refuse = |problem| refused(T::PART, name, vec![problem]);
    check_name(name).map_err(refuse)?;
    let doubts = entry.verify().map_err(refuse)?;
    let transaction = store::write(store.writer()?)?;
    let saved = save(&transaction, T::PART, name, mode, || entry.store(&transaction, name))?;
    transaction.commit()?;
    Ok(Saved { doubts, ..saved })
}

/// Only hides a built-in entry, and one that jobs use. Removes a style with its sizes. Fails where jobs wait or run
/// with the entry.
pub fn remove(store: &mut Store, part: Part, name: &str) -> Result<Removed> {
    let transaction = store::write(store.writer()?)?;
    let removed = known::remove(&transaction, part, name)?;
    transaction.commit()?;
    Ok(removed)
}
