//! Revisions: what is stored of an entry, found again by its content, and which of them is the current one.

use rusqlite::{OptionalExtension, ToSql, Transaction, named_params, params};

use crate::catalogue::Part;
use body::LengthUnit;
use sim::Fabric;
use spec::fields::sex_name;
use spec::file::ScanFile;
use spec::{FABRIC_NUMBERS, Inputs, MEASUREMENTS, Person, fabric_inputs, subject_inputs};
use store::files::SourceFile;
use store::{Result, now_ms};

/// Who brings a revision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// The program, with what is built in: becomes current where nobody else has changed the entry.
    Program,
    /// A study that is run: becomes current where the content is new.
    Study,
    /// A user: becomes current.
    User,
}

/// A revision of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Revision {
    /// Row of the entry's table.
    pub id: i64,
    /// Number, from 1.
    pub number: i64,
    /// Whether it was added just now.
    pub is_new: bool,
}

/// The current revision of an entry and whether it was removed; `None` where there never was one.
pub(super) fn current(transaction: &Transaction<'_>, part: Part, name: &str) -> Result<Option<(i64, bool)>> {
    let sql = "SELECT revision, is_retired FROM catalogue_entry WHERE part = ? AND name = ?";
    let row = |row: &rusqlite::Row<'_>| Ok((row.get(0)?, row.get(1)?));
    Ok(transaction.prepare_cached(sql)?.query_row([part.as_str(), name], row).optional()?)
}

/// Makes a revision the current one, as far as whoever brings it may.
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

/// The revision that a query finds, its columns id and number.
fn found(transaction: &Transaction<'_>, sql: &str, parameters: &[&dyn ToSql]) -> Result<Option<Revision>> {
    let row = |row: &rusqlite::Row<'_>| Ok(Revision { id: row.get(0)?, number: row.get(1)?, is_new: false });
    Ok(transaction.prepare_cached(sql)?.query_row(parameters, row).optional()?)
}

/// The revision that a statement adds, which returns its id and number.
fn added(transaction: &Transaction<'_>, sql: &str, parameters: &[&dyn ToSql]) -> Result<Revision> {
    let row = |row: &rusqlite::Row<'_>| Ok(Revision { id: row.get(0)?, number: row.get(1)?, is_new: true });
    Ok(transaction.prepare_cached(sql)?.query_row(parameters, row)?)
}

/// The revision of a subject who is this person, added where it is new.
pub fn subject(transaction: &Transaction<'_>, name: &str, person: &Person, by: By) -> Result<Revision> {
    let mut inputs = Inputs::default();
    subject_inputs(&mut inputs, name, person);
    let hash = inputs.hash();
    let sql = "SELECT subject_id, revision FROM subject WHERE name = ? AND hash = ?";
    let revision = match found(transaction, sql, &[&name, &hash])? {
        Some(revision) => revision,
        None => {
            let Person { measurements, scan, pose } = person;
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
            added
        }
    };
    make_current(transaction, Part::Subject, name, revision, by)?;
    Ok(revision)
}

/// The revision of a fabric with these numbers, added where it is new.
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

/// Adds a revision of a subject or a fabric: its text and its numbers, each with the name of its column.
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
        ", ?".repeat(columns.len()), // each is numbered on from the greatest before it
    );
    let now = now_ms();
    let mut parameters: Vec<&dyn ToSql> = vec![&name, &hash, &now, &text];
    parameters.extend(values.iter().map(|value| value as &dyn ToSql));
    added(transaction, &sql, &parameters)
}

/// The revision of a style with this seam file, added where it is new; the name and text of no seam file are empty.
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

/// The revision of a size with this pattern, added where it is new.
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
