//! The catalogue: subjects, styles, sizes and fabrics with revisions. An edit adds a revision, content seen before is
//! found again, and nothing a result came from is ever changed.

use rusqlite::{Connection, OptionalExtension, Row, ToSql, Transaction, named_params, params};

use super::error::{Result, StudyError};
use super::file::{Known, SourceFile};
use super::inputs::Inputs;
use super::spec::{fabric_inputs, millimetres, sex_name, subject_inputs};
use super::store::{self, now_ms};
use super::tools;
use super::types::JobId;
use super::workspace::Workspace;
use crate::body::{Measurements, Sex};
use crate::pattern::Style;
use crate::sim::fabric::Stretched;
use crate::sim::{self, Fabric};
use crate::units::from_mm;

/// The thesis's twelve subjects [T tables 6-1 to 6-4].
const THESIS_SUBJECTS: &str = include_str!("../../db/subjects.csv");

/// Puts the thesis's subjects and the fabric library into the catalogue, where they are not there yet.
pub(crate) fn add_builtin(connection: &mut Connection) -> Result<()> {
    let transaction = store::write(connection)?;
    for (name, measurements) in thesis_subjects()? {
        subject(&transaction, &name, &measurements)?;
    }
    for cloth in sim::fabric::library() {
        fabric(&transaction, &cloth)?;
    }
    Ok(transaction.commit()?)
}

/// What study files may name: the built-in entries and, over them, the latest revisions of a database.
pub(crate) fn known(connection: Option<&Connection>) -> Result<Known> {
    let mut known = Known {
        subjects: thesis_subjects()?.into_iter().collect(),
        fabrics: sim::fabric::library().into_iter().map(|cloth| (cloth.name.clone(), cloth)).collect(),
    };
    let Some(connection) = connection else { return Ok(known) };
    let sql = "SELECT subject, sex, stature_mm, weight_kg, chest_girth_mm, waist_girth_mm, hip_girth_mm, neck_girth_mm,
            across_shoulder_mm
        FROM v_subjects WHERE is_latest";
    let mut statement = connection.prepare(sql)?;
    for row in statement.query_map([], subject_row)? {
        known.subjects.extend([row?]);
    }
    let sql = "SELECT fabric, density_kg_m2, thickness_mm, membrane_warp_n_m, membrane_weft_n_m, membrane_coupling_n_m,
            shear_n_m, bending_warp_nm, bending_weft_nm, friction_body, friction_self, source,
            stretch, stretched_warp_n_m, stretched_weft_n_m
        FROM v_fabrics WHERE is_latest";
    let mut statement = connection.prepare(sql)?;
    for row in statement.query_map([], fabric_row)? {
        let cloth = row?;
        known.fabrics.insert(cloth.name.clone(), cloth);
    }
    Ok(known)
}

fn subject_row(row: &Row<'_>) -> rusqlite::Result<(String, Measurements)> {
    let sex: String = row.get(1)?;
    let length = |column| row.get::<_, Option<f64>>(column).map(|x| x.map(from_mm));
    let measurements = Measurements {
        sex: if sex == "male" { Sex::Male } else { Sex::Female },
        stature_m: from_mm(row.get(2)?),
        weight_kg: row.get(3)?,
        chest_girth_m: length(4)?,
        waist_girth_m: length(5)?,
        hip_girth_m: length(6)?,
        neck_girth_m: length(7)?,
        across_shoulder_m: length(8)?,
    };
    Ok((row.get(0)?, measurements))
}

fn fabric_row(row: &Row<'_>) -> rusqlite::Result<Fabric> {
    Ok(Fabric {
        name: row.get(0)?,
        density_kg_m2: row.get(1)?,
        thickness_m: from_mm(row.get(2)?),
        membrane_warp_n_m: row.get(3)?,
        membrane_weft_n_m: row.get(4)?,
        membrane_coupling_n_m: row.get(5)?,
        shear_n_m: row.get(6)?,
        bending_warp_nm: row.get(7)?,
        bending_weft_nm: row.get(8)?,
        friction_body: row.get(9)?,
        friction_self: row.get(10)?,
        source: row.get(11)?,
        stretched: stretched([row.get(12)?, row.get(13)?, row.get(14)?]),
    })
}

/// Moduli under stretch from their three columns, which are set together.
pub(super) fn stretched(columns: [Option<f64>; 3]) -> Option<Stretched> {
    let [stretch, warp, weft] = columns;
    Some(Stretched { stretch: stretch?, membrane_warp_n_m: warp?, membrane_weft_n_m: weft? })
}

