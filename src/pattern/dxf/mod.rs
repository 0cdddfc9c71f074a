//! Reading and writing of AAMA/ASTM DXF: bytes to pieces and back. Nothing is dropped without a message.
//!
//! Layers [AAMA-292, ASTM D6673]: 1 boundary, 2 turn points, 3 curve points, 4 notches, 5 grade reference, 6 mirror
//! line, 7 grain line, 8 internal lines, 11 cut-outs, 13 drill holes, 14 sew line. Curves are flattened.
//!
//! A file is read in three steps. `guard` scans and counts its tags. The `dxf` crate reads the tags, and its entities
//! are compared with these counts. Then each block becomes a piece or is refused.

mod block_names;
mod blocks;
mod code_page;
mod curves;
mod figures;
mod guard;
mod loose;
mod mtext;
mod outline;
pub mod patch;
mod quality;
mod sew_line;
mod tags;
mod units;
mod write;

use std::collections::{BTreeMap, BTreeSet};

use dxf::entities::{Entity, EntityType};
use dxf::{Block, Drawing};

pub(crate) use self::block_names::r12_name;
use self::blocks::{Drawn, Library};
pub use self::code_page::CodePage;
use self::figures::Placement;
use self::guard::{BlockCount, Counts, Inventory, take_inventory};
use self::units::Encoding;
pub use self::units::{Unit, UnitSource};
pub(crate) use self::write::D6673;
pub use self::write::{Standard, write_pieces};
use super::piece::{Beside, Piece};
use super::style::named::without;
use super::{scale, size_order};

/// Greatest distance of a copy from what it draws again: the rounding of files.
const SHADOW_M: f64 = 0.1e-3;
/// Beginning of the reason why a block without an outline is refused.
const NO_OUTLINE: &str = "no outline";
/// Block name of an outline outside all blocks.
pub const NO_BLOCK: &str = "(no block)";

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}: found {found}; accepted: {accepted}", place(file, *line, block.as_deref()))]
pub struct DxfError {
    pub file: String,
    pub line: Option<usize>,
    pub block: Option<String>,
    pub found: String,
    pub accepted: String,
}

impl DxfError {
    fn new(file: &str, line: Option<usize>, found: String, accepted: &str) -> Self {
        Self { file: file.to_owned(), line, block: None, found, accepted: accepted.to_owned() }
    }
}

fn place(file: &str, line: Option<usize>, block: Option<&str>) -> String {
    let line = line.map(|line| format!(", line {line}")).unwrap_or_default();
    let block = block.map(|block| format!(", block `{block}`")).unwrap_or_default();
    format!("{file}{line}{block}")
}

/// A block that cannot be used as a piece.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Refused {
    /// Or [`NO_BLOCK`] for an outline outside all blocks.
    pub block: String,
    /// Line at which the block begins. `None` for a file without blocks.
    pub line: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<String>,
    /// Holds the place in millimetres.
    pub reason: String,
}

#[derive(Clone, Debug, PartialEq)]
pub struct PatternFile {
    pub file: String,
    /// `DXF AC1009`, or `DXF` alone if the file names no version.
    pub format: String,
    pub unit: Unit,
    pub unit_source: UnitSource,
    /// Outside the blocks, as `(key, value)`.
    pub texts: Vec<(String, String)>,
    /// In the order of the file.
    pub pieces: Vec<Piece>,
    pub refused: Vec<Refused>,
    pub warnings: Vec<String>,
    /// Warning that the file contradicts the unit in which it is read. It is in `warnings` too.
    pub unit_remark: Option<String>,
    /// Number of entities by layer.
    pub unused: BTreeMap<String, usize>,
    pub encoding: CodePage,
}

impl PatternFile {
    /// Name of a block byte for byte (Latin-1), whatever the code page of a reader. In a UTF-8 file it is the name
    /// itself.
    pub fn as_written(&self, block: &str) -> String {
        if block == NO_BLOCK || self.encoding.is_utf8() {
            return block.to_owned();
        }
        self.encoding.encoded(block).into_iter().map(char::from).collect()
    }

