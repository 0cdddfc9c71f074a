//! Keys of results: a changed key of a study file is another key of its results, or one that no result depends on.
//!
//! The keys are those of docs/reference.md, which `reference` holds to the program: a new one fails here until it has a row.

use std::collections::{BTreeMap, BTreeSet};

use super::readers::Readers;
use super::reference::{Row, page, study_headings};

/// A study with a value at most of its keys.
const BASE: &str = r#"
name = "tops"
simulators = ["fem", "hybrid"]
[fit]
tight_below_mm = 40
[[subject]]
id = "ii"
like = "male-ii"
[[subject]]
id = "x"
sex = "female"
stature_mm = 1650
[[garment]]
name = "a"
seams = "patterns/tshirt.seams.toml"
fabric = "own"
sizes = [{ name = "S", pattern = "patterns/tshirt-s.dxf" }, { name = "M", pattern = "patterns/tshirt-m.dxf" }]
[[garment]]
name = "b"
seams = "patterns/tshirt.seams.toml"
fabric = "poplin"
sizes = [{ name = "S", pattern = "patterns/tshirt-s.dxf" }]
[[fabric]]
name = "own"
density_kg_m2 = 0.1
thickness_mm = 0.3
membrane_warp_n_m = 3000
membrane_weft_n_m = 2000
membrane_coupling_n_m = 10
shear_n_m = 90
bending_warp_nm = 5e-6
bending_weft_nm = 4e-6
friction_body = 0.3
friction_self = 0.5
"#;

/// Effect of a changed key.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Is {
    /// Other keys of results, or other results.
    Input,
    /// The same keys: nothing of a result depends on it.
    Label,
}
use Is::{Input, Label};

/// A change of the study by hand: heading and key of the page, text that is replaced, text in its place.
type Change = (&'static str, &'static str, &'static str, &'static str, Is);

const TOP: &str = "Top of the study file";
const TWO_LAYERS: &str = "[[outfit]]\nname = \"o\"\nlayers = [\"a\", \"b\"]\n";

/// The first of the garments, and the end of its table.
const A: &str = "name = \"a\"\n";

const BY_HAND: [Change; 45] = [
    (TOP, "name", "name = \"tops\"", "name = \"other\"", Label),
    (TOP, "simulators", "[\"fem\", \"hybrid\"]", "[\"fem\"]", Input),
    (TOP, "edge_length_mm", "name = \"tops\"", "edge_length_mm = 20", Input),
    (TOP, "repeats", "name = \"tops\"", "repeats = 2", Input),
    (TOP, "fit", "[fit]\ntight_below_mm = 40\n", "", Label),
    (TOP, "time_limit_s", "name = \"tops\"", "time_limit_s = 20", Label),
    (TOP, "memory_limit_mb", "name = \"tops\"", "memory_limit_mb = 2000", Label),
    (TOP, "subject", "[[subject]]\nid = \"x\"\nsex = \"female\"\nstature_mm = 1650\n", "", Input),
    (
        TOP,
        "garment",
        "[[garment]]\nname = \"b\"",
        "[[garment]]\nname = \"c\"\nseams = \"patterns/tshirt.seams.toml\"\nfabric = \"own\"\nedge_length_mm = 20\nsizes = [{ name = \"S\", pattern = \"patterns/tshirt-s.dxf\" }]\n[[garment]]\nname = \"b\"",
        Input,
    ),
    (TOP, "outfit", "[[fabric]]", "[[outfit]]\nname = \"o\"\nlayers = [\"a\", \"b\"]\n[[fabric]]", Input),
    (TOP, "fabric", "density_kg_m2 = 0.1", "density_kg_m2 = 0.2", Input),
    (TOP, "parameters", "[fit]", "[parameters]\nfem.seed = 3\n[fit]", Input),
    (TOP, "sweep", "[[fabric]]", "[[sweep]]\nedge_length_mm = [20, 30]\n[[fabric]]", Input),
    ("[fit]", "tight_below_mm", "tight_below_mm = 40", "tight_below_mm = 45", Label),
    ("[fit]", "loose_above_mm", "[fit]", "[fit]\nloose_above_mm = 120", Label),
    ("[[subject]]", "id", "id = \"x\"", "id = \"z\"", Input),
    ("[[subject]]", "like", "male-ii", "male-v", Input),
    ("[[subject]]", "pose", "id = \"x\"", "id = \"x\"\npose = \"arms_30\"", Input),
    ("[[subject]]", "poses", "id = \"x\"", "id = \"x\"\nposes = [\"arms_30\"]", Input),
    ("[[subject]]", "carried_from", "id = \"x\"", "id = \"x\"\npose = \"arms_30\"\ncarried_from = \"arms_20\"", Input),
    ("[[subject]]", "figure", "id = \"x\"", "id = \"x\"\nfigure = [\"flat_seat\"]", Input),
    ("[[subject]]", "sex", "sex = \"female\"", "sex = \"male\"", Input),
    ("[[garment]]", "name", A, "name = \"other\"\n", Label),
    ("[[garment]]", "style", A, "name = \"a\"\nstyle = \"other\"\n", Label),
    ("[[garment]]", "seams", "tshirt.seams.toml", "other.seams.toml", Input),
    ("[[garment]]", "sizes", ", { name = \"M\", pattern = \"patterns/tshirt-m.dxf\" }", "", Input),
    ("[[garment]]", "unit", A, "name = \"a\"\nunit = \"mm\"\n", Input),
    ("[[garment]]", "fabric", "fabric = \"own\"", "fabric = \"interlock_tshirt\"", Input),
    ("[[garment]]", "subjects", A, "name = \"a\"\nsubjects = [\"x\"]\n", Input),
    ("[[garment]]", "edge_length_mm", A, "name = \"a\"\nedge_length_mm = 20\n", Input),
    ("[[garment]]", "parameters", A, "name = \"a\"\nparameters = { fem.seed = 3 }\n", Input),
    ("[[garment]]", "intended_fit", A, "name = \"a\"\nintended_fit = \"slim\"\n", Label),
    ("[[garment]]", "target_ease_mm", A, "name = \"a\"\ntarget_ease_mm = { chest = [10, 20] }\n", Label),
    ("[[garment]]", "priority", A, "name = \"a\"\npriority = 3\n", Label),
    ("[[garment]]", "after", "name = \"b\"", "name = \"b\"\nafter = [\"a\"]", Label),
    ("[[garment]]", "time_limit_s", A, "name = \"a\"\ntime_limit_s = 20\n", Label),
    ("[[garment]]", "memory_limit_mb", A, "name = \"a\"\nmemory_limit_mb = 2000\n", Label),
    ("sizes of a garment", "name", "name = \"M\"", "name = \"L\"", Input),
    ("sizes of a garment", "pattern", "tshirt-m.dxf", "tshirt-l.dxf", Input),
    ("[[fabric]]", "source", "density_kg_m2", "source = \"a book\"\ndensity_kg_m2", Label),
    (
        "[[sweep]]",
        "garments",
        "[[fabric]]",
        "[[sweep]]\nedge_length_mm = [20, 30]\ngarments = [\"a\"]\n[[fabric]]",
        Input,
    ),
    ("[[sweep]]", "fabric", "[[fabric]]", "[[sweep]]\nfabric = [\"own\", \"interlock_tshirt\"]\n[[fabric]]", Input),
    ("[[sweep]]", "fabric.NUMBER", "[[fabric]]", "[[sweep]]\nfabric.shear_n_m = [80, 100]\n[[fabric]]", Input),
    ("[[sweep]]", "edge_length_mm", "[[fabric]]", "[[sweep]]\nedge_length_mm = [20, 30]\n[[fabric]]", Input),
    ("[[sweep]]", "garments", "[[fabric]]", "[[sweep]]\nedge_length_mm = [20]\ngarments = [\"b\"]\n[[fabric]]", Input),
];

