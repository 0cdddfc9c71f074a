//! Contents of the catalogue: current revisions, built-in entries, and removal.

use std::collections::{BTreeMap, BTreeSet};

use rusqlite::{Connection, OptionalExtension, Row, Transaction};

use crate::catalogue::numbers::{columns, read_numbers};
use crate::catalogue::revision::{self, By};
use crate::catalogue::style::{CURRENT_SIZES, seam_file};
use crate::catalogue::table::{self, Read};
use crate::catalogue::{Part, Removed};
use body::{Figures, LengthUnit, Measurements, Pose, Sex};
use sim::{self, Fabric};
use spec::entry::Entry;
use spec::file::{Known, KnownSize, KnownStyle, ScanFile, SizeFile};
use spec::{FABRIC_NUMBERS, MEASUREMENTS, Person};
use store::files::{self, SourceFile};
use store::{Result, SizeKey, Store, StudyError, SubjectId};

/// The twelve subjects of the thesis [T tables 6-1 to 6-4].
const THESIS_SUBJECTS: &str = include_str!("../../../db/subjects.csv");

#[derive(Clone, Debug, PartialEq)]
pub struct SubjectRow {
    pub id: SubjectId,
    /// Same in all revisions.
    pub name: String,
    /// Counts from 1.
    pub revision: i64,
    /// Those taken on the scan, for a scan.
    pub measurements: Measurements,
    /// File name of the scan; `None` where the body is built from measurements.
    pub scan: Option<String>,
    /// `None` for the pose in which the body is built or scanned.
    pub pose: Option<Pose>,
    pub figures: Figures,
}

/// Adds the subjects of the thesis and the built-in fabrics to the catalogue, where they are missing. Does not write to
/// a database that has them, so that queries need not wait for other processes that write.
pub fn add_builtin(connection: &mut Connection) -> Result<()> {
    let mut content = blake3::Hasher::new();
    content.update(THESIS_SUBJECTS.as_bytes());
    content.update(format!("{:?}", sim::fabric::library()).as_bytes());
    let hash = content.finalize().to_hex().to_string();
    let is_there = "SELECT EXISTS (SELECT 1 FROM built_in WHERE hash = ?)";
    if connection.query_row(is_there, [&hash], |row| row.get(0))? {
        return Ok(());
    }
    let transaction = store::write(connection)?;
    transaction.execute("DELETE FROM built_in", [])?;
    transaction.execute("INSERT INTO built_in (hash) VALUES (?)", [&hash])?;
    for (name, measurements) in thesis_subjects()? {
        revision::subject(&transaction, &name, &measurements.into(), By::Program)?;
    }
    for cloth in sim::fabric::library() {
        revision::fabric(&transaction, &cloth, By::Program)?;
    }
    Ok(transaction.commit()?)
}

/// Entries that study files may name: the current ones of a database; without a database the built-in ones.
pub fn known(connection: Option<&Connection>) -> Result<Known> {
    let Some(connection) = connection else {
        return Ok(Known {
            subjects: thesis_subjects()?.into_iter().map(|(name, known)| (name, known.into())).collect(),
            fabrics: sim::fabric::library().into_iter().map(|cloth| (cloth.name.clone(), cloth)).collect(),
            ..Known::default()
        });
    };
    let subjects = stored_subjects(connection)?.into_iter().map(|row| {
        let scan = if row.scan.is_some() { stored_scan(connection, row.id)? } else { None };
        Ok((row.name, Person { measurements: row.measurements, scan, pose: row.pose, figures: row.figures }))
    });
    let fabrics = crate::catalogue::fabrics::stored_fabrics(connection)?
        .into_iter()
        .map(|row| (row.fabric.name.clone(), row.fabric));
    Ok(Known {
        subjects: subjects.collect::<Result<_>>()?,
        fabrics: fabrics.collect(),
        styles: styles(connection)?,
        hidden: hidden(connection)?,
    })
}

/// Removed entries that stay stored, such as `subject male-ii`.
fn hidden(connection: &Connection) -> Result<BTreeSet<String>> {
    let sql = "SELECT part || ' ' || name FROM catalogue_entry WHERE is_retired";
    Ok(connection.prepare_cached(sql)?.query_map([], |row| row.get(0))?.collect::<rusqlite::Result<_>>()?)
}

