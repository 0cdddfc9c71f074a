//! From the text of a study file to a [`Study`], or to everything that is wrong with it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toml::Spanned;
use toml::de::DeTable;

use super::super::error::nearest;
use super::reader::{Place, Reader};
use super::{GarmentEntry, Known, Problem, SizeFile, SourceFile, Study, Subject};
use crate::body::{Measurements, Sex};
use crate::fit::Cuts;
use crate::fit::Simulator;
use crate::sim::Fabric;
use crate::sim::fabric::Stretched;
use crate::units::{from_mm, mm};

const STUDY_KEYS: [&str; 8] =
    ["name", "simulators", "edge_length_mm", "repeats", "fit", "subject", "garment", "fabric"];
const SUBJECT_KEYS: [&str; 10] = [
    "id",
    "like",
    "sex",
    "stature_mm",
    "weight_kg",
    "chest_girth_mm",
    "waist_girth_mm",
    "hip_girth_mm",
    "neck_girth_mm",
    "across_shoulder_mm",
];
const GARMENT_KEYS: [&str; 5] = ["name", "seams", "unit", "fabric", "sizes"];
const FABRIC_KEYS: [&str; 15] = [
    "name",
    "density_kg_m2",
    "thickness_mm",
    "membrane_warp_n_m",
    "membrane_weft_n_m",
    "membrane_coupling_n_m",
    "shear_n_m",
    "bending_warp_nm",
    "bending_weft_nm",
    "friction_body",
    "friction_self",
    "source",
    "stretch_pct",
    "stretched_warp_n_m",
    "stretched_weft_n_m",
];

/// Plausible girths and widths of a person, mm.
const GIRTH_MM: std::ops::Range<f64> = 100.0..3000.0;

/// Checks the text of a study file; files it names are looked up beside it.
pub(super) fn study(path: &Path, text: &str, known: &Known) -> Result<Study, Vec<Problem>> {
    let (mut reader, document) = open(path, text)?;
    let top = Place { name: "study".into(), span: 0..0, table: document.get_ref() };
    reader.only(&top, &STUDY_KEYS);

    let folder = path.parent().unwrap_or(Path::new(""));
    let name = match reader.text(&top, "name") {
        Some(name) => name.into_inner().to_owned(),
        None => folder_name(folder),
    };
    let fabrics = fabrics(&mut reader, &top, &known.fabrics);
    let study = Study {
        name,
        path: path.to_owned(),
        simulators: simulators(&mut reader, &top),
        edge_length_m: from_mm(reader.number(&top, "edge_length_mm", 2.0..100.0).unwrap_or(15.0)),
        repeats: reader.number(&top, "repeats", 1.0..100.0).unwrap_or(1.0) as u32,
        cuts: cuts(&mut reader, &top),
        subjects: subjects(&mut reader, &top, &known.subjects),
        garments: garments(&mut reader, &top, folder, &fabrics),
    };
    if reader.problems.is_empty() {
        return Ok(study);
    }
    reader.problems.sort_by_key(|problem| problem.line);
    Err(reader.problems)
}

/// Checks the text of a file with one subject's measurements.
pub(super) fn measurements_file(path: &Path, text: &str) -> Result<Measurements, Vec<Problem>> {
    let (mut reader, document) = open(path, text)?;
    let top = Place { name: "measurements".into(), span: 0..0, table: document.get_ref() };
    reader.only(&top, &SUBJECT_KEYS[2..]);
    match measurements(&mut reader, &top) {
        Some(measurements) if reader.problems.is_empty() => Ok(measurements),
        _ => Err(reader.problems),
    }
}

/// Parses TOML; where it is broken only that is told, since all else would follow from it.
fn open<'t>(path: &'t Path, text: &'t str) -> Result<(Reader<'t>, Spanned<DeTable<'t>>), Vec<Problem>> {
    let mut reader = Reader::new(path, text);
    let (document, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        reader.problem(&error.span().unwrap_or_default(), error.message());
    }
    if reader.problems.is_empty() { Ok((reader, document)) } else { Err(reader.problems) }
}