/// The built-in subjects, by name.
fn thesis_subjects() -> Result<Vec<(String, Measurements)>> {
    let unreadable = |error: csv::Error| StudyError::Stage { stage: "catalogue", message: error.to_string() };
    csv::Reader::from_reader(THESIS_SUBJECTS.as_bytes())
        .deserialize()
        .map(|row| {
            type Lengths = (f64, f64, f64, f64, f64);
            let (name, sex, stature, weight, girths): (String, Sex, f64, f64, Lengths) = row.map_err(unreadable)?;
            let measurements = Measurements {
                sex,
                stature_m: from_mm(stature),
                weight_kg: Some(weight),
                chest_girth_m: Some(from_mm(girths.0)),
                waist_girth_m: Some(from_mm(girths.1)),
                hip_girth_m: Some(from_mm(girths.2)),
                neck_girth_m: Some(from_mm(girths.3)),
                across_shoulder_m: Some(from_mm(girths.4)),
            };
            Ok((name, measurements))
        })
        .collect()
}

/// The revision of a subject with these measurements, added where it is new.
pub(crate) fn subject(transaction: &Transaction<'_>, name: &str, m: &Measurements) -> Result<i64> {
    let mut inputs = Inputs::default();
    subject_inputs(&mut inputs, name, m);
    let hash = inputs.hash();
    if let Some(id) = found(transaction, "SELECT subject_id FROM subject WHERE name = ? AND hash = ?", &[&name, &hash])?
    {
        return Ok(id);
    }
    transaction
        .prepare_cached(
            "INSERT INTO subject (name, revision, hash, sex, stature_mm, weight_kg, chest_girth_mm, waist_girth_mm,
                hip_girth_mm, neck_girth_mm, across_shoulder_mm, created_at)
            VALUES (:name, 1 + (SELECT count(*) FROM subject WHERE name = :name), :hash, :sex, :stature, :weight, :chest,
                :waist, :hip, :neck, :shoulder, :now)",
        )?
        .execute(named_params! {
            ":name": name, ":hash": hash, ":sex": sex_name(m), ":stature": millimetres(m.stature_m),
            ":weight": m.weight_kg, ":chest": m.chest_girth_m.map(millimetres),
            ":waist": m.waist_girth_m.map(millimetres), ":hip": m.hip_girth_m.map(millimetres),
            ":neck": m.neck_girth_m.map(millimetres), ":shoulder": m.across_shoulder_m.map(millimetres),
            ":now": now_ms(),
        })?;
    Ok(transaction.last_insert_rowid())
}

/// The revision of a fabric with these numbers, added where it is new.
pub(crate) fn fabric(transaction: &Transaction<'_>, cloth: &Fabric) -> Result<i64> {
    let mut inputs = Inputs::default();
    fabric_inputs(&mut inputs, cloth);
    inputs.set("fabric.source", &cloth.source);
    let hash = inputs.hash();
    let sql = "SELECT fabric_id FROM fabric WHERE name = ? AND hash = ?";
    if let Some(id) = found(transaction, sql, &[&cloth.name, &hash])? {
        return Ok(id);
    }
    transaction
        .prepare_cached(
            "INSERT INTO fabric (name, revision, hash, density_kg_m2, thickness_mm, membrane_warp_n_m, membrane_weft_n_m,
                membrane_coupling_n_m, shear_n_m, bending_warp_nm, bending_weft_nm, friction_body, friction_self, source,
                stretch, stretched_warp_n_m, stretched_weft_n_m, created_at)
            VALUES (:name, 1 + (SELECT count(*) FROM fabric WHERE name = :name), :hash, :density, :thickness, :warp, :weft,
                :coupling, :shear, :bend_warp, :bend_weft, :friction_body, :friction_self, :source,
                :stretch, :stretched_warp, :stretched_weft, :now)",
        )?
        .execute(named_params! {
            ":name": cloth.name, ":hash": hash, ":density": cloth.density_kg_m2,
            ":thickness": millimetres(cloth.thickness_m), ":warp": cloth.membrane_warp_n_m,
            ":weft": cloth.membrane_weft_n_m, ":coupling": cloth.membrane_coupling_n_m, ":shear": cloth.shear_n_m,
            ":bend_warp": cloth.bending_warp_nm, ":bend_weft": cloth.bending_weft_nm,
            ":friction_body": cloth.friction_body, ":friction_self": cloth.friction_self, ":source": cloth.source,
            ":stretch": cloth.stretched.map(|s| s.stretch),
            ":stretched_warp": cloth.stretched.map(|s| s.membrane_warp_n_m),
            ":stretched_weft": cloth.stretched.map(|s| s.membrane_weft_n_m),
            ":now": now_ms(),
        })?;
    Ok(transaction.last_insert_rowid())
}

