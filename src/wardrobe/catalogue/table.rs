//! Entries of the catalogue from a CSV table: a column for each key, a row for each entry.

use std::collections::BTreeSet;
use std::path::Path;

use crate::catalogue::format::text_of;
use crate::catalogue::{Part, check_name};
use geom::units::significant;
use pattern::spec_sheet::number;
use pattern::table::{self, Row};
use spec::entry::{Entry, filled, keys};
use spec::file::Placed;
use spec::{Given, decimal};
use store::{Problem, nearest};

pub(super) struct Read<T> {
    pub entries: Vec<Placed<T>>,
    pub problems: Vec<Problem>,
}

/// Headings of a column with names of entries, besides the name of the part (`subject`).
const NAMES: [&str; 2] = ["name", "id"];
/// Columns of views that are not values of an entry.
const IGNORED: [&str; 7] = ["revision", "hash", "is_latest", "is_retired", "scan", "pose", "figure"];
/// Ignored columns that change a subject's body: a value in one prevents the import, for this reason.
const BODIES: [(&str, &str); 3] = [
    ("scan", "the scan's own file is imported"),
    ("pose", "a study says the poses of its subjects"),
    ("figure", "a study says the figures of its subjects"),
];

/// Empty cells are no values.
pub(super) fn read<T: Entry>(path: &Path, part: Part, bytes: &[u8]) -> Result<Read<T>, Vec<Problem>> {
    let mut rows = table::rows(text_of(path, bytes)?).into_iter();
    let head = rows.next().unwrap_or(Row { line: 1, cells: vec![] });
    let columns: Vec<Column> = head.cells.iter().map(|text| Column::read::<T>(part, text)).collect();
    let header: Vec<&str> = columns.iter().map(|column| column.key.as_str()).collect();
    let mut problems = header_problems::<T>(path, part, head.line, &header);
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut entries = Vec::new();
    let mut names = BTreeSet::new();
    for Row { line, cells } in rows {
        match row(part, &columns, &header, &cells) {
            Ok((name, _)) if !names.insert(name.clone()) => {
                problems.push(Problem::at(path, line, format!("{part} `{name}` is there twice; names must differ")));
            }
            Ok((name, entry)) => entries.push(Placed { file: path.to_owned(), line, name, entry }),
            Err(found) => problems.extend(found.into_iter().map(|message| Problem::at(path, line, message))),
        }
    }
    Ok(Read { entries, problems })
}

/// A column: its heading as a key, the key that its values are stored under, and the factor that converts its numbers to
/// the unit of that key.
struct Column {
    heading: String,
    key: String,
    factor: f64,
}

/// Units in headings: their names, the unit of keys to which they are converted, and the factor.
const UNITS: [(&str, &str, f64); 9] = [
    ("mm", "mm", 1.0),
    ("cm", "mm", 10.0),
    ("m", "mm", 1e3),
    ("in", "mm", 25.4),
    ("inch", "mm", 25.4),
    ("inches", "mm", 25.4),
    ("kg", "kg", 1.0),
    ("lb", "kg", 0.453_592_37),
    ("lbs", "kg", 0.453_592_37),
];

