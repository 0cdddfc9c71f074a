//! Styles and their sizes in the catalogue: a seam file, and a pattern a size that can be sewn by it.

use std::path::PathBuf;

use rusqlite::{OptionalExtension, Row, Transaction};

use crate::catalogue::format::{Format, format_of, text_of, unknown_format};
use crate::catalogue::revision::{self, By};
use crate::catalogue::{Mode, Part, Saved, check_name, refused, save};
use crate::seams::workpiece::Workpiece;
use pattern::{Style, size_order, source};
use spec::file::{self, Placed, Sewn, SizeFile};
use spec::patterns::{self, Nest};
use store::files::SourceFile;
use store::{InOrigin, JobId, Origin, Problem, Result, Store, StudyError};

/// What is given of a style or a size; an edit keeps what is not.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StyleGiven {
    /// Seam file of the style.
    pub seams: Option<PathBuf>,
    /// Whether seams are proposed where a new style has none: no seam file, and patterns that hold none.
    pub is_proposed: bool,
    /// Unit of the patterns, where their files name none: `mm`, `cm`, `in` or `m`.
    pub unit: Option<String>,
    /// Patterns, each with the size it is; a file without one brings all sizes in it.
    pub patterns: Vec<(Option<String>, PathBuf)>,
}

/// The size of a pattern that names none.
const UNNAMED: &str = "ONE";

/// A size with the unit of its pattern.
type Sized = (SizeFile, Option<String>);

/// What becomes of the seams of a style.
enum Seams {
    /// They stay those that the style has.
    Kept,
    /// They are those of a file, or of the patterns themselves.
    Given(Option<SourceFile>),
}

/// A style as it is to be stored: its seams and sizes.
struct Draft {
    name: String,
    seams: Seams,
    sizes: Vec<Sized>,
}

/// Saves a style: its seam file, and its sizes. Every size, given now or earlier, must be sewable by the seams.
///
/// # Errors
/// When a file cannot be read or sewn, the name is taken (`Add`) or unknown (`Edit`), or the database is open read-only.
pub fn save_style(store: &mut Store, mode: Mode, name: &str, given: &StyleGiven) -> Result<Vec<Saved>> {
    check_name(name).map_err(|problem| refused(Part::Style, name, vec![problem]))?;
    let sizes = sizes_given(store, name, given)?;
    let seams = match (&given.seams, sizes.first()) {
        (Some(path), first) if mode != Mode::Add || first.is_some() => Seams::Given(Some(SourceFile::read(path)?)),
        (None, _) if mode != Mode::Add => Seams::Kept,
        (None, Some(_)) if sizes.iter().all(|(size, _)| size.pattern.holds_seams()) => Seams::Given(None),
        (None, Some(_)) if given.is_proposed => Seams::Given(Some(proposed(name, &sizes)?)),
        _ => {
            let problem = "a new style needs at least one pattern, and a seam file (or --propose) unless its patterns \
                are GarmentCode JSON";
            return Err(refused(Part::Style, name, vec![problem.to_owned()]));
        }
    };
    store_style(store, mode, Draft { name: name.to_owned(), seams, sizes })
}

/// The seam file proposed for all sizes of a style, made on the sample size of the first pattern that holds several, or
/// else on the middle size.
fn proposed(style: &str, sizes: &[Sized]) -> Result<SourceFile> {
    let unit_of = |unit: &Option<String>| unit.as_deref().and_then(patterns::unit_of);
    let mut made_on = &sizes[sizes.len() / 2];
    let mut drawn = Vec::new();
    for sized in sizes {
        let nest = Nest::read(&sized.0.pattern, unit_of(&sized.1))?;
        if nest.sizes().len() > 1 && nest.sample_size().eq_ignore_ascii_case(&sized.0.name) {
            made_on = sized;
        }
        drawn.push((sized.0.name.clone(), nest.pieces(&sized.0.name)));
    }
    let (size, unit) = made_on;
    drawn.retain(|(name, _)| *name != size.name);
    let pattern = size.pattern.clone();
    Workpiece { pattern, seams: None, size: size.name.clone(), unit: unit_of(unit) }.proposed_for(style, drawn)
}

/// Saves other seams of a style that is there. Every size must be sewable by them.
///
/// # Errors
/// As [`save_style`].
pub fn save_seams(store: &mut Store, name: &str, seams: &SourceFile) -> Result<Vec<Saved>> {
    let seams = Seams::Given(Some(seams.clone()));
    store_style(store, Mode::Edit, Draft { name: name.to_owned(), seams, sizes: vec![] })
}

fn store_style(store: &mut Store, mode: Mode, draft: Draft) -> Result<Vec<Saved>> {
    let problems = unsewable(store, &draft)?;
    if !problems.is_empty() {
        return Err(refused(Part::Style, &draft.name, problems));
    }
    let transaction = store::write(store.writer()?)?;
    let saved = store_draft(&transaction, [mode, Mode::Import], &draft)?;
    transaction.commit()?;
    Ok(saved)
}

