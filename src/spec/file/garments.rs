//! The `[[garment]]` tables of a study file: wearers, seams, fabric and sizes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use toml::Spanned;

use crate::file::reader::{Place, Reader};
use crate::file::sweep::{self, EDGE_MM};
use crate::file::values::{lookup, source, unique};
use crate::file::{GarmentEntry, KnownSize, KnownStyle, Placed, Sewn, SizeFile, Subject, schedule, target};
use crate::parameters::Parameters;
use crate::patterns::{Nest, Unit, unit_of};
use crate::schedule::Limits;
use fit::target::is_rigid;
use geom::units::from_mm;
use pattern::size_order;
use sim::Fabric;
use store::files::SourceFile;

const GARMENT_KEYS: [&str; 15] = [
    "name",
    "subjects",
    "seams",
    "unit",
    "fabric",
    "sizes",
    "style",
    "edge_length_mm",
    "parameters",
    "intended_fit",
    "target_ease_mm",
    "priority",
    "after",
    "time_limit_s",
    "memory_limit_mb",
];

pub(super) struct Common<'a> {
    pub folder: &'a Path,
    pub fabrics: &'a BTreeMap<String, Fabric>,
    pub styles: &'a BTreeMap<String, KnownStyle>,
    /// Edge length of the finest mesh, for garments that give none.
    pub edge_length_m: f64,
    /// Those of a garment replace them.
    pub parameters: Parameters,
    /// Those of a garment replace them.
    pub limits: Limits,
}

pub(super) fn garments(
    reader: &mut Reader<'_>,
    top: &Place<'_>,
    common: &Common<'_>,
    subjects: &[Subject],
) -> Vec<GarmentEntry> {
    let places = reader.tables(top, "garment", "garment");
    if places.is_empty() {
        reader.missing(top, "garment", "at least one [[garment]]");
    }
    let mut garments = Vec::new();
    let mut names = BTreeSet::new();
    for mut place in places {
        let before = names.clone();
        let name = named(reader, &mut place, &mut names);
        let schedule = schedule::schedule(reader, &place, &before, common.limits);
        let subjects = wearers(reader, &place, top, subjects);
        let style = reader.text(&place, "style");
        let Sewn { seams, unit, mut sizes } = match &style {
            Some(style) if !place.table.contains_key("seams") => in_catalogue(reader, &place, style, common.styles),
            _ => {
                let sewn = sewn(reader, &place, common.folder);
                let holds_seams = !sewn.sizes.is_empty() && sewn.sizes.iter().all(|size| size.pattern.holds_seams());
                if !holds_seams && !place.table.contains_key("seams") {
                    let wanted = "the file that says how its pieces are sewn, or a `style` of the catalogue";
                    reader.missing(&place, "seams", wanted);
                }
                sewn
            }
        };
        told_apart(reader, &place, &sizes, unit.as_deref());
        size_order::sort(&mut sizes, |size| &size.name);
        let edge_length_m = reader.number(&place, "edge_length_mm", EDGE_MM).map_or(common.edge_length_m, from_mm);
        let mut parameters = common.parameters.clone();
        for (name, value) in sweep::parameters(reader, &place).iter() {
            // The value was accepted when it was read.
            let _ = parameters.set(name, value.clone());
        }
        let mut target = target::target(reader, &place);
        let fabric = reader.need_text(&place, "fabric", "the name of a fabric");
        let fabric = fabric.and_then(|name| lookup(reader, common.fabrics, &name, "fabric").cloned());
        if let (Some(name), Some(fabric)) = (name, fabric) {
            let name = (*name.get_ref()).to_owned();
            let style = style.map_or_else(|| name.clone(), |style| style.into_inner().to_owned());
            let swept = vec![];
            target.is_rigid = is_rigid(fabric.membrane_weft_n_m);
            garments.push(GarmentEntry {
                name,
                subjects,
                seams,
                unit,
                fabric,
                sizes,
                style,
                edge_length_m,
                parameters,
                target,
                swept,
                schedule,
                outfit: None,
            });
        }
    }
    garments
}

/// Reports several sizes that would have the same pieces, since their one pattern file does not hold each of them.
fn told_apart(reader: &mut Reader<'_>, place: &Place<'_>, sizes: &[SizeFile], unit: Option<&str>) {
    let mut by_file: BTreeMap<String, Vec<&SizeFile>> = BTreeMap::new();
    for size in sizes {
        by_file.entry(size.pattern.hash()).or_default().push(size);
    }
    for sharing in by_file.into_values().filter(|sharing| sharing.len() > 1) {
        let pattern = &sharing[0].pattern;
        // Elsewhere the reason is reported why a file cannot be read.
        let Some(held) = held_sizes(pattern, unit.and_then(unit_of)) else { continue };
        let mut taken = BTreeSet::new();
        for size in &sharing {
            let found = held.iter().position(|name| name.eq_ignore_ascii_case(&size.name));
            let wrong = match found {
                _ if held.len() == 1 => {
                    format!("is one of {} of {}, which holds one size", sharing.len(), pattern.name)
                }
                None => format!("is none of {}", pattern.name),
                Some(index) if !taken.insert(index) => format!("is a second name of one size of {}", pattern.name),
                Some(_) => continue,
            };
            let accepted = match held.as_slice() {
                [_] => "a file a size, or one that holds them all".to_owned(),
                names => format!("one of {}", names.join(", ")),
            };
            reader.problem(&place.span, format!("{}: size `{}` {wrong}; accepted: {accepted}", place.name, size.name));
        }
    }
}

