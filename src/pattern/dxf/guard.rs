//! Inventory of a DXF file, counted from its tags before the `dxf` crate reads it.
//!
//! The crate returns `Ok` even where it drops entities: polylines with unknown group codes (240-269, as some 3D garment
//! CAD writes them) and vertices with malformed numbers. Every number is therefore checked here, and the unknown codes
//! are removed. Afterwards the entities that the crate returns are compared with these counts.

use std::collections::{BTreeMap, BTreeSet};

use super::DxfError;
use super::tags::{Tag, ValueType, clipped, value_type};

/// Kinds that carry a pattern. `VERTEX` includes the vertices of LWPOLYLINE.
pub const KINDS: [&str; 12] = [
    "POLYLINE",
    "VERTEX",
    "LWPOLYLINE",
    "LINE",
    "POINT",
    "TEXT",
    "MTEXT",
    "INSERT",
    "ARC",
    "CIRCLE",
    "ELLIPSE",
    "SPLINE",
];

/// Other kinds of DXF [DXF reference, ENTITIES section]. A kind in neither list means a damaged or foreign file.
const OTHER_KINDS: [&str; 36] = [
    "3DFACE",
    "3DLINE",
    "3DSOLID",
    "ACAD_PROXY_ENTITY",
    "ARCALIGNEDTEXT",
    "ATTDEF",
    "ATTRIB",
    "BODY",
    "DGNUNDERLAY",
    "DIMENSION",
    "DWFUNDERLAY",
    "HATCH",
    "HELIX",
    "IMAGE",
    "LEADER",
    "LIGHT",
    "MESH",
    "MLEADER",
    "MLINE",
    "MULTILEADER",
    "OLE2FRAME",
    "OLEFRAME",
    "PDFUNDERLAY",
    "RAY",
    "REGION",
    "RTEXT",
    "SEQEND",
    "SHAPE",
    "SOLID",
    "SUN",
    "SURFACE",
    "TOLERANCE",
    "TRACE",
    "VIEWPORT",
    "WIPEOUT",
    "XLINE",
];

const SECTIONS: [&str; 8] =
    ["HEADER", "CLASSES", "TABLES", "BLOCKS", "ENTITIES", "OBJECTS", "THUMBNAILIMAGE", "ACDSDATA"];

/// Number of entities of unsupported kinds, by layer (as bytes of the file) and kind.
pub type Foreign<'a> = BTreeMap<(&'a [u8], &'a str), usize>;

/// Unsupported kinds that draw no part of a piece.
const LABELS: [&str; 3] = ["ATTDEF", "ATTRIB", "SEQEND"];

/// Number of entities by kind.
pub type Counts = BTreeMap<&'static str, usize>;

#[derive(Clone, Debug, PartialEq)]
pub struct BlockCount<'a> {
    /// As bytes of the file.
    pub name: &'a [u8],
    /// Line of its `0/BLOCK` tag.
    pub line: usize,
    pub counts: Counts,
    pub foreign: Foreign<'a>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeaderValue<'a> {
    /// Trimmed. Empty if it is not UTF-8.
    pub value: &'a str,
    pub line: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located<'a> {
    pub bytes: &'a [u8],
    /// From 1.
    pub line: usize,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inventory<'a> {
    pub header: BTreeMap<&'a str, HeaderValue<'a>>,
    pub blocks: Vec<BlockCount<'a>>,
    /// Supported entities outside blocks.
    pub entities: Counts,
    /// Outside blocks.
    pub foreign: Foreign<'a>,
    /// Group code 1 of TEXT and MTEXT, and 3 of MTEXT.
    pub texts: Vec<Located<'a>>,
    /// Line numbers of entities between blocks. They are part of no block.
    pub strays: Vec<usize>,
    inserted: Vec<Located<'a>>,
    /// Version, blocks and entities for the `dxf` crate, without the undefined group codes.
    pub clean: Vec<Tag<'a>>,
}

