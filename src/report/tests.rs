use super::data::*;
use super::{Purpose, ReportError, chart, files, html};
use fit::measure::Chi;
use fit::{Basis, Cuts, Ease, Finding, FitClass, Simulator};
use render::{Rgb, Scale, png};

fn ease(pattern_girth_m: f64, body_girth_m: f64) -> Ease {
    let cuts = Cuts::default();
    let ease_m = pattern_girth_m - body_girth_m;
    Ease {
        level: "chest".into(),
        pattern_girth_m,
        body_girth_m,
        class: cuts.classify(ease_m),
        is_held: true,
        borderline: cuts.is_borderline(ease_m),
    }
}

fn measured(no: u32, name: &str, l2d_m: f64, chi: f64, free_edge: bool) -> Measured {
    Measured {
        name: name.into(),
        chi: Chi { no, l2d_m, l3d_m: l2d_m * chi },
        closed: name.ends_with("girth"),
        free_edge,
        controlled: false,
        published_chi: None,
        misprint: None,
    }
}

fn picture(caption: &str) -> Picture {
    let pixel = image::RgbaImage::from_pixel(4, 5, image::Rgba([80, 160, 120, 255]));
    Picture {
        bytes: png(&pixel).unwrap(),
        file: format!("pictures/{caption}.png"),
        alt: format!("Tee, {caption} view"),
        caption: caption.into(),
    }
}

fn run(subject: &str, simulator: Simulator, neck: f64) -> TryOn {
    TryOn {
        garment: "Tee".into(),
        case: "Tee".into(),
        repeat: 1,
        size: "S".into(),
        subject: subject.into(),
        simulator,
        fabric: "jersey".into(),
        outcome: Outcome::Converged,
        ease: Some(ease(1.004, if subject == "i" { 0.931 } else { 1.020 })),
        measured: vec![measured(1, "hem girth", 0.9741, 1.002, false), measured(6, "neck girth", 0.5601, neck, true)],
        vertices: 5334,
        faces: 10500,
        iterations: 84,
        residual: 0.0083,
        residuals: (0..20).map(|i| (i, 10f64.powf(1.0 - 0.1 * f64::from(i)))).collect(),
        penetration_max_m: 0.0003,
        seam_gap_max_m: 0.0,
        wall_s: 3.4,
        views: ["front", "side", "back", "quarter"].map(picture).into(),
        maps: vec![FieldMap {
            picture: picture("stretch"),
            scale: Scale::diverging(1.0, 0.1, "stretch across the grain", ""),
        }],
    }
}

fn sample() -> ReportData {
    ReportData {
        title: "Men's tops".into(),
        question: "How true do T-shirts stay?".into(),
        made: "toile 0.1.0".into(),
        subjects: SubjectTable {
            columns: vec![Column { name: "chest girth".into(), unit: "mm".into(), decimals: 1 }],
            rows: [("i", 931.0), ("ii", 1020.0)]
                .map(|(name, girth)| Subject { name: name.into(), note: "man".into(), values: vec![Some(girth)] })
                .into(),
        },
        drawings: vec![Drawing {
            garment: "Tee".into(),
            size: "S".into(),
            svg: "<svg xmlns='http://www.w3.org/2000/svg'><script>alert(1)</script></svg>".into(),
        }],
        ease: vec![EaseMatrix {
            garment: "Tee".into(),
            sizes: vec!["S".into()],
            subjects: vec!["i".into(), "ii".into(), "iii".into()],
            cells: vec![vec![Some(ease(1.004, 0.931)), Some(ease(1.004, 1.020)), None]],
        }],
        runs: vec![run("i", Simulator::Fem, 1.04), run("ii", Simulator::Fem, 1.06)],
        raw: vec![RawLink { href: "chi.csv".into(), label: "every measurement".into() }],
        ..ReportData::default()
    }
}

