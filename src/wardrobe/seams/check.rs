//! Checks of the seams of patterns, without a simulation.

use std::path::Path;

use crate::catalogue;
use geom::units::{from_mm, mm};
use pattern::check::{self, Finding};
use pattern::progression::leaps;
use pattern::seams::SeamFile;
use pattern::size_order;
use spec::Study;
use spec::file::{GarmentEntry, SizeFile};
use spec::patterns::{self, Nest, Style, Unit};
use store::files::SourceFile;
use store::{Access, InOrigin, Origin, Result};

/// Edge length of the mesh that a check makes.
pub const CHECK_EDGE_MM: f64 = 15.0;

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct SizeCheck {
    pub garment: String,
    pub size: String,
    pub pieces: usize,
    pub seams: usize,
    pub measurements: usize,
    /// Pattern girths that decide the fit, by level of the body.
    pub fit_mm: Vec<(String, f64)>,
    /// Vertices of the mesh at [`CHECK_EDGE_MM`].
    pub vertices: usize,
    /// Least angle of the mesh's triangles.
    pub min_angle_deg: f64,
    pub findings: Vec<Finding>,
    pub error: Option<String>,
}

impl SizeCheck {
    /// True if anything was found.
    pub fn is_bad(&self) -> bool {
        self.error.is_some() || !self.findings.is_empty()
    }
}

/// Checks every size of every garment, by the path of the study file or its folder. Subjects and fabrics that the file
/// names come from `database`, if that exists. A problem of a pattern is in the row of its size.
pub fn check_study(path: &Path, database: &Path) -> Result<Vec<SizeCheck>> {
    let connection = if database.exists() { Some(store::open(database, Access::Read)?) } else { None };
    let study = Study::load(path, &catalogue::known(connection.as_ref())?)?;
    let check = |garment: &GarmentEntry| {
        let unit = garment.unit.as_deref().and_then(patterns::unit_of);
        let sewn = Sewn { garment: garment.name.clone(), seams: garment.seams.clone(), unit };
        sewn.check(&garment.sizes)
    };
    Ok(study.garments.iter().flat_map(check).collect())
}

/// A problem of a size is in its row.
pub fn check_sizes(pattern: &Path, seams: Option<&Path>, unit: Option<Unit>) -> Result<Vec<SizeCheck>> {
    let source = SourceFile::read_pattern(pattern)?;
    let seams = seams.map(SourceFile::read).transpose()?;
    let sizes: Vec<String> = match source.holds_seams() {
        true => vec![String::new()],
        false => Nest::read(&source, unit)?.sizes().into_iter().map(str::to_owned).collect(),
    };
    let garment = pattern.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let sewn = Sewn { garment, seams, unit };
    let sizes: Vec<SizeFile> = sizes.into_iter().map(|name| SizeFile { name, pattern: source.clone() }).collect();
    Ok(sewn.check(&sizes))
}

struct Sewn {
    garment: String,
    seams: Option<SourceFile>,
    unit: Option<Unit>,
}

/// A size that can be sewn, with the index of its row in the result.
struct ReadSize<'a> {
    row: usize,
    name: &'a str,
    style: Style,
}

impl Sewn {
    /// Findings include lengths that leap from one size to the next.
    fn check(&self, sizes: &[SizeFile]) -> Vec<SizeCheck> {
        let (mut rows, mut read) = (Vec::new(), Vec::new());
        for (index, size) in sizes.iter().enumerate() {
            let mut row = self.row(size);
            match self.fill(&mut row, size) {
                Ok(style) => read.push(ReadSize { row: index, name: &size.name, style }),
                Err(error) => row.error = Some(error.to_string()),
            }
            rows.push(row);
        }
        size_order::sort(&mut read, |size| size.name);
        let names: Vec<String> = read.iter().map(|size| size.name.to_owned()).collect();
        for leap in leaps(&read.iter().map(|size| &size.style).collect::<Vec<_>>()) {
            let row: &mut SizeCheck = &mut rows[read[leap.sizes[1]].row];
            row.findings.push(leap.finding(&names));
        }
        rows
    }

    fn row(&self, size: &SizeFile) -> SizeCheck {
        SizeCheck {
            garment: self.garment.clone(),
            size: size.name.clone(),
            pieces: 0,
            seams: 0,
            measurements: 0,
            fit_mm: Vec::new(),
            vertices: 0,
            min_angle_deg: 0.0,
            findings: Vec::new(),
            error: None,
        }
    }

    fn fill(&self, row: &mut SizeCheck, size: &SizeFile) -> Result<Style> {
        let style = patterns::read_style(&size.pattern, self.seams.as_ref(), Some(&size.name), self.unit)?;
        (row.pieces, row.seams, row.measurements) = (style.pieces.len(), style.seams.len(), style.measurements.len());
        let level = |(level, path): &(String, Vec<_>)| (level.clone(), mm(style.path_length_m(path)));
        row.fit_mm = style.fit_levels.iter().map(level).collect();
        if let Some(seams) = &self.seams {
            row.findings = findings_of(&size.pattern, seams, Some(&size.name), self.unit)?;
        }
        let (mesh, quality) = patterns::mesh(&style, from_mm(CHECK_EDGE_MM))?;
        (row.vertices, row.min_angle_deg) = (mesh.rest.len(), quality.min_angle_deg);
        row.findings.extend(check::of_garment(&style, &mesh));
        Ok(style)
    }
}

pub(crate) fn findings_of(
    pattern: &SourceFile,
    seams: &SourceFile,
    size: Option<&str>,
    unit: Option<Unit>,
) -> Result<Vec<Finding>> {
    if pattern.holds_seams() {
        return Ok(Vec::new());
    }
    let pieces = patterns::pieces(pattern, size, unit)?;
    let style = Style::read(&pieces, &seams.bytes, &seams.name).origin(Origin::Pattern)?;
    let entries = SeamFile::parse(&seams.bytes, &seams.name).origin(Origin::Pattern)?;
    Ok(check::findings(&pieces, &entries, &style))
}

pub fn findings(pattern: &Path, seams: &Path, size: Option<&str>, unit: Option<Unit>) -> Result<Vec<Finding>> {
    findings_of(&SourceFile::read_pattern(pattern)?, &SourceFile::read(seams)?, size, unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thesis_study_is_clean_and_a_broken_one_is_not() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/thesis");
        let nowhere = Path::new("no.sqlite");
        let rows = check_study(&folder, nowhere).expect("it reads");
        assert_eq!(rows.len(), 9);
        for row in &rows {
            assert!(!row.is_bad() && row.findings.is_empty() && row.min_angle_deg > 20.0, "{row:?}");
            let levels: Vec<&str> = row.fit_mm.iter().map(|(level, _)| level.as_str()).collect();
            let expect: &[&str] = match row.garment.as_str() {
                "trousers" => &["hip"],
                "dress" => &["chest", "hip"],
                _ => &["chest"],
            };
            assert_eq!(levels, expect, "{}", row.garment);
        }
        let text = std::fs::read_to_string(folder.join("study.toml")).expect("it reads");
        let broken = tempfile::tempdir().expect("a folder");
        let patterns = format!("{}/patterns/", folder.display());
        let text = text.replace("patterns/", &patterns).replace("tshirt.seams.toml", "teetop.seams.toml");
        std::fs::write(broken.path().join("study.toml"), text).expect("writable");
        let rows = check_study(broken.path(), nowhere).expect("it reads");
        let bad: Vec<&str> = rows.iter().filter(|row| row.is_bad()).map(|row| row.garment.as_str()).collect();
        assert_eq!(bad, ["tshirt"; 3]);
    }
}
