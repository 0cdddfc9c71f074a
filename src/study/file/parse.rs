//! From the text of a study file to a [`Study`], or to everything that is wrong with it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toml::Spanned;
use toml::de::DeTable;

use super::super::catalogue::{Entry, keys, sex};
use super::super::error::nearest;
use super::reader::{Place, Reader};
use super::{GarmentEntry, Known, Placed, Problem, Sewn, SizeFile, SourceFile, Study, Subject};
use crate::body::Measurements;
use crate::fit::Cuts;
use crate::fit::Simulator;
use crate::sim::Fabric;
use crate::units::{from_mm, mm};

const STUDY_KEYS: [&str; 8] =
    ["name", "simulators", "edge_length_mm", "repeats", "fit", "subject", "garment", "fabric"];
const GARMENT_KEYS: [&str; 5] = ["name", "seams", "unit", "fabric", "sizes"];
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
        edge_length_m: from_mm(reader.number(&top, "edge_length_mm", 2.0..=100.0).unwrap_or(15.0)),
        repeats: reader.number(&top, "repeats", 1.0..=100.0).unwrap_or(1.0) as u32,
        cuts: cuts(&mut reader, &top),
        subjects: subjects(&mut reader, &top, &known.subjects).into_iter().map(|placed| placed.entry).collect(),
        garments: garments(&mut reader, &top, folder, &fabrics),
    };
    if study.subjects.is_empty() && !top.table.contains_key("subject") {
        reader.missing(&top, "subject", "at least one [[subject]]");
    }
    reader.end(study)
}

/// Entries of one kind from the text of a file with tables like those of a study file.
pub(super) fn entries<T>(
    path: &Path,
    text: &str,
    read: impl FnOnce(&mut Reader<'_>, &Place<'_>) -> Vec<Placed<T>>,
) -> Result<Vec<Placed<T>>, Vec<Problem>> {
    let (mut reader, document) = open(path, text)?;
    let top = Place { name: "file".into(), span: 0..0, table: document.get_ref() };
    reader.only(&top, &STUDY_KEYS);
    let entries = read(&mut reader, &top);
    reader.end(entries)
}

/// Checks the text of a file with one subject's measurements.
pub(super) fn measurements_file(path: &Path, text: &str) -> Result<Measurements, Vec<Problem>> {
    let (mut reader, document) = open(path, text)?;
    let top = Place { name: "measurements".into(), span: 0..0, table: document.get_ref() };
    reader.only(&top, &keys::<Measurements>());
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
    let mut cut = |key, otherwise: f64| reader.number(&place, key, -500.0..=1000.0).map_or(otherwise, from_mm);
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

pub(super) fn subjects(
    reader: &mut Reader<'_>,
    top: &Place<'_>,
    known: &BTreeMap<String, Measurements>,
) -> Vec<Placed<Subject>> {
    let accepted = [&["id", "like"], &keys::<Measurements>()[..]].concat();
    let mut subjects = Vec::new();
    let mut ids = BTreeSet::new();
    for mut place in reader.tables(top, "subject", "subject") {
        reader.only(&place, &accepted);
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
        subjects.extend(measurements.map(|measurements| {
            let subject = Subject { id: (*id.get_ref()).to_owned(), measurements };
            reader.placed(&id.span(), id.get_ref(), subject)
        }));
    }
    subjects
}

fn measurements(reader: &mut Reader<'_>, place: &Place<'_>) -> Option<Measurements> {
    let word = reader.need_text(place, "sex", "\"male\" or \"female\", or name a catalogue entry with `like`");
    let sex = word.and_then(|word| {
        let sex = sex(word.get_ref());
        sex.map_err(|problem| reader.problem(&word.span(), format!("{}: {problem}", place.name))).ok()
    });
    let measurements = numbers(reader, place, Measurements::blank(""), "millimetres, as in `toile subject ls`");
    Some(Measurements { sex: sex?, ..measurements? })
}

/// Reads the numbers of an entry over a blank one; `None` where one is wrong or missing.
fn numbers<T: Entry>(reader: &mut Reader<'_>, place: &Place<'_>, mut entry: T, wanted: &str) -> Option<T> {
    let before = reader.problems.len();
    for field in T::fields() {
        if place.table.contains_key(field.key) {
            let number = reader.checked(place, field.key, |number| field.check(number));
            field.set(&mut entry, number);
        } else if field.is_required {
            reader.missing(place, field.key, wanted);
        }
    }
    (reader.problems.len() == before).then_some(entry)
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
        let name = named(reader, &mut place, &mut names);
        if !place.table.contains_key("seams") {
            reader.missing(&place, "seams", "the file that says how its pieces are sewn");
        }
        let Sewn { seams, unit, sizes } = sewn(reader, &place, folder);
        let fabric = reader.need_text(&place, "fabric", "the name of a fabric");
        let fabric = fabric.and_then(|name| lookup(reader, fabrics, &name, "fabric").cloned());
        if let (Some(name), Some(seams), Some(fabric)) = (name, seams, fabric) {
            garments.push(GarmentEntry { name: (*name.get_ref()).to_owned(), seams, unit, fabric, sizes });
        }
    }
    garments
}

/// All garments without their cloth.
pub(super) fn all_sewn(reader: &mut Reader<'_>, top: &Place<'_>, folder: &Path) -> Vec<Placed<Sewn>> {
    let mut garments = Vec::new();
    let mut names = BTreeSet::new();
    for mut place in reader.tables(top, "garment", "garment") {
        let name = named(reader, &mut place, &mut names);
        let sewn = sewn(reader, &place, folder);
        garments.extend(name.map(|name| reader.placed(&name.span(), name.get_ref(), sewn)));
    }
    garments
}

/// The name of a garment, which its place then bears.
fn named<'t>(
    reader: &mut Reader<'_>,
    place: &mut Place<'t>,
    names: &mut BTreeSet<&'t str>,
) -> Option<Spanned<&'t str>> {
    reader.only(place, &GARMENT_KEYS);
    let name = reader.need_text(place, "name", "its name in results")?;
    unique(reader, names, &name, "garment");
    place.name = format!("garment {}", name.get_ref());
    Some(name)
}

fn sewn(reader: &mut Reader<'_>, place: &Place<'_>, folder: &Path) -> Sewn {
    let seams = reader.text(place, "seams").and_then(|file| source(reader, place, &file, folder));
    Sewn { seams, unit: unit(reader, place), sizes: sizes(reader, place, folder) }
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
    fabrics.extend(own_fabrics(reader, top).into_iter().map(|placed| (placed.name, placed.entry)));
    fabrics
}

/// The fabrics of the file itself.
pub(super) fn own_fabrics(reader: &mut Reader<'_>, top: &Place<'_>) -> Vec<Placed<Fabric>> {
    let accepted = [&["name"], &keys::<Fabric>()[..]].concat();
    let mut fabrics = Vec::new();
    let mut names = BTreeSet::new();
    for mut place in reader.tables(top, "fabric", "fabric") {
        reader.only(&place, &accepted);
        let Some(name) = reader.need_text(&place, "name", "its name") else { continue };
        unique(reader, &mut names, &name, "fabric");
        place.name = format!("fabric {}", name.get_ref());
        let source = reader.text(&place, "source").map_or("study file", Spanned::into_inner).to_owned();
        let blank = Fabric { source, ..Fabric::blank(name.get_ref()) };
        let fabric = numbers(reader, &place, blank, "a number, SI units as in the library (`toile fabric ls`)");
        fabrics.extend(fabric.map(|fabric| reader.placed(&name.span(), name.get_ref(), fabric)));
    }
    fabrics
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