/// Name of the folder a study lies in.
fn folder_name(folder: &Path) -> String {
    let full = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    full.file_name().map_or_else(|| "study".into(), |name| name.to_string_lossy().into_owned())
}

fn simulators(reader: &mut Reader<'_>, top: &Place<'_>) -> Vec<Simulator> {
    let Some(names) = reader.texts(top, "simulators") else { return vec![Simulator::Fem] };
    let mut simulators = Vec::new();
    for name in names {
        match super::super::pipeline::SIMULATORS.into_iter().find(|sim| sim.as_str() == *name.get_ref()) {
            Some(simulator) if !simulators.contains(&simulator) => simulators.push(simulator),
            Some(_) => reader.problem(&name.span(), format!("simulator `{}` is named twice", name.get_ref())),
            None => {
                let accepted = super::super::pipeline::SIMULATORS.map(Simulator::as_str).join(", ");
                reader.problem(&name.span(), format!("no simulator `{}`; accepted: {accepted}", name.get_ref()));
            }
        }
    }
    simulators
}

fn cuts(reader: &mut Reader<'_>, top: &Place<'_>) -> Cuts {
    let default = Cuts::default();
    let Some(value) = top.table.get("fit") else { return default };
    let Some(table) = value.get_ref().as_table() else {
        reader.problem(&value.span(), "study: `fit` is a table with tight_below_mm and loose_above_mm");
        return default;
    };
    let place = Place { name: "fit".into(), span: value.span(), table };
    reader.only(&place, &["tight_below_mm", "loose_above_mm"]);
    let mut cut = |key, otherwise: f64| reader.number(&place, key, -500.0..1000.0).map_or(otherwise, from_mm);
    let cuts = Cuts {
        tight_below_m: cut("tight_below_mm", default.tight_below_m),
        loose_above_m: cut("loose_above_mm", default.loose_above_m),
    };
    if cuts.tight_below_m > cuts.loose_above_m {
        let (tight, loose) = (mm(cuts.tight_below_m), mm(cuts.loose_above_m));
        let message = format!("fit: tight_below_mm is {tight}, above loose_above_mm, {loose}; it must not be greater");
        reader.problem(&place.span, message);
    }
    cuts
}

fn subjects(reader: &mut Reader<'_>, top: &Place<'_>, known: &BTreeMap<String, Measurements>) -> Vec<Subject> {
    let places = reader.tables(top, "subject", "subject");
    if places.is_empty() {
        reader.missing(top, "subject", "at least one [[subject]]");
    }
    let mut subjects = Vec::new();
    let mut ids = BTreeSet::new();
    for mut place in places {
        reader.only(&place, &SUBJECT_KEYS);
        let Some(id) = reader.need_text(&place, "id", "its name in results") else { continue };
        unique(reader, &mut ids, &id, "subject");
        place.name = format!("subject {}", id.get_ref());
        let measurements = match reader.text(&place, "like") {
            Some(name) => {
                let own = place.table.keys().find(|key| !["id", "like"].contains(&key.get_ref().as_ref()));
                if let Some(key) = own {
                    let message = format!("{}: `{}` beside `like`; give one or the other", place.name, key.get_ref());
                    reader.problem(&key.span(), message);
                }
                lookup(reader, known, &name, "subject in the catalogue").cloned()
            }
            None => measurements(reader, &place),
        };
        subjects.extend(measurements.map(|measurements| Subject { id: (*id.get_ref()).to_owned(), measurements }));
    }
    subjects
}

