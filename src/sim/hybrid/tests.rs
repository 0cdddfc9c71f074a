//! Hybrid-GS as a whole, on one man and the drafted styles.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use super::elastic::{Controls, Elastic, Pull};
use super::form::Form;
use super::mapping::can_touch;
use super::path::{PathGraph, Taken};
use super::*;
use crate::laboratory::sheets::{hexagonal_sheet, noise};
use crate::{Silent, fabric};
use body::Dimension;
use body::{self, Measurements, Region, Sex};
use geom::V2;
use pattern::draft::Model;
use pattern::garment::PieceMesh;
use pattern::{Role, SeamMesh, Style, garmentcode};

/// The thesis's men ii and vi: the slimmest and the largest.
fn man(stature_m: f64, chest_m: f64, waist_m: f64, hip_m: f64) -> Body {
    let measurements = Measurements::of(Sex::Male, stature_m)
        .with(Dimension::ChestGirth, chest_m)
        .with(Dimension::WaistGirth, waist_m)
        .with(Dimension::HipGirth, hip_m);
    body::build(&measurements).expect("a body")
}

static SLIM: LazyLock<Body> = LazyLock::new(|| man(1.69, 0.863, 0.782, 0.914));
static LARGE: LazyLock<Body> = LazyLock::new(|| man(1.85, 1.02, 0.873, 1.032));

fn garment(model: Model, size: usize, edge_m: f64) -> Garment {
    let style = Style::read(&model.drafts()[size].pieces, model.seams(), "seams").expect("a style");
    style.mesh(edge_m).expect("a mesh")
}

fn dressed(body: &Body, garment: &Garment, params: &Params) -> Phases {
    let field = DistanceField::build(&body.mesh, 0.012).expect("a field");
    phases(body, &field, std::slice::from_ref(garment), &fabric::library()[0], params, &mut Silent)
        .expect("it can be dressed")
}

/// L3D over L2D.
fn chis(garment: &Garment, x: &[V3]) -> Vec<f64> {
    garment.measurements.iter().map(|m| m.length_m(&garment.rest, x) / m.l2d_m).collect()
}

fn mean_edge_error(garment: &Garment, x: &[V3]) -> f64 {
    let edges = || garment.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let error = |[a, b]: [usize; 2]| ((x[a] - x[b]).norm() / (garment.rest[a] - garment.rest[b]).norm() - 1.0).abs();
    edges().map(error).sum::<f64>() / edges().count() as f64
}

#[test]
fn a_shirt_that_is_large_enough_keeps_its_size_and_stays_out_of_the_body() {
    let garment = garment(Model::Tshirt, 1, 0.03);
    let phases = dressed(&SLIM, &garment, &Params::default());
    let [sewn, popup] = [0, 1].map(|k| &phases.drape.earlier[k].positions);
    for x in [popup, &phases.drape.positions] {
        let chis = chis(&garment, x);
        let ei = chis.iter().map(|chi| (chi - 1.0).abs()).sum::<f64>() / chis.len() as f64;
        assert!(ei < 0.01, "{chis:?}");
        assert!(mean_edge_error(&garment, x) < 0.01);
    }
    assert!(mean_edge_error(&garment, sewn) > 0.1, "the body is not the pattern");
    assert_eq!(phases.drape.self_crossings, 0);
    assert!(phases.drape.history.iter().all(|step| step.residual.is_finite() && step.e_chi.is_finite()));
    assert!(
        phases.drape.seam_gap_max_m == 0.0 && phases.drape.penetration_max_m < 2.5e-3,
        "{:?}",
        phases.drape.penetration_max_m
    );
    // Sewn and popped up: E comes nearer to 1 in every step and does not pass it.
    let grown = phases.drape.history.iter().filter(|step| step.level < 2).map(|step| step.e_chi - 1.0);
    for pair in grown.collect::<Vec<_>>().windows(2) {
        let is_nearer = pair[1].abs() <= pair[0].abs() && pair[0] * pair[1] >= 0.0;
        assert!(is_nearer || pair[1].abs() < 5e-5, "{} after {}", pair[1], pair[0]);
    }
}

