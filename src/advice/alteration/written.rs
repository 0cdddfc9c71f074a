//! Changed patterns as files, and the styles read again from these files.
//!
//! A pattern of DXF files keeps them: coordinates of what moves change, and nothing else. Another pattern is written
//! anew, and so is one whose files do not make the changed style when they are read again.

use crate::error::AdviceError;
use geom::units::mm;
use pattern::dxf::patch::{Patched, Redraw, patched};
use pattern::dxf::{self, Standard};
use pattern::handle::{Redrawn, outlines_apart_m};
use pattern::piece::Piece;
use pattern::source::{self, Kind};
use pattern::{Handle, Style, garmentcode, size_order};
use spec::{JobSpec, patterns};
use store::files::SourceFile;
use store::{InOrigin, Origin, Result};

/// Distance of an outline of a file that is read again from the changed style, from which it is told. A file that is
/// further off than its curves of few points explain is not this style.
const APART_MM: f64 = 0.3;

pub struct Written {
    /// Pattern, its seam file if it has one, and a sheet of old and new outlines, by name.
    pub files: Vec<(String, Vec<u8>)>,
    /// Style as read from the files.
    pub again: Style,
    /// True if the files of the pattern are those of the source, with changed coordinates.
    pub keeps_source: bool,
    pub remarks: Vec<String>,
}

/// Writes a job's style with moved handles into files called `name`: DXF and seam file, or GarmentCode JSON where the
/// pattern holds its own seams. `standard` is that of a file that is written anew.
pub fn written(
    spec: &JobSpec,
    [style, changed]: [&Style; 2],
    moves: &[(Handle, f64)],
    standard: Standard,
    name: &str,
) -> Result<Written> {
    let sheet = (format!("{name}.svg"), pattern::drawing::changed_svg(style, changed, moves).into_bytes());
    let Some(seams) = &spec.seams else {
        let text = serde_json::to_vec_pretty(&garmentcode::document(changed)).origin(Origin::Alter)?;
        let file = SourceFile { name: format!("{name}.json"), bytes: text.into() };
        let again = patterns::read_style(&file, None, None, None)?;
        let files = vec![(file.name.clone(), file.bytes.to_vec()), sheet];
        return Ok(Written { files, again, keeps_source: false, remarks: Vec::new() });
    };
    let mut written = match kept(spec, &[&spec.size], moves, name).and_then(|kept| kept.checked(spec, changed)) {
        Ok(written) => written,
        Err(NotKept(reason)) => anew(spec, seams, moves, standard, name, reason)?,
    };
    written.files.push(sheet);
    Ok(written)
}

/// Writes all sizes of a garment, changed alike, into one file called `name`: the source where it holds all of them,
/// otherwise a new DXF with every piece in every size. Reads the file again before returning it.
pub fn nest(
    spec: &JobSpec,
    others: &[JobSpec],
    moves: &[(Handle, f64)],
    standard: Standard,
    name: &str,
) -> Result<Vec<(String, Vec<u8>)>> {
    let jobs: Vec<&JobSpec> = others.iter().chain([spec]).collect();
    if let Ok(files) = kept_nest(spec, &jobs, moves, name) {
        return Ok(files);
    }
    let mut pieces: Vec<Piece> = Vec::new();
    let mut reseamed = None;
    for job in &jobs {
        let without_seams = || AdviceError::NestWithoutSeams { pattern: job.pattern.name.clone() };
        let seams = job.seams.as_ref().ok_or_else(without_seams)?;
        let (sized, sized_seams) = redrawn(job, seams, moves)?;
        pieces.extend(sized.into_iter().map(|piece| Piece { size: Some(job.size.clone()), ..piece }));
        // The requested size is the last, so the seam file beside the nest is that of this size.
        reseamed = Some(sized_seams);
    }
    size_order::sort(&mut pieces, |piece| piece.size.as_deref().unwrap_or_default());
    let name = format!("{name}.dxf");
    let bytes = dxf::write_pieces(&pieces, &texts(spec), standard);
    let file = SourceFile { name: name.clone(), bytes: bytes.clone().into() };
    for job in &jobs {
        patterns::read_style(&file, reseamed.as_ref(), Some(&job.size), None)?;
    }
    Ok(vec![(name, bytes)])
}

