use std::collections::BTreeMap;

use super::trunk::SHOULDER_SLOPE_DEG;
use super::*;
use crate::curve::CURVE_SEGMENTS;
use crate::{MeshQuality, Style, dxf};
use geom::polyline::self_crossing;
use geom::units::{from_mm, mm};

fn style(model: Model, (name, bytes): &(String, Vec<u8>)) -> Style {
    let file = dxf::read(bytes, name, None).expect("our own file reads");
    assert_eq!((file.refused.len(), file.warnings.len()), (0, 0), "{name}: {:?} {:?}", file.refused, file.warnings);
    Style::read(&file.pieces, model.seams(), model.as_str()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn styles() -> Vec<(Model, Style, Vec<f64>)> {
    let sizes_of = |model: Model| {
        let sizes = model.published_mm();
        let files = model.files();
        assert_eq!(files.len(), sizes.len() + 1, "a file a size and the seams");
        sizes.into_iter().zip(files).map(move |((size, lengths), file)| {
            let style = style(model, &file);
            assert_eq!(style.size, size);
            (model, style, lengths)
        })
    };
    Model::ALL.into_iter().flat_map(sizes_of).collect()
}

#[test]
fn the_files_sew_into_the_published_lengths() {
    assert_eq!(styles().len(), 9);
    for (model, style, lengths) in styles() {
        assert_eq!(style.measurements.len(), lengths.len());
        for (measurement, expect) in style.measurements.iter().zip(lengths) {
            let found = mm(measurement.l2d_m);
            let what = format!("{model:?} {} #{} {}", style.size, measurement.no, measurement.name);
            assert!((found - expect).abs() < 0.1, "{what}: {found:.3} mm for {expect:.2}");
        }
    }
}

fn published_table() -> Option<BTreeMap<(String, String, usize), f64>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/thesis/published_measurements.csv");
    let text = std::fs::read_to_string(path).ok()?;
    let rows = text.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    // Tables 6-21 (a waist that is none) and 6-27 (two equal columns) are those that the audit doubts.
    let sound = rows.filter(|row| !["6-21", "6-27"].contains(&row[0]));
    let parsed = sound.map(|row| {
        let no = row[4].parse().expect("a number");
        ((row[1].to_owned(), row[2].to_uppercase(), no), row[6].parse().expect("a length"))
    });
    Some(parsed.collect())
}

#[test]
fn the_lengths_drafted_to_are_those_of_the_tables() {
    let Some(mut table) = published_table() else {
        eprintln!("skipped: no thesis tables beside the checkout");
        return;
    };
    let garments = [
        (Model::Tshirt, "male_tshirt"),
        (Model::Trousers, "male_trousers"),
        (Model::Teetop, "female_teetop"),
        (Model::Dress, "female_dress"),
    ];
    for (model, garment) in garments {
        for (size, lengths) in model.published_mm() {
            for (k, length) in lengths.into_iter().enumerate() {
                let row = table.remove(&(garment.to_owned(), size.to_owned(), k + 1));
                assert_eq!(row, Some(length), "{garment} {size} #{}", k + 1);
            }
        }
    }
    assert!(table.is_empty(), "not drafted: {table:?}");
}

#[test]
fn every_style_states_its_girth_for_the_fit() {
    let expect = |model: Model, lengths: &[f64]| -> Vec<(&str, f64)> {
        match model {
            Model::Tshirt | Model::Teetop => vec![("chest", lengths[0])],
            Model::Trousers => vec![("hip", lengths[4] + 40.0)],
            Model::Dress => vec![("chest", 960.0), ("hip", lengths[1])],
        }
    };
    for (model, style, lengths) in styles() {
        let expect = expect(model, &lengths);
        assert_eq!(style.fit_levels.len(), expect.len());
        for ((level, path), (name, girth)) in style.fit_levels.iter().zip(expect) {
            let found = mm(style.path_length_m(path));
            assert_eq!(level, name);
            assert!((found - girth).abs() < 0.1, "{model:?} {} {level}: {found:.2} mm", style.size);
        }
    }
}

#[test]
fn the_pieces_are_whole_and_mesh_well() {
    for (model, style, _) in styles() {
        for piece in &style.pieces {
            assert_eq!(self_crossing(&piece.outline()), None, "{model:?} {} {}", style.size, piece.id);
            assert!(piece.edges.iter().all(|edge| edge.name.is_some()), "{model:?} {}: an unnamed edge", piece.id);
            assert!(piece.notches.len() >= 3);
        }
        let garment = style.mesh(from_mm(30.0)).unwrap_or_else(|error| panic!("{model:?}: {error}"));
        let quality = MeshQuality::of(&garment).expect("it has triangles");
        assert!(quality.min_angle_deg > 15.0, "{model:?} {}: {quality:?}", style.size);
    }
}

#[test]
fn the_studies_hold_what_is_drafted() {
    let check = |folder: &str, model: Model| {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        for (name, bytes) in model.files() {
            let kept = std::fs::read(format!("{root}/{folder}/{name}")).unwrap_or_else(|e| panic!("{name}: {e}"));
            let command = format!("toile pattern draft {} -o {folder}", model.as_str());
            assert!(kept == bytes, "{name} is not what is drafted now: run `{command}`");
        }
    };
    check("studies/quickstart/patterns", Model::Tshirt);
    for model in Model::ALL {
        check("studies/thesis/patterns", model);
    }
}

#[test]
fn curves_meet_their_neighbours_as_a_pattern_maker_draws_them() {
    for size in TshirtSize::ALL {
        let body = tshirt::trunk(&size.published_mm().map(from_mm));
        let along = |curve: &[geom::V2], k: usize| (curve[k + 1] - curve[k]).normalize();
        let shoulder = (body.front_armhole[0] - body.front_neck[CURVE_SEGMENTS]).normalize();
        assert!(((-shoulder.y).asin().to_degrees() - SHOULDER_SLOPE_DEG).abs() < 1e-6);
        for curve in [&body.front_armhole, &body.back_armhole] {
            assert!(along(curve, 0).dot(&shoulder).abs() < 0.05, "armhole square to the shoulder");
            assert!(along(curve, CURVE_SEGMENTS - 1).y.abs() < 0.05, "armhole square to the side");
        }
        for curve in [&body.front_neck, &body.back_neck] {
            assert!(along(curve, CURVE_SEGMENTS - 1).dot(&shoulder).abs() < 0.05, "neck square to the shoulder");
        }
        assert!(along(&body.back_neck, 0).y.abs() < 0.05, "back neck square to the centre");
        let width = mm(body.front_neck[CURVE_SEGMENTS].x);
        assert!((width - 80.0).abs() < 0.5, "{size:?}: half neck width {width}");
    }
}

#[test]
fn the_legs_join_without_a_peak_at_fork_and_knee() {
    for (model, style, _) in styles().into_iter().filter(|(model, ..)| *model == Model::Trousers) {
        for piece in &style.pieces {
            let edge = |name: &str| {
                let found = piece.edges.iter().find(|edge| edge.name.as_deref() == Some(name));
                &found.unwrap_or_else(|| panic!("{}: no {name}", piece.id)).line
            };
            let (inseam, crotch) = (edge("inseam"), edge("crotch_lower"));
            // Directions of both edges away from the fork, which they share.
            let fork = if inseam.at(0.0) == crotch.at(crotch.length()) {
                [0.0, crotch.length()]
            } else {
                [inseam.length(), 0.0]
            };
            let away = |line: &geom::polyline::Polyline, arc: f64| {
                let near = if arc > 0.0 { arc - 1e-4 } else { 1e-4 };
                (line.at(near) - line.at(arc)).normalize()
            };
            let angle = away(inseam, fork[0]).angle(&away(crotch, fork[1])).to_degrees();
            assert!((angle - 90.0).abs() < 2.0, "{model:?} {} {}: {angle} degrees at the fork", style.size, piece.id);
            let turns = inseam.points().windows(3).map(|p| (p[1] - p[0]).angle(&(p[2] - p[1])).to_degrees());
            assert!(turns.fold(0.0, f64::max) < 3.0, "{}: the inseam has a corner", piece.id);
        }
    }
}
