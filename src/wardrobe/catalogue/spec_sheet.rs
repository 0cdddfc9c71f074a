//! Specification sheets of styles: the sheet with the points of its rows, and the lengths of the pattern beside them.

use std::path::PathBuf;

use rusqlite::{OptionalExtension, Row, Transaction, params};

use crate::catalogue::sizes::{SizeRow, sizes, workpiece};
use crate::catalogue::{Part, known};
use crate::error::WardrobeError;
use crate::seams::spec_sheet::{Answer, AskedRow, Compared, SheetAsked, SpecLine, SpecReport, compared};
use crate::seams::workpiece::Workpiece;
use pattern::Style;
use pattern::spec_sheet::UNIT_SAID;
use pattern::spec_sheet::compared::Verdict;
use pattern::spec_sheet::matching::RowMatch;
use spec::patterns::{self, Unit};
use store::files::SourceFile;
use store::{Result, Store, StudyError, now_ms};

/// A sheet that is given for a style, or answers for the one that it has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpecGiven {
    /// `None` for the sheet that the style has.
    pub file: Option<PathBuf>,
    /// Name in the workbook; `None` for the first sheet with a table.
    pub sheet: Option<String>,
    /// `None` for the unit that the sheet says.
    pub unit: Option<Unit>,
    pub answers: Vec<Answer>,
}

struct Kept {
    file: SourceFile,
    sheet: String,
    unit: Unit,
    unit_from: String,
    answers: Vec<Answer>,
}

/// Reads a sheet, or the sheet that a style has with further answers, and keeps it with the style and the lengths of all
/// its sizes. Returns the specification beside the pattern; rows that are asked for are kept too.
pub fn keep_spec(store: &mut Store, style: &str, given: &SpecGiven) -> Result<SpecReport> {
    let rows = rows_of(store, style)?;
    let (file, sheet, unit, mut answers) = match (&given.file, kept(store, style)?) {
        (Some(path), _) => (SourceFile::read(path)?, given.sheet.clone(), given.unit, vec![]),
        (None, None) => return Err(WardrobeError::NoSpecSheet { style: style.to_owned() }.into()),
        (None, Some(Kept { file, sheet, unit, unit_from, answers })) => {
            let sheet = given.sheet.clone().or(Some(sheet).filter(|name| !name.is_empty()));
            let said = (unit_from == UNIT_SAID).then_some(unit);
            (file, sheet, given.unit.or(said), answers)
        }
    };
    answers.extend(given.answers.iter().cloned());
    let names: Vec<String> = rows.iter().map(|row| row.size.clone()).collect();
    let styles = rows.iter().map(|row| {
        let Workpiece { pattern, seams, size, unit } = workpiece(store, row.key)?;
        patterns::read_style(&pattern, seams.as_ref(), Some(&size), unit)
    });
    let styles = styles.collect::<Result<Vec<Style>>>()?;
    let asked = SheetAsked { sheet: sheet.as_deref(), unit };
    let found = compared(style, &file, asked, &answers, &names, &styles)?;
    let transaction = store::write(store.writer()?)?;
    write(&transaction, style, &file, &found, &answers)?;
    write_flats(&transaction, &rows, &found)?;
    transaction.commit()?;
    Ok(found.report)
}

/// Specification of a style beside its pattern, with the lengths worn by a subject: the one that is named, or the only
/// one. Sizes that have changed are measured again first, unless the database is read-only.
pub fn spec(store: &mut Store, style: &str, subject: Option<&str>) -> Result<SpecReport> {
    let rows = rows_of(store, style)?;
    if rows.is_empty() {
        return Err(WardrobeError::NoSpecSheet { style: style.to_owned() }.into());
    }
    let is_old = |row: &SizeRow| -> Result<bool> {
        let sql = "SELECT EXISTS (SELECT 1 FROM spec_length WHERE style = ?1 AND size = ?2)
            AND NOT EXISTS (SELECT 1 FROM spec_flat WHERE style_id = ?3 AND size_id = ?4)";
        let values = params![style, row.size, row.key.style, row.key.size];
        Ok(store.reader.prepare_cached(sql)?.query_row(values, |row| row.get(0))?)
    };
    let old = rows.iter().map(is_old).collect::<Result<Vec<bool>>>()?;
    if !store.is_readonly() && old.contains(&true) {
        keep_spec(store, style, &SpecGiven::default())?;
    }
    let Some(Kept { file, sheet, unit, unit_from, .. }) = kept(store, style)? else {
        return Err(WardrobeError::NoSpecSheet { style: style.to_owned() }.into());
    };
    let sizes = "SELECT size FROM spec_length WHERE style = ? GROUP BY size ORDER BY min(size_position)";
    let sizes =
        store.reader.prepare_cached(sizes)?.query_map([style], |row| row.get(0))?.collect::<rusqlite::Result<_>>()?;
    let counts = "SELECT count(*), count(point) FROM spec_row WHERE style = ?";
    let (rows, matched) =
        store.reader.prepare_cached(counts)?.query_row([style], |row| Ok((row.get(0)?, row.get(1)?)))?;
    let Worn { lines, notes } = worn(store, style, subject)?;
    Ok(SpecReport {
        garment: style.to_owned(),
        file: file.name,
        sheet,
        unit: unit.as_str().to_owned(),
        unit_from,
        rows,
        matched,
        sizes,
        lines,
        asked: asked(store, style)?,
        notes,
    })
}

