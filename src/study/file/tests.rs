use super::*;
use crate::body::Sex;

fn known() -> Known {
    let male_ii = Measurements {
        sex: Sex::Male,
        stature_m: 1.69,
        weight_kg: Some(53.0),
        chest_girth_m: Some(0.863),
        waist_girth_m: None,
        hip_girth_m: None,
        neck_girth_m: None,
        across_shoulder_m: None,
    };
    let cotton = Fabric {
        name: "cotton_shirting_light".into(),
        density_kg_m2: 0.1036,
        thickness_m: 0.2e-3,
        membrane_warp_n_m: 3800.0,
        membrane_weft_n_m: 2400.0,
        membrane_coupling_n_m: 0.0,
        shear_n_m: 97.0,
        bending_warp_nm: 5e-6,
        bending_weft_nm: 4e-6,
        friction_body: 0.31,
        friction_self: 0.5,
        source: "test".into(),
    };
    Known {
        subjects: [("male-ii".to_owned(), male_ii)].into(),
        fabrics: [("cotton_shirting_light".to_owned(), cotton)].into(),
    }
}

/// Writes a study into a folder with its two input files and loads it.
fn load(text: &str) -> std::result::Result<Study, String> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("tee-s.dxf"), "dxf").expect("writable");
    std::fs::write(folder.path().join("tee.seams.toml"), "seams").expect("writable");
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).expect("writable");
    let prefix = format!("{}/", folder.path().display());
    Study::load(&path, &known()).map_err(|error| error.to_string().replace(&prefix, ""))
}

const GOOD: &str = r#"
name = "tops"
[[subject]]
id = "ii"
like = "male-ii"
[[subject]]
id = "x"
sex = "female"
stature_mm = 1650
[[garment]]
name = "tee"
seams = "tee.seams.toml"
fabric = "cotton_shirting_light"
sizes = [{ name = "S", pattern = "tee-s.dxf" }]
"#;

#[test]
fn a_good_file_is_read_with_its_inputs() {
    let study = load(GOOD).expect("good");
    assert_eq!((study.name.as_str(), study.repeats, study.simulators.as_slice()), ("tops", 1, &[Simulator::Fem][..]));
    assert_eq!(study.subjects.iter().map(|s| s.id.as_str()).collect::<Vec<_>>(), ["ii", "x"]);
    assert_eq!(&*study.garments[0].sizes[0].pattern.bytes, b"dxf");
}

#[test]
fn every_problem_is_told_at_once_with_its_line() {
    let told = load(
        r#"
nam = "tops"
simulators = ["fem", "fen"]
edge_length_mm = "15"
fit = { tight_below_mm = 120 }
[[subject]]
id = "ii"
like = "male-i1"
[[subject]]
id = "ii"
sex = "man"
stature_mm = 17
[[garment]]
name = "tee"
seams = "tee.seam.toml"
fabric = "cotton_shirting_ligth"
sizes = [{ name = "S", patern = "tee-s.dxf" }]
"#,
    );
    insta::assert_snapshot!(told.expect_err("bad"));
}

#[test]
fn broken_toml_names_its_line() {
    insta::assert_snapshot!(load("name = \"a\"\n[[subject]\nid = 1\n").expect_err("bad"));
}

#[test]
fn the_quickstart_is_a_good_study() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies/quickstart");
    let study = Study::load(&folder, &known()).expect("good");
    assert_eq!(super::super::spec::jobs(&study).len(), 12);
    let thesis = super::super::catalogue::known(None).expect("built in").subjects;
    for subject in &study.subjects {
        assert_eq!(subject.measurements, thesis[&format!("male-{}", subject.id)], "{}", subject.id);
    }
}

proptest::proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(edits in proptest::collection::vec((0usize..GOOD.len(), "[\\[\\]{}=\"a-z0-9.\n -]{0,3}"), 1..6)) {
        let mut text = GOOD.to_owned();
        for (at, insert) in edits {
            let at = (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
            let end = (at + insert.len()).min(text.len());
            text.replace_range(at..end, &insert);
        }
        let problems = parse::study(Path::new("study.toml"), &text, &known()).err().unwrap_or_default();
        for problem in problems {
            proptest::prop_assert!(problem.line.is_some_and(|line| line <= text.lines().count() + 1), "{problem}");
        }
    }
}
