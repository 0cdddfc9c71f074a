//! Study files of the project, read with the built-in catalogue.

use std::path::Path;

use crate::catalogue;
use spec::export::export_study;
use spec::new_study::new_study;
use spec::patterns::Model;
use spec::{Study, jobs};
use store::files;

fn hashes(study: &Study) -> Vec<String> {
    jobs(study).into_iter().map(|job| job.inputs.hash()).collect()
}

fn load(folder: &Path) -> Study {
    Study::load(folder, &catalogue::known(None).expect("built in")).expect("a good study")
}

/// Exports a study, reads it back, and expects the same simulations.
fn check(study: &Study) {
    let elsewhere = tempfile::tempdir().expect("a folder");
    files::write_files(elsewhere.path(), &export_study(study)).expect("writable");
    let again = load(elsewhere.path());
    assert_eq!(hashes(&again), hashes(study));
    assert_eq!((again.name, again.cuts), (study.name.clone(), study.cuts));
}

#[test]
fn an_exported_study_has_the_same_inputs() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    for name in ["quickstart", "thesis", "fabrics"] {
        check(&load(&project.join(name)));
    }
}

#[test]
fn a_new_study_runs_in_every_style_and_its_sweeps_are_exported() {
    for model in Model::ALL {
        let folder = tempfile::tempdir().expect("a folder");
        let files = new_study(folder.path(), model, None).expect("nothing is there");
        files::write_files(folder.path(), &files).expect("writable");
        let path = folder.path().join("study.toml");
        let text = std::fs::read_to_string(&path).expect("written");
        let plain = load(folder.path());
        std::fs::write(
            &path,
            text.replace("# [[sweep]]\n# fabric", "[[sweep]]\nfabric")
                .replace("# edge_length_mm = [", "fem.offset_mu = [0.4]\nedge_length_mm = ["),
        )
        .expect("writable");
        let swept = load(folder.path());
        assert_eq!(swept.jobs(), 4 * plain.jobs(), "{}", model.as_str());
        let first = format!("{} edge_length_mm=20 fabric=cotton_shirting_light offset_mu=0.4", model.as_str());
        assert_eq!(swept.garments[0].name, first);
        check(&swept);
        assert!(new_study(folder.path(), model, None).is_err());
    }
}

#[test]
fn the_quickstart_measures_men_of_the_thesis() {
    let known = catalogue::known(None).expect("built in");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/quickstart");
    let study = Study::load(&folder, &known).expect("good");
    for subject in &study.subjects {
        assert_eq!(subject.person, known.subjects[&format!("male-{}", subject.id)], "{}", subject.id);
    }
}

#[test]
fn the_thesis_study_has_its_54_combinations_by_both_simulators() {
    let known = catalogue::known(None).expect("built in");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/thesis");
    let jobs = jobs(&Study::load(&folder, &known).expect("good"));
    let count = |garment: &str, sex: &str| {
        jobs.iter().filter(|job| job.garment == garment && job.subject.starts_with(sex)).count()
    };
    let counts = [("tshirt", "male"), ("trousers", "male"), ("teetop", "female"), ("dress", "female")];
    assert_eq!(counts.map(|(garment, sex)| count(garment, sex)), [36, 36, 24, 12]);
    assert_eq!(jobs.len(), 108);
}