/// Changes of somebody whose scan lies beside the study.
const OF_SCAN: [Change; 2] = [
    ("[[subject]]", "scan", "y.obj", "z.obj", Input),
    ("[[subject]]", "unit", "scan = \"y.obj\"", "scan = \"y.obj\"\nunit = \"m\"", Input),
];

/// Changes of an outfit, which stands beside the garments.
const OF_OUTFIT: [Change; 4] = [
    ("[[outfit]]", "name", "name = \"o\"", "name = \"p\"", Input),
    ("[[outfit]]", "layers", "[\"a\", \"b\"]", "[\"b\", \"a\"]", Input),
    ("[[outfit]]", "sizes", "name = \"o\"", "name = \"o\"\nsizes = [\"M\", \"S\"]", Input),
    ("[[outfit]]", "subjects", "name = \"o\"", "name = \"o\"\nsubjects = [\"x\"]", Input),
];

/// Studies held against each other by the keys of their results.
struct Bench {
    readers: Readers,
    /// Keys of the page that were changed, by their heading.
    seen: BTreeMap<String, BTreeSet<String>>,
}

impl Bench {
    /// Hashes of the inputs of all jobs of a study.
    fn hashes(&mut self, study: &str) -> BTreeSet<String> {
        self.readers.plan(study).into_iter().map(|job| job.inputs.hash()).collect()
    }

    /// Changes one key of a study.
    fn check(&mut self, [heading, key]: [&str; 2], before: &BTreeSet<String>, study: &str, is: Is) {
        let found = if self.hashes(study) == *before { Label } else { Input };
        assert_eq!(found, is, "{heading} {key}:\n{study}");
        self.seen.entry(heading.to_owned()).or_default().insert(key.to_owned());
    }
}

/// A text with one place of it replaced.
fn edited(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "no {from}");
    text.replacen(from, to, 1)
}

/// Least and greatest number of a row.
fn range(row: &Row) -> Option<[f64; 2]> {
    let (least, most) = row.cells[1].strip_prefix("number ")?.split_once(" to ")?;
    Some([least.parse().ok()?, most.parse().ok()?])
}

