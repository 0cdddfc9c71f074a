use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::*;
use crate::draft::{TshirtSize, tshirt};
use crate::inspect::{FileReport, PieceReport};
use geom::V2;

fn shared(folder: &str) -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/patterns")).join(folder);
    if !path.is_dir() {
        eprintln!("skipped: {} is not here", path.display());
        return None;
    }
    Some(path)
}

fn check_folder(folder: &str, allowed_refusals: usize) {
    let Some(path) = shared(folder) else { return };
    let mut rows: BTreeMap<String, Vec<csv::StringRecord>> = BTreeMap::new();
    let mut table = csv::Reader::from_path(path.join("summary.csv")).expect("the table is there");
    let headers = table.headers().expect("it has a head").clone();
    let column = |name: &str| headers.iter().position(|h| h == name).expect("the column is there");
    for row in table.records() {
        let row = row.expect("it is CSV");
        rows.entry(row[0].to_owned()).or_default().push(row);
    }
    let (mut blocks, mut refused) = (0, 0);
    let mut wrong = Vec::new();
    for (name, rows) in rows {
        let plain = path.join("plain-lines").join(&name);
        let (full, unit) = if plain.exists() { (plain, Some(Unit::Cm)) } else { (path.join(&name), None) };
        let bytes = std::fs::read(full).expect("the file is there");
        let file = read(&bytes, &name, unit).unwrap_or_else(|error| panic!("{error}"));
        let mut pieces = FileReport::from(&file).as_written().pieces;
        refused += file.refused.len();
        for row in rows {
            blocks += 1;
            let number = |name: &str| row[column(name)].parse::<f64>().ok();
            let perimeter = number("perimeter_mm").expect("a number");
            let distance = |p: &PieceReport| (p.perimeter_mm / perimeter - 1.0).abs();
            let nearest = (0..pieces.len())
                .filter(|&i| pieces[i].block == row[1])
                .min_by(|&i, &j| distance(&pieces[i]).total_cmp(&distance(&pieces[j])));
            let Some(index) = nearest.filter(|&i| distance(&pieces[i]) < 1e-4) else {
                if !file.refused.iter().any(|refused| refused.block == row[1]) {
                    wrong.push(format!("{name}/{}: {perimeter} mm is lost", &row[1]));
                }
                continue;
            };
            let piece = pieces.remove(index);
            let mut expect = |what: &str, found: f64, tolerance: f64| {
                if let Some(value) = number(what).filter(|value| (found - value).abs() > tolerance) {
                    wrong.push(format!("{name}/{}: {what} {found} for {value}", &row[1]));
                }
            };
            // The table counts loops that are cut away, and segments that are drawn twice. It has the area of the points,
            // from which the quality curve differs by up to 12 mm.
            let followed = format!("block `{}`: its boundary is sewn along its quality curve", &row[1]);
            let is_followed = file.warnings.iter().any(|warning| warning.starts_with(&followed));
            let slack = if &row[column("simple_polygon")] == "0" || is_followed { 5e-2 } else { 1e-3 };
            expect("area_mm2", piece.area_mm2, slack * piece.area_mm2);
            expect("turn_points", piece.turn_points as f64, 0.0);
            expect("curve_points", piece.curve_points as f64, 0.0);
            expect("notches", piece.notches as f64, 0.0);
            expect("mirror_lines", piece.mirror_lines as f64, 0.0);
            // The table counts the sew line that old Valentina draws on layer 8 among the internal lines.
            let is_on_8 = piece.sew_area_mm2.is_some() && row[column("sewline_area_mm2")].is_empty();
            expect("internal_lines", (piece.internal_lines + usize::from(is_on_8)) as f64, 0.0);
            expect("grain_mm", piece.grain_mm.unwrap_or(0.0), 0.02);
            expect("sewline_area_mm2", piece.sew_area_mm2.unwrap_or(0.0), 1.0);
            if piece.clockwise != (&row[column("direction")] == "cw") {
                wrong.push(format!("{name}/{}: {piece:?}", &row[1]));
            }
        }
    }
    eprintln!("{folder}: {blocks} blocks, {refused} refused");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(refused, allowed_refusals);
}

#[test]
fn freesewing_files_read_as_their_table_says() {
    // The cut lines of two pieces of one file cross themselves (simple_polygon 0 in the table); both have a sew line.
    check_folder("freesewing", 0);
}

