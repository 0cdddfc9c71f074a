//! The study file `study.toml`: which subjects wear which garments, in which fabric, by which simulators.
//!
//! `docs/reference.md` lists its keys, and a test holds that page to what is read here.
//! Everything is checked before anything runs, and all problems are told at once.

mod garments;
mod outfits;
mod parse;
mod reader;
mod schedule;
mod subjects;
mod sweep;
mod target;
#[cfg(test)]
mod tests;
mod values;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::bodies;
use crate::parameters::Parameters;
use crate::schedule::{Limits, Schedule};
use body::{Body, LengthUnit, Measurements, Pose, Sex};
use fit::target::Target;
use fit::{Cuts, Simulator};
use sim::Fabric;
pub use store::files::SourceFile;
use store::{InFile, Origin, Problem, Result, StudyError};

/// A subject of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// Name in results.
    pub id: String,
    /// Who it is, in the pose that results are of.
    pub person: Person,
    /// Pose in which garments are put on, where they are carried from there.
    pub carried_from: Option<Pose>,
}

impl Subject {
    /// The same in the pose in which garments are put on; `None` where that is the pose that results are of.
    #[must_use]
    pub fn dressed(&self) -> Option<Self> {
        let (from, to) = (self.carried_from?, self.person.pose?);
        let name = self.id.strip_suffix(&format!(" {to}")).unwrap_or(&self.id);
        let person = Person { pose: Some(from), ..self.person.clone() };
        Some(Self { id: format!("{name} {from}"), person, carried_from: None })
    }

    /// Whether a name is that of the subject, or of somebody of whom it is one pose.
    #[must_use]
    pub fn is_called(&self, name: &str) -> bool {
        let of_pose = || self.person.pose.is_some_and(|pose| self.id == format!("{name} {pose}"));
        self.id == name || of_pose()
    }
}

/// Somebody who wears garments.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Person {
    /// What is known of the body; of a scan, what is measured on it.
    pub measurements: Measurements,
    /// The scan that is the body, where there is one.
    pub scan: Option<ScanFile>,
    /// How they stand, where that is not as they are built or scanned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
}

impl Person {
    /// The body: the scan, or one that is built from the measurements, in its pose.
    ///
    /// # Errors
    /// When the measurements are those of nobody, or the scan cannot wear garments or stand so.
    pub fn body(&self) -> Result<Body> {
        let body = match &self.scan {
            None => bodies::build_body(&self.measurements)?,
            Some(scan) => {
                let read = bodies::read_scan(&scan.file, scan.unit, Some(self.measurements.sex))?;
                bodies::scanned_body(&scan.file, read)?
            }
        };
        match self.pose {
            Some(pose) => bodies::pose_body(&body, pose),
            None => Ok(body),
        }
    }
}

impl From<Measurements> for Person {
    fn from(measurements: Measurements) -> Self {
        Self { measurements, scan: None, pose: None }
    }
}

impl ScanFile {
    /// Reads a scan and who it is; measured, which tells whether it is a standing person. The unit and the sex are told from it where
    /// they are not given.
    ///
    /// # Errors
    /// When it is no body.
    pub(crate) fn person(self, sex: Option<Sex>) -> Result<Person> {
        Ok(self.person_and_notes(sex)?.0)
    }

    /// As [`Self::person`], with what was guessed or repaired.
    ///
    /// # Errors
    /// When it is no body.
    pub fn person_and_notes(self, sex: Option<Sex>) -> Result<(Person, Vec<String>)> {
        let found = bodies::whole_scan(&self.file, self.unit, sex)?;
        let person = Person { measurements: found.girths.measurements(found.sex), scan: Some(self), pose: None };
        Ok((person, found.imported.notes))
    }
}

/// A body scan of a study.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ScanFile {
    /// OBJ, PLY, STL or GLB.
    pub file: SourceFile,
    /// Unit of the file; told from its height where it is not given.
    pub unit: Option<LengthUnit>,
}

/// One size of a garment.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeFile {
    /// Name of the size, such as `S`.
    pub name: String,
    /// Pattern file of the size, with its bytes.
    pub pattern: SourceFile,
}