/// `None` where the pattern cannot be read.
fn held_sizes(pattern: &SourceFile, unit: Option<Unit>) -> Option<Vec<String>> {
    if pattern.holds_seams() {
        return Some(vec![String::new()]);
    }
    let nest = Nest::read(pattern, unit).ok()?;
    Some(nest.sizes().into_iter().map(str::to_owned).collect())
}

/// Reads a style of the catalogue: the sizes that are named, or all.
fn in_catalogue(
    reader: &mut Reader<'_>,
    place: &Place<'_>,
    name: &Spanned<&str>,
    styles: &BTreeMap<String, KnownStyle>,
) -> Sewn {
    let mut sewn = Sewn { seams: None, unit: unit(reader, place), sizes: vec![] };
    let Some(style) = lookup(reader, styles, name, "style in the catalogue") else { return sewn };
    sewn.seams.clone_from(&style.seams);
    let known: BTreeMap<String, ()> = style.sizes.iter().map(|known| (known.size.name.clone(), ())).collect();
    let wanted = reader.texts(place, "sizes").map(|names| {
        let found = names.iter().filter(|size| lookup(reader, &known, size, "size of the style").is_some());
        found.map(|size| (*size.get_ref()).to_owned()).collect::<Vec<_>>()
    });
    let wanted = wanted.unwrap_or_else(|| style.sizes.iter().map(|known| known.size.name.clone()).collect());
    let of_name = |name: &String| style.sizes.iter().find(|known| known.size.name == *name);
    for KnownSize { size, unit } in wanted.iter().filter_map(of_name) {
        if unit.is_some() && sewn.unit.is_some() && *unit != sewn.unit {
            let message =
                format!("{}: sizes of `{}` are in different units; name those of one", place.name, name.get_ref());
            reader.problem(&name.span(), message);
        }
        sewn.unit = sewn.unit.or(unit.clone());
        sewn.sizes.push(size.clone());
    }
    sewn
}

/// Subjects that the garment names, or else all of the file.
fn wearers(reader: &mut Reader<'_>, garment: &Place<'_>, top: &Place<'_>, subjects: &[Subject]) -> Vec<String> {
    let Some(names) = reader.texts(garment, "subjects") else {
        return subjects.iter().map(|subject| subject.id.clone()).collect();
    };
    // A subject with an error is reported once, at its own line, and not again as unknown.
    let known: BTreeMap<String, ()> = reader
        .tables(top, "subject", "subject")
        .iter()
        .filter_map(|place| place.table.get("id")?.get_ref().as_str().map(str::to_owned))
        .chain(subjects.iter().map(|subject| subject.id.clone()))
        .map(|id| (id, ()))
        .collect();
    let mut wearers: Vec<String> = Vec::new();
    let mut seen = BTreeSet::new();
    for name in &names {
        if seen.contains(name.get_ref()) {
            reader.problem(&name.span(), format!("{}: subject `{}` is named twice", garment.name, name.get_ref()));
        } else if lookup(reader, &known, name, "[[subject]] with the id").is_some() {
            seen.insert(*name.get_ref());
            let called = subjects.iter().filter(|subject| subject.is_called(name.get_ref()));
            wearers.extend(called.map(|subject| subject.id.clone()));
        }
    }
    if names.is_empty() {
        let span = garment.table.get("subjects").map_or(garment.span.clone(), Spanned::span);
        let message = format!("{}: nobody wears it; name subjects, or leave `subjects` out for all", garment.name);
        reader.problem(&span, message);
    }
    wearers
}

/// Reads all garments without their fabric.
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

/// Reads the name of a garment and adds it to the place, for messages.
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
    let seams = reader.text(place, "seams").and_then(|file| source(reader, place, &file, folder, SourceFile::read));
    Sewn { seams, unit: unit(reader, place), sizes: sizes(reader, place, folder) }
}

fn unit(reader: &mut Reader<'_>, place: &Place<'_>) -> Option<String> {
    let unit = reader.text(place, "unit")?;
    if unit_of(unit.get_ref()).is_none() {
        let accepted = Unit::ALL.map(Unit::as_str).join(", ");
        let message = format!("{}: unit `{}`; accepted: {accepted}", place.name, unit.get_ref());
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
