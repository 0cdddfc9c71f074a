//! What contact does with single triangles.

use super::grid::BoxGrid;
use super::tangle::{Release, Wings, crossings, edges_of};
use super::{BodyContact, ContactParams, Skin};
use crate::geom::{DistanceField, V3, shapes};
use crate::sim::testing::check_forces;

#[test]
fn a_chord_through_the_body_is_held_out() {
    let radius = 0.06;
    let ball = shapes::sphere(radius, 48);
    let field = DistanceField::build(&ball, 0.005).expect("a closed ball");
    let skin = Skin::new(&ball).expect("a closed ball");
    // Corners 2 mm outside, 50 mm apart: the centre lies inside.
    let x: Vec<V3> = [0.0, 1.0, 2.0]
        .map(|k: f64| {
            let angle = k * std::f64::consts::TAU / 3.0 + 0.3;
            let (r, across) = (radius + 2e-3, 0.05 / 3.0_f64.sqrt());
            V3::new(across * angle.cos(), across * angle.sin(), (r * r - across * across).sqrt())
        })
        .to_vec();
    let triangles = [[0, 1, 2]];
    let mut contact = BodyContact::new(&field, ContactParams::default(), &[1e-4; 3]);
    assert_eq!(contact.energy(&x), 0.0);
    let depth = contact.hold_out(&skin, &triangles, &x, false);
    let expected = radius - x[0].z;
    assert!((depth - expected).abs() < 3e-4, "{depth} for {expected}");
    let mut forces = vec![V3::zeros(); 3];
    contact.add_forces(&x, &mut forces);
    assert!(forces.iter().all(|f| f.z > 0.0));
    check_forces(|x| contact.energy(x), &forces, &x, 1e-7, 1e-6);
    // Pressed in at rest, it is given more room each time.
    let before = contact.energy(&x);
    contact.hold_out(&skin, &triangles, &x, true);
    assert!(contact.energy(&x) > before);
}

#[test]
fn a_corner_that_pokes_through_cloth_is_drawn_back() {
    let sheet = [V3::new(-0.05, -0.05, 0.0), V3::new(0.05, -0.05, 0.0), V3::new(0.0, 0.08, 0.0)];
    let poking = [V3::new(0.0, 0.0, -0.01), V3::new(0.03, 0.0, 0.03), V3::new(-0.03, 0.002, 0.03)];
    let x: Vec<V3> = sheet.into_iter().chain(poking).collect();
    let triangles = [[0, 1, 2], [3, 4, 5]];
    let wings = Wings::new(&triangles);
    let edges = edges_of(&triangles);
    let mut forces = vec![V3::zeros(); x.len()];
    let mut potential = 0.0;
    for crossing in crossings(&x, edges.pairs(), &triangles) {
        let release = Release::of(&x, &wings, &crossing).expect("the line ends at a rim");
        release.add_force(1.0, &mut forces);
        potential += release.potential(&x);
    }
    assert!(forces[3].z > 0.5 && forces[..3].iter().map(|f| f.z).sum::<f64>() < -0.5, "{forces:?}");
    assert!(forces.iter().sum::<V3>().norm() < 1e-12 && potential.is_finite());
}

#[test]
fn the_grid_finds_all_boxes_within_reach_and_no_others() {
    let wave = |k: usize, f: f64| 0.2 * (f * k as f64).sin();
    let x: Vec<V3> = (0..300).map(|k| V3::new(wave(k, 1.7), wave(k, 2.3), wave(k, 0.9))).collect();
    let near = |k: usize| [3 * k, 3 * k + 1, 3 * k + 2];
    let sets: Vec<[usize; 3]> = (0..100).map(near).collect();
    let reach = 0.03;
    let bounds = |set: &[usize]| set.iter().fold((x[set[0]], x[set[0]]), |(l, h), v| (l.inf(&x[*v]), h.sup(&x[*v])));
    let edges: Vec<[usize; 2]> = (0..299).map(|v| [v, v + 1]).collect();
    let half = edges.iter().map(|&[a, b]| (x[a] - x[b]).norm() / 2.0).fold(0.0, f64::max);
    let grid = BoxGrid::new(&x, &sets, reach, half, 0.05);
    for edge in &edges {
        let (low, high) = bounds(edge);
        let meets = |set: &[usize; 3]| {
            let (l, h) = bounds(set);
            (0..3).all(|k| l[k] - reach <= high[k] && low[k] <= h[k] + reach)
        };
        let expected: Vec<usize> = (0..sets.len()).filter(|k| meets(&sets[*k])).collect();
        assert_eq!(grid.near([&x[edge[0]], &x[edge[1]]]).collect::<Vec<_>>(), expected);
    }
}
