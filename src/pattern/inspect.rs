//! The report of `pattern inspect`: what a pattern file holds, in millimetres.

use std::collections::BTreeMap;

use serde::Serialize;

use super::dxf::{PatternFile, Refused, UnitSource};
use super::piece::Piece;
use geom::V2;
use geom::polyline::signed_area;
use geom::units::mm;

/// Square millimetres in a square metre.
const MM2_PER_M2: f64 = 1e6;

/// What one pattern file holds, or why it cannot be read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileReport {
    /// Name of the file, as it was given.
    pub file: String,
    /// Format and version.
    pub format: String,
    /// Unit of the numbers, `mm`, `cm`, `in` or `m`, with a remark where the user gave it or it is assumed.
    pub units: String,
    /// Millimetres in one unit.
    pub mm_per_unit: Option<f64>,
    /// Pieces in the order of the file.
    pub pieces: Vec<PieceReport>,
    /// Blocks that are no usable pieces.
    pub refused: Vec<Refused>,
    /// Things the user should know.
    pub warnings: Vec<String>,
    /// Number of entities that are not used, by layer.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub unused: BTreeMap<String, usize>,
    /// Why the file cannot be read.
    pub error: Option<String>,
}

/// One piece, as stored.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PieceReport {
    /// Name of the block, byte for byte as the file writes it ([`PatternFile::as_written`]).
    pub block: String,
    /// Piece name, or the block's name where the file gives none, in the file's code page.
    pub name: String,
    /// Size that the piece or the file names.
    pub size: Option<String>,
    /// Number to cut, as written.
    pub quantity: Option<String>,
    /// Length of the outline as the file draws it, with what was cut away to mend it.
    pub perimeter_mm: f64,
    /// Area within the outline.
    pub area_mm2: f64,
    /// Whether the outline closes (it does; a piece whose outline does not is refused).
    pub closed: bool,
    /// Whether the file drew the outline clockwise.
    pub clockwise: bool,
    /// Number of turn points.
    pub turn_points: usize,
    /// Number of curve points.
    pub curve_points: usize,
    /// Number of notches.
    pub notches: usize,
    /// Length of the grain line.
    pub grain_mm: Option<f64>,
    /// Number of mirror lines: 1 for a half piece, else 0.
    pub mirror_lines: usize,
    /// Number of internal lines.
    pub internal_lines: usize,
    /// Number of cut-outs.
    pub cut_outs: usize,
    /// Number of drill holes.
    pub drill_holes: usize,
    /// Area within the sew line.
    pub sew_area_mm2: Option<f64>,
    /// Whether this is a half piece, opened for sewing; it is measured as stored.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub unfolded: bool,
}

impl From<&PatternFile> for FileReport {
    fn from(file: &PatternFile) -> Self {
        let unit = file.unit.as_str();
        Self {
            file: file.file.clone(),
            format: file.format.clone(),
            units: match file.unit_source {
                UnitSource::Given => format!("{unit} (given)"),
                UnitSource::File => unit.to_owned(),
                UnitSource::Assumed => format!("none, assumed {unit}"),
            },
            mm_per_unit: Some(file.unit.mm_per_unit()),
            pieces: file
                .pieces
                .iter()
                .map(|piece| PieceReport { block: file.as_written(&piece.block), ..PieceReport::from(piece) })
                .collect(),
            refused: file
                .refused
                .iter()
                .map(|refused| Refused { block: file.as_written(&refused.block), ..refused.clone() })
                .collect(),
            warnings: file.warnings.clone(),
            unused: file.unused.clone(),
            error: None,
        }
    }
}

impl FileReport {
    /// Report of a file that cannot be read.
    #[must_use]
    pub fn unreadable(file: &str, error: String) -> Self {
        Self {
            file: file.to_owned(),
            format: String::new(),
            units: String::new(),
            mm_per_unit: None,
            pieces: Vec::new(),
            refused: Vec::new(),
            warnings: Vec::new(),
            unused: BTreeMap::new(),
            error: Some(error),
        }
    }
}

impl From<&Piece> for PieceReport {
    fn from(piece: &Piece) -> Self {
        let length = |ends: [V2; 2]| mm((ends[1] - ends[0]).norm());
        Self {
            block: piece.block.clone(),
            name: piece.name.clone(),
            size: piece.size.clone(),
            quantity: piece.quantity.clone(),
            perimeter_mm: mm(piece.drawn_perimeter_m.unwrap_or_else(|| piece.perimeter_m())),
            area_mm2: piece.area_m2() * MM2_PER_M2,
            closed: true,
            clockwise: piece.is_clockwise_in_file,
            turn_points: piece.turn_points.len(),
            curve_points: piece.curve_points.len(),
            notches: piece.notches.len(),
            grain_mm: piece.grain.map(length),
            mirror_lines: usize::from(piece.mirror_line.is_some()),
            internal_lines: piece.internal_lines.len(),
            cut_outs: piece.cut_outs.len(),
            drill_holes: piece.drill_holes.len(),
            sew_area_mm2: piece.sew_line.as_deref().map(|line| signed_area(line).abs() * MM2_PER_M2),
            unfolded: piece.unfolded().is_some(),
        }
    }
}