#[test]
fn pieces_of_one_face_lie_as_one_in_one_patch() {
    // A front in two halves.
    let whole = garment(Model::Tshirt, 1, 0.03);
    let parted = parted(&whole);
    assert_eq!(parted.pieces.len(), whole.pieces.len() + 1);
    let [one, two] = [&whole, &parted].map(|garment| mapping::map(&SLIM, garment).expect("it can be mapped"));
    assert_eq!(two.flips, 0);
    // As one they lie where the whole one does, up to an edge: the hem's auxiliary points are other vertices.
    let place = |mapped: &OnForm, garment: &Garment, p: V2| {
        let front = garment.pieces.iter().filter(|piece| piece.role == Role::Front);
        let nearest = front
            .flat_map(|piece| piece.vertices.clone())
            .min_by(|&a, &b| (garment.rest[a] - p).norm().total_cmp(&(garment.rest[b] - p).norm()));
        mapped.positions[nearest.expect("a front")]
    };
    for v in whole.pieces.iter().find(|p| p.role == Role::Front).expect("a front").vertices.clone().step_by(7) {
        let p = whole.rest[v];
        let (a, b) = (place(&one, &whole, p), place(&two, &parted, p));
        assert!((a - b).norm() < 0.03, "{a:?} and {b:?} at {p:?}");
    }
}

/// Cuts the front in two where its triangles change from one half to the other, and sews it together again.
fn parted(whole: &Garment) -> Garment {
    let mut cut = Garment { pieces: vec![], rest: vec![], triangles: vec![], measurements: vec![], ..whole.clone() };
    // New vertices of each old one: two where it is cut.
    let mut copies = vec![Vec::new(); whole.rest.len()];
    for piece in &whole.pieces {
        let middle = piece.vertices.clone().map(|v| whole.rest[v].x).sum::<f64>() / piece.vertices.len() as f64;
        let is_left = |t: &[usize; 3]| t.iter().map(|&v| whole.rest[v].x).sum::<f64>() / 3.0 > middle;
        let all = whole.triangles[piece.triangles.clone()].iter().copied();
        let (left, right): (Vec<_>, Vec<_>) = all.partition(|t| piece.role == Role::Front && is_left(t));
        for (half, triangles) in [right, left].iter().enumerate().filter(|(_, triangles)| !triangles.is_empty()) {
            let used: BTreeSet<usize> = triangles.iter().flatten().copied().collect();
            let starts = [cut.rest.len(), cut.triangles.len()];
            for &v in &used {
                copies[v].push(cut.rest.len());
                cut.rest.push(whole.rest[v]);
            }
            let number = |v: usize| starts[0] + used.range(..v).count();
            cut.triangles.extend(triangles.iter().map(|t| t.map(number)));
            cut.pieces.push(PieceMesh {
                id: format!("{}_{half}", piece.id),
                vertices: starts[0]..cut.rest.len(),
                triangles: starts[1]..cut.triangles.len(),
                ..piece.clone()
            });
        }
    }
    for pair in cut.seams.iter_mut().flat_map(|s| &mut s.pairs) {
        *pair = pair.map(|v| copies[v][0]);
    }
    let mut centre: Vec<usize> = (0..copies.len()).filter(|&v| copies[v].len() == 2).collect();
    centre.sort_by(|&a, &b| whole.rest[a].y.total_cmp(&whole.rest[b].y));
    let pairs = centre.iter().map(|&v| [copies[v][0], copies[v][1]]).collect();
    cut.seams.push(SeamMesh { name: "centre".into(), pairs });
    cut
}

#[test]
fn a_measurement_left_out_of_the_controls_still_comes_out() {
    let garment = garment(Model::Tshirt, 1, 0.03);
    let no = garment.measurements[0].no;
    let params = Params { uncontrolled: vec![no], ..Params::default() };
    let chi = chis(&garment, &dressed(&SLIM, &garment, &params).drape.positions)[0];
    assert!((chi - 1.0).abs() < 0.03, "{chi}");
}

