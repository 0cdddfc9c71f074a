//! Lines of a DXF file with changed values and added lines. All else stays byte for byte.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::dxf::tags::Tag;
use crate::dxf::units::Unit;

/// Least decimals of a coordinate in millimetres: a hundredth of what scissors follow.
const LEAST_DECIMALS_MM: usize = 3;
/// More are the rounding of binary numbers.
const MOST_DECIMALS: usize = 12;
/// Group codes that number a record or its owner. A copy has none: each number occurs once in a file.
const NUMBERS: [i32; 3] = [5, 105, 330];

#[derive(Clone, Copy, Debug, PartialEq)]
struct Form {
    decimals: usize,
    /// True if zeros at the end are left out.
    is_trimmed: bool,
}

impl Form {
    /// Takes the most decimals of any number, and at least [`LEAST_DECIMALS_MM`] in millimetres.
    fn of(tags: &[Tag<'_>], unit: Unit) -> Self {
        let decimals = |tag: &Tag<'_>| {
            let text = tag.keyword();
            let is_plain = !text.contains(['e', 'E']);
            is_plain.then(|| text.split_once('.').map_or(0, |(_, decimals)| decimals.len()))
        };
        let begins = |tag: &Tag<'_>| tag.code == 2 && matches!(tag.keyword(), "BLOCKS" | "ENTITIES");
        let drawn = tags.iter().skip_while(|tag| !begins(tag));
        let counts = || drawn.clone().filter(|tag| matches!(tag.code, 10 | 11 | 20 | 21)).filter_map(decimals);
        let most = counts().max().unwrap_or(0);
        // A file that leaves zeros out has numbers of fewer decimals. Some write a whole number as `0` or `0.0`.
        let is_trimmed = counts().any(|count| count > 1 && count < most);
        let least = LEAST_DECIMALS_MM + unit.mm_per_unit().log10().ceil() as usize;
        Self { decimals: most.clamp(least, MOST_DECIMALS), is_trimmed }
    }

    fn text(self, value: f64) -> String {
        let mut text = format!("{value:.*}", self.decimals);
        if self.is_trimmed {
            let kept = text.trim_end_matches('0').len();
            text.truncate(if text[..kept].ends_with('.') { kept + 1 } else { kept });
        }
        if text.strip_prefix('-').is_some_and(|rest| rest.bytes().all(|byte| matches!(byte, b'0' | b'.'))) {
            text.remove(0);
        }
        text
    }
}

/// A DXF file with changes.
pub struct Sheet<'a> {
    pub tags: Vec<Tag<'a>>,
    lines: Vec<&'a [u8]>,
    form: Form,
    /// By the line of the file from 0.
    values: BTreeMap<usize, String>,
    /// By the line of the file after which they stand.
    added: BTreeMap<usize, Vec<u8>>,
}

impl<'a> Sheet<'a> {
    pub fn new(bytes: &'a [u8], tags: Vec<Tag<'a>>, unit: Unit) -> Self {
        let lines = bytes.split_inclusive(|&byte| byte == b'\n').collect();
        let form = Form::of(&tags, unit);
        Self { tags, lines, form, values: BTreeMap::new(), added: BTreeMap::new() }
    }

    /// In the unit of the file. 0 for what is no number.
    pub fn number(&self, tag: usize) -> f64 {
        self.tags[tag].keyword().parse().unwrap_or(0.0)
    }

    pub fn rounded(&self, value: f64) -> f64 {
        self.form.text(value).parse().unwrap_or(value)
    }

    /// Changes a number, unless it stays the same in the decimals of the file.
    pub fn set(&mut self, tag: usize, value: f64) {
        let half = 0.5 * 0.1_f64.powi(self.form.decimals as i32);
        if (value - self.number(tag)).abs() >= half {
            self.values.insert(self.tags[tag].line - 1, self.form.text(value));
        }
    }

    pub fn set_count(&mut self, tag: usize, count: usize) {
        self.values.insert(self.tags[tag].line - 1, count.to_string());
    }

