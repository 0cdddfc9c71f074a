//! The study file `study.toml`: which subjects wear which garments, in which fabric, by which simulators.
//!
//! `docs/reference.md` lists its keys; a test compares that page with the keys read here. The whole file is checked
//! before anything runs, and all problems are reported at once.

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
use body::{Body, Figures, LengthUnit, Measurements, Pose, Sex};
use fit::target::Target;
use fit::{Cuts, Simulator};
pub use outfits::LAYERS;
use sim::Fabric;
pub use store::files::SourceFile;
use store::{InFile, Origin, Problem, Result, StudyError};

/// A subject of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// Name in results.
    pub id: String,
    /// Person, in the pose that results are about.
    pub person: Person,
    /// Pose in which garments are put on, if the body then moves to `person.pose` and carries them along.
    pub carried_from: Option<Pose>,
}

impl Subject {
    /// The same subject in the pose in which garments are put on; `None` where garments are not carried.
    #[must_use]
    pub fn dressed(&self) -> Option<Self> {
        let (from, to) = (self.carried_from?, self.person.pose?);
        let name = self.id.strip_suffix(&format!(" {to}")).unwrap_or(&self.id);
        let person = Person { pose: Some(from), ..self.person.clone() };
        Some(Self { id: format!("{name} {from}"), person, carried_from: None })
    }

    /// True if a name is that of the subject, or of the person whom the subject shows in one pose.
    #[must_use]
    pub fn is_called(&self, name: &str) -> bool {
        let of_pose = || self.person.pose.is_some_and(|pose| self.id == format!("{name} {pose}"));
        self.id == name || of_pose()
    }
}

/// A person who wears garments.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Person {
    /// Measurements of the body; for a scan, those taken on the scan.
    pub measurements: Measurements,
    /// Scan that is the body; `None` where the body is built from measurements.
    pub scan: Option<ScanFile>,
    /// Pose; `None` for the pose in which the body is built or scanned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// Figures in which the body departs from the standard body of its measurements. Never those of a scan.
    #[serde(default, skip_serializing_if = "Figures::is_empty")]
    pub figures: Figures,
}

impl Person {
    /// Makes the body, from the scan or from the measurements, in its pose.
    ///
    /// # Errors
    /// When no body has the measurements, or the scan cannot wear garments or take the pose.
    pub fn body(&self) -> Result<Body> {
        let body = match &self.scan {
            None => bodies::build_figured(&self.measurements, &self.figures)?,
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
        Self { measurements, scan: None, pose: None, figures: Figures::default() }
    }
}

impl ScanFile {
    /// Reads and measures a scan. Unit and sex are inferred where they are not given.
    ///
    /// # Errors
    /// When the scan is no standing person.
    pub fn read(self, sex: Option<Sex>) -> Result<ScannedPerson> {
        let found = bodies::whole_scan(&self.file, self.unit, sex)?;
        let of_scan = Person::from(found.girths.measurements(found.sex));
        let person = Person { scan: Some(self), ..of_scan };
        Ok(ScannedPerson { person, notes: found.imported.notes })
    }
}

/// A person whose body is a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct ScannedPerson {
    /// Person, with the measurements taken on the scan.
    pub person: Person,
    /// Remarks on guesses and repairs.
    pub notes: Vec<String>,
}

/// A body scan of a study.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ScanFile {
    /// Mesh file: OBJ, PLY, STL or GLB.
    pub file: SourceFile,
    /// Unit of the file; `None` to infer it from the height.
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
    /// Identifiers of the subjects who wear the garment, in order.
    pub subjects: Vec<String>,
    /// Seam file; `None` where the patterns hold their own seams (GarmentCode JSON).
    pub seams: Option<SourceFile>,
    /// Unit of the patterns, where their files name none: `mm`, `cm`, `in` or `m`.
    pub unit: Option<String>,
    /// Fabric that the garment is cut from.
    pub fabric: Fabric,
    /// Sizes, in order.
    pub sizes: Vec<SizeFile>,
    /// Name of the garment's style in the catalogue.
    pub style: String,
    /// Edge length of the finest cloth mesh, m.
    pub edge_length_m: f64,
    /// Parameters of the simulators that differ from their defaults.
    pub parameters: Parameters,
    /// Intended ease, which results do not depend on.
    pub target: Target,
    /// Names and values that a sweep gave the garment.
    pub swept: Vec<(String, String)>,
    /// Priority, order and limits of the garment's jobs.
    pub schedule: Schedule,
    /// Outfit of which the garment is a layer, if any.
    pub outfit: Option<WornWith>,
}