/// A value that is not the default one.
fn other_value(row: &Row) -> String {
    let words = row.cells[1].split('`').skip(1).step_by(2);
    let default = row.cells[2].trim_matches('`');
    match row.cells[1].split([' ', ':']).next() {
        Some("true") => (default != "true").to_string(),
        Some("text") => format!("{:?}", words.into_iter().find(|word| *word != default).expect("two words")),
        Some("list") => "[1]".to_owned(),
        Some("whole") => "7".to_owned(),
        _ => "0.123".to_owned(),
    }
}

#[test]
fn a_changed_key_is_another_result_or_no_input() {
    let (mut bench, page) = (Bench { readers: Readers::new(), seen: BTreeMap::new() }, page());
    let other_seams = [&bench.readers.read("patterns/tshirt.seams.toml")[..], b"# other\n"].concat();
    bench.readers.write("patterns/other.seams.toml", other_seams);
    bench.readers.write_scan("y.obj", 1.7);
    bench.readers.write_scan("z.obj", 1.8);
    let outfit = format!("{BASE}{TWO_LAYERS}");
    let scanned = edited(BASE, "like = \"male-ii\"", "scan = \"y.obj\"\nsex = \"male\"");
    for (study, changes) in [(BASE, &BY_HAND[..]), (&outfit, &OF_OUTFIT[..]), (&scanned, &OF_SCAN[..])] {
        let before = bench.hashes(study);
        for &(heading, key, from, to, is) in changes {
            bench.check([heading, key], &before, &edited(study, from, to), is);
        }
    }

    let base = bench.hashes(BASE);
    bench.check(["[[fabric]]", "name"], &base, &BASE.replace("\"own\"", "\"other\""), Input);
    let rows = |heading: &str| page[heading].iter().flat_map(|row| row.keys.iter().map(move |key| (key.as_str(), row)));
    for (key, row) in rows("[[subject]]") {
        let Some([least, most]) = range(row) else { continue };
        let line = format!("{key} = {}", 0.5 * (least + most));
        let line = if key == "stature_mm" { line } else { format!("stature_mm = 1650\n{line}") };
        bench.check(["[[subject]]", key], &base, &edited(BASE, "stature_mm = 1650", &line), Input);
    }
    // The numbers of a stretched knit go together.
    let knit = BASE.to_owned() + "stretch_pct = 20\nstretched_warp_n_m = 50\nstretched_weft_n_m = 40\n";
    let knitted = bench.hashes(&knit);
    for (key, row) in rows("[[fabric]]") {
        let Some([least, most]) = range(row) else { continue };
        let line = knit.lines().find(|line| line.starts_with(&format!("{key} = "))).expect("a number of the cloth");
        let study = edited(&knit, line, &format!("{key} = {:e}", (least.max(1e-6) * most).sqrt()));
        bench.check(["[[fabric]]", key], &knitted, &study, Input);
    }
    for (key, row) in rows("[[fabric]] from a laboratory") {
        let [least, most] = range(row).expect("a number");
        let stands_for = row.keys.iter().zip(row.cells[2].split(", ")).find(|(one, _)| *one == key);
        let number = stands_for.expect("a number for each").1.trim_matches('`');
        let line = BASE.lines().find(|line| line.starts_with(number)).expect("a number");
        let study = edited(BASE, line, &format!("{key} = {:e}", (least * most).sqrt()));
        bench.check(["[[fabric]] from a laboratory", key], &base, &study, Input);
    }
    for heading in ["[parameters] of FEM-GS", "[parameters] of Hybrid-GS"] {
        for (key, row) in rows(heading) {
            let study = edited(BASE, "[fit]", &format!("[parameters]\n{key} = {}\n[fit]", other_value(row)));
            bench.check([heading, key], &base, &study, Input);
        }
    }
    for (level, _) in rows("target_ease_mm of a garment") {
        let study = edited(BASE, A, &format!("{A}target_ease_mm = {{ {level} = [10, 20] }}\n"));
        bench.check(["target_ease_mm of a garment", level], &base, &study, Label);
    }
    for heading in study_headings().chain(["[[sweep]]"]) {
        let all: BTreeSet<String> = rows(heading).map(|(key, _)| key.to_owned()).collect();
        assert_eq!(bench.seen.get(heading), Some(&all), "{heading}");
    }
}

#[test]
fn every_byte_of_a_seam_file_and_a_pattern_is_an_input() {
    let one_size = edited(BASE, ", { name = \"M\", pattern = \"patterns/tshirt-m.dxf\" }", "");
    let mut bench = Bench { readers: Readers::new(), seen: BTreeMap::new() };
    let before = bench.hashes(&one_size);
    for (file, end) in [("patterns/tshirt.seams.toml", "# x\n"), ("patterns/tshirt-s.dxf", "999\r\nx\r\n")] {
        let as_it_was = bench.readers.read(file);
        bench.readers.write(file, [&as_it_was[..], end.as_bytes()].concat());
        assert!(before.is_disjoint(&bench.hashes(&one_size)), "{file}");
        bench.readers.write(file, as_it_was);
    }
    assert_eq!(bench.hashes(&one_size), before);
}