    /// Adds a copy of some tags after `after`, with some numbers changed. Handles and what `is_left_out` are not
    /// copied.
    pub fn copy(
        &mut self,
        tags: Range<usize>,
        numbers: &[(usize, f64)],
        is_left_out: impl Fn(i32) -> bool,
        after: usize,
    ) {
        let mut copy = Vec::new();
        for tag in tags {
            let Tag { code, line, .. } = self.tags[tag];
            if NUMBERS.contains(&code) || is_left_out(code) {
                continue;
            }
            copy.extend_from_slice(self.lines[line - 2]);
            match numbers.iter().find(|(of, _)| *of == tag) {
                Some((_, value)) => copy.extend(replaced(self.lines[line - 1], &self.form.text(*value))),
                None => copy.extend_from_slice(self.lines[line - 1]),
            }
        }
        self.added.entry(self.tags[after].line - 1).or_default().extend(copy);
    }

    /// Adds a record at a place, in the unit of the file, after the tag `after`.
    pub fn add_point(&mut self, kind: &str, layer: &str, [x, y]: [f64; 2], after: usize) {
        let line = self.lines[self.tags[after].line - 1];
        let end = if line.ends_with(b"\r\n") { "\r\n" } else { "\n" };
        let [x, y] = [x, y].map(|value| self.form.text(value));
        let text = [("  0", kind), ("  8", layer), (" 10", &x), (" 20", &y)];
        let text: String = text.iter().map(|(code, value)| format!("{code}{end}{value}{end}")).collect();
        self.added.entry(self.tags[after].line - 1).or_default().extend(text.into_bytes());
    }

    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (number, line) in self.lines.iter().enumerate() {
            match self.values.get(&number) {
                Some(text) => bytes.extend(replaced(line, text)),
                None => bytes.extend_from_slice(line),
            }
            bytes.extend(self.added.get(&number).into_iter().flatten());
        }
        bytes
    }
}

/// Keeps the blanks and the end of the line.
fn replaced(line: &[u8], value: &str) -> Vec<u8> {
    let after = line.trim_ascii_start();
    let before = &line[..line.len() - after.len()];
    [before, value.as_bytes(), &after[after.trim_ascii_end().len()..]].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dxf::tags::scan;

    #[test]
    fn numbers_have_the_decimals_of_the_file() {
        let check = |numbers: &[&str], unit: Unit, expect: &str| {
            let tags: String = numbers.iter().map(|number| format!("10\n{number}\n")).collect();
            let tags = format!("10\n0.00000\n0\nSECTION\n2\nBLOCKS\n{tags}0\nEOF\n");
            let form = Form::of(&scan(tags.as_bytes(), "x").expect("tags"), unit);
            let texts: Vec<String> = [12.5, -0.000_000_000_000_1, 1.0 / 3.0].map(|value| form.text(value)).to_vec();
            assert_eq!(texts.join(" "), expect, "{numbers:?}");
        };
        check(&["0", "1.5"], Unit::Mm, "12.500 0.000 0.333");
        check(&["0.0000", "1.5000"], Unit::Mm, "12.5000 0.0000 0.3333");
        check(&["0.0", "1.25", "1.1234", "1.5e-17"], Unit::Mm, "12.5 0.0 0.3333");
        check(&["0.123"], Unit::In, "12.50000 0.00000 0.33333");
        check(&["0.123"], Unit::Cm, "12.5000 0.0000 0.3333");
        check(&["0.123"], Unit::M, "12.500000 0.000000 0.333333");
    }

    #[test]
    fn all_but_the_changed_value_stays_as_it_was() {
        let bytes = b"\xEF\xBB\xBF999\r\nA file\r\n  2\r\nBLOCKS\r\n  0\r\nPOINT\r\n  5\r\n2A\r\n 10\r\n   1.0000 \r\n 20\r\n2.0000\r\n  0\r\nEOF\r\n\x1A";
        let tags = scan(bytes, "x").expect("tags");
        let mut sheet = Sheet::new(bytes, tags, Unit::Mm);
        assert_eq!(sheet.bytes(), bytes);
        sheet.set(5, 2.000_04);
        sheet.set(4, 7.25);
        sheet.copy(2..6, &[(4, 9.0)], |_| false, 5);
        let text = String::from_utf8_lossy(&sheet.bytes()).into_owned();
        let expect = "\u{feff}999\r\nA file\r\n  2\r\nBLOCKS\r\n  0\r\nPOINT\r\n  5\r\n2A\r\n 10\r\n   7.2500 \r\n 20\r\n2.0000\r\n\
            \x20 0\r\nPOINT\r\n 10\r\n   9.0000 \r\n 20\r\n2.0000\r\n  0\r\nEOF\r\n\x1A";
        assert_eq!(text, expect);
    }
}