impl Column {
    /// Reads a heading: a key, or a key in words or in another unit, such as `Chest girth (cm)` or `chest_girth_cm`.
    fn read<T: Entry>(part: Part, heading: &str) -> Self {
        let accepted = keys::<T>();
        let unconverted = |key: &str| Self { heading: key.to_owned(), key: key.to_owned(), factor: 1.0 };
        if accepted.contains(&heading) || is_name(part, heading) {
            return unconverted(heading);
        }
        let words: String = heading.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { ' ' }).collect();
        let words: Vec<&str> = words.split_whitespace().collect();
        let plain = words.join("_");
        if accepted.contains(&plain.as_str()) || is_name(part, &plain) || IGNORED.contains(&plain.as_str()) {
            return unconverted(&plain);
        }
        let found = words.split_last().and_then(|(last, rest)| {
            let (_, unit, factor) = UNITS.iter().find(|(name, ..)| name == last)?;
            let key = format!("{}_{unit}", rest.join("_"));
            accepted.contains(&key.as_str()).then_some(Self { heading: plain.clone(), key, factor: *factor })
        });
        found.unwrap_or_else(|| unconverted(heading))
    }

    /// Value in the unit of the key. An error tells the number in the unit of the column.
    fn value<T: Entry>(&self, cell: &str) -> Result<String, String> {
        let mut fields = T::fields().iter().chain(T::sheets().iter().map(|sheet| &sheet.field));
        let Some(field) = fields.find(|field| field.key == self.key && self.factor != 1.0) else {
            return Ok(cell.to_owned());
        };
        let [least, most] = field.accepted().map(|end| significant(end / self.factor, 4));
        let accepted = format!("accepted: {least} to {most}");
        let number = self
            .number(cell)
            .ok_or_else(|| format!("`{}` is `{cell}`, which is no number; {accepted}", self.heading))?;
        match field.check(number * self.factor) {
            Ok(converted) => Ok(significant(converted, 9)),
            Err(_) => Err(format!("`{}` is {number}; {accepted}", self.heading)),
        }
    }

    /// Number of a cell: a decimal, or a length as inches are taken (`35 1/2`).
    fn number(&self, cell: &str) -> Option<f64> {
        decimal(cell).or_else(|| number::length(cell).filter(|read| read.unit.is_none()).map(|read| read.value))
    }
}

fn is_name(part: Part, column: &str) -> bool {
    column == part.as_str() || NAMES.contains(&column)
}

fn header_problems<T: Entry>(path: &Path, part: Part, line: usize, header: &[&str]) -> Vec<Problem> {
    let accepted = keys::<T>();
    let mut problems = Vec::new();
    if !header.iter().any(|column| is_name(part, column)) {
        problems.push(format!("no column `name`; accepted: name, {}", accepted.join(", ")));
    }
    for (k, &column) in header.iter().enumerate() {
        let place = format!("column {}", k + 1);
        if header[..k].contains(&column) {
            problems.push(format!("{place}: `{column}` is there twice"));
        } else if !(accepted.contains(&column) || is_name(part, column) || IGNORED.contains(&column)) {
            let hint = match nearest(column, accepted.iter().copied().chain(["name"])) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("accepted: name, {}", accepted.join(", ")),
            };
            problems.push(format!("{place}: unknown column `{column}`; {hint}"));
        }
    }
    problems.into_iter().map(|message| Problem::at(path, line, message)).collect()
}

fn row<T: Entry>(
    part: Part,
    columns: &[Column],
    header: &[&str],
    record: &[String],
) -> Result<(String, T), Vec<String>> {
    if record.len() != header.len() {
        return Err(vec![format!("{} cells; accepted: {}, as in the first line", record.len(), header.len())]);
    }
    let cells = || header.iter().copied().zip(record.iter().map(String::as_str));
    let name = cells().find(|(column, _)| is_name(part, column)).map_or("", |(_, cell)| cell);
    let (mut given, mut problems): (Vec<Given>, Vec<String>) = (Vec::new(), Vec::new());
    for (k, ((key, cell), column)) in cells().zip(columns).enumerate() {
        if cell.is_empty() || is_name(part, key) || IGNORED.contains(&key) {
            continue;
        }
        match column.value::<T>(cell) {
            Ok(value) => given.push((key.to_owned(), value)),
            Err(problem) => problems.push(format!("column {}: {problem}", k + 1)),
        }
    }
    let is_given = |(column, _): &&(&str, &str)| cells().any(|(name, cell)| name == *column && !cell.is_empty());
    if let Some((column, accepted)) = BODIES.iter().find(is_given) {
        return Err(vec![format!("{name}: its `{column}` is in no table; {accepted}")]);
    }
    let placed = |(key, problem): Given| match header.iter().position(|column| *column == key) {
        Some(k) => format!("column {}: {problem}", k + 1),
        None => problem,
    };
    check_name(name).map_err(|problem| vec![problem])?;
    if !problems.is_empty() {
        return Err(problems);
    }
    filled(None, name, &given)
        .map(|entry| (name.to_owned(), entry))
        .map_err(|problems| problems.into_iter().map(placed).collect())
}