    /// Judges the unit by the length of the longest piece.
    fn doubt(&self) -> Option<String> {
        let longest_m = scale::longest_m(self.pieces.iter().map(|piece| &piece.outline[..]));
        if longest_m > 0.0 { scale::doubt(longest_m, self.unit) } else { None }
    }

    /// Smallest first. Names without an order stay in the order of the file. Pieces without a size count as size `""`.
    pub fn sizes(&self) -> Vec<&str> {
        let mut sizes = Vec::new();
        for piece in &self.pieces {
            let size = piece.size.as_deref().unwrap_or_default();
            if !sizes.contains(&size) {
                sizes.push(size);
            }
        }
        size_order::sort(&mut sizes, |size| size);
        sizes
    }

    /// The one that the file names, otherwise the middle one.
    pub fn sample_size(&self) -> &str {
        let sizes = self.sizes();
        let said = self.texts.iter().filter(|(key, _)| is_sample_size(key)).map(|(_, value)| value.as_str());
        let sample = said.filter_map(|said| sizes.iter().find(|size| size.eq_ignore_ascii_case(said))).next();
        sample.copied().unwrap_or_else(|| sizes.get(sizes.len() / 2).copied().unwrap_or_default())
    }

    /// Pieces of one size, half pieces unfolded. Without `size` the file must hold only one. Upper and lower case count
    /// as equal. Fails also where a block of this size was refused: the garment would be another one.
    pub fn to_sew(&self, size: Option<&str>) -> Result<Vec<Piece>, DxfError> {
        let doubt = self.doubt();
        if self.unit_source == UnitSource::Assumed {
            let accepted = "a `Units:` text or $INSUNITS in the file, or --unit mm, cm, in or m";
            let hint = doubt.map_or_else(String::new, |doubt| format!(" ({doubt})"));
            return Err(DxfError::new(&self.file, None, format!("no unit{hint}"), accepted));
        }
        if let Some(doubt) = doubt {
            let remark = self.unit_remark.as_ref().map_or_else(String::new, |remark| format!("{remark}; "));
            return Err(DxfError::new(&self.file, None, format!("{remark}{doubt}"), scale::ACCEPTED));
        }
        let sizes = self.sizes();
        let wanted = match (size, sizes.as_slice()) {
            (Some(size), _) => size,
            (None, [only]) => only,
            (None, []) => "",
            (None, _) => {
                return Err(DxfError::new(
                    &self.file,
                    None,
                    format!("{} sizes", sizes.len()),
                    &format!("one of {}", sizes.join(", ")),
                ));
            }
        };
        // A refused piece of another size does not belong to this garment.
        let is_part = |refused: &&Refused| refused.size.as_ref().is_none_or(|size| size.eq_ignore_ascii_case(wanted));
        if let Some(refused) = self.refused.iter().find(is_part) {
            return Err(DxfError {
                file: self.file.clone(),
                line: refused.line,
                block: Some(refused.block.clone()),
                found: refused.reason.clone(),
                accepted: "pieces with one closed outline of straight sides that does not cross itself".to_owned(),
            });
        }
        let said = self.texts.iter().filter(|(key, _)| is_of_garment(key)).map(|(_, value)| value);
        let garment: Vec<&String> = said.collect();
        let to_sew = |piece: &Piece| {
            let unfolded = piece.unfolded();
            Piece {
                beside: Beside {
                    garment: garment.iter().copied().chain(&piece.size).cloned().collect(),
                    fold: piece.mirror_line.filter(|_| unfolded.is_some()),
                    ..piece.beside.clone()
                },
                ..unfolded.unwrap_or_else(|| piece.clone())
            }
        };
        let whole = |size: &str| -> Vec<Piece> {
            let is_of = |piece: &&Piece| piece.size.as_deref().unwrap_or_default().eq_ignore_ascii_case(size);
            self.pieces.iter().filter(is_of).map(to_sew).collect()
        };
        let mut pieces = whole(wanted);
        if sizes.len() > 1 {
            join_sizes(&mut pieces, &sizes.iter().map(|size| whole(size)).collect::<Vec<_>>());
        }
        if sizes.is_empty() {
            let accepted = "pieces with a closed outline on layer 1";
            return Err(DxfError::new(&self.file, None, "no piece".to_owned(), accepted));
        }
        if pieces.is_empty() {
            return Err(DxfError::new(
                &self.file,
                None,
                format!("no size `{wanted}`"),
                &format!("one of {}", sizes.join(", ")),
            ));
        }
        Ok(pieces)
    }
}

