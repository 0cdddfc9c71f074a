//! `[parameters]` and `[[sweep]]` of a study file: values of parameters, fabrics and edge lengths, and all combinations
//! of lists of values.
//!
//! A sweep makes a garment of each combination and names it so: `tshirt offset_mu=0.4 bend_angle_deg=120`.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value as Json;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::fields::FABRIC_NUMBERS;
use crate::file::GarmentEntry;
use crate::file::reader::{Place, Reader};
use crate::file::values::lookup;
use crate::parameters::Parameters;
use fit::target::is_rigid;
use geom::units::from_mm;
use sim::Fabric;

pub(super) const EDGE_MM: std::ops::RangeInclusive<f64> = 2.0..=100.0;
/// Greatest number of garments that a sweep may make of one garment.
const MOST: usize = 10_000;

#[derive(Clone)]
enum Setting {
    Fabric(Fabric),
    FabricNumber(usize, f64),
    EdgeLength(f64),
    Parameter(String, Json),
}

/// A swept quantity and its values.
struct Axis {
    name: String,
    settings: Vec<(String, Setting)>,
}

pub(super) fn parameters(reader: &mut Reader<'_>, place: &Place<'_>) -> Parameters {
    let mut parameters = Parameters::default();
    let Some(value) = place.table.get("parameters") else { return parameters };
    let Some(table) = value.get_ref().as_table() else {
        reader.problem(&value.span(), format!("{}: `parameters` is a table, such as fem.offset_mu = 0.4", place.name));
        return parameters;
    };
    for (name, value) in leaves("", table) {
        if let Err(problem) = parameters.set(&name, json(value.get_ref())) {
            reader.problem(&value.span(), format!("{}: {problem}", place.name));
        }
    }
    parameters
}

/// Replaces each garment of a sweep by the garments that the sweep makes of it.
pub(super) fn swept(
    reader: &mut Reader<'_>,
    top: &Place<'_>,
    garments: Vec<GarmentEntry>,
    fabrics: &BTreeMap<String, Fabric>,
) -> Vec<GarmentEntry> {
    let mut made: BTreeMap<String, Vec<GarmentEntry>> = BTreeMap::new();
    let mut names: BTreeSet<String> = BTreeSet::new();
    for place in reader.tables(top, "sweep", "sweep") {
        let chosen = chosen(reader, &place, &garments);
        let axes = axes(reader, &place, fabrics);
        let size: usize =
            axes.iter().map(|axis| axis.settings.len()).try_fold(1usize, usize::checked_mul).unwrap_or(MOST + 1);
        if axes.is_empty() || size > MOST {
            let found = if axes.is_empty() { "no list of values".to_owned() } else { format!("{size} combinations") };
            reader.problem(&place.span, format!("{}: {found}; accepted: 1 to {MOST} combinations", place.name));
            continue;
        }
        for garment in garments.iter().filter(|garment| chosen.contains(&garment.name)) {
            for variant in variants(garment, &axes) {
                if !names.insert(variant.name.clone()) {
                    reader.problem(&place.span, format!("{}: `{}` is made twice", place.name, variant.name));
                }
                made.entry(garment.name.clone()).or_default().push(variant);
            }
        }
    }
    garments.into_iter().flat_map(|garment| made.remove(&garment.name).unwrap_or_else(|| vec![garment])).collect()
}

/// Garments that the sweep lists, or all.
fn chosen(reader: &mut Reader<'_>, place: &Place<'_>, garments: &[GarmentEntry]) -> Vec<String> {
    let known: BTreeMap<String, ()> = garments.iter().map(|garment| (garment.name.clone(), ())).collect();
    match reader.texts(place, "garments") {
        None => known.into_keys().collect(),
        Some(names) => {
            let found = names.iter().filter(|name| lookup(reader, &known, name, "[[garment]] with the name").is_some());
            found.map(|name| (*name.get_ref()).to_owned()).collect()
        }
    }
}

/// Every combination of the axes; the last axis changes fastest.
fn variants(garment: &GarmentEntry, axes: &[Axis]) -> Vec<GarmentEntry> {
    let mut all = vec![garment.clone()];
    for axis in axes {
        let mut next = Vec::with_capacity(all.len() * axis.settings.len());
        for (before, (text, setting)) in
            all.iter().flat_map(|before| axis.settings.iter().map(move |set| (before, set)))
        {
            let mut variant = before.clone();
            let short = axis.name.rsplit('.').next().unwrap_or(&axis.name);
            variant.name = format!("{} {short}={text}", before.name);
            variant.swept.push((axis.name.clone(), text.clone()));
            apply(&mut variant, setting, short, text);
            next.push(variant);
        }
        all = next;
    }
    all
}