#[test]
fn valentina_files_read_as_their_table_says() {
    check_folder("valentina", 0);
}

#[test]
fn garmentcode_files_read_as_their_table_says() {
    check_folder("garmentcode", 0);
}

#[test]
fn jblockcreator_files_read_as_their_table_says() {
    check_folder("jblockcreator", 0);
}

#[test]
fn what_is_written_is_read_back() {
    for size in TshirtSize::ALL {
        let draft = tshirt(size);
        let file = read(&draft.dxf(), "tshirt.dxf", None).expect("our own file reads");
        assert_eq!((file.unit, file.unit_source), (Unit::Mm, UnitSource::File));
        assert!(file.refused.is_empty() && file.warnings.is_empty(), "{file:?}");
        assert_eq!(file.pieces.len(), draft.pieces.len());
        for (read, drawn) in file.pieces.iter().zip(&draft.pieces) {
            assert_eq!(
                (&read.block, &read.name, &read.size, &read.quantity, &read.texts),
                (&drawn.block, &drawn.name, &drawn.size, &drawn.quantity, &drawn.texts)
            );
            let same = |a: &[V2], b: &[V2]| a.len() == b.len() && a.iter().zip(b).all(|(p, q)| (p - q).norm() < 1e-7);
            assert!(same(&read.outline, &drawn.outline));
            assert!(same(&read.turn_points, &drawn.turn_points) && same(&read.curve_points, &drawn.curve_points));
            assert_eq!(read.notches.len(), drawn.notches.len());
            assert!(same(&read.grain.expect("grain"), &drawn.grain.expect("grain")));
        }
    }
}

#[test]
fn every_kind_of_line_has_its_layer() {
    let square = |low: f64, high: f64| [[low, low], [high, low], [high, high], [low, high]].map(V2::from).to_vec();
    let hole = [square(0.12, 0.14), vec![V2::new(0.12, 0.12)]].concat();
    let piece = Piece {
        block: "P".into(),
        name: "P".into(),
        outline: square(0.0, 0.2),
        sew_line: Some(square(0.01, 0.19)),
        grain: Some([V2::new(0.1, 0.02), V2::new(0.1, 0.18)]),
        mirror_line: Some([V2::new(0.0, 0.0), V2::new(0.0, 0.2)]),
        grade_reference: Some([V2::new(0.05, 0.1), V2::new(0.15, 0.1)]),
        internal_lines: vec![vec![V2::new(0.03, 0.03), V2::new(0.03, 0.17)]],
        cut_outs: vec![hole],
        drill_holes: vec![V2::new(0.05, 0.15)],
        ..Piece::default()
    };
    let in_micrometres = |line: &[V2]| line.iter().map(|p| (p * 1e6).map(f64::round)).collect::<Vec<_>>();
    for standard in [Standard::Aama, Standard::Astm] {
        let file =
            read(&write_pieces(std::slice::from_ref(&piece), &[], standard), "a.dxf", None).expect("our own file");
        let again = &file.pieces[0];
        let check = |what: &str, lines: fn(&Piece) -> Vec<&[V2]>| {
            let [written, read] = [&piece, again].map(|piece| lines(piece).into_iter().map(in_micrometres));
            assert_eq!(read.collect::<Vec<_>>(), written.collect::<Vec<_>>(), "{what}, {standard:?}");
        };
        check("cut line", |piece| vec![&piece.outline]);
        check("sew line", |piece| piece.sew_line.iter().map(Vec::as_slice).collect());
        check("grain", |piece| piece.grain.iter().map(<[V2; 2]>::as_slice).collect());
        check("mirror line", |piece| piece.mirror_line.iter().map(<[V2; 2]>::as_slice).collect());
        check("grade reference", |piece| piece.grade_reference.iter().map(<[V2; 2]>::as_slice).collect());
        check("internal lines", |piece| piece.internal_lines.iter().map(Vec::as_slice).collect());
        check("cut-outs", |piece| piece.cut_outs.iter().map(Vec::as_slice).collect());
        check("drill holes", |piece| vec![&piece.drill_holes]);
    }
}

