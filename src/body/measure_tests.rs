use super::*;
use crate::body::import;

/// The reference bodies beside the project, where they are.
fn reference_bodies() -> Option<std::path::PathBuf> {
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/bodies"));
    folder.is_dir().then(|| folder.to_path_buf())
}

#[test]
fn the_reference_bodies_measure_as_known() {
    let Some(folder) = reference_bodies() else {
        eprintln!("skipped: no reference bodies beside the project");
        return;
    };
    let mut table = csv::Reader::from_path(folder.join("measurements.csv")).expect("the truth table");
    let heads = table.headers().expect("heads").clone();
    let mut errors: std::collections::BTreeMap<&str, Vec<f64>> = std::collections::BTreeMap::new();
    for row in table.records() {
        let row = row.expect("a row");
        let known = |name: &str| {
            row[heads.iter().position(|head| head == name).expect("a column")].parse::<f64>().map(|cm| cm * 10.0)
        };
        let id = &row[0];
        let file = ["obj", "ply"]
            .iter()
            .map(|end| folder.join(format!("meshes/{id}.{end}")))
            .find(|path| path.exists())
            .expect("a mesh");
        let imported = import(&std::fs::read(file).expect("bytes"), None).expect("a body");
        let found = measure(&imported.mesh, None).expect("a standing body");
        let pairs = [
            ("stature", known("stature_cm"), found.stature_mm),
            ("neck", known("neck_girth_cm"), found.neck_girth_mm),
            ("chest", known("chest_girth_cm"), found.chest_girth_mm),
            ("underbust", known("underbust_girth_cm"), found.underbust_girth_mm),
            ("waist", known("waist_iso_girth_cm"), found.waist_girth_mm),
            ("hip", known("hip_girth_cm"), found.hip_girth_mm),
            ("thigh", known("thigh_girth_cm"), found.thigh_girth_mm),
            ("upper arm", known("upper_arm_girth_cm"), found.upper_arm_girth_mm.expect("free arms")),
            ("across shoulder", known("across_back_shoulder_cm"), found.across_shoulder_mm),
            ("inseam", known("crotch_height_cm"), found.inseam_mm),
            ("volume (l)", known("volume_l").map(|l| l / 10.0), found.volume_l),
            ("chest level", known("chest_height_cm"), found.chest_level_mm),
            ("hip level", known("hip_height_cm"), found.hip_level_mm),
            ("neck level", known("neck_height_cm"), found.neck_level_mm),
        ];
        for (name, known, found) in pairs {
            if let Ok(known) = known {
                errors.entry(name).or_default().push(found - known);
            }
        }
    }
    for (name, errors) in &errors {
        let mean = errors.iter().map(|e| e.abs()).sum::<f64>() / errors.len() as f64;
        let most = errors.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        eprintln!("{name:16} MAE {mean:6.2} max {most:6.2}  {errors:.1?}");
    }
    let check = |name: &str, mae: f64| {
        let errors = &errors[name];
        let mean = errors.iter().map(|e| e.abs()).sum::<f64>() / errors.len() as f64;
        assert!(mean <= mae, "{name}: MAE {mean:.2} mm > {mae} mm");
    };
    for (name, mae) in [("stature", 0.5), ("chest", 9.0), ("waist", 9.0), ("hip", 9.0), ("neck", 4.0)] {
        check(name, mae);
    }
}
