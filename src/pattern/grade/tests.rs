use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::*;
use crate::dxf;
use crate::piece::GradePoint;

const TABLE: &str = "ANSI/AAMA VERSION: 1.0.0\r\nAUTHOR: someone\r\nCREATION TIME: 14:03\r\nUNITS: METRIC\r\n\
GRADE RULE TABLE: BLOUSE\r\nNUMBER OF SIZES: 3\r\nSIZE LIST: S M\r\n  L\r\nSAMPLE SIZE: M\r\nRULE: DELTA  1\r\n\
   -10.00,   -5.00      0.00,    0.00     10.00,    5.00\r\nRULE: DELTA 2\r\n 0.0, -5.0\r\n 0.0, 0.0\r\n 0.0, 5.0\r\n\
RULE: DELTA 3\r\n0 0 0 0 0 0\r\nEND\r\n";

/// 100 mm: rule 3 at its lower corners, 1 at the upper right, 2 at the upper left; a vertex half way up each side has
/// none.
fn square() -> PatternFile {
    dxf::read(drawing().as_bytes(), "square.dxf", None).expect("it reads")
}

fn drawing() -> String {
    let line = |layer: &str, ends: [[f64; 2]; 2]| {
        let [[a, b], [c, d]] = ends;
        format!("0\nLINE\n8\n{layer}\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n")
    };
    let corners = [[0.0, 0.0], [100.0, 0.0], [100.0, 50.0], [100.0, 100.0], [0.0, 100.0], [0.0, 50.0]];
    let mut text = "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nP\n".to_owned();
    for k in 0..6 {
        text += &line("1", [corners[k], corners[(k + 1) % 6]]);
    }
    for (corner, rule) in [(0, 3), (1, 3), (3, 1), (4, 2), (4, 2)] {
        let [x, y] = corners[corner];
        write!(text, "0\nTEXT\n8\n2\n10\n{x}\n20\n{y}\n40\n3\n1\n# {rule}\n").expect("a string");
    }
    text += &line("5", [[20.0, 50.0], [80.0, 50.0]]);
    text += "0\nPOINT\n8\n4\n10\n100\n20\n75\n0\nPOINT\n8\n13\n10\n50\n20\n90\n0\nENDBLK\n8\n0\n0\nENDSEC\n";
    text += "0\nSECTION\n2\nENTITIES\n0\nTEXT\n8\n1\n10\n0\n20\n0\n1\nUnits: METRIC\n0\nENDSEC\n0\nEOF\n";
    text
}

fn table() -> GradeTable {
    read(TABLE.as_bytes(), "blouse.rul").expect("it reads")
}

#[test]
fn a_table_has_sizes_and_steps() {
    let table = table();
    assert_eq!((table.sizes.join(" "), table.sample), ("S M L".to_owned(), 1));
    assert_eq!(table.rules[&1], [V2::new(-0.01, -0.005), V2::zeros(), V2::new(0.01, 0.005)]);
    assert_eq!(table.rules[&2][0], V2::new(0.0, -0.005));
    let inches = read(TABLE.replace("METRIC", "ENGLISH").as_bytes(), "a.rul").expect("it reads");
    assert!((inches.rules[&1][2].x - 0.254).abs() < 1e-12);
}

#[test]
fn tables_of_other_programs_are_read() {
    // Steps behind the number of their rule, and no blank after a key.
    let joined = TABLE
        .replace("DELTA  1\r\n", "DELTA  1 ")
        .replace("DELTA 3\r\n", "DELTA 3 ")
        .replace("TABLE: BLOUSE", "TABLE:BLOUSE");
    let table = read(joined.as_bytes(), "blouse.rul").expect("it reads");
    assert_eq!(table.rules, self::table().rules);
    // A notch at a graded corner, with a rule of its own that says otherwise.
    let notch = "0\nTEXT\n8\n4\n10\n0\n20\n0\n40\n3\n1\n# 1\n0\nENDBLK\n";
    let mut file = square();
    let corner = file.pieces[0].grade_points[0].at;
    let notched =
        dxf::read(drawing().replacen("0\nENDBLK\n", notch, 1).as_bytes(), "square.dxf", None).expect("it reads");
    assert!(notched.pieces[0].grade_points.iter().any(|point| point.is_inner && point.at == corner));
    file.pieces = notched.pieces;
    let graded = grade(&file, &table).expect("it grades");
    assert!(graded.refused.is_empty(), "{:?}", graded.refused);
    assert!(graded.pieces.iter().all(|piece| piece.outline[0] == corner));
}