fn words(page: &str) -> String {
    let body = page.split_once("<body>").unwrap().1;
    let mut text = String::new();
    let mut rest = body;
    while let Some((before, after)) = rest.split_once('<') {
        text += before;
        let (tag, tail) = after.split_once('>').unwrap();
        let name = tag.trim_start_matches('/').split(' ').next().unwrap();
        let inline = ["b", "span", "small", "em", "strong", "i", "code"].contains(&name);
        let cell = ["td", "th", "dd", "dt"].contains(&name);
        text += if inline {
            " "
        } else if cell {
            " | "
        } else {
            "\n"
        };
        rest = if name == "svg" && !tag.starts_with('/') { tail.split_once("</svg>").unwrap().1 } else { tail };
    }
    let line = |l: &str| {
        l.split_whitespace().filter(|w| *w != "|" || l.contains(char::is_alphanumeric)).collect::<Vec<_>>().join(" ")
    };
    let lines = text.lines().map(line).map(|l| l.replace("| |", "|").trim_matches([' ', '|']).to_owned());
    lines.filter(|l| !l.is_empty()).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_small_page_reads_well() {
    insta::assert_snapshot!(words(&html(&sample()).unwrap()));
}

#[test]
fn the_page_needs_nothing_else() {
    let page = html(&sample()).unwrap();
    for forbidden in ["<script", "http://", "https://", "<link", "@import", "onload"] {
        let found = page.replace("http://www.w3.org/2000/svg", "").contains(forbidden);
        assert!(!found, "{forbidden} on the page");
    }
    let addresses = |key: &str| page.matches(key).count();
    assert_eq!(addresses("src=\""), addresses("src=\"data:image/"), "every picture is inside the page");
    assert_eq!(addresses("<img "), addresses(" alt=\""), "every picture has words");
    assert_eq!(addresses("<th>"), 0, "every header says what it heads");
    assert_eq!(addresses("<th "), addresses("scope=\""));
}

#[test]
fn charts_are_files_beside_the_page_and_its_links_lead_to_them() {
    let files = files(&sample(), Purpose::Compare).unwrap();
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    let page = String::from_utf8(files[0].1.clone()).unwrap();
    let links: Vec<&str> = page.split("href=\"charts/").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(names[0] == "index.html" && links.len() > 6, "{names:?} {links:?}");
    assert_eq!(links.len(), names.len() - 1);
    for link in links {
        assert!(names.contains(&format!("charts/{link}").as_str()), "{link} is not among {names:?}");
    }
}

#[test]
fn names_from_outside_are_text_not_markup() {
    let mut data = sample();
    let evil = "<b onload=\"x\">&'";
    data.title = evil.into();
    data.runs[0].subject = evil.into();
    data.runs[0].measured[0].name = evil.into();
    data.runs[1].outcome = Outcome::Failed(evil.into());
    data.runs[0].fabric = evil.into();
    let page = html(&data).unwrap();
    assert!(!page.contains("<b onload"), "markup got through");
    assert!(page.contains("&lt;b onload") || page.contains("&#60;b onload"));
}

#[test]
fn every_fit_class_of_every_garment_has_an_answer() {
    let page = words(&html(&sample()).unwrap());
    for class in [FitClass::Tight, FitClass::Just, FitClass::Loose] {
        assert!(page.contains(&format!("{} fit", class.as_str())), "{}", class.as_str());
    }
    assert_eq!(page.matches("insufficient evidence").count(), 3);
    assert_eq!(html(&sample()).unwrap().matches("data-verdict=\"insufficient_evidence\"").count(), 3);
    assert!(page.contains("Only FEM-GS ran on this fit"));
    let mut data = sample();
    data.verdicts.push(Verdict {
        garment: "Tee".into(),
        class: FitClass::Just,
        recommended: Simulator::Fem,
        basis: Basis::Evidence,
        finding: Finding::Fem,
        effect: Some(-0.021),
        interval: Some((-0.034, -0.012)),
        p_holm: Some(0.031),
        subjects: 6,
        reason: "FEM wins.".into(),
        would_settle: "Three subjects more.".into(),
    });
    let page = words(&html(&data).unwrap());
    assert!(page.contains("\u{2212}0.0210 (\u{2212}0.0340 to \u{2212}0.0120)") && page.contains("FEM-GS is truer"));
    assert_eq!(page.matches("insufficient evidence").count(), 2);
}

#[test]
fn repeats_are_compared_where_there_are_some() {
    assert!(!html(&sample()).unwrap().contains("Repeatability"));
    let mut data = sample();
    let again = |from: &TryOn, garment: &str, repeat: u32, chi: f64| {
        let mut run = TryOn { garment: garment.into(), repeat, ..from.clone() };
        run.measured[0].chi.l3d_m = run.measured[0].chi.l2d_m * chi;
        run
    };
    let [first, second] = [data.runs[0].clone(), data.runs[1].clone()];
    data.runs.push(again(&first, "Tee seed=1", 1, 1.0044));
    data.runs.push(again(&first, "Tee seed=2", 1, 0.9980));
    data.runs.push(again(&second, "Tee", 2, 1.002));
    let page = words(&html(&data).unwrap());
    assert!(page.contains("2 cases were simulated more than once") && page.contains("1 of them gave"), "{page}");
    // Chi 1.0044 less 0.9980; EI (0.0044 + 0.04) / 2 and (0.002 + 0.04) / 2.
    assert!(page.contains("Tee, S on i, jersey | FEM-GS | 3 | 0.0064 | #1 hem girth | 0.0210 | 0.0222"), "{page}");
    assert!(page.contains("Tee, S on ii, jersey | FEM-GS | 2 | 0.0000"), "{page}");
    assert!(page.contains("ii, repeat 2"), "{page}");
}

#[test]
fn failed_and_unconverged_runs_are_shown() {
    let mut data = sample();
    data.runs[0].outcome = Outcome::NotConverged;
    data.runs[1].outcome = Outcome::Failed("the mesh folded over".into());
    data.runs[1].measured.clear();
    data.runs[1].views.clear();
    let page = words(&html(&data).unwrap());
    assert!(page.contains("Tee S, subject i, FEM-GS, jersey did not converge (residual 0.8 % of a vertex"));
    assert!(page.contains("Tee S, subject ii, FEM-GS, jersey failed: the mesh folded over"));
    assert!(page.contains("No result: the mesh folded over"));
    assert!(html(&ReportData::default()).unwrap().contains("No runs yet."));
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let mut data = sample();
    data.raw[0].href = "javascript:alert(1)".into();
    assert!(matches!(html(&data), Err(ReportError::Link(_))));
    let mut data = sample();
    data.runs[0].views[0].bytes = b"GIF89a".to_vec();
    assert!(matches!(html(&data), Err(ReportError::PictureFormat(_))));
}

#[test]
fn charts_of_different_names_are_different_files() {
    let names =
        [("上衣", "M"), ("衬衫", "M"), ("tee", "M"), ("tee+", "M"), ("Tee", "M"), ("tee", "../2X"), ("tee", "..:2X")];
    let runs_of = |(garment, size): &(&str, &str)| {
        ["i", "ii"].map(|subject| TryOn {
            garment: (*garment).into(),
            size: (*size).into(),
            ..run(subject, Simulator::Fem, 1.04)
        })
    };
    let data = ReportData { runs: names.iter().flat_map(runs_of).collect(), ..sample() };
    let files = files(&data, Purpose::Compare).unwrap();
    let paths: std::collections::BTreeSet<String> = files.iter().map(|(path, _)| path.to_lowercase()).collect();
    assert_eq!(paths.len(), files.len(), "{paths:?}");
    let page = String::from_utf8(files[0].1.clone()).unwrap();
    for (path, _) in &files[1..] {
        assert!(path.starts_with("charts/") && !path.contains("..") && path.matches('/').count() == 1, "{path}");
        assert_eq!(page.matches(&format!("href=\"{path}\"")).count(), 1, "{path}");
    }
    for path in ["charts/上衣-size-m-ei.png", "charts/tee+-size-m-ei.svg", "charts/tee-size-2x-ei-2.svg"] {
        assert!(paths.contains(path), "{path} of {paths:?}");
    }
}

#[test]
fn a_chart_of_many_measurements_and_subjects_is_a_smaller_picture() {
    let mut many = run("i", Simulator::Fem, 1.04);
    many.measured = (1..=60).map(|no| measured(no, "seam", 0.5, 1.04, false)).collect();
    let runs = vec![&many; 12];
    let labels: Vec<String> = (1..=12).map(|k| format!("subject {k}")).collect();
    let png = chart::chi_chart("Tee", &runs, &labels).unwrap().png().unwrap();
    let picture = image::load_from_memory(&png).unwrap();
    let (width, height) = (picture.width(), picture.height());
    assert!(height > 7900 && height <= 8192 && width < 1600, "{width} x {height}");
}

#[test]
fn charts_place_marks_where_values_are() {
    let runs = [run("i", Simulator::Fem, 1.04), run("i", Simulator::Hybrid, 0.90)];
    let runs: Vec<&TryOn> = runs.iter().collect();
    let labels = ["i".to_owned(), "i".to_owned()];
    let chi = chart::chi_chart("Tee", &runs, &labels).unwrap();
    assert!(chi.svg().contains("#6 neck girth") && chi.svg().contains("\n1.00\n"), "{}", chi.svg());
    let ei = chart::metric_chart("Tee", chart::Metric::Ei, &runs, &labels).unwrap();
    // EI (0.002 + 0.04) / 2 and (0.002 + 0.10) / 2, in the bars' own labels.
    assert!(ei.svg().contains("0.021") && ei.svg().contains("0.051"), "{}", ei.svg());
    let count = |picture: &image::RgbaImage, c: Rgb| picture.pixels().filter(|p| p.0[..3] == [c.0, c.1, c.2]).count();
    let picture = image::load_from_memory(&ei.png().unwrap()).unwrap().to_rgba8();
    let [fem, hybrid] = [Simulator::Fem, Simulator::Hybrid].map(|s| count(&picture, super::theme::simulator(s)) as f64);
    // Beyond the square of the key, the bars' areas are as their values.
    let square = 28.0 * 28.0;
    let ratio = (hybrid - square) / (fem - square);
    assert!((ratio - 0.051 / 0.021).abs() < 0.1, "{ratio}");
    let residual = chart::residual_chart("Tee", &runs, &labels).unwrap();
    assert!(residual.svg().contains("<polyline") && !residual.png().unwrap().is_empty());
    let all: Vec<TryOn> = runs.iter().map(|run| (*run).clone()).collect();
    let ease = chart::ease_chart(&all, &Cuts::default()).unwrap().unwrap();
    assert!(ease.svg().contains("S i") && ease.svg().contains("just | loose"), "{}", ease.svg());
    assert_eq!(ease.address("svg"), "charts/ei-against-ease.svg");
    assert!(chart::time_chart(&[]).unwrap().is_none());
    let mean = chart::mean_sd_chart("Tee", &runs).unwrap();
    assert!(mean.alt().contains("2 measurements over 2 runs"), "{}", mean.alt());
}

/// The sample with a fit sheet of the first run: two open comments, and one that is met.
fn fitted() -> ReportData {
    let comment = |number: i64, side: &'static str, place: &str, spot: Option<[f64; 2]>| FitComment {
        number,
        side,
        place: place.into(),
        spot,
        said: "tight by 32 mm".into(),
        severity: "major",
        cause: "pattern too narrow there".into(),
        action: String::new(),
        owner: String::new(),
        state: "round 1, open".into(),
    };
    let sheet = FitSheet {
        garment: "Tee".into(),
        subject: "i".into(),
        intended: "regular".into(),
        verdict: "wear S".into(),
        drape: String::new(),
        sizes: vec![FitSize { size: "S".into(), is_to_wear: true, fits: true, words: "as meant".into() }],
        simulator: Some(Simulator::Fem),
        tables: vec![],
        sections: vec![],
        comments: vec![
            comment(1, "front", "chest", Some([0.5, 0.4])),
            comment(2, "back", "neck", Some([0.5, 0.1])),
            comment(3, "front", "lining", None),
        ],
        round: "Round 1, not signed; 3 open of 3.".into(),
        called: "S".into(),
    };
    let mut data = sample();
    for picture in &mut data.runs[0].views {
        picture.file = format!("pictures/job-1-{}-plain.jpg", picture.caption);
    }
    data.fit.sheets = vec![sheet];
    data.assumed = vec![Assumed {
        garment: "Tee".into(),
        told: vec!["sewn 10 mm inside the cut line".into()],
        left_out: vec![Fact { name: "POCKET, COLLAR".into(), value: "a drape does without them".into() }],
    }];
    data
}

