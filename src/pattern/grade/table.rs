//! Grade rule tables (`.rul`) [AAMA-292, ASTM D6673]: displacement of each numbered point in each size.
//!
//! ```text
//! UNITS: METRIC
//! GRADE RULE TABLE: TROUSERS
//! NUMBER OF SIZES: 3
//! SIZE LIST: 36 38 40
//! SAMPLE SIZE: 38
//! RULE: DELTA 1
//!   -10.00,  -5.00   0.00, 0.00   10.00, 5.00
//! END
//! ```
//!
//! A rule has one pair of x and y for each size, relative to the sample size, whose pair is zero. It may span several
//! lines.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::dxf::{D6673, Standard, Unit};
use geom::V2;
use geom::units::{from_mm, mm};

/// A large table has some hundred thousand.
const MOST_BYTES: usize = 8 << 20;
/// Greatest displacement by a rule.
const GREATEST_M: f64 = 2.0;
const ZERO_M: f64 = 1e-6;

/// Pairs of x and y.
const PAIRS_A_LINE: usize = 4;

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}{}: found {found}; accepted: {accepted}", line.map(|line| format!(", line {line}")).unwrap_or_default())]
pub struct GradeError {
    pub file: String,
    pub line: Option<usize>,
    pub found: String,
    pub accepted: String,
}

#[derive(Clone, Debug, PartialEq)]
pub struct GradeTable {
    pub file: String,
    pub sizes: Vec<String>,
    pub sample: usize,
    pub unit: Unit,
    /// Displacements relative to the sample size, m, one for each size.
    pub rules: BTreeMap<u32, Vec<V2>>,
}

/// Fails also where a rule occurs twice, lacks a pair for a size, or moves the sample size.
pub fn read(bytes: &[u8], file: &str) -> Result<GradeTable, GradeError> {
    let reader = Reader { file };
    if bytes.len() > MOST_BYTES {
        return Err(reader.error(None, format!("{} MB", bytes.len() >> 20), "a table of at most 8 MB"));
    }
    if bytes.contains(&0) {
        return Err(reader.error(Some(1), "a binary file".to_owned(), "a text file with RULE: DELTA"));
    }
    let text = String::from_utf8_lossy(bytes);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let text = if text.contains('\n') { Cow::from(text) } else { Cow::from(text.replace('\r', "\n")) };
    let mut head = Head::default();
    let mut rules: BTreeMap<u32, Rule> = BTreeMap::new();
    let mut open = Open::Head;
    for (index, line) in text.lines().enumerate().map(|(index, line)| (index + 1, line.trim())) {
        let key_value = line.split_once(':').map(|(key, value)| (key.trim().to_ascii_uppercase(), value.trim()));
        match key_value {
            _ if line.is_empty() => {}
            _ if line.eq_ignore_ascii_case("END") => open = Open::Nothing,
            Some((key, value)) if key == "RULE" => {
                let (number, steps) = reader.rule_number(index, value)?;
                let rule = Rule { line: index, numbers: reader.numbers(index, steps)? };
                if let Some(first) = rules.insert(number, rule) {
                    let found = format!("rule {number} again, first in line {}", first.line);
                    return Err(reader.error(Some(index), found, "each rule once"));
                }
                open = Open::Rule(number);
            }
            Some((key, value)) => {
                open = if key == "SIZE LIST" { Open::Sizes } else { Open::Head };
                head.take(&key, value, index);
            }
            None => match open {
                Open::Sizes => head.sizes.1.extend(line.split_whitespace().map(str::to_owned)),
                Open::Rule(number) => {
                    let numbers = reader.numbers(index, line)?;
                    rules.entry(number).and_modify(|rule| rule.numbers.extend(numbers));
                }
                Open::Head | Open::Nothing => {}
            },
        }
    }
    reader.table(head, rules)
}

pub fn named_in_pattern(name: &str) -> (String, String) {
    ("Grade Rule Table".to_owned(), name.to_owned())
}

pub fn is_name_of_table(key: &str) -> bool {
    key.eq_ignore_ascii_case("grade rule table")
}

/// Writer, program and date, alike for pattern and table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Imprint {
    /// `(key, value)`, such as `Author`.
    texts: Vec<(String, String)>,
}