#[test]
fn damaged_tables_are_refused_with_line_and_finding() {
    let check = |from: &str, to: &str, line: Option<usize>, expect: &str| {
        assert!(TABLE.contains(from), "{from}");
        let error = read(TABLE.replacen(from, to, 1).as_bytes(), "a.rul").expect_err(expect);
        assert!(error.found.contains(expect) && error.line == line && !error.accepted.is_empty(), "{error}");
    };
    check("METRIC", "CUBITS", Some(4), "unit `CUBITS`");
    check("UNITS: METRIC\r\n", "", None, "no unit");
    check("SIZES: 3", "SIZES: 4", Some(6), "4 sizes, and a list of 3 in line 7");
    check("SAMPLE SIZE: M", "SAMPLE SIZE: XL", Some(9), "`XL`, 0 times");
    check("SAMPLE SIZE: M\r\n", "", None, "no sample size");
    check("DELTA  1", "PERCENT 1", Some(10), "PERCENT 1");
    check("DELTA 2", "DELTA 1", Some(12), "rule 1 again, first in line 10");
    check("10.00,    5.00", "10.00", Some(10), "5 numbers in rule 1");
    check("-10.00", "-10;00", Some(11), "`-10;00`");
    check("-10.00", "NaN", Some(11), "`NaN`");
    check("-10.00", "-1e9", Some(10), "a step of");
    check("0.00,    0.00", "1.00,    0.00", Some(10), "moves the sample size");
    // Editors put a byte order mark before a text, old ones end lines with CR alone.
    let marked = ["\u{feff}", TABLE].concat();
    let plain = read(TABLE.as_bytes(), "a.rul").expect("it reads");
    assert_eq!(read(marked.as_bytes(), "a.rul").expect("it reads"), plain);
    assert_eq!(read(TABLE.replace("\r\n", "\n").replace('\n', "\r").as_bytes(), "a.rul").expect("it reads"), plain);
    let none = read(b"\x89PNG\x00", "a.rul").expect_err("no table");
    assert!(none.found.contains("binary"), "{none}");
    assert!(read(b"", "a.rul").expect_err("empty").found.contains("no rule"));
}

#[test]
fn points_move_by_their_rules_and_between_them_by_arc_length() {
    let graded = grade(&square(), &table()).expect("it grades");
    assert!(graded.refused.is_empty(), "{:?}", graded.refused);
    assert_eq!(graded.sizes(), ["S", "M", "L"]);
    let [small, sample, large] = &graded.pieces[..] else { panic!("{:?}", graded.pieces.len()) };
    assert_eq!(Piece { size: None, ..sample.clone() }, Piece { size: None, ..square().pieces[0].clone() });
    let vertex_mm = |piece: &Piece, k: usize| [piece.outline[k].x * 1e3, piece.outline[k].y * 1e3];
    let close = |found: [f64; 2], expect: [f64; 2]| {
        assert!(found.iter().zip(expect).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} for {expect:?}");
    };
    for (piece, sign) in [(small, -1.0), (large, 1.0)] {
        close(vertex_mm(piece, 0), [0.0, 0.0]);
        close(vertex_mm(piece, 2), [100.0 + sign * 5.0, 50.0 + sign * 2.5]);
        close(vertex_mm(piece, 3), [100.0 + sign * 10.0, 100.0 + sign * 5.0]);
        close(vertex_mm(piece, 4), [0.0, 100.0 + sign * 5.0]);
        close(vertex_mm(piece, 5), [0.0, 50.0 + sign * 2.5]);
        let notch = piece.notches[0].at * 1e3;
        close([notch.x, notch.y], [100.0 + sign * 7.5, 75.0 + sign * 3.75]);
        // Nearest to the middle of the upper side.
        let hole = piece.drill_holes[0] * 1e3;
        close([hole.x, hole.y], [50.0 + sign * 5.0, 90.0 + sign * 5.0]);
    }
}

#[test]
fn an_inner_line_beside_a_corner_moves_by_its_own_rule() {
    // The lower left corner stays (rule 1). A line that begins beside it or in it moves by rule 2.
    let check = |away: V2| {
        let mut file = square();
        let piece = &mut file.pieces[0];
        let corner = piece.grade_points[0].at;
        let rule = piece.grade_points.iter().map(|point| point.rule).find(|&rule| rule != piece.grade_points[0].rule);
        let at = corner + away;
        piece.internal_lines = vec![vec![at, V2::new(0.05, 0.05)]];
        piece.grade_points.push(GradePoint { at, rule: rule.expect("another rule"), is_inner: false });
        let graded = grade(&file, &table()).expect("it grades");
        assert!(graded.refused.is_empty(), "{:?}", graded.refused);
        for piece in &graded.pieces {
            assert_eq!(piece.outline[0], corner);
        }
        assert_ne!(graded.pieces[2].internal_lines[0][0], at);
    };
    check(V2::new(0.0003, 0.0));
    check(V2::zeros());
}

