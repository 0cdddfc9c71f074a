//! What the fit is told by, and that its page says the same as the code.

use crate::program::{Place, shared};
use toile::fit::target::TARGETS;
use toile::pattern::Handle;
use toile::pattern::pom::Point;

#[test]
fn the_page_on_fit_has_every_point_and_every_target() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/fit.md")).expect("in the repository");
    for point in Point::ALL {
        let row = format!("| `{}` | {} |", point.as_str(), point.definition());
        assert!(page.contains(&row), "docs/fit.md lacks: {row}");
    }
    for row in TARGETS {
        let eases = row.eases_mm().map(|[least, most]| format!("{least} to {most}")).join(" | ");
        assert!(page.contains(&format!(" | {eases} |")), "docs/fit.md lacks {}: {eases}", row.level);
    }
}

#[test]
fn the_page_on_handles_has_them_all() {
    let page =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/handles.md")).expect("in the repository");
    for handle in Handle::ALL {
        let name = format!("`{}`", handle.as_str());
        let is_row =
            |line: &str| line.starts_with('|') && line.split('|').nth(1).is_some_and(|cell| cell.contains(&name));
        assert!(page.lines().any(is_row), "docs/handles.md lacks {name}");
    }
}

#[test]
fn a_sheet_is_written_with_its_steps() {
    let place = Place::new();
    place.draft();
    let rows =
        place.toile("pattern pom patterns/tshirt-s.dxf --seams patterns/tshirt.seams.toml --json").ends_with(0).json();
    let points = rows["points"].as_array().expect("points");
    let chest = points.iter().find(|point| point["point"] == "half_chest").expect("a chest");
    assert!((chest["length_mm"].as_f64().expect("a number") - 487.05).abs() < 0.1, "{chest}");
    for (file, starts) in [("sheet.csv", &b"point,"[..]), ("sheet.xlsx", &b"PK"[..]), ("sheet.svg", &b"<svg"[..])] {
        let command = format!("pattern pom patterns/tshirt-s.dxf --seams patterns/tshirt.seams.toml -o {file}");
        place.toile(&command).ends_with(0);
        let bytes = std::fs::read(place.path(file)).expect("it is written");
        assert!(bytes.starts_with(starts), "{file}");
    }
    let wrong = place.toile("pattern pom patterns/tshirt-s.dxf --seams patterns/tshirt.seams.toml -o sheet.pdf");
    assert!(wrong.ends_with(2).err.contains("accepted: X.csv, X.xlsx or X.svg"));
    let Some(nest) = shared("patterns/freesewing/teagan_nest_aama-inch.dxf") else {
        eprintln!("skipped: no ../shared");
        return;
    };
    let rows = place.toile(&format!("pattern pom {} --json", nest.display())).ends_with(0).json();
    assert_eq!(rows["sizes"].as_array().map(Vec::len), Some(8));
    let widths = rows["points"].as_array().expect("points").iter().filter(|point| point["point"] == "neck_width");
    let steps: Vec<f64> = widths.filter_map(|point| point["step_mm"].as_f64()).collect();
    assert!(steps.len() == 7 && steps.iter().all(|step| *step > 9.0), "{steps:?}");
}

#[test]
fn a_garment_says_its_own_target() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["m"])]);
    let file = place.path("study.toml");
    let text = std::fs::read_to_string(&file).expect("the study's file");
    let with = |line: &str| {
        let text = text.replacen("[[garment]]", &format!("[[garment]]\n{line}"), 1);
        std::fs::write(&file, text).expect("writable");
    };
    with("intended_fit = \"slim\"\ntarget_ease_mm = { chest = [1, 2] }");
    let cards = place.toile("fit . --json").ends_with(0).json();
    let card = &cards[0];
    assert_eq!(card["intended"], "slim", "{card}");
    let levels = card["sizes"][0]["levels"].as_array().expect("levels");
    let chest = levels.iter().find(|level| level["level"] == "chest").expect("a chest");
    assert_eq!(chest["target_mm"], serde_json::json!([1.0, 2.0]), "{chest}");
    for (line, says) in [
        ("intended_fit = \"snug\"", "accepted: compression, slim, regular, loose"),
        ("target_ease_mm = { chest = [9, 2] }", "least and greatest ease in millimetres"),
        ("target_ease_mm = { ankle = [1, 2] }", "target_ease_mm at `ankle`"),
        ("target_ease_mm = 3", "`target_ease_mm` is no table"),
    ] {
        with(line);
        let err = place.toile("fit .").ends_with(2).err;
        assert!(err.contains(says), "{line}: {err}");
    }
}

