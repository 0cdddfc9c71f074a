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
    pub fn dressed(&self) -> Option<Self> {
        let (from, to) = (self.carried_from?, self.person.pose?);
        let name = self.id.strip_suffix(&format!(" {to}")).unwrap_or(&self.id);
        let person = Person { pose: Some(from), ..self.person.clone() };
        Some(Self { id: format!("{name} {from}"), person, carried_from: None })
    }

    /// True if a name is that of the subject, or of the person whom the subject shows in one pose.
    pub fn is_called(&self, name: &str) -> bool {
        let of_pose = || self.person.pose.is_some_and(|pose| self.id == format!("{name} {pose}"));
        self.id == name || of_pose()
    }
}

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Person {
    /// Those taken on the scan, for a scan.
    pub measurements: Measurements,
    /// `None` where the body is built from measurements.
    pub scan: Option<ScanFile>,
    /// `None` for the pose in which the body is built or scanned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// Figures in which the body departs from the standard body of its measurements. Never those of a scan.
    #[serde(default, skip_serializing_if = "Figures::is_empty")]
    pub figures: Figures,
}

impl Person {
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
    /// Infers unit and sex where they are not given.
    pub fn read(self, sex: Option<Sex>) -> Result<ScannedPerson> {
        let found = bodies::whole_scan(&self.file, self.unit, sex)?;
        let of_scan = Person::from(found.girths.measurements(found.sex));
        let person = Person { scan: Some(self), ..of_scan };
        Ok(ScannedPerson { person, notes: found.imported.notes })
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct ScannedPerson {
    pub person: Person,
    /// Remarks on guesses and repairs.
    pub notes: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ScanFile {
    /// OBJ, PLY, STL or GLB.
    pub file: SourceFile,
    /// `None` to infer it from the height.
    pub unit: Option<LengthUnit>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SizeFile {
    pub name: String,
    pub pattern: SourceFile,
}

#[derive(Clone, Debug, PartialEq)]
pub struct GarmentEntry {
    pub name: String,
    /// Wearers by identifier, in order.
    pub subjects: Vec<String>,
    /// `None` where the patterns hold their own seams (GarmentCode JSON).
    pub seams: Option<SourceFile>,
    /// Unit of the patterns, where their files name none: `mm`, `cm`, `in` or `m`.
    pub unit: Option<String>,
    pub fabric: Fabric,
    pub sizes: Vec<SizeFile>,
    /// Name of the garment's style in the catalogue.
    pub style: String,
    /// Edge length of the finest cloth mesh.
    pub edge_length_m: f64,
    pub parameters: Parameters,
    /// Intended ease, which results do not depend on.
    pub target: Target,
    /// Names and values that a sweep gave the garment.
    pub swept: Vec<(String, String)>,
    pub schedule: Schedule,
    /// Outfit of which the garment is a layer, if any.
    pub outfit: Option<WornWith>,
}

/// Place of a garment in an outfit.
#[derive(Clone, Debug, PartialEq)]
pub struct WornWith {
    pub name: String,
    /// Index, the inmost 0.
    pub layer: usize,
    /// All layers as garments of their own. Sizes with the same index in each layer's list are worn together.
    pub layers: Vec<GarmentEntry>,
}

impl GarmentEntry {
    /// Name of the garment in the file, without the values that a sweep appends.
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
    /// Name in the file, or that of its folder.
    pub name: String,
    /// Path of the `study.toml`.
    pub path: PathBuf,
    pub subjects: Vec<Subject>,
    pub garments: Vec<GarmentEntry>,
    /// Layers of outfits as garments, in order.
    pub layers: Vec<GarmentEntry>,
    pub simulators: Vec<Simulator>,
    /// Number of simulations of each combination of garment, size, subject and simulator.
    pub repeats: u32,
    pub cuts: Cuts,
}

/// Entries that a study file may name instead of defining them.
#[derive(Clone, Debug, Default)]
pub struct Known {
    pub subjects: BTreeMap<String, Person>,
    /// Fabrics of the catalogue and of the program.
    pub fabrics: BTreeMap<String, Fabric>,
    pub styles: BTreeMap<String, KnownStyle>,
    /// Entries that were removed but stay stored, such as `subject male-ii`.
    pub hidden: BTreeSet<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct KnownStyle {
    /// `None` where the patterns hold their own seams.
    pub seams: Option<SourceFile>,
    pub sizes: Vec<KnownSize>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct KnownSize {
    pub size: SizeFile,
    /// Unit of the pattern, where its file names none.
    pub unit: Option<String>,
}

/// An entry of a file, with its line.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed<T> {
    pub file: PathBuf,
    /// Counts from 1.
    pub line: usize,
    pub name: String,
    pub entry: T,
}

impl<T> Placed<T> {
    pub fn map<U>(self, make: impl FnOnce(T) -> U) -> Placed<U> {
        let Self { file, line, name, entry } = self;
        Placed { file, line, name, entry: make(entry) }
    }

    pub fn problem(&self, message: impl Into<String>) -> Problem {
        Problem::at(&self.file, self.line, message)
    }
}

/// Seams and sizes of a garment: a `[[garment]]` without its fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Sewn {
    /// `None` where a file has sizes only.
    pub seams: Option<SourceFile>,
    /// Unit of the patterns, where their files name none.
    pub unit: Option<String>,
    pub sizes: Vec<SizeFile>,
}

/// Path of a study file, from its own path or that of its folder.
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

    pub fn load(path: &Path, known: &Known) -> Result<Self> {
        let path = study_file(path);
        let text = std::fs::read_to_string(&path).map_err(StudyError::io(&path))?;
        parse::study(&path, &text, known).map_err(StudyError::File)
    }
}

/// `text` is that of a study file, or of a file with nothing but subjects.
pub fn subjects(path: &Path, text: &str, known: &Known) -> std::result::Result<Vec<Placed<Subject>>, Vec<Problem>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    parse::entries(path, text, |reader, top| {
        reader.hidden.clone_from(&known.hidden);
        subjects::subjects(reader, top, folder, &known.subjects)
    })
}

/// `text` is that of a study file, or of a file with nothing but fabrics.
pub fn fabrics(path: &Path, text: &str) -> std::result::Result<Vec<Placed<Fabric>>, Vec<Problem>> {
    parse::entries(path, text, parse::own_fabrics)
}

/// `text` is that of a study file, or of a file with nothing but garments.
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
pub fn read_body(path: &Path, unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<(Body, Vec<String>)> {
    if holds_measurements(path) {
        return Ok((bodies::build_body(&read_measurements(path, sex)?)?, Vec::new()));
    }
    let source = SourceFile::read(path)?;
    let scan = bodies::read_scan(&source, unit, sex)?;
    let notes = scan.imported.notes.clone();
    Ok((bodies::scanned_body(&source, scan)?, notes))
}

/// Reads TOML with the keys of a `[[fabric]]`.
pub fn read_fabric(path: &Path) -> Result<Fabric> {
    let text = std::fs::read_to_string(path).map_err(StudyError::io(path))?;
    parse::fabric_file(path, &text).map_err(StudyError::File)
}
