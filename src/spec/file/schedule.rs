//! Schedule of the jobs of a study file: `priority`, `after`, `time_limit_s`, `memory_limit_mb`.

use std::collections::{BTreeMap, BTreeSet};

use crate::file::GarmentEntry;
use crate::file::reader::{Place, Reader};
use crate::file::values::lookup;
use crate::schedule::{Limits, Schedule};

/// Thirty days.
const LONGEST_S: f64 = 30.0 * 86_400.0;
/// A process does not even start in less than 50 MB.
const MEMORY_MB: std::ops::RangeInclusive<f64> = 50.0..=4e6;
const PRIORITY: std::ops::RangeInclusive<f64> = -1000.0..=1000.0;

pub(super) fn limits(reader: &mut Reader<'_>, place: &Place<'_>) -> Limits {
    Limits {
        time_s: reader.number(place, "time_limit_s", 0.001..=LONGEST_S),
        memory_mb: reader.number(place, "memory_limit_mb", MEMORY_MB).map(|megabytes| megabytes as u32),
    }
}

/// A garment waits only for garments before it in the file, so that no circle arises.
pub(super) fn schedule(
    reader: &mut Reader<'_>,
    place: &Place<'_>,
    before: &BTreeSet<&str>,
    of_study: Limits,
) -> Schedule {
    let known: BTreeMap<String, ()> = before.iter().map(|name| ((*name).to_owned(), ())).collect();
    let after = reader.texts(place, "after").unwrap_or_default();
    let after = after.iter().filter(|name| lookup(reader, &known, name, "[[garment]] before this one").is_some());
    Schedule {
        after: after.map(|name| (*name.get_ref()).to_owned()).collect(),
        priority: reader.number(place, "priority", PRIORITY).map_or(0, |priority| priority.round() as i64),
        limits: limits(reader, place).or(of_study),
    }
}

/// Replaces garment names in `after` by the names of the garments that sweeps made of them.
pub(super) fn after_swept(mut garments: Vec<GarmentEntry>) -> Vec<GarmentEntry> {
    let names: Vec<[String; 2]> =
        garments.iter().map(|garment| [garment.unswept_name().to_owned(), garment.name.clone()]).collect();
    for garment in &mut garments {
        let after = &mut garment.schedule.after;
        *after = names.iter().filter(|[file, _]| after.contains(file)).map(|[_, name]| name.clone()).collect();
    }
    garments
}