#[test]
fn quantities_are_counted_as_the_standard_does() {
    let check = |standard: Standard, written: &str, expect: &str| {
        let mut piece = tshirt(TshirtSize::S).pieces.swap_remove(0);
        piece.quantity = Some(written.to_owned());
        let file = read(&write_pieces(&[piece], &[], standard), "a.dxf", None).expect("our own file");
        assert_eq!(file.pieces[0].quantity.as_deref(), Some(expect), "{standard:?}: {written}");
    };
    check(Standard::Aama, "3", "3");
    check(Standard::Aama, "2,1", "3");
    check(Standard::Aama, "1, 1", "2");
    check(Standard::Astm, "1", "1,0");
    check(Standard::Astm, "2", "1,1");
    check(Standard::Astm, "3", "2,1");
    check(Standard::Astm, "2,1", "2,1");
    check(Standard::Astm, "a pair", "a pair");
}

fn edited(from: &str, to: &str) -> Vec<u8> {
    let text = String::from_utf8(tshirt(TshirtSize::S).dxf()).expect("we write ASCII");
    assert!(text.contains(from), "`{from}` is in the file");
    text.replacen(from, to, 1).into_bytes()
}

#[test]
fn damaged_files_are_refused_with_line_and_finding() {
    let whole = tshirt(TshirtSize::S).dxf();
    let truncated = whole[..whole.len() / 2].to_vec();
    let check = |what: &str, bytes: &[u8], line: Option<usize>, finding: &str| {
        let error = read(bytes, "a.dxf", None).expect_err(what);
        let text = error.to_string();
        assert!(text.starts_with("a.dxf") && text.contains(finding), "{what}: {text}");
        assert!(line.is_none_or(|line| error.line == Some(line)), "{what}: {text}");
        assert!(!error.accepted.is_empty(), "{what}");
    };
    check("empty", b"", None, "empty");
    check("blank", b" \r\n\r\n", None, "empty");
    check("binary", b"AutoCAD Binary DXF\r\n\x1a\x00", Some(1), "binary");
    check("not DXF", b"%PDF-1.7\nhello\n", Some(1), "not DXF");
    check("a picture", b"\x89PNG\r\n\x1a\n\x00\x00", Some(1), "binary");
    check("truncated", &truncated, None, "ends");
    check("cut before EOF", &whole[..whole.len() - 10], None, "ends");
    check("a missing line", &edited("BLOCKS\r\n", ""), None, "group code");
    let line_of = |bytes: &[u8], value: &str| {
        let text = String::from_utf8_lossy(bytes).into_owned();
        text.lines().position(|line| line == value).map(|index| index + 1)
    };
    let comma = edited("\r\n550.7600\r\n", "\r\n550,7600\r\n");
    check("decimal comma", &comma, line_of(&comma, "550,7600"), "`550,7600` for group code 20 of VERTEX");
    let nan = edited("\r\n550.7600\r\n", "\r\nNaN\r\n");
    check("not a number", &nan, line_of(&nan, "NaN"), "`NaN`");
    let unit = edited("Units: METRIC", "Units: CUBITS");
    check("unknown unit", &unit, line_of(&unit, "Units: CUBITS"), "unit `CUBITS`");
    let integer = edited(" 66\r\n1\r\n", " 66\r\n\r\n");
    check("empty integer", &integer, None, "`` for group code 66 of POLYLINE");
    let page = edited("AC1009\r\n", "AC1009\r\n  9\r\n$DWGCODEPAGE\r\n  3\r\nANSI_77\r\n");
    // The code page matters if a text has other letters than ASCII.
    let page = [page.as_slice(), b""].concat();
    let page = String::from_utf8_lossy(&page).replacen("JERSEY", "J\u{1}RSEY", 1).into_bytes();
    let page: Vec<u8> = page.into_iter().map(|byte| if byte == 1 { 0xD6 } else { byte }).collect();
    check("unknown code page", &page, line_of(&page, "ANSI_77"), "ANSI_77");
    check("an unknown group code", &edited(" 66\r\n1\r\n", "150\r\n1\r\n"), None, "undefined group code 150");
    let stray = edited("\r\nVERTEX\r\n", "\r\nVORTEX\r\n");
    check("an unknown entity", &stray, line_of(&stray, "VORTEX"), "`VORTEX`");
    check("an unknown section", &edited("\r\nBLOCKS\r\n", "\r\nBLACKS\r\n"), None, "section `BLACKS`");
    check("a missing coordinate", &edited(" 20\r\n550.7600\r\n", ""), None, "without group code 20");
    check("a block without end", &edited("ENDBLK\r\n  8\r\n0\r\n  0\r\n", ""), None, "inside the block");
}

