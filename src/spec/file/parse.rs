//! Reads the text of a study file into a [`Study`], or into all of its problems.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toml::Spanned;
use toml::de::DeTable;

use crate::entry::{Entry, keys};
use crate::file::garments::{Common, garments};
use crate::file::outfits::outfits;
use crate::file::reader::{Place, Reader};
use crate::file::subjects::{measurements, subjects};
use crate::file::values::{numbers, unique};
use crate::file::{Known, Placed, Study, Subject, schedule, sweep};
use body::Measurements;
use fit::{Cuts, Simulator};
use geom::units::{from_mm, mm};
use sim::Fabric;
use store::Problem;
use store::files::check_study_name;

const STUDY_KEYS: [&str; 13] = [
    "name",
    "simulators",
    "edge_length_mm",
    "repeats",
    "fit",
    "subject",
    "garment",
    "outfit",
    "fabric",
    "parameters",
    "sweep",
    "time_limit_s",
    "memory_limit_mb",
];

/// Paths in the text begin at the file's folder.
pub(super) fn study(path: &Path, text: &str, known: &Known) -> Result<Study, Vec<Problem>> {
    let (mut reader, document) = open(path, text)?;
    reader.hidden.clone_from(&known.hidden);
    let top = Place { name: "study".into(), span: 0..0, table: document.get_ref() };
    reader.only(&top, &STUDY_KEYS);

    let folder = path.parent().unwrap_or(Path::new(""));
    let name = match reader.text(&top, "name") {
        Some(name) => {
            if let Err(accepted) = check_study_name(name.get_ref()) {
                reader.problem(&name.span(), format!("study: `name` is {:?}; {accepted}", name.get_ref()));
            }
            name.into_inner().to_owned()
        }
        None => folder_name(folder),
    };
    let fabrics = fabrics(&mut reader, &top, &known.fabrics);
    let subjects = subjects(&mut reader, &top, folder, &known.subjects);
    let subjects: Vec<Subject> = subjects.into_iter().map(|placed| placed.entry).collect();
    let common = Common {
        folder,
        fabrics: &fabrics,
        styles: &known.styles,
        edge_length_m: from_mm(reader.number(&top, "edge_length_mm", sweep::EDGE_MM).unwrap_or(15.0)),
        parameters: sweep::parameters(&mut reader, &top),
        limits: schedule::limits(&mut reader, &top),
    };
    let worn = garments(&mut reader, &top, &common, &subjects);
    let garments = schedule::after_swept(sweep::swept(&mut reader, &top, worn, &fabrics));
    let study = Study {
        name,
        path: path.to_owned(),
        simulators: simulators(&mut reader, &top),
        repeats: reader.number(&top, "repeats", 1.0..=100.0).unwrap_or(1.0) as u32,
        cuts: cuts(&mut reader, &top),
        layers: outfits(&mut reader, &top, &garments),
        garments,
        subjects,
    };
    if study.subjects.is_empty() && !top.table.contains_key("subject") {
        reader.missing(&top, "subject", "at least one [[subject]]");
    }
    reader.end(study)
}

/// Reads entries of one kind from the text of a file with the tables of a study file.
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

/// Reads the one entry of a file: its table `[[key]]`, or the whole file where it has no such header.
fn sole<'t, T>(
    path: &'t Path,
    text: &'t str,
    key: &str,
    read: impl FnOnce(&mut Reader<'_>, Place<'_>) -> Option<T>,
) -> Result<T, Vec<Problem>> {
    let (mut reader, document) = open(path, text)?;
    let top = Place { name: key.to_owned(), span: 0..0, table: document.get_ref() };
    let place = if top.table.contains_key(key) {
        reader.only(&top, &STUDY_KEYS);
        let places = reader.tables(&top, key, key);
        match <[Place<'_>; 1]>::try_from(places) {
            Ok([place]) => Some(place),
            Err(places) => {
                let problem = format!("{} entries of [[{key}]]; accepted: one", places.len());
                reader.problem(&places.get(1).map_or(0..0, |place| place.span.clone()), problem);
                None
            }
        }
    } else {
        Some(top)
    };
    match place.and_then(|place| read(&mut reader, place)) {
        Some(entry) if reader.problems.is_empty() => Ok(entry),
        _ => Err(reader.problems),
    }
}

