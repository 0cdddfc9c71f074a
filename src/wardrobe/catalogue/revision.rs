//! Revisions of entries: found by their content, added where that is new, and made current.

use rusqlite::{OptionalExtension, ToSql, Transaction, named_params, params};

use crate::catalogue::Part;
use body::LengthUnit;
use sim::Fabric;
use spec::fields::sex_name;
use spec::file::ScanFile;
use spec::{FABRIC_NUMBERS, Inputs, MEASUREMENTS, Person, fabric_inputs, subject_inputs};
use store::files::SourceFile;
use store::{Result, now_ms};

/// Origin of a revision, which decides whether it becomes current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// The program, for a built-in entry. The revision becomes current if it is new, unless a user or study has changed
    /// the entry or somebody has removed it.
    Program,
    /// A study that is run. The revision becomes current if it is new.
    Study,
    /// A user. The revision becomes current.
    User,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Revision {
    /// Number of the row in the table of the entry's part.
    pub id: i64,
    /// Counts from 1.
    pub number: i64,
    pub is_new: bool,
}

pub(super) struct Current {
    pub number: i64,
    /// True where the entry was removed.
    pub is_retired: bool,
}

/// `None` where there never was one.
pub(super) fn current(transaction: &Transaction<'_>, part: Part, name: &str) -> Result<Option<Current>> {
    let sql = "SELECT revision, is_retired FROM catalogue_entry WHERE part = ? AND name = ?";
    let row = |row: &rusqlite::Row<'_>| Ok(Current { number: row.get(0)?, is_retired: row.get(1)? });
    Ok(transaction.prepare_cached(sql)?.query_row([part.as_str(), name], row).optional()?)
}

fn make_current(transaction: &Transaction<'_>, part: Part, name: &str, revision: Revision, by: By) -> Result<()> {
    transaction
        .prepare_cached(
            "INSERT INTO catalogue_entry (part, name, revision, is_own) VALUES (:part, :name, :revision, :own)
            ON CONFLICT (part, name) DO UPDATE
                SET revision = excluded.revision, is_own = excluded.is_own, is_retired = 0
                WHERE :wanted OR (:new AND (:own OR NOT (is_own OR is_retired)))",
        )?
        .execute(named_params! {
            ":part": part.as_str(), ":name": name, ":revision": revision.number, ":own": by != By::Program,
            ":wanted": by == By::User, ":new": revision.is_new,
        })?;
    Ok(())
}

/// Columns of the query are id and number.
fn found(transaction: &Transaction<'_>, sql: &str, parameters: &[&dyn ToSql]) -> Result<Option<Revision>> {
    let row = |row: &rusqlite::Row<'_>| Ok(Revision { id: row.get(0)?, number: row.get(1)?, is_new: false });
    Ok(transaction.prepare_cached(sql)?.query_row(parameters, row).optional()?)
}

/// Statement returns id and number.
fn added(transaction: &Transaction<'_>, sql: &str, parameters: &[&dyn ToSql]) -> Result<Revision> {
    let row = |row: &rusqlite::Row<'_>| Ok(Revision { id: row.get(0)?, number: row.get(1)?, is_new: true });
    Ok(transaction.prepare_cached(sql)?.query_row(parameters, row)?)
}

/// Revision of a subject with this body, added where the body is new.
pub fn subject(transaction: &Transaction<'_>, name: &str, person: &Person, by: By) -> Result<Revision> {
    let mut inputs = Inputs::default();
    subject_inputs(&mut inputs, name, person);
    let hash = inputs.hash();
    let sql = "SELECT subject_id, revision FROM subject WHERE name = ? AND hash = ?";
    let revision = match found(transaction, sql, &[&name, &hash])? {
        Some(revision) => revision,
        None => {
            let Person { measurements, scan, pose, figures } = person;
            let numbers = MEASUREMENTS.iter().map(|field| (field.key, field.get(measurements)));
            let added = insert(transaction, "subject", name, &hash, ("sex", sex_name(measurements)), numbers)?;
            if let Some(ScanFile { file, unit }) = scan {
                let sql = "INSERT INTO scan (subject_id, file, unit, mesh) VALUES (?, ?, ?, ?)";
                transaction.execute(sql, params![added.id, file.name, unit.map(LengthUnit::name), &*file.bytes])?;
            }
            if let Some(pose) = pose {
                let sql = "UPDATE subject SET pose = ? WHERE subject_id = ?";
                transaction.execute(sql, params![pose.to_string(), added.id])?;
            }
            if !figures.is_empty() {
                let sql = "UPDATE subject SET figure = ? WHERE subject_id = ?";
                transaction.execute(sql, params![figures.to_string(), added.id])?;
            }
            added
        }
    };
    make_current(transaction, Part::Subject, name, revision, by)?;
    Ok(revision)
}