/// Gives each piece its counterparts in the other sizes: the same name but for the size. Pieces of equal name are
/// matched in their order.
fn join_sizes(pieces: &mut [Piece], sizes: &[Vec<Piece>]) {
    let bare = |piece: &Piece| without(&piece.name, piece.size.as_deref().unwrap_or_default());
    // Full names are compared first: the 2 of `SLEEVE 2` may be no size.
    let is_same = |is_whole: bool, a: &Piece, b: &Piece| if is_whole { a.name == b.name } else { bare(a) == bare(b) };
    for k in 0..pieces.len() {
        let in_size = |size: &Vec<Piece>| {
            [true, false].into_iter().find_map(|is_whole| {
                let is_it = |other: &&Piece| is_same(is_whole, other, &pieces[k]);
                let number = pieces[..k].iter().filter(is_it).count();
                size.iter().filter(is_it).nth(number).cloned()
            })
        };
        pieces[k].beside.sizes = sizes.iter().filter_map(in_size).collect();
    }
}

pub fn is_sample_size(key: &str) -> bool {
    plain(key) == "samplesize"
}

fn is_of_garment(key: &str) -> bool {
    is_sample_size(key)
        || ["style", "stylename", "stylenumber", "styleno", "model", "modelname"].contains(&plain(key).as_str())
}

/// Lower case, without blanks and underscores.
fn plain(key: &str) -> String {
    key.to_ascii_lowercase().replace(['_', ' '], "")
}

/// `unit` overrides the unit of the file, `file_name` is for messages. A block that cannot be used is no error: it is
/// listed in [`PatternFile::refused`]. Fails also where the `dxf` crate loses an entity.
pub fn read(bytes: &[u8], file_name: &str, unit: Option<Unit>) -> Result<PatternFile, DxfError> {
    let tags = tags::scan(bytes, file_name)?;
    let inventory = take_inventory(&tags, file_name)?;
    let Encoding { page: encoding, remark } = units::code_page(&inventory, file_name)?;
    let (claims, unit_remark) = match unit {
        Some(given) => {
            (Vec::new(), units::claims(&inventory, file_name).ok().and_then(|c| units::overruled(&c, given)))
        }
        None => (units::claims(&inventory, file_name)?, None),
    };
    let (unit, unit_source) = match (unit, claims.first()) {
        (Some(unit), _) => (unit, UnitSource::Given),
        (None, Some(claim)) => (claim.unit, UnitSource::File),
        (None, None) => (Unit::Mm, UnitSource::Assumed),
    };
    let drawing = load(&inventory, encoding, file_name)?;
    let version = inventory.header.get("$ACADVER").map_or("", |entry| entry.value);
    let mut file = PatternFile {
        file: file_name.to_owned(),
        format: format!("DXF {version}").trim_end().to_owned(),
        unit,
        unit_source,
        texts: blocks::texts(drawing.entities()),
        pieces: Vec::new(),
        refused: Vec::new(),
        warnings: units::contradictions(&claims).into_iter().chain(unit_remark.clone()).chain(remark).collect(),
        unit_remark,
        unused: BTreeMap::new(),
        encoding,
    };
    file.warnings.extend(drawing.entities().filter_map(scaled_insert));
    file.warnings.extend(inventory.missing_blocks().into_iter().map(|(name, line)| {
        format!("block `{name}` is inserted (line {line}) but not in the file: what it draws is missing")
    }));
    if let Some(first) = inventory.strays.first() {
        let count = inventory.strays.len();
        file.warnings
            .push(format!("{count} entities stand between blocks (the first in line {first}): they are left out"));
    }
    if unit_source == UnitSource::Assumed {
        file.warnings.push(format!("{file_name} names no unit: millimetres are assumed; say the unit to sew from it"));
    }
    file.add_all(&drawing, &inventory);
    file.drop_shadows();
    file.warnings.extend(file.doubt());
    let sample_size =
        file.texts.iter().find(|(key, _)| key.eq_ignore_ascii_case("size")).map(|(_, value)| value.clone());
    for piece in &mut file.pieces {
        piece.size = piece.size.take().or_else(|| sample_size.clone());
    }
    file.share_texts();
    file.name_by_file();
    Ok(file)
}

