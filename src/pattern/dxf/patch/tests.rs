use super::{Patched, Redraw, patched};
use crate::Style;
use crate::draft::Model;
use crate::dxf::{self, Standard};
use crate::handle::{Handle, Redrawn, outlines_apart_m};
use crate::piece::Piece;
use crate::propose;
use crate::style::EdgeRef;
use geom::V2;
use geom::polyline::boundary_distance;
use geom::units::mm;

const INCH_M: f64 = 0.0254;

/// In inches, its fold along y = 0 and its grain along x.
fn half_front(size: &str, wider: f64) -> String {
    let corners = [(0.0, 0.0), (24.0, 0.0), (24.0, 4.0), (16.0, 9.0 + wider), (0.0, 9.5 + wider)];
    let curve = [(20.0, 4.5), (17.0, 5.5)];
    let point = |(x, y): (f64, f64)| format!(" 10\r\n{x:9.4}\r\n 20\r\n{y:9.4}\r\n");
    let entity = |kind: &str, layer: u32| format!("  0\r\n{kind}\r\n  8\r\n{layer}\r\n");
    let line = |layer: u32, [from, to]: [(f64, f64); 2]| {
        let to = point(to).replace(" 10\r\n", " 11\r\n").replace(" 20\r\n", " 21\r\n");
        format!("{}{}{to}", entity("LINE", layer), point(from))
    };
    let vertices = [corners[0], corners[1], corners[2], curve[0], curve[1], corners[3], corners[4]];
    let vertices: String = vertices.map(|v| format!("{}{} 70\r\n0\r\n", entity("VERTEX", 1), point(v))).concat();
    let points = |layer: u32, points: &[(f64, f64)]| -> String {
        points.iter().map(|p| format!("{}{}", entity("POINT", layer), point(*p))).collect()
    };
    let text =
        |words: &str, at: (f64, f64)| format!("{}{} 40\r\n0.25\r\n  1\r\n{words}\r\n", entity("TEXT", 1), point(at));
    let parts = [
        format!("  0\r\nBLOCK\r\n  8\r\n0\r\n  2\r\nFRONT-{size}\r\n 70\r\n64\r\n{}", point((0.0, 0.0))),
        text("Piece Name: FRONT", (4.0, 2.0)),
        text(&format!("Size: {size}"), (4.0, 1.5)),
        text("Annotation: caf\u{e9}", (4.0, 1.0)),
        format!("{} 66\r\n1\r\n 70\r\n1\r\n{vertices}{}", entity("POLYLINE", 1), entity("SEQEND", 1)),
        points(2, &corners),
        points(3, &curve),
        points(4, &[(8.0, 9.25 + wider)]),
        text("# 7", corners[3]).replace("  8\r\n1\r\n", "  8\r\n2\r\n"),
        line(6, [corners[0], corners[1]]),
        line(7, [(2.0, 3.0), (10.0, 3.0)]),
        line(8, [(0.0, 5.0), (20.0, 4.5)]),
        points(13, &[(12.0, 8.0)]),
        "  0\r\nENDBLK\r\n  8\r\n0\r\n".to_owned(),
    ];
    parts.concat()
}

fn nest() -> Vec<u8> {
    let texts = [
        "Style Name: TEE",
        "Creation Date: 11-30-2026",
        "Author: Ann",
        "Sample Size: S",
        "Units: ENGLISH",
        "Tolerance: 0.02",
    ];
    let texts = texts.map(|text| {
        format!("  0\r\nTEXT\r\n  8\r\n1\r\n 10\r\n0.0\r\n 20\r\n-1.0\r\n 40\r\n0.25\r\n  1\r\n{text}\r\n")
    });
    let head = "999\r\nANSI/AAMA\r\n  0\r\nSECTION\r\n  2\r\nHEADER\r\n  9\r\n$DWGCODEPAGE\r\n  3\r\nANSI_1252\r\n  9\r\n$EXTMIN\r\n \
                10\r\n0.0\r\n 20\r\n0.0\r\n  0\r\nENDSEC\r\n  0\r\nSECTION\r\n  2\r\nBLOCKS\r\n";
    let inserts = ["S", "M"]
        .map(|size| format!("  0\r\nINSERT\r\n  8\r\n1\r\n  2\r\nFRONT-{size}\r\n 10\r\n0.0\r\n 20\r\n0.0\r\n"));
    let middle = "  0\r\nENDSEC\r\n  0\r\nSECTION\r\n  2\r\nENTITIES\r\n";
    let all = [
        head,
        &half_front("S", 0.0),
        &half_front("M", 0.5),
        middle,
        &texts.concat(),
        &inserts.concat(),
        "  0\r\nENDSEC\r\n  0\r\nEOF\r\n",
    ];
    encoding_rs::WINDOWS_1252.encode(&all.concat()).0.into_owned()
}

