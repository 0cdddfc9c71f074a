//! The changed pattern as files, and as they are read again.

use crate::error::{Result, StudyError};
use crate::files::SourceFile;
use crate::patterns;
use crate::spec::JobSpec;
use pattern::dxf::{self, Standard};
use pattern::{Handle, Style, garmentcode, handle};

/// A changed pattern in files.
pub struct Written {
    /// By file name: the pattern, its seam file where it has one, and a sheet of old and new outlines.
    pub files: Vec<(String, Vec<u8>)>,
    /// The style that the files make.
    pub again: Style,
}

/// Writes a job's style as its handles change it: DXF with its seam file, or GarmentCode JSON where the pattern holds its own seams.
///
/// # Errors
/// What the handles refuse of the pieces as they are drawn; what cannot be read again.
pub fn written(
    spec: &JobSpec,
    style: &Style,
    changed: &Style,
    moves: &[(Handle, f64)],
    standard: Standard,
) -> Result<Written> {
    let name = format!("{}-{}-{}", spec.garment, spec.size, spec.subject);
    let sheet = (format!("{name}.svg"), pattern::drawing::changed_svg(style, changed).into_bytes());
    let Some(seams) = &spec.seams else {
        let text = serde_json::to_vec_pretty(&garmentcode::document(changed)).map_err(StudyError::stage("alter"))?;
        let file = SourceFile { name: format!("{name}.json"), bytes: text.into() };
        let again = patterns::read_style(&file, None, None, None)?;
        return Ok(Written { files: vec![(file.name.clone(), file.bytes.to_vec()), sheet], again });
    };
    let unit = spec.unit.as_deref().and_then(patterns::unit_of);
    let drawn = patterns::pieces(&spec.pattern, Some(&spec.size), unit)?;
    let pieces = handle::redrawn(&drawn, &seams.bytes, &seams.name, moves).map_err(StudyError::stage("alter"))?;
    let texts = [("Style Name".to_owned(), spec.garment.clone()), ("Units".to_owned(), "METRIC".to_owned())];
    let file = SourceFile { name: format!("{name}.dxf"), bytes: dxf::write_pieces(&pieces, &texts, standard).into() };
    let again = patterns::read_style(&file, Some(seams), None, None)?;
    let seam_file = (format!("{name}.seams.toml"), seams.bytes.to_vec());
    Ok(Written { files: vec![(file.name.clone(), file.bytes.to_vec()), seam_file, sheet], again })
}
