//! Report of `pattern inspect`: the content of a pattern file, in millimetres.

use std::collections::BTreeMap;

use serde::Serialize;

use super::dxf::{PatternFile, Refused, UnitSource};
use super::piece::Piece;
use geom::V2;
use geom::polyline::signed_area;
use geom::units::mm;

/// Square millimetres in a square metre.
const MM2_PER_M2: f64 = 1e6;

/// Content of one pattern file, or the reason why it cannot be read.
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
    /// Blocks that cannot be used as pieces.
    pub refused: Vec<Refused>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Number of unused entities by layer.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub unused: BTreeMap<String, usize>,
    /// Reason why the file cannot be read.
    pub error: Option<String>,
    /// Names of blocks byte for byte as in the file ([`PatternFile::as_written`]), by the names in its code page, where
    /// the two differ.
    #[serde(skip)]
    pub written: BTreeMap<String, String>,
}

/// One piece as the file stores it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PieceReport {
    /// Name of the block in the file's code page.
    pub block: String,
    /// Name of the piece in the file's code page, or the name of the block if the file gives none.
    pub name: String,
    /// Size as the piece or the file names it.
    pub size: Option<String>,
    /// Quantity to cut, as written.
    pub quantity: Option<String>,
    /// Length of the outline as drawn, mm, before any repair.
    pub perimeter_mm: f64,
    /// Area within the outline, mm2.
    pub area_mm2: f64,
    /// True if the outline is closed. Always true, because a piece with an open outline is refused.
    pub closed: bool,
    /// True if the file draws the outline clockwise.
    pub clockwise: bool,
    /// Number of turn points.
    pub turn_points: usize,
    /// Number of curve points.
    pub curve_points: usize,
    /// Number of notches.
    pub notches: usize,
    /// Length of the grain line, mm.
    pub grain_mm: Option<f64>,
    /// Number of mirror lines: 1 for a half piece, otherwise 0.
    pub mirror_lines: usize,
    /// Number of internal lines.
    pub internal_lines: usize,
    /// Number of cut-outs.
    pub cut_outs: usize,
    /// Number of drill holes.
    pub drill_holes: usize,
    /// Area within the sew line, mm2.
    pub sew_area_mm2: Option<f64>,
    /// True for a half piece. It is opened for sewing, but measured as stored.
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
            pieces: file.pieces.iter().map(PieceReport::from).collect(),
            refused: file.refused.clone(),
            warnings: file.warnings.clone(),
            unused: file.unused.clone(),
            error: None,
            written: written_names(file),
        }
    }
}

impl FileReport {
    /// Report of a file that cannot be read.
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
            written: BTreeMap::new(),
        }
    }

    /// Report for other programs: names of blocks byte for byte as in the file, whatever the code page of its reader.
    pub fn as_written(mut self) -> Self {
        let blocks = self.pieces.iter_mut().map(|piece| &mut piece.block);
        for block in blocks.chain(self.refused.iter_mut().map(|refused| &mut refused.block)) {
            if let Some(written) = self.written.get(block) {
                written.clone_into(block);
            }
        }
        self
    }
}

/// Names of the blocks of a file as they are written, where that is not how they read.
fn written_names(file: &PatternFile) -> BTreeMap<String, String> {
    let blocks = file.pieces.iter().map(|piece| &piece.block).chain(file.refused.iter().map(|refused| &refused.block));
    blocks.map(|block| (block.clone(), file.as_written(block))).filter(|(read, written)| read != written).collect()
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