/// Current styles with their current sizes, by name.
fn styles(connection: &Connection) -> Result<BTreeMap<String, KnownStyle>> {
    let sql = format!(
        "SELECT style.name, seam_file, seams, size.name, pattern_file, pattern, unit
        {CURRENT_SIZES}"
    );
    let mut statement = connection.prepare_cached(&sql)?;
    let mut rows = statement.query([])?;
    let mut styles: BTreeMap<String, KnownStyle> = BTreeMap::new();
    while let Some(row) = rows.next()? {
        let seams = seam_file(row.get(1)?, row.get(2)?);
        let pattern = SourceFile { name: row.get(4)?, bytes: row.get::<_, Vec<u8>>(5)?.into() };
        let style = styles.entry(row.get(0)?).or_insert(KnownStyle { seams, sizes: vec![] });
        style.sizes.push(KnownSize { size: SizeFile { name: row.get(3)?, pattern }, unit: row.get(6)? });
    }
    Ok(styles)
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StyleFiles {
    pub style: String,
    /// `None` where the pattern holds its seams.
    pub seams: Option<SourceFile>,
    pub pattern: SourceFile,
    /// Unit of the pattern, where its file names none.
    pub unit: Option<String>,
}

pub fn read_style(connection: &Connection, SizeKey { style, size }: SizeKey) -> Result<StyleFiles> {
    let sql = "SELECT style.name, seam_file, seams, pattern_file, pattern, unit FROM style, size
        WHERE style_id = ? AND size_id = ?";
    Ok(connection.prepare_cached(sql)?.query_row([style, size], |row| {
        let pattern = SourceFile { name: row.get(3)?, bytes: row.get::<_, Vec<u8>>(4)?.into() };
        Ok(StyleFiles { style: row.get(0)?, seams: seam_file(row.get(1)?, row.get(2)?), pattern, unit: row.get(5)? })
    })?)
}

pub fn read_fabric(connection: &Connection, id: i64) -> Result<Fabric> {
    let sql = format!("SELECT name, source, {} FROM fabric WHERE fabric_id = ?", columns(&FABRIC_NUMBERS));
    Ok(connection.prepare_cached(&sql)?.query_row([id], |row| {
        let mut cloth = Fabric { source: row.get(1)?, ..Fabric::blank(&row.get::<_, String>(0)?) };
        read_numbers(row, 2, &FABRIC_NUMBERS, &mut cloth)?;
        Ok(cloth)
    })?)
}

fn stored_subjects(connection: &Connection) -> Result<Vec<SubjectRow>> {
    let sql = format!(
        "{} JOIN catalogue_entry AS entry USING (name, revision)
        WHERE part = 'subject' AND NOT is_retired ORDER BY name",
        select_subject()
    );
    let mut statement = connection.prepare_cached(&sql)?;
    let rows = statement.query_map([], subject_row)?.collect::<rusqlite::Result<_>>()?;
    Ok(rows)
}

fn select_subject() -> String {
    let scan = "(SELECT file FROM scan WHERE scan.subject_id = subject.subject_id)";
    format!("SELECT subject_id, name, revision, sex, {scan}, pose, figure, {} FROM subject", columns(&MEASUREMENTS))
}

fn subject_row(row: &Row<'_>) -> rusqlite::Result<SubjectRow> {
    let sex: String = row.get(3)?;
    let sex = if sex == "male" { Sex::Male } else { Sex::Female };
    let mut measurements = Measurements::of(sex, f64::NAN);
    read_numbers(row, 7, &MEASUREMENTS, &mut measurements)?;
    let (id, name, revision, scan) = (SubjectId(row.get(0)?), row.get(1)?, row.get(2)?, row.get(4)?);
    let pose = row.get::<_, Option<String>>(5)?.and_then(|text| text.parse().ok());
    let figure = row.get::<_, Option<String>>(6)?.unwrap_or_default();
    let figures = Figures::read(figure.split_whitespace()).unwrap_or_default();
    Ok(SubjectRow { id, name, revision, measurements, scan, pose, figures })
}

/// `None` where the body is built from measurements.
fn stored_scan(connection: &Connection, id: SubjectId) -> Result<Option<ScanFile>> {
    let sql = "SELECT file, unit, mesh FROM scan WHERE subject_id = ?";
    let row = |row: &Row<'_>| {
        let unit: Option<String> = row.get(1)?;
        let unit = LengthUnit::ALL.into_iter().find(|known| Some(known.name()) == unit.as_deref());
        let file = SourceFile { name: row.get(0)?, bytes: row.get::<_, Vec<u8>>(2)?.into() };
        Ok(ScanFile { file, unit })
    };
    Ok(connection.prepare_cached(sql)?.query_row([id.0], row).optional()?)
}

pub fn person(store: &Store, id: SubjectId) -> Result<Person> {
    let SubjectRow { measurements, pose, figures, .. } = subject_revision(store, id)?;
    Ok(Person { measurements, scan: stored_scan(&store.reader, id)?, pose, figures })
}

pub(super) fn thesis_subjects() -> Result<Vec<(String, Measurements)>> {
    let path = std::path::Path::new("db/subjects.csv");
    let read = table::read::<Measurements>(path, Part::Subject, THESIS_SUBJECTS.as_bytes());
    let Read { entries, problems } = read.map_err(StudyError::File)?;
    if !problems.is_empty() {
        return Err(StudyError::File(problems));
    }
    Ok(entries.into_iter().map(|placed| (placed.name, placed.entry)).collect())
}

