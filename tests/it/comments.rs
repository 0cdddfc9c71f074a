//! Rounds of fitting: what a round asks, an alteration mends and the next round meets.

use crate::program::Place;

#[test]
fn what_one_round_asked_is_met_in_the_next_once_the_pattern_is_altered() {
    let place = Place::new();
    place.study(&[("tee", 0.1, &["s"])]);
    let text = place.study_file();
    let aimed = text.replace("name = \"tee\"\n", "name = \"tee\"\ntarget_ease_mm = { chest = [155, 170] }\n");
    place.write("study.toml", &aimed);
    let first = place.toile("comment round . --json").ends_with(0).json();
    let asked = first.as_array().expect("comments");
    let chest = asked.iter().find(|one| one["quantity"] == "chest tight").expect("a comment on the chest");
    let number = chest["number"].as_i64().expect("a number");
    assert_eq!((chest["severity"].as_str(), chest["status"].as_str()), (Some("major"), Some("open")), "{chest}");
    assert!(chest["said"].as_str().is_some_and(|said| said.starts_with("chest tight by 44 mm")), "{chest}");
    assert!(chest["action"].as_str().is_some_and(|action| action.starts_with("chest +")), "{chest}");
    let again = place.toile("comment round .").ends_with(0);
    assert!(again.err.contains("nothing has changed since the last round"), "{}", again.err);

    place.toile("comment add . --at back:neck gapes --severity major --action darts").ends_with(0);
    let own = asked.len() as i64 + 1;
    place.toile(&format!("comment set . {own} --owner ann --status closed")).ends_with(0);
    let unknown = place.toile("comment set . 99 --owner ann").ends_with(2).err;
    assert!(unknown.contains("no comment `99`; there are: 1"), "{unknown}");
    let wrong = place.toile("comment add . --at collar gapes").ends_with(2).err;
    assert!(wrong.contains("accepted: front:PLACE"), "{wrong}");

    // Words of a fitter outlast a round that measures the same again.
    place.toile(&format!("comment set . {number} --text mine")).ends_with(0);
    place.write("study.toml", aimed.replace("[155, 170]", "[150, 170]"));
    let second = place.toile("comment round .").ends_with(0);
    assert!(second.err.contains("round 2, size s"), "{}", second.err);
    let kept = place.sql(&format!("SELECT said, status FROM v_comment WHERE number = {number}"));
    assert_eq!(kept, ["mine,open"]);

    place.toile("alter . --size s -o out").ends_with(0);
    for (from, to) in
        [("out/tee-s-ii.dxf", "patterns/tshirt-s.dxf"), ("out/tee-s-ii.seams.toml", "patterns/tshirt.seams.toml")]
    {
        std::fs::copy(place.path(from), place.path(to)).expect("altered");
    }
    place.toile("comment round .").ends_with(0);
    let signed = place.toile("comment sign . --by ann").ends_with(0).err;
    assert!(signed.contains("round 3 of tee on ii is signed by ann"), "{signed}");
    let told = place
        .sql(&format!("SELECT status, met_in, owner FROM v_comment WHERE number IN ({number}, {own}) ORDER BY number"));
    assert_eq!(told, ["met,3,", "closed,,ann"]);
}
