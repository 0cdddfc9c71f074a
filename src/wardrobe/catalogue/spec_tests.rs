//! Specification sheets of styles, in the database and beside it.

use std::path::PathBuf;

use super::*;
use crate::seams::spec_sheet::SpecReport;
use pattern::spec_sheet::compared::Verdict;
use spec::patterns::{self, Model};
use store::{Table, Value, sql};

/// Six rows in centimetres: one out of tolerance, one that is asked for.
const SHEET: &str = "All measurements in cm,,,,,\ncode,description,tol,S,M,L\n\
A,1/2 Chest 2.5 cm below armhole,1,48.5,51.5,54.5\nB,Chest circumference,2,97,103,110\n\
C,CB length,0.5,70.5,73,73.5\nD,Body width 40 cm below HPS,1,48.5,51.5,54.5\nE,Neck width,,16,16,16\n\
F,Collar height,0.2,2,2,2\n";

struct Bench {
    folder: tempfile::TempDir,
    store: Store,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let store = open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        store::files::write_files(folder.path(), &patterns::drafted(Model::Tshirt)).expect("writable");
        std::fs::write(folder.path().join("sheet.csv"), SHEET).expect("writable");
        let mut bench = Self { folder, store };
        let given = StyleGiven {
            seams: Some(bench.path("tshirt.seams.toml")),
            patterns: ["S", "M", "L"].map(|size| bench.size(size, size)).to_vec(),
            ..StyleGiven::default()
        };
        save_style(&mut bench.store, Mode::Add, "tee", &given).expect("it is sewn");
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn size(&self, name: &str, drafted: &str) -> (Option<String>, PathBuf) {
        (Some(name.to_owned()), self.path(&format!("tshirt-{}.dxf", drafted.to_lowercase())))
    }

    fn keep(&mut self, file: Option<&str>, answers: &[&str]) -> SpecReport {
        let answers = answers.iter().map(|answer| answer.parse().expect("an answer")).collect();
        let given = SpecGiven { file: file.map(|name| self.path(name)), answers, ..SpecGiven::default() };
        keep_spec(&mut self.store, "tee", &given).expect("it is kept")
    }

    fn rows(&self, sql: &str) -> Table {
        sql::query(&self.store, sql).expect("valid")
    }

    fn one(&self, sql: &str) -> String {
        let cells = self.rows(sql).rows.into_iter().flatten();
        cells.map(|value| value.to_string()).collect::<Vec<_>>().join(",")
    }
}

#[test]
fn the_view_has_the_numbers_of_the_comparison() {
    let mut bench = Bench::new();
    let report = bench.keep(Some("sheet.csv"), &[]);
    assert_eq!((report.rows, report.matched, &*report.unit), (6, 5, "cm"), "{:?}", report.asked);
    let found = bench.rows(
        "SELECT code, point, size, spec_mm, minus_mm, flat_mm, deviation_mm, step_mm, flat_step_mm, verdict FROM v_spec
        ORDER BY position, size_position",
    );
    assert_eq!(found.rows.len(), report.lines.len());
    for (row, line) in found.rows.iter().zip(&report.lines) {
        let text = |text: Option<&str>| text.map_or(Value::Null, |text| Value::Text(text.to_owned()));
        let words = [Some(&*line.code), line.point.as_deref(), Some(&*line.size)].map(text);
        assert_eq!((&row[..3], &row[9]), (&words[..], &text(line.verdict.map(Verdict::as_str))), "{line:?}");
        let numbers =
            [Some(line.spec_mm), line.minus_mm, line.flat_mm, line.deviation_mm, line.step_mm, line.flat_step_mm];
        for (value, number) in row[3..9].iter().zip(numbers) {
            match (value, number) {
                (Value::Null, None) => {}
                (Value::Real(value), Some(number)) => assert!((value - number).abs() < 1e-9, "{line:?}"),
                found => panic!("{found:?}, {line:?}"),
            }
        }
    }
    // By hand: half of the girth is 517.05 mm, and the length of the back 719.96 mm.
    let by_hand =
        "SELECT round(deviation_mm, 1) || ' ' || verdict FROM v_spec WHERE size = 'M' AND code IN ('A', 'B', 'C')";
    assert_eq!(bench.one(by_hand), "2.0 in,4.1 in,-10.0 out");
    assert_eq!(
        bench.one("SELECT DISTINCT point FROM v_spec WHERE code IN ('B', 'D')"),
        "2*half_chest,half_below_hps@400"
    );
    assert_eq!(bench.one("SELECT DISTINCT verdict IS NULL FROM v_spec WHERE code = 'E'"), "1");
    assert_eq!(spec(&mut bench.store, "tee", None).expect("kept").lines, report.lines);
}