fn apply(variant: &mut GarmentEntry, setting: &Setting, short: &str, text: &str) {
    match setting {
        Setting::Fabric(fabric) => variant.fabric = fabric.clone(),
        Setting::FabricNumber(field, number) => {
            FABRIC_NUMBERS[*field].set(&mut variant.fabric, Some(*number));
            variant.fabric.name = format!("{} {short}={text}", variant.fabric.name);
        }
        Setting::EdgeLength(length_m) => variant.edge_length_m = *length_m,
        Setting::Parameter(name, value) => {
            // The value was accepted when the axis was read.
            let _ = variant.parameters.set(name, value.clone());
        }
    }
    variant.target.is_rigid = is_rigid(variant.fabric.membrane_weft_n_m);
}

fn axes(reader: &mut Reader<'_>, place: &Place<'_>, fabrics: &BTreeMap<String, Fabric>) -> Vec<Axis> {
    let mut axes = Vec::new();
    for (name, value) in leaves("", place.table).into_iter().filter(|(name, _)| name != "garments") {
        let Some(list) = value.get_ref().as_array() else {
            let message =
                format!("{}: `{name}` must be a list of values, found {}", place.name, value.get_ref().type_str());
            reader.problem(&value.span(), message);
            continue;
        };
        let mut settings: Vec<(String, Setting)> = Vec::new();
        for item in list.iter() {
            let text = json(item.get_ref()).as_str().map_or_else(|| json(item.get_ref()).to_string(), str::to_owned);
            match setting(&name, item, fabrics) {
                Err(problem) => reader.problem(&item.span(), format!("{}: {problem}", place.name)),
                Ok(_) if settings.iter().any(|(before, _)| *before == text) => {
                    reader.problem(&item.span(), format!("{}: `{name}` has {text} twice", place.name));
                }
                Ok(setting) => settings.push((text, setting)),
            }
        }
        if list.is_empty() {
            reader.problem(&value.span(), format!("{}: `{name}` has no value", place.name));
        }
        axes.push(Axis { name, settings });
    }
    axes
}

fn setting(name: &str, item: &Spanned<DeValue<'_>>, fabrics: &BTreeMap<String, Fabric>) -> Result<Setting, String> {
    let value = json(item.get_ref());
    let number = || value.as_f64().ok_or_else(|| format!("`{name}` is {value}; accepted: a number"));
    if name == "fabric" {
        let known: Vec<&str> = fabrics.keys().map(String::as_str).collect();
        let wanted = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let hint = || match store::nearest(&wanted, known.iter().copied()) {
            Some(near) => format!("no fabric `{wanted}`; did you mean `{near}`?"),
            None => format!("no fabric `{wanted}`; there are: {}", known.join(", ")),
        };
        return fabrics.get(&wanted).cloned().map(Setting::Fabric).ok_or_else(hint);
    }
    if let Some(key) = name.strip_prefix("fabric.") {
        let keys = || FABRIC_NUMBERS.iter().map(|field| field.key);
        let Some(field) = keys().position(|known| known == key) else {
            let hint = store::nearest(key, keys()).map(|near| format!("did you mean `fabric.{near}`?"));
            let all = || format!("there are: {}", keys().collect::<Vec<_>>().join(", "));
            return Err(format!("no number `{key}` of a fabric; {}", hint.unwrap_or_else(all)));
        };
        return Ok(Setting::FabricNumber(field, FABRIC_NUMBERS[field].check(number()?)?));
    }
    if name == "edge_length_mm" {
        let edge_mm = number()?;
        let accepted = || format!("`{name}` is {edge_mm}; accepted: {} to {}", EDGE_MM.start(), EDGE_MM.end());
        return if EDGE_MM.contains(&edge_mm) { Ok(Setting::EdgeLength(from_mm(edge_mm))) } else { Err(accepted()) };
    }
    Parameters::default().set(name, value.clone()).map_err(|problem| {
        let more = if name.contains('.') { "" } else { "; also: fabric, fabric.NUMBER, edge_length_mm" };
        format!("{problem}{more}")
    })?;
    Ok(Setting::Parameter(name.to_owned(), value))
}

/// All values of a table and its subtables, each under its dotted name.
fn leaves<'t>(prefix: &str, table: &'t DeTable<'t>) -> Vec<(String, &'t Spanned<DeValue<'t>>)> {
    let mut found = Vec::new();
    for (key, value) in table.iter() {
        let name = format!("{prefix}{}", key.get_ref());
        match value.get_ref().as_table() {
            Some(inner) => found.extend(leaves(&format!("{name}."), inner)),
            None => found.push((name, value)),
        }
    }
    found
}

/// A number that its type cannot hold becomes null.
fn json(value: &DeValue<'_>) -> Json {
    match value {
        DeValue::Integer(digits) => i64::from_str_radix(digits.as_str(), digits.radix()).map_or(Json::Null, Json::from),
        DeValue::Float(digits) => digits.as_str().parse::<f64>().map_or(Json::Null, Json::from),
        DeValue::Boolean(is) => (*is).into(),
        DeValue::Array(items) => items.iter().map(|item| json(item.get_ref())).collect(),
        DeValue::String(text) => text.as_ref().into(),
        other => other.type_str().into(),
    }
}
