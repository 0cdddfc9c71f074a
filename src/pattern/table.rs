//! Tables as text (CSV), with line numbers, and with cells that no spreadsheet takes for formulas.
//!
//! A spreadsheet takes a text that begins with `=`, `+`, `-` or `@` for a formula. Such a text is written with an
//! apostrophe before it, which the readers of Toile remove.

use std::borrow::Cow;

use csv::{ReaderBuilder, Trim};

/// Possible column delimiters. The last one if none occurs.
const DELIMITERS: [char; 3] = [';', '\t', ','];
const FORMULA: [char; 4] = ['=', '+', '-', '@'];

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Line of the file at which the row begins, from 1.
    pub line: usize,
    /// Without spaces at their ends.
    pub cells: Vec<String>,
}

/// Drops the byte order mark of UTF-8 that some editors write.
pub fn unmarked(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Decodes UTF-8, without a byte order mark. The error is the line of the first byte that is not UTF-8.
pub fn text(bytes: &[u8]) -> Result<&str, usize> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let mut lines = Lines::default();
        lines.to(bytes, error.valid_up_to())
    })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// Takes commas, semicolons or tabs, and any kind of line end. Leaves out rows without text. Rows may differ in their
/// number of cells.
pub fn rows(text: &str) -> Vec<Row> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .delimiter(delimiter(text))
        .flexible(true)
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let mut lines = Lines::default();
    let mut rows = Vec::new();
    // Cannot fail: the text is in memory, and rows may have any length.
    for record in reader.records().map_while(Result::ok) {
        let from = record.position().map_or(0, |position| position.byte() as usize);
        // The CSV reader counts the line ends before a record as part of it.
        let ends = text[from..].bytes().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
        let line = lines.to(text.as_bytes(), from + ends);
        let cells: Vec<String> = record.iter().map(|cell| unguarded(cell).to_owned()).collect();
        if cells.iter().any(|cell| !cell.is_empty()) {
            rows.push(Row { line, cells });
        }
    }
    rows
}

/// Most frequent delimiter in the first line with text, outside of quotes.
fn delimiter(text: &str) -> u8 {
    let head = text.split(['\r', '\n']).find(|line| !line.trim().is_empty()).unwrap_or_default();
    let count = |mark: &char| head.split('"').step_by(2).map(|plain| plain.matches(*mark).count()).sum::<usize>();
    DELIMITERS.into_iter().max_by_key(count).map_or(b',', |mark| mark as u8)
}

/// Lines that end in LF, CR LF or CR.
#[derive(Default)]
struct Lines {
    at: usize,
    ended: usize,
}

impl Lines {
    /// Line number of a byte, from 1. Successive calls must not go backwards.
    fn to(&mut self, bytes: &[u8], at: usize) -> usize {
        while self.at < at {
            let is_end = match bytes[self.at] {
                b'\r' => bytes.get(self.at + 1) != Some(&b'\n'),
                byte => byte == b'\n',
            };
            self.ended += usize::from(is_end);
            self.at += 1;
        }
        1 + self.ended
    }
}

/// Keeps spreadsheets from taking a cell for a formula.
pub fn guarded(text: &str) -> Cow<'_, str> {
    let is_plain = !begins_as_formula(text.trim_start_matches('\'')) || is_number(text);
    if is_plain { text.into() } else { format!("'{text}").into() }
}

/// Reverses [`guarded`].
fn unguarded(cell: &str) -> &str {
    let text = cell.strip_prefix('\'').filter(|text| begins_as_formula(text.trim_start_matches('\'')));
    text.unwrap_or(cell)
}

fn begins_as_formula(text: &str) -> bool {
    let text = text.trim();
    // A single character is no formula.
    text.starts_with(FORMULA) && text.chars().nth(1).is_some()
}

fn is_number(text: &str) -> bool {
    text.parse::<f64>().is_ok() && !text.contains(|sign: char| sign.is_alphabetic() && !matches!(sign, 'e' | 'E'))
}

