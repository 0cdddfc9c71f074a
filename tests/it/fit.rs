//! What the fit is told by, and that its page says the same as the code.

use crate::program::{Place, shared};
use toile::fit::target::TARGETS;
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
