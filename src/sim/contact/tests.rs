//! Tests of contact on single triangles and small sheets.

use super::grid::BoxGrid;
use super::intersections::{Release, Wings, edges_of, held_apart, intersections};
use super::{BodyContact, ClothContact, ClothContactParams, ContactParams, Skin};
use crate::cloth::Cloth;
use crate::laboratory::{self, settle, sheets::sheet};
use crate::quality;
use crate::sewing::unsewn;
use crate::solver::System;
use crate::testing::{check_forces, fabric};
use geom::{DistanceField, V2, V3, shapes};

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
    let mesh: (&[[usize; 2]], &[[usize; 3]]) = (&[[0, 1], [0, 2], [1, 2]], &[[0, 1, 2]]);
    let mut contact = BodyContact::new(&field, ContactParams::default(), &[1e-4; 3]);
    assert_eq!(contact.energy(&x), 0.0);
    let depth = contact.hold_out(&skin, mesh, &x, false);
    let expected = radius - x[0].z;
    assert!((depth - expected).abs() < 3e-4, "{depth} for {expected}");
    let mut forces = vec![V3::zeros(); 3];
    contact.add_forces(&x, &mut forces);
    assert!(forces.iter().all(|f| f.z > 0.0));
    check_forces(|x| contact.energy(x), &forces, &x, 1e-7, 1e-6);
    // At rest and still inside, its offset grows each time.
    let before = contact.energy(&x);
    contact.hold_out(&skin, mesh, &x, true);
    assert!(contact.energy(&x) > before);
}

#[test]
fn friction_forgets_how_deep_a_contact_was_before() {
    let radius = 5e-3;
    let field = DistanceField::build(&shapes::sphere(radius, 48), 5e-4).expect("a closed ball");
    let on = |angle: f64, height_m: f64| vec![V3::new(angle.sin(), 0.0, angle.cos()) * (radius + height_m)];
    // Pressed in at the pole in steps, then moved along the ball, whose normal turns.
    let held = |heights_m: &[f64]| {
        let mut contact = BodyContact::new(&field, ContactParams::default(), &[1e-4]);
        contact.set_friction(std::iter::once(0.3));
        let mut assembled = |x: &[V3]| {
            let (mut forces, mut diagonal) = (vec![V3::zeros()], vec![nalgebra::Matrix3::zeros()]);
            contact.assemble(x, &mut forces, &mut diagonal);
            contact.drag_anchors(x);
            forces[0]
        };
        for &height_m in heights_m {
            assembled(&on(0.0, height_m));
        }
        assembled(&on(0.02, 1e-4))
    };
    let (at_once, by_steps) = (held(&[1e-4]), held(&[9e-4, 5e-4, 1e-4]));
    assert!(at_once.dot(&V3::new(0.02_f64.cos(), 0.0, -0.02_f64.sin())) < 0.0, "it is not held: {at_once}");
    assert!((at_once - by_steps).norm() < 1e-9 * at_once.norm(), "{by_steps} for {at_once}");
}

fn poking(height: f64) -> Vec<V3> {
    let sheet = [V3::new(-0.05, -0.05, 0.0), V3::new(0.05, -0.05, 0.0), V3::new(0.0, 0.08, 0.0)];
    let poking = [V3::zeros(), V3::new(0.03, 0.0, 0.04), V3::new(-0.03, 0.002, 0.04)];
    sheet.into_iter().chain(poking.map(|p| p + V3::new(0.0, 0.0, height))).collect()
}

