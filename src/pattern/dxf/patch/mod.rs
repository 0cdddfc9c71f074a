//! Changes of a DXF file in its own form: what moves gets other coordinates, and every other byte of the file stays.
//!
//! `sheet` holds the file with its changes, `sides` tells what becomes of a straight side, and `lines` changes the
//! entities of a piece.

mod lines;
mod sheet;
mod sides;

use std::ops::Range;

use geom::V2;
use geom::polyline::{boundary_distance, contains};
use geom::units::{from_mm, mm};

use self::lines::Redrawing;
use self::sheet::Sheet;
use super::tags::{Tag, scan};
use super::units::Unit;
use super::{DxfError, NO_BLOCK, is_layout};
use crate::piece::Piece;

/// Greatest difference between two changes of a block.
const ALIKE_M: f64 = 0.05e-3;
const NEAR_M: f64 = 1e-3;

pub struct Redraw<'a> {
    pub piece: &'a Piece,
    /// Place of a point after the change, in metres, as the file draws the piece.
    pub carried: &'a dyn Fn(V2) -> V2,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Patched {
    pub bytes: Vec<u8>,
    /// Greatest distance of an outline from where its points are carried to. It comes of curves, which keep their
    /// points.
    pub departs_m: f64,
}

/// Changes coordinates of what moves, in the decimals of the file and at least 3 in millimetres; all else stays byte
/// for byte. A straight side that bends by more than 0.2 mm gets as few points as it needs, each a curve point (layer
/// 3) where the file marks such. Curves keep their points. Fails where one block would change in two ways.
pub fn patched(bytes: &[u8], file_name: &str, unit: Option<Unit>, redraws: &[Redraw<'_>]) -> Result<Patched, DxfError> {
    let unit = super::read(bytes, file_name, unit)?.unit;
    let tags = scan(bytes, file_name)?;
    let entities = entities(&tags);
    let marks_curves = entities.iter().any(|entity| entity.kind == "POINT" && entity.layer == "3");
    let mut sheet = Sheet::new(bytes, tags, unit);
    let mut departs_m = 0.0_f64;
    for (number, redraw) in redraws.iter().enumerate() {
        if let Some(earlier) = redraws[..number].iter().find(|earlier| is_same(earlier.piece, redraw.piece)) {
            check_alike(file_name, earlier, redraw)?;
            continue;
        }
        let own: Vec<&Entity<'_>> = entities.iter().filter(|entity| entity.is_of(&sheet, unit, redraw.piece)).collect();
        departs_m = departs_m.max(Redrawing::new(&mut sheet, unit, redraw, marks_curves).draw(&own));
    }
    Ok(Patched { bytes: sheet.bytes(), departs_m })
}

fn is_same(piece: &Piece, other: &Piece) -> bool {
    match (piece.beside.line, other.beside.line) {
        (Some(line), Some(of_other)) => line == of_other,
        (None, None) => piece.outline == other.outline,
        _ => false,
    }
}

fn check_alike(file: &str, earlier: &Redraw<'_>, redraw: &Redraw<'_>) -> Result<(), DxfError> {
    let apart = |p: &V2| ((redraw.carried)(*p) - (earlier.carried)(*p)).norm();
    let apart_m = redraw.piece.outline.iter().map(apart).fold(0.0, f64::max);
    if apart_m <= ALIKE_M {
        return Ok(());
    }
    Err(DxfError {
        file: file.to_owned(),
        line: redraw.piece.beside.line,
        block: Some(redraw.piece.block.clone()),
        found: format!("two changes, {:.2} mm apart", mm(apart_m)),
        accepted: "a block for each size".to_owned(),
    })
}

/// An entity of BLOCKS or ENTITIES.
pub(super) struct Entity<'a> {
    /// A `POLYLINE` holds its vertices.
    kind: &'a str,
    layer: &'a str,
    /// Line number. `None` outside all blocks.
    block: Option<usize>,
    /// Tags of its first record.
    head: Range<usize>,
    vertices: Vec<Range<usize>>,
    last: usize,
}

impl Entity<'_> {
    /// Outside all blocks: true if it lies on the piece.
    fn is_of(&self, sheet: &Sheet<'_>, unit: Unit, piece: &Piece) -> bool {
        if self.block.is_some() || piece.beside.line.is_some() {
            return self.block == piece.beside.line;
        }
        // An insertion places a whole block, wherever its pieces have gone.
        if piece.block != NO_BLOCK || self.kind == "INSERT" {
            return false;
        }
        let first = self.vertices.first().unwrap_or(&self.head);
        let Some(spot) = spots(sheet, first.clone(), 10).into_iter().next() else { return false };
        let place = spot.at * from_mm(unit.mm_per_unit());
        contains(&piece.outline, &place) || boundary_distance(&piece.outline, &place) < NEAR_M
    }
}

#[derive(Clone, Copy, Debug)]
struct Spot {
    /// Index of the tag.
    x: usize,
    y: usize,
    /// In the unit of the file.
    at: V2,
}

/// Points with the group codes `code` and `code + 10`.
fn spots(sheet: &Sheet<'_>, range: Range<usize>, code: i32) -> Vec<Spot> {
    let mut spots = Vec::new();
    let mut x = None;
    for tag in range {
        if sheet.tags[tag].code == code {
            x = Some(tag);
        } else if sheet.tags[tag].code == code + 10
            && let Some(x) = x.take()
        {
            spots.push(Spot { x, y: tag, at: V2::new(sheet.number(x), sheet.number(tag)) });
        }
    }
    spots
}

fn entities<'a>(tags: &[Tag<'a>]) -> Vec<Entity<'a>> {
    let starts: Vec<usize> = (0..tags.len()).filter(|&tag| tags[tag].code == 0).collect();
    let mut found: Vec<Entity<'_>> = Vec::new();
    let (mut section, mut block, mut is_open) = ("", None, false);
    for (number, &start) in starts.iter().enumerate() {
        let head = start..starts.get(number + 1).copied().unwrap_or(tags.len());
        let keyword = |code: i32| head.clone().find(|&tag| tags[tag].code == code).map(|tag| keyword_of(tags[tag]));
        let kind = keyword_of(tags[start]);
        match kind {
            "SECTION" => section = keyword(2).unwrap_or_default(),
            _ if !matches!(section, "BLOCKS" | "ENTITIES") => {}
            "BLOCK" => block = (!is_layout(keyword(2).unwrap_or_default())).then_some(tags[start].line),
            "ENDBLK" => block = None,
            "ENDSEC" => section = "",
            "VERTEX" | "SEQEND" if is_open => {
                if let Some(line) = found.last_mut() {
                    line.last = head.end - 1;
                    if kind == "VERTEX" {
                        line.vertices.push(head);
                    }
                }
            }
            _ => {
                let layer = keyword(8).unwrap_or("0");
                found.push(Entity { kind, layer, block, last: head.end - 1, head, vertices: Vec::new() });
            }
        }
        is_open = matches!(kind, "POLYLINE") || (kind == "VERTEX" && is_open);
    }
    found
}

/// Trimmed. Empty if it is not ASCII.
fn keyword_of<'a>(tag: Tag<'a>) -> &'a str {
    std::str::from_utf8(tag.value.trim_ascii()).unwrap_or("")
}

#[cfg(test)]
mod tests;
