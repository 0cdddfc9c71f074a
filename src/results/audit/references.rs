//! Captions, references and words of the text, checked against the tables and figures that they name.

use std::collections::{BTreeMap, BTreeSet};

use crate::audit::tables::{Row, Tables};
use crate::audit::{Audit, Finding};

/// Number of a table or figure of chapter 6, with its garment, size (`one` where there is only one) and simulator.
type Label = (&'static str, [&'static str; 3]);

/// Size that the captions of the measurement tables name; empty where they name none.
const CAPTIONED: [(&str, &str); 18] = [
    ("6-5", "s"),
    ("6-6", "s"),
    ("6-8", "m"),
    ("6-9", "m"),
    ("6-11", "l"),
    ("6-12", "l"),
    ("6-14", ""),
    ("6-15", ""),
    ("6-17", ""),
    ("6-18", ""),
    ("6-20", ""),
    ("6-21", ""),
    ("6-23", "m"),
    ("6-24", "m"),
    ("6-26", "l"),
    ("6-27", "l"),
    ("6-29", ""),
    ("6-30", ""),
];

/// Figures that chart these tables. They stand beside the tables; the size of the trousers is that of the section.
const FIGURES: [Label; 18] = [
    ("Figure 6-7", ["male_tshirt", "s", "fem"]),
    ("Figure 6-9", ["male_tshirt", "s", "hybrid"]),
    ("Figure 6-14", ["male_tshirt", "m", "fem"]),
    ("Figure 6-16", ["male_tshirt", "m", "hybrid"]),
    ("Figure 6-21", ["male_tshirt", "l", "fem"]),
    ("Figure 6-23", ["male_tshirt", "l", "hybrid"]),
    ("Figure 6-29", ["male_trousers", "s", "fem"]),
    ("Figure 6-31", ["male_trousers", "s", "hybrid"]),
    ("Figure 6-36", ["male_trousers", "m", "fem"]),
    ("Figure 6-38", ["male_trousers", "m", "hybrid"]),
    ("Figure 6-43", ["male_trousers", "l", "fem"]),
    ("Figure 6-45", ["male_trousers", "l", "hybrid"]),
    ("Figure 6-51", ["female_teetop", "m", "fem"]),
    ("Figure 6-53", ["female_teetop", "m", "hybrid"]),
    ("Figure 6-58", ["female_teetop", "l", "fem"]),
    ("Figure 6-60", ["female_teetop", "l", "hybrid"]),
    ("Figure 6-66", ["female_dress", "one", "fem"]),
    ("Figure 6-68", ["female_dress", "one", "hybrid"]),
];

/// Sentences about the numbers of one table: the table or figure that the text refers to, and the chart of the numbers.
const SENTENCES: [(&str, &str); 9] = [
    ("Table 6-9", "Figure 6-16"),
    ("Table 6-14", "Figure 6-29"),
    ("Table 6-17", "Figure 6-36"),
    ("Table 6-18", "Figure 6-38"),
    ("Table 6-20", "Figure 6-43"),
    ("Table 6-20", "Figure 6-45"),
    ("Table 6-27", "Figure 6-60"),
    ("Figure 6-29", "Figure 6-66"),
    ("Table 6-30", "Figure 6-68"),
];

/// Iterations of Hybrid-GS's drape: in section 6.2.4 for all garments, in 5.5 for a T-shirt and for a loose dress.
const DRAPE_STEPS: f64 = 40.0;
const DRAPE_RANGES: [(&str, [f64; 2]); 2] = [("t-shirt", [20.0, 40.0]), ("loose dress", [50.0, 80.0])];

/// A row of Table 6-32 whose first word is cut short.
const CUT_SHORT: (&str, &str) = ("Tim cost", "Time cost");

pub(super) fn check(tables: &Tables) -> Audit {
    if tables.rows.is_empty() {
        return Audit { recomputed: 0, findings: Vec::new() };
    }
    let mut findings = captions(tables);
    findings.extend(references(tables));
    findings.extend(iterations());
    findings.extend(words(tables));
    Audit { recomputed: CAPTIONED.len() + SENTENCES.len() + DRAPE_RANGES.len(), findings }
}