#[test]
fn a_corner_that_pokes_through_cloth_is_drawn_back() {
    let x = poking(-0.01);
    let triangles = [[0, 1, 2], [3, 4, 5]];
    let wings = Wings::new(&triangles);
    let edges = edges_of(&triangles);
    let mut forces = vec![V3::zeros(); x.len()];
    let mut potential = 0.0;
    for crossing in intersections(&x, edges.pairs(), &triangles) {
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
    let grid = BoxGrid::new(&x, &sets, reach, 0.05);
    let mut found = Vec::new();
    for edge in &edges {
        let (low, high) = bounds(edge);
        let meets = |set: &[usize; 3]| {
            let (l, h) = bounds(set);
            (0..3).all(|k| l[k] - reach <= high[k] && low[k] <= h[k] + reach)
        };
        let expected: Vec<usize> = (0..sets.len()).filter(|k| meets(&sets[*k])).collect();
        assert_eq!(grid.near([&x[edge[0]], &x[edge[1]]], &mut found), expected);
    }
}

fn two_sheets() -> (Vec<V2>, Vec<V2>, Vec<[usize; 3]>) {
    let ((large, mut triangles), (small, others)) = (sheet(4, 4, 0.02), sheet(1, 1, 0.005));
    triangles.extend(others.iter().map(|t| t.map(|v| v + large.len())));
    (large, small, triangles)
}

#[test]
fn cloth_is_pushed_off_cloth_and_no_step_takes_it_through() {
    let (large, small, triangles) = two_sheets();
    let sheets_at = |[x, y, z]: [f64; 3]| -> Vec<V3> {
        let upper = small.iter().map(|p| V3::new(p.x + 0.033 + x, p.y + 0.0305 + y, z));
        large.iter().map(|p| V3::new(p.x, p.y, 0.0)).chain(upper).collect()
    };
    let areas = vec![1e-4; large.len() + small.len()];
    let contact_at = |place: [f64; 3]| {
        let mut contact = ClothContact::new(ClothContactParams::default(), &triangles, &areas);
        contact.update(&sheets_at(place));
        contact
    };
    let above = contact_at([0.0, 0.0, 3e-3]);
    assert_eq!(above.energy(&sheets_at([0.0, 0.0, 2.5e-3])), 0.0);
    for height in [1.3e-3, 4e-4] {
        let x = sheets_at([0.0, 0.0, height]);
        let mut forces = vec![V3::zeros(); areas.len()];
        assert!(above.assemble(&x, &mut forces).len() >= 4);
        assert!(forces[large.len()..].iter().all(|f| f.z > 0.0));
        check_forces(|x| above.energy(x), &forces, &x, 1e-9, 1e-5);
    }
    // Through it, or beyond the pairs that were searched: never. Along it: freely.
    assert_eq!(above.energy(&sheets_at([0.0, 0.0, -1e-3])), f64::INFINITY);
    assert_eq!(above.energy(&sheets_at([0.0, 0.0, -5e-3])), f64::INFINITY);
    assert_eq!(above.energy(&sheets_at([0.0, 0.0, 0.05])), f64::INFINITY);
    let near = contact_at([0.0, 0.0, 3e-4]);
    assert!(near.energy(&sheets_at([2e-3, -1e-3, 3e-4])).is_finite());
}

#[test]
fn what_falls_together_goes_far_and_what_closes_in_does_not() {
    let (large, small, triangles) = two_sheets();
    let sheets_at = |fallen: f64, height: f64| -> Vec<V3> {
        let upper = small.iter().map(|p| V3::new(p.x + 0.033, p.y + 0.0305, height - fallen));
        large.iter().map(|p| V3::new(p.x, p.y, -fallen)).chain(upper).collect()
    };
    let areas = vec![1e-4; large.len() + small.len()];
    let mut contact = ClothContact::new(ClothContactParams::default(), &triangles, &areas);
    contact.update(&sheets_at(0.0, 5e-3));
    contact.update(&sheets_at(5e-3, 5e-3));
    let by = |to: &[V3]| -> Vec<V3> { to.iter().zip(sheets_at(5e-3, 5e-3)).map(|(p, q)| p - q).collect() };
    let (together, closing) = (sheets_at(0.015, 5e-3), sheets_at(5e-3, -5e-3));
    assert!(contact.free_path_m() < 5e-3 && contact.free_share(&by(&together)) > 1.0);
    assert_eq!(contact.energy(&together), 0.0);
    let share = contact.free_share(&by(&closing));
    assert!((0.1..1.0).contains(&share), "{share}");
    assert_eq!(contact.energy(&closing), f64::INFINITY);
    // Farther than pairs were searched it may not go, even together.
    assert_eq!(contact.energy(&sheets_at(0.05, 5e-3)), f64::INFINITY);
}

#[test]
fn triangles_side_by_side_do_not_fold_through_each_other() {
    // A strip of three squares; the last is turned about its edge onto the first, and through it.
    let (rest, triangles) = sheet(3, 1, 0.015);
    let turned = |degrees: f64| -> Vec<V3> {
        let place = |p: &V2| {
            let bend = |from: f64, angle: f64| ((p.x - from).max(0.0), angle.to_radians());
            let (past, angle) = bend(0.015, degrees);
            let (further, second) = bend(0.03, 2.0 * degrees);
            let along = past - further;
            let x = p.x.min(0.015) + along * angle.cos() + further * second.cos();
            V3::new(x, p.y, along * angle.sin() + further * second.sin())
        };
        rest.iter().map(place).collect()
    };
    let areas = vec![1e-4; rest.len()];
    let edges = edges_of(&triangles);
    let count = |x: &[V3]| intersections(x, edges.pairs(), &triangles).len();
    // 120 degrees closes the strip to a triangle; 128 takes its end through its beginning.
    assert_eq!((count(&turned(112.0)), count(&turned(128.0)) > 0), (0, true));
    let mut contact = ClothContact::new(ClothContactParams::default(), &triangles, &areas);
    contact.update(&turned(112.0));
    assert!(contact.energy(&turned(114.0)).is_finite());
    assert_eq!(contact.energy(&turned(128.0)), f64::INFINITY);
}

#[test]
fn a_load_does_not_press_cloth_through_cloth() {
    // A sheet held at its rim carries another under 20 kPa: ten times what a spring over the thickness can take.
    let ((large, mut triangles), (small, others)) = (sheet(6, 6, 0.015), sheet(2, 2, 0.012));
    triangles.extend(others.iter().map(|t| t.map(|v| v + large.len())));
    let rest: Vec<V2> = large.iter().copied().chain(small.iter().map(|p| p + V2::new(0.2, 0.0))).collect();
    let mut x: Vec<V3> = large.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
    x.extend(small.iter().map(|p| V3::new(p.x + 0.031, p.y + 0.034, 3e-3)));
    let garment = laboratory::garment((rest, triangles));
    let cloth = Cloth::new(&garment, &fabric(), unsewn(&garment)).expect("sound");
    let field = laboratory::nowhere();
    let mut system = System::new(&cloth, BodyContact::new(&field, ContactParams::default(), &cloth.areas), None);
    system.self_contact = Some(ClothContact::new(ClothContactParams::default(), &cloth.triangles, &cloth.areas));
    let is_rim = |p: &V2| p.x < 1e-9 || p.y < 1e-9 || p.x > 0.0899 || p.y > 0.0899;
    system.held = (0..large.len()).filter(|&v| is_rim(&large[v])).collect();
    for v in 0..x.len() {
        system.weights[v] = if v < large.len() { 0.0 } else { 2e4 * cloth.areas[v] };
    }
    settle(&mut system, &mut x, 1e-2, 150);
    assert_eq!(quality::self_crossings(&x, &cloth.triangles), 0);
    let lowest = x[large.len()..].iter().map(|p| p.z).fold(f64::MAX, f64::min);
    assert!(lowest < -3e-3, "the load is felt: {lowest}");
    // The cloth that carries it is below it.
    let below = x[..large.len()].iter().map(|p| p.z).fold(f64::MAX, f64::min);
    assert!((lowest - below).abs() < 4e-3, "{lowest} over {below}");
}

#[test]
fn what_does_not_come_free_is_drawn_harder_until_it_does() {
    let areas = [1e-4; 6];
    let mut contact = ClothContact::new(ClothContactParams::default(), &[[0, 1, 2], [3, 4, 5]], &areas);
    let mut pull = |x: &[V3]| {
        contact.update(x);
        let mut forces = vec![V3::zeros(); areas.len()];
        contact.assemble(x, &mut forces);
        forces[3..].iter().sum::<V3>().z
    };
    let first = pull(&poking(-0.01));
    assert!(first > 0.0);
    let later: Vec<f64> = (0..20).map(|_| pull(&poking(-0.01))).collect();
    assert!(later[19] > 3.0 * first && later.windows(2).all(|w| w[1] >= w[0]), "{first}, then {later:?}");
    // Free cloth is pushed apart by contact alone, and the next crossing begins anew.
    assert_eq!(pull(&poking(0.01)), 0.0);
    assert_eq!(pull(&poking(-0.01)), first);
}

#[test]
fn what_has_been_drawn_for_long_enough_passes_for_good() {
    let (areas, triangles) = ([1e-4; 6], [[0, 1, 2], [3, 4, 5]]);
    let check = |crossed_for: usize, passes: bool| {
        let params = ClothContactParams { release_steps: 3, ..ClothContactParams::default() };
        let mut contact = ClothContact::new(params, &triangles, &areas);
        (0..crossed_for).for_each(|_| contact.update(&poking(-1e-3)));
        // Free again and at rest, its contact has its whole thickness.
        contact.update(&poking(1e-4));
        assert_eq!(contact.ripen(), !passes, "after {crossed_for} steps");
        assert_eq!(contact.pressed_energy(&poking(1e-4)) == 0.0, passes, "after {crossed_for} steps");
        assert_eq!(contact.is_untangled(), !passes, "after {crossed_for} steps");
    };
    check(1, false);
    check(2, false);
    check(3, true);
    check(9, true);
}

#[test]
fn what_has_come_free_is_pushed_apart_little_by_little() {
    let (areas, triangles) = ([1e-4; 6], [[0, 1, 2], [3, 4, 5]]);
    let contact = || ClothContact::new(ClothContactParams::default(), &triangles, &areas);
    let push = |contact: &mut ClothContact, x: &[V3]| {
        contact.update(x);
        let mut forces = vec![V3::zeros(); areas.len()];
        contact.assemble(x, &mut forces);
        forces[3].z
    };
    let (crossed, free) = (poking(-1e-3), poking(1e-4));
    let whole = push(&mut contact(), &free);
    let freed = || {
        let mut freed = contact();
        freed.update(&crossed);
        freed
    };
    let mut pushed = freed();
    let growing: Vec<f64> = (0..30).map(|_| push(&mut pushed, &free)).collect();
    assert!(growing[0] < 1e-3 * whole, "{growing:?} of {whole}");
    assert!(growing.windows(2).all(|w| w[1] >= w[0]) && growing[15] < whole && growing[29] == whole, "{growing:?}");
    // Cloth is not at rest on a contact that still grows, and no part of it is stepped by itself.
    let mut fresh = freed();
    push(&mut fresh, &free);
    assert!(!fresh.is_untangled() && fresh.ripen() && fresh.is_untangled() && !fresh.ripen());
    assert_eq!(push(&mut fresh, &free), whole);
}

#[test]
fn a_move_is_held_back_only_where_cloth_would_pierce_itself() {
    let (large, small, triangles) = two_sheets();
    let sheets_at = |height: f64, corner: f64| -> Vec<V3> {
        let upper = small.iter().map(|p| V3::new(p.x + 0.033, p.y + 0.0305, height + 0.1 * p.x));
        let mut x: Vec<V3> = large.iter().map(|p| V3::new(p.x, p.y, 0.0)).chain(upper).collect();
        x[0].z = corner;
        x
    };
    let edges = edges_of(&triangles);
    let count = |x: &[V3]| intersections(x, edges.pairs(), &triangles).len();
    let (from, to) = (sheets_at(1e-3, 0.0), sheets_at(-2e-4, 5e-3));
    assert!(count(&from) == 0 && count(&to) > 0);
    let reached = held_apart(&from, &to, &triangles);
    assert_eq!(count(&reached), 0);
    assert_eq!(reached[0], to[0]);
    assert_eq!(held_apart(&from, &sheets_at(5e-4, 1e-3), &triangles), sheets_at(5e-4, 1e-3));
}

#[test]
fn what_is_about_to_be_sewn_does_not_let_the_rest_of_its_cloth_pass() {
    // A triangle, and another folded over it that is to be sewn to it at two corners. These corners are a millimetre
    // below it, beside their partners. The third corner is above its middle.
    let below = V3::new(0.0, 0.01, -1e-3);
    let corners = [V3::new(0.0, 0.0, 0.0), V3::new(0.06, 0.0, 0.0), V3::new(0.03, 0.06, 0.0)];
    let x =
        vec![corners[0], corners[1], corners[2], corners[0] + below, corners[1] + below, V3::new(0.03, 0.03, 1.5e-3)];
    let triangles = [[0, 1, 2], [4, 3, 5]];
    let areas = [1e-4; 6];
    assert!(!intersections(&x, edges_of(&triangles).pairs(), &triangles).is_empty(), "nothing pierces the triangle");
    let through = |contact: &mut ClothContact| {
        contact.update(&x);
        let mut moved = x.clone();
        moved[5].z = -1e-3;
        contact.energy(&moved)
    };
    let contact = || ClothContact::new(ClothContactParams::default(), &triangles, &areas);
    assert_eq!(through(&mut contact().but_near([[0, 3], [1, 4]].into_iter())), f64::INFINITY);
    // Cloth that crosses a piece to which it is not sewn comes free without hindrance.
    assert!(through(&mut contact()).is_finite());
}

#[test]
fn what_is_moved_without_regard_to_energy_is_kept_apart_and_stops_before_it_meets() {
    let (large, small, triangles) = two_sheets();
    let edges = edges_of(&triangles);
    let sheets_at = |height: f64| -> Vec<V3> {
        let upper = small.iter().map(|p| V3::new(p.x + 0.033, p.y + 0.0305, height));
        large.iter().map(|p| V3::new(p.x, p.y, 0.0)).chain(upper).collect()
    };
    let areas = vec![1e-4; large.len() + small.len()];
    let check = |from: f64, to: f64, stops: bool| {
        let mut contact = ClothContact::new(ClothContactParams::default(), &triangles, &areas);
        contact.update(&sheets_at(from));
        let mut stopped = sheets_at(to);
        assert_eq!(contact.stop(&mut stopped) > 0, stops, "from {from} to {to}");
        assert!(intersections(&stopped, edges.pairs(), &triangles).is_empty(), "from {from} to {to}");
        // Moved apart first, both give way, and the small sheet stays on its side.
        let mut apart = sheets_at(to);
        contact.keep_apart(&mut apart);
        let mean = |x: &[V3], range: std::ops::Range<usize>| {
            let count = range.len() as f64;
            x[range].iter().map(|p| p.z).sum::<f64>() / count
        };
        let (below, above) = (mean(&sheets_at(to), 0..large.len()), mean(&apart, large.len()..apart.len()));
        assert_eq!(above > to + 1e-9, stops, "from {from} to {to}: {above} over {below}");
    };
    check(1e-3, -1e-3, true);
    check(1e-3, 5e-5, true);
    check(1e-3, 3e-3, false);
    check(4e-3, 3e-3, false);
}
