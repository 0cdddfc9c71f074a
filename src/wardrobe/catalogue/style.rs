//! Saving and importing styles: a seam file, and for each size a pattern that the seam file sews.

use std::path::PathBuf;

use rusqlite::{OptionalExtension, Row, Transaction};

use crate::catalogue::format::{Format, format_of, text_of, unknown_format};
use crate::catalogue::revision::{self, By};
use crate::catalogue::{Mode, Part, Saved, check_name, check_size_name, refused, save};
use crate::seams::workpiece::Workpiece;
use pattern::{size_order, source};
use spec::file::{self, KnownSize, Placed, Sewn, SizeFile};
use spec::patterns::{self, Nest, SizePieces};
use store::files::SourceFile;
use store::{InOrigin, Origin, Problem, Result, Store, StudyError};

/// Parts of a style or a size that are given; an edit keeps the others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StyleGiven {
    pub seams: Option<PathBuf>,
    /// True to propose seams for a new style that has neither a seam file nor patterns with seams.
    pub is_proposed: bool,
    /// Unit of the patterns, where their files name none: `mm`, `cm`, `in` or `m`.
    pub unit: Option<String>,
    /// Patterns with the names of their sizes; without a name, all sizes of the file.
    pub patterns: Vec<(Option<String>, PathBuf)>,
}

/// Name of the size of a pattern that names no size.
const UNNAMED: &str = "ONE";

enum Seams {
    Kept,
    /// Seams of a file; `None` for those that the patterns hold.
    Given(Option<SourceFile>),
}

struct Draft {
    name: String,
    seams: Seams,
    sizes: Vec<KnownSize>,
}

/// Saves a style: its seam file and its sizes. The seams must fit every size, given now or earlier.
pub fn save_style(store: &mut Store, mode: Mode, name: &str, given: &StyleGiven) -> Result<Vec<Saved>> {
    check_name(name).map_err(|problem| refused(Part::Style, name, vec![problem]))?;
    let sizes = sizes_given(store, name, given)?;
    let seams = match (&given.seams, sizes.first()) {
        (Some(path), first) if mode != Mode::Add || first.is_some() => Seams::Given(Some(SourceFile::read(path)?)),
        (None, _) if mode != Mode::Add => Seams::Kept,
        (None, Some(_)) if sizes.iter().all(|known| known.size.pattern.holds_seams()) => Seams::Given(None),
        (None, Some(_)) if given.is_proposed => Seams::Given(Some(proposed(name, &sizes)?)),
        _ => {
            let problem = "a new style needs at least one pattern, and a seam file (or --propose) unless its patterns \
                are GarmentCode JSON";
            return Err(refused(Part::Style, name, vec![problem.to_owned()]));
        }
    };
    store_style(store, mode, Draft { name: name.to_owned(), seams, sizes })
}

/// Proposes one seam file for all sizes of a style. It is made on the sample size of the last pattern with several
/// sizes; without such a pattern, on the middle size.
fn proposed(style: &str, sizes: &[KnownSize]) -> Result<SourceFile> {
    let unit_of = |unit: &Option<String>| unit.as_deref().and_then(patterns::unit_of);
    let mut made_on = &sizes[sizes.len() / 2];
    let mut drawn = Vec::new();
    for known in sizes {
        let KnownSize { size, unit } = known;
        let nest = Nest::read(&size.pattern, unit_of(unit))?;
        if nest.sizes().len() > 1 && nest.sample_size().eq_ignore_ascii_case(&size.name) {
            made_on = known;
        }
        drawn.push(SizePieces { size: size.name.clone(), pieces: nest.pieces(&size.name) });
    }
    let KnownSize { size, unit } = made_on;
    drawn.retain(|other| other.size != size.name);
    let pattern = size.pattern.clone();
    Workpiece { pattern, seams: None, size: size.name.clone(), unit: unit_of(unit) }.proposed_for(style, drawn)
}

/// New seams must fit every size.
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

/// Saves a size, named `STYLE/SIZE`.
pub fn save_size(store: &mut Store, mode: Mode, name: &str, given: &StyleGiven) -> Result<Saved> {
    let refuse = |problem: &str| refused(Part::Size, name, vec![problem.to_owned()]);
    let (style, size) = name.split_once('/').ok_or_else(|| refuse("its name; accepted: STYLE/SIZE"))?;
    check_size_name(size).map_err(|problem| refuse(&problem))?;
    let sizes = match (given.patterns.as_slice(), &given.unit) {
        ([(_, path)], unit) => {
            let before = sizes_of(store, style)?.into_iter().find(|before| before.size.name == size);
            let unit = unit.clone().or(before.and_then(|before| before.unit));
            let size = SizeFile { name: size.to_owned(), pattern: SourceFile::read_pattern(path)? };
            vec![KnownSize { size, unit }]
        }
        ([], Some(unit)) => {
            let before = sizes_of(store, style)?.into_iter().filter(|before| before.size.name == size);
            before.map(|before| KnownSize { unit: Some(unit.clone()), ..before }).collect()
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

/// Imports garments of study files, or of files with nothing but garments, into the catalogue. With [`Part::Size`]
/// imports only their sizes.
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

/// Sizes given for a style, with their units; all sizes of the style where only the unit is given.
fn sizes_given(store: &Store, style: &str, given: &StyleGiven) -> Result<Vec<KnownSize>> {
    let unit = given.unit.clone();
    if given.patterns.is_empty() {
        let with_unit = |known: KnownSize| KnownSize { unit: unit.clone(), ..known };
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
            check_size_name(&name).map_err(|problem| {
                let problem = format!("{}: size `{name}`: {problem}; say SIZE={}", pattern.name, path.display());
                refused(Part::Style, style, vec![problem])
            })?;
            sizes.push(KnownSize { size: SizeFile { name, pattern: pattern.clone() }, unit: unit.clone() });
        }
    }
    size_order::sort(&mut sizes, |known| &known.size.name);
    Ok(sizes)
}

/// Problems of sizes that the seams of a draft do not fit: the draft's own sizes and, with new seams, the style's other
/// sizes.
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
        let is_kept = |before: &KnownSize| !draft.sizes.iter().any(|known| known.size.name == before.size.name);
        sizes.extend(sizes_of(store, &draft.name)?.into_iter().filter(is_kept));
    }
    let problem = |KnownSize { size, unit }: &KnownSize| {
        let unit = unit.as_deref().and_then(patterns::unit_of);
        let read = patterns::read_style(&size.pattern, seams.as_ref(), Some(&size.name), unit);
        read.err().map(|error| format!("size {}: {error}", size.name))
    };
    Ok(sizes.iter().filter_map(problem).collect())
}

