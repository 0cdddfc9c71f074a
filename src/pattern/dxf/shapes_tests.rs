//! Curves, pieces without blocks, blocks in blocks, versions of DXF.

use std::f64::consts::PI;

use dxf::entities::{Entity, EntityType, LwPolyline, ModelPoint};
use dxf::enums::AcadVersion;
use dxf::{Drawing, LwPolylineVertex, Point};

use super::*;
use crate::inspect::FileReport;
use crate::piece::Piece;

/// Takes `code value` lines, separated by `;`.
fn tags(text: &str) -> String {
    let tag = |tag: &str| {
        let (code, value) = tag.trim().split_once(' ').unwrap_or((tag.trim(), ""));
        format!("{code}\n{value}\n")
    };
    text.split(';').filter(|part| !part.trim().is_empty()).map(tag).collect()
}

fn sections(blocks: &str, entities: &str) -> Vec<u8> {
    let text = format!(
        "0 SECTION; 2 BLOCKS; {blocks} 0 ENDSEC; 0 SECTION; 2 ENTITIES; 0 TEXT; 8 1; 10 0; 20 0; 40 3; 1 Units: METRIC; {entities} 0 ENDSEC; 0 EOF"
    );
    tags(&text).into_bytes()
}

fn block(name: &str, entities: &str) -> String {
    format!("0 BLOCK; 8 0; 2 {name}; 70 0; 10 0; 20 0; {entities} 0 ENDBLK; 8 0;")
}

fn line(layer: &str, [x1, y1, x2, y2]: [f64; 4]) -> String {
    format!("0 LINE; 8 {layer}; 10 {x1}; 20 {y1}; 11 {x2}; 21 {y2};")
}

fn lwpolyline(layer: &str, vertices: &[(f64, f64, f64)]) -> String {
    let vertex = |(x, y, bulge): &(f64, f64, f64)| format!("10 {x}; 20 {y}; 42 {bulge};");
    format!("0 LWPOLYLINE; 8 {layer}; 90 {}; 70 1; {}", vertices.len(), vertices.iter().map(vertex).collect::<String>())
}

