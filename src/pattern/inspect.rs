//! Report of `pattern inspect`: the content of a pattern file, in millimetres.

use std::collections::BTreeMap;

use serde::Serialize;

use super::dxf::{PatternFile, Refused, UnitSource};
use super::piece::Piece;
use geom::V2;
use geom::polyline::signed_area;
use geom::units::mm;

const MM2_PER_M2: f64 = 1e6;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileReport {
    pub file: String,
    pub format: String,
    /// `mm`, `cm`, `in` or `m`, with a remark where the user gave it or it is assumed.
    pub units: String,
    pub mm_per_unit: Option<f64>,
    pub pieces: Vec<PieceReport>,
    pub refused: Vec<Refused>,
    pub warnings: Vec<String>,
    /// Number of entities by layer.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub unused: BTreeMap<String, usize>,
    pub error: Option<String>,
    /// Block names byte for byte ([`PatternFile::as_written`]), by the names in the code page, where the two differ.
    #[serde(skip)]
    pub written: BTreeMap<String, String>,
}

/// Piece as the file stores it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PieceReport {
    /// In the file's code page.
    pub block: String,
    /// In the file's code page, or the block if the file gives none.
    pub name: String,
    pub size: Option<String>,
    pub quantity: Option<String>,
    /// Outline as drawn, before any repair.
    pub perimeter_mm: f64,
    pub area_mm2: f64,
    /// Always true, because a piece with an open outline is refused.
    pub closed: bool,
    pub clockwise: bool,
    pub turn_points: usize,
    pub curve_points: usize,
    pub notches: usize,
    pub grain_mm: Option<f64>,
    /// 1 for a half piece, otherwise 0.
    pub mirror_lines: usize,
    pub internal_lines: usize,
    pub cut_outs: usize,
    pub drill_holes: usize,
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

    /// Names blocks byte for byte as in the file, for other programs, whatever their code page.
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

/// Block names that are not written as they read.
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
