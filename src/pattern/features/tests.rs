use super::*;
use crate::draft::{TshirtSize, tshirt};
use crate::dxf;

fn written(pieces: &[Piece]) -> Vec<u8> {
    serde_json::to_vec(&Features::of(pieces, "a.dxf", &[("Style Name".to_owned(), "Tee".to_owned())])).expect("JSON")
}

fn assert_same(read: &Piece, piece: &Piece) {
    let near = |a: &[V2], b: &[V2]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).norm() < 2e-9);
    assert!(near(&read.outline, &piece.outline), "{}", piece.name);
    assert!(near(&read.turn_points, &piece.turn_points) && near(&read.curve_points, &piece.curve_points));
    assert!(near(&read.drill_holes, &piece.drill_holes));
    assert_eq!(read.notches.len(), piece.notches.len());
    assert_eq!(corner_vertices(read), corner_vertices(piece));
    let words = |piece: &Piece| {
        let Piece { block, name, size, quantity, texts, is_clockwise_in_file, .. } = piece.clone();
        (block, name, size, quantity, texts, is_clockwise_in_file)
    };
    assert_eq!(words(read), words(piece));
    let counts = |piece: &Piece| {
        let lines =
            [&piece.internal_lines, &piece.cut_outs].map(|lines| lines.iter().map(Vec::len).collect::<Vec<_>>());
        let ends = [piece.grain, piece.mirror_line, piece.grade_reference].map(|ends| ends.is_some());
        (lines, ends, piece.grade_points.len(), piece.sew_line.as_ref().map(Vec::len))
    };
    assert_eq!(counts(read), counts(piece));
}

fn samples() -> Vec<Piece> {
    let mut pieces = tshirt(TshirtSize::M).pieces;
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/patterns"));
    for name in [
        "freesewing/teagan_nest_aama-inch.dxf",
        "freesewing/brian_cisMaleAdult40_aama.dxf",
        "valentina/notchbug.v1.1.1.astm-r12.dxf",
    ] {
        match std::fs::read(folder.join(name)) {
            Ok(bytes) => pieces.extend(dxf::read(&bytes, name, Some(Unit::Mm)).expect("it reads").pieces),
            Err(_) => eprintln!("skipped: no {name}"),
        }
    }
    pieces
}

#[test]
fn what_is_written_is_read_back_as_the_same_pieces() {
    let pieces = samples();
    let json = written(&pieces);
    assert!(is_features(&json));
    let file = read(&json, "a.json").expect("our own file reads");
    assert_eq!(file.pieces.len(), pieces.len());
    for (read, piece) in file.pieces.iter().zip(&pieces) {
        assert_same(read, piece);
    }
    // A piece that was read once is read unchanged from then on.
    let again = read(&written(&file.pieces), "a.json").expect("it reads");
    assert_eq!(again.pieces, file.pieces);
    assert_eq!(again.texts, [("Style Name".to_owned(), "Tee".to_owned())]);
}

#[test]
fn edges_go_once_round() {
    for piece in samples() {
        let features = PieceFeatures::of(&piece);
        assert_eq!(features.edges.len(), features.corners.len());
        let total: f64 = features.edges.iter().map(|edge| edge.length_mm).sum();
        let round = mm(geom::polyline::perimeter(piece.seam_outline()));
        assert!(features.edges.is_empty() || (total - round).abs() < 1e-3, "{}: {total} for {round}", piece.name);
    }
}

#[test]
fn other_json_is_refused() {
    let json = String::from_utf8(written(&tshirt(TshirtSize::M).pieces)).expect("JSON");
    let check = |from: &str, to: &str, expect: &str| {
        assert!(json.contains(from), "{from}");
        let error = read(json.replacen(from, to, 1).as_bytes(), "a.json").expect_err(expect).to_string();
        assert!(error.starts_with("a.json: ") && error.contains(expect) && error.contains("accepted"), "{error}");
    };
    check("\"unit\":\"mm\"", "\"unit\":\"in\"", "unit `in`");
    check("\"version\":1", "\"version\":2", "version 2");
    check("\"outline\":", "\"outlines\":", "unknown field");
    check("\"outline\":[[", "\"outline\":[[1e9,0],[", "within 100 m");
    check("\"outline\":[[", "\"outline\":[[0,9999],[", "crosses itself");
    assert!(!is_features(b"{\"pattern\": {}}") && !is_features(b"[]"));
}
