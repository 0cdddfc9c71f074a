//! Patterns as other kinds of file, with what lies beside them.

use serde_json::Value;

use super::program::Place;

/// The drafted front with a grade point at each of two corners, as the sample size.
fn sample(place: &Place) -> String {
    let text = std::fs::read_to_string(place.path("patterns/tshirt-m.dxf")).expect("drafted");
    let lines: Vec<&str> = text.lines().collect();
    // The first two turn points are POINTs of layer 2: the coordinates stand four and six lines below.
    let points = lines.windows(8).filter(|tags| tags[1] == "POINT" && tags[3] == "2").take(2);
    let graded = points.enumerate().map(|(k, tags)| {
        format!(
            "  0\r\nTEXT\r\n  8\r\n2\r\n 10\r\n{}\r\n 20\r\n{}\r\n 40\r\n3\r\n  1\r\n# {}\r\n",
            tags[5],
            tags[7],
            k + 1
        )
    });
    let graded: String = graded.collect();
    text.replacen("  0\r\nENDBLK\r\n", &format!("{graded}  0\r\nENDBLK\r\n"), 1)
}

const RULES: &str = "UNITS: METRIC\nNUMBER OF SIZES: 3\nSIZE LIST: S M L\nSAMPLE SIZE: M\n\
RULE: DELTA 1\n-10.0, 0.0  0.0, 0.0  10.0, 0.0\nRULE: DELTA 2\n-10.0, 0.0  0.0, 0.0  10.0, 0.0\nEND\n";

fn perimeters(report: &Value) -> Vec<(String, f64)> {
    let piece = |piece: &Value| {
        (piece["size"].as_str().unwrap_or_default().to_owned(), piece["perimeter_mm"].as_f64().expect("a number"))
    };
    report["pieces"].as_array().expect("pieces").iter().map(piece).collect()
}

#[test]
fn features_and_conversions_come_back_as_the_same_file() {
    let place = Place::new();
    place.draft();
    let drawn = std::fs::read(place.path("patterns/tshirt-m.dxf")).expect("drafted");
    place.toile("pattern features patterns/tshirt-m.dxf -o t.features.json").ends_with(0);
    let printed = place.toile("pattern features patterns/tshirt-m.dxf").ends_with(0).json();
    assert_eq!(
        printed["pieces"][0]["corners"].as_array().map(Vec::len),
        printed["pieces"][0]["edges"].as_array().map(Vec::len)
    );
    for from in ["patterns/tshirt-m.dxf", "t.features.json"] {
        place.toile(&format!("pattern convert {from} -o out/again.dxf")).ends_with(0);
        assert_eq!(std::fs::read(place.path("out/again.dxf")).expect("written"), drawn, "{from}");
    }
    place.toile("pattern convert patterns/tshirt-m.dxf --seams patterns/tshirt.seams.toml -o t.json").ends_with(0);
    place.toile("pattern check t.json").ends_with(0);
    let pieces = place.toile("pattern inspect t.json --json").ends_with(0).json();
    assert_eq!(perimeters(&pieces[0]).len(), 4);
    assert!(place.toile("pattern convert patterns/tshirt-m.dxf -o t.json").ends_with(2).err.contains("--seams"));
    assert!(place.toile("pattern convert patterns/tshirt-m.dxf -o t.png").ends_with(2).err.contains("found `.png`"));
}

#[test]
fn a_sample_size_and_a_grade_rule_table_make_a_nest() {
    let place = Place::new();
    place.draft();
    let sample = sample(&place);
    // The other pieces have no grade points.
    place.write("sample.dxf", &sample);
    place.write("style.rul", RULES);
    let said = place.toile("pattern inspect sample.dxf --rul style.rul --json").ends_with(2);
    let report = &said.json()[0];
    assert_eq!(report["refused"].as_array().map(Vec::len), Some(4), "{}", said.err);
    let sizes: Vec<String> = perimeters(report).into_iter().map(|(size, _)| size).collect();
    assert_eq!(sizes, ["S", "M", "M", "M", "L"]);
    place.write("style.rul", RULES.replace("METRIC", "ELLS"));
    let said = place.toile("pattern inspect sample.dxf --rul style.rul").ends_with(2);
    assert!(said.err.contains("style.rul, line 1: found unit `ELLS`"), "{}", said.err);
}

#[test]
fn a_table_in_centimetres_under_metric_is_said_and_may_be_stated() {
    let place = Place::new();
    place.draft();
    place.write("sample.dxf", sample(&place));
    place.write("style.rul", RULES);
    place.write("cm.rul", RULES.replace("10.0", "1.0"));
    let read = |arguments: &str| {
        let said = place.toile(&format!("pattern inspect sample.dxf {arguments} --json"));
        (perimeters(&said.json()[0]), said.err)
    };
    let (millimetres, said) = read("--rul style.rul");
    assert!(!said.contains("style.rul: "), "{said}");
    let (_, said) = read("--rul cm.rul");
    assert!(
        said.contains("cm.rul: its longest step is 1.0 mm from one size to the next in mm, which is hardly a grade"),
        "{said}"
    );
    for arguments in ["--rul cm.rul --rul-unit cm", "--rul style.rul --rul-unit mm"] {
        assert_eq!(read(arguments), (millimetres.clone(), read("--rul style.rul").1), "{arguments}");
    }
    let (_, said) = read("--rul cm.rul --unit cm");
    assert!(said.contains("taken as cm, as those of the pattern are, and go up to 10.0 mm"), "{said}");
    assert!(place.toile("pattern inspect sample.dxf --rul-unit cm").ends_with(2).err.contains("--rul"));
}

