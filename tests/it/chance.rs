//! The chance of fit: what the program prints, and that people who were measured lie where the survey says.

use std::collections::BTreeMap;

use toile::body::{Dimension, Likely, Measurements, Sex};
use toile::sim::fabric::library;

use super::program::{Place, shared};

/// Deviations that an 80 % interval reaches.
const REACH: f64 = 1.281_55;

/// What is read of each person of the survey, and what is foretold; with the survey's columns, and what turns them into ours, of men
/// and women.
const READ: [(Dimension, &str, [f64; 2]); 5] = [
    (Dimension::Stature, "stature", [1e-3, 1e-3]),
    (Dimension::Weight, "weight_kg", [1.0, 1.0]),
    (Dimension::ChestGirth, "chestcircumference", [1e-3, 1e-3]),
    (Dimension::WaistGirth, "waistcircumference", [0.997e-3, 0.968e-3]),
    (Dimension::NeckGirth, "neckcircumference", [1e-3, 1e-3]),
];
const FORETOLD: [(Dimension, &str, [f64; 2]); 4] = [
    (Dimension::HipGirth, "buttockcircumference", [1e-3, 1e-3]),
    (Dimension::ThighGirth, "thighcircumference", [1e-3, 1e-3]),
    (Dimension::UpperArmGirth, "bicepscircumferenceflexed", [0.92e-3, 0.92e-3]),
    (Dimension::CalfGirth, "calfcircumference", [1e-3, 1e-3]),
];

#[test]
fn measured_people_lie_in_their_intervals_as_often_as_is_said() {
    let Some(path) = shared("anthropometry/ansur2.csv") else {
        eprintln!("skipped: no ../shared");
        return;
    };
    let text = std::fs::read_to_string(path).expect("a table");
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let mut held: BTreeMap<&str, usize> = BTreeMap::new();
    let mut people = 0;
    for line in lines.step_by(5) {
        let row: BTreeMap<&str, &str> = heads.iter().copied().zip(line.split(',')).collect();
        let (sex, column) = if row["sex"] == "M" { (Sex::Male, 0) } else { (Sex::Female, 1) };
        let value = |name: &str, scale: [f64; 2]| row[name].parse::<f64>().expect("a number") * scale[column];
        let mut readings = Measurements::of(sex, 1.0);
        READ.iter().for_each(|(dimension, name, scale)| readings.set(*dimension, value(name, *scale)));
        // What the survey read is what it knows the spread of: nothing errs beyond that.
        let Ok(likely) = Likely::of(&readings, |_| 0.0) else { continue };
        people += 1;
        let median = likely.median();
        for (dimension, name, scale) in FORETOLD {
            let off = (value(name, scale) / median.get(dimension).expect("every dimension")).ln();
            *held.entry(name).or_default() += usize::from((off / likely.spread(dimension)).abs() < REACH);
        }
    }
    assert!(people > 1000, "{people}");
    for (name, held) in held {
        let share = held as f64 / f64::from(people);
        eprintln!("{name}: {:.1} % of {people}", 100.0 * share);
        assert!((0.76..0.84).contains(&share), "{name}: {share}");
    }
}

#[test]
fn the_chance_of_fit_is_told_with_its_intervals() {
    let place = Place::new();
    place.toile("study new mine").ends_with(0);
    let asked = "chance mine --subject male-ii --draws 100";
    let said = place.toile(asked).ends_with(0).out;
    assert!(
        said.contains("fits with") && said.contains("80 % interval") && said.contains("decides most often"),
        "{said}"
    );
    let found = place.toile(&format!("{asked} --json -o chance.svg")).ends_with(0).json();
    let size = &found["sizes"][0];
    let [low, share, high] = [&size["fits"]["interval"][0], &size["fits"]["share"], &size["fits"]["interval"][1]]
        .map(|v| v.as_f64().expect("a number"));
    assert!(0.0 <= low && low <= share && share <= high && high <= 1.0, "{size}");
    let picture = std::fs::read_to_string(place.path("chance.svg")).expect("it is written");
    assert!(picture.starts_with("<svg") && picture.contains("as meant"));
    for (wrong, words) in [
        ("chance mine --subject nobody", "male-ii"),
        ("chance mine --subject male-ii --size XXXL", "XXXL"),
        ("chance mine --subject male-ii --error-factor 0", "above 0"),
        ("chance mine --subject male-ii -o chance.pdf", "accepted: X.svg or X.png"),
    ] {
        let said = place.toile(wrong).ends_with(2).err;
        assert!(said.contains(words), "{wrong}: {said}");
    }
}

#[test]
fn drapes_say_what_cloth_and_start_leave_open() {
    let place = Place::new();
    place.study(&[("a", 0.12, &["m"])]);
    // A class of the library, whose cloths differ.
    let text = place.study_file();
    place.write("study.toml", text.replace("fabric = \"poplin_a\"", "fabric = \"poplin\""));
    let found = place.toile("chance . --draws 20 --fem 1 --json").ends_with(0).json();
    let drape = &found["drape"];
    assert_eq!((drape["draws"].as_i64(), drape["at_rest"].as_i64()), (Some(1), Some(1)), "{drape}");
    let library = library();
    let poplin = library.iter().find(|fabric| fabric.name == "poplin").expect("in the library");
    let bends_mm = drape["bending_length_mm"][1].as_f64().expect("a number");
    let [least_mm, most_mm] = poplin.scatter_m()[0].map(|m| 1e3 * m);
    assert!((least_mm..=most_mm).contains(&bends_mm), "{bends_mm}");
    assert!((bends_mm - 1e3 * poplin.bending_lengths_m()[0]).abs() > 1e-3, "the cloth is drawn: {bends_mm}");
    assert!(drape["ease_mm"]["chest"][1].as_f64().is_some_and(f64::is_finite), "{drape}");
}