/// In the order of genuine files.
const IMPRINT: [&str; 5] = ["Author", "Product", "Version", "Creation Date", "Creation Time"];

impl Imprint {
    /// Takes Toile's own name and version, and the date and time of the pattern. The clock is not asked, so that the
    /// same pattern makes the same bytes.
    pub fn of(pattern: &[(String, String)]) -> Self {
        let text = |key: &&str| match *key {
            "Author" | "Product" => Some("Toile".to_owned()),
            "Version" => Some(env!("CARGO_PKG_VERSION").to_owned()),
            dated => {
                let said = pattern.iter().find(|(known, _)| known.eq_ignore_ascii_case(dated));
                said.map(|(_, value)| value.trim().to_owned()).filter(|value| !value.is_empty())
            }
        };
        let texts = IMPRINT.iter().filter_map(|key| Some(((*key).to_owned(), text(key)?))).collect();
        Self { texts }
    }

    pub fn texts(&self) -> impl Iterator<Item = (String, String)> + '_ {
        self.texts.iter().cloned()
    }
}

/// Writes millimetres. `name` is the name by which the pattern file refers to the table.
pub fn write(table: &GradeTable, name: &str, imprint: &Imprint, standard: Standard) -> String {
    let first = match standard {
        Standard::Aama => "ANSI/AAMA VERSION: 1.0.0",
        Standard::Astm => D6673,
    };
    let plain = |text: &str| text.replace(char::is_control, " ");
    let mut text = format!("{first}\r\n");
    for (key, value) in &imprint.texts {
        let _ = write!(text, "{}: {}\r\n", key.to_uppercase(), plain(value));
    }
    text.push_str("UNITS: METRIC\r\n");
    let name = plain(name);
    let (sizes, count) = (table.sizes.join(" "), table.sizes.len());
    let _ = write!(text, "GRADE RULE TABLE: {name}\r\nNUMBER OF SIZES: {count}\r\nSIZE LIST: {sizes}\r\n");
    let _ = write!(text, "SAMPLE SIZE: {}\r\n", table.sizes[table.sample]);
    for (number, steps) in &table.rules {
        let _ = write!(text, "RULE: DELTA {number}\r\n");
        for line in steps.chunks(PAIRS_A_LINE) {
            let pair = |step: &V2| format!("{:.4}, {:.4}", mm(step.x) + 0.0, mm(step.y) + 0.0);
            let pairs: Vec<String> = line.iter().map(pair).collect();
            let _ = write!(text, "   {}\r\n", pairs.join("    ").replace("-0.0000", "0.0000"));
        }
    }
    text.push_str("END\r\n");
    text
}

/// Entry that a line without a key continues.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Open {
    Head,
    Sizes,
    Rule(u32),
    Nothing,
}

#[derive(Clone, Debug, Default)]
struct Head {
    unit: Option<(usize, String)>,
    count: Option<(usize, String)>,
    sizes: (usize, Vec<String>),
    sample: Option<(usize, String)>,
}

impl Head {
    fn take(&mut self, key: &str, value: &str, line: usize) {
        let entry = Some((line, value.to_owned()));
        match key {
            "UNITS" => self.unit = entry,
            "NUMBER OF SIZES" => self.count = entry,
            "SAMPLE SIZE" | "BASE SIZE" => self.sample = entry,
            "SIZE LIST" => self.sizes = (line, value.split_whitespace().map(str::to_owned).collect()),
            _ => {}
        }
    }
}

#[derive(Clone, Debug)]
struct Rule {
    line: usize,
    numbers: Vec<f64>,
}

struct Reader<'a> {
    file: &'a str,
}