impl PatternFile {
    fn add_all(&mut self, drawing: &Drawing, inventory: &Inventory<'_>) {
        let placement = Placement::scaled(geom::units::from_mm(self.unit.mm_per_unit()));
        let blocks: Vec<&Block> = drawing.blocks().collect();
        let library = Library::of(&blocks);
        let outside = || {
            let layouts = blocks.iter().filter(|block| is_layout(&block.name)).flat_map(|block| &block.entities);
            drawing.entities().chain(layouts)
        };
        let within = blocks.iter().filter(|block| !is_layout(&block.name)).flat_map(|block| &block.entities);
        let (on_sheet, in_others) = (inserted(outside()), inserted(within));
        let mut strange = Vec::new();
        for (block, counted) in blocks.iter().zip(&inventory.blocks).filter(|(block, _)| !is_layout(&block.name)) {
            let name = block.name.to_ascii_uppercase();
            if in_others.contains(&name) && !on_sheet.contains(&name) {
                self.warnings.push(format!("block `{}` is read as part of the blocks it is inserted in", block.name));
                continue;
            }
            let mut drawn = Drawn::collect(&block.entities, &placement, &library);
            drawn.add_foreign(&counted.foreign);
            self.count_unused(&drawn);
            if drawn.is_no_piece() && !drawn.is_empty() {
                strange.push((block.name.clone(), counted.line, drawn));
            } else if !drawn.is_empty() {
                self.warnings.extend(drawn.remarks(&block.name));
                self.add(&block.name, Some(counted.line), drawn);
            }
        }
        let mut outer = Drawn::default();
        outer.add_foreign(&inventory.foreign);
        self.count_unused(&outer);
        let loose = loose::read(outside(), &placement, &library);
        self.pieces.extend(loose.pieces);
        self.refused.extend(loose.refused);
        self.warnings.extend(loose.remarks);
        if let Some(rest) = loose.rest {
            self.count_unused(&rest);
            // Without blocks, the outline must be outside of them.
            if inventory.blocks.is_empty() {
                self.add(NO_BLOCK, None, rest);
            }
        }
        let is_foreign = self.pieces.is_empty() && self.refused.is_empty();
        for (name, line, drawn) in strange {
            if is_foreign {
                self.add(&name, Some(line), drawn);
            } else {
                self.warnings
                    .push(format!("block `{name}` is no piece: it draws on none of the layers 1-8, 11, 13, 14"));
            }
        }
    }

    fn add(&mut self, block: &str, line: Option<usize>, drawn: Drawn) {
        let (size, others) = (drawn.size(), drawn.layers_beside());
        match drawn.into_piece(block, &mut self.warnings) {
            Ok(mut piece) => {
                piece.beside.line = line;
                self.pieces.push(piece);
            }
            Err(reason) => {
                let reason = match others.filter(|_| reason.starts_with(NO_OUTLINE)) {
                    Some(others) => {
                        reason.replacen("; accepted", &format!(", but on other layers: {others}; accepted"), 1)
                    }
                    None => reason,
                };
                self.refused.push(Refused { block: block.to_owned(), line, size, reason });
            }
        }
    }