#[test]
fn comments_are_called_out_on_the_picture_of_their_side() {
    let page_of = |data: &ReportData| String::from_utf8(files(data, Purpose::Fit).unwrap()[1].1.clone()).unwrap();
    let page = page_of(&fitted());
    let shots: Vec<&str> =
        page.split("<div class=\"shot\">").skip(1).map(|rest| rest.split_once("</div>").unwrap().0).collect();
    let [front, side, back] = shots[..] else { panic!("{} pictures", shots.len()) };
    let check = |shot: &str, view: &str, numbers: &str| {
        assert!(shot.contains(&format!("alt=\"Tee, {view} view\"")), "{view}: {shot}");
        let label = shot.split_once("aria-label=\"").map(|(_, rest)| rest.split_once('"').unwrap().0);
        assert_eq!(label, (!numbers.is_empty()).then_some(numbers), "{view}");
    };
    check(front, "front", "Comments 1");
    check(side, "side", "");
    check(back, "back", "Comments 2");
    assert!(words(&page).contains("3 | front: lining"), "a comment without a place is in the table");
    let mut met = fitted();
    met.fit.sheets[0].comments.iter_mut().for_each(|comment| comment.spot = None);
    assert!(!page_of(&met).contains("class=\"shot\""), "no callout, no picture for it");
}

