//! The chance of fit on the quickstart study.

use std::path::Path;

use super::*;
use crate::chance::bench::Bench;
use engine::ease;
use spec::bodies;
use wardrobe::catalogue;

fn quickstart() -> Study {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/quickstart");
    Study::load(&folder, &catalogue::known(None).expect("built in")).expect("a good study")
}

fn question(subject: &str) -> Question {
    Question {
        garment: None,
        subject: Some(subject.to_owned()),
        size: None,
        draws: 200,
        seed: 3,
        error_factor: 1.0,
        tolerance_mm: 6.0,
        fem: 0,
    }
}

#[test]
fn shares_of_a_size_add_up_and_its_likely_ease_is_that_of_the_flat_pattern() {
    let found = chance(&quickstart(), &question("ii")).expect("it can be told");
    assert_eq!(found.told, "S");
    let worn: f64 = found.sizes.iter().map(|size| size.wear.share).sum();
    assert!((worn - 1.0).abs() < 1e-12, "{worn}");
    for size in &found.sizes {
        assert!((size.fits.share + size.tight + size.loose - 1.0).abs() < 1e-12, "{}", size.size);
        let decides: f64 = size.levels.iter().map(|level| level.decides).sum();
        assert!((decides - (1.0 - size.fits.share)).abs() < 1e-12, "{}: {decides}", size.size);
    }
    let small = found.told().expect("told");
    // `toile fit` says 111 mm. The chest was read, so its median is nearly that.
    let chest = small.levels.iter().find(|level| level.level == "chest").expect("covered");
    assert!((chest.ease_mm[1] - 111.0).abs() < 5.0, "{:?}", chest.ease_mm);
    let width = chest.ease_mm[2] - chest.ease_mm[0];
    assert!((15.0..40.0).contains(&width), "{width}");
    assert!(found.chart().expect("drawn").svg().contains("across shoulder"));
}

#[test]
fn the_same_seed_gives_the_same_and_a_better_tape_a_narrower_ease() {
    let study = quickstart();
    let told = |question: &Question| serde_json::to_value(chance(&study, question).expect("told")).expect("plain");
    let first = told(&question("v"));
    assert_eq!(first, told(&question("v")));
    assert_ne!(first, told(&Question { seed: 4, ..question("v") }));
    let hip = |question: &Question| {
        let found = chance(&study, question).expect("told");
        let level = found.sizes[0].levels.iter().find(|level| level.level == "hip").expect("covered").clone();
        level.ease_mm[2] - level.ease_mm[0]
    };
    let exact = Question { error_factor: 0.01, tolerance_mm: 0.01, ..question("v") };
    let rough = Question { error_factor: 2.0, ..question("v") };
    let widths = [exact, question("v"), rough].map(|question| hip(&question));
    assert!(widths[0] < 3.0 && widths[0] < 0.3 * widths[1] && widths[1] < 0.9 * widths[2], "{widths:?}");
}

#[test]
fn eases_are_nearly_linear_in_the_dimensions() {
    let study = quickstart();
    let question = Question { tolerance_mm: 1e-9, ..question("v") };
    let (jobs, target) = asked(&study, &question).expect("there");
    let style = stages::style(&jobs[1]).expect("it can be read");
    let styles = [(jobs[1].size.clone(), style)];
    let bench = Bench::new(&styles, &target, &jobs[1].person.measurements, None, &question).expect("a person");
    let mut draw = Draw::new(9);
    let (mut squares, mut count) = (0.0, 0);
    for _ in 0..6 {
        let person = bench.person(&mut draw);
        let linear = bench.eases_m(&bench.sizes[0], &person, &mut draw);
        let body = bodies::build_body(&person).expect("a person");
        let built = ease::on(&styles[0].1, &body);
        for (level, ease_m) in bench.sizes[0].levels.iter().zip(linear) {
            let truth = built.iter().find(|ease| ease.level == level.name).expect("covered").ease_m();
            squares += (1e3 * (ease_m - truth)).powi(2);
            count += 1;
        }
    }
    let rms_mm = (squares / f64::from(count)).sqrt();
    assert!(rms_mm < 1.5, "{rms_mm}");
}

#[test]
fn what_is_not_there_is_named() {
    let study = quickstart();
    let check = |question: Question, words: &str| {
        let error = chance(&study, &question).expect_err("refused").to_string();
        assert!(error.contains(words), "{error}");
    };
    check(Question { subject: None, ..question("v") }, "ii");
    check(question("nobody"), "nobody");
    check(Question { size: Some("XXL".into()), ..question("v") }, "XXL");
    check(Question { garment: Some("coat".into()), ..question("v") }, "coat");
}

#[test]
fn a_size_that_is_mostly_out_of_reach_is_the_nearest() {
    let check = |out_of_reach: f64, expect: &str| {
        let all = Share::of(10, 10);
        let size = "40".to_owned();
        let chance =
            SizeChance { size, wear: all, fits: all, tight: 0.0, loose: 1.0, out_of_reach, levels: Vec::new() };
        assert_eq!(chance.place(), expect, "{out_of_reach}");
    };
    check(0.0, "the one to wear");
    check(0.5, "the one to wear");
    check(0.51, "the nearest, though none fits,");
    check(1.0, "the nearest, though none fits,");
}
