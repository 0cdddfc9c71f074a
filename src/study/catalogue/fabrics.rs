//! The fabrics of the catalogue as lists show them.

use rusqlite::{Connection, Row};

use crate::catalogue::known::{columns, read_numbers};
use crate::error::Result;
use crate::spec::fields::{Entry, FABRIC_NUMBERS};
use crate::store::Store;
use geom::units::GRAVITY;
use sim::Fabric;

/// A fabric of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct FabricRow {
    /// Its name, numbers and their source.
    pub fabric: Fabric,
    /// Number of the revision.
    pub revision: i64,
    /// Whether somebody here added or changed it; else it is of the library.
    pub is_own: bool,
    /// Jobs that use it, in whatever revision.
    pub jobs: i64,
}

impl FabricRow {
    /// Length of a strip, along the grain and across it, that bends under its own weight as Peirce's test has it:
    /// `(B / (w g))^(1/3)`, m [Peirce 1930].
    #[must_use]
    pub fn bending_lengths_m(&self) -> [f64; 2] {
        let Fabric { bending_warp_nm, bending_weft_nm, density_kg_m2, .. } = self.fabric;
        [bending_warp_nm, bending_weft_nm].map(|rigidity| (rigidity / (density_kg_m2 * GRAVITY)).cbrt())
    }

    /// Force that stretches a strip along the grain and across it by a share of its length, per width, N/m; the strip may
    /// become narrower.
    #[must_use]
    pub fn tensions_n_m(&self, stretch: f64) -> [f64; 2] {
        let strain = stretch * (1.0 + 0.5 * stretch);
        let laws = [self.fabric.warp_law(), self.fabric.weft_law()];
        laws.map(|law| (1.0 + stretch) * law.stress(strain))
    }
}

/// The current fabrics, by name, without the number of their jobs.
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

/// The fabrics of the catalogue, by name.
///
/// # Errors
/// When the database cannot be read.
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