#[test]
fn a_size_is_altered_until_it_fits_and_its_file_is_what_was_promised() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["s"])]);
    let asks = "--target chest=150..170 --target hip=100..110";
    // What a cutter does without drawing the pattern anew does not reach as far.
    let bounded = place.toile("alter . --size s --target chest=300..320").ends_with(3);
    assert!(bounded.err.contains("another size is needed"), "{}", bounded.err);
    let found = place.toile(&format!("alter . --size s {asks} --limit-mm 60 -o out --json")).ends_with(0).json();
    let moves = found["moves"].as_array().expect("moves");
    assert!(moves.iter().any(|one| one["handle"] == "chest" && one["amount_mm"].as_f64() > Some(10.0)), "{moves:?}");
    for level in found["levels"].as_array().expect("levels") {
        let ease = |key: &str| level[key].as_f64().expect("an ease");
        // The curves of the file keep their points: each of four edges lies within 0.2 mm.
        assert!((ease("promised_mm") - ease("achieved_mm")).abs() < 1.0, "{level}");
        let within = |low: f64, high: f64| (low..=high).contains(&ease("achieved_mm"));
        match level["level"].as_str() {
            Some("chest") => assert!(ease("before_mm") < 150.0 && within(150.0, 170.0), "{level}"),
            Some("hip") => assert!(ease("before_mm") < 100.0 && within(100.0, 110.0), "{level}"),
            _ => {}
        }
    }
    let checked = place.toile("pattern check out/tee-s-ii.dxf --seams out/tee-s-ii.seams.toml");
    checked.ends_with(0);
    let asked = place.toile("alter . --size s --move waist=-5 --json").ends_with(0).json();
    assert_eq!(asked["moves"].as_array().map(Vec::len), Some(1), "{asked}");
    let check = |arguments: &str, says: &str| {
        let err = place.toile(arguments).ends_with(2).err;
        assert!(err.contains(says), "{arguments}: {err}");
    };
    check("alter . --size xl", "no size `xl`; there are: s");
    check("alter . --size s --target collar=1..2", "no target `collar`; there are: across_shoulder, chest");
    check("alter . --size s --move collar=3", "no handle `collar`");
    check("alter . --size s --move inseam", "accepted: HANDLE=MM");
    check("alter . --size s --target hip=9", "accepted: NAME=LEAST..MOST");
    assert!(place.toile("alter . --size s --target chest=600..610 --limit-mm 20").ends_with(3).out.contains("missed"));
}

#[test]
fn a_drape_is_altered_until_it_hangs_as_asked_and_all_sizes_alike() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["s", "m"])]);
    let listed = place.toile("alter . --size m --list --json").ends_with(0).json();
    let stands = |name: &str| {
        let all = listed.as_array().expect("a list");
        all.iter().find(|one| one["name"] == name).and_then(|one| one["value"].as_f64()).expect("it stands")
    };
    let over = stands("hem_front_over_back");
    let asked = format!("hem_front_over_back={}..{}", over - 30.0, over - 10.0);
    // Lengths alone: so coarse a drape answers to a sleeve by chance.
    let stay = "chest waist hem shoulder_slope forward_shoulder shoulder_length front_width back_width upper_back bust \
        front_neck_depth back_neck_depth neck_width armhole_depth bicep cuff cap_height sleeve_length";
    let stay: String = stay.split(' ').map(|handle| format!(" --without {handle}")).collect();
    let wide: String = ["chest", "hip", "waist", "upper_arm", "across_shoulder"]
        .iter()
        .map(|level| format!(" --target {level}=0..300"))
        .collect();
    let command = format!("alter . --size m --target {asked}{wide}{stay} --nest --standard astm -o out --json");
    let found = place.toile(&command).ends_with(0).json();
    let reading = &found["readings"][0];
    let value = |key: &str| reading[key].as_f64().expect("a reading");
    assert!((value("before") - over).abs() < 1e-9 && value("achieved") < over - 9.0, "{reading}");
    assert!((value("promised") - value("achieved")).abs() < 10.0, "{reading}");
    let lengths = ["front_length", "back_length"];
    let moves = found["moves"].as_array().expect("moves");
    assert!(moves.iter().any(|one| lengths.iter().any(|name| one["handle"] == *name)), "{moves:?}");
    let nest = place.toile("pattern check out/tee-nest-ii.dxf --seams out/tee-m-ii.seams.toml").ends_with(0).out;
    assert!(["s", "m"].iter().all(|size| nest.contains(size)), "{nest}");
}
