//! Pattern files with the tables beside them (grade rules, piece information): inspected, reduced to features, and
//! converted to other formats.

use std::path::Path;

use crate::error::WardrobeError;
pub use pattern::dxf::Standard;
use pattern::dxf::{self, PatternFile, Unit};
use pattern::features::Features;
use pattern::grade::{self, Ungraded};
use pattern::inspect::FileReport;
use pattern::source::{self, Kind};
use pattern::{Style, garmentcode, info};
use spec::patterns::drawings;
use store::files::SourceFile;
use store::{InOrigin, Origin, Result};

/// Choices and tables that go with a pattern file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beside<'a> {
    /// Size to which the pattern is reduced, if any.
    pub size: Option<&'a str>,
    /// Unit of DXF files.
    pub unit: Option<Unit>,
    /// Grade rule table. With it the pattern file is the sample size, from which all sizes are made.
    pub rules: Option<&'a Path>,
    /// Unit of the table's numbers, replacing the unit that it names.
    pub rule_unit: Option<Unit>,
    /// CSV or XLSX with piece information.
    pub info: Option<&'a Path>,
}

impl Beside<'_> {
    /// Grades a pattern and adds its piece information. Returns the pattern with remarks on the tables.
    fn complete(&self, mut pattern: PatternFile) -> Result<(PatternFile, Vec<String>)> {
        let mut notes = Vec::new();
        if let Some(path) = self.rules {
            let source = SourceFile::read(path)?;
            let table = grade::read(&source.bytes, &source.name).origin(Origin::Pattern)?;
            let (table, note) = grade::in_unit_of(table, pattern.unit, self.rule_unit).origin(Origin::Pattern)?;
            notes.extend(note);
            pattern = grade::grade(&pattern, &table).origin(Origin::Pattern)?;
        }
        if let Some(path) = self.info {
            let source = SourceFile::read(path)?;
            let table = info::read(&source.bytes, &source.name).origin(Origin::Pattern)?;
            table.merge(&mut pattern).origin(Origin::Pattern)?;
        }
        Ok((pattern, notes))
    }

    /// Reads a pattern in the size asked for and checks that all its pieces can be sewn. Returns the pattern with
    /// remarks on the tables.
    fn usable_pattern(&self, source: &SourceFile) -> Result<(PatternFile, Vec<String>)> {
        let read = source::read(&source.bytes, &source.name, self.unit).origin(Origin::Pattern)?;
        let (mut pattern, notes) = self.complete(read)?;
        let sizes = pattern.sizes().into_iter().map(str::to_owned).collect::<Vec<_>>();
        for size in self.size.map_or(sizes, |size| vec![size.to_owned()]) {
            // A nest is no garment, so each of its sizes is checked by itself.
            pattern.to_sew(Some(&size)).origin(Origin::Pattern)?;
        }
        self.keep_size(&mut pattern);
        Ok((pattern, notes))
    }

    fn keep_size(&self, pattern: &mut PatternFile) {
        if let Some(size) = self.size {
            let is_of = |name: &str| name.eq_ignore_ascii_case(size);
            pattern.pieces.retain(|piece| is_of(piece.size.as_deref().unwrap_or_default()));
        }
    }
}

/// Reports the contents of a pattern file of any kind, or of every pattern below a folder, by name. An unreadable file
/// has its error in its report.
pub fn inspect(path: &Path, beside: &Beside<'_>) -> Result<Vec<FileReport>> {
    let files = if path.is_dir() { drawings(path)? } else { vec![path.to_owned()] };
    files.iter().map(|file| report(&SourceFile::read(file)?.bytes, &file.to_string_lossy(), beside)).collect()
}

fn report(bytes: &[u8], name: &str, beside: &Beside<'_>) -> Result<FileReport> {
    let is_alone = beside.size.is_none() && beside.rules.is_none() && beside.info.is_none();
    if is_alone && source::kind(bytes) == Kind::GarmentCode {
        // The GarmentCode specification says more about its unit than a pattern does.
        let read = garmentcode::read(bytes, name);
        let unreadable = |error: &garmentcode::GarmentCodeError| FileReport::unreadable(name, error.to_string());
        return Ok(read.as_ref().map_or_else(unreadable, FileReport::from));
    }
    // An unreadable file is a finding; a wrong table beside it is the user's to correct.
    let (mut pattern, notes) = match source::read(bytes, name, beside.unit) {
        Ok(read) => beside.complete(read)?,
        Err(error) => return Ok(FileReport::unreadable(name, error.to_string())),
    };
    beside.keep_size(&mut pattern);
    pattern.warnings.extend(notes);
    Ok(FileReport::from(&pattern))
}