/// Skips the undefined group codes 240-269.
pub fn take_inventory<'a>(tags: &[Tag<'a>], file: &str) -> Result<Inventory<'a>, DxfError> {
    let mut walk = Walk { file, section: None, block: None, inventory: Inventory::default() };
    // A record is a tag of group code 0 and the tags up to the next one.
    let starts: Vec<usize> = (0..tags.len()).filter(|&i| tags[i].code == 0).collect();
    if let Some(stray) = tags[..starts.first().copied().unwrap_or(tags.len())].iter().find(|tag| tag.code != 999) {
        return Err(walk.fail(stray, format!("group code {} before the first section", stray.code), "0/SECTION"));
    }
    for (k, &start) in starts.iter().enumerate() {
        walk.record(&tags[start..starts.get(k + 1).copied().unwrap_or(tags.len())])?;
    }
    if walk.inventory.blocks.is_empty() && walk.inventory.entities.is_empty() {
        let found = "neither blocks nor entities".to_owned();
        return Err(DxfError::new(
            file,
            None,
            found,
            "a DXF file with pattern pieces in BLOCKS, or an outline in ENTITIES",
        ));
    }
    Ok(walk.inventory)
}

impl Inventory<'_> {
    /// Names of blocks and texts, as bytes.
    pub fn words(&self) -> impl Iterator<Item = &[u8]> {
        self.texts.iter().map(|text| text.bytes).chain(self.blocks.iter().map(|block| block.name))
    }

    /// Each once, with the line number of an insertion.
    pub fn missing_blocks(&self) -> Vec<(String, usize)> {
        let mut known: BTreeSet<Vec<u8>> = self.blocks.iter().map(|block| block.name.to_ascii_uppercase()).collect();
        let missing = self.inserted.iter().filter(|name| known.insert(name.bytes.to_ascii_uppercase()));
        missing.map(|name| (clipped(&String::from_utf8_lossy(name.bytes)), name.line)).collect()
    }
}

struct Walk<'a, 'f> {
    file: &'f str,
    section: Option<&'a str>,
    /// Line number of its start.
    block: Option<usize>,
    inventory: Inventory<'a>,
}

