//! The `[[outfit]]` tables of a study file: garments worn on top of each other.

use std::collections::{BTreeMap, BTreeSet};

use toml::Spanned;

use crate::file::reader::{Place, Reader};
use crate::file::values::{lookup, unique};
use crate::file::{GarmentEntry, SizeFile, WornWith};

/// Accepted numbers of layers; contact keeps at most five apart.
pub const LAYERS: std::ops::RangeInclusive<usize> = 2..=5;

/// Reads every layer of every outfit as a garment of its own. The layer `shirt` of the outfit `office` becomes `office
/// shirt`.
pub(super) fn outfits(reader: &mut Reader<'_>, top: &Place<'_>, garments: &[GarmentEntry]) -> Vec<GarmentEntry> {
    let known: BTreeMap<String, &GarmentEntry> =
        garments.iter().map(|garment| (garment.name.clone(), garment)).collect();
    let mut names = BTreeSet::new();
    let mut all = Vec::new();
    for mut place in reader.tables(top, "outfit", "outfit") {
        reader.only(&place, &["name", "layers", "sizes", "subjects"]);
        let Some(name) = reader.need_text(&place, "name", "its name in results") else { continue };
        unique(reader, &mut names, &name, "outfit");
        place.name = format!("outfit {}", name.get_ref());
        let Some(layers) = layers(reader, &place, &known) else { continue };
        let (Some(sizes), subjects) = (sizes(reader, &place, &layers), wearers(reader, &place, &layers)) else {
            continue;
        };
        all.extend(worn(name.get_ref(), &layers, &sizes, &subjects));
    }
    all
}

/// Inmost first.
fn layers<'k>(
    reader: &mut Reader<'_>,
    place: &Place<'_>,
    known: &BTreeMap<String, &'k GarmentEntry>,
) -> Option<Vec<&'k GarmentEntry>> {
    let Some(named) = reader.texts(place, "layers") else {
        reader.missing(place, "layers", "garments of the file, the inner first: [\"shirt\", \"trousers\"]");
        return None;
    };
    let found: Vec<_> =
        named.iter().filter_map(|name| lookup(reader, known, name, "[[garment]] with the name")).collect();
    if found.len() < named.len() {
        return None;
    }
    let distinct: BTreeSet<&str> = found.iter().map(|garment| garment.name.as_str()).collect();
    if distinct.len() < found.len() || !LAYERS.contains(&found.len()) {
        let (least, most) = (LAYERS.start(), LAYERS.end());
        let message = format!("{}: {} layers; accepted: {least} to {most} different garments", place.name, named.len());
        reader.problem(&span(place, "layers"), message);
        return None;
    }
    Some(found.into_iter().copied().collect())
}

/// Sizes that are worn together, each with one size of every layer: those that the outfit names; else all that the
/// layers have in common; else the only size of each layer.
fn sizes(reader: &mut Reader<'_>, place: &Place<'_>, layers: &[&GarmentEntry]) -> Option<Vec<Vec<SizeFile>>> {
    let size_of = |layer: &GarmentEntry, name: &str| layer.sizes.iter().find(|size| size.name == name).cloned();
    if let Some(named) = reader.texts(place, "sizes") {
        let found: Option<Vec<SizeFile>> =
            named.iter().zip(layers).map(|(name, layer)| size_of(layer, name.get_ref())).collect();
        return match found {
            Some(together) if named.len() == layers.len() => Some(vec![together]),
            _ => {
                let all = layers.iter().map(|layer| format!("{} of {}", known_sizes(layer), layer.name));
                let message = format!(
                    "{}: `sizes` has one size of each layer: {}",
                    place.name,
                    all.collect::<Vec<_>>().join("; ")
                );
                reader.problem(&span(place, "sizes"), message);
                None
            }
        };
    }
    let first = layers.first()?;
    let common = first.sizes.iter().map(|size| layers.iter().map(|layer| size_of(layer, &size.name)).collect());
    let common: Vec<Vec<SizeFile>> = common.collect::<Vec<Option<_>>>().into_iter().flatten().collect();
    let only =
        || layers.iter().map(|layer| <[SizeFile; 1]>::try_from(layer.sizes.clone()).ok().map(|[size]| size)).collect();
    let together: Option<Vec<Vec<SizeFile>>> =
        if common.is_empty() { Option::map(only(), |sizes| vec![sizes]) } else { Some(common) };
    if together.is_none() {
        reader.missing(place, "sizes", "one size of each layer, since they have none in common");
    }
    together
}

fn known_sizes(layer: &GarmentEntry) -> String {
    layer.sizes.iter().map(|size| size.name.as_str()).collect::<Vec<_>>().join(", ")
}

/// All who wear every layer, or those of them that the outfit names.
fn wearers(reader: &mut Reader<'_>, place: &Place<'_>, layers: &[&GarmentEntry]) -> Vec<String> {
    let first = layers.first().map_or(&[][..], |layer| &layer.subjects);
    let all: Vec<String> =
        first.iter().filter(|id| layers.iter().all(|layer| layer.subjects.contains(id))).cloned().collect();
    let Some(named) = reader.texts(place, "subjects") else {
        if all.is_empty() {
            reader.problem(&span(place, "layers"), format!("{}: nobody wears all of its layers", place.name));
        }
        return all;
    };
    let known: BTreeMap<String, ()> = all.into_iter().map(|id| (id, ())).collect();
    let wanted = named.iter().filter(|name| lookup(reader, &known, name, "subject who wears all layers").is_some());
    wanted.map(|name| (*name.get_ref()).to_owned()).collect()
}

/// Span of a key in the text, or of its table where the key is missing.
fn span(place: &Place<'_>, key: &str) -> std::ops::Range<usize> {
    place.table.get(key).map_or(place.span.clone(), Spanned::span)
}

/// The layers of an outfit as garments. Each layer waits for the one under it: one simulation drapes all layers, and
/// the later jobs take its cached drape.
fn worn(outfit: &str, layers: &[&GarmentEntry], sizes: &[Vec<SizeFile>], subjects: &[String]) -> Vec<GarmentEntry> {
    let together: Vec<GarmentEntry> = layers
        .iter()
        .enumerate()
        .map(|(number, layer)| GarmentEntry {
            sizes: sizes.iter().map(|together| together[number].clone()).collect(),
            swept: vec![],
            ..(*layer).clone()
        })
        .collect();
    let name = |layer: &GarmentEntry| format!("{outfit} {}", layer.name);
    let entry = |(number, layer): (usize, &GarmentEntry)| {
        let mut entry = layer.clone();
        entry.name = name(layer);
        entry.subjects = subjects.to_vec();
        entry.schedule.after = number.checked_sub(1).map(|under| name(&together[under])).into_iter().collect();
        entry.outfit = Some(WornWith { name: outfit.to_owned(), layer: number, layers: together.clone() });
        entry
    };
    together.iter().enumerate().map(entry).collect()
}