fn captions(tables: &Tables) -> Vec<Finding> {
    let mut bare: BTreeMap<&str, Vec<(&str, &str)>> = BTreeMap::new();
    for (table, size) in CAPTIONED {
        let Some(row) = tables.rows.iter().find(|row| row.table == table) else { continue };
        let of_garment = tables.rows.iter().filter(|other| other.of.garment == row.of.garment);
        let has_several = of_garment.into_iter().any(|other| other.of.size != row.of.size);
        if size.is_empty() && has_several {
            bare.entry(&row.of.garment).or_default().push((table, &row.of.size));
        }
    }
    let finding = |(garment, found): (&str, Vec<(&str, &str)>)| Finding {
        kind: "caption",
        place: format!("tables {}", found.iter().map(|(table, _)| *table).collect::<Vec<_>>().join(" ")),
        stated: format!("{garment}, no size"),
        recomputed: format!("sizes {}", found.iter().map(|(_, size)| *size).collect::<Vec<_>>().join(" ")),
        says: "the captions do not say which of its sizes they show".into(),
    };
    bare.into_iter().map(finding).collect()
}

/// References to another table or figure than that of the numbers in the sentence.
fn references(tables: &Tables) -> Vec<Finding> {
    let shows = |label: &str| -> Option<[&str; 3]> {
        if let Some(table) = label.strip_prefix("Table ") {
            let row = tables.rows.iter().find(|row| row.table == table)?;
            return Some([&row.of.garment, &row.of.size, row.simulator.as_str()]);
        }
        FIGURES.iter().find(|(figure, _)| *figure == label).map(|(_, shown)| *shown)
    };
    let wrong = SENTENCES.iter().filter_map(|(first, chart)| {
        let (found, meant) = (shows(first)?, shows(chart)?);
        if found == meant {
            return None;
        }
        let table = tables.rows.iter().find(|row| [&*row.of.garment, &row.of.size, row.simulator.as_str()] == meant)?;
        Some(Finding {
            kind: "reference",
            place: format!("\"{first}, {chart}\""),
            stated: format!("{first}: {}", found.join(" ")),
            recomputed: format!("Table {}: {}", table.table, meant.join(" ")),
            says: format!("{chart} charts Table {}, and so the sentence means that", table.table),
        })
    });
    wrong.collect()
}

fn iterations() -> Vec<Finding> {
    let outside = DRAPE_RANGES.iter().filter(|(_, [low, high])| !(*low..=*high).contains(&DRAPE_STEPS));
    let finding = |(garment, [low, high]): &(&str, [f64; 2])| Finding {
        kind: "statement",
        place: "sections 6.2.4 and 5.5".into(),
        stated: format!("drape in {DRAPE_STEPS} iterations"),
        recomputed: format!("{low} to {high} for a {garment}"),
        says: "the two sections give the drape step other numbers of iterations".into(),
    };
    outside.map(finding).collect()
}

fn words(tables: &Tables) -> Vec<Finding> {
    let rows: Vec<&Row> = tables.rows.iter().filter(|row| row.name.contains("Circumstance")).collect();
    let finding = |place: String, stated: &str, meant: &str, says: &str| Finding {
        kind: "word",
        place,
        stated: stated.into(),
        recomputed: meant.into(),
        says: says.into(),
    };
    let first = (!rows.is_empty()).then(|| {
        let tables: BTreeSet<&str> = rows.iter().map(|row| row.table.as_str()).collect();
        let place = format!("{} rows of {} tables", rows.len(), tables.len());
        finding(place, "Circumstance", "Circumference", "the names of these measurements mean another word")
    });
    let (stated, meant) = CUT_SHORT;
    first.into_iter().chain([finding("table 6-32".into(), stated, meant, "a letter is missing")]).collect()
}
