//! Pairs from the printed tables of the thesis, with chi computed again from the printed lengths.

use rusqlite::{Connection, Row};

use crate::columns::simulator;
use crate::error::Result;
use fit::{Cuts, Errors, Pair, Simulator};
use geom::units::from_mm;

/// A row for each measurement of each case and simulator. The thesis prints no pattern girth at chest or hip, so the
/// ease here is the hem girth less the chest girth for tops and the dress, and the waist girth less the hip girth for
/// trousers. The pattern lengths are those printed for FEM, since Table 6-21 prints another waist length for Hybrid.
/// Subjects of both sexes have the same names, so the sex is put before the name.
const ROWS: &str = "
    WITH girth AS (
        SELECT garment, size, l2d_mm FROM published
        WHERE simulator = 'fem' AND measurement_no = iif(garment = 'male_trousers', 5, 1)
    ),
    body AS (SELECT name, chest_girth_mm, hip_girth_mm FROM subject WHERE revision = 1)
    SELECT garment, size, name, girth.l2d_mm - iif(garment = 'male_trousers', hip_girth_mm, chest_girth_mm) AS ease_mm,
        simulator, measurement_no, measurement, abs(chi - 1)
    FROM v_published JOIN girth USING (garment, size)
        JOIN body ON name = substr(garment, 1, instr(garment, '_') - 1) || '-' || subject
    ORDER BY garment, size, name, measurement_no, simulator";

/// Printed names, or their first words, of measurements along an edge that no seam holds.
const FREE_EDGES: [&str; 3] = ["Hem", "Sleeve Opening", "Neck Opening"];
/// Measurement that Hybrid-GS's pop-up step sets to its pattern length by construction [T 5.4].
const CONTROLLED: &str = "Hem";

/// All 54 cases of the thesis.
pub fn pairs(connection: &Connection) -> Result<Vec<Pair>> {
    let mut statement = connection.prepare_cached(ROWS)?;
    let mut rows = statement.query([])?;
    let mut pairs: Vec<Pair> = Vec::new();
    while let Some(row) = rows.next()? {
        let (garment, size, subject): (String, String, String) = (row.get(0)?, row.get(1)?, row.get(2)?);
        let known = pairs.last().is_some_and(|p| (&p.garment, &p.size, &p.subject) == (&garment, &size, &subject));
        if !known {
            let ease_m = from_mm(row.get(3)?);
            let class = Cuts::default().classify(ease_m);
            pairs.push(Pair { garment, size, subject, class, ease_m, errors: vec![] });
        }
        if let Some(pair) = pairs.last_mut() {
            add(pair, row)?;
        }
    }
    Ok(pairs)
}

fn add(pair: &mut Pair, row: &Row<'_>) -> Result<()> {
    let (no, name, error): (u32, String, f64) = (row.get(5)?, row.get(6)?, row.get(7)?);
    if pair.errors.last().is_none_or(|last| last.no != no) {
        let free_edge = FREE_EDGES.iter().any(|edge| name.starts_with(edge));
        let controlled = name.starts_with(CONTROLLED);
        pair.errors.push(Errors { no, name, fem: f64::NAN, hybrid: f64::NAN, free_edge, controlled });
    }
    if let Some(errors) = pair.errors.last_mut() {
        match simulator(row, 4)? {
            Simulator::Fem => errors.fem = error,
            Simulator::Hybrid => errors.hybrid = error,
        }
    }
    Ok(())
}