impl<'a> Walk<'a, '_> {
    fn fail(&self, tag: &Tag<'_>, found: String, accepted: &str) -> DxfError {
        DxfError::new(self.file, Some(tag.line), found, accepted)
    }

    fn record(&mut self, record: &[Tag<'a>]) -> Result<(), DxfError> {
        let head = record[0];
        match (head.keyword_static(), self.section) {
            ("SECTION", None) => {
                let name = record.get(1).filter(|tag| tag.code == 2).map(|tag| keyword_of(tag.value));
                let name = name
                    .ok_or_else(|| self.fail(&head, "a section without a name".to_owned(), "2/NAME after 0/SECTION"))?;
                if !SECTIONS.contains(&name) {
                    return Err(self.fail(&head, format!("section `{}`", clipped(name)), &SECTIONS.join(", ")));
                }
                self.section = Some(name);
                if name == "HEADER" {
                    self.header(&record[2..]);
                }
            }
            ("ENDSEC", Some(_)) => {
                if self.block.is_some() {
                    return Err(self.fail(
                        &head,
                        "the section ends inside a block".to_owned(),
                        "0/ENDBLK before 0/ENDSEC",
                    ));
                }
                self.section = None;
            }
            ("EOF", None) => {}
            (keyword @ ("SECTION" | "EOF"), Some(section)) => {
                let found = format!("{keyword} inside section {section}: the file is truncated or damaged");
                return Err(self.fail(&head, found, "0/ENDSEC first"));
            }
            (_, Some("BLOCKS" | "ENTITIES")) => return self.content(record),
            (_, Some(_)) => {}
            (keyword, None) => {
                return Err(self.fail(
                    &head,
                    format!("`{}` outside all sections", clipped(keyword)),
                    "0/SECTION or 0/EOF",
                ));
            }
        }
        let is_kept = matches!(self.section, Some("BLOCKS" | "ENTITIES")) && head.begins("SECTION");
        if is_kept {
            self.inventory.clean.extend(record.iter().take(2));
        } else if head.begins("ENDSEC") && self.inventory.clean.last().is_some_and(|tag| !tag.begins("ENDSEC")) {
            self.inventory.clean.push(head);
        }
        Ok(())
    }

    fn header(&mut self, tags: &[Tag<'a>]) {
        for pair in tags.windows(2) {
            if pair[0].code == 9 {
                let value = HeaderValue { value: keyword_of(pair[1].value), line: pair[1].line };
                self.inventory.header.insert(keyword_of(pair[0].value), value);
            }
        }
    }

    fn content(&mut self, record: &[Tag<'a>]) -> Result<(), DxfError> {
        let head = record[0];
        let is_in_blocks = self.section == Some("BLOCKS");
        self.check_values(record)?;
        match head.keyword_static() {
            "BLOCK" if is_in_blocks => {
                if let Some(line) = self.block.replace(head.line) {
                    return Err(self.fail(&head, format!("a block inside the block of line {line}"), "0/ENDBLK first"));
                }
                let name = record.iter().find(|tag| tag.code == 2).map(|tag| tag.value.trim_ascii());
                let name = name.ok_or_else(|| self.fail(&head, "a block without a name".to_owned(), "group code 2"))?;
                let (counts, foreign) = (Counts::new(), Foreign::new());
                self.inventory.blocks.push(BlockCount { name, line: head.line, counts, foreign });
            }
            "ENDBLK" if is_in_blocks => {
                // Some writers end the section with the ENDBLK of a block that was never opened.
                self.block = None;
            }
            _ if is_in_blocks && self.block.is_none() && !is_boundary(record) => {
                self.inventory.strays.push(head.line);
                return Ok(());
            }
            _ if is_in_blocks && self.block.is_none() => {
                return Err(self.fail(
                    &head,
                    format!("{} outside all blocks", clipped(head.keyword_static())),
                    "0/BLOCK first",
                ));
            }
            keyword if !KINDS.contains(&keyword) && !OTHER_KINDS.contains(&keyword) => {
                return Err(self.fail(&head, format!("`{}`", clipped(keyword)), "an entity of DXF"));
            }
            keyword => {
                self.check_coordinates(keyword, record)?;
                self.count(keyword, record);
            }
        }
        self.inventory.clean.extend(record.iter().filter_map(|tag| match value_type(tag.code) {
            ValueType::Undefined => None,
            ValueType::Integer(..) => Some(Tag { value: without_zero_decimals(tag.value), ..*tag }),
            ValueType::Real | ValueType::Text => Some(*tag),
        }));
        Ok(())
    }

    fn count(&mut self, keyword: &'a str, record: &[Tag<'a>]) {
        let (counts, foreign) = match self.inventory.blocks.last_mut() {
            Some(block) if self.block.is_some() => (&mut block.counts, &mut block.foreign),
            _ => (&mut self.inventory.entities, &mut self.inventory.foreign),
        };
        if !KINDS.contains(&keyword) && !LABELS.contains(&keyword) {
            let layer = record.iter().find(|tag| tag.code == 8).map_or(&b"0"[..], |tag| tag.value.trim_ascii());
            *foreign.entry((layer, keyword)).or_default() += 1;
        }
        if let Some(kind) = KINDS.into_iter().find(|&kind| kind == keyword) {
            *counts.entry(kind).or_default() += 1;
        }
        if keyword == "LWPOLYLINE" {
            *counts.entry("VERTEX").or_default() += record.iter().filter(|tag| tag.code == 10).count();
        }
        if keyword == "INSERT" {
            let names = record
                .iter()
                .filter(|tag| tag.code == 2)
                .map(|tag| Located { bytes: tag.value.trim_ascii(), line: tag.line });
            self.inventory.inserted.extend(names);
        }
        if matches!(keyword, "TEXT" | "MTEXT") {
            let is_text = |tag: &&Tag<'_>| tag.code == 1 || (keyword == "MTEXT" && tag.code == 3);
            self.inventory
                .texts
                .extend(record.iter().filter(is_text).map(|tag| Located { bytes: tag.value, line: tag.line }));
        }
    }

    fn check_values(&self, record: &[Tag<'a>]) -> Result<(), DxfError> {
        for tag in record {
            let value = String::from_utf8_lossy(tag.value.trim_ascii());
            let found =
                || format!("`{}` for group code {} of {}", clipped(&value), tag.code, record[0].keyword_static());
            match value_type(tag.code) {
                ValueType::Real if !value.parse::<f64>().is_ok_and(f64::is_finite) => {
                    return Err(self.fail(tag, found(), "a number with a decimal point, such as 78.88"));
                }
                ValueType::Integer(least, greatest)
                    if !keyword_of(without_zero_decimals(tag.value))
                        .parse::<i64>()
                        .is_ok_and(|v| (least..=greatest).contains(&v)) =>
                {
                    return Err(self.fail(tag, found(), &format!("an integer from {least} to {greatest}")));
                }
                ValueType::Undefined if !(240..=269).contains(&tag.code) => {
                    return Err(self.fail(
                        tag,
                        format!("undefined group code {}", tag.code),
                        "group codes of DXF (240-269 are skipped)",
                    ));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Checks the numbers of points and knots: the crate pairs incomplete lists without an error.
    fn check_spline(&self, record: &[Tag<'a>]) -> Result<(), DxfError> {
        let count = |code: i32| record.iter().filter(|tag| tag.code == code).count();
        for (x, y, stated, what) in [(10, 20, 73, "control points"), (11, 21, 74, "fit points"), (40, 40, 72, "knots")]
        {
            let says = record.iter().find(|tag| tag.code == stated).map(|tag| keyword_of(tag.value));
            if count(x) != count(y) || says.is_some_and(|says| says.parse() != Ok(count(x))) {
                let says = says.unwrap_or("an unstated number of");
                let found = format!("SPLINE of {says} {what} with {} and {}", count(x), count(y));
                let accepted = format!("as many of group codes {x} and {y} as group code {stated} says");
                return Err(self.fail(&record[0], found, &accepted));
            }
        }
        Ok(())
    }

    /// Refuses missing coordinates, which the crate takes for zero.
    fn check_coordinates(&self, keyword: &str, record: &[Tag<'a>]) -> Result<(), DxfError> {
        let needed: &[i32] = match keyword {
            "VERTEX" | "POINT" => &[10, 20],
            "LINE" => &[10, 20, 11, 21],
            "CIRCLE" => &[10, 20, 40],
            "ARC" => &[10, 20, 40, 50, 51],
            "ELLIPSE" => &[10, 20, 11, 21, 40],
            "SPLINE" => return self.check_spline(record),
            "LWPOLYLINE" => {
                let count = |code: i32| record.iter().filter(|tag| tag.code == code).count();
                let stated = record.iter().find(|tag| tag.code == 90).map_or("none", |tag| keyword_of(tag.value));
                if count(10) != count(20) || stated.parse() != Ok(count(10)) {
                    let found = format!("LWPOLYLINE of {stated} vertices with {} x and {} y", count(10), count(20));
                    return Err(self.fail(&record[0], found, "as many of group codes 10 and 20 as group code 90 says"));
                }
                &[]
            }
            _ => &[],
        };
        match needed.iter().find(|&&code| !record.iter().any(|tag| tag.code == code)) {
            Some(code) => Err(self.fail(
                &record[0],
                format!("{keyword} without group code {code}"),
                "both coordinates of every point",
            )),
            None => Ok(()),
        }
    }
}

/// True for a record of a boundary or a sew line, without which a piece is another one.
fn is_boundary(record: &[Tag<'_>]) -> bool {
    let layer = record.iter().find(|tag| tag.code == 8).map_or(&b"0"[..], |tag| tag.value.trim_ascii());
    matches!(layer, b"1" | b"14") && !matches!(record[0].keyword(), "TEXT" | "MTEXT" | "ATTRIB" | "ATTDEF" | "SEQEND")
}

/// Drops the zero decimals (`0.000000`) that some writers add to integers.
fn without_zero_decimals(value: &[u8]) -> &[u8] {
    match value.iter().position(|&byte| byte == b'.') {
        Some(point) if point > 0 && value[point + 1..].trim_ascii_end().iter().all(|&byte| byte == b'0') => {
            &value[..point]
        }
        _ => value,
    }
}

fn keyword_of(value: &[u8]) -> &str {
    std::str::from_utf8(value.trim_ascii()).unwrap_or("")
}

impl<'a> Tag<'a> {
    /// [`Tag::keyword`] with the lifetime of the file.
    fn keyword_static(&self) -> &'a str {
        keyword_of(self.value)
    }
}