/// Saves a size, named `STYLE/SIZE`, of a style that is there.
///
/// # Errors
/// As [`save_style`].
pub fn save_size(store: &mut Store, mode: Mode, name: &str, given: &StyleGiven) -> Result<Saved> {
    let refuse = |problem: &str| refused(Part::Size, name, vec![problem.to_owned()]);
    let (style, size) = name.split_once('/').ok_or_else(|| refuse("its name; accepted: STYLE/SIZE"))?;
    check_name(size).map_err(|problem| refuse(&problem))?;
    let sizes = match (given.patterns.as_slice(), &given.unit) {
        ([(_, path)], unit) => {
            let before = sizes_of(store, style)?.into_iter().find(|(before, _)| before.name == size);
            let unit = unit.clone().or(before.and_then(|(_, unit)| unit));
            vec![(SizeFile { name: size.to_owned(), pattern: SourceFile::read_pattern(path)? }, unit)]
        }
        ([], Some(unit)) => {
            let before = sizes_of(store, style)?.into_iter().filter(|(before, _)| before.name == size);
            before.map(|(before, _)| (before, Some(unit.clone()))).collect()
        }
        _ => return Err(refuse("a size has one pattern")),
    };
    let draft = Draft { name: style.to_owned(), seams: Seams::Kept, sizes };
    let problems = unsewable(store, &draft)?;
    if !problems.is_empty() {
        return Err(refused(Part::Size, name, problems));
    }
    let transaction = store::write(store.writer()?)?;
    let mut saved = store_draft(&transaction, [mode; 2], &draft)?;
    transaction.commit()?;
    saved.pop().ok_or_else(|| StudyError::NotFound { what: "size", name: name.to_owned(), known: vec![] })
}

/// Brings the garments of study files, or of files with nothing else, into the catalogue: for [`Part::Size`] only
/// their sizes.
pub(super) fn import_styles(store: &mut Store, part: Part, files: &[PathBuf]) -> Result<Vec<Saved>> {
    let mut drafts: Vec<Placed<Draft>> = Vec::new();
    let mut problems = Vec::new();
    for path in files {
        let bytes = std::fs::read(path).map_err(StudyError::io(path))?;
        let read = match format_of(path) {
            Some(Format::Toml) => text_of(path, &bytes).and_then(|text| file::garments(path, text)),
            _ => Err(vec![unknown_format(path, "TOML (.toml)")]),
        };
        match read {
            Ok(garments) if garments.is_empty() => problems.push(Problem::of(path, "no [[garment]] in it")),
            Ok(garments) => drafts.extend(garments.into_iter().map(|placed| {
                let name = placed.name.clone();
                placed.map(|sewn| draft(part, name, sewn))
            })),
            Err(found) => problems.extend(found),
        }
    }
    for placed in &drafts {
        let found = match check_name(&placed.name) {
            Ok(()) => unsewable(store, &placed.entry)?,
            Err(problem) => vec![problem],
        };
        problems.extend(found.into_iter().map(|problem| placed.problem(format!("garment {}: {problem}", placed.name))));
    }
    if !problems.is_empty() {
        return Err(StudyError::File(problems));
    }
    let transaction = store::write(store.writer()?)?;
    let mut saved = Vec::new();
    for placed in &drafts {
        saved.extend(store_draft(&transaction, [Mode::Import; 2], &placed.entry)?);
    }
    transaction.commit()?;
    Ok(saved)
}

/// The sizes that are given of a style, with their units; all it has, where only the unit is given.
fn sizes_given(store: &Store, style: &str, given: &StyleGiven) -> Result<Vec<Sized>> {
    let unit = given.unit.clone();
    if given.patterns.is_empty() {
        let with_unit = |(size, _): Sized| (size, unit.clone());
        return Ok(if unit.is_some() { sizes_of(store, style)?.into_iter().map(with_unit).collect() } else { vec![] });
    }
    let mut sizes = Vec::new();
    for (name, path) in &given.patterns {
        let pattern = SourceFile::read_pattern(path)?;
        let names = match name {
            Some(name) => vec![name.clone()],
            None => sizes_in(&pattern, unit.as_deref())?,
        };
        for name in names {
            let name = if name.is_empty() { UNNAMED.to_owned() } else { name };
            check_name(&name).map_err(|_| {
                let problem = format!("{}: `{name}` is no name of a size; say SIZE={}", pattern.name, path.display());
                refused(Part::Style, style, vec![problem])
            })?;
            sizes.push((SizeFile { name, pattern: pattern.clone() }, unit.clone()));
        }
    }
    size_order::sort(&mut sizes, |sized| &sized.0.name);
    Ok(sizes)
}

/// Why sizes of a style could not be sewn were a draft stored: its own, and with new seams those there are as well.
fn unsewable(store: &Store, draft: &Draft) -> Result<Vec<String>> {
    let (seams, is_new) = match (&draft.seams, seams_of(store, &draft.name)?) {
        (Seams::Given(seams), _) => (seams.clone(), true),
        (Seams::Kept, Some(own)) => (own, false),
        (Seams::Kept, None) => {
            return Ok(vec![format!("no style `{}` in the catalogue; give its seam file", draft.name)]);
        }
    };
    let mut sizes = draft.sizes.clone();
    if is_new {
        let is_kept = |(before, _): &Sized| !draft.sizes.iter().any(|(size, _)| size.name == before.name);
        sizes.extend(sizes_of(store, &draft.name)?.into_iter().filter(is_kept));
    }
    let problem = |(size, unit): &Sized| {
        let unit = unit.as_deref().and_then(patterns::unit_of);
        let read = patterns::read_style(&size.pattern, seams.as_ref(), Some(&size.name), unit);
        read.err().map(|error| format!("size {}: {error}", size.name))
    };
    Ok(sizes.iter().filter_map(problem).collect())
}