pub(super) fn measurements_file(path: &Path, text: &str) -> Result<Measurements, Vec<Problem>> {
    sole(path, text, "subject", |reader, place| {
        reader.only(&place, &[&["id"], &keys::<Measurements>()[..]].concat());
        measurements(reader, &place, "")
    })
}

pub(super) fn fabric_file(path: &Path, text: &str) -> Result<Fabric, Vec<Problem>> {
    sole(path, text, "fabric", |reader, place| {
        own_fabric(reader, place, &mut BTreeSet::new()).map(|placed| placed.entry)
    })
}

/// Parses TOML. Reports syntax errors alone, since all other problems would follow from them.
fn open<'t>(path: &'t Path, text: &'t str) -> Result<(Reader<'t>, Spanned<DeTable<'t>>), Vec<Problem>> {
    let mut reader = Reader::new(path, text);
    let (document, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        reader.problem(&error.span().unwrap_or_default(), error.message());
    }
    if reader.problems.is_empty() { Ok((reader, document)) } else { Err(reader.problems) }
}

fn folder_name(folder: &Path) -> String {
    let full = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    full.file_name().map_or_else(|| "study".into(), |name| name.to_string_lossy().into_owned())
}

fn simulators(reader: &mut Reader<'_>, top: &Place<'_>) -> Vec<Simulator> {
    let Some(names) = reader.texts(top, "simulators") else { return vec![Simulator::Fem] };
    let mut simulators = Vec::new();
    for name in names {
        match crate::parameters::SIMULATORS.into_iter().find(|sim| sim.as_str() == *name.get_ref()) {
            Some(simulator) if !simulators.contains(&simulator) => simulators.push(simulator),
            Some(_) => reader.problem(&name.span(), format!("simulator `{}` is named twice", name.get_ref())),
            None => {
                let accepted = crate::parameters::SIMULATORS.map(Simulator::as_str).join(", ");
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

/// Fabrics that the file may name: its own and the known ones. Of two with the same name the file's own counts.
fn fabrics(reader: &mut Reader<'_>, top: &Place<'_>, known: &BTreeMap<String, Fabric>) -> BTreeMap<String, Fabric> {
    let mut fabrics = known.clone();
    fabrics.extend(own_fabrics(reader, top).into_iter().map(|placed| (placed.name, placed.entry)));
    fabrics
}

pub(super) fn own_fabrics(reader: &mut Reader<'_>, top: &Place<'_>) -> Vec<Placed<Fabric>> {
    let mut names = BTreeSet::new();
    let places = reader.tables(top, "fabric", "fabric");
    places.into_iter().filter_map(|place| own_fabric(reader, place, &mut names)).collect()
}

fn own_fabric<'t>(
    reader: &mut Reader<'_>,
    mut place: Place<'t>,
    names: &mut BTreeSet<&'t str>,
) -> Option<Placed<Fabric>> {
    reader.only(&place, &[&["name"], &keys::<Fabric>()[..]].concat());
    let name = reader.need_text(&place, "name", "its name")?;
    unique(reader, names, &name, "fabric");
    place.name = format!("fabric {}", name.get_ref());
    let source = reader.text(&place, "source").map_or("study file", Spanned::into_inner).to_owned();
    let blank = Fabric { source, ..Fabric::blank(name.get_ref()) };
    let fabric = numbers(reader, &place, blank, "a number, SI units as in the library (`toile fabric ls`)")?;
    Some(reader.placed(&name.span(), name.get_ref(), fabric))
}
