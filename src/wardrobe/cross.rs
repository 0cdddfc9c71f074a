//! The study of `toile audit garments`: every garment of a folder on every body of another.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::error::WardrobeError;
use crate::seams::{Asking, proposal};
use body::Measurements;
use fit::Simulator;
use pattern::table::{self, Row};
use spec::bodies;
use spec::file::{holds_measurements, read_measurements};
use spec::new_study::{Outline, Worn};
use spec::patterns::{self, Nest, Unit};
use store::files::SourceFile;
use store::{InOrigin, Origin, Problem, Result, StudyError};

const BODIES: [&str; 9] = ["obj", "ply", "stl", "glb", "toml", "smis", "vit", "yaml", "yml"];

/// Garments and bodies of a study, by their folders.
#[derive(Clone, Debug, PartialEq)]
pub struct Wardrobe {
    pub name: String,
    /// Folder of patterns: DXF, GarmentCode.
    pub garments: PathBuf,
    /// Folder of bodies: meshes, measurements.
    pub bodies: PathBuf,
    /// Table of pairs with the columns `garment` and `body`; without a table every body wears every garment.
    pub pairs: Option<PathBuf>,
    /// Unit of the patterns, where their files name none.
    pub unit: Option<Unit>,
    /// Seam allowance of pieces without a sew line.
    pub allowance_m: f64,
    /// Name of a built-in fabric.
    pub fabric: String,
    pub simulators: Vec<Simulator>,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Opened {
    /// Files of the study: `study.toml`, and a seam file for each pattern that holds no seams.
    pub files: Vec<(String, Vec<u8>)>,
    /// Each with the reason.
    pub refused: Vec<(PathBuf, String)>,
}

/// A body of the study: measurements, or the path of a scan.
enum Wearer {
    Measured(Box<Measurements>),
    Scanned(PathBuf),
}

impl Wardrobe {
    /// Makes the study. Patterns without seams are sewn as proposed. Files that cannot be read or sewn are listed with
    /// the reason.
    pub fn open(&self) -> Result<Opened> {
        let mut opened = Opened::default();
        let bodies = self.wearers(&mut opened)?;
        let mut garments = named(patterns::drawings(&self.garments)?);
        let wearers = self.couples(&garments, &bodies)?;
        garments.retain(|name, _| wearers.contains_key(name));
        garments.retain(|name, path| match self.sewn(name, path, &mut opened.files) {
            Ok(()) => true,
            Err(error) => {
                opened.refused.push((path.clone(), error.to_string()));
                false
            }
        });
        if garments.is_empty() || bodies.is_empty() {
            let reasons = opened.refused.iter().map(|(path, why)| format!("{}: {why}", path.display()));
            let reasons = reasons.collect::<Vec<_>>().join("; ");
            return Err(WardrobeError::NothingToDress { reasons }.into());
        }
        let text = self.text(&garments, &bodies, &wearers, &opened.files)?;
        opened.files.push(("study.toml".to_owned(), text.into_bytes()));
        Ok(opened)
    }

    /// Lists those that cannot be used in `opened`.
    fn wearers(&self, opened: &mut Opened) -> Result<BTreeMap<String, Wearer>> {
        let mut found = BTreeMap::new();
        for (name, path) in named(self.body_files()?) {
            let read = if holds_measurements(&path) {
                read_measurements(&path, None).map(|measured| Wearer::Measured(Box::new(measured)))
            } else {
                let read = SourceFile::read(&path).and_then(|source| bodies::whole_scan(&source, None, None));
                read.and_then(|_| absolute(&path)).map(Wearer::Scanned)
            };
            match read {
                Ok(wearer) => drop(found.insert(name, wearer)),
                Err(error) => opened.refused.push((path, error.to_string())),
            }
        }
        Ok(found)
    }

    fn body_files(&self) -> Result<Vec<PathBuf>> {
        let mut found = Vec::new();
        for entry in std::fs::read_dir(&self.bodies).map_err(StudyError::io(&self.bodies))? {
            let path = entry.map_err(StudyError::io(&self.bodies))?.path();
            let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
            found.extend(ending.is_some_and(|ending| BODIES.contains(&ending.as_str())).then_some(path));
        }
        found.sort();
        if found.is_empty() {
            let error = WardrobeError::NoBody { folder: self.bodies.clone(), accepted: BODIES.join(", ") };
            return Err(error.into());
        }
        Ok(found)
    }