/// Line of CSV. Cells with commas, quotes or line ends are quoted.
pub fn line<'a>(cells: impl Iterator<Item = Cow<'a, str>>) -> String {
    let quoted = |cell: Cow<'a, str>| {
        let needs = cell.contains(['"', ',', '\n', '\r']);
        if needs { format!("\"{}\"", cell.replace('"', "\"\"")).into() } else { cell }
    };
    let line = cells.map(quoted).collect::<Vec<_>>().join(",");
    // An empty line would not be read as a row.
    if line.is_empty() { "\"\"\n".to_owned() } else { line + "\n" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_know_their_lines_whatever_these_end_in() {
        let check = |lines: &str, expect: &[(usize, &[&str])]| {
            for end in ["\n", "\r\n", "\r"] {
                for last in ["", end] {
                    let table = lines.replace('\n', end) + last;
                    let found = rows(&table);
                    let found: Vec<(usize, Vec<&str>)> =
                        found.iter().map(|row| (row.line, row.cells.iter().map(String::as_str).collect())).collect();
                    let expect: Vec<(usize, Vec<String>)> = expect
                        .iter()
                        .map(|(line, cells)| (*line, cells.iter().map(|cell| cell.replace('\n', end)).collect()))
                        .collect();
                    assert_eq!(format!("{found:?}"), format!("{expect:?}"), "{table:?}");
                }
            }
        };
        check("a,b\n1,2\n3,4", &[(1, &["a", "b"]), (2, &["1", "2"]), (3, &["3", "4"])]);
        check("a,b\n\n1,2\n\n\n3,4", &[(1, &["a", "b"]), (3, &["1", "2"]), (6, &["3", "4"])]);
        check("\n\na;b\n1;2", &[(3, &["a", "b"]), (4, &["1", "2"])]);
        check("a,b\n , \n,\n1,2", &[(1, &["a", "b"]), (4, &["1", "2"])]);
        check(
            "a,b\n\"1\n\n1\",2\n3,\"4\n4\"\n5,6",
            &[(1, &["a", "b"]), (2, &["1\n\n1", "2"]), (5, &["3", "4\n4"]), (7, &["5", "6"])],
        );
        check("\"a, b\"\tc\n1\t2", &[(1, &["a, b", "c"]), (2, &["1", "2"])]);
        check("a,b\n1\n1,2,3", &[(1, &["a", "b"]), (2, &["1"]), (3, &["1", "2", "3"])]);
        check("a", &[(1, &["a"])]);
        check("", &[]);
    }

    #[test]
    fn bytes_are_text_from_their_mark_on() {
        let check = |bytes: &[u8], expect: Result<&str, usize>| assert_eq!(text(bytes), expect);
        check(b"\xef\xbb\xbfa,b\n", Ok("a,b\n"));
        check(b"a,b\r\n1,2\r\n\xff,2", Err(3));
        check(b"a,b\r1,2\r\xff,2", Err(3));
    }

    #[test]
    fn no_spreadsheet_computes_a_text_and_no_reader_sees_it_changed() {
        let check = |text: &str, cell: &str| {
            assert_eq!(guarded(text), cell, "{text}");
            let table =
                line([Cow::from("a"), Cow::from("b")].into_iter()) + &line([cell.into(), "x".into()].into_iter());
            assert_eq!(rows(&table)[1].cells, [text, "x"], "{text}");
        };
        for same in
            ["", "a", "-", "+", "'", "'a", "12", "-5", "+30.0", "-1.5e-3", "a=b", "上衣", "a\nb", "a,\"b\"", "'-"]
        {
            check(same, same);
        }
        check("=1+2", "'=1+2");
        check("+30.0 +30.0", "'+30.0 +30.0");
        check("-left", "'-left");
        check("-inf", "'-inf");
        check("@SUM(1,2)", "'@SUM(1,2)");
        check("'=1", "''=1");
        check("''=1", "'''=1");
        assert_eq!(line([Cow::from("")].into_iter()), "\"\"\n");
        assert_eq!(guarded(" =1"), "' =1");
    }
}