/// Current sizes, from the smallest to the largest.
fn rows_of(store: &Store, style: &str) -> Result<Vec<SizeRow>> {
    let rows: Vec<SizeRow> = sizes(store)?.into_iter().filter(|row| row.style == style).collect();
    if rows.is_empty() {
        return Err(known::missing(&store.reader, Part::Style, style)?);
    }
    Ok(rows)
}

fn kept(store: &Store, style: &str) -> Result<Option<Kept>> {
    let sql = "SELECT file, bytes, sheet, unit, unit_from, answers FROM spec_sheet WHERE style = ?";
    let row = |row: &Row<'_>| {
        let (unit, answers): (String, String) = (row.get(3)?, row.get(5)?);
        Ok(Kept {
            file: SourceFile { name: row.get(0)?, bytes: row.get::<_, Vec<u8>>(1)?.into() },
            sheet: row.get(2)?,
            unit: patterns::unit_of(&unit).unwrap_or(Unit::Mm),
            unit_from: row.get(4)?,
            answers: answers.lines().filter_map(|line| line.parse().ok()).collect(),
        })
    };
    Ok(store.reader.prepare_cached(sql)?.query_row([style], row).optional()?)
}

/// Stores a sheet with its rows in place of the one before.
fn write(
    transaction: &Transaction<'_>,
    style: &str,
    file: &SourceFile,
    found: &Compared,
    answers: &[Answer],
) -> Result<()> {
    let Compared { sheet, matching, .. } = found;
    transaction.execute("DELETE FROM spec_sheet WHERE style = ?", [style])?;
    let answers: String = answers.iter().map(|answer| format!("{answer}\n")).collect();
    let (unit, why) = (matching.unit.unit, &matching.unit.why);
    transaction.execute(
        "INSERT INTO spec_sheet (style, file, sheet, unit, unit_from, bytes, answers, saved_at)
            VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
        params![style, file.name, sheet.sheet, unit.as_str(), why, &*file.bytes, answers, now_ms()],
    )?;
    let per_unit = unit.mm_per_unit();
    let mut row_sql = transaction.prepare_cached(
        "INSERT INTO spec_row (style, position, code, description, point, times, matched, minus_mm, plus_mm, asked,
            candidates) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
    )?;
    let mut length_sql = transaction.prepare_cached(
        "INSERT INTO spec_length (style, position, size_position, size, spec_mm) VALUES (?, ?, ?, ?, ?)",
    )?;
    for (position, (row, outcome)) in (1_i64..).zip(sheet.rows.iter().zip(&matching.rows)) {
        let (target, how, asked) = match outcome {
            RowMatch::Is(target, how) => (Some(target), how.as_str(), None),
            RowMatch::None => (None, "none", None),
            RowMatch::Asked { why, candidates } => (None, "asked", Some((why, candidates))),
        };
        let candidates = asked.map(|(_, all)| all.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "));
        let [minus_mm, plus_mm] = [row.minus, row.plus].map(|length| length.map(|length| length * per_unit));
        let point = target.map(|target| target.measure.to_string());
        let times = target.map_or(1.0, |target| target.times);
        let why = asked.map(|(why, _)| why);
        let (code, description) = (&row.code, &row.description);
        row_sql.execute(params![
            style,
            position,
            code,
            description,
            point,
            times,
            how,
            minus_mm,
            plus_mm,
            why,
            candidates
        ])?;
        for (k, (size, length)) in (1_i64..).zip(sheet.sizes.iter().zip(&row.lengths)) {
            if let Some(length) = length {
                length_sql.execute(params![style, position, k, size, length * per_unit])?;
            }
        }
    }
    Ok(())
}