/// The side at y = 9 to 9.5 inches bulges by 0.4 inches; the fold stays.
fn bulged(p: V2) -> V2 {
    let share = (p.x / (16.0 * INCH_M)).clamp(0.0, 1.0);
    p + V2::new(0.0, 0.4 * p.y / 9.0 * (std::f64::consts::PI * share).sin())
}

fn sewn(bytes: &[u8], size: &str) -> Vec<Piece> {
    dxf::read(bytes, "nest.dxf", None).expect("a nest").to_sew(Some(size)).expect("the size")
}

fn redrawn_by(bytes: &[u8], size: &str, carried: &dyn Fn(V2) -> V2) -> Patched {
    let pieces = sewn(bytes, size);
    let redraws: Vec<Redraw<'_>> = pieces.iter().map(|piece| Redraw { piece, carried }).collect();
    patched(bytes, "nest.dxf", None, &redraws).expect("it is changed")
}

fn without_coordinates(bytes: &[u8]) -> Vec<&[u8]> {
    let lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
    let is_coordinate = |code: &[u8]| matches!(code.trim_ascii(), b"10" | b"20" | b"11" | b"21");
    lines.chunks(2).flat_map(|tag| if is_coordinate(tag[0]) { &tag[..1] } else { tag }).copied().collect()
}

fn count(bytes: &[u8], record: &str) -> usize {
    String::from_utf8_lossy(bytes).matches(record).count()
}

#[test]
fn nothing_that_stays_changes() {
    let source = nest();
    assert_eq!(redrawn_by(&source, "S", &|p| p).bytes, source);
    let shifted = redrawn_by(&source, "S", &|p| p + V2::new(INCH_M, 0.0)).bytes;
    assert_eq!(without_coordinates(&shifted), without_coordinates(&source));
    // The other size and what stands outside the block stay byte for byte.
    let text = |bytes: &[u8]| encoding_rs::WINDOWS_1252.decode(bytes).0.into_owned();
    let (source, shifted) = (text(&source), text(&shifted));
    let around = |text: &str| {
        let [from, to] = ["FRONT-S", "ENDBLK"].map(|mark| text.find(mark).expect("a block"));
        [text[..from].to_owned(), text[to..].to_owned()]
    };
    assert_eq!(around(&source), around(&shifted));
    assert!(shifted.contains(" 10\r\n  17.00000\r\n") && shifted.contains("Annotation: caf\u{e9}"), "{shifted}");
    // Texts stay inside their piece where they are.
    assert!(shifted.contains(" 10\r\n   4.0000\r\n 20\r\n   2.0000\r\n"), "{shifted}");
}

#[test]
fn a_straight_side_that_bends_gets_curve_points_and_a_curve_none() {
    let source = nest();
    let Patched { bytes, departs_m } = redrawn_by(&source, "S", &bulged);
    let added = |record: &str| count(&bytes, record) - count(&source, record);
    let vertices = added("VERTEX\r\n");
    assert!((4..8).contains(&vertices) && added("POINT\r\n  8\r\n3\r\n") == vertices, "{vertices}");
    assert_eq!(added("POINT\r\n"), vertices);
    assert!(departs_m < 0.25e-3, "{departs_m}");
    let [before, after] =
        [&source, &bytes].map(|bytes| dxf::read(bytes, "x", None).expect("a nest").pieces.swap_remove(0));
    assert_eq!((after.mirror_line, &after.texts), (before.mirror_line, &before.texts));
    let is_vertex = |p: &V2| after.outline.iter().any(|vertex| (vertex - p).norm() < 1e-9);
    assert!(after.turn_points.iter().chain(&after.curve_points).all(is_vertex));
    assert_eq!((after.turn_points.len(), after.curve_points.len()), (5, 2 + vertices));
    let on_side = |k: u32| bulged(V2::new(0.0, 9.5).lerp(&V2::new(16.0, 9.0), f64::from(k) / 50.0) * INCH_M);
    assert!((0..=50).all(|k| boundary_distance(&after.outline, &on_side(k)) < 0.2e-3));
    assert!(boundary_distance(&after.outline, &after.notches[0].at) < 1e-6);
    assert!((after.grade_points[0].at - after.turn_points[3]).norm() < 1e-9);
    let direction = |piece: &Piece| piece.grain.map(|[from, to]| to - from);
    assert!(direction(&after).zip(direction(&before)).is_some_and(|(is, was)| (is - was).norm() < 1e-12));
    assert!((after.drill_holes[0] - bulged(before.drill_holes[0])).norm() < 1e-6);
    assert_eq!(after.internal_lines[0].len(), 2);
}