struct NotKept(String);

impl<E: std::fmt::Display> From<E> for NotKept {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

struct Kept {
    pattern: SourceFile,
    seams: SourceFile,
    unit: Option<patterns::Unit>,
    /// Greatest distance of a curve of few points from where its points would be.
    departs_m: f64,
}

/// Changes all sizes of a pattern in its files, if they hold the sizes of all jobs, and reads these again.
fn kept_nest(
    spec: &JobSpec,
    jobs: &[&JobSpec],
    moves: &[(Handle, f64)],
    name: &str,
) -> std::result::Result<Vec<(String, Vec<u8>)>, NotKept> {
    let is_other = |job: &&&JobSpec| job.pattern.bytes != spec.pattern.bytes || job.unit != spec.unit;
    if let Some(other) = jobs.iter().find(is_other) {
        return Err(format!("size {} is in another file than size {}", other.size, spec.size).into());
    }
    let source = patterns::Nest::read(&spec.pattern, spec.unit.as_deref().and_then(patterns::unit_of))?;
    // The seam file is that of the requested size, which comes last.
    let is_it = |size: &&str| size.eq_ignore_ascii_case(&spec.size);
    let sizes: Vec<&str> = source.sizes().into_iter().filter(|size| !is_it(size)).chain([spec.size.as_str()]).collect();
    let kept = kept(spec, &sizes, moves, name)?;
    for job in jobs {
        patterns::read_style(&kept.pattern, Some(&kept.seams), Some(&job.size), kept.unit)?;
    }
    Ok(files_of(&kept.pattern))
}

fn kept(spec: &JobSpec, sizes: &[&str], moves: &[(Handle, f64)], name: &str) -> std::result::Result<Kept, NotKept> {
    let unit = spec.unit.as_deref().and_then(patterns::unit_of);
    let parts = spec.pattern.parts();
    if let Some(other) = parts.iter().find(|part| source::kind(&part.bytes) != Kind::Dxf) {
        return Err(format!("{} is no DXF", other.name).into());
    }
    let Some(seams) = &spec.seams else { return Err("the pattern has no seam file".into()) };
    // Pieces of each size, and how many of them come of each part.
    let mut drawn: Vec<(Vec<Piece>, Vec<usize>)> = Vec::new();
    for size in sizes {
        let of_part = |part: &SourceFile| patterns::pieces(part, Some(size), unit);
        let of_parts = parts.iter().map(of_part).collect::<Result<Vec<_>>>()?;
        let counts = of_parts.iter().map(Vec::len).collect();
        drawn.push((of_parts.concat(), counts));
    }
    let redrawings = drawn.iter().map(|(pieces, _)| Redrawn::of(pieces, &seams.bytes, &seams.name, moves));
    let redrawings = redrawings.collect::<std::result::Result<Vec<_>, _>>()?;
    let (mut changed, mut departs_m) = (Vec::new(), 0.0_f64);
    for (number, part) in parts.iter().enumerate() {
        let of_sizes = drawn.iter().zip(&redrawings).flat_map(|((pieces, counts), redrawn)| {
            let before: usize = counts[..number].iter().sum();
            (before..before + counts[number]).map(move |piece| (&pieces[piece], move |p| redrawn.carried(piece, p)))
        });
        let carried: Vec<_> = of_sizes.collect();
        let redraws: Vec<Redraw<'_>> = carried.iter().map(|(piece, carried)| Redraw { piece, carried }).collect();
        let Patched { bytes, departs_m: of_part } = patched(&part.bytes, &part.name, unit, &redraws)?;
        departs_m = departs_m.max(of_part);
        changed.push(SourceFile { name: part.name.clone(), bytes: bytes.into() });
    }
    let pattern = match &changed[..] {
        [only] if !spec.pattern.name.ends_with('/') => {
            SourceFile { name: format!("{name}.dxf"), bytes: only.bytes.clone() }
        }
        parts => SourceFile::folder(name, parts),
    };
    let mut reseamed = seams.bytes.to_vec();
    for (size, redrawn) in sizes.iter().zip(&redrawings) {
        let again = patterns::pieces(&pattern, Some(size), unit)?;
        let of_size = redrawn.seams(&again, &seams.bytes, &seams.name)?;
        // Corners are found on one size of a nest. Without a name of that size, the requested one comes last.
        if of_size != *seams.bytes {
            reseamed = of_size;
        }
    }
    let seams = SourceFile { name: format!("{name}.seams.toml"), bytes: reseamed.into() };
    Ok(Kept { pattern, seams, unit, departs_m })
}

impl Kept {
    /// Reads the size of a job again. Fails where the files do not make the changed style.
    fn checked(self, spec: &JobSpec, changed: &Style) -> std::result::Result<Written, NotKept> {
        let again = patterns::read_style(&self.pattern, Some(&self.seams), Some(&spec.size), self.unit)?;
        let apart_mm = mm(outlines_apart_m(&again, changed));
        let departs_mm = mm(self.departs_m);
        if apart_mm > APART_MM + departs_mm {
            return Err(format!("read again, an outline is {apart_mm:.1} mm off").into());
        }
        let remark = format!(
            "curves of few points keep their number of points: an outline is up to {apart_mm:.1} mm beside the change"
        );
        let remarks = if apart_mm > APART_MM { vec![remark] } else { Vec::new() };
        let files = files_of(&self.pattern).into_iter().chain(files_of(&self.seams)).collect();
        Ok(Written { files, again, keeps_source: true, remarks })
    }
}

/// Files of a pattern by name; those of a folder within it.
fn files_of(pattern: &SourceFile) -> Vec<(String, Vec<u8>)> {
    let within = if pattern.name.ends_with('/') { pattern.name.as_str() } else { "" };
    pattern.parts().into_iter().map(|part| (format!("{within}{}", part.name), part.bytes.to_vec())).collect()
}

fn anew(
    spec: &JobSpec,
    seams: &SourceFile,
    moves: &[(Handle, f64)],
    standard: Standard,
    name: &str,
    reason: String,
) -> Result<Written> {
    let (pieces, reseamed) = redrawn(spec, seams, moves)?;
    let file =
        SourceFile { name: format!("{name}.dxf"), bytes: dxf::write_pieces(&pieces, &texts(spec), standard).into() };
    let seams = SourceFile { name: format!("{name}.seams.toml"), ..reseamed };
    let again = patterns::read_style(&file, Some(&seams), None, None)?;
    let files = [&file, &seams].into_iter().flat_map(files_of).collect();
    let remark = format!("the pattern is written anew, not as it came: {reason}");
    Ok(Written { files, again, keeps_source: false, remarks: vec![remark] })
}

/// Pieces of a job's size as drawn, with the handles moved, and their seam file.
fn redrawn(spec: &JobSpec, seams: &SourceFile, moves: &[(Handle, f64)]) -> Result<(Vec<Piece>, SourceFile)> {
    let unit = spec.unit.as_deref().and_then(patterns::unit_of);
    let drawn = patterns::pieces(&spec.pattern, Some(&spec.size), unit)?;
    let redrawn = Redrawn::of(&drawn, &seams.bytes, &seams.name, moves).origin(Origin::Alter)?;
    let pieces = redrawn.pieces();
    let reseamed = redrawn.seams(&pieces, &seams.bytes, &seams.name).origin(Origin::Alter)?;
    Ok((pieces, SourceFile { name: seams.name.clone(), bytes: reseamed.into() }))
}

fn texts(spec: &JobSpec) -> [(String, String); 2] {
    [("Style Name".to_owned(), spec.garment.clone()), ("Units".to_owned(), "METRIC".to_owned())]
}
