//! The reference page lists what the program takes: no key more, none less. What the readers refuse a nonsense with tells
//! what they accept.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use toile::fit::Cuts;
use toile::sim::{fem, hybrid};

use super::readers::{Readers, seam_file};
use super::tree::{files, root, text, within};

/// A name that nothing has.
const NONSENSE: &str = "zzzzzz";

/// A value that no key has.
const DATE: &str = "1979-05-27";

/// A row of a table of the page.
pub struct Row {
    /// Words between backquotes in its first cell.
    pub keys: Vec<String>,
    /// Its cells: key, value, default, meaning.
    pub cells: Vec<String>,
}

/// Words between backquotes.
fn quoted(text: &str) -> Vec<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Rows of the page by the heading they stand under.
pub fn page() -> BTreeMap<String, Vec<Row>> {
    let mut found: BTreeMap<String, Vec<Row>> = BTreeMap::new();
    let mut heading = String::new();
    for line in text(&root().join("docs/reference.md")).lines() {
        if line.starts_with('#') {
            heading = line.trim_start_matches('#').trim().replace('`', "");
        } else if let Some(row) = line.strip_prefix("| ").and_then(|row| row.strip_suffix('|')) {
            let cells: Vec<String> = row.split('|').map(|cell| cell.trim().to_owned()).collect();
            found.entry(heading.clone()).or_default().push(Row { keys: quoted(&cells[0]), cells });
        }
    }
    // The first row of a table is its head.
    found.values_mut().for_each(|rows| drop(rows.remove(0)));
    found
}

/// A table of a file, and how to ask its reader.
struct Section {
    headings: &'static [&'static str],
    /// Beginnings of files that end within the table; what a reader reads of it may depend on them.
    beginnings: &'static [&'static str],
}

/// A study file up to an outfit with its layers.
const TWO_LAYERS: &str = r#"
[[subject]]
id = "ii"
like = "male-ii"
[[garment]]
name = "a"
seams = "patterns/tshirt.seams.toml"
fabric = "poplin"
sizes = [{ name = "S", pattern = "patterns/tshirt-s.dxf" }]
[[garment]]
name = "b"
seams = "patterns/tshirt.seams.toml"
fabric = "poplin"
sizes = [{ name = "S", pattern = "patterns/tshirt-s.dxf" }]
[[outfit]]
name = "o"
layers = ["a", "b"] # the inner first
"#;

/// Sections of the study file.
const STUDY: [Section; 9] = [
    Section { headings: &["Top of the study file"], beginnings: &[""] },
    Section { headings: &["[fit]"], beginnings: &["[fit]\n"] },
    Section {
        headings: &["[[subject]]"],
        beginnings: &["[[subject]]\n", "[[subject]]\nid = \"a\"\n", "[[subject]]\nid = \"a\"\nscan = \"a.ply\"\n"],
    },
    Section { headings: &["[[garment]]"], beginnings: &["[[garment]]\n"] },
    Section { headings: &["sizes of a garment"], beginnings: &["[[garment]]\n[[garment.sizes]]\n"] },
    Section { headings: &["target_ease_mm of a garment"], beginnings: &["[[garment]]\n[garment.target_ease_mm]\n"] },
    Section { headings: &["[[outfit]]"], beginnings: &["[[outfit]]\n", "[[outfit]]\nname = \"o\"\n", TWO_LAYERS] },
    Section {
        headings: &["[[fabric]]", "[[fabric]] from a laboratory"],
        beginnings: &["[[fabric]]\n", "[[fabric]]\nname = \"f\"\n"],
    },
    Section { headings: &["[parameters] of FEM-GS", "[parameters] of Hybrid-GS"], beginnings: &["[parameters]\n"] },
];

/// Headings of the study file's tables.
pub fn study_headings() -> impl Iterator<Item = &'static str> {
    STUDY.iter().flat_map(|section| section.headings).copied()
}