#[test]
fn a_block_does_not_change_in_two_ways() {
    let source = nest();
    let piece = &sewn(&source, "S")[0];
    let change = |by: f64| {
        patched(
            &source,
            "nest.dxf",
            None,
            &[Redraw { piece, carried: &|p| p }, Redraw { piece, carried: &move |p| p + V2::new(by, 0.0) }],
        )
    };
    assert_eq!(change(1e-5).map(|patched| patched.bytes), Ok(source.clone()));
    let told = change(1e-3).expect_err("two ways").to_string();
    assert!(told.contains("block `FRONT-S`: found two changes, 1.00 mm apart"), "{told}");
}

#[test]
fn arcs_bulges_and_lines_change() {
    let file = |boundary: &str| {
        format!(
            "0\nSECTION\n2\nENTITIES\n0\nTEXT\n8\n1\n10\n0\n20\n-9\n1\nUnits: METRIC\n{boundary}0\nENDSEC\n0\nEOF\n"
        )
        .into_bytes()
    };
    let check = |boundary: &str, added: usize| {
        let source = file(boundary);
        // Wider below the arc, and moved to the right.
        let carried = |p: V2| V2::new(p.x * 1.02 + 0.01, p.y + 0.1 * (p.x / 0.2 - 0.5).powi(2) * (0.1 - p.y).max(0.0));
        let pieces = sewn(&source, "");
        let bytes = patched(&source, "x", None, &[Redraw { piece: &pieces[0], carried: &carried }])
            .expect("it is changed")
            .bytes;
        let again = sewn(&bytes, "");
        for p in &pieces[0].outline {
            let off_m = boundary_distance(&again[0].outline, &carried(*p));
            assert!(off_m < 0.6e-3, "{boundary}: {:.3} mm at {p:?}", mm(off_m));
        }
        let ends = |bytes: &[u8]| count(bytes, "\nVERTEX\n") + count(bytes, "\nLINE\n") + count(bytes, "\n10\n");
        assert_eq!(count(&bytes, "LINE\n8"), count(&source, "LINE\n8") + added, "{}", String::from_utf8_lossy(&bytes));
        assert!(ends(&bytes) > ends(&source), "{boundary}");
    };
    let line = |[a, b, c, d]: [i32; 4]| format!("0\nLINE\n8\n1\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n");
    let sides = [[0, 100, 0, 0], [0, 0, 200, 0], [200, 0, 200, 100]].map(line).concat();
    let arc = "0\nARC\n8\n1\n10\n100\n20\n100\n40\n100\n50\n0\n51\n180\n";
    check(&format!("{sides}{arc}"), 3);
    let lines =
        "0\nLWPOLYLINE\n8\n1\n90\n4\n70\n1\n10\n0\n20\n0\n10\n200\n20\n0\n10\n200\n20\n100\n42\n1\n10\n0\n20\n100\n";
    check(lines, 0);
}

fn turned_tee() -> Vec<u8> {
    let half = |piece: Piece| {
        let on_left = |points: &[V2]| -> Vec<V2> { points.iter().copied().filter(|p| p.x > -1e-9).collect() };
        let top = piece.outline.iter().filter(|p| p.x.abs() < 1e-9).fold(0.0_f64, |top, p| top.max(p.y));
        let mut outline = on_left(&piece.outline);
        outline.insert(0, V2::zeros());
        let turn_points = [on_left(&piece.turn_points), vec![V2::zeros()]].concat();
        let notches = piece.notches.iter().copied().filter(|notch| notch.at.x > -1e-9).collect();
        let mirror_line = Some([V2::zeros(), V2::new(0.0, top)]);
        Piece { outline, turn_points, notches, mirror_line, curve_points: on_left(&piece.curve_points), ..piece }
    };
    let turned = |p: &mut V2| *p = V2::new(-p.y, p.x) / 25.4;
    let drafts = Model::Tshirt.drafts().into_iter().take(2);
    let pieces = drafts.flat_map(|draft| draft.pieces).map(|piece| {
        let mut piece = if piece.name.eq_ignore_ascii_case("front") { half(piece) } else { piece };
        let lines = piece.mirror_line.iter_mut().chain(&mut piece.grain).flatten();
        let points = piece.outline.iter_mut().chain(&mut piece.turn_points).chain(&mut piece.curve_points);
        points.chain(piece.notches.iter_mut().map(|notch| &mut notch.at)).chain(lines).for_each(turned);
        piece
    });
    let texts = [("Author", "Ann"), ("Sample Size", "S"), ("Tolerance", "0.02")]
        .map(|(key, value)| (key.to_owned(), value.to_owned()));
    let written = dxf::write_pieces(&pieces.collect::<Vec<_>>(), &texts, Standard::Aama);
    let text = String::from_utf8(written).expect("ASCII").replace("Units: METRIC", "Units: ENGLISH");
    text.into_bytes()
}

