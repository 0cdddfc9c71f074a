//! Studies through the real program: results, cache, crashes, workers, report.

use std::process::Stdio;

use super::fit_report;
use super::program::{DRAPED, Place, draped};
use super::report::numbers_are_those_of_the_views;

/// Contract columns of the views.
const VIEWS: [(&str, &str); 8] = [
    (
        "v_jobs",
        "job_id study garment size subject simulator status attempts error queued_at started_at finished_at wall_ms",
    ),
    (
        "v_chi",
        "study garment size subject simulator stage measurement_no measurement kind is_free_edge is_controlled l2d_mm
        l3d_mm chi",
    ),
    (
        "v_metrics",
        "study garment size subject simulator n e_chi sd_chi ei max_abs_error vertices faces iterations residual
        converged penetration_max_mm seam_gap_max_mm wall_ms",
    ),
    (
        "v_ease",
        "study garment size subject level pattern_girth_mm body_girth_mm ease_mm fit_class undersized borderline",
    ),
    ("v_pair", "study garment size subject fit_class ease_mm ei_fem ei_hybrid d_ei"),
    (
        "v_recommendation",
        "study garment fit_class recommended basis verdict rule_says effect ci_low ci_high n_subjects reason",
    ),
    ("v_published", "garment size l2d_mm l3d_mm chi"),
    ("v_provenance", "job_id input_hash program_version git_commit git_dirty machine seed"),
];

#[test]
fn a_study_is_run_and_its_results_keep_the_contract() {
    let said = &draped().said;
    assert!(said.out.contains("light m, fem: chi = L3D / L2D") && said.out.contains("Neck Opening"), "{}", said.out);
    assert!(said.err.contains("2 jobs, 2 to run, 0 up to date"), "{}", said.err);
    results_keep_the_contract(&Place::draped());
}

#[test]
fn two_workers_give_the_same_bits_as_one() {
    let lengths = |place: &Place| place.sql("SELECT garment, size, measurement_no, l3d_mm FROM v_chi ORDER BY 1, 2, 3");
    let other = Place::new();
    other.study(&DRAPED);
    other.toile("run . --workers 2 --no-report").ends_with(0);
    assert_eq!(lengths(&other), lengths(&Place::draped()));
}

/// Every view has its columns, and the results are numbers that can be.
fn results_keep_the_contract(place: &Place) {
    for (view, columns) in VIEWS {
        let columns = columns.split_whitespace().collect::<Vec<_>>().join(", ");
        place.write("q.sql", format!("SELECT {columns} FROM {view}"));
        place.toile("sql -f q.sql").ends_with(0);
    }
    assert_eq!(place.one("SELECT count(*) FROM v_metrics WHERE converged AND residual <= 0.01 AND n = 9"), "2");
    assert_eq!(place.one("SELECT count(*) FROM v_metrics WHERE seam_gap_max_mm = 0"), "2");
    assert_eq!(place.one("SELECT count(*) FROM v_chi WHERE l2d_mm > 0 AND l3d_mm > 0"), "18");
    let off = "SELECT count(*) FROM v_chi AS c JOIN v_published AS p ON p.garment = 'male_tshirt'
        AND p.size = c.size AND p.measurement_no = c.measurement_no WHERE abs(c.l2d_mm - p.l2d_mm)";
    assert_eq!(place.one(&format!("{off} > 0.1")), "0");
    assert_ne!(place.one(&format!("{off} <= 0.1")), "0");
    let wrong = "SELECT count(*) FROM v_metrics AS m WHERE abs(ei -
        (SELECT avg(abs(chi - 1)) FROM v_chi AS c WHERE c.job_id = m.job_id)) > 1e-9";
    assert_eq!(place.one(wrong), "0");
}

