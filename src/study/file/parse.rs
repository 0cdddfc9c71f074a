//! From the text of a study file to a [`Study`], or to everything that is wrong with it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toml::Spanned;
use toml::de::DeTable;

use super::super::error::{StudyError, nearest};
use super::super::tools::read_scan;
use super::reader::{Place, Reader};
use super::{GarmentEntry, Known, Problem, ScanFile, SizeFile, SourceFile, Study, Subject};
use crate::body::{Dimension, LengthUnit, Measurements, Sex};
use crate::fit::Cuts;
use crate::fit::Simulator;
use crate::sim::Fabric;
use crate::units::{from_mm, mm};

const STUDY_KEYS: [&str; 8] =
    ["name", "simulators", "edge_length_mm", "repeats", "fit", "subject", "garment", "fabric"];
/// Keys of a subject: who it is, where it comes from, and the measurements by which it is known.
const SUBJECT_KEYS: [&str; 5 + Dimension::ALL.len()] = {
    let mut keys = [""; 5 + Dimension::ALL.len()];
    (keys[0], keys[1], keys[2], keys[3], keys[4]) = ("id", "like", "scan", "unit", "sex");
    let mut i = 5;
    while i < keys.len() {
        keys[i] = Dimension::ALL[i - 5].key();
        i += 1;
    }
    keys
};
const GARMENT_KEYS: [&str; 6] = ["name", "subjects", "seams", "unit", "fabric", "sizes"];
const FABRIC_KEYS: [&str; 12] = [
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
    let subjects = subjects(&mut reader, &top, folder, &known.subjects);
    let study = Study {
        name,
        path: path.to_owned(),
        simulators: simulators(&mut reader, &top),
        edge_length_m: from_mm(reader.number(&top, "edge_length_mm", 2.0..100.0).unwrap_or(15.0)),
        repeats: reader.number(&top, "repeats", 1.0..100.0).unwrap_or(1.0) as u32,
        cuts: cuts(&mut reader, &top),
        garments: garments(&mut reader, &top, folder, &subjects, &fabrics),
        subjects,
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
    reader.only(&top, &SUBJECT_KEYS[4..]);
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

fn subjects(
    reader: &mut Reader<'_>,
    top: &Place<'_>,
    folder: &Path,
    known: &BTreeMap<String, Measurements>,
) -> Vec<Subject> {
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
        let found = match (reader.text(&place, "like"), reader.text(&place, "scan")) {
            (Some(name), _) => {
                alone(reader, &place, &["id", "like"]);
                lookup(reader, known, &name, "subject in the catalogue").cloned().map(|known| (known, None))
            }
            (None, Some(file)) => {
                alone(reader, &place, &["id", "scan", "sex", "unit"]);
                scanned(reader, &place, &file, folder).map(|(measurements, scan)| (measurements, Some(scan)))
            }
            (None, None) => measurements(reader, &place).map(|measurements| (measurements, None)),
        };
        let id = (*id.get_ref()).to_owned();
        subjects.extend(found.map(|(measurements, scan)| Subject { id, measurements, scan }));
    }
    subjects
}

/// Refuses keys beside those of a subject that is named or scanned.
fn alone(reader: &mut Reader<'_>, place: &Place<'_>, accepted: &[&str]) {
    if let Some(key) = place.table.keys().find(|key| !accepted.contains(&key.get_ref().as_ref())) {
        let message = format!("{}: `{}` beside `{}`; give one or the other", place.name, key.get_ref(), accepted[1]);
        reader.problem(&key.span(), message);
    }
}

/// A scan beside the study file, and what is measured on it.
fn scanned(
    reader: &mut Reader<'_>,
    place: &Place<'_>,
    file: &Spanned<&str>,
    folder: &Path,
) -> Option<(Measurements, ScanFile)> {
    let sex = reader.text(place, "sex").and_then(|text| sex(reader, place, &text));
    let unit = reader.text(place, "unit").and_then(|text| {
        let unit = LengthUnit::ALL.into_iter().find(|unit| unit.name() == *text.get_ref());
        if unit.is_none() {
            let accepted = LengthUnit::ALL.map(LengthUnit::name).join(", ");
            reader.problem(&text.span(), format!("{}: unit `{}`; accepted: {accepted}", place.name, text.get_ref()));
        }
        unit
    });
    let scan = ScanFile { file: source(reader, place, file, folder, SourceFile::read)?, unit };
    match read_scan(&scan.file, unit, sex) {
        Ok(found) => Some((found.girths.measurements(found.sex), scan)),
        Err(error) => {
            reader.problem(&file.span(), format!("{}: {error}", place.name));
            None
        }
    }
}

fn sex(reader: &mut Reader<'_>, place: &Place<'_>, text: &Spanned<&str>) -> Option<Sex> {
    match *text.get_ref() {
        "male" | "m" | "M" => Some(Sex::Male),
        "female" | "f" | "F" => Some(Sex::Female),
        other => {
            reader.problem(&text.span(), format!("{}: sex `{other}`; accepted: male, female", place.name));
            None
        }
    }
}

fn measurements(reader: &mut Reader<'_>, place: &Place<'_>) -> Option<Measurements> {
    let wanted = "\"male\" or \"female\", or name a catalogue entry with `like`";
    let sex = reader.need_text(place, "sex", wanted).and_then(|text| sex(reader, place, &text));
    if !place.table.contains_key("stature_mm") {
        reader.missing(place, "stature_mm", "the stature in millimetres");
    }
    let stature_m = reader.number(place, "stature_mm", 500.0..2600.0).map(from_mm);
    let others = Dimension::ALL.into_iter().filter(|dimension| *dimension != Dimension::Stature);
    let range = |dimension| if dimension == Dimension::Weight { 10.0..400.0 } else { GIRTH_MM };
    let known: Vec<(Dimension, f64)> = others
        .filter_map(|dimension| Some((dimension, reader.number(place, dimension.key(), range(dimension))?)))
        .collect();
    let mut measurements = Measurements::of(sex?, stature_m?);
    for (dimension, value) in known {
        measurements.set(dimension, value / dimension.per_si());
    }
    Some(measurements)
}

fn garments(
    reader: &mut Reader<'_>,
    top: &Place<'_>,
    folder: &Path,
    subjects: &[Subject],
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
        let subjects = wearers(reader, &place, top, subjects);
        let sizes = sizes(reader, &place, folder);
        let seams = seams(reader, &place, folder, &sizes);
        let fabric = reader.need_text(&place, "fabric", "the name of a fabric");
        let fabric = fabric.and_then(|name| lookup(reader, fabrics, &name, "fabric").cloned());
        let unit = unit(reader, &place);
        if let (Some(name), Some(fabric)) = (name, fabric) {
            garments.push(GarmentEntry { name: (*name.get_ref()).to_owned(), subjects, seams, unit, fabric, sizes });
        }
    }
    garments
}