/// Error for an entry that is not there: it is hidden, or nothing has the name.
pub(super) fn missing(connection: &Connection, part: Part, name: &str) -> Result<StudyError> {
    if hidden(connection)?.contains(&format!("{part} {name}")) {
        return Ok(StudyError::Hidden { what: part.as_str(), name: name.to_owned() });
    }
    let sql = "SELECT name FROM catalogue_entry WHERE part = ? AND NOT is_retired ORDER BY name";
    let mut statement = connection.prepare_cached(sql)?;
    let known = statement.query_map([part.as_str()], |row| row.get(0))?.collect::<rusqlite::Result<_>>()?;
    Ok(StudyError::NotFound { what: part.as_str(), name: name.to_owned(), known })
}

/// Only hides a built-in entry, and one that jobs use. Removes a style with its sizes. Fails where jobs wait or run
/// with the entry.
pub fn remove(transaction: &Transaction<'_>, part: Part, name: &str) -> Result<Removed> {
    if revision::current(transaction, part, name)?.is_none_or(|current| current.is_retired) {
        return Err(missing(transaction, part, name)?);
    }
    if part == Part::Style {
        for size in sizes(transaction, name)? {
            remove(transaction, Part::Size, &size)?;
        }
    }
    let table = part.as_str();
    let named = if part == Part::Size { "size.style || '/' || size.name" } else { &format!("{table}.name") };
    let sql = format!("SELECT count(*) FROM job JOIN {table} USING ({table}_id) WHERE {named} = ?");
    let jobs: i64 = transaction.query_row(&sql, [name], |row| row.get(0))?;
    let open = "SELECT study.name, count(*) FROM job JOIN study USING (study_id) JOIN";
    let open = format!(
        "{open} {table} USING ({table}_id) WHERE {named} = ? AND status IN ('queued', 'running')
        AND is_current GROUP BY study.name"
    );
    let waiting: Option<(String, i64)> =
        transaction.query_row(&open, [name], |row| Ok((row.get(0)?, row.get(1)?))).optional()?;
    if let Some((study, jobs)) = waiting {
        let word = files::word(&study);
        let problem =
            format!("{jobs} jobs of {study} wait or run with it; `toile queue cancel --study {word}` ends them");
        return Err(StudyError::Refused { what: part.as_str(), name: name.to_owned(), problems: vec![problem] });
    }
    let is_built_in = match part {
        Part::Subject => thesis_subjects()?.iter().any(|(built_in, _)| built_in == name),
        Part::Fabric => sim::fabric::library().iter().any(|cloth| cloth.name == name),
        Part::Style | Part::Size => false,
    };
    let is_hidden = jobs > 0 || is_built_in;
    if is_hidden {
        let sql = "UPDATE catalogue_entry SET is_retired = 1 WHERE part = ? AND name = ?";
        transaction.execute(sql, [part.as_str(), name])?;
    } else {
        transaction.execute(&format!("DELETE FROM {table} WHERE {named} = ?"), [name])?;
        if part == Part::Style {
            transaction.execute("DELETE FROM spec_sheet WHERE style = ?", [name])?;
        }
        transaction.execute("DELETE FROM catalogue_entry WHERE part = ? AND name = ?", [part.as_str(), name])?;
    }
    Ok(Removed { part, name: name.to_owned(), jobs, is_hidden })
}

fn sizes(transaction: &Transaction<'_>, style: &str) -> Result<Vec<String>> {
    let sql = "SELECT DISTINCT style || '/' || size FROM v_sizes WHERE style = ? AND NOT is_retired";
    let mut statement = transaction.prepare_cached(sql)?;
    let sizes = statement.query_map([style], |row| row.get(0))?.collect::<rusqlite::Result<_>>()?;
    Ok(sizes)
}

/// Sorted by name.
pub fn subjects(store: &Store) -> Result<Vec<SubjectRow>> {
    stored_subjects(&store.reader)
}

/// Current or earlier revision.
pub fn subject_revision(store: &Store, id: SubjectId) -> Result<SubjectRow> {
    let sql = format!("{} WHERE subject_id = ?", select_subject());
    let found = store.reader.prepare_cached(&sql)?.query_row([id.0], subject_row);
    found.map_err(|error| match error {
        rusqlite::Error::QueryReturnedNoRows => {
            StudyError::NotFound { what: "revision of a subject", name: id.0.to_string(), known: vec![] }
        }
        error => error.into(),
    })
}

pub fn subject(store: &Store, name: &str) -> Result<Person> {
    match known(Some(&store.reader))?.subjects.remove(name) {
        Some(person) => Ok(person),
        None => Err(missing(&store.reader, Part::Subject, name)?),
    }
}
