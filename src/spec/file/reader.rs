//! A reader of TOML that collects all problems, each with its line, the finding and the accepted values.

use std::collections::BTreeSet;
use std::ops::{Range, RangeInclusive};
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::file::Placed;
use store::{Problem, nearest};

/// Reader of one file with the problems found so far.
pub(super) struct Reader<'a> {
    path: &'a Path,
    text: &'a str,
    /// Positions of the line feeds, in bytes, ascending.
    ends: Vec<usize>,
    pub problems: Vec<Problem>,
    /// Entries of the catalogue that were removed but stay stored, such as `subject male-ii`.
    pub hidden: BTreeSet<String>,
}

/// A table of the file, with a name for messages.
#[derive(Clone)]
pub(super) struct Place<'t> {
    /// Name such as `[fit]` or `subject ii`.
    pub name: String,
    /// Span in the text, bytes.
    pub span: Range<usize>,
    pub table: &'t DeTable<'t>,
}

impl<'a> Reader<'a> {
    pub fn new(path: &'a Path, text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(position, _)| position).collect();
        Self { path, text, ends, problems: Vec::new(), hidden: BTreeSet::new() }
    }

    pub fn problem(&mut self, span: &Range<usize>, message: impl Into<String>) {
        let column = self.before(span).rsplit(|&byte| byte == b'\n').next().map_or(1, |line| {
            1 + line.iter().filter(|&&byte| byte & 0xc0 != 0x80).count() // bytes that begin a character
        });
        let problem = Problem::at(self.path, self.line(span), message);
        self.problems.push(Problem { column: Some(column), ..problem });
    }

    /// Line where a span begins, from 1.
    pub fn line(&self, span: &Range<usize>) -> usize {
        1 + self.ends.partition_point(|end| *end < span.start)
    }

    pub fn placed<T>(&self, span: &Range<usize>, name: &str, entry: T) -> Placed<T> {
        Placed { file: self.path.to_owned(), line: self.line(span), name: name.to_owned(), entry }
    }

    fn before(&self, span: &Range<usize>) -> &'a [u8] {
        &self.text.as_bytes()[..span.start.min(self.text.len())]
    }

    /// Ends reading: returns the value, or all problems.
    pub fn end<T>(mut self, read: T) -> Result<T, Vec<Problem>> {
        self.problems.sort_by_key(|problem| problem.line);
        if self.problems.is_empty() { Ok(read) } else { Err(self.problems) }
    }

    pub fn only(&mut self, place: &Place<'_>, accepted: &[&str]) {
        for key in place.table.keys() {
            let name = key.get_ref();
            if accepted.contains(&name.as_ref()) {
                continue;
            }
            let hint = match nearest(name, accepted.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("accepted: {}", accepted.join(", ")),
            };
            self.problem(&key.span(), format!("{}: unknown key `{name}`; {hint}", place.name));
        }
    }

    fn mistyped(&mut self, place: &Place<'_>, key: &str, value: &Spanned<DeValue<'_>>, wanted: &str) {
        let found = value.get_ref().type_str();
        self.problem(&value.span(), format!("{}: `{key}` must be {wanted}, found {found}", place.name));
    }

    pub fn missing(&mut self, place: &Place<'_>, key: &str, wanted: &str) {
        self.problem(&place.span.clone(), format!("{}: `{key}` is missing; give {wanted}", place.name));
    }

    /// Optional text; a value of another type is a problem.
    pub fn text<'t>(&mut self, place: &Place<'t>, key: &str) -> Option<Spanned<&'t str>> {
        let value = place.table.get(key)?;
        let Some(text) = value.get_ref().as_str() else {
            self.mistyped(place, key, value, "text in quotes");
            return None;
        };
        Some(Spanned::new(value.span(), text))
    }

    pub fn need_text<'t>(&mut self, place: &Place<'t>, key: &str, wanted: &str) -> Option<Spanned<&'t str>> {
        if !place.table.contains_key(key) {
            self.missing(place, key, wanted);
        }
        self.text(place, key)
    }

    pub fn number(&mut self, place: &Place<'_>, key: &str, range: RangeInclusive<f64>) -> Option<f64> {
        self.checked(place, key, |number| {
            let accepted = || format!("`{key}` is {number}; accepted: {} to {}", range.start(), range.end());
            if range.contains(&number) { Ok(number) } else { Err(accepted()) }
        })
    }

    pub fn checked(
        &mut self,
        place: &Place<'_>,
        key: &str,
        check: impl FnOnce(f64) -> Result<f64, String>,
    ) -> Option<f64> {
        let value = place.table.get(key)?;
        let number = match value.get_ref() {
            DeValue::Integer(digits) => i64::from_str_radix(digits.as_str(), digits.radix()).ok().map(|n| n as f64),
            DeValue::Float(digits) => digits.as_str().parse().ok(),
            _ => {
                self.mistyped(place, key, value, "a number");
                return None;
            }
        };
        // A number that its type cannot hold is outside of every range.
        let accepted = check(number.unwrap_or(f64::INFINITY));
        accepted.map_err(|problem| self.problem(&value.span(), format!("{}: {problem}", place.name))).ok()
    }

    /// Tables of `[[key]]`, or of a list of inline tables.
    pub fn tables<'t>(&mut self, place: &Place<'t>, key: &str, what: &str) -> Vec<Place<'t>> {
        let Some(value) = place.table.get(key) else { return Vec::new() };
        let Some(list) = value.get_ref().as_array() else {
            self.mistyped(place, key, value, "a list of tables");
            return Vec::new();
        };
        let mut tables = Vec::new();
        for (index, item) in list.iter().enumerate() {
            match item.get_ref().as_table() {
                Some(table) => tables.push(Place { name: format!("{what} {}", index + 1), span: item.span(), table }),
                None => self.mistyped(place, key, item, "a list of tables"),
            }
        }
        tables
    }

    pub fn texts<'t>(&mut self, place: &Place<'t>, key: &str) -> Option<Vec<Spanned<&'t str>>> {
        let value = place.table.get(key)?;
        let Some(list) = value.get_ref().as_array() else {
            self.mistyped(place, key, value, "a list of texts");
            return None;
        };
        let mut texts = Vec::new();
        for item in list.iter() {
            match item.get_ref().as_str() {
                Some(text) => texts.push(Spanned::new(item.span(), text)),
                None => self.mistyped(place, key, item, "a list of texts"),
            }
        }
        Some(texts)
    }
}