    /// Leaves out pieces that draw a piece again under its size and a number (`M-1`): CAD programs keep such copies.
    fn drop_shadows(&mut self) {
        let is_drawn_by = |piece: &Piece, of: &str, other: &Piece| {
            other.name == piece.name
                && other.size.as_deref() == Some(of)
                && other.outline.len() == piece.outline.len()
                && other.outline.iter().zip(&piece.outline).all(|(a, b)| (a - b).norm() < SHADOW_M)
        };
        let shadow = |piece: &Piece| {
            let (of, number) = piece.size.as_deref()?.rsplit_once('-')?;
            let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
            (is_number && self.pieces.iter().any(|other| is_drawn_by(piece, of, other))).then(|| of.to_owned())
        };
        let shadows: Vec<Option<String>> = self.pieces.iter().map(shadow).collect();
        let said = self.pieces.iter().zip(&shadows).filter_map(|(piece, of)| {
            let (size, of) = (piece.size.as_deref()?, of.as_deref()?);
            Some(format!("block `{}`: size {size} draws `{}` of size {of} again: left out", piece.block, piece.name))
        });
        self.warnings.extend(said.collect::<Vec<_>>());
        let mut is_shadow = shadows.iter().map(Option::is_some);
        self.pieces.retain(|_| !is_shadow.next().unwrap_or(false));
    }

    /// Copies the texts of the piece of the same name in another size: CAD programs write texts in the sample size
    /// alone.
    fn share_texts(&mut self) {
        let has_texts = |(_, piece): &(usize, &Piece)| !piece.texts.is_empty();
        // Of several pieces of a name, the first counts.
        let told: BTreeMap<String, usize> =
            self.pieces.iter().enumerate().filter(has_texts).rev().map(|(k, piece)| (piece.name.clone(), k)).collect();
        for k in 0..self.pieces.len() {
            if let Some(&from) = told.get(&self.pieces[k].name).filter(|_| self.pieces[k].texts.is_empty()) {
                let (quantity, texts) = (self.pieces[from].quantity.clone(), self.pieces[from].texts.clone());
                let piece = &mut self.pieces[k];
                piece.quantity = piece.quantity.take().or(quantity);
                piece.texts = texts;
            }
        }
    }

    /// Names the only piece of a file after the file, if nothing else names it.
    fn name_by_file(&mut self) {
        let stem = self.file.rsplit(['/', '\\']).next().unwrap_or_default();
        let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
        if let [piece] = &mut self.pieces[..]
            && piece.name == NO_BLOCK
            && !stem.is_empty()
        {
            piece.name = stem.to_owned();
        }
    }

    fn count_unused(&mut self, drawn: &Drawn) {
        for (layer, count) in &drawn.unused {
            *self.unused.entry(layer.clone()).or_default() += count;
        }
    }
}

/// True for the model or paper space of DXF.
fn is_layout(block: &str) -> bool {
    let name = block.trim_start_matches(['*', '$']).to_ascii_uppercase();
    name.len() < block.len() && (name.starts_with("MODEL_SPACE") || name.starts_with("PAPER_SPACE"))
}

/// In upper case.
fn inserted<'e>(entities: impl Iterator<Item = &'e Entity>) -> BTreeSet<String> {
    let name = |entity: &'e Entity| match &entity.specific {
        EntityType::Insert(insert) => Some(insert.name.to_ascii_uppercase()),
        _ => None,
    };
    entities.filter_map(name).collect()
}

