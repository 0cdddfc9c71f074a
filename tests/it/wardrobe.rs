//! Every garment of a folder on every body of another: `toile audit garments`.

use super::program::Place;

/// A man with room in a drafted T-shirt M.
const SLIM: &str = "sex = \"male\"\nstature_mm = 1690\nweight_kg = 53\nchest_girth_mm = 863\nwaist_girth_mm = 782\n\
                    hip_girth_mm = 914\n";

#[test]
fn all_is_dressed_in_all_and_what_cannot_be_is_left_out_with_its_reason() {
    let place = Place::new();
    place.toile("pattern draft tshirt -o drafts").ends_with(0);
    let shirt = std::fs::read(place.path("drafts/tshirt-m.dxf")).expect("drafted");
    place.write("garments/shirt.dxf", &shirt);
    place.write("garments/torn.dxf", &shirt[..shirt.len() / 3]);
    place.write("bodies/slim.toml", SLIM);
    place.write("bodies/nobody.toml", "sex = \"male\"\nstature_mm = 17\n");

    let command = "audit garments garments --bodies bodies --sim hybrid --workers 1 -o tried --json";
    let said = place.toile(command).ends_with(0);
    let document = said.json();
    assert_eq!(document["study"], "tried");
    let [job] = &document["jobs"].as_array().expect("jobs")[..] else { panic!("one job: {document}") };
    assert_eq!((&job["garment"], &job["subject"], &job["status"]), (&"shirt".into(), &"slim".into(), &"done".into()));
    assert!(job["faults"].as_array().is_some_and(Vec::is_empty) && job["ei"].as_f64().is_some_and(|ei| ei < 0.05));
    let tally = &document["simulators"][0];
    assert_eq!((&tally["simulator"], &tally["good"], &tally["ended"]), (&"hybrid".into(), &1.into(), &1.into()));
    let left: Vec<&str> =
        document["left_out"].as_array().expect("a list").iter().filter_map(|f| f["file"].as_str()).collect();
    assert_eq!(left.len(), 2, "{document}");
    assert!(left[0].ends_with("nobody.toml") && left[1].ends_with("torn.dxf"), "{left:?}");
    assert!(said.err.contains("torn.dxf: left out: ") && said.err.contains("1 jobs, 1 to run"), "{}", said.err);
    let written = std::fs::read(place.path("tried/audit.json")).expect("written");
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&written).expect("JSON"), document);

    // What is done is not done again; a table of pairs says who wears what, and may name only what is there.
    let again = place.toile(command).ends_with(0);
    assert!(again.err.contains("1 jobs, 0 to run, 1 up to date"), "{}", again.err);
    place.write("pairs.csv", "garment;body\r\n\r\nshirt;fat\r\n");
    let unknown = place.toile(&format!("{command} --pairs pairs.csv")).ends_with(2);
    assert!(unknown.err.contains("pairs.csv:3: no body `fat`"), "{}", unknown.err);
    place.write("pairs.csv", "garment,who\nshirt,fat\n");
    let unknown = place.toile(&format!("{command} --pairs pairs.csv")).ends_with(2);
    assert!(unknown.err.contains("pairs.csv:1: no column `body`; accepted: "), "{}", unknown.err);
    let empty = place.toile("audit garments bodies --bodies bodies -o empty").ends_with(2);
    assert!(empty.err.contains("none of them a pattern"), "{}", empty.err);
}