fn measurements(reader: &mut Reader<'_>, place: &Place<'_>) -> Option<Measurements> {
    let sex = match reader.need_text(place, "sex", "\"male\" or \"female\", or name a catalogue entry with `like`") {
        Some(text) => match *text.get_ref() {
            "male" | "m" | "M" => Some(Sex::Male),
            "female" | "f" | "F" => Some(Sex::Female),
            other => {
                reader.problem(&text.span(), format!("{}: sex `{other}`; accepted: male, female", place.name));
                None
            }
        },
        None => None,
    };
    if !place.table.contains_key("stature_mm") {
        reader.missing(place, "stature_mm", "the stature in millimetres");
    }
    let stature_m = reader.number(place, "stature_mm", 500.0..2600.0).map(from_mm);
    let weight_kg = reader.number(place, "weight_kg", 10.0..400.0);
    let mut girth = |key| reader.number(place, key, GIRTH_MM).map(from_mm);
    let [chest_girth_m, waist_girth_m, hip_girth_m, neck_girth_m, across_shoulder_m] =
        ["chest_girth_mm", "waist_girth_mm", "hip_girth_mm", "neck_girth_mm", "across_shoulder_mm"].map(&mut girth);
    Some(Measurements {
        sex: sex?,
        stature_m: stature_m?,
        weight_kg,
        chest_girth_m,
        waist_girth_m,
        hip_girth_m,
        neck_girth_m,
        across_shoulder_m,
    })
}

fn garments(
    reader: &mut Reader<'_>,
    top: &Place<'_>,
    folder: &Path,
    fabrics: &BTreeMap<String, Fabric>,
) -> Vec<GarmentEntry> {
    let places = reader.tables(top, "garment", "garment");
    if places.is_empty() {
        reader.missing(top, "garment", "at least one [[garment]]");
    }
    let mut garments = Vec::new();
    let mut names = BTreeSet::new();
    for mut place in places {
        reader.only(&place, &GARMENT_KEYS);
        let name = reader.need_text(&place, "name", "its name in results");
        if let Some(name) = &name {
            unique(reader, &mut names, name, "garment");
            place.name = format!("garment {}", name.get_ref());
        }
        let seams = reader.need_text(&place, "seams", "the file that says how its pieces are sewn");
        let seams = seams.and_then(|file| source(reader, &place, &file, folder));
        let fabric = reader.need_text(&place, "fabric", "the name of a fabric");
        let fabric = fabric.and_then(|name| lookup(reader, fabrics, &name, "fabric").cloned());
        let unit = unit(reader, &place);
        let sizes = sizes(reader, &place, folder);
        if let (Some(name), Some(seams), Some(fabric)) = (name, seams, fabric) {
            garments.push(GarmentEntry { name: (*name.get_ref()).to_owned(), seams, unit, fabric, sizes });
        }
    }
    garments
}

fn unit(reader: &mut Reader<'_>, place: &Place<'_>) -> Option<String> {
    let unit = reader.text(place, "unit")?;
    if !["mm", "cm", "in"].contains(unit.get_ref()) {
        let message = format!("{}: unit `{}`; accepted: mm, cm, in", place.name, unit.get_ref());
        reader.problem(&unit.span(), message);
        return None;
    }
    Some(unit.into_inner().to_owned())
}

fn sizes(reader: &mut Reader<'_>, garment: &Place<'_>, folder: &Path) -> Vec<SizeFile> {
    let places = reader.tables(garment, "sizes", "size");
    if places.is_empty() {
        reader.missing(garment, "sizes", "a list like [{ name = \"S\", pattern = \"s.dxf\" }]");
    }
    let mut sizes = Vec::new();
    let mut names = BTreeSet::new();
    for mut place in places {
        place.name = format!("{}, {}", garment.name, place.name);
        reader.only(&place, &["name", "pattern"]);
        let name = reader.need_text(&place, "name", "the size's name");
        let pattern = reader.need_text(&place, "pattern", "its DXF file");
        let pattern = pattern.and_then(|file| source(reader, &place, &file, folder));
        if let Some(name) = name {
            unique(reader, &mut names, &name, "size");
            sizes.extend(pattern.map(|pattern| SizeFile { name: (*name.get_ref()).to_owned(), pattern }));
        }
    }
    sizes
}

/// The known fabrics and those of the file itself, which win.
fn fabrics(reader: &mut Reader<'_>, top: &Place<'_>, known: &BTreeMap<String, Fabric>) -> BTreeMap<String, Fabric> {
    let mut fabrics = known.clone();
    let mut names = BTreeSet::new();
    for mut place in reader.tables(top, "fabric", "fabric") {
        reader.only(&place, &FABRIC_KEYS);
        let Some(name) = reader.need_text(&place, "name", "its name") else { continue };
        unique(reader, &mut names, &name, "fabric");
        place.name = format!("fabric {}", name.get_ref());
        if let Some(fabric) = fabric(reader, &place, name.get_ref()) {
            fabrics.insert(fabric.name.clone(), fabric);
        }
    }
    fabrics
}

