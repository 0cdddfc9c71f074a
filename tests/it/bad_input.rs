//! Files that cannot be used: refused with file, line and what was found, before anything is written.

use super::program::Place;

/// Name of the file that is spoilt.
const FILE: &str = "patterns/tshirt-m.dxf";

/// A way to spoil a pattern, and what must be said of it.
struct Case {
    what: &'static str,
    spoil: fn(&str) -> Vec<u8>,
    /// A value whose line is to be named; the refusal names some line where this is `None`.
    at: Option<&'static str>,
    found: &'static str,
}

/// The y of the V-neck's lowest point in size M, as the draft writes it.
const NECK: &str = "\r\n560.7600\r\n";

const CASES: [Case; 7] = [
    Case { what: "truncated", spoil: |text| text[..text.len() / 2].into(), at: None, found: "truncated" },
    Case { what: "empty", spoil: |_| Vec::new(), at: None, found: "empty" },
    Case { what: "binary", spoil: |_| b"AutoCAD Binary DXF\r\n\x1a\0\0\0".into(), at: None, found: "binary" },
    Case { what: "a picture", spoil: |_| b"\x89PNG\r\n\x1a\n\0\0".into(), at: None, found: "binary" },
    Case {
        what: "crosses itself",
        spoil: |text| text.replacen(NECK, "\r\n-60.0000\r\n", 1).into(),
        at: None,
        found: "crosses itself at (",
    },
    Case {
        what: "decimal comma",
        spoil: |text| text.replacen(NECK, "\r\n78,88\r\n", 1).into(),
        at: Some("78,88"),
        found: "`78,88`",
    },
    Case {
        what: "unknown unit",
        spoil: |text| text.replacen("Units: METRIC", "Units: CUBITS", 1).into(),
        at: Some("Units: CUBITS"),
        found: "`CUBITS`",
    },
];

/// A place with a study and results of an earlier time in its database, without the time to make them.
fn place() -> Place {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["m"])]);
    place.toile("ease .").ends_with(0);
    place
}

/// All bytes of the database: file and log.
fn database(place: &Place) -> Vec<Vec<u8>> {
    ["toile.sqlite", "toile.sqlite-wal"].map(|name| std::fs::read(place.path(name)).unwrap_or_default()).into()
}

#[test]
fn a_damaged_pattern_is_refused_and_the_database_stays_as_it_is() {
    let place = place();
    let whole = std::fs::read_to_string(place.path(FILE)).expect("drafted");
    let before = database(&place);
    let rows = place.sql("SELECT study, size, pattern_girth_mm FROM v_ease WHERE decides");
    assert_eq!(rows.len(), 1);
    for Case { what, spoil, at, found } in CASES {
        let bytes = spoil(&whole);
        assert_ne!(bytes, whole.as_bytes(), "{what}: nothing is spoilt");
        place.write(FILE, &bytes);
        let spoilt = String::from_utf8_lossy(&bytes).into_owned();
        let line = at.map(|value| spoilt.lines().position(|line| line == value).expect("it is there") + 1);
        for command in ["pattern inspect patterns/tshirt-m.dxf", "run .", "run . --dry-run", "ease ."] {
            let said = place.toile(command).ends_with(2);
            let names_line = match line {
                Some(line) => said.err.contains(&format!("tshirt-m.dxf, line {line}")),
                None => what == "empty" || said.err.contains("tshirt-m.dxf, line "),
            };
            assert!(said.err.contains(found) && names_line, "{what}, {command}: {}", said.err);
            assert!(said.err.contains("tshirt-m.dxf"), "{what}, {command}: {}", said.err);
            assert!(!said.err.contains("panicked"), "{what}, {command}: {}", said.err);
        }
        assert_eq!(database(&place), before, "{what}");
    }
    assert_eq!(place.sql("SELECT study, size, pattern_girth_mm FROM v_ease WHERE decides"), rows);
    assert_eq!(place.one("SELECT count(*) FROM v_jobs"), "0");
}

#[test]
fn a_missing_unit_is_assumed_to_look_and_must_be_said_to_sew() {
    let place = place();
    let whole = std::fs::read_to_string(place.path(FILE)).expect("drafted");
    place.write(FILE, whole.replace("Units: METRIC", "Note: none"));
    let said = place.toile("pattern inspect --json patterns/tshirt-m.dxf").ends_with(0);
    assert_eq!(said.json()[0]["units"], "none, assumed mm");
    assert!(said.err.contains("names no unit"), "{}", said.err);
    let said = place.toile("run . --dry-run").ends_with(2);
    assert!(said.err.contains("found no unit; accepted:"), "{}", said.err);
}

#[test]
fn refused_pieces_stand_beside_good_ones() {
    let place = place();
    let whole = std::fs::read_to_string(place.path(FILE)).expect("drafted");
    place.write(FILE, whole.replacen(NECK, "\r\n-60.0000\r\n", 1));
    let said = place.toile("pattern inspect --json patterns/tshirt-m.dxf").ends_with(2);
    let report = &said.json()[0];
    assert_eq!(report["pieces"].as_array().map(Vec::len), Some(2));
    assert_eq!(report["refused"][0]["block"], "FRONT");
    let line = report["refused"][0]["line"].as_u64().expect("a line") as usize;
    let text = std::fs::read_to_string(place.path(FILE)).expect("there");
    assert_eq!(text.lines().nth(line - 1).map(str::trim), Some("BLOCK"), "line {line}");
}

#[test]
fn every_problem_of_a_study_file_is_told_with_its_line() {
    let place = place();
    let text = place.study_file();
    let before = database(&place);
    let text = text.replace("edge_length_mm = 60", "edge_length_mm = \"fine\"").replace("stature_mm", "stature_cm");
    place.write("study.toml", &text);
    let said = place.toile("run .").ends_with(2);
    let line_of = |word: &str| text.lines().position(|line| line.contains(word)).expect("it is there") + 1;
    for word in ["edge_length_mm", "stature_cm"] {
        let expect = format!("study.toml:{}:", line_of(word));
        assert!(said.err.contains(&expect) && said.err.contains(word), "{expect} {}", said.err);
    }
    place.write("study.toml", "name = [\n");
    place.toile("run .").ends_with(2);
    place.toile("run nowhere").ends_with(2);
    assert_eq!(database(&place), before);
}

#[test]
fn a_mesh_that_is_no_body_is_refused() {
    let place = Place::new();
    let check = |name: &str, bytes: &[u8]| {
        place.write(name, bytes);
        let said = place.toile(&format!("body measure {name}")).ends_with(2);
        assert!(said.err.contains(name) && said.out.is_empty(), "{}", said.err);
    };
    check("empty.obj", b"");
    check("text.obj", b"a letter to a friend\n");
    check("triangle.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    check("number.obj", b"v 0 0,5 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    check("half.stl", b"solid body\nfacet normal 0 0 1\n");
}
