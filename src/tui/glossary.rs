//! Explanations of the numbers on screens, from `docs/glossary.md` and, for points of measure, `docs/fit.md`: program
//! and readers share one text.

use std::sync::LazyLock;

const GLOSSARY: &str = include_str!("../../docs/glossary.md");
const FIT: &str = include_str!("../../docs/fit.md");

/// Meaning of a name, from a line of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Term {
    /// Names of the term, the main one first; then headings of screens and columns of SQL.
    pub names: Vec<String>,
    /// Unit; empty for a term that is no number.
    pub unit: String,
    /// Definition, and method of measurement.
    pub about: String,
    /// Values that are good or bad; empty where none are.
    pub good: String,
    /// Document that says more; empty without one.
    pub more: String,
}

impl Term {
    pub fn name(&self) -> &str {
        &self.names[0]
    }

    /// True if names or texts contain a text, which must be in lower case.
    pub fn contains(&self, text: &str) -> bool {
        self.names.iter().chain([&self.about]).any(|words| words.to_lowercase().contains(text))
    }
}

/// All terms, in the order of the documents.
pub static TERMS: LazyLock<Vec<Term>> = LazyLock::new(|| {
    let mut terms = terms_of(GLOSSARY);
    let points = FIT.split("\n## ").find(|part| part.starts_with("Points of measure")).unwrap_or_default();
    for mut point in points.lines().filter_map(point_of) {
        // Some levels of the body have the names of points; the glossary's own term counts.
        point.names.retain(|name| !terms.iter().any(|term| term.names.contains(name)));
        terms.extend(Some(point).filter(|point| !point.names.is_empty()));
    }
    terms
});

/// Term of a name; without one, the term of the part before a comma, as in `mean gap, chest`.
pub fn term(name: &str) -> Option<&'static Term> {
    let known = |name: &str| TERMS.iter().find(|term| term.names.iter().any(|known| known == name));
    known(name).or_else(|| known(name.split_once(',')?.0))
}

/// Cells of a table line whose first cell has names between backquotes.
fn cells(line: &str) -> Option<Vec<&str>> {
    let row = line.strip_prefix("| `")?.strip_suffix('|')?;
    Some(row.split('|').map(str::trim).collect())
}

/// Takes a line between heading and table as naming the document that tells more of all rows.
fn terms_of(glossary: &str) -> Vec<Term> {
    let mut more = String::new();
    let mut terms = vec![];
    for line in glossary.lines() {
        if line.starts_with("More: [") {
            more = linked(line);
        }
        terms.extend(term_of(line, &more));
    }
    terms
}

/// Document that the first link of a text leads to.
fn linked(text: &str) -> String {
    let file = text.split_once('(').and_then(|(_, rest)| rest.split_once(')'));
    file.map_or_else(String::new, |(file, _)| format!("docs/{file}"))
}

/// Prefers a link at the end of the term's words to that of its table.
fn term_of(line: &str, more: &str) -> Option<Term> {
    let (names, unit, about, good) = match cells(line)?[..] {
        [names, unit, about] => (names, unit, about, ""),
        [names, unit, about, good] => (names, unit, about, good),
        _ => return None,
    };
    let names = names.split("`, `").map(|name| name.trim_matches('`').to_owned()).collect();
    let (about, more) =
        about.split_once(" [More]").map_or_else(|| (about, more.to_owned()), |(about, link)| (about, linked(link)));
    let plain = |text: &str| text.replace('`', "");
    Some(Term { names, unit: unit.to_owned(), about: plain(about), good: plain(good), more })
}

/// Reads a term from a line of the table of points of measure.
fn point_of(line: &str) -> Option<Term> {
    let [point, measured] = cells(line)?.try_into().ok()?;
    let point = point.trim_matches('`');
    let about = format!("A point of measure: {measured}.");
    let mut names = vec![point.replace('_', " "), point.to_owned()];
    names.dedup();
    Some(Term { names, unit: "mm".to_owned(), about, good: String::new(), more: "docs/fit.md".to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use spec::{FABRIC_NUMBERS, MEASUREMENTS};

    #[test]
    fn every_line_of_the_tables_is_a_term_and_no_name_is_two() {
        let lines = GLOSSARY.lines().filter(|line| line.starts_with("| `")).count();
        assert_eq!(terms_of(GLOSSARY).len(), lines, "each has three or four cells");
        let mut names: Vec<&str> = TERMS.iter().flat_map(|term| &term.names).map(String::as_str).collect();
        let all = names.len();
        names.sort_unstable();
        for pair in names.windows(2) {
            assert_ne!(pair[0], pair[1], "of {all} names");
        }
    }

    #[test]
    fn terms_are_found_by_any_name() {
        let check = |name: &str, expect: Option<&str>| assert_eq!(term(name).map(Term::name), expect, "{name}");
        check("L2D mm", Some("L2D"));
        check("penetration_max_mm", Some("in body"));
        check("mean gap, upper arm", Some("gap"));
        check("half chest", Some("half chest"));
        check("half_chest", Some("half chest"));
        check("bending rigidity, warp", Some("bending rigidity, warp"));
        check("no such thing", None);
        let more = |name| term(name).map(|term| (term.more.as_str(), term.about.ends_with('.')));
        assert_eq!(more("chi"), Some(("docs/drapes.md", true)));
        assert_eq!(more("EI"), Some(("docs/evidence.md", true)));
    }

    #[test]
    fn every_number_of_subjects_and_fabrics_has_a_term() {
        let measurements = MEASUREMENTS.iter().map(|field| (field.key, field.label));
        let label = |label: &'static str| label.split_once(" [").map_or(label, |(name, _)| name);
        let fabrics = FABRIC_NUMBERS.iter().map(|field| (field.key, label(field.label)));
        for (key, label) in measurements.chain(fabrics) {
            assert!(term(key).is_some(), "{key}");
            assert!(term(label).is_some(), "{label}");
        }
    }

    #[test]
    fn documents_that_tell_more_are_there() {
        for term in TERMS.iter().filter(|term| !term.more.is_empty()) {
            let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(&term.more);
            assert!(file.is_file(), "{} of {}", term.more, term.name());
        }
    }
}