/// The revision of a style with this seam file, added where it is new.
pub(crate) fn style(transaction: &Transaction<'_>, name: &str, seams: &SourceFile) -> Result<i64> {
    let hash = seams.hash();
    if let Some(id) = found(transaction, "SELECT style_id FROM style WHERE name = ? AND hash = ?", &[&name, &hash])? {
        return Ok(id);
    }
    let text = String::from_utf8_lossy(&seams.bytes);
    transaction
        .prepare_cached(
            "INSERT INTO style (name, revision, hash, seam_file, seams, created_at)
            VALUES (?1, 1 + (SELECT count(*) FROM style WHERE name = ?1), ?2, ?3, ?4, ?5)",
        )?
        .execute(params![name, hash, seams.name, text, now_ms()])?;
    Ok(transaction.last_insert_rowid())
}

/// The revision of a size with this pattern, added where it is new.
pub(crate) fn size(
    transaction: &Transaction<'_>,
    style: &str,
    name: &str,
    pattern: &SourceFile,
    unit: Option<&str>,
) -> Result<i64> {
    let mut inputs = Inputs::default();
    inputs.set("pattern", pattern.hash());
    inputs.set("unit", unit.unwrap_or_default());
    let hash = inputs.hash();
    let sql = "SELECT size_id FROM size WHERE style = ? AND name = ? AND hash = ?";
    if let Some(id) = found(transaction, sql, &[&style, &name, &hash])? {
        return Ok(id);
    }
    transaction
        .prepare_cached(
            "INSERT INTO size (style, name, revision, hash, pattern_file, unit, pattern, created_at)
            VALUES (?1, ?2, 1 + (SELECT count(*) FROM size WHERE style = ?1 AND name = ?2), ?3, ?4, ?5, ?6, ?7)",
        )?
        .execute(params![style, name, hash, pattern.name, unit, &*pattern.bytes, now_ms()])?;
    Ok(transaction.last_insert_rowid())
}

/// The number of an entry that is there already.
fn found(transaction: &Transaction<'_>, sql: &str, parameters: &[&dyn ToSql]) -> Result<Option<i64>> {
    Ok(transaction.prepare_cached(sql)?.query_row(parameters, |row| row.get(0)).optional()?)
}

impl Workspace {
    /// The style a job was made from.
    ///
    /// # Errors
    /// When there is no such job.
    pub(super) fn style_of(&self, id: JobId) -> Result<Style> {
        let sql = "SELECT pattern_file, pattern, seam_file, seams, unit, size.name
            FROM job JOIN size USING (size_id) JOIN style USING (style_id) WHERE job_id = ?";
        type Stored = (String, Vec<u8>, String, String, Option<String>, String);
        let row = |row: &Row<'_>| {
            Ok::<Stored, _>((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?, row.get(4)?, row.get(5)?))
        };
        let found = self.reader.prepare_cached(sql)?.query_row([id.0], row).optional()?;
        let missing = || StudyError::NotFound { what: "job", name: id.to_string(), known: vec![] };
        let (pattern_file, pattern, seam_file, seams, unit, size) = found.ok_or_else(missing)?;
        let pattern = SourceFile { name: pattern_file, bytes: pattern.into() };
        let seams = SourceFile { name: seam_file, bytes: seams.into_bytes().into() };
        tools::read_style(&pattern, &seams, Some(&size), unit.as_deref().and_then(tools::unit_of))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_is_a_revision_and_known_content_is_found_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut connection =
            store::open(&folder.path().join("toile.sqlite"), store::Access::Write).expect("a new database");
        let (_, original) = thesis_subjects().expect("built in").swap_remove(1);
        let edited = Measurements { stature_m: 1.70, ..original.clone() };
        let transaction = store::write(&mut connection).expect("idle");
        let ids = [&original, &edited, &original].map(|m| subject(&transaction, "ii", m).expect("valid"));
        assert_eq!(ids[0], ids[2]);
        assert_ne!(ids[0], ids[1]);
        transaction.commit().expect("idle");
        let known = known(Some(&connection)).expect("readable");
        assert_eq!(known.subjects["ii"], edited);
        assert_eq!(known.subjects["male-ii"], original);
    }
}
