//! Equilibria with known answers, whatever the path of the solver.

use crate::cloth::Cloth;
use crate::contact::{BodyContact, ContactParams};
use crate::laboratory::sheets::{shaken, sheet};
use crate::laboratory::{self, settle};
use crate::sewing::unsewn;
use crate::solver::System;
use crate::solver::system::Assembled;
use crate::testing::{check_forces, fabric};
use crate::{Fabric, quality};
use geom::{DistanceField, V2, V3, shapes};
use linalg::linear;
use linalg::pcg::PcgParams;
use nalgebra::Matrix3;
use pattern::Garment;

/// One piece without seams, its grain along v.
fn rectangle(columns: usize, rows: usize, step: f64) -> Garment {
    laboratory::garment(sheet(columns, rows, step))
}

#[test]
fn all_forces_together_are_the_energys() {
    let garment = rectangle(4, 4, 0.02);
    let cloth = Cloth::new(&garment, &fabric(), unsewn(&garment)).expect("sound");
    let field = DistanceField::build(&shapes::sphere(0.06, 24), 0.006).expect("a closed sphere");
    let mut system = System::new(&cloth, BodyContact::new(&field, ContactParams::default(), &cloth.areas), None);
    system.contact.set_friction(std::iter::repeat_n(0.3, cloth.len()));
    let flat: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x - 0.04, p.y - 0.04, 0.06)).collect();
    system.assemble(&flat, None);
    let x = shaken(&flat, 3e-4, 7);
    assert!(system.contact.count() > 0);
    // With the anchors of friction where the cloth lay flat, as in a step.
    check_forces(|x| system.energy(x), &system.forces(&x), &x, 1e-7, 1e-6);
}

#[test]
fn a_tube_too_small_is_stretched_onto_the_body_and_no_further() {
    // A tube of 0.9 the girth of a post must end at the post's girth plus the contact offset, and not inside it.
    let radius = 0.1;
    let profile = [(0.0, -0.3), (radius, -0.3), (radius, -0.1), (radius, 0.1), (radius, 0.3), (0.0, 0.3)];
    let post = shapes::revolve(&profile, 96);
    let field = DistanceField::build(&post, 0.006).expect("a closed post");
    let columns = 60;
    let mut garment = rectangle(columns, 6, 0.9 * std::f64::consts::TAU * radius / 60.0);
    garment.seams = vec![pattern::SeamMesh {
        name: "back".into(),
        pairs: (0..=6).map(|j| [j * (columns + 1), j * (columns + 1) + columns]).collect(),
    }];
    let light = Fabric { density_kg_m2: 1e-3, membrane_coupling_n_m: 0.0, ..fabric() };
    let cloth = Cloth::new(&garment, &light, crate::sewing::welded(&garment)).expect("sound");
    let around = |p: &V2| {
        let angle = std::f64::consts::TAU * p.x / garment.rest[columns].x;
        V3::new(1.02 * radius * angle.cos(), 1.02 * radius * angle.sin(), p.y)
    };
    let mut x = cloth.weld(&garment.rest.iter().map(around).collect::<Vec<_>>());
    let params = ContactParams::default();
    let mut system = System::new(&cloth, BodyContact::new(&field, params, &cloth.areas), None);
    system.weights.fill(0.0);
    settle(&mut system, &mut x, 1e-2, 200);
    let girth: f64 = (0..columns).map(|i| (x[i + 1 - (i + 1) / columns * columns] - x[i]).norm()).sum();
    let expected = std::f64::consts::TAU * radius;
    let bias_mm = (girth - expected) * 1e3;
    // Chords cut the circle by 0.3 mm in all; the offset of 1 mm adds at most 6.3 mm.
    assert!((-0.5..6.5).contains(&bias_mm), "bias {bias_mm} mm");
    assert!(x.iter().all(|p| p.xy().norm() > radius - 2e-4));
}

#[test]
fn crossings_are_counted() {
    let (rest, triangles) = sheet(1, 1, 0.02);
    let flat = rest.iter().map(|p| V3::new(p.x, p.y, 0.0));
    let upright = rest.iter().map(|p| V3::new(0.009, p.y + 0.001, p.x - 0.011));
    let x: Vec<V3> = flat.chain(upright).collect();
    let mut both = triangles.clone();
    both.extend(triangles.iter().map(|t| t.map(|v| v + 4)));
    assert!(quality::self_crossings(&x, &both) > 0);
    assert_eq!(quality::self_crossings(&x[..4], &triangles), 0);
}

#[test]
fn both_solvers_find_the_same_and_patches_sooner() {
    let garment = laboratory::garment(sheet(30, 30, 0.02));
    let cloth = Cloth::new(&garment, &fabric(), unsewn(&garment)).expect("sound");
    let x: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x, p.y, 0.5 + 0.3 * p.x * p.x)).collect();
    let field = DistanceField::build(&shapes::sphere(0.06, 24), 0.006).expect("a closed sphere");
    let mut system = System::new(&cloth, BodyContact::new(&field, ContactParams::default(), &cloth.areas), None);
    let Assembled { forces, mut operator, .. } = system.assemble(&x, None);
    for (block, mass) in operator.diagonal.iter_mut().zip(&cloth.masses) {
        *block += Matrix3::identity() * (mass / 0.01);
    }
    let within = |most: usize, system: &mut System, is_coarse: bool| {
        let params = PcgParams { tolerance: 1e-4, max_iterations: most };
        let mut found = vec![V3::zeros(); x.len()];
        if is_coarse {
            system.linear.solve(&operator, &x, &forces, &mut found, &params);
        } else {
            linear::jacobi(&operator, &forces, &mut found, &params);
        }
        found
    };
    let exact = within(5000, &mut system, false);
    let far = |found: Vec<V3>| {
        let [error, size] = [0.0, 1.0].map(|share: f64| {
            found.iter().zip(&exact).map(|(p, q)| (p * (1.0 - share) - q).norm_squared()).sum::<f64>().sqrt()
        });
        error / size
    };
    let (few, jacobi) = (far(within(40, &mut system, true)), far(within(40, &mut system, false)));
    assert!(far(within(5000, &mut system, true)) < 0.01, "the patches end elsewhere");
    assert!(few < 0.1 * jacobi, "after 40 iterations {few} with patches, {jacobi} without");
}
