//! Patterns: read as pieces and styles, meshed, drawn.

use std::path::{Path, PathBuf};

use crate::error::SpecError;
use geom::units::mm;
use pattern::dxf::PatternFile;
use pattern::{Garment, Piece, garmentcode, scale, source};
use store::files::SourceFile;
use store::{InOrigin, Origin, Result, StudyError};

pub use pattern::check::{Finding, of_garment as garment_findings};
pub use pattern::draft::Model;
pub use pattern::drawing::{points_svg as points_sheet, svg as sheet};
pub use pattern::dxf::Unit;
pub use pattern::inspect::{FileReport, PieceReport};
pub use pattern::{MeshQuality, Style};

/// Patterns below a folder, by path: DXF files, and JSON files that are patterns.
pub fn drawings(folder: &Path) -> Result<Vec<PathBuf>> {
    let (mut found, mut others) = (Vec::new(), 0);
    let top = folder;
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).map_err(StudyError::io(&folder))? {
            let entry = entry.map_err(StudyError::io(&folder))?;
            let kind = entry.file_type().map_err(StudyError::io(entry.path()))?;
            if kind.is_dir() {
                folders.push(entry.path());
            } else if is_drawing(&entry.path())? {
                found.push(entry.path());
            } else {
                others += 1;
            }
        }
    }
    if found.is_empty() {
        return Err(SpecError::NoPattern { folder: top.to_owned(), others }.into());
    }
    found.sort();
    Ok(found)
}

/// True if a file is a pattern: DXF by its ending, JSON by its contents.
fn is_drawing(path: &Path) -> Result<bool> {
    let ends_in = |ending: &str| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(ending));
    if ends_in("json") {
        return Ok(source::is_json_pattern(&std::fs::read(path).map_err(StudyError::io(path))?));
    }
    Ok(ends_in("dxf"))
}

/// `size` picks a size where the pattern holds several.
pub fn style(pattern: &Path, seams: Option<&Path>, size: Option<&str>, unit: Option<Unit>) -> Result<Style> {
    let seams = seams.map(SourceFile::read).transpose()?;
    let pattern = SourceFile::read_pattern(pattern)?;
    let size = size.filter(|_| !pattern.holds_seams());
    let size = size.map(|size| Nest::read(&pattern, unit)?.size_named(size).map(str::to_owned)).transpose()?;
    read_style(&pattern, seams.as_ref(), size.as_deref(), unit)
}

/// `size` is `None` for the sample size.
pub fn pieces(pattern: &SourceFile, size: Option<&str>, unit: Option<Unit>) -> Result<Vec<Piece>> {
    let nest = Nest::read(pattern, unit)?;
    nest.pieces(size.unwrap_or(nest.sample_size()))
}

pub struct SizePieces {
    pub size: String,
    pub pieces: Result<Vec<Piece>>,
}

/// Files of a pattern, which may hold several sizes (a nest).
pub struct Nest {
    files: Vec<PatternFile>,
    /// Seam allowance of pieces without a sew line.
    allowance_m: f64,
}

impl Nest {
    /// Reads the file of a pattern, or all files of its folder.
    pub fn read(pattern: &SourceFile, unit: Option<Unit>) -> Result<Self> {
        let read = |part: &SourceFile| source::read(&part.bytes, &part.name, unit).origin(Origin::Pattern);
        Ok(Self { files: pattern.parts().iter().map(read).collect::<Result<_>>()?, allowance_m: 0.0 })
    }

    /// Sets the seam allowance of pieces without a sew line.
    pub fn with_allowance(self, allowance_m: f64) -> Self {
        Self { allowance_m, ..self }
    }

    /// Line along which the pieces are sewn, in words.
    pub fn sewn_along(&self) -> String {
        let pieces = || self.files.iter().flat_map(|file| &file.pieces);
        let lined = pieces().filter(|piece| piece.sew_line.is_some()).count();
        match (lined, self.allowance_m) {
            (0, 0.0) => "the cut line is sewn: the file has no sew line, and no allowance was said".to_owned(),
            (0, m) => format!("sewn {} mm inside the cut line", mm(m)),
            (lined, _) if lined == pieces().count() => "the sew line of the file is sewn".to_owned(),
            (lined, m) => format!(
                "{lined} of {} pieces have a sew line; the others are sewn {} mm inside their cut line",
                pieces().count(),
                mm(m)
            ),
        }
    }

    /// File that says which sizes there are: the first with several sizes, since a file of one size goes with any.
    fn graded(&self) -> Option<&PatternFile> {
        self.files.iter().find(|file| file.sizes().len() > 1).or(self.files.first())
    }

