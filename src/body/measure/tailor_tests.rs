use super::*;
use crate::testing::reference_bodies;
use crate::{Dimension, Measurements, build, from_scan, lengths, write_obj};
use std::collections::BTreeMap;

fn by_key(taken: &[Taken]) -> BTreeMap<&str, f64> {
    taken.iter().filter_map(|taken| Some((taken.key, taken.written?))).collect()
}

fn built(sex: Sex, stature_m: f64, weight_kg: f64) -> Body {
    build(&Measurements::of(sex, stature_m).with(Dimension::Weight, weight_kg)).expect("an ordinary body")
}

#[test]
fn a_taut_tape_follows_a_ball_and_spans_the_air() {
    let ball = geom::shapes::sphere(0.5, 96);
    let ends = [V3::new(0.5, 0.0, 0.0), V3::new(0.0, 0.5, 0.0)];
    let over = taut(&ball, ends[0], ends[1], V3::new(1.0, 1.0, 0.0)).expect("two ends");
    assert!((length_of(&over) - 0.25 * std::f64::consts::PI).abs() < 1e-3, "{}", length_of(&over));
    let straight = taut(&ball, ends[0], ends[1], V3::new(-1.0, -1.0, 0.0)).expect("two ends");
    assert!(length_of(&straight) > length_of(&over), "the long way round is longer");
    assert_eq!(taut(&ball, ends[0], ends[0], V3::z()), None);
}

#[test]
fn every_measure_is_taken_on_a_built_body_and_agrees_with_its_points() {
    for body in [built(Sex::Female, 1.65, 60.0), built(Sex::Male, 1.80, 82.0)] {
        let taken = body.tailor();
        assert!(taken.iter().all(|taken| taken.written.is_some() && taken.path.len() > 1), "{taken:?}");
        let read = by_key(&taken);
        let marks = &body.landmarks;
        let near = |key: &str, expect: f64, off: f64| {
            assert!((read[key] - mm(expect)).abs() < mm(off), "{key}: {:.1} for {:.1}", read[key], mm(expect));
        };
        near("bust_point_distance_mm", (marks.bust[0] - marks.bust[1]).norm(), 1e-6);
        near("bust_point_height_mm", body.levels.chest_m, 1e-3);
        near("scye_to_waist_mm", marks.armpit[0].z - body.levels.waist_m, 1e-6);
        near("body_rise_mm", body.levels.waist_m - body.levels.crotch_m, 2e-3);
        near("shoulder_length_mm", (marks.side_neck[0] - marks.shoulder[0]).norm(), 6e-3);
        assert!(read["armscye_depth_mm"] > mm(marks.back_neck.z - marks.armpit[0].z));
        let (girth, across) = (read["armscye_girth_mm"], mm((marks.shoulder[0] - marks.armpit[0]).norm()));
        let box_round = 2.0 * (1.4 * across + read["armscye_width_mm"]);
        assert!((1.9 * across..box_round).contains(&girth), "{girth} round an arm {across} high");
        let across = body.girths.written("across_shoulder_mm").expect("shoulders");
        for key in ["front_width_mm", "back_width_mm"] {
            assert!((0.75..1.05).contains(&(read[key] / across)), "{key}: {} of {across}", read[key]);
        }
        assert!((12.0..28.0).contains(&read["shoulder_slope_deg"]));
    }
}

#[test]
fn a_scan_of_a_built_body_says_how_well_it_is_known() {
    let body = built(Sex::Female, 1.68, 64.0);
    let scan = from_scan(write_obj(&body.mesh).as_bytes(), None, Some(Sex::Female)).expect("a body");
    let found = lengths(&scan.imported.mesh, Some(Sex::Female), scan.girths).expect("a standing body");
    let (read, known) = (by_key(&found.tailor), body.tailor());
    for (key, value) in by_key(&known) {
        let sd = found.confidence.iter().find(|confidence| confidence.key == key).expect(key).sd;
        assert!((read[key] - value).abs() < 3.5 * sd + 3.0, "{key}: {:.1} for {value:.1}, sd {sd:.1}", read[key]);
    }
    let document = serde_json::to_value(&found).expect("numbers");
    for key in ["knee_girth_mm", "forearm_girth_mm", "elbow_girth_mm", "ankle_girth_mm", "armscye_depth_mm"] {
        assert!(document[key].is_number() && document["confidence"][key]["sd_mm"].is_number(), "{key} in {document}");
    }
    assert!(
        document["confidence"]["chest_girth_mm"]["reason"].as_str().is_some_and(|reason| reason.contains("nipples"))
    );
}

#[test]
fn reference_bodies_lie_within_three_deviations() {
    let Some(folder) = reference_bodies() else {
        eprintln!("skipped: no reference bodies beside the project");
        return;
    };
    let columns = [
        ("across_shoulder_mm", "across_back_shoulder_cm"),
        ("arm_length_mm", "arm_length_cm"),
        ("back_waist_length_mm", "back_waist_length_cm"),
        ("cervicale_height_mm", "cervicale_height_cm"),
        ("chest_girth_mm", "chest_girth_cm"),
        ("knee_girth_mm", "knee_girth_cm"),
        ("wrist_girth_mm", "wrist_girth_cm"),
        ("waist_girth_mm", "waist_iso_girth_cm"),
    ];
    let mut table = csv::Reader::from_path(folder.join("measurements.csv")).expect("the truth table");
    for row in table.deserialize::<BTreeMap<String, String>>() {
        let row = row.expect("a row");
        let file = ["obj", "ply"].map(|end| folder.join(format!("meshes/{}.{end}", row["id"])));
        let file = file.into_iter().find(|path| path.exists()).expect("a mesh");
        let sex = if row["sex"] == "F" { Sex::Female } else { Sex::Male };
        let scan = from_scan(&std::fs::read(file).expect("bytes"), None, Some(sex)).expect("a body");
        let found = lengths(&scan.imported.mesh, Some(sex), scan.girths).expect("a standing body");
        let read: BTreeMap<&str, Option<f64>> = found.entries().collect();
        for (key, column) in columns {
            let (value, known) = (read[key].expect(key), row[column].parse::<f64>().expect(column) * 10.0);
            let sd = found.confidence.iter().find(|confidence| confidence.key == key).expect(key).sd;
            assert!((value - known).abs() < 3.0 * sd, "{} {key}: {value:.1} for {known:.1}, sd {sd:.1}", row["id"]);
        }
    }
}