/// Seam file of the current revision of a style. The outer `None` means no such style; the inner, patterns with seams.
fn seams_of(store: &Store, style: &str) -> Result<Option<Option<SourceFile>>> {
    let sql = "SELECT seam_file, seams FROM style JOIN catalogue_entry AS entry USING (name, revision)
        WHERE part = 'style' AND name = ? AND NOT is_retired";
    let row = |row: &Row<'_>| {
        let text: String = row.get(1)?;
        Ok(seam_file(row.get(0)?, text))
    };
    Ok(store.reader.prepare_cached(sql)?.query_row([style], row).optional()?)
}

/// Current sizes, from the smallest to the largest.
fn sizes_of(store: &Store, style: &str) -> Result<Vec<KnownSize>> {
    let sql = "SELECT size.name, pattern_file, pattern, unit
        FROM size JOIN catalogue_entry AS entry
            ON entry.name = style || '/' || size.name AND entry.revision = size.revision
        WHERE part = 'size' AND style = ? AND NOT is_retired ORDER BY size_id";
    let mut statement = store.reader.prepare_cached(sql)?;
    let row = |row: &Row<'_>| {
        let pattern = SourceFile { name: row.get(1)?, bytes: row.get::<_, Vec<u8>>(2)?.into() };
        Ok(KnownSize { size: SizeFile { name: row.get(0)?, pattern }, unit: row.get(3)? })
    };
    let mut sizes = statement.query_map([style], row)?.collect::<rusqlite::Result<Vec<KnownSize>>>()?;
    size_order::sort(&mut sizes, |known| &known.size.name);
    Ok(sizes)
}

/// Rows of current sizes with their current styles, by style.
pub(super) const CURRENT_SIZES: &str = "FROM size
    JOIN catalogue_entry AS sized ON sized.part = 'size' AND sized.name = size.style || '/' || size.name
        AND sized.revision = size.revision AND NOT sized.is_retired
    JOIN style ON style.name = size.style
    JOIN catalogue_entry AS styled ON styled.part = 'style' AND styled.name = style.name
        AND styled.revision = style.revision AND NOT styled.is_retired
    ORDER BY style.name, size_id";

/// Empty name stands for a style without seam file.
pub(super) fn seam_file(name: String, text: String) -> Option<SourceFile> {
    (!name.is_empty()).then(|| SourceFile { name, bytes: text.into_bytes().into() })
}

fn draft(part: Part, name: String, sewn: Sewn) -> Draft {
    let Sewn { seams, unit, sizes } = sewn;
    let seams = if part == Part::Style { Seams::Given(seams) } else { Seams::Kept };
    Draft { name, seams, sizes: sizes.into_iter().map(|size| KnownSize { size, unit: unit.clone() }).collect() }
}

fn sizes_in(pattern: &SourceFile, unit: Option<&str>) -> Result<Vec<String>> {
    let read = source::read(&pattern.bytes, &pattern.name, unit.and_then(patterns::unit_of));
    let file = read.origin(Origin::Pattern)?;
    Ok(file.sizes().into_iter().map(str::to_owned).collect())
}

/// First mode is for the style with its seams, the second for its sizes.
fn store_draft(transaction: &Transaction<'_>, [mode, of_sizes]: [Mode; 2], draft: &Draft) -> Result<Vec<Saved>> {
    let mut saved = Vec::new();
    if let Seams::Given(seams) = &draft.seams {
        let store = || revision::style(transaction, &draft.name, seams.as_ref(), By::User);
        saved.push(save(transaction, Part::Style, &draft.name, mode, store)?);
    }
    for KnownSize { size, unit } in &draft.sizes {
        let place = (draft.name.as_str(), size.name.as_str());
        let store = || revision::size(transaction, place, &size.pattern, unit.as_deref(), By::User);
        saved.push(save(transaction, Part::Size, &format!("{}/{}", draft.name, size.name), of_sizes, store)?);
    }
    Ok(saved)
}