/// A garment of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct GarmentEntry {
    /// Name in results.
    pub name: String,
    /// Identifiers of the subjects who wear it, in order.
    pub subjects: Vec<String>,
    /// How its pieces are sewn and measured; `None` where the patterns hold their own seams (GarmentCode JSON).
    pub seams: Option<SourceFile>,
    /// Unit of the patterns, where their files name none: `mm`, `cm`, `in` or `m`.
    pub unit: Option<String>,
    /// Fabric that it is cut from.
    pub fabric: Fabric,
    /// Sizes, in order.
    pub sizes: Vec<SizeFile>,
    /// Its style in the catalogue.
    pub style: String,
    /// Edge length of the finest cloth mesh, m.
    pub edge_length_m: f64,
    /// Values of the simulators' parameters that are not the default ones.
    pub parameters: Parameters,
    /// What ease it is to have; no input of a result.
    pub target: Target,
    /// Names and values that a sweep gave it.
    pub swept: Vec<(String, String)>,
    /// When its jobs are started, and what each may take.
    pub schedule: Schedule,
    /// What it is worn with, as a layer of an outfit.
    pub outfit: Option<WornWith>,
}

/// The place of a garment in an outfit.
#[derive(Clone, Debug, PartialEq)]
pub struct WornWith {
    /// Name of the outfit.
    pub name: String,
    /// Its layer, the inmost 0.
    pub layer: usize,
    /// All layers as they are alone; sizes at one place of their lists are worn together.
    pub layers: Vec<GarmentEntry>,
}

impl GarmentEntry {
    /// Its name in the file, where a sweep made it.
    #[must_use]
    pub fn unswept_name(&self) -> &str {
        self.swept.iter().rev().fold(&self.name, |name, (axis, value)| {
            let short = axis.rsplit('.').next().unwrap_or(axis);
            name.strip_suffix(&format!(" {short}={value}")).unwrap_or(name)
        })
    }
}

/// A study, checked and with all its inputs read.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// Name of the study: that in the file, or that of its folder.
    pub name: String,
    /// Path of the `study.toml`.
    pub path: PathBuf,
    /// Subjects, in order.
    pub subjects: Vec<Subject>,
    /// Garments, in order.
    pub garments: Vec<GarmentEntry>,
    /// Layers of outfits, in order.
    pub layers: Vec<GarmentEntry>,
    /// Simulators, in order.
    pub simulators: Vec<Simulator>,
    /// Simulations of each cell.
    pub repeats: u32,
    /// Where the fit classes meet.
    pub cuts: Cuts,
}

/// What a study file may name instead of bringing it.
#[derive(Clone, Debug, Default)]
pub struct Known {
    /// Subjects of the catalogue.
    pub subjects: BTreeMap<String, Person>,
    /// Fabrics of the catalogue and the library.
    pub fabrics: BTreeMap<String, Fabric>,
    /// Styles of the catalogue with their sizes.
    pub styles: BTreeMap<String, KnownStyle>,
    /// Entries that were removed and stay stored: `subject male-ii`.
    pub hidden: BTreeSet<String>,
}

/// A style of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownStyle {
    /// Seam file; `None` where the patterns hold their own seams.
    pub seams: Option<SourceFile>,
    /// Sizes, each with the unit of its pattern where its file names none.
    pub sizes: Vec<(SizeFile, Option<String>)>,
}

/// An entry of a file, and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed<T> {
    /// Path of the file.
    pub file: PathBuf,
    /// Its line, from 1.
    pub line: usize,
    /// Name of the entry.
    pub name: String,
    /// What the file says there.
    pub entry: T,
}

impl<T> Placed<T> {
    /// Something made of the entry, at the same place.
    pub fn map<U>(self, make: impl FnOnce(T) -> U) -> Placed<U> {
        let Self { file, line, name, entry } = self;
        Placed { file, line, name, entry: make(entry) }
    }

    /// A problem of the entry.
    pub fn problem(&self, message: impl Into<String>) -> Problem {
        Problem::at(&self.file, self.line, message)
    }
}

/// How a garment is sewn, and its sizes: a `[[garment]]` without its cloth.
#[derive(Clone, Debug, PartialEq)]
pub struct Sewn {
    /// Seam file; a file of sizes alone need not name it.
    pub seams: Option<SourceFile>,
    /// Unit of the patterns, where their files name none.
    pub unit: Option<String>,
    /// Sizes, in order.
    pub sizes: Vec<SizeFile>,
}