#[test]
fn a_table_beside_the_pattern_tells_its_pieces() {
    let place = Place::new();
    place.draft();
    place.write("pieces.csv", "piece,quantity,material\nfront,1,Twill\nsleeve,\"1,1\",Rib\n");
    let told = place.toile("pattern features patterns/tshirt-m.dxf --info pieces.csv").ends_with(0).json();
    let texts = told["pieces"][0]["information"]["texts"].as_array().expect("texts").clone();
    assert!(texts.contains(&serde_json::json!(["material", "Twill"])), "{texts:?}");
    assert_eq!(told["pieces"][2]["information"]["quantity"], "1,1");
    place.write("pieces.csv", "piece,quantity\nhood,1\n");
    let said = place.toile("pattern inspect patterns/tshirt-m.dxf --info pieces.csv").ends_with(2);
    assert!(said.err.contains("pieces.csv, row 2, column `piece`: found piece `hood`"), "{}", said.err);
}

/// The drafted T-shirt in three sizes as one file of features, under other names and in another order.
fn nest(place: &Place, sizes: [(&str, &str); 3]) {
    let mut all: Option<Value> = None;
    for (drawn, size) in sizes {
        let mut one = place.toile(&format!("pattern features patterns/tshirt-{drawn}.dxf")).ends_with(0).json();
        for piece in one["pieces"].as_array_mut().expect("pieces") {
            piece["information"]["size"] = size.into();
        }
        let pieces = one["pieces"].as_array().cloned().expect("pieces");
        match all.as_mut().and_then(|all| all["pieces"].as_array_mut()) {
            Some(known) => known.extend(pieces),
            None => all = Some(one),
        }
    }
    place.write("nest.json", all.expect("three sizes").to_string());
}

#[test]
fn sizes_go_from_the_smallest_to_the_largest_in_whatever_order_a_file_has_them() {
    let place = Place::new();
    place.draft();
    nest(&place, [("l", "12"), ("s", "8"), ("m", "10")]);
    place.toile("pattern convert nest.json -o nest.dxf").ends_with(0);
    let sheet = place.toile("pattern pom nest.dxf --seams patterns/tshirt.seams.toml --json").ends_with(0).json();
    assert_eq!(sheet["sizes"], serde_json::json!(["8", "10", "12"]));
    let steps = sheet["points"].as_array().expect("points").iter().filter_map(|point| point["step_mm"].as_f64());
    assert!(steps.into_iter().all(|step| step > -1e-6), "every step makes wider or longer: {sheet}");
    for (standard, head) in [("aama", "ANSI/AAMA VERSION: 1.0.0"), ("astm", "ASTM/D13Proposal 1 Version: D 6673-04")] {
        place.toile(&format!("pattern convert nest.dxf --with-rul --standard {standard} -o style.dxf")).ends_with(0);
        let rules = std::fs::read_to_string(place.path("style.rul")).expect("written");
        assert!(rules.starts_with(head) && rules.contains("\r\nSIZE LIST: 8 10 12\r\n"), "{rules}");
        assert!(rules.contains("\r\nGRADE RULE TABLE: style\r\n"), "{rules}");
        let drawn = std::fs::read_to_string(place.path("style.dxf")).expect("written");
        assert_eq!(drawn.matches("\r\nGrade Rule Table: style\r\n").count(), 1);
        place.toile("pattern convert style.dxf --rul style.rul --with-rul -o again.dxf").ends_with(0);
        let again = std::fs::read_to_string(place.path("again.dxf")).expect("written");
        assert!(again.contains("Grade Rule Table: again") && !again.contains("Grade Rule Table: style"));
    }
    place.toile("subject add f --sex f --stature-mm 1650 --chest-girth-mm 860").ends_with(0);
    place.toile("study new mine --pattern nest.dxf --subject f").ends_with(0);
    let study = std::fs::read_to_string(place.path("mine/study.toml")).expect("written");
    let places = ["\"8\"", "\"10\"", "\"12\""].map(|size| study.find(size).unwrap_or_else(|| panic!("{study}")));
    assert!(places.is_sorted(), "{study}");
    // A study that lists them otherwise is answered in their order too.
    let [first, _, last] = ["8", "10", "12"].map(|size| format!("\"{size}\""));
    let turned = study.replace(&first, "\"?\"").replace(&last, &first).replace("\"?\"", &last);
    place.write("mine/study.toml", turned);
    let said = place.toile("fit mine --subject f");
    let columns = ["8 ease_mm", "10 ease_mm", "12 ease_mm"].map(|size| said.out.find(size));
    assert!(columns.is_sorted() && columns[0].is_some(), "{}", said.out);
}
