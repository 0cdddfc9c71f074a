//! Reading of pattern files of every supported kind: DXF, GarmentCode JSON, pattern features as JSON.

use super::dxf::{self, CodePage, DxfError, PatternFile, Unit, UnitSource};
use super::features::{self, FeaturesError};
use super::garmentcode::{self, GarmentCodeError, Specification};

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SourceError {
    /// Also a file of unknown kind, read as DXF.
    #[error(transparent)]
    Dxf(#[from] DxfError),
    #[error(transparent)]
    GarmentCode(#[from] GarmentCodeError),
    #[error(transparent)]
    Features(#[from] FeaturesError),
}

/// Kind that the first bytes of a file tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// DXF, or an unknown kind.
    Dxf,
    /// JSON that holds its seams.
    GarmentCode,
    Features,
}

pub fn kind(bytes: &[u8]) -> Kind {
    let text = without_mark(bytes);
    match text.starts_with(b"{") {
        true if features::is_features(text) => Kind::Features,
        true => Kind::GarmentCode,
        false => Kind::Dxf,
    }
}

/// True for features, or panels as GarmentCode writes them. JSON files of other kinds often lie beside patterns.
pub fn is_json_pattern(bytes: &[u8]) -> bool {
    #[derive(serde::Deserialize)]
    struct Head {
        pattern: Option<Panels>,
    }
    #[derive(serde::Deserialize)]
    struct Panels {
        panels: Option<serde::de::IgnoredAny>,
    }
    let text = without_mark(bytes);
    let has_panels =
        || serde_json::from_slice::<Head>(text).is_ok_and(|h| h.pattern.is_some_and(|p| p.panels.is_some()));
    features::is_features(text) || has_panels()
}

/// Cuts off the byte order mark and blanks at the beginning.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes).trim_ascii_start()
}

/// Reads the pieces of a pattern file of any kind. `unit` overrides the unit of a DXF file.
///
/// # Examples
/// ```
/// use pattern::dxf::Unit;
/// use pattern::{draft::Model, source};
///
/// // The bytes of a file; here of the drafted T-shirt, whose first size is S.
/// let (name, bytes) = Model::Tshirt.files().swap_remove(0);
/// let file = source::read(&bytes, &name, None)?;
/// assert_eq!((file.unit, file.pieces.len()), (Unit::Mm, 3));
///
/// // What is wrong with a file is told with its line and with what would be accepted.
/// let error = source::read(b"0\nSECTION\n", "shirt.dxf", None).unwrap_err();
/// assert!(error.to_string().starts_with("shirt.dxf"));
/// # Ok::<(), source::SourceError>(())
/// ```
pub fn read(bytes: &[u8], file: &str, unit: Option<Unit>) -> Result<PatternFile, SourceError> {
    Ok(match kind(bytes) {
        Kind::Dxf => dxf::read(bytes, file, unit)?,
        Kind::Features => features::read(without_mark(bytes), file)?,
        Kind::GarmentCode => garmentcode::read(without_mark(bytes), file)?.into(),
    })
}

impl From<Specification> for PatternFile {
    /// Takes the panels as pieces, without their seams.
    fn from(specification: Specification) -> Self {
        Self {
            file: specification.file,
            format: "GarmentCode JSON".to_owned(),
            // The coordinates are in metres already. The unit only reports that of the file.
            unit: if specification.mm_per_unit == 10.0 { Unit::Cm } else { Unit::Mm },
            unit_source: UnitSource::File,
            texts: Vec::new(),
            pieces: specification.pieces,
            refused: Vec::new(),
            warnings: Vec::new(),
            unit_remark: None,
            unused: Default::default(),
            encoding: CodePage::Web(encoding_rs::UTF_8),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Style;
    use crate::draft::{Model, TshirtSize, tshirt};

    #[test]
    fn every_kind_is_told_by_its_content_and_gives_the_same_pieces() {
        let draft = tshirt(TshirtSize::M);
        let dxf = draft.dxf();
        let features = features::Features::of(&draft.pieces, "tshirt.dxf", &[]);
        let features = serde_json::to_vec(&features).expect("JSON");
        let (_, seams) = Model::Tshirt.files().into_iter().find(|(name, _)| name.ends_with(".toml")).expect("seams");
        let style = Style::read(&draft.pieces, &seams, "seams").expect("our own seams");
        let mut specification = b"\xEF\xBB\xBF\n".to_vec();
        specification.extend(serde_json::to_vec(&garmentcode::document(&style)).expect("JSON"));
        for (bytes, expect) in [(dxf, Kind::Dxf), (features, Kind::Features), (specification, Kind::GarmentCode)] {
            assert_eq!(kind(&bytes), expect);
            let file = read(&bytes, "tshirt", None).expect("our own file");
            let pieces = file.to_sew(None).expect("one size");
            assert!(pieces.len() >= draft.pieces.len(), "{expect:?}");
            for drawn in &draft.pieces {
                let near = |piece: &&crate::Piece| (piece.area_m2() / drawn.area_m2() - 1.0).abs() < 1e-3;
                assert!(pieces.iter().any(|piece| near(&piece)), "{expect:?}: {}", drawn.name);
            }
        }
        assert!(matches!(read(b"{\"pattern\"", "a.json", None), Err(SourceError::GarmentCode(_))));
        assert!(matches!(read(b"", "a.json", None), Err(SourceError::Dxf(_))));
    }
}