/// The study file of a path that names it or its folder.
#[must_use]
pub fn study_file(path: &Path) -> PathBuf {
    if path.is_dir() { path.join("study.toml") } else { path.to_owned() }
}

impl Study {
    /// Sets what each simulation may take, over what the file says.
    pub fn limit(&mut self, limits: Limits) {
        for garment in self.garments.iter_mut().chain(&mut self.layers) {
            garment.schedule.limits = limits.or(garment.schedule.limits);
        }
    }

    /// All that results are of, in order: garments alone, then the layers of outfits.
    pub fn worn(&self) -> impl Iterator<Item = &GarmentEntry> {
        self.garments.iter().chain(&self.layers)
    }

    /// Reads and checks a study: the file or its folder.
    ///
    /// # Errors
    /// [`StudyError::File`] with everything that is wrong; [`StudyError::Io`] when the file itself cannot be read.
    pub fn load(path: &Path, known: &Known) -> Result<Self> {
        let path = study_file(path);
        let text = std::fs::read_to_string(&path).map_err(StudyError::io(&path))?;
        parse::study(&path, &text, known).map_err(StudyError::File)
    }
}

/// The subjects of the text of a study file, or of one that has nothing else.
pub fn subjects(path: &Path, text: &str, known: &Known) -> std::result::Result<Vec<Placed<Subject>>, Vec<Problem>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    parse::entries(path, text, |reader, top| {
        reader.hidden.clone_from(&known.hidden);
        subjects::subjects(reader, top, folder, &known.subjects)
    })
}

/// The fabrics of the text of a study file, or of one that has nothing else.
pub fn fabrics(path: &Path, text: &str) -> std::result::Result<Vec<Placed<Fabric>>, Vec<Problem>> {
    parse::entries(path, text, parse::own_fabrics)
}

/// The garments of the text of a study file, or of one that has nothing else; without their cloth.
pub fn garments(path: &Path, text: &str) -> std::result::Result<Vec<Placed<Sewn>>, Vec<Problem>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    parse::entries(path, text, |reader, top| garments::all_sewn(reader, top, folder))
}

/// Measurements from the text of a file with those of a `[[subject]]`.
///
/// # Errors
/// [`StudyError::File`] with everything that is wrong.
pub(crate) fn measurements(path: &Path, text: &str) -> Result<Measurements> {
    parse::measurements_file(path, text).map_err(StudyError::File)
}

/// Whether a file holds measurements by its ending, and no mesh.
pub fn holds_measurements(path: &Path) -> bool {
    ["toml", "smis", "vit", "yaml", "yml", "json"]
        .iter()
        .any(|ending| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(ending)))
}

/// Measurements from a TOML file with those of a study's `[[subject]]`, or as SeamlyMe, Valentina and GarmentCode keep them;
/// `sex` where such a file does not say.
///
/// # Errors
/// Everything that is wrong with the file, at once.
pub fn read_measurements(path: &Path, sex: Option<Sex>) -> Result<Measurements> {
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        let text = std::fs::read_to_string(path).map_err(StudyError::io(path))?;
        return measurements(path, &text);
    }
    let source = SourceFile::read(path)?;
    let in_file = |error| StudyError::refused(Origin::Body, InFile { file: source.name.clone(), source: error });
    body::read_foreign(&source.bytes, sex).map_err(in_file)
}

/// The body of a file, measurements or a mesh, in a unit and of a sex where that cannot be told from it; and what had to be guessed.
///
/// # Errors
/// When it cannot be used.
pub fn read_body(path: &Path, unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<(Body, Vec<String>)> {
    if holds_measurements(path) {
        return Ok((bodies::build_body(&read_measurements(path, sex)?)?, Vec::new()));
    }
    let source = SourceFile::read(path)?;
    let scan = bodies::read_scan(&source, unit, sex)?;
    let notes = scan.imported.notes.clone();
    Ok((bodies::scanned_body(&source, scan)?, notes))
}

/// A fabric from a TOML file with what stands under a study's `[[fabric]]`.
///
/// # Errors
/// Everything that is wrong with the file, at once.
pub fn read_fabric(path: &Path) -> Result<Fabric> {
    let text = std::fs::read_to_string(path).map_err(StudyError::io(path))?;
    parse::fabric_file(path, &text).map_err(StudyError::File)
}