#[test]
fn a_shirt_that_is_too_small_keeps_its_size_and_says_what_it_lacks() {
    let garment = garment(Model::Tshirt, 0, 0.03);
    let phases = dressed(&LARGE, &garment, &Params::default());
    let chis = chis(&garment, &phases.drape.positions);
    assert!(chis.iter().all(|chi| (chi - 1.0).abs() < 0.02), "{chis:?}");
    let chest = &closures(&LARGE, &garment, &phases.drape.positions)[0];
    let lacks = chest.body_girth_m - garment.fit_levels[0].girth_m;
    assert!(lacks > 0.03 && (chest.shortfall_m() - lacks).abs() < 0.01, "{chest:?}, pattern lacks {lacks}");
}

#[test]
fn both_backends_of_the_pop_up_bring_the_size_back() {
    let garment = garment(Model::Tshirt, 1, 0.03);
    let [rigid, pyramid] = [Backend::Rigid, Backend::Pyramid].map(|popup| {
        let phases = dressed(&SLIM, &garment, &Params { popup, ..Params::default() });
        [0, 1].map(|k| mean_edge_error(&garment, &phases.drape.earlier[k].positions))
    });
    for [sewn, popped] in [rigid, pyramid] {
        assert!(popped < 0.6 * sewn, "{popped} of {sewn}");
    }
    assert!(rigid[1] < pyramid[1], "the default is the better one: {rigid:?}, {pyramid:?}");
}

#[test]
fn pyramids_do_not_diverge_where_the_garment_is_too_small() {
    let garment = garment(Model::Tshirt, 0, 0.03);
    let phases = dressed(&LARGE, &garment, &Params { popup: Backend::Pyramid, ..Params::default() });
    let popped = mean_edge_error(&garment, &phases.drape.earlier[1].positions);
    assert!(popped < 0.3, "{popped}");
}

#[test]
fn trousers_and_a_dress_are_mapped() {
    let trousers = garment(Model::Trousers, 1, 0.03);
    let mapped = mapping::map(&SLIM, &trousers).expect("trousers");
    assert_eq!(mapped.flips, 0);
    assert_eq!(mapping::map(&SLIM, &garment(Model::Dress, 0, 0.03)).expect("a dress").flips, 0);
}

/// Two garments worn together; measured nowhere.
fn with(mut one: Garment, other: &Garment) -> Garment {
    let (first, before) = (one.rest.len(), one.triangles.len());
    one.rest.extend(&other.rest);
    one.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + first)));
    one.seams.extend(other.seams.iter().map(|seam| SeamMesh {
        pairs: seam.pairs.iter().map(|pair| pair.map(|v| v + first)).collect(),
        ..seam.clone()
    }));
    one.pieces.extend(other.pieces.iter().map(|piece| PieceMesh {
        vertices: piece.vertices.start + first..piece.vertices.end + first,
        triangles: piece.triangles.start + before..piece.triangles.end + before,
        ..piece.clone()
    }));
    Garment { measurements: Vec::new(), fit_levels: Vec::new(), reinforcements: Vec::new(), ..one }
}

#[test]
fn a_top_and_trousers_are_a_suit_but_a_skirt_over_trousers_is_not() {
    let suit = with(garment(Model::Tshirt, 1, 0.05), &garment(Model::Trousers, 1, 0.05));
    assert_eq!(features::kind(&suit).expect("a suit"), features::Kind::Suit);
    let both = with(garment(Model::Dress, 0, 0.03), &garment(Model::Trousers, 1, 0.05));
    let error = mapping::map(&SLIM, &both).expect_err("a skirt over trousers").to_string();
    assert!(error.contains("cannot place role Skirt") && error.contains("over legs"), "{error}");
}