impl Reader<'_> {
    fn error(&self, line: Option<usize>, found: String, accepted: &str) -> GradeError {
        GradeError { file: self.file.to_owned(), line, found, accepted: accepted.to_owned() }
    }

    /// Number, and the steps that follow it in the same line.
    fn rule_number<'v>(&self, line: usize, value: &'v str) -> Result<(u32, &'v str), GradeError> {
        let split =
            |text: &'v str| text.trim_start().split_once(char::is_whitespace).unwrap_or((text.trim_start(), ""));
        let (kind, rest) = split(value);
        let (number, steps) = split(rest);
        let number = number.parse().ok().filter(|_| kind.eq_ignore_ascii_case("DELTA"));
        let number =
            number.ok_or_else(|| self.error(Some(line), format!("RULE: {value}"), "RULE: DELTA and a number"))?;
        Ok((number, steps))
    }

    fn numbers(&self, line: usize, text: &str) -> Result<Vec<f64>, GradeError> {
        let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
        let number = |word: &str| match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.error(
                Some(line),
                format!("`{word}`"),
                "pairs of x and y with decimal points, such as -10.00, 5.00",
            )),
        };
        words.map(number).collect()
    }

    fn table(&self, head: Head, rules: BTreeMap<u32, Rule>) -> Result<GradeTable, GradeError> {
        if rules.is_empty() {
            let found = "no rule".to_owned();
            return Err(self.error(None, found, "a grade rule table with RULE: DELTA entries"));
        }
        let unit = match head.unit {
            Some((_, unit)) if unit.eq_ignore_ascii_case("METRIC") => Unit::Mm,
            Some((_, unit)) if unit.eq_ignore_ascii_case("ENGLISH") => Unit::In,
            Some((line, unit)) => {
                return Err(self.error(
                    Some(line),
                    format!("unit `{unit}`"),
                    "METRIC (millimetres) or ENGLISH (inches)",
                ));
            }
            None => return Err(self.error(None, "no unit".to_owned(), "UNITS: METRIC or UNITS: ENGLISH")),
        };
        let (sizes_line, sizes) = head.sizes;
        if let Some((line, count)) = head.count.filter(|(_, count)| count.parse() != Ok(sizes.len())) {
            let found = format!("{count} sizes, and a list of {} in line {sizes_line}", sizes.len());
            return Err(self.error(Some(line), found, "as many names without blanks as sizes"));
        }
        let Some((line, sample)) = head.sample else {
            return Err(self.error(None, "no sample size".to_owned(), "SAMPLE SIZE: one of the size list"));
        };
        let named: Vec<usize> = (0..sizes.len()).filter(|&k| sizes[k].eq_ignore_ascii_case(&sample)).collect();
        let &[sample] = named.as_slice() else {
            let found = format!("sample size `{sample}`, {} times in the size list", named.len());
            return Err(self.error(Some(line), found, &format!("one of {}", sizes.join(", "))));
        };
        let scale = from_mm(unit.mm_per_unit());
        let steps = rules
            .into_iter()
            .map(|(number, rule)| Ok((number, self.steps(number, &rule, scale, sizes.len(), sample)?)));
        let rules = steps.collect::<Result<_, GradeError>>()?;
        Ok(GradeTable { file: self.file.to_owned(), sizes, sample, unit, rules })
    }

    fn steps(&self, number: u32, rule: &Rule, scale: f64, sizes: usize, sample: usize) -> Result<Vec<V2>, GradeError> {
        if rule.numbers.len() != 2 * sizes {
            let found = format!("{} numbers in rule {number}", rule.numbers.len());
            return Err(self.error(
                Some(rule.line),
                found,
                &format!("{}: x and y for each of {sizes} sizes", 2 * sizes),
            ));
        }
        let steps: Vec<V2> = rule.numbers.chunks(2).map(|pair| V2::new(pair[0], pair[1]) * scale).collect();
        if steps[sample].norm() > ZERO_M {
            let found = format!("rule {number}, which moves the sample size");
            return Err(self.error(Some(rule.line), found, "steps from the sample size, whose own is zero"));
        }
        check_steps(self.file, Some(rule.line), number, &steps)?;
        Ok(steps)
    }
}

/// Refuses steps that are too long for a garment.
pub(super) fn check_steps(file: &str, line: Option<usize>, number: u32, steps: &[V2]) -> Result<(), GradeError> {
    let Some(step) = steps.iter().find(|step| step.norm() > GREATEST_M) else { return Ok(()) };
    let found = format!("a step of {:.1} m in rule {number}", step.norm());
    Err(GradeError { file: file.to_owned(), line, found, accepted: "steps of at most 2 m".to_owned() })
}