#[test]
fn unusable_pieces_are_refused_and_the_others_read() {
    let check = |what: &str, bytes: &[u8], finding: &str| {
        let file = read(bytes, "a.dxf", None).unwrap_or_else(|error| panic!("{what}: {error}"));
        assert_eq!((file.pieces.len(), file.refused.len()), (2, 1), "{what}: {:?}", file.refused);
        assert!(
            file.refused[0].block == "FRONT" && file.refused[0].reason.contains(finding),
            "{what}: {:?}",
            file.refused
        );
    };
    // The apex of the V-neck thrown down through the hem.
    check("self-crossing", &edited("\r\n550.7600\r\n", "\r\n-50.0000\r\n"), "crosses itself at (");
    check("out of the world", &edited("\r\n550.7600\r\n", "\r\n1e308\r\n"), "up to 1000 m from the origin");
    check("open", &edited(" 70\r\n1\r\n", " 70\r\n0\r\n"), "does not close: 458.95 mm");
    check("no outline", &edited("POLYLINE\r\n  8\r\n1\r\n", "POLYLINE\r\n  8\r\n99\r\n"), "no outline");
    check(
        "an arc across the neck",
        &edited(" 20\r\n550.7600\r\n", " 20\r\n550.7600\r\n 42\r\n5.0\r\n"),
        "crosses itself at (",
    );
    check(
        "a circle besides",
        &edited(
            "  0\r\nPOLYLINE\r\n",
            "  0\r\nCIRCLE\r\n  8\r\n1\r\n 10\r\n0\r\n 20\r\n0\r\n 40\r\n9\r\n  0\r\nPOLYLINE\r\n",
        ),
        "a second outline",
    );
}

#[test]
fn harmless_oddities_are_read() {
    let whole = read(&tshirt(TshirtSize::S).dxf(), "a.dxf", None).expect("our own file reads").pieces;
    let check = |what: &str, bytes: &[u8]| {
        let mut file = read(bytes, "a.dxf", None).unwrap_or_else(|error| panic!("{what}: {error}"));
        // A block may begin further down in the file.
        file.pieces.iter_mut().zip(&whole).for_each(|(piece, of)| piece.beside.line = of.beside.line);
        assert_eq!(file.pieces, whole, "{what}");
    };
    check("group code 250 on a polyline", &edited(" 66\r\n1\r\n", " 66\r\n1\r\n250\r\n7\r\n"));
    check("a real for an integer", &edited(" 66\r\n1\r\n", " 66\r\n1.000\r\n"));
    check("no SEQEND", &edited("  0\r\nSEQEND\r\n  8\r\n1\r\n", ""));
    check("a comment", &edited("  0\r\nPOLYLINE\r\n", "999\r\nfront\r\n  0\r\nPOLYLINE\r\n"));
    let unix = String::from_utf8(tshirt(TshirtSize::S).dxf()).expect("ASCII").replace("\r\n", "\n");
    check("line feeds only", unix.as_bytes());
}

#[test]
fn units_come_from_the_user_the_texts_or_the_header() {
    let check = |bytes: &[u8], given: Option<Unit>, expect: (Unit, UnitSource), report: &str| {
        let file = read(bytes, "a.dxf", given).expect("it reads");
        assert_eq!((file.unit, file.unit_source), expect);
        assert_eq!(FileReport::from(&file).units, report);
        let told = file.warnings.iter().filter(|said| !said.starts_with("the longest piece")).count();
        assert_eq!(told, usize::from(expect.1 == UnitSource::Assumed || file.unit_remark.is_some()));
        // The user contradicts the file by giving another unit than it names.
        let own =
            read(bytes, "a.dxf", None).is_ok_and(|own| own.unit_source == UnitSource::File && own.unit != expect.0);
        assert_eq!(file.unit_remark.is_some(), given.is_some() && own, "{:?}", file.unit_remark);
        let front = file.pieces[0].perimeter_m() / expect.0.mm_per_unit();
        assert!(
            (front - read(&tshirt(TshirtSize::S).dxf(), "a.dxf", None).expect("it reads").pieces[0].perimeter_m())
                .abs()
                < 1e-9
        );
    };
    let named = |header: &str| {
        let text = String::from_utf8(edited("Units: METRIC", "Note: none")).expect("ASCII");
        text.replacen("AC1009\r\n", &format!("AC1009\r\n{header}"), 1).into_bytes()
    };
    check(&edited("METRIC", "ENGLISH"), None, (Unit::In, UnitSource::File), "in");
    check(&edited("METRIC", "ENGLISH"), Some(Unit::Cm), (Unit::Cm, UnitSource::Given), "cm (given)");
    check(&named(""), None, (Unit::Mm, UnitSource::Assumed), "none, assumed mm");
    check(&named("  9\r\n$INSUNITS\r\n 70\r\n5\r\n"), None, (Unit::Cm, UnitSource::File), "cm");
    check(&named("  9\r\n$MEASUREMENT\r\n 70\r\n0\r\n"), None, (Unit::In, UnitSource::File), "in");
}