#[test]
fn handles_change_the_sizes_of_a_nest_and_keep_its_fold() {
    let source = turned_tee();
    let seams = propose::propose(&sewn(&source, "S")).toml("tee");
    let gaps_m = |style: &Style| -> Vec<f64> {
        let length = |side: &[EdgeRef]| side.iter().map(|edge| style.edge(*edge).line.length()).sum::<f64>();
        style.seams.iter().map(|seam| length(&seam.a) - length(&seam.b)).collect()
    };
    let check = |sizes: &[&str], moves: &[(Handle, f64)]| {
        let of_sizes: Vec<Vec<Piece>> = sizes.iter().map(|size| sewn(&source, size)).collect();
        let redrawn = of_sizes.iter().map(|pieces| Redrawn::of(pieces, seams.as_bytes(), "tee", moves));
        let redrawings: Vec<Redrawn<'_>> = redrawn.map(|redrawn| redrawn.expect("it has them")).collect();
        let carried: Vec<_> = of_sizes
            .iter()
            .zip(&redrawings)
            .flat_map(|(pieces, by)| (0..pieces.len()).map(move |k| (&pieces[k], move |p| by.carried(k, p))))
            .collect();
        let redraws: Vec<Redraw<'_>> = carried.iter().map(|(piece, carried)| Redraw { piece, carried }).collect();
        let bytes = patched(&source, "nest.dxf", None, &redraws).expect("it is changed").bytes;
        for (size, by) in sizes.iter().zip(&redrawings) {
            let before = Style::read(&sewn(&source, size), seams.as_bytes(), "tee").expect("a style");
            let moved = before.moved(moves).expect("it has them");
            let pieces = sewn(&bytes, size);
            let reseamed = by.seams(&pieces, seams.as_bytes(), "tee").expect("its own seams");
            let again = Style::read(&pieces, &reseamed, "tee").expect("its seams hold");
            let apart_mm = mm(outlines_apart_m(&again, &moved));
            assert!(apart_mm < 0.3, "{size} {moves:?}: {apart_mm:.3} mm");
            for (is, was) in gaps_m(&again).iter().zip(gaps_m(&before)) {
                assert!((is - was).abs() < 0.3e-3, "{size} {moves:?}: {:.3} mm", mm(is - was));
            }
        }
        let [before, after] = [&source, &bytes].map(|bytes| dxf::read(bytes, "x", None).expect("a nest"));
        assert_eq!((&after.texts, after.pieces.len()), (&before.texts, before.pieces.len()));
        for (is, was) in after.pieces.iter().zip(&before.pieces) {
            let is_changed = was.size.as_deref().is_some_and(|size| sizes.contains(&size));
            // The block of a size may begin further down in the file.
            let was = &Piece { beside: is.beside.clone(), ..was.clone() };
            assert!(is_changed || is == was, "{} {:?}", is.name, is.size);
            // The fold is the line x = 0, turned.
            let on_fold = |piece: &Piece| piece.outline.iter().filter(|p| p.y.abs() < 1e-9).count();
            assert_eq!(is.mirror_line.is_some(), was.mirror_line.is_some());
            assert!(is.mirror_line.is_none() || on_fold(is) == on_fold(was), "{}", is.name);
            assert_eq!((is.turn_points.len(), is.notches.len()), (was.turn_points.len(), was.notches.len()));
        }
    };
    use Handle::*;
    check(&["S"], &[(Chest, 0.01), (BodyLength, 0.02)]);
    check(&["M"], &[(FrontNeckDepth, 0.01), (SleeveLength, -0.02), (Hem, 0.015)]);
    check(&["S", "M"], &[(ShoulderSlope, 0.006), (ArmholeDepth, 0.01), (Waist, -0.012)]);
}
