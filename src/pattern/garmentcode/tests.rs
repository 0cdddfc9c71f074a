use std::collections::BTreeMap;

use super::*;
use crate::draft::Model;
use crate::{MeshQuality, dxf};
use geom::units::from_mm;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/patterns/garmentcode");

/// Reads a folder beside the checkout, by garment. Without the folder there are none.
fn specifications() -> BTreeMap<String, Specification> {
    let mut all = BTreeMap::new();
    for folder in [FOLDER.to_owned(), format!("{FOLDER}/upstream")] {
        let Ok(entries) = std::fs::read_dir(&folder) else {
            eprintln!("skipped: no {folder}");
            continue;
        };
        for entry in entries {
            let path = entry.expect("a folder entry").path();
            let name = path.file_name().expect("a file").to_string_lossy().into_owned();
            if let Some(garment) = name.strip_suffix("_specification.json") {
                let bytes = std::fs::read(&path).expect("readable");
                all.insert(garment.to_owned(), read(&bytes, &name).unwrap_or_else(|error| panic!("{error}")));
            }
        }
    }
    all
}

#[test]
fn every_stitch_pairs_the_edges_of_the_table_at_their_lengths() {
    let all = specifications();
    if all.is_empty() {
        return;
    }
    let table = std::fs::read_to_string(format!("{FOLDER}/stitch_lengths.csv")).expect("the table");
    let mut rows = 0;
    for row in table.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>()) {
        let specification = &all[row[0]];
        let stitch = specification.stitches[row[1].parse::<usize>().expect("a number")];
        for (k, side) in stitch.sides.into_iter().enumerate() {
            assert_eq!(specification.pieces[side.piece].block, row[2 + 2 * k], "{row:?}");
            assert_eq!(side.edge.to_string(), row[3 + 2 * k], "{row:?}");
            let expect: f64 = row[6 + k].parse().expect("a length");
            let found = mm(specification.edges[side.piece][side.edge].length());
            assert!((found - expect).abs() < 1e-4 * expect + 0.005, "{row:?}: {found:.3} mm");
        }
        assert_eq!(stitch.same_direction, row[8] == RIGHT_WRONG, "{row:?}");
        rows += 1;
    }
    assert_eq!(rows, table.lines().count() - 1);
    assert_eq!(all.len(), 13, "{:?}", all.keys());
}

#[test]
fn the_drawing_beside_a_specification_has_the_same_pieces() {
    for (garment, specification) in specifications() {
        let name = format!("{garment}.dxf");
        let Ok(bytes) = std::fs::read(format!("{FOLDER}/{name}")) else { continue };
        let drawing = dxf::read(&bytes, &name, None).expect("it reads");
        assert_eq!(drawing.pieces.len(), specification.pieces.len());
        for piece in &specification.pieces {
            let drawn = drawing.pieces.iter().find(|drawn| drawn.block == piece.block).expect("the same names");
            for (found, expect) in [(piece.perimeter_m(), drawn.perimeter_m()), (piece.area_m2(), drawn.area_m2())] {
                assert!((found / expect - 1.0).abs() < 1e-3, "{garment} {}: {found} for {expect}", piece.block);
            }
            assert_eq!(piece.turn_points.len(), drawn.turn_points.len(), "{garment} {}", piece.block);
        }
    }
}

#[test]
fn specifications_become_styles_that_mesh() {
    for (garment, specification) in specifications() {
        let style = specification.style();
        assert_eq!(style.name, garment);
        let meshed = style.mesh(from_mm(30.0)).unwrap_or_else(|error| panic!("{garment}: {error}"));
        let quality = MeshQuality::of(&meshed).expect("it has triangles");
        assert!(quality.min_angle_deg > 1.0, "{garment}: {quality:?}");
        assert_eq!(meshed.seams.len(), specification.stitches.len());
    }
}

fn there_and_back(style: &Style) -> Specification {
    let bytes = serde_json::to_vec(&document(style)).expect("it is JSON");
    read(&bytes, "back_specification.json").unwrap_or_else(|error| panic!("{}: {error}", style.name))
}

#[test]
fn drafted_styles_come_back_from_the_format_as_they_were() {
    for model in Model::ALL {
        let draft = &model.drafts()[0];
        let style = Style::read(&draft.pieces, model.seams(), "seams").expect("a style");
        let back = there_and_back(&style);
        assert_eq!(back.pieces.len(), style.pieces.len());
        for (piece, found) in style.pieces.iter().zip(&back.pieces) {
            let outline = piece.outline();
            let area = signed_area(&outline);
            assert!((found.area_m2() / area - 1.0).abs() < 1e-4, "{model:?} {}", piece.id);
            let perimeter = geom::polyline::perimeter(&outline);
            assert!((found.perimeter_m() / perimeter - 1.0).abs() < 1e-4, "{model:?} {}", piece.id);
        }
        // Every seam is still sewn over its whole length, edge by edge of equal lengths.
        let sewn = |style: &Style| -> f64 {
            style.seams.iter().flat_map(|seam| &seam.a).map(|&edge| style.edge(edge).line.length()).sum()
        };
        assert!((sewn(&back.style()) / sewn(&style) - 1.0).abs() < 1e-4, "{model:?}");
        for stitch in &back.stitches {
            let [a, b] = stitch.sides.map(|side| back.edges[side.piece][side.edge].length());
            assert!((mm(a) - mm(b)).abs() < 0.5, "{model:?}: {a} and {b}");
        }
    }
}