/// Jumpsuit, dress whose bodice is wider than its skirt's front, and shirt whose sleeve seams lie before its sides.
#[test]
fn sides_need_not_meet() {
    for name in ["js_mean_all", "dress_pencil", "shirt_mean"] {
        let path = format!(
            "{}/../../../shared/patterns/garmentcode/upstream/{name}_specification.json",
            env!("CARGO_MANIFEST_DIR")
        );
        let Ok(bytes) = std::fs::read(&path) else {
            eprintln!("skipped: {path} is not here");
            continue;
        };
        let style = garmentcode::read(&bytes, name).expect("a specification").style();
        let mapped = mapping::map(&LARGE, &style.mesh(0.03).expect("a mesh"));
        assert!(mapped.unwrap_or_else(|error| panic!("{name}: {error}")).flips < 10, "{name}");
    }
}

#[test]
fn what_cannot_be_mapped_is_named_with_its_reason() {
    let mut alone = garment(Model::Tshirt, 1, 0.05);
    alone.seams.retain(|seam| !seam.name.starts_with("side"));
    let error = mapping::map(&SLIM, &alone).expect_err("no sides").to_string();
    assert!(error.contains("\"back\"") && error.contains("along two sides"), "{error}");
    let mut loose = garment(Model::Tshirt, 1, 0.05);
    let sleeve = loose.pieces.iter_mut().find(|p| p.role == Role::SleeveRight).expect("a sleeve");
    sleeve.role = Role::Other;
    let own = sleeve.vertices.clone();
    loose.seams.retain(|seam| !seam.pairs.iter().flatten().any(|v| own.contains(v)));
    let error = mapping::map(&SLIM, &loose).expect_err("sewn to nothing").to_string();
    assert!(error.contains("cannot place role Other"), "{error}");
}

fn picks(count: usize, below: usize, seed: u64) -> Vec<usize> {
    noise(count, seed).into_iter().map(|r| (((r + 1.0) / 2.0) * below as f64) as usize % below).collect()
}

#[test]
fn the_fast_search_finds_the_path_of_the_full_one() {
    let form = Form::hung(&SLIM);
    let normals = form.mesh.triangle_normals();
    let graph = PathGraph::new(&form.mesh, 3);
    let allowed = |face: usize| can_touch(Role::Front, form.regions[face], &normals[face]);
    // Both ends on the front of the chest: where it looks forward more than to the side.
    let is_front = |&f: &usize| form.regions[f] == Region::Chest && normals[f].y > normals[f].x.abs();
    let features: Vec<usize> =
        (0..graph.len()).filter(|&n| !graph.faces(n).is_empty() && graph.faces(n).iter().all(is_front)).collect();
    assert!(features.len() > 100, "{}", features.len());
    let (from, to) = (picks(500, features.len(), 1), picks(500, features.len(), 2));
    for (a, b) in from.into_iter().zip(to).map(|(a, b)| (features[a], features[b])) {
        let full = graph.shortest(a, b).expect("connected");
        let fast = graph.shortest_within(a, b, allowed, &Taken::default()).expect("connected");
        let (full_m, fast_m) = (graph.length(&full), graph.length(&fast));
        assert!(fast == full || (fast_m - full_m).abs() < 1e-12, "{a} to {b}: {fast_m} for {full_m}");
    }
}

#[test]
fn a_trouser_back_is_not_led_over_the_front_of_the_leg() {
    // Figure 5-11: the shortest way between the two seams of a leg piece may run over the wrong side of the leg. On
    // this body it always runs over the front, which is right for a front and wrong for a back.
    let form = Form::legs(&SLIM);
    let normals = form.mesh.triangle_normals();
    let graph = PathGraph::new(&form.mesh, 3);
    let side = |path: &[usize]| path.iter().map(|&n| graph.position(n).y).sum::<f64>() / path.len() as f64;
    let mut misled = 0;
    for ring in 0..form.legs[0].end() as usize {
        let [outer, inner] = [0, 12].map(|line| form.legs[0].line(line).nth(ring).expect("a ring"));
        let middle = side(&[outer, inner]);
        let back = |face: usize| can_touch(Role::LegBackRight, form.regions[face], &normals[face]);
        let full = graph.shortest(outer, inner).expect("connected");
        let oriented = graph.shortest_within(outer, inner, back, &Taken::default()).expect("connected");
        misled += usize::from(side(&full) > middle);
        assert!(side(&oriented) < middle, "ring {ring}");
        assert!(oriented.iter().all(|&n| graph.faces(n).iter().any(|&f| back(f))));
    }
    assert!(misled > 0, "the full search never errs here: the test shows nothing");
}

