//! The fabrics of the catalogue as lists show them.

use rusqlite::{Connection, Row};

use crate::catalogue::numbers::{columns, read_numbers};
use geom::units::mm;
use sim::Fabric;
use sim::fabric::Kind;
use spec::FABRIC_NUMBERS;
use spec::entry::Entry;
use store::{Result, Store, Table, Value};

#[derive(Clone, Debug, PartialEq)]
pub struct FabricRow {
    /// Name and numbers of the fabric, with their source.
    pub fabric: Fabric,
    pub revision: i64,
    /// True where a user or a study added or changed the fabric; false for a built-in one.
    pub is_own: bool,
    /// Number of jobs that use any revision of the fabric.
    pub jobs: i64,
}

impl FabricRow {
    /// True if the fabric stands for a class of cloths, not for one cloth.
    pub fn is_class(&self) -> bool {
        self.fabric.known().is_some_and(|known| known.kind == Kind::Class)
    }

    /// Kind of a built-in fabric, in words: one cloth, with the numbers that come from another cloth; or a class, with
    /// the bending lengths of the middle eight tenths of its cloths. `None` for any other fabric.
    pub fn stands_for(&self) -> Option<String> {
        let known = self.fabric.known()?;
        let [least, most] = sim::fabric::weights::ends();
        let told = match known.kind {
            Kind::Class => {
                let [warp, weft] = self.fabric.scatter_m().map(|ends| ends.map(|length| format!("{:.0}", mm(length))));
                let [warp, weft] = [warp, weft].map(|ends| ends.join(" to "));
                let cloths = sim::fabric::weights::count(self.fabric.density_kg_m2);
                format!("; {cloths} of its weight bend at {warp} mm, across at {weft} (p{least:.0} to p{most:.0})")
            }
            _ if known.of_another.is_empty() => String::new(),
            _ => format!("; {} of another", parts(&known.of_another)),
        };
        Some(format!("{}{told}", known.kind))
    }

    /// Force per width that stretches a strip by a share of its length: along the grain, and across it. The strip may
    /// become narrower.
    pub fn tensions_n_m(&self, stretch: f64) -> [f64; 2] {
        let strain = stretch * (1.0 + 0.5 * stretch);
        let laws = [self.fabric.warp_law(), self.fabric.weft_law()];
        laws.map(|law| (1.0 + stretch) * law.stress(strain))
    }
}

/// Current fabrics, by name; their numbers of jobs are left at 0.
pub(super) fn stored_fabrics(connection: &Connection) -> Result<Vec<FabricRow>> {
    let sql = format!(
        "SELECT name, revision, is_own, source, {} FROM fabric JOIN catalogue_entry AS entry USING (name, revision)
        WHERE part = 'fabric' AND NOT is_retired ORDER BY name",
        columns(&FABRIC_NUMBERS)
    );
    let row = |row: &Row<'_>| {
        let mut fabric = Fabric { source: row.get(3)?, ..Fabric::blank(&row.get::<_, String>(0)?) };
        read_numbers(row, 4, &FABRIC_NUMBERS, &mut fabric)?;
        Ok(FabricRow { fabric, revision: row.get(1)?, is_own: row.get(2)?, jobs: 0 })
    };
    let mut statement = connection.prepare_cached(&sql)?;
    let rows = statement.query_map([], row)?.collect::<rusqlite::Result<_>>()?;
    Ok(rows)
}

/// Columns that [`with_bending`] adds.
const BENDING: [&str; 8] = [
    "stands_for",
    "of_another",
    "bending_length_warp_mm",
    "bending_length_weft_mm",
    "bending_rank_warp",
    "bending_rank_weft",
    "class_length_warp_mm",
    "class_length_weft_mm",
];

/// Adds columns to a table of fabrics with the columns of `v_fabrics`: kind, numbers from other cloths, bending
/// lengths, their ranks among the known cloths of the same weight, and the ranges of the class.
pub fn with_bending(mut table: Table) -> Table {
    let column_of = |key: &str| table.columns.iter().position(|column| column == key);
    let name = column_of("fabric");
    let places: Vec<_> = FABRIC_NUMBERS.iter().map(|field| column_of(field.key)).collect();
    for row in &mut table.rows {
        let mut fabric = Fabric::blank(&name.map_or_else(String::new, |k| row[k].to_string()));
        for (field, place) in FABRIC_NUMBERS.iter().zip(&places) {
            field.set(&mut fabric, place.and_then(|k| number(&row[k])));
        }
        row.extend(bending(&fabric));
    }
    table.columns.extend(BENDING.map(str::to_owned));
    table
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Real(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    }
}

fn bending(fabric: &Fabric) -> [Value; 8] {
    let tenths = |length_m: f64| (mm(length_m) * 10.0).round() / 10.0;
    let known = fabric.known();
    let borrowed = known.filter(|known| !known.of_another.is_empty()).map(|known| parts(&known.of_another));
    let text = |text: Option<String>| text.map_or(Value::Null, Value::Text);
    let [along, across] = fabric.bending_lengths_m().map(|length| Value::Real(tenths(length)));
    let [rank_along, rank_across] = fabric.standings().map(|standing| Value::Text(standing.to_string()));
    let is_class = known.is_some_and(|known| known.kind == Kind::Class);
    let ends = |[least, most]: [f64; 2]| is_class.then(|| format!("{} to {}", tenths(least), tenths(most)));
    let [class_along, class_across] = fabric.scatter_m().map(|scatter| text(ends(scatter)));
    let kind = text(known.map(|known| known.kind.to_string()));
    [kind, text(borrowed), along, across, rank_along, rank_across, class_along, class_across]
}

fn parts(parts: &[sim::fabric::Part]) -> String {
    parts.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// Sorted by name.
pub fn fabrics(store: &Store) -> Result<Vec<FabricRow>> {
    let mut fabrics = stored_fabrics(&store.reader)?;
    let sql = "SELECT name, sum(jobs) FROM fabric JOIN
        (SELECT fabric_id, count(*) AS jobs FROM job GROUP BY fabric_id) USING (fabric_id) GROUP BY name";
    let mut statement = store.reader.prepare_cached(sql)?;
    let mut used = statement.query([])?;
    while let Some(row) = used.next()? {
        let name: String = row.get(0)?;
        if let Some(found) = fabrics.iter_mut().find(|found| found.fabric.name == name) {
            found.jobs = row.get(1)?;
        }
    }
    Ok(fabrics)
}