/// The report stands alone: pictures in it, no script, nothing loaded.
#[test]
fn the_report_is_self_contained_and_has_the_numbers_of_the_views() {
    let place = &Place::draped();
    let path = draped().said.out.lines().find_map(|line| line.strip_prefix("report: ")).expect("the report's path");
    // Of one simulator the report opens with the fit; the comparison lies beside it.
    let path = &path.replace("index.html", "compare.html");
    let page = std::fs::read_to_string(place.path(path)).expect("the page is there");
    assert!(page.trim_end().ends_with("</html>") && page.contains("coarse"), "a whole page");
    assert!(page.contains("data:image/"), "pictures are in the page");
    let without_names = page.replace("http://www.w3.org/", "");
    for forbidden in ["<script", "http://", "https://", "<link", "@import", "src=\"/", "javascript:"] {
        assert!(!without_names.contains(forbidden), "the report holds {forbidden}");
    }
    numbers_are_those_of_the_views(place, &page);
    let fit = path.replace("compare.html", "index.html");
    let fit = std::fs::read_to_string(place.path(&fit)).expect("the fit report is there");
    fit_report::numbers_are_those_of_the_views(place, &fit);
}

/// The one size there is, and how it sits at every level that it covers; nobody else's.
#[test]
fn a_size_is_advised() {
    let place = Place::draped();
    let cards = place.toile("fit . --subject ii --json").ends_with(0).json();
    let cards = cards.as_array().expect("cards");
    assert!(!cards.is_empty() && cards.iter().all(|card| card["subject"] == "ii"), "{cards:?}");
    let size = &cards[0]["sizes"][0];
    assert!(size["size"] == "m" && size["place"] == 1, "{size:?}");
    let levels: Vec<&str> =
        size["levels"].as_array().expect("levels").iter().filter_map(|l| l["level"].as_str()).collect();
    assert!(["across_shoulder", "chest", "waist", "hip"].iter().all(|level| levels.contains(level)), "{levels:?}");
    let told = place.toile("fit . --subject ii").ends_with(0).out;
    assert!(told.contains(" on ii (regular fit): wear m: "), "{told}");
    assert!(place.toile("fit . --subject vii").ends_with(2).err.contains("no subject `vii`"));
    let explained = place.toile("recommend . --explain").ends_with(0).out;
    assert!(explained.contains("by the rule") && explained.contains("6 subjects with this fit"), "{explained}");
}

/// One result or several, from any side, in any cloth; what cannot be drawn says why.
#[test]
fn pictures_are_made_to_order() {
    let place = Place::draped();
    let stripes = image::RgbImage::from_fn(8, 4, |x, _| image::Rgb(if x < 4 { [200, 30, 30] } else { [230, 60, 60] }));
    stripes.save(place.path("stripes.png")).expect("a folder to write to");
    let drawn = |arguments: &str| {
        place.toile(&format!("render {arguments} --width 60 --height 80 -o p.png")).ends_with(0);
        std::fs::read(place.path("p.png")).expect("it is there")
    };
    let picture = |arguments: &str| image::load_from_memory(&drawn(arguments)).expect("a picture").to_rgb8();
    let plain = picture("1");
    assert_eq!(plain.dimensions(), (60, 80));
    let sheet = picture("1 2 --view front,back");
    assert!(sheet.width() > 120 && sheet.height() > 160, "{:?}", sheet.dimensions());
    let red = |picture: &image::RgbImage| picture.pixels().filter(|p| p[0] > p[1].saturating_add(40)).count();
    let [all, sleeve] =
        ["stripes.png@30", "sleeve_left=stripes.png@30"].map(|cloth| red(&picture(&format!("1 --cloth {cloth}"))));
    assert!(red(&plain) == 0 && 0 < sleeve && 3 * sleeve < all, "{all} red pixels, {sleeve} on a sleeve");
    for other in ["--turn 30", "--view close-up", "--zoom 200", "--cloth twill", "--skin #dcb094", "--map stretch"] {
        assert_ne!(picture(&format!("1 {other}")), plain, "{other}");
    }
    let turning = drawn("1 --turntable 5");
    let frames = turning.windows(8).find(|bytes| bytes.starts_with(b"acTL")).expect("an animation")[7];
    assert_eq!(frames, 5);

    let refused = |arguments: &str, says: &str| {
        let said = place.toile(&format!("render {arguments} -o q.png")).ends_with(2);
        assert!(said.err.contains(says) && !place.path("q.png").exists(), "{arguments}: {}", said.err);
    };
    refused("1 --cloth hood=twill", "no piece `hood`; there are: ");
    refused("1 --cloth nowhere.png", "nowhere.png");
    refused("1 --cloth study.toml", "accepted: PNG and JPEG");
    refused("1 --cloth check@-3", "a repeat of -3 mm");
    refused("1 --skin pink", "pink is no colour");
    refused("1 2 --turntable 8", "one job");
    refused("1 --turntable 8 --view back", "cannot be used with");
    refused("99", "no job `99`");
}