/// The seam file of a style, where it has one, current revision; `None` where there is no such style.
fn seams_of(store: &Store, style: &str) -> Result<Option<Option<SourceFile>>> {
    let sql = "SELECT seam_file, seams FROM style JOIN catalogue_entry AS entry USING (name, revision)
        WHERE part = 'style' AND name = ? AND NOT is_retired";
    let row = |row: &Row<'_>| {
        let text: String = row.get(1)?;
        Ok(seam_file(row.get(0)?, text))
    };
    Ok(store.reader.prepare_cached(sql)?.query_row([style], row).optional()?)
}

/// The sizes of a style from the smallest to the largest, current revisions.
fn sizes_of(store: &Store, style: &str) -> Result<Vec<Sized>> {
    let sql = "SELECT size.name, pattern_file, pattern, unit
        FROM size JOIN catalogue_entry AS entry
            ON entry.name = style || '/' || size.name AND entry.revision = size.revision
        WHERE part = 'size' AND style = ? AND NOT is_retired ORDER BY size_id";
    let mut statement = store.reader.prepare_cached(sql)?;
    let row = |row: &Row<'_>| {
        let pattern = SourceFile { name: row.get(1)?, bytes: row.get::<_, Vec<u8>>(2)?.into() };
        Ok((SizeFile { name: row.get(0)?, pattern }, row.get(3)?))
    };
    let mut sizes = statement.query_map([style], row)?.collect::<rusqlite::Result<Vec<Sized>>>()?;
    size_order::sort(&mut sizes, |sized| &sized.0.name);
    Ok(sizes)
}

/// The style a job was made from.
///
/// # Errors
/// When there is no such job.
pub fn style_of(store: &Store, id: JobId) -> Result<Style> {
    let sql = "SELECT pattern_file, pattern, seam_file, seams, unit, size.name
        FROM job JOIN size USING (size_id) JOIN style USING (style_id) WHERE job_id = ?";
    type Stored = (String, Vec<u8>, String, String, Option<String>, String);
    let row =
        |row: &Row<'_>| Ok::<Stored, _>((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?, row.get(4)?, row.get(5)?));
    let found = store.reader.prepare_cached(sql)?.query_row([id.0], row).optional()?;
    let missing = || StudyError::NotFound { what: "job", name: id.to_string(), known: vec![] };
    let (pattern_file, pattern, seam_file, seams, unit, size) = found.ok_or_else(missing)?;
    let pattern = SourceFile { name: pattern_file, bytes: pattern.into() };
    let seams = self::seam_file(seam_file, seams);
    patterns::read_style(&pattern, seams.as_ref(), Some(&size), unit.as_deref().and_then(patterns::unit_of))
}

/// A seam file as stored; a style without one has an empty name there.
pub(super) fn seam_file(name: String, text: String) -> Option<SourceFile> {
    (!name.is_empty()).then(|| SourceFile { name, bytes: text.into_bytes().into() })
}

/// A garment of a file as it is to be stored.
fn draft(part: Part, name: String, sewn: Sewn) -> Draft {
    let Sewn { seams, unit, sizes } = sewn;
    let seams = if part == Part::Style { Seams::Given(seams) } else { Seams::Kept };
    Draft { name, seams, sizes: sizes.into_iter().map(|size| (size, unit.clone())).collect() }
}

/// Names of the sizes in a pattern file.
fn sizes_in(pattern: &SourceFile, unit: Option<&str>) -> Result<Vec<String>> {
    let read = source::read(&pattern.bytes, &pattern.name, unit.and_then(patterns::unit_of));
    let file = read.origin(Origin::Pattern)?;
    Ok(file.sizes().into_iter().map(str::to_owned).collect())
}

/// Stores a draft: its seams, where there are any, by one mode, and its sizes by another.
fn store_draft(transaction: &Transaction<'_>, [mode, of_sizes]: [Mode; 2], draft: &Draft) -> Result<Vec<Saved>> {
    let mut saved = Vec::new();
    if let Seams::Given(seams) = &draft.seams {
        let store = || revision::style(transaction, &draft.name, seams.as_ref(), By::User);
        saved.push(save(transaction, Part::Style, &draft.name, mode, store)?);
    }
    for (size, unit) in &draft.sizes {
        let place = (draft.name.as_str(), size.name.as_str());
        let store = || revision::size(transaction, place, &size.pattern, unit.as_deref(), By::User);
        saved.push(save(transaction, Part::Size, &format!("{}/{}", draft.name, size.name), of_sizes, store)?);
    }
    Ok(saved)
}