#[test]
fn a_tube_gets_its_length_and_girth_back() {
    // A sheet rolled to three quarters of a turn, at 0.9 of its size.
    let (rest, triangles) = hexagonal_sheet(24, 16, 0.02);
    let radius = 0.9 * 0.48 / (1.5 * std::f64::consts::PI);
    let rolled = |p: &V2| V3::new(radius * (0.9 * p.x / radius).cos(), radius * (0.9 * p.x / radius).sin(), 0.9 * p.y);
    let x: Vec<V3> = rest.iter().map(rolled).collect();
    let garment = Garment {
        name: "tube".into(),
        size: String::new(),
        pieces: vec![PieceMesh {
            id: "tube".into(),
            role: Role::Other,
            vertices: 0..rest.len(),
            triangles: 0..triangles.len(),
            grain: V2::y(),
            edges: std::collections::BTreeMap::new(),
        }],
        rest,
        triangles,
        seams: vec![],
        measurements: vec![],
        fit_levels: vec![],
        edge_length_m: 0.02,
        reinforcements: vec![],
    };
    let own: Vec<usize> = (0..x.len()).collect();
    let mut elastic =
        Elastic::new(&garment, &own, &x, Controls::NONE, &[], vec![], vec![1e-6; x.len()]).expect("sound triangles");
    let none = vec![V3::zeros(); x.len()];
    let mut now = x.clone();
    let mut last = mean_edge_error(&garment, &now);
    assert!((last - 0.1).abs() < 2e-3, "{last}");
    for _ in 0..30 {
        now = elastic.step(&now, &Pull { targets: &now, loads: &none, share: 1.0, control: 1.0, closer_m: 0.0 });
        let error = mean_edge_error(&garment, &now);
        assert!(error <= last + 1e-5, "{error} after {last}");
        last = error;
    }
    assert!(last < 1e-3, "{last}");
    // Rolled still, not flat: its ends face each other.
    let flat = garment.rest.iter().map(|p| p.x).fold(0.0, f64::max);
    assert!((now[24] - now[0]).norm() < 0.6 * flat);
}

#[test]
fn pieces_are_drawn_together_at_their_size_and_go_through_nothing() {
    let field = DistanceField::build(&SLIM.mesh, 0.012).expect("a field");
    for model in [Model::Tshirt, Model::Trousers] {
        let garment = garment(model, 1, 0.04);
        let cotton = &fabric::library()[0];
        let mut steps = 0;
        let x = draw::together(Wearer { body: &SLIM, field: &field }, &garment, cotton, |_| {
            steps += 1;
            Ok(())
        });
        let x = x.expect("it can be drawn together");
        let gap_m = quality::seam_gap_m(&garment, &x);
        assert!(gap_m < 0.02 && steps > 5, "{}: seams {gap_m} m open after {steps} steps", model.as_str());
        let sewn = Sewn::at(&garment, &x);
        assert_eq!(quality::self_crossings(&sewn.x, &sewn.triangles), 0, "{}", model.as_str());
        let error = mean_edge_error(&garment, &x);
        assert!(error < 0.03, "{}: edges are off by {error}", model.as_str());
    }
}

#[test]
fn a_circle_skirt_in_tiers_is_drawn_together_where_it_cannot_be_mapped() {
    let skirt = crate::testing::tiered(&[13.0, 43.0]);
    assert!(mapping::map(&SLIM, &skirt).is_err());
    let phases = dressed(&SLIM, &skirt, &Params::default());
    let drape = &phases.drape;
    assert!(phases.mapped.is_none() && drape.self_crossings == 0, "{}", drape.self_crossings);
    assert_eq!(drape.seam_gap_max_m, 0.0);
    let error = mean_edge_error(&skirt, &drape.positions);
    assert!(error < 0.02, "edges are off by {error}");
}