#[test]
fn contradictions_and_scaled_blocks_are_warned_of() {
    let check = |bytes: &[u8], expect: &str| {
        let warnings = read(bytes, "a.dxf", None).expect("it reads").warnings;
        assert!(warnings.len() == 1 && warnings[0].contains(expect), "{warnings:?}");
    };
    check(
        &edited("AC1009\r\n", "AC1009\r\n  9\r\n$INSUNITS\r\n 70\r\n1\r\n"),
        "says mm, $INSUNITS (line 14) says in: mm is taken",
    );
    check(&edited("INSERT\r\n", "INSERT\r\n 41\r\n2.0\r\n"), "block `FRONT` is inserted 2 x 1 times");
}

#[test]
fn loops_of_a_cut_line_matter_where_it_is_sewn_alone() {
    // The cut line runs over itself at a corner of the hem, once alone and once beside its sew line.
    let draft = tshirt(TshirtSize::S);
    let looped = |has_sew_line: bool| {
        let mut draft = draft.clone();
        let front = &mut draft.pieces[0];
        front.sew_line = has_sew_line.then(|| front.outline.clone());
        let corner = front.outline[0];
        // Without a sew line, the loop is large enough to be an error.
        let size = if has_sew_line { 1e-3 } else { 2e-3 };
        let point = |x: f64, y: f64| corner + V2::new(x, y) * size;
        front.outline.splice(1..1, [point(10.0, 0.0), point(18.0, -4.0), point(10.0, -4.0), point(18.0, 0.0)]);
        read(&draft.dxf(), "a.dxf", None).expect("it reads")
    };
    let alone = looped(false);
    assert!(alone.refused[0].reason.contains("the outline crosses itself"), "{:?}", alone.refused);
    let beside = looped(true);
    assert_eq!((beside.pieces.len(), beside.refused.len()), (3, 0), "{:?}", beside.refused);
    assert!(
        beside.warnings.iter().any(|said| said.contains("its cut line crosses itself at (")),
        "{:?}",
        beside.warnings
    );
    assert_eq!(beside.pieces[0].seam_outline().len(), draft.pieces[0].outline.len());
    // The perimeter is that of the drawing: 8 mm of the hem there and back, by two slants.
    let longer_mm = FileReport::from(&beside).pieces[0].perimeter_mm - 1e3 * draft.pieces[0].perimeter_m();
    assert!((longer_mm - 2.0 * 80.0_f64.sqrt()).abs() < 0.01, "{longer_mm} mm longer");
}

#[test]
fn only_a_named_size_in_a_named_unit_is_sewn() {
    let file = |bytes: &[u8]| read(bytes, "a.dxf", None).expect("it reads");
    let whole = file(&tshirt(TshirtSize::S).dxf());
    assert_eq!(whole.to_sew(None).expect("one size").len(), 3);
    assert_eq!(whole.to_sew(Some("s")), whole.to_sew(Some("S")));
    let refuse = |file: &PatternFile, size: Option<&str>, expect: &str| {
        let error = file.to_sew(size).expect_err(expect).to_string();
        assert!(error.contains(expect), "{error}");
    };
    refuse(&whole, Some("XL"), "no size `XL`; accepted: one of S");
    refuse(&file(&edited("Size: S", "Size: M")), None, "2 sizes; accepted: one of S, M");
    refuse(&file(&edited("Units: METRIC", "Note: none")), None, "found no unit");
    let crossed = file(&edited("\r\n550.7600\r\n", "\r\n-50.0000\r\n"));
    let line = crossed.refused[0].line.expect("it is a block");
    refuse(&crossed, None, &format!("a.dxf, line {line}, block `FRONT`: found the outline crosses itself"));
}