/// Revision of a fabric with these numbers, added where they are new.
pub fn fabric(transaction: &Transaction<'_>, cloth: &Fabric, by: By) -> Result<Revision> {
    let mut inputs = Inputs::default();
    fabric_inputs(&mut inputs, cloth);
    inputs.set("fabric.source", &cloth.source);
    let (name, hash) = (cloth.name.as_str(), inputs.hash());
    let sql = "SELECT fabric_id, revision FROM fabric WHERE name = ? AND hash = ?";
    let revision = match found(transaction, sql, &[&name, &hash])? {
        Some(revision) => revision,
        None => {
            let numbers = FABRIC_NUMBERS.iter().map(|field| (field.key, field.get(cloth)));
            insert(transaction, "fabric", name, &hash, ("source", &cloth.source), numbers)?
        }
    };
    make_current(transaction, Part::Fabric, name, revision, by)?;
    Ok(revision)
}

/// Texts and numbers come with the names of their columns.
fn insert(
    transaction: &Transaction<'_>,
    table: &str,
    name: &str,
    hash: &str,
    (text_column, text): (&str, &str),
    numbers: impl Iterator<Item = (&'static str, Option<f64>)>,
) -> Result<Revision> {
    let (columns, values): (Vec<&str>, Vec<Option<f64>>) = numbers.unzip();
    let sql = format!(
        "INSERT INTO {table} (name, revision, hash, created_at, {text_column}, {})
        VALUES (?1, 1 + (SELECT count(*) FROM {table} WHERE name = ?1), ?2, ?3, ?4{})
        RETURNING {table}_id, revision",
        columns.join(", "),
        ", ?".repeat(columns.len()), // SQLite numbers each one after the greatest number before it
    );
    let now = now_ms();
    let mut parameters: Vec<&dyn ToSql> = vec![&name, &hash, &now, &text];
    parameters.extend(values.iter().map(|value| value as &dyn ToSql));
    added(transaction, &sql, &parameters)
}

/// Revision of a style with this seam file, added where it is new. Without a seam file its name and text are empty.
pub fn style(transaction: &Transaction<'_>, name: &str, seams: Option<&SourceFile>, by: By) -> Result<Revision> {
    let none = SourceFile { name: String::new(), bytes: [].into() };
    let seams = seams.unwrap_or(&none);
    let hash = seams.hash();
    let sql = "SELECT style_id, revision FROM style WHERE name = ? AND hash = ?";
    let revision = match found(transaction, sql, &[&name, &hash])? {
        Some(revision) => revision,
        None => {
            let text = String::from_utf8_lossy(&seams.bytes);
            let sql = "INSERT INTO style (name, revision, hash, seam_file, seams, created_at)
                VALUES (?1, 1 + (SELECT count(*) FROM style WHERE name = ?1), ?2, ?3, ?4, ?5)
                RETURNING style_id, revision";
            added(transaction, sql, params![name, hash, seams.name, text, now_ms()])?
        }
    };
    make_current(transaction, Part::Style, name, revision, by)?;
    Ok(revision)
}

/// Revision of a size with this pattern, added where it is new.
pub fn size(
    transaction: &Transaction<'_>,
    (style, name): (&str, &str),
    pattern: &SourceFile,
    unit: Option<&str>,
    by: By,
) -> Result<Revision> {
    let mut inputs = Inputs::default();
    inputs.set("pattern", pattern.hash());
    inputs.set("unit", unit.unwrap_or_default());
    let hash = inputs.hash();
    let sql = "SELECT size_id, revision FROM size WHERE style = ? AND name = ? AND hash = ?";
    let revision = match found(transaction, sql, &[&style, &name, &hash])? {
        Some(revision) => revision,
        None => {
            let sql = "INSERT INTO size (style, name, revision, hash, pattern_file, unit, pattern, created_at)
                VALUES (?1, ?2, 1 + (SELECT count(*) FROM size WHERE style = ?1 AND name = ?2), ?3, ?4, ?5, ?6, ?7)
                RETURNING size_id, revision";
            added(transaction, sql, params![style, name, hash, pattern.name, unit, &*pattern.bytes, now_ms()])?
        }
    };
    make_current(transaction, Part::Size, &format!("{style}/{name}"), revision, by)?;
    Ok(revision)
}