/// Sections of the seam file.
const SEAMS: [Section; 6] = [
    Section { headings: &["Top of the seam file"], beginnings: &["name = \"a\"\n"] },
    Section { headings: &["[piece.NAME]"], beginnings: &["[piece.a]\n"] },
    Section { headings: &["[[seam]]"], beginnings: &["[[seam]]\n"] },
    Section { headings: &["[[measurement]]"], beginnings: &["[[measurement]]\n"] },
    Section { headings: &["[[reinforce]]"], beginnings: &["[[reinforce]]\n"] },
    Section { headings: &["[fit.LEVEL]"], beginnings: &["[fit.a]\n"] },
];

impl Section {
    fn rows<'p>(&self, page: &'p BTreeMap<String, Vec<Row>>) -> Vec<&'p Row> {
        let rows = |heading: &&str| page.get(*heading).unwrap_or_else(|| panic!("no table under {heading}"));
        self.headings.iter().flat_map(rows).collect()
    }

    /// What the reader of study files says where rows of the section have a value, over all beginnings.
    fn told(&self, readers: &Readers, rows: &[&Row], value: &str) -> Vec<String> {
        let keys = || rows.iter().flat_map(|row| &row.keys);
        let file = |beginning: &&str| {
            let last = beginning.rsplit("]\n").next().unwrap_or_default();
            let is_there = |key: &str| last.lines().any(|line| line.starts_with(&format!("{key} =")));
            let lines = keys().filter(|key| !is_there(key)).map(|key| format!("{key} = {value}\n"));
            format!("{beginning}{}", lines.collect::<String>())
        };
        self.beginnings.iter().flat_map(|beginning| readers.study(&file(beginning))).collect()
    }
}

/// What a refusal says that there is: behind `accepted` or `there are`, or between backquotes behind `expected`.
fn accepted(told: &str) -> BTreeSet<String> {
    if let Some((_, list)) = told.split_once("expected ") {
        return quoted(list).into_iter().collect();
    }
    let list = ["accepted: ", "there are: "].iter().find_map(|mark| Some(told.split_once(mark)?.1));
    list.into_iter()
        .flat_map(|list| list.split(';').next())
        .flat_map(|list| list.split(", "))
        .map(str::to_owned)
        .collect()
}

fn naming<'t>(told: &'t [String], name: &str) -> impl Iterator<Item = &'t String> {
    let name = format!("`{name}`");
    told.iter().filter(move |problem| problem.contains(&name))
}

#[test]
fn every_key_is_in_the_reference() {
    let (readers, page) = (Readers::new(), page());
    let check = |section: &Section, told: &[String]| {
        let keys: BTreeSet<String> = section.rows(&page).iter().flat_map(|row| row.keys.clone()).collect();
        let refusal = naming(told, NONSENSE).next().unwrap_or_else(|| panic!("{:?}: {told:?}", section.headings));
        assert_eq!(keys, accepted(refusal), "{:?}", section.headings);
    };
    for section in &STUDY {
        check(section, &readers.study(&format!("{}{NONSENSE} = [1, 2]\n", section.beginnings[0])));
    }
    for section in &SEAMS {
        check(section, &Vec::from_iter(seam_file(&format!("{}{NONSENSE} = 1\n", section.beginnings[0]))));
    }
}

#[test]
fn what_may_be_swept_is_in_the_reference() {
    let (readers, page) = (Readers::new(), page());
    let told = readers.study(&format!("[[sweep]]\n{NONSENSE} = [1]\n"));
    let (parameters, others) = naming(&told, NONSENSE).next().expect("refused").split_once("; also: ").expect("others");
    let keys = |headings: &'static [&'static str]| {
        let rows = Section { headings, beginnings: &[] }.rows(&page);
        rows.iter().flat_map(|row| row.keys.clone()).collect::<BTreeSet<String>>()
    };
    assert_eq!(accepted(parameters), keys(STUDY[8].headings));
    let others: BTreeSet<String> = others.split(", ").chain(["garments"]).map(str::to_owned).collect();
    assert_eq!(keys(&["[[sweep]]"]), others);
    let told = readers.study(&format!("[[sweep]]\nfabric.{NONSENSE} = [1]\n"));
    let numbers = accepted(naming(&told, NONSENSE).next().expect("refused")).into_iter();
    assert_eq!(keys(&["[[fabric]]"]), numbers.chain(["name", "source"].map(str::to_owned)).collect());
}

