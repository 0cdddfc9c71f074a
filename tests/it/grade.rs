//! `toile grade`: sizes that fit a population.

use crate::program::Place;

/// Share of the people held out whom a set fits, %.
fn share(found: &serde_json::Value, set: usize) -> f64 {
    found["sets"][set]["held_out_percent"].as_f64().expect("a share")
}

#[test]
fn a_grade_fits_more_people_and_its_rules_are_read_again() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["s", "m"])]);
    // A coarser drape lies in the body here and there.
    place.write("study.toml", place.study_file().replace("edge_length_mm = 60", "edge_length_mm = 40"));
    let command = "grade . --people 30 --held-out 60 --drape 0.01 -o out --json";
    let found = place.toile(command).ends_with(0).json();
    assert_eq!(found["people"], serde_json::json!([30, 60]));
    assert!(share(&found, 1) > 1.5 * share(&found, 0), "{found}");
    assert!(found["apart_mm"].as_f64().is_some_and(|mm| mm < 0.1), "{}", found["apart_mm"]);
    assert_eq!((found["drapes"]["people"].as_u64(), found["drapes"]["agree"].as_u64()), (Some(1), Some(1)), "{found}");
    let sizes = found["sets"][1]["sizes"].as_array().expect("sizes");
    assert_eq!(sizes.iter().map(|size| size["size"].clone()).collect::<Vec<_>>(), ["s", "m"]);
    for file in ["tee.xlsx", "tee.svg", "tee.rul", "tee-s.dxf"] {
        assert!(place.path("out").join(file).is_file(), "{file}");
    }
    // What other programs read is what other commands read: the same girths from the rules as from the size drawn.
    place.toile("pattern inspect out/tee.dxf --rul out/tee.rul").ends_with(0);
    place.toile("pattern check out/tee-m.dxf --seams out/tee.seams.toml").ends_with(0);
    let drawn = place.toile("pattern pom out/tee-m.dxf --seams out/tee.seams.toml --json").ends_with(0).json();
    let length = |of: &serde_json::Value, point: &str| -> f64 {
        let points = of["points"].as_array().expect("points").iter();
        let mut found = points.filter(|one| one["point"] == point && one["size"] == "m");
        found.next().and_then(|one| one["length_mm"].as_f64()).unwrap_or_else(|| panic!("no {point}: {of}"))
    };
    for point in ["half_chest", "half_hem", "shoulder", "half_bicep"] {
        let (sheet, drawn) = (length(&found["sheet"], point), length(&drawn, point));
        assert!((sheet - drawn).abs() < 0.1, "{point}: {sheet}, not {drawn}");
    }
}

#[test]
fn steps_are_even_where_that_is_asked_and_the_same_again() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["s", "m"])]);
    let command = "grade . --people 20 --held-out 20 --sizes 3 --even --without across_shoulder --base m --json";
    let found = place.toile(command).ends_with(0).json();
    assert_eq!(found["base"], "m");
    let amounts = |size: &serde_json::Value| -> f64 {
        let turns = size["turns"].as_array().expect("turns").iter();
        turns.filter(|turn| turn["handle"] == "chest").filter_map(|turn| turn["amount_mm"].as_f64()).sum()
    };
    let chest: Vec<f64> = found["sets"][1]["sizes"].as_array().expect("sizes").iter().map(amounts).collect();
    // Amounts are told to 0.1 mm.
    assert!(chest.len() == 3 && (chest[0] - 2.0 * chest[1] + chest[2]).abs() < 0.21, "{chest:?}");
    assert!(found["rules"].as_u64().is_some_and(|rules| rules < 60), "{}", found["rules"]);
    let levels = found["levels"].as_array().expect("levels");
    assert!(levels.iter().all(|level| level["level"] != "across_shoulder"), "{levels:?}");
    assert_eq!(place.toile(command).ends_with(0).json(), found, "the same seed, the same sizes");
}

#[test]
fn what_cannot_be_graded_is_said() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["s"])]);
    let check = |arguments: &str, says: &str| {
        let err = place.toile(&format!("grade . {arguments}")).ends_with(2).err;
        assert!(err.contains(says), "{arguments}: {err}");
    };
    check("--people 3", "3 people; accepted: 20 to 20000");
    check("--sizes 0", "0 sizes; accepted: 1 to 40");
    check("--base xl", "no size `xl`; there are: s");
    check("--garment coat", "no garment `coat`");
    check("--without ankle", "no level `ankle`");
    check("--drape 2", "accepted: 0 to 1");
}
