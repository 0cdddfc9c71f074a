use super::*;

/// Limits of the mean absolute error of each source, mm.
const LIMITS: [(&str, &[(&str, f64)]); 4] = [
    ("scan", &[("neck_girth", 4.0), ("chest_girth", 9.0), ("waist_girth", 9.0), ("hip_girth", 9.0)]),
    ("silhouette_orthographic", &[("chest_girth", 15.0), ("waist_girth", 15.0), ("hip_girth", 15.0)]),
    ("silhouette_perspective", &[("chest_girth", 20.0), ("waist_girth", 20.0), ("hip_girth", 20.0)]),
    ("photo", &[("chest_girth", 20.0), ("waist_girth", 20.0), ("hip_girth", 20.0)]),
];

#[test]
fn the_reference_bodies_are_measured_within_the_limits() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/bodies"));
    if !folder.is_dir() {
        eprintln!("skipped: no reference bodies beside the project");
        return;
    }
    let found = evaluate(folder).expect("the reference bodies");
    for body in &found.bodies {
        eprintln!("{} {} {:.1?} {:?}", body.id, body.source, body.errors_mm, body.error);
    }
    for (source, limits) in LIMITS {
        for (name, limit) in limits {
            let accuracy = &found.source[source][name];
            eprintln!("{source:24} {name:12} {accuracy:.1?}");
            assert!(accuracy.mae_mm <= *limit, "{source} {name}: {accuracy:.1?}, limit {limit} mm");
        }
    }
    assert!(found.bodies.iter().all(|body| body.error.is_none()));
}

#[test]
fn a_folder_without_tables_is_refused_and_a_lost_mesh_is_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let told = evaluate(folder.path()).expect_err("no tables").to_string();
    assert!(told.contains("manifest.csv: ") && told.contains("accepted: CSV tables"), "{told}");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a table");
    write("manifest.csv", "id,sex,file\r\n\r\na,F,lost.obj,more\r\n");
    let told = evaluate(folder.path()).expect_err("a cell without a column").to_string();
    assert!(told.contains("manifest.csv: line 3 has 4 cells for 3 columns; accepted: "), "{told}");
    write("manifest.csv", "id,sex,file\na,F,lost.obj\n");
    write("measurements.csv", "id,stature_cm\na,160\n");
    let found = evaluate(folder.path()).expect("two tables");
    assert!(found.source["scan"].is_empty());
    assert!(found.bodies[0].error.as_ref().is_some_and(|error| error.contains("lost.obj")));
}
