use super::*;
use crate::from_scan;

#[test]
fn lengths_of_the_reference_bodies_are_near_the_truth() {
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/bodies"));
    if !folder.is_dir() {
        eprintln!("skipped: no reference bodies beside the project");
        return;
    }
    let mut table = csv::Reader::from_path(folder.join("measurements.csv")).expect("the truth table");
    let heads = table.headers().expect("heads").clone();
    for row in table.records().map(|row| row.expect("a row")).step_by(3) {
        let known = |name: &str| {
            let column = heads.iter().position(|head| head == name).expect("a column");
            row[column].parse::<f64>().expect("a number") * 10.0
        };
        let file = ["obj", "ply"].map(|end| folder.join(format!("meshes/{}.{end}", &row[0])));
        let file = file.into_iter().find(|path| path.exists()).expect("a mesh");
        let scan = from_scan(&std::fs::read(file).expect("bytes"), None, None).expect("a body");
        let found = lengths(&scan.imported.mesh, Some(scan.sex), scan.girths).expect("a standing body");
        let found = serde_json::to_value(&found).expect("numbers");
        let read = |key: &str| found[key].as_f64().expect(key);
        let pairs = [
            ("cervicale_height", 12.0),
            ("back_waist_length", 20.0),
            ("arm_length", 20.0),
            ("wrist_girth", 8.0),
            ("calf_girth", 12.0),
            ("ankle_girth", 4.0),
        ];
        for (name, tolerance) in pairs {
            let (value, known) = (read(&format!("{name}_mm")), known(&format!("{name}_cm")));
            assert!((value - known).abs() < tolerance, "{} {name}: {value:.1} for {known:.1}", &row[0]);
        }
        let [girth, crotch] = ["waist_girth_mm", "total_crotch_length_mm"].map(read);
        assert!((0.7..1.3).contains(&(crotch / girth)), "{crotch} round the crotch, waist {girth}");
    }
}

#[test]
fn a_taut_tape_spans_a_hollow() {
    // The back of a C: from its top to its bottom the tape runs straight.
    let median = [V2::new(0.0, 0.0), V2::new(0.2, 0.0), V2::new(0.2, 1.0), V2::new(0.0, 1.0), V2::new(0.05, 0.5)];
    let length = taut(&median, V3::new(0.0, 0.0, 1.0), 0.02, -1.0).expect("two ends");
    assert!((length - 0.98).abs() < 5e-3, "{length}");
    // The front bulges.
    let bulging = [V2::new(0.0, 0.0), V2::new(0.3, 0.5), V2::new(0.0, 1.0)];
    let length = taut(&bulging, V3::new(0.0, 0.0, 1.0), 0.0, 1.0).expect("two ends");
    assert!((length - 2.0 * 0.3_f64.hypot(0.5)).abs() < 1e-6, "{length}");
}