const SQUARE: [(f64, f64, f64); 4] = [(0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (100.0, 100.0, 0.0), (0.0, 100.0, 0.0)];

fn moved(by: f64) -> Vec<(f64, f64, f64)> {
    SQUARE.iter().map(|&(x, y, bulge)| (x + by, y, bulge)).collect()
}

fn read_all(bytes: &[u8]) -> PatternFile {
    read(bytes, "a.dxf", None).unwrap_or_else(|error| panic!("{error}"))
}

fn only(entities: &str) -> (Piece, Vec<String>) {
    let mut file = read_all(&sections(&block("P", entities), "0 INSERT; 8 1; 2 P; 10 0; 20 0;"));
    assert!(file.refused.is_empty() && file.pieces.len() == 1, "{:?} {:?}", file.refused, file.pieces.len());
    (file.pieces.remove(0), file.warnings)
}

#[track_caller]
fn measures(piece: &Piece, perimeter_mm: f64, area_mm2: f64) {
    let (perimeter, area) = (piece.perimeter_m() * 1e3, piece.area_m2() * 1e6);
    assert!((perimeter / perimeter_mm - 1.0).abs() < 5e-5, "perimeter {perimeter} for {perimeter_mm}");
    assert!((area / area_mm2 - 1.0).abs() < 2e-4, "area {area} for {area_mm2}");
}

#[test]
fn curved_outlines_are_flattened_and_it_is_said() {
    let check = |entities: String, perimeter_mm: f64, area_mm2: f64, said: &str| {
        let (piece, warnings) = only(&entities);
        measures(&piece, perimeter_mm, area_mm2);
        assert_eq!(warnings, [format!("block `P`: {said} flattened, chords within 0.01 mm")]);
    };
    let half = PI * 50.0;
    let disc = PI * 2500.0;
    let mut bulged = SQUARE;
    bulged[1].2 = 1.0;
    check(lwpolyline("1", &bulged), 300.0 + half, 10_000.0 + 0.5 * disc, "1 arc");
    bulged[3].2 = -1.0;
    check(lwpolyline("1", &bulged), 200.0 + 2.0 * half, 10_000.0, "2 arcs");
    let vertex = |(x, y, bulge): &(f64, f64, f64)| format!("0 VERTEX; 8 1; 10 {x}; 20 {y}; 42 {bulge};");
    let old = format!("0 POLYLINE; 8 1; 66 1; 70 1; {} 0 SEQEND; 8 1;", bulged.iter().map(vertex).collect::<String>());
    check(old, 200.0 + 2.0 * half, 10_000.0, "2 arcs");
    let three =
        line("1", [0.0, 0.0, 100.0, 0.0]) + &line("1", [0.0, 100.0, 0.0, 0.0]) + &line("1", [100.0, 100.0, 0.0, 100.0]);
    let arc = "0 ARC; 8 1; 10 100; 20 50; 40 50; 50 270; 51 90;";
    check(three.clone() + arc, 300.0 + half, 10_000.0 + 0.5 * disc, "1 arc");
    // Seen from behind: the normal points down, so x is reversed.
    let behind = "0 ARC; 8 1; 10 -100; 20 50; 40 50; 50 90; 51 270; 210 0; 220 0; 230 -1;";
    check(three.clone() + behind, 300.0 + half, 10_000.0 + 0.5 * disc, "1 arc");
    let ellipse =
        "0 ELLIPSE; 8 1; 10 100; 20 50; 30 0; 11 0; 21 50; 31 0; 40 0.5; 41 3.141592653589793; 42 6.283185307179586;";
    // Half the perimeter of an ellipse of half axes 2 and 1 is 4.844224.
    check(three.clone() + ellipse, 300.0 + 25.0 * 4.844_224, 10_000.0 + 0.25 * disc, "1 ellipse");
    let spline = "0 SPLINE; 8 1; 70 8; 71 2; 72 6; 73 3; 74 0; 40 0; 40 0; 40 0; 40 1; 40 1; 40 1; \
                  10 100; 20 0; 30 0; 10 150; 20 50; 30 0; 10 100; 20 100; 30 0;";
    // A parabola of chord 100 and height 25: two thirds of their product.
    let parabola = 25.0 * (2.0_f64.sqrt() + 1.0_f64.asinh()) * 2.0;
    check(three + spline, 300.0 + parabola, 10_000.0 + 100.0 * 25.0 * 2.0 / 3.0, "1 spline");
    check("0 CIRCLE; 8 1; 10 5; 20 5; 40 50;".to_owned(), 2.0 * half, disc, "1 circle");
}

#[test]
fn holes_and_cut_outs_are_kept() {
    let more = "0 CIRCLE; 8 13; 10 20; 20 20; 40 2; 0 POINT; 8 13; 10 50; 20 50; 0 CIRCLE; 8 11; 10 70; 20 70; 40 5; \
                0 HATCH; 8 8; 0 CIRCLE; 8 Construction; 10 0; 20 0; 40 1;";
    let file = read_all(&sections(&block("P", &(lwpolyline("1", &SQUARE) + more)), ""));
    let piece = &file.pieces[0];
    assert_eq!(
        piece.drill_holes.iter().map(|p| (p.x * 1e3, p.y * 1e3)).collect::<Vec<_>>(),
        [(20.0, 20.0), (50.0, 50.0)]
    );
    assert_eq!((piece.cut_outs.len(), piece.internal_lines.len()), (1, 0));
    let unused: Vec<(&str, usize)> = file.unused.iter().map(|(layer, count)| (layer.as_str(), *count)).collect();
    assert_eq!(unused, [("8", 1), ("Construction", 1)]);
}

#[test]
fn what_cannot_be_drawn_on_the_boundary_is_refused_with_its_reason() {
    let check = |entities: &str, expect: &str| {
        let file = read_all(&sections(&block("P", entities), ""));
        assert!(file.pieces.is_empty() && file.refused[0].reason.contains(expect), "{expect}: {:?}", file.refused);
        assert!(file.refused[0].reason.contains("accepted"), "{:?}", file.refused);
    };
    check("0 HATCH; 8 1;", "HATCH on layer 1");
    check("0 POLYLINE; 8 1; 66 1; 70 64; 0 SEQEND; 8 1;", "polygon mesh");
    check("0 SPLINE; 8 1; 71 3; 74 2; 11 0; 21 0; 11 9; 21 9;", "fit points alone");
    check("0 ARC; 8 1; 10 0; 20 0; 40 5; 50 0; 51 90; 210 0; 220 1; 230 1;", "tilted plane");
    check(&(lwpolyline("1", &SQUARE) + &lwpolyline("1", &moved(300.0))), "a second outline");
    check("0 POINT; 8 7; 10 0; 20 0;", "no outline");
}

#[test]
fn a_spline_without_its_knots_is_refused_with_its_line() {
    let spline = "0 SPLINE; 8 1; 71 2; 72 6; 73 3; 10 0; 20 0; 10 1; 20 1; 10 2; 20 0;";
    let error = read(&sections(&block("P", spline), ""), "a.dxf", None).expect_err("no knots");
    assert!(error.line.is_some() && error.found.contains("6 knots"), "{error}");
}

#[test]
fn an_outline_drawn_twice_counts_once() {
    let (piece, warnings) = only(&(lwpolyline("1", &SQUARE) + &lwpolyline("1", &SQUARE)));
    measures(&piece, 400.0, 10_000.0);
    assert!(warnings[0].contains("1 boundary lines are drawn twice"), "{warnings:?}");
}

#[test]
fn pieces_outside_blocks_have_what_lies_within_them() {
    let text = |x: f64, text: &str| format!("0 TEXT; 8 1; 10 {x}; 20 50; 40 3; 1 {text};");
    let point = |layer: &str, x: f64| format!("0 POINT; 8 {layer}; 10 {x}; 20 0;");
    let entities = [
        lwpolyline("1", &SQUARE),
        lwpolyline("1", &moved(200.0)),
        text(50.0, "Sleeve"),
        text(250.0, "Piece Name: Cuff"),
        text(260.0, "Size: 38"),
        point("4", 250.0),
        point("2", 0.0),
        point("2", 100.0),
        line("7", [20.0, 20.0, 20.0, 80.0]),
        line("7", [500.0, 20.0, 500.0, 80.0]),
    ];
    let file = read_all(&sections("", &entities.concat()));
    assert!(file.refused.is_empty(), "{:?}", file.refused);
    let [sleeve, cuff] = &file.pieces[..] else { panic!("{:?}", file.pieces) };
    assert_eq!((sleeve.block.as_str(), sleeve.name.as_str(), cuff.name.as_str()), (NO_BLOCK, "Sleeve", "Cuff"));
    assert_eq!((sleeve.turn_points.len(), cuff.notches.len(), cuff.size.as_deref()), (2, 1, Some("38")));
    assert!(sleeve.grain.is_some() && cuff.grain.is_none());
    assert_eq!(file.warnings, ["1 entities lie outside all outlines and are not used"]);
    // Blocks beside them are pieces too, but the sheet is not.
    let blocks = block("P", &lwpolyline("1", &moved(400.0))) + &block("*Model_Space", "") + &block("$PAPER_SPACE", "");
    assert_eq!(read_all(&sections(&blocks, &entities.concat())).pieces.len(), 3);
}

#[test]
fn blocks_in_blocks_are_drawn_where_they_are_inserted() {
    // A pocket of 10 x 5 turned by a quarter and doubled, its marks on layer 0 taking the layer of the insertion.
    let pocket = block("POCKET", &(line("0", [0.0, 0.0, 10.0, 0.0]) + &line("0", [10.0, 0.0, 10.0, 5.0])));
    let inner = "0 INSERT; 8 8; 2 Pocket; 10 50; 20 20; 41 2; 42 2; 50 90;";
    let blocks = pocket + &block("FRONT", &(lwpolyline("1", &SQUARE) + inner));
    let file = read_all(&sections(&blocks, "0 INSERT; 8 1; 2 FRONT; 10 0; 20 0; 50 45;"));
    assert_eq!((file.pieces.len(), file.refused.len()), (1, 0), "{:?}", file.refused);
    let ends: Vec<[f64; 2]> = file.pieces[0].internal_lines[1].iter().map(|p| [p.x * 1e3, p.y * 1e3]).collect();
    for (found, expect) in ends.iter().flatten().zip([50.0, 40.0, 40.0, 40.0]) {
        assert!((found - expect).abs() < 1e-9, "{ends:?}");
    }
    assert_eq!(file.warnings, ["block `POCKET` is read as part of the blocks it is inserted in"]);
    let endless = block("A", "0 INSERT; 8 1; 2 B; 10 0; 20 0;") + &block("B", "0 INSERT; 8 1; 2 A; 10 0; 20 0;");
    let file = read_all(&sections(&endless, "0 INSERT; 8 1; 2 A; 10 0; 20 0;"));
    assert!(file.refused[0].reason.contains("more than 8 deep"), "{:?}", file.refused);
}

#[test]
fn blocks_that_are_no_pieces_are_named() {
    let blocks = block("P", &lwpolyline("1", &SQUARE)) + &block("ARROW", &line("0", [0.0, 0.0, 1.0, 1.0]));
    let file = read_all(&sections(&blocks, ""));
    assert_eq!((file.pieces.len(), file.refused.len()), (1, 0));
    assert!(file.warnings[0].starts_with("block `ARROW` is no piece"), "{:?}", file.warnings);
    // It is refused if the file has nothing else.
    let file = read_all(&sections(&block("ARROW", &line("0", [0.0, 0.0, 1.0, 1.0])), ""));
    assert!(
        file.refused[0].reason.starts_with("no outline (layer 1), but on other layers: `0` (1); accepted"),
        "{:?}",
        file.refused
    );
}

#[test]
fn large_and_binary_files_are_told_apart() {
    let check = |bytes: &[u8], expect: &str| {
        let error = read(bytes, "a.dxf", None).expect_err(expect);
        assert!(error.found.contains(expect), "{error}");
    };
    check(b"AutoCAD Binary DXF\r\n\x1a\x00\x00\x00SECTION", "a binary DXF file");
    check(b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", "PNG");
    check(b"AC1032\x00\x00", "DWG");
    check(&b"999\na\n".repeat(12_000_000), "72 MB");
}

#[test]
fn versions_from_r12_to_2013_read_the_same() {
    let all = [
        (AcadVersion::R12, "AC1009"),
        (AcadVersion::R13, "AC1012"),
        (AcadVersion::R14, "AC1014"),
        (AcadVersion::R2000, "AC1015"),
        (AcadVersion::R2004, "AC1018"),
        (AcadVersion::R2007, "AC1021"),
        (AcadVersion::R2010, "AC1024"),
        (AcadVersion::R2013, "AC1027"),
    ];
    for (version, code) in all {
        let mut drawing = Drawing::new();
        drawing.header.version = version;
        drawing.header.default_drawing_units = dxf::enums::Units::Centimeters;
        let mut front = Block { name: "Vorderteil Größe".to_owned(), ..Block::default() };
        let mut add = |layer: &str, specific: EntityType| {
            let mut entity = Entity::new(specific);
            entity.common.layer = layer.to_owned();
            front.entities.push(entity);
        };
        let corners = SQUARE.map(|(x, y, _)| (x * 0.1, y * 0.1));
        if version < AcadVersion::R14 {
            let mut line = dxf::entities::Polyline::default();
            line.set_is_closed(true);
            for (x, y) in corners {
                line.add_vertex(&mut Drawing::new(), dxf::entities::Vertex::new(Point::new(x, y, 0.0)));
            }
            add("1", EntityType::Polyline(line));
        } else {
            let mut line = LwPolyline::default();
            line.set_is_closed(true);
            line.vertices = corners.map(|(x, y)| LwPolylineVertex { x, y, ..LwPolylineVertex::default() }).to_vec();
            add("1", EntityType::LwPolyline(line));
        }
        for (x, y) in corners {
            add("2", EntityType::ModelPoint(ModelPoint::new(Point::new(x, y, 0.0))));
        }
        drawing.add_block(front);
        let mut bytes = Vec::new();
        drawing.save(&mut bytes).expect("it writes");
        let unit = (version < AcadVersion::R2000).then_some(Unit::Cm);
        let file = read(&bytes, "a.dxf", unit).unwrap_or_else(|error| panic!("{code}: {error}"));
        assert_eq!((file.format, file.unit), (format!("DXF {code}"), Unit::Cm));
        assert!(file.refused.is_empty() && file.pieces.len() == 1, "{code}: {:?}", file.refused);
        measures(&file.pieces[0], 400.0, 10_000.0);
        assert_eq!(file.pieces[0].turn_points.len(), 4, "{code}");
        if version >= AcadVersion::R2007 {
            assert_eq!(file.pieces[0].name, "Vorderteil Größe", "{code}");
        }
    }
}

fn path(layer: &str, points: &[(f64, f64)]) -> String {
    points.windows(2).map(|ends| line(layer, [ends[0].0, ends[0].1, ends[1].0, ends[1].1])).collect()
}

#[test]
fn what_programs_of_the_trade_write_is_mended_and_it_is_said() {
    let square = lwpolyline("1", &SQUARE);
    let check = |what: &str, entities: &str, sew_mm2: Option<f64>, area_mm2: f64, says: &str| {
        let (piece, warnings) = only(entities);
        assert!((piece.area_m2() * 1e6 - area_mm2).abs() < 1.0, "{what}: {}", piece.area_m2() * 1e6);
        let sew = piece.sew_line.as_deref().map(|line| geom::polyline::signed_area(line) * 1e6);
        assert_eq!(sew.map(f64::round), sew_mm2, "{what}");
        let told = warnings.join("; ");
        assert!(if says.is_empty() { told.is_empty() } else { told.contains(says) }, "{what}: {told}");
    };
    // The sew line of a half piece ends at the fold, or is left out where there is no allowance.
    let fold = line("6", [0.0, 0.0, 0.0, 100.0]);
    let open = path("14", &[(0.0, 10.0), (90.0, 10.0), (90.0, 90.0), (0.0, 90.0)]);
    check("a sew line to the fold", &format!("{square}{fold}{open}"), Some(7200.0), 10_000.0, "");
    let two = path("14", &[(10.0, 0.0), (10.0, 100.0)]) + &path("14", &[(80.0, 100.0), (80.0, 0.0)]);
    check("two strips", &format!("{square}{two}"), Some(7000.0), 10_000.0, "");
    // A slit is drawn out and back.
    let slit = |off: f64| {
        let (out, back) = ([(50.0, 0.0), (50.0, 40.0)], [(50.0, 40.0), (50.0 + off, 0.0)]);
        let rest = [(50.0 + off, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0), (0.0, 0.0), (50.0, 0.0)];
        [path("1", &out), path("1", &back), path("1", &rest)].concat()
    };
    check("a slit", &slit(0.0), None, 10_000.0, "as the sides of a slit");
    check("a slit of a grid step", &slit(0.0254), None, 10_000.0, "cut away");
    let missing = "0 INSERT; 8 1; 2 Q; 10 0; 20 0;";
    check("a block that is not there", &format!("{square}{missing}"), None, 10_000.0, "block `Q` is inserted");
}

#[test]
fn a_broken_size_leaves_the_others_alone() {
    let sized = |name: &str, size: &str, outline: &str| {
        block(name, &format!("0 TEXT; 8 1; 10 0; 20 0; 40 3; 1 Size: {size}; {outline}"))
    };
    let bow = lwpolyline("1", &[(0.0, 0.0, 0.0), (100.0, 100.0, 0.0), (100.0, 0.0, 0.0), (0.0, 80.0, 0.0)]);
    let file = read_all(&sections(&(sized("A_36", "36", &lwpolyline("1", &SQUARE)) + &sized("A_50", "50", &bow)), ""));
    assert_eq!(file.to_sew(Some("36")).expect("a whole one").len(), 1);
    let error = file.to_sew(Some("50")).expect_err("it crosses itself").to_string();
    assert!(error.contains("crosses itself"), "{error}");
}

#[test]
fn texts_are_read_in_what_they_are_written_in() {
    let named = |header: &str, name: &[u8]| {
        let text = String::from_utf8(sections(&block("NAME", &lwpolyline("1", &SQUARE)), "")).expect("ASCII");
        let head = tags(&format!("0 SECTION; 2 HEADER; {header} 0 ENDSEC;"));
        let parts: Vec<&str> = text.split("NAME").collect();
        read_all(&[head.as_bytes(), parts[0].as_bytes(), name, parts[1].as_bytes()].concat())
    };
    let check = |header: &str, bytes: &[u8], expect: &str| {
        let file = named(header, bytes);
        assert_eq!(file.pieces[0].block, expect, "{header}");
    };
    check("", b"\xC4rmel", "\u{c4}rmel");
    check("9 $ACADVER; 1 AC1009;", "\u{c4}rmel".as_bytes(), "\u{c4}rmel");
    check("9 $DWGCODEPAGE; 3 dos850;", b"\x8Ermel", "\u{c4}rmel");
    check("9 $DWGCODEPAGE; 3 nobody knows;", b"FRONT", "FRONT");
    // People read names in the code page of the file, other programs byte for byte.
    let dos = named("9 $DWGCODEPAGE; 3 dos850;", b"\x8Ermel");
    let report = FileReport::from(&dos);
    assert_eq!((report.pieces[0].block.as_str(), dos.as_written("\u{c4}rmel").as_str()), ("\u{c4}rmel", "\u{8e}rmel"));
    assert_eq!(report.as_written().pieces[0].block, "\u{8e}rmel");
}

#[test]
fn a_unit_that_nobody_could_wear_is_not_sewn() {
    let with = |units: &str, size: f64| {
        let outline = SQUARE.map(|(x, y, bulge)| (x * size, y * size, bulge));
        let text = String::from_utf8(sections(&block("P", &lwpolyline("1", &outline)), "")).expect("ASCII");
        let head = tags(units);
        read_all(&[head.as_bytes(), text.replace("Units: METRIC", "Nothing").as_bytes()].concat())
    };
    let metres = "0 SECTION; 2 HEADER; 9 $INSUNITS; 70 6; 0 ENDSEC;";
    let error = with(metres, 7.0).to_sew(None).expect_err("a giant's").to_string();
    assert!(error.contains("700 m long in m; it would be 0.70 m in mm") && error.contains("--unit mm"), "{error}");
    assert_eq!(with(metres, 0.007).to_sew(None).expect("0.7 m").len(), 1);
}
