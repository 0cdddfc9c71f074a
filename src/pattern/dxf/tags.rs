//! The tag stream of a DXF file: pairs of a group code line and a value line, with line numbers.

use super::DxfError;

/// A nest of 15 sizes has some megabytes.
pub const MOST_BYTES: usize = 64 << 20;
/// Each takes some 100 bytes of memory.
const MOST_TAGS: usize = 5_000_000;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tag<'a> {
    pub code: i32,
    /// Without its line end.
    pub value: &'a [u8],
    /// Line of the value, from 1.
    pub line: usize,
}

impl Tag<'_> {
    /// Trimmed. Only ASCII is decoded.
    pub fn keyword(&self) -> &str {
        std::str::from_utf8(self.value.trim_ascii()).unwrap_or("")
    }

    /// True for group code 0 with this value.
    pub fn begins(&self, keyword: &str) -> bool {
        self.code == 0 && self.keyword() == keyword
    }
}

/// Types of [DXF reference, group code value types].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueType {
    Real,
    /// Lower and upper bound.
    Integer(i64, i64),
    /// Also handles and binary chunks.
    Text,
    Undefined,
}

pub fn value_type(code: i32) -> ValueType {
    match code {
        10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => ValueType::Real,
        60..=79 | 170..=179 | 270..=299 | 370..=389 | 400..=409 | 1060..=1070 => {
            ValueType::Integer(i64::from(i16::MIN), i64::from(i16::MAX))
        }
        90..=99 | 420..=429 | 440..=459 | 1071 => ValueType::Integer(i64::from(i32::MIN), i64::from(i32::MAX)),
        160..=169 => ValueType::Integer(i64::MIN, i64::MAX),
        0..=9 | 100..=102 | 105 | 300..=369 | 390..=399 | 410..=419 | 430..=439 | 470..=481 | 999..=1009 => {
            ValueType::Text
        }
        _ => ValueType::Undefined,
    }
}

/// Reads up to and including `0/EOF`.
pub fn scan<'a>(bytes: &'a [u8], file: &str) -> Result<Vec<Tag<'a>>, DxfError> {
    let fail = |line: Option<usize>, found: String, accepted: &str| Err(DxfError::new(file, line, found, accepted));
    if bytes.trim_ascii().is_empty() {
        return fail(None, "an empty file".to_owned(), "a text DXF file");
    }
    if bytes.len() > MOST_BYTES {
        let found = format!("{:.0} MB", bytes.len() as f64 * 1e-6);
        return fail(None, found, &format!("a file of at most {} MB", MOST_BYTES / 1_000_000));
    }
    if let Some(kind) = binary_kind(bytes) {
        return fail(Some(1), kind.to_owned(), "a text (ASCII) DXF file; export it as such");
    }
    let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let mut lines = text.split(|&byte| byte == b'\n').map(|line| line.strip_suffix(b"\r").unwrap_or(line)).enumerate();
    let mut tags = Vec::new();
    let mut last_line = 0;
    while let Some((index, code_line)) = lines.next() {
        let code_text = String::from_utf8_lossy(code_line.trim_ascii()).into_owned();
        let Ok(code) = code_text.parse::<i32>() else {
            if tags.is_empty() {
                return fail(Some(index + 1), format!("`{}`: this is not DXF", clipped(&code_text)), "a text DXF file");
            }
            if code_text.is_empty() && lines.clone().all(|(_, line)| line.trim_ascii().is_empty()) {
                break;
            }
            return fail(
                Some(index + 1),
                format!("`{}` for a group code", clipped(&code_text)),
                "an integer on every second line",
            );
        };
        let Some((value_index, value)) = lines.next() else {
            return fail(
                Some(index + 1),
                format!("the file ends after group code {code}"),
                "a whole DXF file, ending in 0/EOF",
            );
        };
        let tag = Tag { code, value, line: value_index + 1 };
        last_line = tag.line;
        tags.push(tag);
        if tags.len() > MOST_TAGS {
            let found = format!("more than {MOST_TAGS} group codes");
            return fail(Some(last_line), found, "a file of fewer");
        }
        if tag.begins("EOF") {
            return Ok(tags);
        }
    }
    fail(
        Some(last_line),
        "the file ends without 0/EOF: it is truncated".to_owned(),
        "a whole DXF file, ending in 0/EOF",
    )
}

/// `None` for text.
fn binary_kind(bytes: &[u8]) -> Option<&'static str> {
    let known: [(&[u8], &str); 8] = [
        (b"AutoCAD Binary DXF", "a binary DXF file"),
        (b"AutoCAD DXB", "a binary file (DXB)"),
        (b"AC10", "a binary file (DWG)"),
        (b"\x89PNG", "a binary file (a PNG picture)"),
        (b"\xff\xd8\xff", "a binary file (a JPEG picture)"),
        (b"PK\x03\x04", "a binary file (a ZIP archive)"),
        (b"\xff\xfe", "a binary file (text in UTF-16)"),
        (b"\xfe\xff", "a binary file (text in UTF-16)"),
    ];
    let kind = known.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, kind)| *kind);
    kind.or_else(|| bytes.contains(&0).then_some("a binary file"))
}

pub fn clipped(text: &str) -> String {
    let mut short: String = text.chars().take(40).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
