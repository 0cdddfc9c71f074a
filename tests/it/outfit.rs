//! Garments over each other through the real program.

use super::program::Place;

#[test]
fn an_outfit_is_draped_as_a_whole_and_each_layer_has_its_result() {
    let place = Place::draped();
    let outfit = "\n[[outfit]]\nname = \"two\"\nlayers = [\"light\", \"heavy\"]\nsizes = [\"m\", \"l\"]\n";
    let study = place.study_file() + outfit;
    place.write("study.toml", &study);

    let run = place.toile("run . --workers 2 --no-report").ends_with(0);
    assert!(run.err.contains("4 jobs, 2 to run"), "{}", run.err);
    let layers = "SELECT group_concat(layer || ' ' || garment || ' ' || size, '; ') FROM (SELECT * FROM v_outfit ORDER BY layer)";
    assert_eq!(place.one(layers), "1 two light m; 2 two heavy l");
    let faults = "SELECT count(*) FROM v_metrics WHERE NOT converged OR self_crossings > 0 OR penetration_max_mm > 0.5";
    assert_eq!(place.one(faults), "0");
    // Over the inner one a tape reads more than on the skin.
    let girth = |garment: &str| -> f64 {
        let of = format!("SELECT body_girth_mm FROM v_ease WHERE garment = '{garment}' AND level = 'chest'");
        place.one(&of).parse().expect("a number")
    };
    assert!(girth("two heavy") > girth("heavy") + 3.0, "{} and {}", girth("two heavy"), girth("heavy"));
    assert_eq!(girth("two light"), girth("light"));

    // The picture of the outer layer shows the inner one too.
    let job = place.one("SELECT job_id FROM v_outfit WHERE layer = 2");
    let alone = place.one("SELECT job_id FROM v_jobs WHERE garment = 'heavy'");
    let drawn = |job: &str| {
        place.toile(&format!("render {job} --map gap --width 60 --height 80 -o p.png")).ends_with(0);
        std::fs::read(place.path("p.png")).expect("it is there")
    };
    assert_ne!(drawn(&job), drawn(&alone));

    // Nothing is draped twice, and what changes a layer changes the others.
    assert!(place.toile("run . --why --no-report").ends_with(0).err.contains("4 jobs, 0 to run"));
    let thicker = study.replace("density_kg_m2 = 0.2", "density_kg_m2 = 0.25");
    place.write("study.toml", thicker);
    let dry = place.toile("run . --dry-run").ends_with(0);
    assert_eq!(dry.out.matches("up to date").count(), 1, "{}", dry.out);
}

#[test]
fn several_patterns_are_tried_on_over_each_other() {
    let place = Place::new();
    place.draft();
    place.write("ii.toml", "sex = \"male\"\nstature_mm = 1690\nchest_girth_mm = 863\n");
    let shirt = |size: &str| format!("--pattern patterns/tshirt-{size}.dxf --seams patterns/tshirt.seams.toml");
    let both = format!("--edge-mm 60 {} {} -o worn", shirt("m"), shirt("l"));
    let tried = place.toile(&format!("try --body ii.toml {both} --json")).ends_with(0);
    let layers: serde_json::Value = serde_json::from_str(&tried.out).expect("JSON");
    let sizes: Vec<&str> = layers.as_array().expect("a list").iter().filter_map(|one| one["size"].as_str()).collect();
    assert_eq!(sizes, ["M", "L"]);
    let mesh = std::fs::read_to_string(place.path("worn/drape.obj")).expect("it is there");
    assert!(["o body", "o layer_1", "o layer_2"].iter().all(|name| mesh.contains(name)));

    let refused = |arguments: &str, says: &str| {
        let said = place.toile(&format!("try --body ii.toml {arguments}")).ends_with(2);
        assert!(said.err.contains(says), "{arguments}: {}", said.err);
    };
    let patterns = "--pattern patterns/tshirt-m.dxf --pattern patterns/tshirt-l.dxf";
    refused(&format!("{patterns} --seams patterns/tshirt.seams.toml"), "one --seams for 2 patterns");
    refused(&format!("{both} --size m --size l --size s"), "3 times --size for 2 patterns");
    refused(&format!("{both} --repeat 2"), "--repeat is for one garment");
    refused(&format!("{both} --sim hybrid"), "Hybrid-GS drapes one garment at a time");
}
