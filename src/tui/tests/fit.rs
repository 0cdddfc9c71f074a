//! Fit of the example's T-shirt, as threads answer it and the Fit screen shows it.

use insta::assert_snapshot;

use super::{Bench, fixture};
use crate::app::App;
use crate::keys::screen::Screen;
use crate::messages::effect::Effect;
use crate::messages::message::Message;
use crate::screens::fit::actions::{card_levels, quantities_shown};
use crate::screens::fit::state::View;
use crate::widgets::theme::Colours;
use fit::Simulator;
use results::{
    Balance, CrossSection, CutCloth, CutLine, FitCard, FoldLine, GarmentWorn, LevelGap, LevelSits, RegionPressure,
    SizeSits, SizeWorn, WornPoint,
};
use store::JobId;

const SIZES: [&str; 3] = ["S", "M", "L"];

/// Level, body, target, and ease of each size, mm.
type LevelMm = (&'static str, f64, Option<[f64; 2]>, [f64; 3]);

const LEVELS: [LevelMm; 6] = [
    ("neck", 381.0, None, [180.0, 189.0, 198.0]),
    ("across_shoulder", 458.0, Some([0.0, 50.0]), [-4.0, 14.0, 32.0]),
    ("chest", 936.0, Some([50.0, 120.0]), [38.0, 98.0, 158.0]),
    ("waist", 867.0, Some([50.0, 230.0]), [107.0, 167.0, 227.0]),
    ("hip", 1004.0, Some([40.0, 120.0]), [-30.0, 30.0, 90.0]),
    ("upper_arm", 268.0, Some([40.0, 180.0]), [145.0, 167.0, 189.0]),
];

fn sits(level: usize, size: usize) -> LevelSits {
    let (level, body_girth_mm, target_mm, eases_mm) = LEVELS[level];
    let ease_mm = eases_mm[size];
    let off_mm = target_mm.map(|[least, most]| (ease_mm - least).min(0.0) + (ease_mm - most).max(0.0));
    LevelSits {
        level: level.into(),
        pattern_girth_mm: body_girth_mm + ease_mm,
        body_girth_mm,
        ease_mm,
        target_mm,
        off_mm,
        weight_mm: off_mm.map(|off_mm| if off_mm < 0.0 { -2.0 * off_mm } else { off_mm }),
        cannot_close: false,
        covered_deg: None,
    }
}

fn card(subject: &str) -> FitCard {
    let size = |(k, worst): (usize, &str)| SizeSits {
        size: SIZES[k].into(),
        place: Some([3, 1, 2][k]),
        worst_level: Some(worst.into()),
        levels: (0..LEVELS.len()).map(|level| sits(level, k)).collect(),
    };
    let sizes = ["hip", "hip", "chest"].into_iter().enumerate().map(size).collect();
    FitCard { garment: "tshirt".into(), subject: subject.into(), intended: Some("regular".into()), sizes }
}

fn drape(k: usize, job: i64) -> SizeWorn {
    let more = k as f64;
    let gap = |level: &str, mean: f64| LevelGap {
        level: level.into(),
        least_gap_mm: Some(1.0),
        mean_gap_mm: Some(mean + 6.0 * more),
        greatest_gap_mm: Some(3.0 * mean),
    };
    let balance =
        |quantity: &str, value: f64, unit: &str| Balance { quantity: quantity.into(), value, unit: unit.into() };
    let point = |point: &str, flat_mm: f64, draped_mm: Option<f64>| WornPoint {
        point: point.into(),
        flat_mm: flat_mm + 30.0 * more,
        step_mm: (k > 0).then_some(30.0),
        draped_mm: draped_mm.map(|draped| draped + 30.0 * more),
    };
    SizeWorn {
        size: SIZES[k].into(),
        job: JobId(job),
        gaps: vec![gap("upper_arm", 12.0), gap("chest", 9.0), gap("waist", 14.0), gap("hip", 3.0)],
        balance: vec![
            balance("hem_front", 784.0 - 5.0 * more, "mm"),
            balance("hem_front_over_back", -5.0 + 18.0 * more, "mm"),
            balance("side_seam_lean_left", 2.0 * more - 1.0, "deg"),
            balance("side_seam_lean_right", 2.0 * more, "deg"),
        ],
        pressure: vec![RegionPressure {
            region: "upper_arms".into(),
            area_cm2: 55.0,
            mean_kpa: 0.04,
            most_kpa: 0.19,
            most_mmhg: 1.4,
        }],
        folds: vec![FoldLine {
            kind: "drag_line".into(),
            length_mm: 133.0,
            from_vertical_deg: 40.0,
            height_mm: 900.0,
            side_deg: 90.0,
        }],
        points: vec![point("half_chest", 487.1, Some(486.7)), point("neck_width", 160.0, None)],
        drawn: vec![],
    }
}

/// Fit of the T-shirt on a subject: with drapes of three sizes on the first subject, one on the second, none on the
/// third.
pub fn worn(subject: &str) -> GarmentWorn {
    let sizes: Vec<SizeWorn> = match subject {
        "i" => [1, 7, 13].into_iter().enumerate().map(|(k, job)| drape(k, job)).collect(),
        "ii" => vec![drape(0, 3)],
        _ => vec![],
    };
    GarmentWorn { card: card(subject), simulator: (!sizes.is_empty()).then_some(Simulator::Fem), sizes }
}

/// An ellipse around a point of the plane, mm.
fn ellipse(at: f64, across: f64, deep: f64) -> CutLine {
    let point = |k: usize| {
        let (sin, cos) = (k as f64 / 60.0 * std::f64::consts::TAU).sin_cos();
        [at + across * cos, deep * sin]
    };
    CutLine { points: (0..60).map(point).collect(), closed: true }
}

/// Sections as the thread that cuts answers them: a trunk at three levels, with arms beside its chest.
pub fn sections(jobs: &[JobId]) -> Vec<CrossSection> {
    let size = |job: &JobId| if job.0 == 3 { 0 } else { job.0 as usize / 6 };
    let section = |(level, height_mm, across, deep): (&str, f64, f64, f64)| CrossSection {
        level: level.into(),
        height_mm,
        centre: [0.0, 0.0],
        skin: ellipse(0.0, across, deep),
        others: if level == "chest" { vec![ellipse(-260.0, 50.0, 50.0), ellipse(260.0, 50.0, 50.0)] } else { vec![] },
        cloth: jobs
            .iter()
            .map(|job| {
                let gap = 6.0 + 22.0 * size(job) as f64;
                CutCloth {
                    job: job.0,
                    size: SIZES[size(job)].into(),
                    simulator: "fem".into(),
                    lines: vec![ellipse(0.0, across + gap, deep + gap)],
                    gaps: vec![(0.0, Some(gap)), (90.0, Some(gap + 4.0)), (180.0, None)],
                }
            })
            .collect(),
    };
    [("chest", 1243.7, 170.0, 115.0), ("waist", 1049.8, 140.0, 100.0), ("hip", 869.0, 175.0, 125.0)]
        .into_iter()
        .map(section)
        .collect()
}

#[test]
fn looks() {
    let check = |name: &str, width: u16, height: u16, keys: &str| {
        let mut bench = Bench::example(width, height);
        assert_snapshot!(format!("{name}_{width}x{height}"), bench.press(keys).screen());
    };
    check("fit", 80, 24, "0");
    check("fit_section", 80, 24, "0<Tab>");
    check("fit_sizes", 80, 24, "0<Tab><Tab>jj");
    check("fit", 160, 50, "0");
    check("fit_without_drape", 80, 24, "0ll");
}

#[test]
fn the_worst_level_is_cut_first_and_keys_step_through_levels() {
    let level = |keys: &str| {
        let mut bench = Bench::example(80, 24);
        let App { state, screens } = &bench.press(keys).app;
        screens.fit.section(state).map(|section| section.level.clone())
    };
    let check = |keys: &str, expect: &str| assert_eq!(level(keys).as_deref(), Some(expect), "{keys}");
    check("F", "hip");
    check("0v", "chest");
    check("0vv", "waist");
    check("0vV", "hip");
    check("0kk", "chest");
    check("0<Tab>jj", "waist");
    check("0<Tab>gj", "waist");
    check("0<Tab>G", "hip");
    assert_eq!(level("0g"), None, "no body is cut at the neck");
    let screen = Bench::example(80, 24).press("0g<Tab>").screen();
    assert!(screen.contains("not cut at this level; v goes to chest, waist, hip"), "{screen}");
    check("0gv", "chest");
    check("0kkl", "chest");
}

#[test]
fn parts_are_gone_through_and_subjects_stepped() {
    let mut bench = Bench::example(80, 24);
    let seen: Vec<View> =
        ["0", "<Tab>", "<Tab>", "<Tab>", "<Tab>", "<S-Tab>"].map(|key| bench.press(key).app.screens.fit.view).to_vec();
    assert_eq!(seen, [View::Card, View::Section, View::Sizes, View::Comments, View::Card, View::Comments]);
    bench.press("<S-Tab>");
    assert!(bench.screen().contains("tshirt on i · FEM"), "{}", bench.screen());
    bench.press("l");
    assert!(bench.screen().contains("tshirt on ii · FEM"), "{}", bench.screen());
    assert_eq!(bench.app.state.focus.job, Some(JobId(3)), "the selected job goes with the subject");
    bench.press("lv");
    assert!(bench.status().contains("sections need a drape: R runs"), "{}", bench.status());
    assert!(bench.screen().contains("no drape yet") && bench.screen().contains("tshirt on iii"), "{}", bench.screen());
    bench.press("hhjj5<Esc>");
    assert_eq!((bench.app.state.nav.screen, bench.app.screens.fit.row), (Screen::Fit, 2));
    bench.press("q");
    assert_eq!((bench.app.state.nav.screen, bench.app.state.focus.wearer.clone()), (Screen::Study, None));
}

#[test]
fn sections_are_asked_for_once_and_late_ones_dropped() {
    let mut bench = Bench::example(80, 24);
    bench.press("0<Tab>jjv");
    let cuts = |bench: &Bench| bench.effects.iter().filter(|effect| matches!(effect, Effect::Cut(_))).count();
    assert_eq!(cuts(&bench), 1);
    bench.press("l");
    assert_eq!((cuts(&bench), bench.app.screens.fit.asked.clone()), (2, vec![JobId(3)]));
    bench.send(Message::Cut(vec![JobId(1)], Err("late".into())));
    assert!(bench.app.screens.fit.section(&bench.app.state).is_some());
    bench.send(Message::Cut(vec![JobId(3)], Err("the mesh is gone".into())));
    assert!(bench.screen().contains("no section: the mesh is gone"), "{}", bench.screen());
}

#[test]
fn what_is_tight_or_loose_has_its_sign_and_colour() {
    let mut bench = Bench::example(160, 50);
    let buffer = bench.press("0").drawn().buffer().clone();
    let theme = bench.app.state.theme;
    let style_of = |sign: &str, words: &str| {
        let cell = |k: usize| buffer.content[k].symbol();
        let starts = (0..buffer.content.len() - words.chars().count()).filter(|k| cell(*k) == sign);
        let is_told = |k: &usize| words.chars().enumerate().all(|(n, c)| cell(k + 2 + n) == c.to_string());
        starts.filter(is_told).map(|k| buffer.content[k].fg).next()
    };
    assert_eq!(style_of("▼", "tight by 70!"), theme.bad().fg);
    assert_eq!(style_of("▲", "loose by 38"), theme.warn().fg);
    assert_eq!(style_of("·", "as meant"), theme.good().fg);
}

#[test]
fn without_colours_sizes_have_lines_of_their_own() {
    let mut bench = Bench::example(80, 24);
    bench.app.state.theme.colours = Colours::None;
    let screen = bench.press("0<Tab>").screen();
    let key = |size: &str| {
        let line = screen.lines().find(|line| line.contains(size)).expect("in the key");
        line.chars().skip(2).take(4).collect::<String>()
    };
    let mut lines = [key(" S "), key("▸M "), key(" L ")].to_vec();
    lines.dedup();
    assert_eq!(lines.len(), 3, "{screen}");
}

#[test]
fn the_filter_narrows_levels_and_quantities() {
    let mut bench = Bench::example(80, 24);
    bench.press("0/chest<Enter>");
    assert_eq!(card_levels(&bench.app.state), ["chest"]);
    let names: Vec<String> = quantities_shown(&bench.app.state).into_iter().map(|row| row.name).collect();
    assert_eq!(names, ["mean gap, chest", "half chest"]);
    assert!(bench.status().contains("filter /chest/"), "{}", bench.status());
}

#[test]
fn copies_are_tables() {
    let copied = |keys: &str| match Bench::example(80, 24).press(keys).asked().as_slice() {
        [Effect::Copy(text)] => text.clone(),
        other => panic!("{other:?}"),
    };
    let card = copied("0y");
    assert_eq!(card.lines().count(), 7);
    let hip = "hip\t1004.0\t40.0\t120.0\t-30.0\t-70.0\t30.0\t-10.0\t90.0\t0.0";
    assert_eq!(card.lines().nth(5), Some(hip));
    let sizes = copied("0<Tab><Tab>y");
    assert_eq!(sizes.lines().nth(1), Some("hem, front over back\t−5\t+13\t+31"));
}

#[test]
fn a_study_without_ease_says_so() {
    let mut bench = Bench::example(80, 24);
    bench.press("0");
    let mut data = bench.app.state.data.clone().expect("read");
    let empty = FitCard { sizes: vec![], ..card("i") };
    data.worn = Some(GarmentWorn { card: empty, simulator: None, sizes: vec![] });
    bench.app.update(Message::Data(data));
    assert!(bench.screen().contains("no ease is known yet"), "{}", bench.screen());
    let mut bench = Bench::new(80, 24, fixture::empty());
    assert!(bench.press("0<Tab>vjl").screen().contains("no study yet"));
}
