use super::*;
use crate::testing::{Noise, in_mm, roughen};
use crate::{from_scan, pose, write_obj};
use geom::crossing;

fn person(sex: Sex) -> Measurements {
    let [stature, chest, waist, hip] = if sex == Sex::Male { [1.78, 1.0, 0.86, 1.0] } else { [1.67, 0.92, 0.74, 0.98] };
    Measurements::of(sex, stature)
        .with(Dimension::ChestGirth, chest)
        .with(Dimension::WaistGirth, waist)
        .with(Dimension::HipGirth, hip)
}

fn amounts(found: &[FigureFound]) -> ByTrait<f64> {
    let mut amounts = [0.0; TRAITS];
    found.iter().for_each(|found| amounts[found.of as usize] = found.amount_mm);
    amounts
}

fn faults(sex: Sex, of: Trait, sign: f64, degree: &str) -> Vec<String> {
    let text = format!("{}={degree}", of.name(sign));
    let figures = Figures::read([text.as_str()]).expect("a figure");
    let (asked, known) = (figures.amount_mm(of), person(sex));
    let body = match build_figured(&known, &figures) {
        Ok(body) => body,
        Err(error) => return vec![format!("{text}: {error}")],
    };
    let mut faults = Vec::new();
    let euler = (body.mesh.positions.len() + body.mesh.triangles.len()) as isize - body.mesh.edges().len() as isize;
    if !body.mesh.is_closed_manifold() || euler != 2 || !crossing::self_crossings(&body.mesh).is_empty() {
        faults.push(format!("{text}: the skin is not sound"));
    }
    for (dimension, value) in known.known() {
        let off = mm(body.girths.get(dimension).expect("read") - value);
        if off.abs() > 2.0 {
            faults.push(format!("{text}: {dimension:?} is off by {off:.1} mm"));
        }
    }
    let found = self::figures(&body).expect("a standing body");
    for found in &found {
        let (amount, is_it) = (found.amount_mm, found.of == of);
        let off = if is_it { amount - asked } else { amount };
        if off.abs() > if is_it { 5.0 } else { asked.abs().max(12.0) / 3.0 } || (!is_it && found.is_clear()) {
            faults.push(format!("{text}: {:?} of {amount:.1} mm is found, sd {:.1}", found.of, found.sd_mm));
        }
    }
    faults
}

fn check_all(sex: Sex) {
    let all: Vec<(Trait, f64, &str)> = Trait::ALL
        .into_iter()
        .filter(|of| *of != Trait::Bust || sex == Sex::Female)
        .flat_map(|of| [-1.0, 1.0].map(|sign| ["slight", "medium", "strong"].map(|degree| (of, sign, degree))))
        .flatten()
        .collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let wrong: Vec<String> = std::thread::scope(|scope| {
        let all = &all;
        let share = |first: usize| {
            let of_thread = all.iter().skip(first).step_by(threads);
            of_thread.flat_map(|(of, sign, degree)| faults(sex, *of, *sign, degree)).collect::<Vec<_>>()
        };
        let running: Vec<_> = (0..threads).map(|first| scope.spawn(move || share(first))).collect();
        running.into_iter().flat_map(|thread| thread.join().expect("a check does not panic")).collect()
    });
    assert!(wrong.is_empty(), "{} faults\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_figure_of_a_man_is_built_as_asked_and_found_again() {
    check_all(Sex::Male);
}

#[test]
fn every_figure_of_a_woman_is_built_as_asked_and_found_again() {
    check_all(Sex::Female);
}

#[test]
fn a_body_without_figures_is_that_of_its_measurements() {
    let known = person(Sex::Female);
    let plain = build(&known).expect("a body");
    assert_eq!(build_figured(&known, &Figures::default()).expect("a body"), plain);
    let found = figures(&plain).expect("a standing body");
    assert!(found.iter().all(|found| !found.is_clear()), "{found:?}");
    assert_eq!(found.len(), TRAITS);
}

#[test]
fn figures_come_together_and_hold_in_a_scan_and_another_pose() {
    let asked = Figures::read(["flat_seat", "round_back", "sloping_shoulders=8", "full_thigh"]).expect("figures");
    let body = build_figured(&person(Sex::Male), &asked).expect("a body");
    let check = |name: &str, found: &[FigureFound], off_mm: f64| {
        let amounts = amounts(found);
        for of in Trait::ALL {
            let off = amounts[of as usize] - asked.amount_mm(of);
            assert!(off.abs() < off_mm, "{name}: {of:?} is off by {off:.1} mm");
        }
    };
    check("built", &figures(&body).expect("a standing body"), 5.0);
    let mut rough = body.mesh.clone();
    roughen(&mut rough, 0.002, &mut Noise(3));
    let scan = from_scan(write_obj(&rough).as_bytes(), None, Some(Sex::Male)).expect("a scan");
    check("scanned", &scan.figures().expect("a standing body").expect("feet"), 12.0);
    let posed = pose(&body, "arms_30".parse().expect("a pose")).expect("it can stand so");
    check("posed", &figures(&posed).expect("a standing body"), 8.0);
}

#[test]
fn the_amount_is_the_change_of_the_tape_that_defines_it() {
    let known = person(Sex::Female);
    let read = |body: &Body, key: &str| {
        let taken = body.tailor().into_iter().find(|taken| taken.key == key);
        taken.and_then(|taken| taken.written).unwrap_or_else(|| in_mm(&body.girths, key))
    };
    let plain = build(&known).expect("a body");
    let check = |figure: &str, key: &str, expect: f64| {
        let body = build_figured(&known, &Figures::read([figure]).expect("a figure")).expect("a body");
        let change = read(&body, key) - read(&plain, key);
        assert!((change - expect).abs() < 3.0, "{figure}: {key} changes by {change:.1} mm, expected {expect}");
    };
    check("flat_seat=18", "crotch_length_back_mm", -18.0);
    check("prominent_abdomen=12", "crotch_length_front_mm", 12.0);
    check("long_rise=15", "body_rise_mm", 15.0);
    check("large_upper_arm=20", "upper_arm_girth_mm", 20.0);
    check("thin_thigh=15", "thigh_girth_mm", -15.0);
}

#[test]
fn figures_that_a_body_cannot_have_are_refused() {
    let check = |known: &Measurements, figure: &str, words: &[&str]| {
        let figures = Figures::read([figure]).expect("a figure");
        let error = build_figured(known, &figures).expect_err("no such body").to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    check(&person(Sex::Male), "full_bust", &["full_bust", "man"]);
    check(&person(Sex::Male).with(Dimension::ThighGirth, 0.6), "full_thigh", &["thigh_girth_mm", "full_thigh"]);
    check(&person(Sex::Male).with(Dimension::Inseam, 0.83), "long_rise", &["inseam_mm", "long_rise"]);
}