fn scaled_insert(entity: &Entity) -> Option<String> {
    let EntityType::Insert(insert) = &entity.specific else { return None };
    let (x, y) = (insert.x_scale_factor, insert.y_scale_factor);
    (x != 1.0 || y != 1.0)
        .then(|| format!("block `{}` is inserted {x} x {y} times its size: it is read as stored", insert.name))
}

/// Compares the entities of the `dxf` crate with the inventory.
fn load(inventory: &Inventory<'_>, code_page: CodePage, file: &str) -> Result<Drawing, DxfError> {
    let mut clean = Vec::new();
    if let Some(version) = inventory.header.get("$ACADVER") {
        clean.extend(format!("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{}\n0\nENDSEC\n", version.value).into_bytes());
    }
    for tag in &inventory.clean {
        clean.extend(format!("{}\n", tag.code).into_bytes());
        match code_page {
            // The crate supports no OEM code page.
            CodePage::Dos(_) if !tag.value.is_ascii() => clean.extend(code_page.decoded(tag.value).into_bytes()),
            _ => clean.extend(tag.value),
        }
        clean.push(b'\n');
    }
    clean.extend(b"0\nEOF\n");
    let encoding = match code_page {
        CodePage::Web(encoding) => encoding,
        CodePage::Dos(_) => encoding_rs::UTF_8,
    };
    let drawing = Drawing::load_with_encoding(&mut clean.as_slice(), encoding).map_err(|error| {
        DxfError::new(file, None, format!("a file that the DXF reader refuses: {error}"), "a DXF file of R12 or later")
    })?;
    let blocks: Vec<&Block> = drawing.blocks().collect();
    if blocks.len() != inventory.blocks.len() {
        let found = format!("{} blocks, of which the reader kept {}", inventory.blocks.len(), blocks.len());
        return Err(DxfError::new(file, None, found, "blocks that the DXF reader keeps"));
    }
    for (counted, block) in inventory.blocks.iter().zip(blocks) {
        compare(file, Some(counted), &counted.counts, &counts_of(block.entities.iter()))?;
    }
    compare(file, None, &inventory.entities, &counts_of(drawing.entities()))?;
    Ok(drawing)
}

fn counts_of<'d>(entities: impl Iterator<Item = &'d Entity>) -> Counts {
    let mut counts = Counts::new();
    for entity in entities {
        let (kind, vertices) = match &entity.specific {
            EntityType::Polyline(line) => ("POLYLINE", line.vertices().count()),
            EntityType::LwPolyline(line) => ("LWPOLYLINE", line.vertices.len()),
            EntityType::Line(_) => ("LINE", 0),
            EntityType::ModelPoint(_) => ("POINT", 0),
            EntityType::Text(_) => ("TEXT", 0),
            EntityType::MText(_) => ("MTEXT", 0),
            EntityType::Insert(_) => ("INSERT", 0),
            EntityType::Arc(_) => ("ARC", 0),
            EntityType::Circle(_) => ("CIRCLE", 0),
            EntityType::Ellipse(_) => ("ELLIPSE", 0),
            EntityType::Spline(_) => ("SPLINE", 0),
            EntityType::Vertex(_) => ("VERTEX", 0),
            _ => continue,
        };
        *counts.entry(kind).or_default() += 1;
        *counts.entry("VERTEX").or_default() += vertices;
    }
    counts
}

fn compare(file: &str, block: Option<&BlockCount<'_>>, counted: &Counts, kept: &Counts) -> Result<(), DxfError> {
    let number = |counts: &Counts, kind: &str| counts.get(kind).copied().unwrap_or(0);
    for kind in guard::KINDS {
        if number(counted, kind) != number(kept, kind) {
            return Err(DxfError {
                file: file.to_owned(),
                line: block.map(|block| block.line),
                block: block.map(|block| String::from_utf8_lossy(block.name).into_owned()),
                found: format!("{} {kind}, of which the reader kept {}", number(counted, kind), number(kept, kind)),
                accepted: "entities that the DXF reader keeps".to_owned(),
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod shapes_tests;
#[cfg(test)]
mod tests;
