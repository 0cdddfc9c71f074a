use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::*;
use crate::pattern::draft::{TshirtSize, tshirt};
use crate::pattern::inspect::{FileReport, PieceReport};

fn shared(folder: &str) -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/patterns")).join(folder);
    if !path.is_dir() {
        println!("skipped: {} is not here", path.display());
        return None;
    }
    Some(path)
}

/// All DXF files of a folder of sample patterns against its table of what they hold.
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
        let mut pieces = FileReport::from(&file).pieces;
        refused += file.refused.len();
        for row in rows {
            blocks += 1;
            let number = |name: &str| row[column(name)].parse::<f64>().ok();
            let perimeter = number("perimeter_mm").expect("a number");
            let distance = |p: &PieceReport| (p.perimeter_mm / perimeter - 1.0).abs();
            // The table shows the names of the Cyrillic file as if they were Windows-1252.
            let is_cyrillic = name.contains("cp1251");
            let nearest = (0..pieces.len())
                .filter(|&i| is_cyrillic || pieces[i].block == row[1])
                .min_by(|&i, &j| distance(&pieces[i]).total_cmp(&distance(&pieces[j])));
            let Some(index) = nearest.filter(|&i| distance(&pieces[i]) < 2e-4) else {
                if !file.refused.iter().any(|refused| refused.block == row[1]) {
                    wrong.push(format!("{name}/{}: {perimeter} mm is lost", &row[1]));
                }
                continue;
            };
            let piece = pieces.remove(index);
            let mut expect = |what: &str, found: f64, tolerance: f64| {
                if let Some(value) = number(what) {
                    if (found - value).abs() > tolerance {
                        wrong.push(format!("{name}/{}: {what} {found} for {value}", &row[1]));
                    }
                }
            };
            expect("area_mm2", piece.area_mm2, 1.0);
            expect("turn_points", piece.turn_points as f64, 0.0);
            expect("curve_points", piece.curve_points as f64, 0.0);
            expect("notches", piece.notches as f64, 0.0);
            expect("grain_mm", piece.grain_mm.unwrap_or(0.0), 0.02);
            expect("sewline_area_mm2", piece.sew_area_mm2.unwrap_or(0.0), 1.0);
            if piece.clockwise != (&row[column("direction")] == "cw") {
                wrong.push(format!("{name}/{}: {piece:?}", &row[1]));
            }
        }
    }
    println!("{folder}: {blocks} blocks, {refused} refused");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(refused, allowed_refusals);
}

#[test]
fn freesewing_files_read_as_their_table_says() {
    // Two pieces of one file cross themselves (simple_polygon 0 in the table).
    check_folder("freesewing", 2);
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
        let file = read(&write(&draft), "tshirt.dxf", None).expect("our own file reads");
        assert_eq!((file.unit, file.unit_source), (Unit::Mm, UnitSource::File));
        assert!(file.refused.is_empty() && file.warnings.is_empty(), "{file:?}");
        assert_eq!(file.pieces.len(), draft.pieces.len());
        for (read, drawn) in file.pieces.iter().zip(&draft.pieces) {
            assert_eq!(
                (&read.block, &read.name, &read.size, &read.quantity, &read.texts),
                (&drawn.block, &drawn.name, &drawn.size, &drawn.quantity, &drawn.texts)
            );
            let same = |a: &[crate::geom::V2], b: &[crate::geom::V2]| {
                a.len() == b.len() && a.iter().zip(b).all(|(p, q)| (p - q).norm() < 1e-7)
            };
            assert!(same(&read.outline, &drawn.outline));
            assert!(same(&read.turn_points, &drawn.turn_points) && same(&read.curve_points, &drawn.curve_points));
            assert_eq!(read.notches.len(), drawn.notches.len());
            assert!(same(&read.grain.expect("grain"), &drawn.grain.expect("grain")));
        }
    }
}