/// Stores what the current sizes measure at the points of a sheet.
fn write_flats(transaction: &Transaction<'_>, rows: &[SizeRow], found: &Compared) -> Result<()> {
    let Compared { sheet, matching, flats, .. } = found;
    let mut sql = transaction
        .prepare_cached("INSERT OR REPLACE INTO spec_flat (style_id, size_id, point, flat_mm) VALUES (?, ?, ?, ?)")?;
    for outcome in &matching.rows {
        let RowMatch::Is(target, _) = outcome else { continue };
        let point = target.measure.to_string();
        for (size, flat_mm) in sheet.sizes.iter().zip(flats.get(&point).into_iter().flatten()) {
            let (Some(flat_mm), Some(row)) = (flat_mm, rows.iter().find(|row| row.size == *size)) else { continue };
            sql.execute(params![row.key.style, row.key.size, point, flat_mm])?;
        }
    }
    Ok(())
}

fn asked(store: &Store, style: &str) -> Result<Vec<AskedRow>> {
    let sql = "SELECT code, description, asked, candidates FROM spec_row WHERE style = ? AND matched = 'asked'
        ORDER BY position";
    let row = |row: &Row<'_>| {
        let candidates: String = row.get(3)?;
        Ok(AskedRow {
            code: row.get(0)?,
            description: row.get(1)?,
            why: row.get(2)?,
            candidates: candidates.split_whitespace().map(str::to_owned).collect(),
        })
    };
    Ok(store.reader.prepare_cached(sql)?.query_map([style], row)?.collect::<rusqlite::Result<_>>()?)
}

struct Worn {
    lines: Vec<SpecLine>,
    notes: Vec<String>,
}

/// Lines of a specification from `v_spec`. What is worn is that of one subject: by FEM-GS, or else Hybrid-GS.
fn worn(store: &Store, style: &str, subject: Option<&str>) -> Result<Worn> {
    let subjects = "SELECT DISTINCT subject FROM v_spec WHERE style = ? AND subject IS NOT NULL ORDER BY subject";
    let subjects: Vec<String> = store
        .reader
        .prepare_cached(subjects)?
        .query_map([style], |row| row.get(0))?
        .collect::<rusqlite::Result<_>>()?;
    let (wearer, note) = match (subject, &subjects[..]) {
        (Some(name), all) if all.iter().any(|known| known == name) => (Some(name.to_owned()), None),
        (Some(name), all) => {
            return Err(StudyError::NotFound {
                what: "subject with a result",
                name: name.to_owned(),
                known: all.to_vec(),
            });
        }
        (None, [only]) => (Some(only.clone()), Some(format!("worn by {only}"))),
        (None, []) => (None, None),
        (None, several) => (None, Some(format!("worn lengths are those of --subject, one of {}", several.join(", ")))),
    };
    // One row for each line: that of the wearer where there is one, the latest result first.
    let sql = "SELECT * FROM (
            SELECT *, row_number() OVER (PARTITION BY position, size_position
                ORDER BY subject IS ?2 DESC, simulator = 'fem' DESC, job_id DESC) AS place
            FROM v_spec WHERE style = ?1)
        WHERE place = 1 ORDER BY position, size_position";
    let line = |row: &Row<'_>| {
        let verdict: Option<String> = row.get("verdict")?;
        let who: Option<String> = row.get("subject")?;
        let worn_mm: Option<f64> = row.get("worn_mm")?;
        Ok(SpecLine {
            code: row.get("code")?,
            description: row.get("description")?,
            point: row.get("point")?,
            size: row.get("size")?,
            spec_mm: row.get("spec_mm")?,
            minus_mm: row.get("minus_mm")?,
            plus_mm: row.get("plus_mm")?,
            flat_mm: row.get("flat_mm")?,
            worn_mm: worn_mm.filter(|_| who.is_some() && who == wearer),
            deviation_mm: row.get("deviation_mm")?,
            verdict: verdict.map(|name| if name == Verdict::In.as_str() { Verdict::In } else { Verdict::Out }),
            step_mm: row.get("step_mm")?,
            flat_step_mm: row.get("flat_step_mm")?,
        })
    };
    let mut statement = store.reader.prepare_cached(sql)?;
    let lines = statement.query_map(params![style, wearer], line)?.collect::<rusqlite::Result<_>>()?;
    Ok(Worn { lines, notes: note.into_iter().collect() })
}