#[test]
fn a_gap_map_of_another_simulator_says_so() {
    let check = |girth_m: f64, has_both: bool, expect: &[&str]| {
        let mut data = fitted();
        let drape = |simulator: Simulator| {
            let mut run = data.runs[0].clone();
            (run.simulator, run.ease) = (simulator, Some(ease(1.004, girth_m)));
            let map = |name: &str| FieldMap {
                picture: Picture { file: format!("pictures/{}-front-{name}.png", simulator.as_str()), ..picture(name) },
                scale: Scale::diverging(0.0, 1.0, name, ""),
            };
            run.maps = ["stretch", "gap"].map(map).into();
            run
        };
        data.runs = Simulator::ALL[..if has_both { 2 } else { 1 }].iter().map(|one| drape(*one)).collect();
        let page = words(&String::from_utf8(files(&data, Purpose::Fit).unwrap()[1].1.clone()).unwrap());
        let captions = page.lines().filter(|line| line.ends_with("stretch") || line.ends_with("gap"));
        assert_eq!(captions.collect::<Vec<_>>(), expect, "{girth_m}: {page}");
    };
    check(1.020, true, &["stretch", "Hybrid-GS: gap"]);
    check(1.020, false, &["stretch", "gap"]);
    check(0.931, true, &["stretch", "gap"]);
}

#[test]
fn both_pages_say_what_is_assumed_and_left_off() {
    for (name, page) in files(&fitted(), Purpose::Fit).unwrap().into_iter().take(2) {
        let page = words(&String::from_utf8(page).unwrap());
        assert!(page.contains("Assumed and left off"), "{name}");
        let row = "Tee | sewn 10 mm inside the cut line | POCKET, COLLAR : a drape does without them";
        assert!(page.contains(row), "{name}: {page}");
    }
    assert!(!html(&sample()).unwrap().contains("left off"));
}