#[test]
fn what_is_ambiguous_is_refused() {
    let check = |edit: fn(&mut Piece), expect: &str| {
        let mut file = square();
        edit(&mut file.pieces[0]);
        let graded = grade(&file, &table()).expect("the sample size stays");
        assert_eq!((graded.pieces.len(), graded.refused.len()), (1, 2));
        assert!(graded.refused[0].reason.contains(expect), "{:?}", graded.refused);
    };
    check(|piece| piece.grade_points[0].rule = 7, "rule 7 at (0.0, 0.0) mm, which blouse.rul does not hold");
    check(|piece| piece.grade_points[4].rule = 1, "rules 2 and 1 at (0.0, 100.0) mm");
    check(|piece| piece.grade_points.truncate(1), "1 graded points");
    check(|piece| piece.grade_reference = Some([V2::zeros(), V2::new(0.0, 1.0)]), "line at 90 degrees");
    let mut file = square();
    file.pieces[0].grade_points.clear();
    assert!(grade(&file, &table()).expect_err("none").found.contains("no grade point"));
    let mut file = square();
    file.pieces[0].size = Some("XL".to_owned());
    assert!(grade(&file, &table()).expect_err("size").found.contains("size `XL`"));
}

/// Compares sizes and pieces whose outlines all have equally many vertices.
#[test]
fn a_nest_is_what_its_own_rules_make_of_its_sample_size() {
    const SIZES: [&str; 4] = ["34", "36", "38", "40"];
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/patterns/freesewing/teagan_nest_aama-inch.dxf");
    let Ok(bytes) = std::fs::read(path) else {
        eprintln!("skipped: no {path}");
        return;
    };
    let nest = dxf::read(&bytes, "nest.dxf", None).expect("it reads");
    let drawn = |size: &str| -> Vec<Piece> {
        let is_compared = |piece: &&Piece| piece.size.as_deref() == Some(size) && !piece.block.contains("SLEEVE");
        nest.pieces.iter().filter(is_compared).cloned().collect()
    };
    let mut sample = PatternFile { pieces: drawn("36"), ..nest.clone() };
    let mut rules: BTreeMap<u32, Vec<V2>> = BTreeMap::new();
    for (index, piece) in sample.pieces.iter_mut().enumerate() {
        piece.grade_reference = None;
        piece.grade_points.clear();
        for (vertex, &at) in piece.outline.iter().enumerate() {
            let rule = 1 + (rules.len() as u32);
            piece.grade_points.push(GradePoint { at, rule, is_inner: false });
            rules.insert(rule, SIZES.iter().map(|size| drawn(size)[index].outline[vertex] - at).collect());
        }
    }
    let mut text = format!("UNITS: METRIC\nNUMBER OF SIZES: 4\nSIZE LIST: {}\nSAMPLE SIZE: 36\n", SIZES.join(" "));
    for (rule, steps) in &rules {
        writeln!(text, "RULE: DELTA {rule}").expect("a string");
        for step in steps {
            writeln!(text, "{:10.3},{:9.3}", step.x * 1e3, step.y * 1e3).expect("a string");
        }
    }
    let graded = grade(&sample, &read(text.as_bytes(), "nest.rul").expect("it reads")).expect("it grades");
    assert!(graded.refused.is_empty() && graded.pieces.len() == 8, "{:?}", graded.refused);
    for (found, drawn) in graded.pieces.iter().zip(SIZES.iter().flat_map(|size| drawn(size))) {
        let off_mm = (found.perimeter_m() - drawn.perimeter_m()).abs() * 1e3;
        assert!(off_mm < 0.02, "{} {:?}: {off_mm} mm", drawn.block, drawn.size);
    }
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(128))]

    #[test]
    fn damaged_tables_never_panic_and_never_lose_a_size(edits in proptest::collection::vec((0.0..1.0_f64, proptest::num::u8::ANY), 1..8)) {
        let mut bytes = TABLE.as_bytes().to_vec();
        for (share, byte) in edits {
            let index = (share * bytes.len() as f64) as usize;
            bytes[index] = byte;
        }
        if let Ok(table) = read(&bytes, "a.rul") {
            proptest::prop_assert!(table.rules.values().all(|steps| steps.len() == table.sizes.len()));
            let _ = grade(&square(), &table);
        }
    }

    #[test]
    fn graded_outlines_close_and_keep_their_vertices(x in -30.0..30.0_f64, y in -30.0..30.0_f64) {
        let text = TABLE.replace("10.00,    5.00\r\nRULE", &format!("{x:.3}, {y:.3}\r\nRULE"));
        let graded = grade(&square(), &read(text.as_bytes(), "a.rul").expect("it reads")).expect("it grades");
        let large = graded.pieces.last().expect("the largest size");
        proptest::prop_assert_eq!(large.outline.len(), 6);
        let corner = (large.outline[3] - V2::new(0.1, 0.1)) * 1e3;
        proptest::prop_assert!((corner - V2::new(x, y)).norm() < 1e-3);
    }
}