    /// Names of the sizes, the smallest first; one empty name where none is named.
    pub fn sizes(&self) -> Vec<&str> {
        self.graded().map_or(vec![], PatternFile::sizes)
    }

    /// Name of a size as the files write it. Files that name no size are of any size.
    pub fn size_named<'n>(&'n self, size: &'n str) -> Result<&'n str> {
        let sizes = self.sizes();
        match sizes.iter().find(|name| name.eq_ignore_ascii_case(size)) {
            Some(name) => Ok(name),
            None if sizes.iter().all(|name| name.is_empty()) => Ok(size),
            None => {
                let pattern = self.graded().map_or("", |file| &file.file).to_owned();
                Err(SpecError::NoSize { pattern, size: size.to_owned(), sizes: sizes.join(", ") }.into())
            }
        }
    }

    /// Texts of the first file outside its pieces, as `(key, value)`.
    pub fn texts(&self) -> &[(String, String)] {
        self.files.first().map_or(&[], |file| &file.texts)
    }

    pub fn sample_size(&self) -> &str {
        self.graded().map_or("", PatternFile::sample_size)
    }

    pub fn unit_remarks(&self) -> impl Iterator<Item = &str> {
        self.files.iter().filter_map(|file| file.unit_remark.as_deref())
    }

    /// Pieces of a size. Files with a single size, under whatever name, give their pieces to every size.
    pub fn pieces(&self, size: &str) -> Result<Vec<Piece>> {
        let mut pieces = Vec::new();
        for file in &self.files {
            let is_nest = file.sizes().len() > 1;
            for piece in file.to_sew(is_nest.then_some(size)).origin(Origin::Pattern)? {
                let mut piece = piece.with_allowance(self.allowance_m).origin(Origin::Pattern)?;
                if !is_nest && !size.is_empty() {
                    piece.size = Some(size.to_owned());
                }
                pieces.push(piece);
            }
        }
        Ok(pieces)
    }

    pub fn others(&self, size: &str) -> Vec<SizePieces> {
        let others = self.sizes().into_iter().filter(|other| !other.eq_ignore_ascii_case(size));
        others.map(|other| SizePieces { size: other.to_owned(), pieces: self.pieces(other) }).collect()
    }
}

pub fn unit_of(name: &str) -> Option<Unit> {
    Unit::ALL.into_iter().find(|unit| unit.as_str() == name)
}

pub fn read_style(
    pattern: &SourceFile,
    seams: Option<&SourceFile>,
    size: Option<&str>,
    unit: Option<Unit>,
) -> Result<Style> {
    let mut style = if pattern.holds_seams() {
        let read = garmentcode::read(&pattern.bytes, &pattern.name).origin(Origin::Pattern)?;
        let mut style = read.style();
        if let Some(seams) = seams {
            style.measure(&seams.bytes, &seams.name).origin(Origin::Pattern)?;
        }
        style
    } else {
        let Some(seams) = seams else {
            return Err(SpecError::NoSeams { pattern: pattern.name.clone() }.into());
        };
        let pieces = pieces(pattern, size, unit)?;
        Style::read(&pieces, &seams.bytes, &seams.name).origin(Origin::Pattern)?
    };
    check_scale(&style, &pattern.name)?;
    if style.measurements.is_empty() {
        style.measure_openings_and_seams();
    }
    Ok(style)
}

/// Refuses a style without pieces, or with pieces too small or too large for a person: its file has another unit than
/// it says.
fn check_scale(style: &Style, file: &str) -> Result<()> {
    if style.pieces.is_empty() {
        return Err(SpecError::NoPiece { pattern: file.to_owned() }.into());
    }
    let outlines: Vec<_> = style.pieces.iter().map(|piece| piece.outline()).collect();
    let longest_m = scale::longest_m(outlines.iter().map(|outline| &outline[..]));
    match scale::doubt(longest_m, Unit::M) {
        Some(_) => Err(SpecError::Scale { pattern: file.to_owned(), longest_m }.into()),
        None => Ok(()),
    }
}

pub fn mesh(style: &Style, edge_length_m: f64) -> Result<(Garment, MeshQuality)> {
    let garment = style.mesh(edge_length_m).origin(Origin::Mesh)?;
    let quality = MeshQuality::of(&garment).ok_or(SpecError::NoTriangles)?;
    Ok((garment, quality))
}

pub fn drafted(model: Model) -> Vec<(String, Vec<u8>)> {
    model.files()
}
