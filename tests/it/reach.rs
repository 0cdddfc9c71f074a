//! What a movement does to a garment, through the real program.

use super::program::Place;

#[test]
fn a_body_moves_with_a_garment_on_and_its_openings_are_told() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["m"])]);
    let study = place.study_file();
    let poses = "id = \"ii\"\nposes = [\"arms_45\", \"arms_75\"]\ncarried_from = \"arms_45\"\n";
    let moved = study.replacen("id = \"ii\"\n", poses, 1);
    assert_ne!(moved, study);
    place.write("study.toml", moved);
    let run = place.toile("run . --workers 2 --sim fem --no-report").ends_with(0);
    assert!(run.err.contains("2 to run"), "{}", run.err);
    let faults = "SELECT count(*) FROM v_metrics WHERE NOT converged OR self_crossings > 0 OR penetration_max_mm > 0.5";
    assert_eq!(place.one(faults), "0");
    let drawn = |opening: &str| -> f64 {
        let of = format!(
            "SELECT drawn_mm FROM v_drawn WHERE subject = 'ii arms_75' AND carried_from = 'arms_45' AND opening = '{opening}'"
        );
        place.one(&of).parse().expect("a number")
    };
    assert!(drawn("Sleeve Opening") > 10.0 && drawn("Hem Circumference") > 0.0, "the sleeve is too short to reach up");
    assert_eq!(place.one("SELECT count(*) FROM v_drawn WHERE subject = 'ii arms_45'"), "0");
    assert!(place.toile("run . --sim fem --why").ends_with(0).err.contains("2 jobs, 0 to run"));
    let job = place.one("SELECT job_id FROM v_jobs WHERE subject = 'ii arms_75'");
    let again = place.toile(&format!("run rerun {job}")).ends_with(2);
    assert!(again.err.contains("carried it from another pose"), "{}", again.err);
}

#[test]
fn a_garment_is_tried_on_and_reached_in() {
    let place = Place::new();
    place.draft();
    place.write("ii.toml", "sex = \"male\"\nstature_mm = 1690\nchest_girth_mm = 863\n");
    let tee = "--edge-mm 60 --pattern patterns/tshirt-m.dxf --seams patterns/tshirt.seams.toml -o worn";
    let tried = place.toile(&format!("try --body ii.toml {tee} --pose arms_45 --reach arms_75 --json")).ends_with(0);
    let told: serde_json::Value = serde_json::from_str(&tried.out).expect("JSON");
    let reach = &told["reach"];
    assert_eq!((reach["pose"].as_str(), reach["self_crossings"].as_u64()), (Some("arms_75"), Some(0)));
    let cuff = reach["opening"].as_array().expect("a list").iter().find(|one| one["opening"] == "Sleeve Opening");
    assert!(cuff.and_then(|one| one["drawn_mm"].as_f64()).expect("it is there") > 10.0);
    assert!(reach["tension_n_m"].as_array().is_some_and(|all| all.len() == 4) && reach["pressure_kpa"].is_array());
    assert!(place.path("worn/reach.png").is_file() && place.path("worn/drape.png").is_file());

    let refused = |arguments: &str, code: i32, says: &str| {
        let said = place.toile(&format!("try --body ii.toml {tee} {arguments}")).ends_with(code);
        assert!(said.err.contains(says), "{arguments}: {}", said.err);
    };
    refused("--reach arms_75 --sim hybrid", 2, "--reach is for one garment and --sim fem");
    refused("--reach wings_3", 2, "pose `wings_3`; accepted: arms_5 to arms_90");
}
