use super::*;
use crate::testing::{in_mm, reference_bodies};
use crate::{Measurements, build, import, write_obj};

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
            ("stature", known("stature_cm"), in_mm(&found, "stature_mm")),
            ("neck", known("neck_girth_cm"), in_mm(&found, "neck_girth_mm")),
            ("chest", known("chest_girth_cm"), in_mm(&found, "chest_girth_mm")),
            ("underbust", known("underbust_girth_cm"), in_mm(&found, "underbust_girth_mm")),
            ("waist", known("waist_iso_girth_cm"), in_mm(&found, "waist_girth_mm")),
            ("hip", known("hip_girth_cm"), in_mm(&found, "hip_girth_mm")),
            ("thigh", known("thigh_girth_cm"), in_mm(&found, "thigh_girth_mm")),
            ("upper arm", known("upper_arm_girth_cm"), in_mm(&found, "upper_arm_girth_mm")),
            ("across shoulder", known("across_back_shoulder_cm"), in_mm(&found, "across_shoulder_mm")),
            ("inseam", known("crotch_height_cm"), in_mm(&found, "inseam_mm")),
            ("volume (l)", known("volume_l").map(|l| l / 10.0), found.volume_l()),
            ("chest level", known("chest_height_cm"), in_mm(&found, "chest_level_mm")),
            ("hip level", known("hip_height_cm"), in_mm(&found, "hip_level_mm")),
            ("neck level", known("neck_height_cm"), in_mm(&found, "neck_level_mm")),
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
    let check = |name: &str, mean_limit: f64, most_limit: f64| {
        let errors = &errors[name];
        let mean = errors.iter().map(|e| e.abs()).sum::<f64>() / errors.len() as f64;
        let most = errors.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        assert!(mean <= mean_limit, "{name}: mean error {mean:.2} mm > {mean_limit} mm");
        assert!(most <= most_limit, "{name}: greatest error {most:.2} mm > {most_limit} mm");
    };
    check("stature", 0.5, 0.5);
    check("neck", 1.0, 2.0);
    check("chest", 5.0, 15.0);
    check("chest level", 4.5, 9.0);
    check("neck level", 4.0, 6.0);
    check("waist", 1.0, 2.0);
    check("hip", 3.0, 9.0);
    check("thigh", 3.0, 5.0);
    check("upper arm", 5.0, 9.0);
    check("inseam", 5.0, 8.0);
    // Its rule is made on bodies drawn at random, of which others err by 10 mm on average.
    check("across shoulder", 15.0, 26.0);
}

#[test]
fn a_built_body_is_measured_alike_through_any_file() {
    let asked = Measurements::of(Sex::Male, 1.76).with(Dimension::Weight, 68.0);
    let body = build(&asked).expect("an ordinary man");
    let straight = measure(&body.mesh, Some(Sex::Male)).expect("a standing body");
    let mut turned = body.mesh.clone();
    for p in &mut turned.positions {
        // Millimetres, y up, looking along -z.
        *p = V3::new(p.x, p.z, -p.y) * 1000.0;
    }
    let imported = import(write_obj(&turned).as_bytes(), None).expect("a body");
    assert_eq!(imported.notes.len(), 3, "{:?}", imported.notes);
    let found = measure(&imported.mesh, Some(Sex::Male)).expect("a standing body");
    assert!((in_mm(&found, "chest_girth_mm") - in_mm(&straight, "chest_girth_mm")).abs() < 0.1, "{found:?}");
    assert!((in_mm(&found, "neck_girth_mm") - in_mm(&straight, "neck_girth_mm")).abs() < 0.1, "{found:?}");
    let keys = serde_json::to_value(&found).expect("numbers");
    for key in [
        "stature_mm",
        "neck_girth_mm",
        "chest_girth_mm",
        "underbust_girth_mm",
        "waist_girth_mm",
        "hip_girth_mm",
        "thigh_girth_mm",
        "upper_arm_girth_mm",
        "across_shoulder_mm",
        "inseam_mm",
        "volume_l",
        "chest_level_mm",
    ] {
        assert!(keys[key].is_number(), "{key} in {keys}");
    }
}

#[test]
fn what_is_no_body_is_refused() {
    let check = |positions: Vec<V3>, triangles: Vec<[usize; 3]>| {
        assert!(measure(&TriMesh { positions, triangles }, None).is_err());
    };
    check(Vec::new(), Vec::new());
    let corners = vec![V3::zeros(), V3::x(), V3::y(), V3::z()];
    check(corners.clone(), Vec::new());
    check(corners, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
}

#[test]
fn a_summit_is_found_between_its_samples_and_in_the_middle_where_it_is_flat() {
    let profile =
        |height: &dyn Fn(f64) -> f64| (0..=96).map(|i| f64::from(i) * 1.5e-3).map(|z| (z, height(z))).collect();
    let check = |profile: Vec<(f64, f64)>, expect: f64, off: f64| {
        let found = summit(&profile).expect("a profile");
        assert!((found - expect).abs() < off, "{found} for {expect}");
    };
    check(profile(&|z| 0.1 - 4.0 * (z - 0.0707).powi(2)), 0.0707, 8e-4);
    // Alike over 30 mm, uneven by a tenth of a millimetre, steep beside it.
    let flat = |z: f64| 0.1 - 3.0 * ((z - 0.070).abs() - 0.015).max(0.0) + 1e-4 * (z * 2000.0).sin();
    check(profile(&flat), 0.070, 3e-3);
    assert_eq!(summit(&[]), None);
}