    fn couples(
        &self,
        garments: &BTreeMap<String, PathBuf>,
        bodies: &BTreeMap<String, Wearer>,
    ) -> Result<BTreeMap<String, Vec<String>>> {
        let Some(path) = &self.pairs else {
            let all: Vec<String> = bodies.keys().cloned().collect();
            return Ok(garments.keys().map(|garment| (garment.clone(), all.clone())).collect());
        };
        let mut wearers: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let bytes = std::fs::read(path).map_err(StudyError::io(path))?;
        let refuse = |line: usize, found: String| StudyError::File(vec![Problem::at(path, line, found)]);
        let text = table::text(&bytes).map_err(|line| refuse(line, "bytes that are no UTF-8".to_owned()))?;
        let rows = table::rows(text);
        let (line, head) = rows.first().map_or((1, &[][..]), |row| (row.line, &row.cells[..]));
        let column = |name: &str| {
            let found = head.iter().position(|column| column == name);
            found.ok_or_else(|| refuse(line, format!("no column `{name}`; accepted: the columns garment and body")))
        };
        let (garment_column, body_column) = (column("garment")?, column("body")?);
        let mut problems = Vec::new();
        for Row { line, cells } in rows.iter().skip(1) {
            let mut known = |what, column: usize, names: Vec<&String>| {
                let name = cells.get(column).map_or("", String::as_str);
                if !names.iter().any(|known| *known == name) {
                    let known = names.into_iter().cloned().collect();
                    let missing = StudyError::NotFound { what, name: name.to_owned(), known };
                    problems.push(Problem::at(path, *line, missing.to_string()));
                }
                name.to_owned()
            };
            let garment = known("garment", garment_column, garments.keys().collect());
            let body = known("body", body_column, bodies.keys().collect());
            wearers.entry(garment).or_default().push(body);
        }
        if !problems.is_empty() {
            return Err(StudyError::File(problems));
        }
        Ok(wearers)
    }

    /// Checks that a pattern can be sewn, and adds a seam file for one without seams.
    fn sewn(&self, name: &str, path: &Path, files: &mut Vec<(String, Vec<u8>)>) -> Result<()> {
        let pattern = SourceFile::read(path)?;
        if pattern.holds_seams() {
            return patterns::read_style(&pattern, None, None, self.unit).map(drop);
        }
        let how = Asking { size: None, unit: self.unit, allowance_m: self.allowance_m, answers: &[] };
        let proposal = proposal(&pattern, &how)?.proposal;
        let proposal = proposal.to_drape().origin(Origin::Pattern)?;
        let seams = SourceFile { name: seam_file(name), bytes: proposal.toml(name).into_bytes().into() };
        patterns::read_style(&pattern, Some(&seams), None, self.unit)?;
        files.push((seams.name, seams.bytes.to_vec()));
        Ok(())
    }

    fn text(
        &self,
        garments: &BTreeMap<String, PathBuf>,
        bodies: &BTreeMap<String, Wearer>,
        wearers: &BTreeMap<String, Vec<String>>,
        files: &[(String, Vec<u8>)],
    ) -> Result<String> {
        let mut worn = Vec::new();
        for (name, path) in garments {
            let Some(subjects) = wearers.get(name) else { continue };
            let seams = seam_file(name);
            let nest = Nest::read(&SourceFile::read(path)?, self.unit)?;
            let size = match nest.sample_size() {
                "" => "one",
                size => size,
            };
            worn.push(Worn {
                style: name,
                seams: files.iter().any(|(file, _)| *file == seams).then_some(seams),
                unit: self.unit.map(|unit| unit.as_str().to_owned()),
                subjects: Some(subjects.clone()),
                sizes: vec![(size.to_owned(), absolute(path)?.display().to_string())],
            });
        }
        let mut outline = Outline {
            name: Some(&self.name),
            simulators: &self.simulators,
            known: vec![],
            measured: vec![],
            scanned: vec![],
            garments: worn,
            fabric: &self.fabric,
            fit: None,
            outfits: vec![],
        };
        for (name, wearer) in bodies {
            match wearer {
                Wearer::Measured(measured) => outline.measured.push((name, (**measured).clone())),
                Wearer::Scanned(path) => outline.scanned.push((name, path.display().to_string())),
            }
        }
        Ok(outline.text())
    }
}

/// Path within the study's folder.
fn seam_file(garment: &str) -> String {
    format!("seams/{garment}.seams.toml")
}

fn absolute(path: &Path) -> Result<PathBuf> {
    std::fs::canonicalize(path).map_err(StudyError::io(path))
}

/// Files by their names without endings. Where two files share a name, the names of their folders go before it.
fn named(paths: Vec<PathBuf>) -> BTreeMap<String, PathBuf> {
    let mut found: BTreeMap<String, PathBuf> = BTreeMap::new();
    for path in paths {
        let word = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let mut name = word(path.file_stem());
        for folder in path.ancestors().skip(1) {
            if !found.contains_key(&name) {
                break;
            }
            name = format!("{}-{name}", word(folder.file_name()));
        }
        found.insert(name, path);
    }
    found
}