#[test]
fn a_second_run_computes_nothing() {
    let place = Place::draped();
    let finished = "SELECT job_id, attempts, started_at, finished_at FROM v_jobs ORDER BY 1";
    let before = place.sql(finished);
    let second = place.toile("run . --why").ends_with(0);
    assert!(second.err.contains("2 jobs, 0 to run, 2 up to date"), "{}", second.err);
    assert!(second.err.contains("light m ii fem: up to date (done)"), "{}", second.err);
    assert_eq!(place.sql(finished), before, "nothing is computed again");
    assert_eq!(second.out, draped().said.out);
}

/// One number of one cloth: its garment is draped anew from the old body, field and mesh; the other is left alone.
#[test]
fn a_changed_number_recomputes_its_drape() {
    let place = Place::draped();
    let study = place.study_file();
    place.write("study.toml", study.replace("density_kg_m2 = 0.1\n", "density_kg_m2 = 0.12\n"));
    let named = "fabric.poplin_light.density_kg_m2: 0.1 -> 0.12";
    let jobs = place.one("SELECT count(*) FROM v_jobs");
    let planned = place.toile("run . --dry-run --json").ends_with(0).json();
    let why = |garment: &str| {
        let row = planned.as_array().expect("rows").iter().find(|row| row["garment"] == garment).expect("planned");
        (row["runs"].clone(), row["why"].as_str().expect("a reason").to_owned())
    };
    assert_eq!(why("light"), ("yes".into(), format!("changed since job 1: {named}")));
    assert_eq!(why("heavy"), ("no".into(), "up to date (done)".into()));
    assert_eq!(place.one("SELECT count(*) FROM v_jobs"), jobs, "planning writes nothing");

    let run = place.toile("run . --why --no-report").ends_with(0);
    assert!(run.err.contains(&format!("light m ii fem: changed since job 1: {named}")), "{}", run.err);
    assert!(run.err.contains("2 jobs, 1 to run, 1 up to date"), "{}", run.err);
    let lines = place.toile("queue log 3 --json").ends_with(0).json();
    let seconds = |k: usize| lines[k]["seconds"].as_f64().expect("a number");
    assert!(seconds(0) <= 0.0 && seconds(1).abs() < 1.0, "queued, then started: {lines}");
    let log = place.toile("queue log 3").ends_with(0).out;
    assert!(log.contains("body from the cache, field from the cache, mesh from the cache, drape made"), "{log}");
    assert_eq!(place.one("SELECT count(*) FROM artefact WHERE kind <> 'drape'"), "4", "body, field, two meshes");

    place.write("study.toml", study);
    let back = place.toile("run . --no-report").ends_with(0);
    assert!(back.err.contains("2 jobs, 0 to run, 2 up to date"), "old results are kept: {}", back.err);
}

#[test]
fn a_quiet_run_of_a_paused_study_says_that_it_waits_and_a_run_tells_its_end() {
    let place = Place::new();
    place.hybrid_study("", &[("tee", 0.1, &["s"])], "");
    place.toile("job handout . -o jobs").ends_with(0);
    place.toile("queue pause coarse").ends_with(0);
    let mut command = place.command("run . --no-report --quiet");
    let mut run = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
    let mut told = String::new();
    let mut errors = std::io::BufReader::new(run.stderr.take().expect("piped"));
    std::io::BufRead::read_line(&mut errors, &mut told).expect("a line");
    assert!(told.contains("coarse is paused: its jobs wait until `toile queue resume coarse`"), "{told}");
    place.toile("queue resume coarse").ends_with(0);
    assert!(run.wait().expect("ours").success());
    let again = place.toile("run . --no-report").ends_with(0);
    assert!(again.err.contains("coarse: 1 up to date before") && !again.err.contains('\x07'), "{}", again.err);
}

