//! Pattern files with what lies beside them: a grade rule table, a table of piece information; looking into them,
//! taking their features, writing them as other kinds of file.

use std::path::Path;

use super::error::{Result, StudyError};
use super::file::SourceFile;
use super::tools::{drawings, read_style};
use crate::pattern::dxf::{self, PatternFile, Unit};
use crate::pattern::features::Features;
use crate::pattern::inspect::FileReport;
use crate::pattern::source::{self, Kind};
use crate::pattern::{garmentcode, grade, info};

/// What is said about a pattern beside its file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beside<'a> {
    /// Only pieces of this size.
    pub size: Option<&'a str>,
    /// Unit of DXF files.
    pub unit: Option<Unit>,
    /// Grade rule table: the file is of the sample size, and all sizes are made.
    pub rules: Option<&'a Path>,
    /// Piece information.
    pub info: Option<&'a Path>,
}

impl Beside<'_> {
    /// The pattern of a file, graded, and told what the table says.
    fn pattern(&self, bytes: &[u8], name: &str) -> Result<PatternFile> {
        let stage = StudyError::stage("pattern");
        let mut pattern = source::read(bytes, name, self.unit).map_err(stage)?;
        if let Some(path) = self.rules {
            let source = SourceFile::read(path)?;
            let table = grade::read(&source.bytes, &source.name).map_err(StudyError::stage("pattern"))?;
            pattern = grade::grade(&pattern, &table).map_err(StudyError::stage("pattern"))?;
        }
        if let Some(path) = self.info {
            let source = SourceFile::read(path)?;
            let table = info::read(&source.bytes, &source.name).map_err(StudyError::stage("pattern"))?;
            table.merge(&mut pattern).map_err(StudyError::stage("pattern"))?;
        }
        if let Some(size) = self.size {
            let is_of = |name: &str| name.eq_ignore_ascii_case(size);
            pattern.pieces.retain(|piece| is_of(piece.size.as_deref().unwrap_or_default()));
        }
        Ok(pattern)
    }

    fn is_plain(&self) -> bool {
        self.size.or(self.unit.map(Unit::as_str)).is_none() && self.rules.or(self.info).is_none()
    }
}

/// What is in a pattern file of any kind, or in every one below a folder, by name. A file that cannot be read has its
/// error in its report.
///
/// # Errors
/// When the path cannot be read, or a file beside it is wrong.
pub fn inspect(path: &Path, beside: &Beside<'_>) -> Result<Vec<FileReport>> {
    let files = if path.is_dir() { drawings(path)? } else { vec![path.to_owned()] };
    let report = |file: &std::path::PathBuf| {
        let bytes = SourceFile::read(file)?.bytes;
        let name = file.to_string_lossy();
        if beside.is_plain() && source::kind(&bytes) == Kind::GarmentCode {
            let read = garmentcode::read(&bytes, &name);
            return Ok(read
                .as_ref()
                .map_or_else(|error| FileReport::unreadable(&name, error.to_string()), FileReport::from));
        }
        // A file that cannot be read by itself is a finding; what lies beside it is the user's to put right.
        if let Err(error) = source::read(&bytes, &name, beside.unit) {
            return Ok(FileReport::unreadable(&name, error.to_string()));
        }
        Ok(FileReport::from(&beside.pattern(&bytes, &name)?))
    };
    files.iter().map(report).collect()
}

/// The features of a pattern's pieces, as JSON.
///
/// # Errors
/// When a file cannot be read, or a piece of it is refused.
pub fn features(path: &Path, beside: &Beside<'_>) -> Result<String> {
    let source = SourceFile::read(path)?;
    let pattern = usable(beside.pattern(&source.bytes, &source.name)?)?;
    let features = Features::of(&pattern.pieces, &source.name, &pattern.texts);
    serde_json::to_string_pretty(&features).map_err(StudyError::stage("pattern"))
}

/// A pattern without refused pieces, in a unit that is known.
fn usable(pattern: PatternFile) -> Result<PatternFile> {
    // What may be sewn may be handed on; every size for itself, as a nest is no garment.
    for size in pattern.sizes() {
        pattern.to_sew(Some(size)).map_err(StudyError::stage("pattern"))?;
    }
    Ok(pattern)
}

/// A pattern as AAMA DXF: all its sizes, half pieces as halves.
///
/// # Errors
/// As [`features`].
pub fn convert_to_dxf(path: &Path, beside: &Beside<'_>) -> Result<Vec<u8>> {
    let source = SourceFile::read(path)?;
    let pattern = usable(beside.pattern(&source.bytes, &source.name)?)?;
    Ok(dxf::write_pieces(&pattern.pieces, &pattern.texts))
}

/// A pattern and its seams as GarmentCode JSON.
///
/// # Errors
/// When a file cannot be read, or the seams do not fit the pattern.
pub fn convert_to_garmentcode(path: &Path, seams: Option<&Path>, beside: &Beside<'_>) -> Result<String> {
    let source = SourceFile::read(path)?;
    let style = match (seams, source::kind(&source.bytes)) {
        (Some(seams), _) => read_style(&source, Some(&SourceFile::read(seams)?), beside.size, beside.unit)?,
        (None, Kind::GarmentCode) => {
            garmentcode::read(&source.bytes, &source.name).map_err(StudyError::stage("pattern"))?.style()
        }
        (None, _) => {
            let message = format!("{}: GarmentCode JSON holds seams: name a seam file (--seams FILE)", source.name);
            return Err(StudyError::Stage { stage: "pattern", message });
        }
    };
    serde_json::to_string_pretty(&garmentcode::document(&style)).map_err(StudyError::stage("pattern"))
}