#[test]
fn pieces_are_joined_over_sizes_by_their_names_whatever_sizes_are_called() {
    let check = |names: [[&str; 2]; 3], expect: [[&str; 3]; 2]| {
        let piece =
            |size: &str, name: &str| Piece { name: name.to_owned(), size: Some(size.to_owned()), ..Piece::default() };
        let pieces_of = |(size, names): (&str, [&str; 2])| names.map(|name| piece(size, name)).to_vec();
        let sizes: Vec<Vec<Piece>> = ["1", "2", "3"].into_iter().zip(names).map(pieces_of).collect();
        for mut pieces in sizes.clone() {
            join_sizes(&mut pieces, &sizes);
            for (piece, expect) in pieces.iter().zip(expect) {
                let found: Vec<&str> = piece.beside.sizes.iter().map(|other| other.name.as_str()).collect();
                assert_eq!(found, expect, "{names:?}");
            }
        }
    };
    check([["SLEEVE 1", "SLEEVE 2"]; 3], [["SLEEVE 1"; 3], ["SLEEVE 2"; 3]]);
    check([["FRONT", "FRONT"]; 3], [["FRONT"; 3]; 2]);
    check(
        [["FRONT 1", "BACK 1"], ["FRONT 2", "BACK 2"], ["FRONT 3", "BACK 3"]],
        [["FRONT 1", "FRONT 2", "FRONT 3"], ["BACK 1", "BACK 2", "BACK 3"]],
    );
}

#[test]
fn graded_half_pieces_open_for_sewing() {
    let Some(path) = shared("freesewing") else { return };
    let bytes = std::fs::read(path.join("teagan_nest_aama-inch.dxf")).expect("the file is there");
    let file = read(&bytes, "nest.dxf", None).expect("it reads");
    assert_eq!(file.sizes(), ["28", "32", "34", "36", "38", "40", "42", "44"]);
    let pieces = file.to_sew(Some("36")).expect("size 36 is there");
    let area = |name: &str| pieces.iter().find(|piece| piece.name == name).expect("it is there").area_m2() * 1e6;
    // Twice the half front and half back of the table; the sleeve is whole.
    for (name, expect) in
        [("TEAGAN FRONT", 2.0 * 147_451.7), ("TEAGAN BACK", 2.0 * 152_646.6), ("TEAGAN SLEEVE", 47_893.1)]
    {
        assert!((area(name) - expect).abs() < 1.0, "{name}: {}", area(name));
    }
    let unfolded = FileReport::from(&file).pieces.iter().filter(|piece| piece.unfolded).count();
    assert_eq!(unfolded, 16);
}

#[test]
fn what_the_sample_size_says_of_a_piece_holds_for_every_size() {
    let drafts = crate::draft::Model::Tshirt.drafts();
    let mut pieces: Vec<Piece> = drafts.into_iter().flat_map(|draft| draft.pieces).collect();
    for piece in &mut pieces {
        let is_sample = piece.size.as_deref() == Some("M");
        piece.quantity = is_sample.then(|| "2".to_owned());
        piece.texts = if is_sample { vec![("Category".to_owned(), "top".to_owned())] } else { Vec::new() };
    }
    let file = read(&write_pieces(&pieces, &[], Standard::Aama), "a.dxf", None).expect("our own file");
    assert_eq!(file.sizes().len(), 3);
    for piece in &file.pieces {
        assert_eq!((piece.quantity.as_deref(), piece.texts.len()), (Some("2"), 1), "{} {:?}", piece.name, piece.size);
    }
}

#[test]
fn names_follow_the_code_page() {
    let text = String::from_utf8(edited("AC1009\r\n", "AC1009\r\n  9\r\n$DWGCODEPAGE\r\n  3\r\nANSI_1251\r\n"))
        .expect("ASCII");
    let text = text.replace("SLEEVE", "Рукав");
    let (bytes, _, _) = encoding_rs::WINDOWS_1251.encode(&text);
    let file = read(&bytes, "a.dxf", None).expect("it reads");
    assert_eq!((file.pieces[2].block.as_str(), file.pieces[2].name.as_str()), ("Рукав", "Рукав"));
    let report = FileReport::from(&file);
    assert_eq!((report.pieces[2].block.as_str(), report.pieces[2].name.as_str()), ("Рукав", "Рукав"));
    assert_eq!(report.as_written().pieces[2].block, "Ðóêàâ");
}

