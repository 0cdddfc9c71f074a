//! Sizes of the styles of the catalogue, for lists and for work on their seams.

use rusqlite::{OptionalExtension, Row};

use crate::catalogue::style::{CURRENT_SIZES, seam_file};
use crate::seams::desk::confidences;
use crate::seams::workpiece::Workpiece;
use pattern::{Style, size_order};
use spec::patterns;
use store::files::SourceFile;
use store::{JobId, Result, SizeKey, Store, StudyError};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SizeRow {
    pub key: SizeKey,
    pub style: String,
    pub style_revision: i64,
    pub size: String,
    pub revision: i64,
    pub pattern_file: String,
    /// `None` where the pattern holds its seams.
    pub seam_file: Option<String>,
    /// Unit of the pattern, where its file names none.
    pub unit: Option<String>,
    /// Number of the style's proposed seams that nobody has confirmed.
    pub unconfirmed: usize,
}

/// Current sizes of all styles, by style, from the smallest to the largest.
pub fn sizes(store: &Store) -> Result<Vec<SizeRow>> {
    let sql = format!(
        "SELECT style_id, size_id, style.name, style.revision, size.name, size.revision, pattern_file,
            seam_file, unit, seams
        {CURRENT_SIZES}"
    );
    let row = |row: &Row<'_>| {
        let seam_file: String = row.get(7)?;
        let unsure = confidences(&row.get::<_, String>(9)?).into_iter().flatten();
        Ok(SizeRow {
            key: SizeKey { style: row.get(0)?, size: row.get(1)? },
            style: row.get(2)?,
            style_revision: row.get(3)?,
            size: row.get(4)?,
            revision: row.get(5)?,
            pattern_file: row.get(6)?,
            seam_file: (!seam_file.is_empty()).then_some(seam_file),
            unit: row.get(8)?,
            unconfirmed: unsure.count(),
        })
    };
    let mut statement = store.reader.prepare_cached(&sql)?;
    let mut sizes = statement.query_map([], row)?.collect::<rusqlite::Result<Vec<SizeRow>>>()?;
    for style in sizes.chunk_by_mut(|a, b| a.style == b.style) {
        size_order::sort(style, |row| &row.size);
    }
    Ok(sizes)
}

pub fn workpiece(store: &Store, key: SizeKey) -> Result<Workpiece> {
    let sql = "SELECT pattern_file, pattern, seam_file, seams, size.name, unit
        FROM size, style WHERE size_id = ? AND style_id = ?";
    let row = |row: &Row<'_>| {
        let unit: Option<String> = row.get(5)?;
        Ok(Workpiece {
            pattern: SourceFile { name: row.get(0)?, bytes: row.get::<_, Vec<u8>>(1)?.into() },
            seams: seam_file(row.get(2)?, row.get(3)?),
            size: row.get(4)?,
            unit: unit.as_deref().and_then(patterns::unit_of),
        })
    };
    let found = store.reader.prepare_cached(sql)?.query_row([key.size, key.style], row).optional()?;
    found.ok_or_else(|| StudyError::NotFound { what: "revision of a size", name: key.size.to_string(), known: vec![] })
}

pub fn workpiece_of(store: &Store, id: JobId) -> Result<Workpiece> {
    let sql = "SELECT style_id, size_id FROM job WHERE job_id = ?";
    let row = |row: &Row<'_>| Ok(SizeKey { style: row.get(0)?, size: row.get(1)? });
    let found = store.reader.prepare_cached(sql)?.query_row([id.0], row).optional()?;
    let missing = || StudyError::NotFound { what: "job", name: id.to_string(), known: vec![] };
    workpiece(store, found.ok_or_else(missing)?)
}

pub fn style_of(store: &Store, id: JobId) -> Result<Style> {
    let Workpiece { pattern, seams, size, unit } = workpiece_of(store, id)?;
    patterns::read_style(&pattern, seams.as_ref(), Some(&size), unit)
}