fn fabric(reader: &mut Reader<'_>, place: &Place<'_>, name: &str) -> Option<Fabric> {
    let mut need = |key, range| {
        if !place.table.contains_key(key) {
            reader.missing(place, key, "a number, SI units as in the library (`toile fabric ls`)");
        }
        reader.number(place, key, range)
    };
    let density_kg_m2 = need("density_kg_m2", 0.005..5.0);
    let thickness_mm = need("thickness_mm", 0.01..20.0);
    let [warp, weft] = ["membrane_warp_n_m", "membrane_weft_n_m"].map(|key| need(key, 1.0..1e6));
    let shear_n_m = need("shear_n_m", 0.1..1e6);
    let [bend_warp, bend_weft] = ["bending_warp_nm", "bending_weft_nm"].map(|key| need(key, 1e-9..1e-1));
    let [friction_body, friction_self] = ["friction_body", "friction_self"].map(|key| need(key, 0.0..5.0));
    let coupling = reader.number(place, "membrane_coupling_n_m", 0.0..1e6).unwrap_or(0.0);
    let stretched = stretched(reader, place);
    let source = reader.text(place, "source").map_or("study file", Spanned::into_inner).to_owned();
    Some(Fabric {
        name: name.to_owned(),
        density_kg_m2: density_kg_m2?,
        thickness_m: from_mm(thickness_mm?),
        membrane_warp_n_m: warp?,
        membrane_weft_n_m: weft?,
        membrane_coupling_n_m: coupling,
        shear_n_m: shear_n_m?,
        bending_warp_nm: bend_warp?,
        bending_weft_nm: bend_weft?,
        friction_body: friction_body?,
        friction_self: friction_self?,
        source,
        stretched,
    })
}

/// The moduli of a knit under stretch: three keys or none.
fn stretched(reader: &mut Reader<'_>, place: &Place<'_>) -> Option<Stretched> {
    let keys = ["stretch_pct", "stretched_warp_n_m", "stretched_weft_n_m"];
    if !keys.iter().any(|key| place.table.contains_key(*key)) {
        return None;
    }
    for key in keys.iter().filter(|key| !place.table.contains_key(**key)) {
        reader.missing(place, key, "a number: a law that stiffens has its stretch and both secant moduli there");
    }
    let stretch_pct = reader.number(place, keys[0], 1.0..200.0);
    let [warp, weft] = [keys[1], keys[2]].map(|key| reader.number(place, key, 1.0..1e6));
    Some(Stretched { stretch: stretch_pct? / 100.0, membrane_warp_n_m: warp?, membrane_weft_n_m: weft? })
}

/// Refuses a second entry of the same name.
fn unique<'t>(reader: &mut Reader<'_>, names: &mut BTreeSet<&'t str>, name: &Spanned<&'t str>, what: &str) {
    if !names.insert(name.get_ref()) {
        reader.problem(&name.span(), format!("{what} `{}` is there twice; names must differ", name.get_ref()));
    }
}

/// An entry by name; a problem with a suggestion where there is none.
fn lookup<'k, T>(
    reader: &mut Reader<'_>,
    known: &'k BTreeMap<String, T>,
    name: &Spanned<&str>,
    what: &str,
) -> Option<&'k T> {
    let found = known.get(*name.get_ref());
    if found.is_none() {
        let hint = match nearest(name.get_ref(), known.keys().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are: {}", known.keys().cloned().collect::<Vec<_>>().join(", ")),
        };
        reader.problem(&name.span(), format!("no {what} `{}`; {hint}", name.get_ref()));
    }
    found
}

/// A file beside the study file; a problem with a suggestion where it cannot be read.
fn source(reader: &mut Reader<'_>, place: &Place<'_>, file: &Spanned<&str>, folder: &Path) -> Option<SourceFile> {
    let path = folder.join(file.get_ref());
    match SourceFile::read(&path) {
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

/// Names of the files in a folder, sorted.
fn file_names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