/// Place of a garment in an outfit.
#[derive(Clone, Debug, PartialEq)]
pub struct WornWith {
    /// Name of the outfit.
    pub name: String,
    /// Index of the garment's layer, the inmost 0.
    pub layer: usize,
    /// All layers as garments of their own. Sizes with the same index in each layer's list are worn together.
    pub layers: Vec<GarmentEntry>,
}

impl GarmentEntry {
    /// Name of the garment in the file, without the values that a sweep appends.
    #[must_use]
    pub fn unswept_name(&self) -> &str {
        self.swept.iter().rev().fold(&self.name, |name, (axis, value)| {
            let short = axis.rsplit('.').next().unwrap_or(axis);
            name.strip_suffix(&format!(" {short}={value}")).unwrap_or(name)
        })
    }
}

/// A study, checked and with all its inputs in memory.
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
    /// Layers of outfits as garments, in order.
    pub layers: Vec<GarmentEntry>,
    /// Simulators, in order.
    pub simulators: Vec<Simulator>,
    /// Number of simulations of each combination of garment, size, subject and simulator.
    pub repeats: u32,
    /// Eases at which the fit classes meet.
    pub cuts: Cuts,
}

/// Entries that a study file may name instead of defining them.
#[derive(Clone, Debug, Default)]
pub struct Known {
    /// Subjects of the catalogue.
    pub subjects: BTreeMap<String, Person>,
    /// Fabrics of the catalogue and of the program.
    pub fabrics: BTreeMap<String, Fabric>,
    /// Styles of the catalogue with their sizes.
    pub styles: BTreeMap<String, KnownStyle>,
    /// Entries that were removed but stay stored, such as `subject male-ii`.
    pub hidden: BTreeSet<String>,
}

/// A style of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownStyle {
    /// Seam file; `None` where the patterns hold their own seams.
    pub seams: Option<SourceFile>,
    /// Sizes of the style.
    pub sizes: Vec<KnownSize>,
}

/// A size of a style of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownSize {
    /// Name and pattern.
    pub size: SizeFile,
    /// Unit of the pattern, where its file names none.
    pub unit: Option<String>,
}

/// An entry of a file, with its line.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed<T> {
    /// Path of the file.
    pub file: PathBuf,
    /// Line of the entry, from 1.
    pub line: usize,
    /// Name of the entry.
    pub name: String,
    /// The entry.
    pub entry: T,
}

impl<T> Placed<T> {
    /// Converts the entry; place and name stay.
    pub fn map<U>(self, make: impl FnOnce(T) -> U) -> Placed<U> {
        let Self { file, line, name, entry } = self;
        Placed { file, line, name, entry: make(entry) }
    }

    /// A problem of the entry.
    pub fn problem(&self, message: impl Into<String>) -> Problem {
        Problem::at(&self.file, self.line, message)
    }
}

/// Seams and sizes of a garment: a `[[garment]]` without its fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Sewn {
    /// Seam file; `None` where a file has sizes only.
    pub seams: Option<SourceFile>,
    /// Unit of the patterns, where their files name none.
    pub unit: Option<String>,
    /// Sizes, in order.
    pub sizes: Vec<SizeFile>,
}

/// Path of a study file, from its own path or that of its folder.
#[must_use]
pub fn study_file(path: &Path) -> PathBuf {
    if path.is_dir() { path.join("study.toml") } else { path.to_owned() }
}