/// Types as the page calls them, and as the readers do.
const TYPES: [[&str; 2]; 10] = [
    ["texts", "a list of texts"],
    ["text", "text in quotes"],
    ["tables", "a list of tables"],
    ["table", "table"],
    ["number", "a number"],
    ["two numbers", "least and greatest"],
    ["whole number", "a whole number"],
    ["true or false", "true or false"],
    ["list of whole numbers", "a list of whole numbers"],
    ["list of numbers", "a list of values"],
];

#[test]
fn values_of_a_study_file_are_those_of_the_reference() {
    let (readers, page) = (Readers::new(), page());
    for section in &STUDY {
        let rows = section.rows(&page);
        let [mistyped, too_great] = [DATE, "1e12"].map(|value| section.told(&readers, &rows, value));
        for (key, row) in rows.iter().flat_map(|row| row.keys.iter().map(move |key| (key, row))) {
            let value = &row.cells[1];
            let [_, wanted] =
                TYPES.iter().find(|[name, _]| value.starts_with(name)).unwrap_or_else(|| panic!("{value}"));
            // A word may be any text: which ones there are is looked at below.
            let is_told = |problem: &String| problem.contains(wanted) || problem.contains("unknown variant");
            assert!(naming(&mistyped, key).any(is_told), "{key}: {value}: {mistyped:#?}");
            if let Some((least, most)) = value.strip_prefix("number ").and_then(|range| range.split_once(" to ")) {
                let range = |text: &str| text.parse::<f64>().expect("a number");
                let is_told = |problem: &String| {
                    let told = problem.split_once("accepted: ").and_then(|(_, range)| range.split_once(" to "));
                    told.is_some_and(|(a, b)| [range(a), range(b)] == [range(least), range(most)])
                };
                assert!(naming(&too_great, key).any(is_told), "{key}: {value}: {too_great:#?}");
            }
        }
    }
}

#[test]
fn words_that_a_key_may_have_are_those_of_the_reference() {
    let (readers, page) = (Readers::new(), page());
    let check = |row: &Row, told: &[String]| {
        let words: BTreeSet<String> = quoted(&row.cells[1]).into_iter().collect();
        let mut refused = naming(told, NONSENSE).filter(|problem| !problem.contains("no parameter"));
        assert_eq!(
            accepted(refused.next().unwrap_or_else(|| panic!("{:?}: {told:?}", row.keys))),
            words,
            "{:?}",
            row.keys
        );
    };
    let with_words = |section: &Section| {
        let has_words = |row: &&Row| row.cells[1].starts_with("text") && row.cells[1].contains('`');
        section.rows(&page).into_iter().filter(has_words).collect::<Vec<_>>()
    };
    for section in &STUDY {
        for row in with_words(section) {
            let word = format!("\"{NONSENSE}\"");
            let value = if row.cells[1].starts_with("texts") { format!("[{word}]") } else { word };
            // Some messages have the value as TOML.
            let told = section.told(&readers, &[row], &value);
            let [toml, named] = ['"', '`'].map(|quote| format!("{quote}{NONSENSE}{quote}"));
            let told: Vec<String> = told.iter().map(|problem| problem.replace(&toml, &named)).collect();
            check(row, &told);
        }
    }
    for section in &SEAMS {
        for row in with_words(section) {
            let file = format!("{}{} = \"{NONSENSE}\"\n", section.beginnings[0], row.keys[0]);
            check(row, &Vec::from_iter(seam_file(&file)));
        }
    }
}

#[test]
fn what_a_study_file_needs_is_what_the_reference_says() {
    let (readers, page) = (Readers::new(), page());
    for section in &STUDY {
        let told = section.told(&readers, &[], "");
        let rows = section.rows(&page);
        let is_required = |row: &&&Row| row.cells[2].starts_with("required");
        let required: BTreeSet<&String> = rows.iter().filter(is_required).flat_map(|row| &row.keys).collect();
        let missing = |key: &&String| told.iter().any(|problem| problem.contains(&format!("`{key}` is missing")));
        let needed: BTreeSet<&String> = rows.iter().flat_map(|row| &row.keys).filter(missing).collect();
        assert_eq!(required, needed, "{:?}", section.headings);
    }
}