/// Files that are damaged on purpose.
const SAMPLES: [&str; 4] = [
    "freesewing/teagan_cisFemaleAdult36_c3d.dxf",
    "freesewing/teagan_nest_aama-inch.dxf",
    "valentina/TShirt_test.v0.7.52.astm-2000.dxf",
    "valentina/notchbug.v1.1.1.astm-r12.dxf",
];

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(64))]

    #[test]
    fn truncated_files_are_refused(share in 0.0..1.0_f64) {
        let whole = tshirt(TshirtSize::S).dxf();
        let length = (share * (whole.len() - 5) as f64) as usize;
        proptest::prop_assert!(read(&whole[..length], "a.dxf", None).is_err());
    }

    #[test]
    fn mutated_files_never_panic_and_never_lose_a_piece_in_silence(edits in proptest::collection::vec((0.0..1.0_f64, proptest::num::u8::ANY), 1..6)) {
        let mut bytes = tshirt(TshirtSize::S).dxf();
        for (share, byte) in edits {
            let index = (share * bytes.len() as f64) as usize;
            bytes[index] = byte;
        }
        if let Ok(file) = read(&bytes, "a.dxf", None) {
            proptest::prop_assert_eq!(file.pieces.len() + file.refused.len(), 3);
        }
    }

    #[test]
    fn files_with_missing_lines_never_panic_and_never_lose_a_piece_in_silence(gap in 0.0..1.0_f64, count in 1..5_usize) {
        let text = String::from_utf8(tshirt(TshirtSize::S).dxf()).expect("we write ASCII");
        let mut lines: Vec<&str> = text.lines().collect();
        let first = (gap * (lines.len() - count) as f64) as usize;
        lines.drain(first..first + count);
        if let Ok(file) = read(lines.join("\n").as_bytes(), "a.dxf", None) {
            proptest::prop_assert_eq!(file.pieces.len() + file.refused.len(), 3);
        }
    }

    #[test]
    fn damaged_files_of_other_programs_never_lose_a_piece_in_silence(
        file in 0..SAMPLES.len(),
        cuts in proptest::collection::vec((0.0..1.0_f64, 0..40_usize), 1..3),
    ) {
        let Some(path) = shared("") else { return Ok(()) };
        let mut bytes = std::fs::read(path.join(SAMPLES[file])).expect("the file is there");
        let blocks = |file: &PatternFile| file.pieces.len() + file.refused.len();
        let whole = blocks(&read(&bytes, "a.dxf", None).expect("it reads"));
        for (share, count) in cuts {
            let first = (share * (bytes.len() - count) as f64) as usize;
            bytes.drain(first..first + count);
        }
        if let Ok(file) = read(&bytes, "a.dxf", None) {
            proptest::prop_assert_eq!(blocks(&file), whole);
        }
    }

    #[test]
    fn files_with_foreign_numbers_and_texts_give_pieces_that_can_be_used(
        file in 0..SAMPLES.len(),
        edits in proptest::collection::vec((0.0..1.0_f64, 0.0..1.0_f64, 0..7_usize), 1..12),
    ) {
        let Some(path) = shared("") else { return Ok(()) };
        let bytes = std::fs::read(path.join(SAMPLES[file])).expect("the file is there");
        let mut lines: Vec<Vec<u8>> = bytes.split(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
        let last = (lines.len() - 1) as f64;
        for (first, second, edit) in edits {
            let (i, j) = ((first * last) as usize, (second * last) as usize);
            let foreign: &[u8] = match edit {
                0 => { lines.swap(i, j); continue }
                1 => { lines[i] = lines[j].clone(); continue }
                2 => b"NaN",
                3 => b"1e308",
                4 => b"-inf",
                5 => b"\xff\xfe\xd0\x00",
                _ => b"4294967296.5",
            };
            lines[i] = foreign.to_vec();
        }
        if let Ok(file) = read(&lines.join(&b'\n'), "a.dxf", Some(Unit::Mm)) {
            for piece in &file.pieces {
                proptest::prop_assert!(piece.area_m2() > 0.0 && piece.perimeter_m().is_finite());
            }
            for size in file.sizes() {
                let Ok(pieces) = file.to_sew(Some(size)) else { continue };
                for seam in crate::propose::propose(&pieces).seams {
                    proptest::prop_assert!((0.0..=1.0).contains(&seam.confidence));
                }
            }
        }
    }

    #[test]
    fn any_bytes_never_panic(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..400)) {
        let _ = read(&bytes, "a.dxf", None);
    }
}
