//! Ease, the size to wear, and how a drape sits, as views tell them.

use super::*;
use crate::assessment::{Level, Pressing};
use fit::on_body::{Hang, Sides};
use store::sql;

fn worn(spec: &JobSpec, _monitor: &mut dyn Monitor) -> Result<Outcome> {
    let eases_mm: &[(&str, f64)] = match spec.size.as_str() {
        "s" => &[("chest", 80.0), ("hip", 10.0), ("neck", 5.0), ("wrist", -30.0)],
        _ => &[("chest", 150.0), ("hip", 70.0), ("neck", 15.0), ("wrist", 130.0)],
    };
    let ease = |(level, mm): &(&str, f64)| Ease {
        level: (*level).to_owned(),
        pattern_girth_m: 0.9 + 1e-3 * mm,
        body_girth_m: 0.9,
        class: FitClass::Just,
        borderline: false,
        is_held: *level != "wrist",
    };
    let length_m = if spec.size == "s" { 0.50 } else { 0.53 };
    let point =
        |point: &str, draped_m: Option<f64>| MeasuredPoint { point: point.to_owned(), flat_m: length_m, draped_m };
    let points = vec![point("half_chest", Some(1.01 * length_m)), point("neck_width", None)];
    let level = Level {
        level: "chest".to_owned(),
        height_m: 1.3,
        body_girth_m: 0.9,
        cloth_length_m: 0.95,
        body_area_m2: 0.06,
        air_m2: 0.004,
        gaps_m: vec![Some(0.01), None, Some(-0.002), Some(0.022)],
    };
    let pressing = Pressing { region: "chest".to_owned(), area_m2: 0.01, mean_kpa: 0.4, most_kpa: 1.0 };
    let hem = Sides { front_m: Some(0.8), back_m: Some(0.83), right_m: None, left_m: None };
    let hang = Hang { hem: Some(hem), waist: None, lean_rad: [Some(0.1), None] };
    let worn = Assessment { levels: vec![level], hang, folds: vec![], pressing: vec![pressing], drawn: vec![] };
    Ok(Outcome { eases: eases_mm.iter().map(ease).collect(), points, worn, ..outcome(spec) })
}

#[test]
fn how_a_drape_sits_is_told_by_views() {
    let mut bench = Bench::new();
    bench.run(&study(0.1), 1, worn);
    let check = |sql: &str, expect: &[&str]| {
        let rows = sql::query(&bench.store, &format!("{sql} AND subject = 'v' AND size = 's'")).expect("valid").rows;
        let told: Vec<String> =
            rows.iter().map(|row| row.iter().map(Value::to_string).collect::<Vec<_>>().join(" ")).collect();
        assert_eq!(told, expect, "{sql}");
    };
    check(
        "SELECT angle_deg, round(gap_mm, 6) FROM v_section WHERE level = 'chest' AND gap_mm < 15",
        &["0 10", "20 -2"],
    );
    check(
        "SELECT height_mm, round(mean_gap_mm, 6), round(least_gap_mm, 6), round(air_area_cm2, 6) FROM v_section_level WHERE level = 'chest'",
        &["1300 10 -2 40"],
    );
    check("SELECT round(value, 3), unit FROM v_balance WHERE quantity = 'hem_front_over_back'", &["-30 mm"]);
    check("SELECT round(value, 3), unit FROM v_balance WHERE quantity GLOB 'side_*'", &["5.73 deg"]);
    check("SELECT region, mean_kpa, round(most_mmhg, 3) FROM v_pressure WHERE region = 'chest'", &["chest 0.4 7.501"]);
}

#[test]
fn the_size_to_wear_is_the_one_whose_worst_level_is_nearest_to_its_target() {
    let mut bench = Bench::new();
    bench.run(&study(0.1), 1, worn);
    let ask = |sql: &str| -> Vec<String> {
        let rows = sql::query(&bench.store, sql).expect("valid").rows;
        rows.iter().map(|row| row.iter().map(Value::to_string).collect::<Vec<_>>().join(" ")).collect()
    };
    let off = "SELECT size, level, round(off_mm), verdict FROM v_fit WHERE subject = 'v' AND off_mm <> 0 ORDER BY 1, 2";
    assert_eq!(ask(off), ["m chest 30 loose", "s hip -30 tight", "s wrist -50 tight"]);
    // The sleeve hangs free: its wrist has no greatest ease.
    let free = "SELECT level, least_mm FROM v_fit WHERE subject = 'v' AND size = 'm' AND most_mm IS NULL AND least_mm IS NOT NULL";
    assert_eq!(ask(free), ["wrist 20"]);
    let places = "SELECT size, worst_level, round(worst_off_mm), place FROM v_size WHERE subject = 'v' ORDER BY place";
    assert_eq!(ask(places), ["m chest 30 1", "s wrist -50 2"]);
    // Neither a wrist nor a neck decides the class.
    let decides = "SELECT size, level, fit_class FROM v_ease WHERE subject = 'v' AND decides ORDER BY 1";
    assert_eq!(ask(decides), ["m hip just", "s hip tight"]);
    let points = "SELECT size, point, round(flat_mm), round(step_mm), round(draped_mm) FROM v_pom WHERE subject = 'v' ORDER BY 2, 1";
    let expect = [
        "m half_chest 530 30 535",
        "s half_chest 500 NULL 505",
        "m neck_width 530 30 NULL",
        "s neck_width 500 NULL NULL",
    ];
    let told = ask(points).into_iter().map(|row| row.replace("  ", " ")).collect::<Vec<_>>();
    assert_eq!(told.len(), expect.len(), "{told:?}");
    for (told, expect) in told.iter().zip(expect) {
        let words =
            |text: &str| text.split_whitespace().filter(|word| *word != "NULL").map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(told), words(expect));
    }
}