#[test]
fn what_only_tells_makes_no_database() {
    let place = Place::new();
    for command in ["info", "queue ls", "sql times", "export 1 -o a.glb"] {
        let mut command = place.command(command);
        let output = command.env("TOILE_DB", place.path("typo/x.sqlite")).output().expect("it starts");
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && told.contains("there is no such file"), "{told}");
        assert!(!place.path("typo").exists(), "{command:?}");
    }
}

#[test]
fn a_file_is_studied_twice_and_bare_names_are_those_of_the_project() {
    let place = Place::new();
    place.draft();
    let new = |rest: &str| place.toile(&format!("study new {rest} --pattern patterns/tshirt-m.dxf --subject male-ii"));
    new("mine").ends_with(0);
    let again = new("other").ends_with(0);
    assert!(again.err.contains("style tshirt-m is in the catalogue already, of the same files"), "{}", again.err);
    assert!(place.path("mine/study.toml").exists() && place.path("other/study.toml").exists());
    place.write("patterns/tshirt-m.dxf", std::fs::read(place.path("patterns/tshirt-s.dxf")).expect("drafted"));
    let refused = new("third").ends_with(2);
    assert!(refused.err.contains("a style `tshirt-m` already, of other files; --as NAME"), "{}", refused.err);
    new("third --as small").ends_with(0);
    std::fs::create_dir(place.path("studies")).expect("writable");
    let told = new("fourth --as small").ends_with(0);
    assert!(place.path("studies/fourth/study.toml").exists(), "{}", told.err);
    assert!(told.err.contains("`toile run studies/fourth` runs it"), "{}", told.err);
    let told = place.toile("subject rm male-ii").ends_with(2);
    assert!(told.err.contains("jobs of") && told.err.contains("`toile queue cancel --study"), "{}", told.err);
}

/// Sections of the results: by level and height, as a table, as JSON and drawn.
#[test]
fn sections_are_cut() {
    let place = Place::draped();
    let told = place.toile("section . --garment light --json").ends_with(0).json();
    let levels: Vec<&str> = told.as_array().expect("sections").iter().filter_map(|one| one["level"].as_str()).collect();
    assert!(["chest", "waist", "hip"].iter().all(|level| levels.contains(level)), "{levels:?}");
    let chest = &told[levels.iter().position(|level| *level == "chest").expect("a chest")]["cloth"][0];
    assert_eq!((chest["size"].as_str(), chest["simulator"].as_str()), (Some("m"), Some("fem")));
    for (angle, gap) in place
        .sql("SELECT angle_deg, gap_mm FROM v_section WHERE garment = 'light' AND level = 'chest'")
        .iter()
        .filter_map(|line| line.split_once(','))
    {
        let number = (angle.parse::<f64>().expect("degrees") / 10.0).round() as usize;
        let cut = chest["gaps"][number][1].as_f64();
        assert_eq!(
            cut.map(|gap| (1e3 * gap).round()),
            gap.parse::<f64>().ok().map(|gap| (1e3 * gap).round()),
            "{angle}"
        );
    }
    let table = place.toile("section . --at-mm 1000").ends_with(0).out;
    assert!(table.contains("light on ii: gap from skin to cloth") && table.contains("1000 mm"), "{table}");
    place.toile("section . --garment light --level waist -o waist.svg").ends_with(0);
    assert!(std::fs::read_to_string(place.path("waist.svg")).expect("drawn").contains("light on ii: waist"));
    let check = |arguments: &str, says: &str| {
        let err = place.toile(arguments).ends_with(2).err;
        assert!(err.contains(says), "{arguments}: {err}");
    };
    check("section . --level ankle", "no level `ankle`; there are: chest, underbust");
    check("section . --at-mm 2500", "accepted: heights from 0 to 1690 mm");
    check("section . --level waist -o waist.svg", "2 sections are asked for");
    check("section . --garment light --level waist -o waist.gif", "accepted: X.svg or X.png");
    check("section . --sim hybrid", "has no drape of what is asked for");
}
