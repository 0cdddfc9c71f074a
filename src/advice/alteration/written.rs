//! Changed patterns as files, and the styles read again from these files.

use crate::error::AdviceError;
use pattern::dxf::{self, Standard};
use pattern::handle::{self, Redrawn};
use pattern::piece::Piece;
use pattern::{Handle, Style, garmentcode, size_order};
use spec::{JobSpec, patterns};
use store::files::SourceFile;
use store::{InOrigin, Origin, Result};

/// A changed pattern in files.
pub struct Written {
    /// Files by name: the pattern, its seam file if it has one, and a sheet of old and new outlines.
    pub files: Vec<(String, Vec<u8>)>,
    /// Style as read from the files.
    pub again: Style,
}

/// Writes a job's style with moved handles into files called `name`: DXF and seam file, or GarmentCode JSON where the
/// pattern holds its own seams.
///
/// # Errors
/// When the drawn pieces cannot be changed in this way, or the files cannot be read again.
pub fn written(
    spec: &JobSpec,
    [style, changed]: [&Style; 2],
    moves: &[(Handle, f64)],
    standard: Standard,
    name: &str,
) -> Result<Written> {
    let sheet = (format!("{name}.svg"), pattern::drawing::changed_svg(style, changed).into_bytes());
    let Some(seams) = &spec.seams else {
        let text = serde_json::to_vec_pretty(&garmentcode::document(changed)).origin(Origin::Alter)?;
        let file = SourceFile { name: format!("{name}.json"), bytes: text.into() };
        let again = patterns::read_style(&file, None, None, None)?;
        return Ok(Written { files: vec![(file.name.clone(), file.bytes.to_vec()), sheet], again });
    };
    let Redrawn { pieces, seams: reseamed } = redrawn(spec, seams, moves)?;
    let file =
        SourceFile { name: format!("{name}.dxf"), bytes: dxf::write_pieces(&pieces, &texts(spec), standard).into() };
    let seams = SourceFile { name: format!("{name}.seams.toml"), bytes: reseamed.into() };
    let again = patterns::read_style(&file, Some(&seams), None, None)?;
    let files = [&file, &seams].map(|file| (file.name.clone(), file.bytes.to_vec())).into_iter().chain([sheet]);
    Ok(Written { files: files.collect(), again })
}

/// Writes all sizes of a garment, changed alike, into one DXF file called `name`, with every piece in every size. Reads
/// the file again before returning it.
///
/// # Errors
/// When a size cannot be changed in this way or read again, or the pattern holds its own seams, which no nest can.
pub fn nest(
    spec: &JobSpec,
    others: &[JobSpec],
    moves: &[(Handle, f64)],
    standard: Standard,
    name: &str,
) -> Result<(String, Vec<u8>)> {
    let mut pieces: Vec<Piece> = Vec::new();
    let mut reseamed = None;
    for job in others.iter().chain([spec]) {
        let without_seams = || AdviceError::NestWithoutSeams { pattern: job.pattern.name.clone() };
        let seams = job.seams.as_ref().ok_or_else(without_seams)?;
        let sized = redrawn(job, seams, moves)?;
        pieces.extend(sized.pieces.into_iter().map(|piece| Piece { size: Some(job.size.clone()), ..piece }));
        // The requested size is the last, so the seam file beside the nest is that of this size.
        reseamed = Some(SourceFile { name: seams.name.clone(), bytes: sized.seams.into() });
    }
    size_order::sort(&mut pieces, |piece| piece.size.as_deref().unwrap_or_default());
    let name = format!("{name}.dxf");
    let bytes = dxf::write_pieces(&pieces, &texts(spec), standard);
    let file = SourceFile { name: name.clone(), bytes: bytes.clone().into() };
    for job in others.iter().chain([spec]) {
        patterns::read_style(&file, reseamed.as_ref(), Some(&job.size), None)?;
    }
    Ok((name, bytes))
}

/// Pieces of a job's size as drawn, with the handles moved.
fn redrawn(spec: &JobSpec, seams: &SourceFile, moves: &[(Handle, f64)]) -> Result<Redrawn> {
    let unit = spec.unit.as_deref().and_then(patterns::unit_of);
    let drawn = patterns::pieces(&spec.pattern, Some(&spec.size), unit)?;
    handle::redrawn(&drawn, &seams.bytes, &seams.name, moves).origin(Origin::Alter)
}

/// Texts for the head of a file.
fn texts(spec: &JobSpec) -> [(String, String); 2] {
    [("Style Name".to_owned(), spec.garment.clone()), ("Units".to_owned(), "METRIC".to_owned())]
}
