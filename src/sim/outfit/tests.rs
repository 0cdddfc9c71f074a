use super::*;
use crate::cloth::Cloth;
use crate::fem::Params;
use crate::laboratory::{garment, sheets::shaken, sheets::sheet};
use crate::testing::{check_forces, fabric};
use crate::{Fabric, Silent, fabric, quality, sewing};
use body::Body;
use body::{Dimension, Measurements, Sex};
use geom::DistanceField;
use pattern::draft::Model;
use pattern::{SeamMesh, Style};

/// About the z axis, 0.3 m long.
fn tube(radius_m: f64) -> (Garment, Vec<V3>) {
    let girth_m = std::f64::consts::TAU * radius_m;
    let (columns, edge_m) = (24, girth_m / 24.0);
    let rows = (0.3 / edge_m).round() as usize;
    let mut tube = garment(sheet(columns, rows, edge_m));
    let pairs = (0..=rows).map(|row| [row * (columns + 1), row * (columns + 1) + columns]).collect();
    tube.seams = vec![SeamMesh { name: "side".into(), pairs }];
    let place = |p: &geom::V2| {
        let (sin, cos) = (p.x / radius_m).sin_cos();
        V3::new(radius_m * cos, radius_m * sin, p.y)
    };
    let positions = tube.rest.iter().map(place).collect();
    (tube, positions)
}

#[test]
fn garments_together_are_what_each_is_alone() {
    let (stiff, soft) =
        (fabric(), Fabric { membrane_warp_n_m: 300.0, bending_weft_nm: 1e-6, density_kg_m2: 0.3, ..fabric() });
    let ((one, at_one), (other, at_other)) = (tube(0.1), tube(0.13));
    let cloth =
        |garment: &Garment, fabric: &Fabric| Cloth::new(garment, fabric, sewing::welded(garment)).expect("sound");
    let (alone, beside) = (cloth(&one, &stiff), cloth(&other, &soft));
    let both = Garment::beside(&[&one, &other]);
    let together =
        Cloth::of_layers(&both, &[(one.pieces.len(), &stiff), (other.pieces.len(), &soft)], sewing::welded(&both));
    let together = together.expect("sound");
    let (x, y) = (shaken(&alone.weld(&at_one), 2e-3, 1), shaken(&beside.weld(&at_other), 2e-3, 2));
    let forces = |cloth: &Cloth, x: &[V3]| {
        let mut forces = vec![V3::zeros(); x.len()];
        cloth.add_forces(x, &mut forces);
        forces
    };
    let expected = [forces(&alone, &x), forces(&beside, &y)].concat();
    let found = forces(&together, &[x, y].concat());
    let scale = expected.iter().map(V3::amax).fold(0.0, f64::max);
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).amax() < 1e-9 * scale, "{found} for {expected}");
    }
    assert_eq!(together.masses, [alone.masses, beside.masses].concat());
    let parts = parted(&[&one, &other], &cloth(&both, &stiff).unweld(&vec![V3::zeros(); together.len()]));
    assert_eq!([parts[0].len(), parts[1].len()], [one.rest.len(), other.rest.len()]);
}

#[test]
fn what_is_beyond_its_cover_is_drawn_back_by_the_slope_of_an_energy() {
    let ((cover, at), (inner, _)) = (tube(0.1), tube(0.1));
    let vertex_of = sewing::welded(&inner);
    let cover = Cover::new(&cover, &at).expect("triangles").over(&inner, &vertex_of);
    let check = |p: V3, expect: Option<f64>| {
        let found = cover.trespass(0, &p).map(|(depth, back)| (1e3 * depth, back.dot(&V3::new(p.x, p.y, 0.0))));
        match (found, expect) {
            (Some((depth_mm, back)), Some(expected_mm)) => {
                assert!((depth_mm - expected_mm).abs() < 0.9 && back < 0.0, "{depth_mm} at {p}")
            }
            (found, expect) => assert!(found.is_none() && expect.is_none(), "{found:?} at {p}"),
        }
    };
    // Its chords cut 0.9 mm off the radius.
    check(V3::new(0.12, 0.0, 0.15), Some(21.5));
    check(V3::new(0.0, 0.099, 0.15), Some(0.5));
    check(V3::new(0.05, 0.0, 0.15), None);
    // It goes on a little above its edge.
    check(V3::new(0.12, 0.0, 0.31), Some(21.5));
    check(V3::new(0.12, 0.0, 0.4), None);
    let energy = |x: &[V3]| x.iter().filter_map(|p| cover.trespass(0, p)).map(|(d, _)| 0.5 * d * d).sum::<f64>();
    let x: Vec<V3> = (0..6).map(|k| V3::new(0.12, 0.01 * f64::from(k), 0.11 + 0.013 * f64::from(k))).collect();
    let forces: Vec<V3> = x.iter().map(|p| cover.trespass(0, p).map_or(V3::zeros(), |(d, back)| back * d)).collect();
    check_forces(energy, &forces, &x, 1e-5, 1e-2);
}

#[test]
fn a_shirt_over_another_lies_outside_it_and_both_come_to_rest() {
    let body = body::build(
        &Measurements::of(Sex::Male, 1.75)
            .with(Dimension::ChestGirth, 0.9)
            .with(Dimension::WaistGirth, 0.8)
            .with(Dimension::HipGirth, 0.94),
    )
    .expect("a body");
    let field = DistanceField::build(&body.mesh, 0.006).expect("a closed body");
    let mesh = |size: usize| {
        let draft = &Model::Tshirt.drafts()[size];
        Style::read(&draft.pieces, Model::Tshirt.seams(), "seams").expect("drafted").mesh(0.04).expect("it meshes")
    };
    let cotton = fabric::library().into_iter().find(|f| f.name == "cotton_shirting_light").expect("in the library");
    let (inner, outer) = ([mesh(1)], [mesh(2)]);
    let layers = [&inner, &outer].map(|garments| Layer { garments, fabric: &cotton });
    let params = Params::default();
    let wearer = Wearer { body: &body, field: &field };
    let drapes = dress(wearer, &layers, &params, &mut Silent).expect("worn");
    assert!(drapes.iter().all(|drape| drape.converged && drape.self_crossings == 0));
    let alone = params.alone(wearer, layers[1], 0.0, &mut Silent).expect("worn");
    let top_m = |drape: &Drape| quality::top_m(&outer[0], &drape.positions);
    assert!(top_m(&drapes[1]) - top_m(&alone) > 1e-3, "{} m, alone {} m", top_m(&drapes[1]), top_m(&alone));
    // The body with the inner shirt on is wider at the chest, by no more than the shirt and its folds at the armholes.
    let (dressed, _) = dressed(wearer, &layers[..1], &[drapes[0].positions.clone()], 0.0).expect("a solid");
    let girth_m = |body: &Body| body.girths.get(Dimension::ChestGirth).expect("a trunk");
    let pattern_m = inner[0].fit_levels.iter().find(|level| level.level == "chest").expect("a chest").girth_m;
    let (over_m, bare_m) = (girth_m(&dressed), girth_m(&body));
    assert!(
        (bare_m + 5e-3..pattern_m + 0.02).contains(&over_m),
        "{over_m} m over the shirt of {pattern_m} m, {bare_m} m bare"
    );
}