/// Numbers and words of a tree of parameters by their names in a study file, with its units.
fn leaves(name: &str, tree: &Value, found: &mut BTreeMap<String, Value>) {
    let Some(fields) = tree.as_object() else {
        let (name, per_si) =
            match (name.strip_suffix("_rad"), name.strip_suffix("_m").filter(|stem| !stem.ends_with("_n"))) {
                (Some(stem), _) => (format!("{stem}_deg"), 1f64.to_degrees()),
                (_, Some(stem)) => (format!("{stem}_mm"), 1e3),
                _ => (name.to_owned(), 1.0),
            };
        let value = if tree.is_f64() { tree.as_f64().map(|number| number * per_si).into() } else { tree.clone() };
        found.insert(name, value);
        return;
    };
    fields.iter().for_each(|(field, tree)| leaves(&format!("{name}.{field}"), tree, found));
}

#[test]
fn defaults_are_those_of_the_reference() {
    let page = page();
    let mut defaults = BTreeMap::new();
    leaves("fem", &serde_json::to_value(fem::Params::default()).expect("plain"), &mut defaults);
    leaves("hybrid", &serde_json::to_value(hybrid::Params::default()).expect("plain"), &mut defaults);
    let cuts = Cuts::default();
    defaults.insert("tight_below_mm".into(), (1e3 * cuts.tight_below_m).into());
    defaults.insert("loose_above_mm".into(), (1e3 * cuts.loose_above_m).into());
    let sections = [&STUDY[1], &STUDY[8]];
    let rows: Vec<&Row> = sections.iter().flat_map(|section| section.rows(&page)).collect();
    assert_eq!(rows.len(), defaults.len());
    for row in rows {
        let (key, told) = (&row.keys[0], row.cells[2].trim_matches('`'));
        let is_so = match &defaults[key] {
            Value::Null => told == "none",
            Value::String(word) => told == word,
            Value::Number(number) => {
                let (number, told) = (number.as_f64().expect("finite"), told.parse::<f64>().expect("a number"));
                (number - told).abs() <= 1e-9 * number.abs()
            }
            other => serde_json::from_str::<Value>(told).is_ok_and(|told| told == *other),
        };
        assert!(is_so, "{key}: {told}, not {}", defaults[key]);
    }
}

#[test]
fn every_exit_code_is_in_the_reference() {
    let source = text(&root().join("src/cli/lib.rs"));
    let parsed = syn::parse_file(&source).expect("it compiles");
    let ends = parsed.items.into_iter().find_map(|item| match item {
        syn::Item::Enum(one) if one.ident == "End" => Some(one.variants),
        _ => None,
    });
    let code = |variant: syn::Variant| match variant.discriminant {
        Some((_, syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(code), .. }))) => code.to_string(),
        _ => panic!("{} has no number", variant.ident),
    };
    let codes: Vec<String> = ends.expect("the enum of exit codes").into_iter().map(code).collect();
    let told: Vec<String> = page()["Exit codes"].iter().map(|row| row.cells[0].clone()).collect();
    assert_eq!(told, codes);
}

/// What stands before the name of a variable where a source file reads it.
const READS: [&str; 8] = ["env(\"", "var(\"", "var_os(\"", "named(\"", "set(\"", "is_set(\"", "is(\"", "env = \""];

#[test]
fn every_environment_variable_is_in_the_reference() {
    let is_test = |path: &str| path.contains("/tests") || path.ends_with("_tests.rs");
    let mut read = BTreeSet::new();
    for path in files(&root().join("src"), &["rs"]).iter().filter(|path| !is_test(&within(path))) {
        let source = text(path);
        for names in READS.iter().flat_map(|before| source.split(before).skip(1)) {
            let name = names.split('"').next().unwrap_or_default();
            let is_variable = !name.is_empty() && name.chars().all(|c| c.is_ascii_uppercase() || c == '_');
            read.extend(is_variable.then(|| name.to_owned()));
        }
    }
    let told: BTreeSet<String> = page()["Environment variables"].iter().flat_map(|row| row.keys.clone()).collect();
    assert_eq!(told, read);
}