#[test]
fn read_specifications_come_back_stitch_by_stitch() {
    for (garment, specification) in specifications() {
        let back = there_and_back(&specification.style());
        assert!(back.stitches.len() >= specification.stitches.len(), "{garment}");
        for (piece, found) in specification.pieces.iter().zip(&back.pieces) {
            assert_eq!(piece.block, found.block);
            assert!((found.area_m2() / piece.area_m2() - 1.0).abs() < 1e-3, "{garment} {}", piece.block);
        }
    }
}

#[test]
fn divided_seams_keep_their_direction() {
    let bow = r#","curvature":{"type":"circle","params":[5.1,0,1]}"#;
    for (flag, is_same) in [("", false), (r#","right_wrong""#, true)] {
        let stitch = format!(r#"[{{"panel":"p","edge":0}},{{"panel":"p","edge":2}}{flag}]"#);
        let text =
            square(bow, &stitch, "100").replace(r#"{"endpoints":[2,3]}"#, &format!(r#"{{"endpoints":[2,3]{bow}}}"#));
        let back = there_and_back(&read(text.as_bytes(), "bows").expect("it reads").style());
        let parts = back.stitches.len();
        assert!(parts >= 2 && back.edges[0].len() == 2 * parts + 2, "{parts} parts");
        for stitch in &back.stitches {
            let [a, b] = stitch.sides.map(|side| side.edge);
            // Parts of the first bow, the straight side, parts of the second bow.
            let partner = if is_same { a } else { parts - 1 - a };
            assert_eq!((b, stitch.same_direction), (parts + 1 + partner, is_same));
        }
    }
}

/// Square of 10 cm with one edge as given, sewn to its opposite.
fn square(edge: &str, stitch: &str, units: &str) -> String {
    let edges =
        format!(r#"{{"endpoints":[0,1]{edge}}},{{"endpoints":[1,2]}},{{"endpoints":[2,3]}},{{"endpoints":[3,0]}}"#);
    format!(
        r#"{{"pattern":{{"panels":{{"p":{{"translation":[0,0,0],"rotation":[0,0,0],
        "vertices":[[0,0],[10,0],[10,10],[0,10]],"edges":[{edges}]}}}},"stitches":[{stitch}]}},
        "properties":{{"curvature_coords":"relative","units_in_meter":{units}}}}}"#
    )
}

#[test]
fn curves_are_what_the_format_says() {
    let check = |edge: &str, expect_mm: f64, bulge_mm: f64| {
        let read = read(square(edge, "", "100").as_bytes(), "square").unwrap_or_else(|error| panic!("{edge}: {error}"));
        let line = &read.edges[0][0];
        // The chords of an arc that is nearly a full circle are a little shorter than the arc.
        assert!((mm(line.length()) / expect_mm - 1.0).abs() < 6e-4, "{edge}: {}", mm(line.length()));
        assert!((mm(line.at(0.5 * line.length()).y) - bulge_mm).abs() < 0.02, "{edge}");
    };
    let half_turn = 50.0 * std::f64::consts::PI;
    check("", 100.0, 0.0);
    check(r#","curvature":[0.5,-0.2]"#, 102.606, -10.0);
    check(r#","curvature":{"type":"quadratic","params":[[0.5,-0.2]]}"#, 102.606, -10.0);
    check(r#","curvature":{"type":"circle","params":[5,0,1]}"#, half_turn, -50.0);
    check(r#","curvature":{"type":"circle","params":[5,0,0]}"#, half_turn, 50.0);
    let long = 2.0 * half_turn * 10.0 / 5.0 - 2.0 * 100.0 * 0.5_f64.asin();
    check(r#","curvature":{"type":"circle","params":[10,1,1]}"#, long, -(100.0 + 100.0 * 0.75_f64.sqrt()));
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let sewn = r#"[{"panel":"p","edge":1},{"panel":"p","edge":3}]"#;
    let check = |text: &str, place: &str| {
        let error = read(text.as_bytes(), "bad.json").expect_err("it is wrong");
        assert!(error.place.contains(place) && error.file == "bad.json", "{error}");
    };
    assert!(read(square("", sewn, "100").as_bytes(), "good").is_ok());
    check("{", "the file");
    check(&square("", sewn, "0"), "units_in_meter");
    check(&square("", sewn, "100").replace("relative", "absolute"), "curvature_coords");
    check(&square("", sewn, "100").replace("[1,2]", "[1,9]"), "edge 1");
    check(&square("", sewn, "100").replace("[1,2]", "[2,1]"), "edge 0");
    check(&square("", sewn, "100").replace("[10,10]", "[1e300,10]"), "panel `p`");
    check(&square("", sewn, "100").replace("[10,10]", "[2,-5]"), "panel `p`");
    check(&square(r#","curvature":{"type":"circle","params":[4,0,1]}"#, sewn, "100"), "edge 0");
    check(&square(r#","curvature":{"type":"spiral","params":[4]}"#, sewn, "100"), "the file");
    check(&square("", &format!("{sewn},{sewn}"), "100"), "stitch 1");
    check(&square("", r#"[{"panel":"q","edge":1},{"panel":"p","edge":3}]"#, "100"), "stitch 0");
    check(&square("", r#"[{"panel":"p","edge":1}]"#, "100"), "stitch 0");
}

proptest::proptest! {
    #[test]
    fn no_mutation_makes_the_reader_panic(at in 0.0..1.0_f64, byte: u8, cut: bool) {
        let mut bytes = square(r#","curvature":{"type":"circle","params":[7,0,1]}"#, "", "100").into_bytes();
        let place = (at * bytes.len() as f64) as usize;
        bytes[place] = byte;
        if cut {
            bytes.truncate(place);
        }
        let _ = read(&bytes, "mutated");
    }
}
