//! A buyer's specification sheet beside a pattern, and kept with a style.

use serde_json::Value;

use super::program::Place;

/// One row out of tolerance in size L, one that is asked for.
const SHEET: &str = "Spec sheet in inches,,,,,\ncode,description,tol,S,M,L\nA,1/2 chest,1/2,19 1/8,20 3/8,21 1/2\n\
B,C.B. length,1/4,27 3/4,28 3/8,30\nC,Rib height,1/8,3/4,3/4,3/4\n";

const STYLE: &str = "style add tee --seams patterns/tshirt.seams.toml --pattern S=patterns/tshirt-s.dxf \
    M=patterns/tshirt-m.dxf L=patterns/tshirt-l.dxf";

/// Rows of a JSON array as cells.
fn cells(rows: &Value, keys: &[&str]) -> Vec<Vec<Value>> {
    let rows = rows.as_array().expect("rows").iter();
    rows.map(|row| keys.iter().map(|key| row[key].clone()).collect()).collect()
}

#[test]
fn a_sheet_is_kept_with_its_style_and_the_same_in_every_place() {
    let place = Place::new();
    place.draft();
    place.write("sheet.csv", SHEET);
    place.toile(STYLE).ends_with(0);
    let kept = place.toile("style spec tee --sheet sheet.csv --json").ends_with(3);
    assert!(kept.err.contains("--match C=none"), "{}", kept.err);
    let keys = ["code", "point", "size", "spec_mm", "plus_mm", "flat_mm", "deviation_mm", "verdict", "step_mm"];
    let printed = cells(&kept.json()["lines"], &keys);
    let query = "SELECT * FROM v_spec ORDER BY position, size_position";
    let mut sql = place.command("sql --format json");
    let sql = sql.arg(query).output().expect("it starts");
    assert_eq!(cells(&serde_json::from_slice(&sql.stdout).expect("JSON"), &keys), printed);
    assert_eq!(place.one("SELECT code || size FROM v_spec WHERE verdict = 'out'"), "BL");
    let answered = place.toile("style spec tee --match C=none").ends_with(3);
    assert!(!answered.err.contains("--match"), "{}", answered.err);
    assert!(answered.out.contains("-27.0 !"), "{}", answered.out);
    place.toile("style spec tee -o spec.xlsx").ends_with(3);
    place.toile("style spec tee -o spec.csv").ends_with(3);
    let csv = std::fs::read_to_string(place.path("spec.csv")).expect("written");
    assert_eq!(csv.lines().count(), 10);
    assert!(place.toile("style spec tee -o spec.png").ends_with(2).err.contains("found `.png`"));
}

#[test]
fn a_sheet_stands_beside_a_pattern_without_a_database() {
    let place = Place::new();
    place.draft();
    place.write("sheet.csv", SHEET.replace("30\n", "28 7/8\n"));
    let command = "pattern spec patterns/tshirt-m.dxf --seams patterns/tshirt.seams.toml --sheet sheet.csv";
    place.toile(&format!("{command} --size M -o spec.xlsx")).ends_with(0);
    let said = place.toile(&format!("{command} --size M --sheet-unit cm")).ends_with(0);
    assert!(said.err.contains("its lengths do not fit"), "{}", said.err);
    assert!(
        place.toile(&format!("{command} --match Z=half_chest")).ends_with(2).err.contains("accepted: one of A, B, C")
    );
    assert!(place.toile(&format!("{command} --match A=bust")).ends_with(2).err.contains("half_chest, half_waist"));
    assert!(!place.path("toile.sqlite").exists());
}