fn regraded(nest: &PatternFile, sample: &str, standard: dxf::Standard) -> PatternFile {
    let Ungraded { pieces, table, .. } = ungrade(nest, sample).expect("one pattern");
    let written = dxf::write_pieces(&pieces, &[("Sample Size".to_owned(), sample.to_owned())], standard);
    let file = dxf::read(&written, "a.dxf", None).expect("our own file");
    let said = [("CREATION DATE", " 4-12-2017"), ("Style Name", "a"), ("Creation Time", "")];
    let said = said.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let text = write(&table, "a", &Imprint::of(&said), standard);
    let told = "\r\nAUTHOR: Toile\r\nPRODUCT: Toile\r\nVERSION: ";
    assert!(text.contains(told) && text.contains("\r\nCREATION DATE: 4-12-2017\r\nUNITS: METRIC\r\n"), "{text}");
    let head = if standard == dxf::Standard::Aama { "ANSI/AAMA" } else { "ASTM/D13Proposal 1 Version: D 6673-04\r\n" };
    assert!(text.starts_with(head) && text.contains("\r\nGRADE RULE TABLE: a\r\n"), "{text}");
    let table = read(text.as_bytes(), "a.rul").expect("our own table");
    let graded = grade(&file, &table).expect("it grades");
    assert!(graded.refused.is_empty(), "{:?}", graded.refused);
    graded
}

fn away(vertices: &[V2], line: &[V2]) -> f64 {
    let sides = || (0..line.len()).map(|k| (line[k], line[(k + 1) % line.len()]));
    let nearest = |p: &V2| sides().map(|(a, b)| segment_distance(&a, &b, p)).fold(f64::INFINITY, f64::min);
    vertices.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn a_nest_written_as_rules_is_the_same_nest_again() {
    for model in crate::draft::Model::ALL {
        let mut nest = dxf::read(&model.drafts()[0].dxf(), "a.dxf", None).expect("our own file");
        nest.pieces = model.drafts().into_iter().flat_map(|draft| draft.pieces).collect();
        // One size has a curve with fewer vertices, as if it were drawn separately.
        let turns: Vec<V2> = nest.pieces[0].turn_points.clone();
        let thinned = &mut nest.pieces[0].outline;
        let mut count = 0;
        thinned.retain(|at| {
            count += 1;
            count % 3 != 0 || turns.iter().any(|turn| (turn - at).norm() < 1e-4)
        });
        nest.pieces[0].curve_points.clear();
        let sizes: Vec<String> = nest.sizes().into_iter().map(str::to_owned).collect();
        for standard in [dxf::Standard::Aama, dxf::Standard::Astm] {
            let again = regraded(&nest, &sizes[sizes.len() / 2], standard);
            assert_eq!(again.sizes(), sizes);
            for piece in &nest.pieces {
                let is_it = |other: &&Piece| other.name == piece.name && other.size == piece.size;
                let other = again.pieces.iter().find(is_it).expect("every piece in every size");
                let apart = away(&piece.outline, &other.outline).max(away(&other.outline, &piece.outline));
                assert!(apart < 0.01e-3, "{model:?} {} {:?}: {} mm", piece.name, piece.size, mm(apart));
                for (notch, again) in piece.notches.iter().zip(&other.notches) {
                    assert!((notch.at - again.at).norm() < 0.01e-3, "{model:?} {}", piece.name);
                }
            }
        }
    }
}

#[test]
fn what_is_no_nest_is_not_written_as_rules() {
    let draft = crate::draft::Model::Tshirt.drafts();
    let mut nest = dxf::read(&draft[0].dxf(), "a.dxf", None).expect("our own file");
    nest.pieces.extend(draft[1].pieces.iter().skip(1).cloned());
    let told = ungrade(&nest, "S").expect_err("a piece is missing").to_string();
    assert!(told.contains("no piece `BACK` in size M") || told.contains("no piece `FRONT` in size M"), "{told}");
    assert!(ungrade(&nest, "XXL").expect_err("no such size").to_string().contains("one of S, M"));
}
