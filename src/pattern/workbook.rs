//! Cells of an XLSX workbook [ECMA-376], which is a ZIP archive of XML.
//!
//! Numbers and texts are read: shared, inline, and results of formulas. Styles are ignored, so a date is read as its
//! serial number. ZIP64, encryption and compression other than deflate are refused.

use std::io::Read;

use flate2::read::DeflateDecoder;
use roxmltree::{Document, Node};

use super::table::Row;

/// Greatest size of an unpacked part, bytes.
const MOST_UNPACKED: u64 = 64 << 20;
const MOST_COLUMNS: usize = 200;
/// Local header, central entry and end of central directory of a ZIP archive [PKWARE APPNOTE].
const LOCAL: [u8; 4] = *b"PK\x03\x04";
const CENTRAL: [u8; 4] = *b"PK\x01\x02";
const END: [u8; 4] = *b"PK\x05\x06";

/// First and last rows, numbered as in the sheet, and columns, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Merged {
    pub rows: [usize; 2],
    pub columns: [usize; 2],
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    pub name: String,
    /// Numbered as in the sheet. An error value such as `#REF!` stands in its cell.
    pub rows: Vec<Row>,
    pub merged: Vec<Merged>,
}

pub struct Workbook<'a> {
    archive: Archive<'a>,
    shared: Vec<String>,
    /// Names, and the parts of the archive that hold them.
    sheets: Vec<(String, String)>,
}

impl<'a> Workbook<'a> {
    pub fn open(bytes: &'a [u8]) -> Result<Self, String> {
        let archive = Archive::open(bytes)?;
        let shared = match archive.find("xl/sharedStrings.xml") {
            Some(entry) => shared_strings(&archive.text(entry)?)?,
            None => Vec::new(),
        };
        let sheets = archive.sheets()?;
        Ok(Self { archive, shared, sheets })
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.sheets.iter().map(|(name, _)| name.as_str())
    }

    pub fn sheet(&self, index: usize) -> Result<Sheet, String> {
        let none = || "an archive without a worksheet".to_owned();
        let (name, path) = self.sheets.get(index).ok_or_else(none)?;
        let text = self.archive.text(self.archive.find(path).ok_or_else(none)?)?;
        let document = parse(&text)?;
        let merged = document.descendants().filter(|node| node.has_tag_name_in("mergeCell"));
        let merged = merged.filter_map(|node| merged_cells(node.attribute("ref")?)).collect();
        Ok(Sheet { name: name.clone(), rows: rows(&document, &self.shared)?, merged })
    }
}

fn rows(document: &Document<'_>, shared: &[String]) -> Result<Vec<Row>, String> {
    let mut rows: Vec<Row> = Vec::new();
    for row in document.descendants().filter(|node| node.has_tag_name_in("row")) {
        let line = row.attribute("r").and_then(|r| r.parse().ok()).unwrap_or(rows.len() + 1);
        let mut cells = Vec::new();
        for cell in row.children().filter(|node| node.has_tag_name_in("c")) {
            let column = cell.attribute("r").map_or(cells.len(), column_of);
            if column >= MOST_COLUMNS {
                return Err(format!("row {line} with a cell in column {}", column + 1));
            }
            cells.resize(cells.len().max(column + 1), String::new());
            cells[column] = value(&cell, shared).map_err(|found| format!("{found} in row {line}"))?;
        }
        rows.push(Row { line, cells });
    }
    Ok(rows)
}

fn merged_cells(name: &str) -> Option<Merged> {
    let (first, last) = name.split_once(':')?;
    let row = |cell: &str| cell.trim_start_matches(|c: char| c.is_ascii_alphabetic()).parse::<usize>().ok();
    Some(Merged { rows: [row(first)?, row(last)?], columns: [first, last].map(column_of) })
}

/// Writes names such as `AB12`. Columns count from 0, rows from 1.
pub fn cell_name(column: usize, row: usize) -> String {
    let mut letters = Vec::new();
    let mut rest = column + 1;
    while rest > 0 {
        letters.push(b'A' + ((rest - 1) % 26) as u8);
        rest = (rest - 1) / 26;
    }
    let letters: String = letters.into_iter().rev().map(char::from).collect();
    format!("{letters}{row}")
}

pub fn is_error(cell: &str) -> bool {
    cell.starts_with('#') && (cell.ends_with(['!', '?']) || cell == "#N/A")
}

/// Ignores namespaces.
trait Named {
    fn has_tag_name_in(&self, name: &str) -> bool;
}