/// Who wears a garment: the subjects it names, or else all of the file.
fn wearers(reader: &mut Reader<'_>, garment: &Place<'_>, top: &Place<'_>, subjects: &[Subject]) -> Vec<String> {
    let Some(names) = reader.texts(garment, "subjects") else {
        return subjects.iter().map(|subject| subject.id.clone()).collect();
    };
    // Subjects that are in the file but wrong are told of once, at their own place.
    let known: BTreeMap<String, ()> = reader
        .tables(top, "subject", "subject")
        .iter()
        .filter_map(|place| place.table.get("id")?.get_ref().as_str().map(|id| (id.to_owned(), ())))
        .collect();
    let mut wearers: Vec<String> = Vec::new();
    for name in &names {
        if wearers.iter().any(|wearer| wearer == name.get_ref()) {
            reader.problem(&name.span(), format!("{}: subject `{}` is named twice", garment.name, name.get_ref()));
        } else if lookup(reader, &known, name, "[[subject]] with the id").is_some() {
            wearers.push((*name.get_ref()).to_owned());
        }
    }
    if names.is_empty() {
        let span = garment.table.get("subjects").map_or(garment.span.clone(), Spanned::span);
        let message = format!("{}: nobody wears it; name subjects, or leave `subjects` out for all", garment.name);
        reader.problem(&span, message);
    }
    wearers
}

/// The seam file, which only patterns without seams of their own need.
fn seams(reader: &mut Reader<'_>, garment: &Place<'_>, folder: &Path, sizes: &[SizeFile]) -> Option<SourceFile> {
    let holds_seams = !sizes.is_empty() && sizes.iter().all(|size| size.pattern.holds_seams());
    if holds_seams && !garment.table.contains_key("seams") {
        return None;
    }
    let file = reader.need_text(garment, "seams", "the file that says how its pieces are sewn")?;
    source(reader, garment, &file, folder, SourceFile::read)
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
        let pattern = reader.need_text(&place, "pattern", "its DXF file, folder of DXF files, or GarmentCode JSON");
        let pattern = pattern.and_then(|file| source(reader, &place, &file, folder, SourceFile::read_pattern));
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
    })
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
fn source(
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

/// Names of the files in a folder, sorted.
fn file_names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