#[test]
fn answers_are_kept_with_the_sheet() {
    let mut bench = Bench::new();
    assert_eq!(bench.keep(Some("sheet.csv"), &[]).asked[0].code, "F");
    let report = bench.keep(None, &["F=none", "A=half_waist"]);
    assert!(report.asked.is_empty(), "{:?}", report.asked);
    assert_eq!(bench.one("SELECT matched FROM spec_row WHERE code IN ('A', 'F')"), "answer,none");
    let report = bench.keep(None, &["A=2*half_waist"]);
    assert_eq!(report.lines[0].point.as_deref(), Some("2*half_waist"));
    assert!(report.asked.is_empty(), "an earlier answer holds");
    assert_eq!(bench.keep(Some("sheet.csv"), &[]).asked.len(), 1, "another sheet has its own");
}

#[test]
fn worn_lengths_are_those_of_results_and_flat_ones_of_the_revision() {
    let mut bench = Bench::new();
    bench.keep(Some("sheet.csv"), &[]);
    let fill = "INSERT INTO study (study_id, name, path, tight_below_mm, loose_above_mm, updated_at)
            VALUES (1, 'tops', 'p', 50, 100, 0);
        INSERT INTO job (job_id, study_id, garment, size, subject, simulator, input_hash, status, queued_at, subject_id,
            style_id, size_id, fabric_id)
        SELECT 1, 1, 'tee', 'M', 'ii', 'fem', 'h', 'done', 0, 1, style_id, size_id, 1 FROM style, size
            WHERE style.name = 'tee' AND size.name = 'M';
        INSERT INTO pom VALUES (1, 1, 'half_chest', 517.05, 520.5);";
    bench.store.writer().expect("writable").execute_batch(fill).expect("valid");
    assert_eq!(bench.one("SELECT worn_mm FROM v_spec WHERE subject = 'ii' AND code IN ('A', 'B')"), "520.5,1041");
    assert_eq!(bench.one("SELECT count(*) FROM v_spec"), "18");
    let report = spec(&mut bench.store, "tee", None).expect("kept");
    let worn: Vec<f64> = report.lines.iter().filter_map(|line| line.worn_mm).collect();
    assert_eq!(worn, [520.5, 1041.0]);
    let told = spec(&mut bench.store, "tee", Some("iv")).expect_err("no result").to_string();
    assert!(told.contains("no subject with a result `iv`"), "{told}");
    // Another pattern of the size is measured when it is asked for, and what was worn is not of it.
    let given = StyleGiven { patterns: vec![bench.size("M", "L")], ..StyleGiven::default() };
    save_size(&mut bench.store, Mode::Edit, "tee/M", &given).expect("it is sewn");
    assert_eq!(bench.one("SELECT flat_mm IS NULL, worn_mm IS NULL FROM v_spec WHERE code = 'A' AND size = 'M'"), "1,1");
    let report = spec(&mut bench.store, "tee", None).expect("kept");
    let flat = report.lines.iter().find(|line| line.code == "A" && line.size == "M").and_then(|line| line.flat_mm);
    assert!(flat.is_some_and(|mm| (mm - 547.05).abs() < 0.1), "{flat:?}");
}

#[test]
fn a_style_without_a_sheet_says_so() {
    let mut bench = Bench::new();
    let mut told = |style: &str| spec(&mut bench.store, style, None).expect_err(style).to_string();
    assert!(told("tea").contains("did you mean `tee`?"));
    assert!(told("tee").contains("style tee has no specification sheet; give one with --sheet FILE"));
    bench.keep(Some("sheet.csv"), &[]);
    remove(&mut bench.store, Part::Style, "tee").expect("there");
    assert_eq!(bench.one("SELECT count(*) FROM v_spec"), "0");
}
