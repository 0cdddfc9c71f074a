//! Intended ease of a garment of a study file: `intended_fit` and `target_ease_mm`.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::file::reader::{Place, Reader};
use fit::target::{Intended, TARGETS, Target};
use geom::units::from_mm;

/// Accepted eases, mm.
const EASE_MM: std::ops::RangeInclusive<f64> = -500.0..=1000.0;

/// Regular fit where the garment names none.
pub(super) fn target(reader: &mut Reader<'_>, place: &Place<'_>) -> Target {
    let mut target = Target::default();
    if let Some(name) = reader.text(place, "intended_fit") {
        match Intended::from_name(name.get_ref()) {
            Some(intended) => target.intended = intended,
            None => {
                let all = Intended::ALL.map(Intended::as_str).join(", ");
                let message = format!("{}: intended_fit `{}`; accepted: {all}", place.name, name.get_ref());
                reader.problem(&name.span(), message);
            }
        }
    }
    let Some(value) = place.table.get("target_ease_mm") else { return target };
    let Some(table) = value.get_ref().as_table() else {
        reader.problem(&value.span(), format!("{}: `target_ease_mm` is no table; accepted: {EXAMPLE}", place.name));
        return target;
    };
    own(reader, place, table, &mut target);
    target
}

const EXAMPLE: &str = "{ chest = [60, 100] }, least and greatest ease in millimetres";

fn own(reader: &mut Reader<'_>, place: &Place<'_>, table: &DeTable<'_>, target: &mut Target) {
    for (level, value) in table {
        let name = level.get_ref();
        if *name != "neck" && !TARGETS.iter().any(|row| row.level == name.as_ref()) {
            let mut known: Vec<&str> = TARGETS.iter().map(|row| row.level).chain(["neck"]).collect();
            known.sort_unstable();
            known.dedup();
            let message = format!("{}: target_ease_mm at `{name}`; accepted: {}", place.name, known.join(", "));
            reader.problem(&level.span(), message);
            continue;
        }
        match band(value) {
            Some(band_mm) => drop(target.own_m.insert(name.to_string(), band_mm.map(from_mm))),
            None => {
                let (least, most) = (EASE_MM.start(), EASE_MM.end());
                let accepted = format!("{EXAMPLE}, from {least} to {most}");
                reader.problem(
                    &value.span(),
                    format!("{}: target_ease_mm at `{name}`; accepted: {accepted}", place.name),
                );
            }
        }
    }
}

/// Least and greatest ease, mm.
fn band(value: &Spanned<DeValue<'_>>) -> Option<[f64; 2]> {
    let number = |item: &Spanned<DeValue<'_>>| match item.get_ref() {
        DeValue::Integer(digits) => i64::from_str_radix(digits.as_str(), digits.radix()).ok().map(|n| n as f64),
        DeValue::Float(digits) => digits.as_str().parse().ok(),
        _ => None,
    };
    let numbers: Vec<f64> = value.get_ref().as_array()?.iter().map(number).collect::<Option<_>>()?;
    let [least, most] = <[f64; 2]>::try_from(numbers).ok()?;
    (least < most && EASE_MM.contains(&least) && EASE_MM.contains(&most)).then_some([least, most])
}