impl Study {
    /// Sets limits of each simulation, which replace those of the file.
    pub fn limit(&mut self, limits: Limits) {
        for garment in self.garments.iter_mut().chain(&mut self.layers) {
            garment.schedule.limits = limits.or(garment.schedule.limits);
        }
    }

    /// All garments that have results: those worn alone, then the layers of outfits.
    pub fn worn(&self) -> impl Iterator<Item = &GarmentEntry> {
        self.garments.iter().chain(&self.layers)
    }

    /// Reads and checks a study, by the path of its file or of its folder.
    ///
    /// # Errors
    /// [`StudyError::File`] with all problems; [`StudyError::Io`] when the file itself cannot be read.
    pub fn load(path: &Path, known: &Known) -> Result<Self> {
        let path = study_file(path);
        let text = std::fs::read_to_string(&path).map_err(StudyError::io(&path))?;
        parse::study(&path, &text, known).map_err(StudyError::File)
    }
}

/// Reads the subjects of a text: that of a study file, or of a file with nothing but subjects.
pub fn subjects(path: &Path, text: &str, known: &Known) -> std::result::Result<Vec<Placed<Subject>>, Vec<Problem>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    parse::entries(path, text, |reader, top| {
        reader.hidden.clone_from(&known.hidden);
        subjects::subjects(reader, top, folder, &known.subjects)
    })
}

/// Reads the fabrics of a text: that of a study file, or of a file with nothing but fabrics.
pub fn fabrics(path: &Path, text: &str) -> std::result::Result<Vec<Placed<Fabric>>, Vec<Problem>> {
    parse::entries(path, text, parse::own_fabrics)
}

/// Reads the garments, without their fabrics, of a text: that of a study file, or of a file with nothing but garments.
pub fn garments(path: &Path, text: &str) -> std::result::Result<Vec<Placed<Sewn>>, Vec<Problem>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    parse::entries(path, text, |reader, top| garments::all_sewn(reader, top, folder))
}

/// True if a file's ending is one of measurements and not of a mesh.
pub fn holds_measurements(path: &Path) -> bool {
    ["toml", "smis", "smms", "vit", "vst", "yaml", "yml", "json"]
        .iter()
        .any(|ending| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(ending)))
}

/// Reads measurements from a TOML file with the keys of a `[[subject]]`, or from a file of SeamlyMe, Valentina or
/// GarmentCode. `sex` is used where such a file names none.
///
/// # Errors
/// All problems of the file at once.
pub fn read_measurements(path: &Path, sex: Option<Sex>) -> Result<Measurements> {
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        let text = std::fs::read_to_string(path).map_err(StudyError::io(path))?;
        return parse::measurements_file(path, &text).map_err(StudyError::File);
    }
    let source = SourceFile::read(path)?;
    let in_file = |error| StudyError::refused(Origin::Body, InFile { file: source.name.clone(), source: error });
    body::read_foreign(&source.bytes, sex).map_err(in_file)
}

/// Makes a body from a file of measurements or a mesh; returns it with remarks on guesses. `unit` and `sex` are used
/// where they cannot be inferred from the file.
///
/// # Errors
/// When the file cannot be read, or no body can be made from it.
pub fn read_body(path: &Path, unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<(Body, Vec<String>)> {
    if holds_measurements(path) {
        return Ok((bodies::build_body(&read_measurements(path, sex)?)?, Vec::new()));
    }
    let source = SourceFile::read(path)?;
    let scan = bodies::read_scan(&source, unit, sex)?;
    let notes = scan.imported.notes.clone();
    Ok((bodies::scanned_body(&source, scan)?, notes))
}

/// Reads a fabric from a TOML file with the keys of a `[[fabric]]`.
///
/// # Errors
/// All problems of the file at once.
pub fn read_fabric(path: &Path) -> Result<Fabric> {
    let text = std::fs::read_to_string(path).map_err(StudyError::io(path))?;
    parse::fabric_file(path, &text).map_err(StudyError::File)
}