/// Returns JSON, with remarks on the tables.
pub fn features(path: &Path, beside: &Beside<'_>) -> Result<(String, Vec<String>)> {
    let source = SourceFile::read(path)?;
    let (pattern, notes) = beside.usable_pattern(&source)?;
    let features = Features::of(&pattern.pieces, &source.name, &pattern.texts);
    Ok((serde_json::to_string_pretty(&features).origin(Origin::Pattern)?, notes))
}

/// Writes a pattern as DXF by a standard, half pieces as halves and all sizes as a nest. Returns remarks on the tables
/// too.
pub fn convert_to_dxf(path: &Path, beside: &Beside<'_>, standard: Standard) -> Result<(Vec<u8>, Vec<String>)> {
    let (pattern, notes) = beside.usable_pattern(&SourceFile::read(path)?)?;
    Ok((dxf::write_pieces(&pattern.pieces, &pattern.texts, standard), notes))
}

/// A pattern as sample size and grade rule table.
#[derive(Clone, Debug, PartialEq)]
pub struct Graded {
    /// Sample size.
    pub dxf: Vec<u8>,
    pub rules: String,
    /// Remarks on parts without rules, and on the tables beside the pattern.
    pub notes: Vec<String>,
}

/// Writes the sample size of a pattern as DXF, and the grade rule table that makes all sizes from it. The DXF names the
/// table. Fails where a piece is missing or different in one size.
pub fn convert_to_graded(path: &Path, beside: &Beside<'_>, standard: Standard, table_name: &str) -> Result<Graded> {
    let all = Beside { size: None, ..*beside };
    let (pattern, mut remarks) = all.usable_pattern(&SourceFile::read(path)?)?;
    let sample = beside.size.unwrap_or(pattern.sample_size());
    let Ungraded { pieces, table, notes } = grade::ungrade(&pattern, sample).origin(Origin::Pattern)?;
    let is_other = |(key, _): &&(String, String)| !dxf::is_sample_size(key) && !grade::is_name_of_table(key);
    let sample = ("Sample Size".to_owned(), table.sizes[table.sample].clone());
    let own = [sample, grade::named_in_pattern(table_name)];
    let texts: Vec<_> = pattern.texts.iter().filter(is_other).cloned().chain(own).collect();
    let rules = grade::write(&table, table_name, &grade::Imprint::of(&pattern.texts), standard);
    remarks.extend(notes);
    Ok(Graded { dxf: dxf::write_pieces(&pieces, &texts, standard), rules, notes: remarks })
}

/// Returns remarks on the tables too.
pub fn convert_to_garmentcode(path: &Path, seams: Option<&Path>, beside: &Beside<'_>) -> Result<(String, Vec<String>)> {
    let source = SourceFile::read(path)?;
    let mut notes = Vec::new();
    let style = match (seams, source::kind(&source.bytes)) {
        (Some(seams), _) => {
            let (file, remarks) = beside.usable_pattern(&source)?;
            notes = remarks;
            // A file with one size need not name it as it is asked for.
            let size = beside.size.filter(|_| file.sizes().len() > 1);
            let pieces = file.to_sew(size).origin(Origin::Pattern)?;
            let seams = SourceFile::read(seams)?;
            Style::read(&pieces, &seams.bytes, &seams.name).origin(Origin::Pattern)?
        }
        (None, Kind::GarmentCode) => garmentcode::read(&source.bytes, &source.name).origin(Origin::Pattern)?.style(),
        (None, _) => {
            return Err(WardrobeError::NoSeams { pattern: source.name }.into());
        }
    };
    let text = serde_json::to_string_pretty(&garmentcode::document(&style)).origin(Origin::Pattern)?;
    Ok((text, notes))
}