impl Named for Node<'_, '_> {
    fn has_tag_name_in(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

fn parse(text: &str) -> Result<Document<'_>, String> {
    Document::parse(text).map_err(|error| format!("a part that is no XML: {error}"))
}

/// Text without phonetic readings.
fn text_below(node: &Node<'_, '_>) -> String {
    let is_text = |inner: &Node<'_, '_>| {
        inner.has_tag_name_in("t") && !inner.ancestors().any(|above| above.has_tag_name_in("rPh"))
    };
    node.descendants().filter(is_text).filter_map(|inner| inner.text()).collect()
}

fn shared_strings(text: &str) -> Result<Vec<String>, String> {
    let document = parse(text)?;
    Ok(document.descendants().filter(|node| node.has_tag_name_in("si")).map(|node| text_below(&node)).collect())
}

fn column_of(name: &str) -> usize {
    let letters = name.bytes().take_while(u8::is_ascii_alphabetic).take(4);
    letters.fold(0, |index, letter| 26 * index + usize::from(letter.to_ascii_uppercase() - b'A') + 1).saturating_sub(1)
}

fn value(cell: &Node<'_, '_>, shared: &[String]) -> Result<String, String> {
    let own = cell.children().find(|node| node.has_tag_name_in("v")).and_then(|node| node.text()).unwrap_or_default();
    let text = match cell.attribute("t") {
        Some("s") => {
            let index = own.trim().parse::<usize>().ok();
            index.and_then(|index| shared.get(index)).cloned().ok_or_else(|| format!("shared text `{own}`"))?
        }
        Some("inlineStr") => text_below(cell),
        _ => own.to_owned(),
    };
    Ok(text.trim().to_owned())
}

#[derive(Clone, Debug)]
struct Entry {
    name: String,
    method: u16,
    packed: usize,
    offset: usize,
}

struct Archive<'a> {
    bytes: &'a [u8],
    entries: Vec<Entry>,
}

impl<'a> Archive<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self, String> {
        let cut = || "a ZIP archive that is cut off".to_owned();
        let end = bytes.windows(END.len()).rposition(|window| window == END).ok_or_else(cut)?;
        let count = number(bytes, end + 10, 2).ok_or_else(cut)?;
        let mut at = number(bytes, end + 16, 4).ok_or_else(cut)?;
        let mut entries = Vec::new();
        for _ in 0..count {
            if bytes.get(at..at + 4) != Some(&CENTRAL[..]) {
                return Err(cut());
            }
            let field = |offset: usize, size: usize| number(bytes, at + offset, size).ok_or_else(cut);
            if field(8, 2)? & 1 == 1 {
                return Err("an encrypted workbook".to_owned());
            }
            let length = field(28, 2)?;
            let name = bytes.get(at + 46..at + 46 + length).ok_or_else(cut)?;
            entries.push(Entry {
                name: String::from_utf8_lossy(name).into_owned(),
                method: field(10, 2)? as u16,
                packed: field(20, 4)?,
                offset: field(42, 4)?,
            });
            at += 46 + length + field(30, 2)? + field(32, 2)?;
        }
        Ok(Self { bytes, entries })
    }

    fn find(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name.eq_ignore_ascii_case(name))
    }

    /// In the order of the workbook. A sheet that is not in the archive is left out.
    fn sheets(&self) -> Result<Vec<(String, String)>, String> {
        let none = || "an archive without a worksheet".to_owned();
        let workbook = self.text(self.find("xl/workbook.xml").ok_or_else(none)?)?;
        let relations = self.text(self.find("xl/_rels/workbook.xml.rels").ok_or_else(none)?)?;
        let (document, relations) = (parse(&workbook)?, parse(&relations)?);
        let path_of = |sheet: &Node<'_, '_>| {
            let id =
                sheet.attributes().find(|attribute| attribute.name() == "id" && attribute.namespace().is_some())?;
            let target = relations.descendants().find(|node| node.attribute("Id") == Some(id.value()))?;
            let target = target.attribute("Target")?;
            let path = target.strip_prefix('/').map_or_else(|| format!("xl/{target}"), str::to_owned);
            self.find(&path).map(|entry| entry.name.clone())
        };
        let sheets = document.descendants().filter(|node| node.has_tag_name_in("sheet"));
        let sheets =
            sheets.filter_map(|sheet| Some((sheet.attribute("name").unwrap_or_default().to_owned(), path_of(&sheet)?)));
        Some(sheets.collect::<Vec<_>>()).filter(|sheets| !sheets.is_empty()).ok_or_else(none)
    }

    fn text(&self, entry: &Entry) -> Result<String, String> {
        let broken = |why: &str| format!("`{}`, which {why}", entry.name);
        let header = self.bytes.get(entry.offset..entry.offset.saturating_add(4));
        if header != Some(&LOCAL[..]) {
            return Err(broken("is not where the archive says"));
        }
        // The local header repeats name and extra field, in lengths that may differ.
        let field = |offset: usize| number(self.bytes, entry.offset + offset, 2).unwrap_or_default();
        let start = entry.offset + 30 + field(26) + field(28);
        let packed = self.bytes.get(start..start.saturating_add(entry.packed)).ok_or_else(|| broken("is cut off"))?;
        let mut unpacked = Vec::new();
        let read = match entry.method {
            0 => packed.take(MOST_UNPACKED).read_to_end(&mut unpacked),
            8 => DeflateDecoder::new(packed).take(MOST_UNPACKED).read_to_end(&mut unpacked),
            _ => return Err(broken("is packed in another way than deflate")),
        };
        read.map_err(|error| broken(&format!("does not unpack: {error}")))?;
        if unpacked.len() as u64 == MOST_UNPACKED {
            return Err(broken("is too large"));
        }
        String::from_utf8(unpacked).map_err(|_| broken("is no UTF-8"))
    }
}

/// Little-endian, of `size` bytes.
fn number(bytes: &[u8], at: usize, size: usize) -> Option<usize> {
    let field = bytes.get(at..at.checked_add(size)?)?;
    Some(field.iter().rev().fold(0, |value, &byte| value << 8 | usize::from(byte)))
}
