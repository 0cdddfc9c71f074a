//! Studies of the project and the published one, with the built-in catalogue.

use std::path::Path;

use crate::catalogue;
use fit::{Errors, Finding, FitClass, Pair, rule_score, wins};
use spec::export::export_study;
use spec::new_study::new_study;
use spec::patterns::Model;
use spec::{Study, jobs};
use store::evidence::{self, PUBLISHED};
use store::{Store, files};

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

fn open() -> (tempfile::TempDir, Store) {
    let folder = tempfile::tempdir().expect("a folder");
    let store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
    (folder, store)
}

fn pairs_of<'a>(pairs: &'a [Pair], garment: &str) -> Vec<&'a Pair> {
    pairs.iter().filter(|pair| pair.garment.ends_with(garment)).collect()
}

/// Counts of the cases in which each simulator has the lower EI, as in the audit of the thesis's tables.
#[test]
fn the_published_tables_know_no_winner() {
    let (_folder, store) = open();
    let pairs = evidence::pairs(&store, PUBLISHED).expect("readable");
    let all = |_: &Errors| true;
    let check =
        |garment: &str, expected: [usize; 2]| assert_eq!(wins(&pairs_of(&pairs, garment), all), expected, "{garment}");
    check("", [27, 27]);
    check("tshirt", [5, 13]);
    check("trousers", [8, 10]);
    check("teetop", [8, 4]);
    check("dress", [6, 0]);
    assert_eq!(pairs.len(), 54);
    let class = |class: FitClass| pairs.iter().filter(|pair| pair.class == class).collect::<Vec<_>>();
    assert_eq!(wins(&class(FitClass::Loose), all), [12, 9]);
    assert_eq!(wins(&class(FitClass::Just), all), [6, 5]);
    assert_eq!(wins(&class(FitClass::Tight), all), [9, 13]);
    let score = rule_score(&pairs);
    assert_eq!((score.right, score.of), (25, 43));
}

#[test]
fn t_shirts_turn_to_fem_without_the_neck_opening() {
    let (_folder, store) = open();
    let evidence = evidence::evidence(&store, PUBLISHED).expect("readable");
    let garment = |name: &str| evidence.garments.iter().find(|all| all.garment == name).expect("published");
    let shirts = &garment("male_tshirt").analysis;
    let all = shirts.estimate.expect("six subjects");
    assert!(all.mean > 0.0 && shirts.wins == [5, 13], "{all:?}");
    let rest = shirts.turned_by().expect("one measurement");
    assert_eq!((rest.what.as_str(), rest.wins), ("#6 Neck Opening", [15, 3]));
    assert!(rest.mean < 0.0, "{rest:?}");
    // The dress: FEM-GS wins for six of six subjects, which gives the least possible p.
    let (dress, p_holm) = (&garment("female_dress").analysis, garment("female_dress").p_holm);
    assert_eq!((dress.wins, dress.estimate.expect("six").p), ([6, 0], 0.03125));
    assert_eq!(p_holm, Some(0.125), "of four garments");
    // No universal rule: of no garment and fit class is anything proven.
    for answer in &evidence.answers {
        assert_eq!(answer.finding, Finding::InsufficientEvidence, "{} {:?}", answer.garment, answer.class);
        assert_eq!(answer.recommended(), answer.class.rule_says());
    }
    assert_eq!(evidence.answers.len(), 11);
}
