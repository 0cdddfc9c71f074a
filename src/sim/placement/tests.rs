use std::f64::consts::PI;

use serde_json::json;

use super::*;
use crate::testing::{lapelled, panel, sewn, skirt_role, stitch, tiered};
use body::{self, Measurements, Sex};
use geom::Surface;
use pattern::Style;
use pattern::draft::Model;
use pattern::garment::SeamMesh;

fn body() -> Body {
    body::build(&Measurements::of(Sex::Male, 1.75)).expect("a body")
}

fn garment(model: Model) -> Garment {
    let style = Style::read(&model.drafts()[0].pieces, model.seams(), "seams").expect("a style");
    style.mesh(0.04).expect("a mesh")
}

#[test]
fn drafted_garments_start_outside_the_body_with_near_seams() {
    let body = body();
    let surface = Surface::new(&body.mesh).expect("a closed body");
    // Greatest share of vertices inside, and greatest mean gap of the seams.
    let check = |model: Model, inside: f64, gap_m: f64| {
        let garment = garment(model);
        let x = place(&body, &garment, &Bend::default()).expect("all roles are known");
        let count = x.iter().filter(|p| surface.signed_distance(p) < 0.0).count();
        assert!((count as f64) <= inside * x.len() as f64, "{}: {count} of {} inside", garment.name, x.len());
        let pairs: Vec<_> = garment.seams.iter().flat_map(|seam| &seam.pairs).collect();
        let mean = pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).sum::<f64>() / pairs.len() as f64;
        assert!(mean < gap_m, "{}: mean gap {mean} m", garment.name);
    };
    check(Model::Tshirt, 0.03, 0.2);
    check(Model::Teetop, 0.03, 0.2);
    check(Model::Dress, 0.03, 0.2);
    check(Model::Trousers, 0.05, 0.1);
}

#[test]
fn an_angle_of_nothing_leaves_the_trunk_flat() {
    let (body, garment) = (body(), garment(Model::Tshirt));
    let bend = Bend { bend_angle_rad: Some(0.0), ..Bend::default() };
    let x = place(&body, &garment, &bend).expect("all roles are known");
    for piece in garment.pieces.iter().filter(|piece| [Role::Front, Role::Back].contains(&piece.role)) {
        let depths = || piece.vertices.clone().map(|v| x[v].y);
        let [near, far] = [depths().fold(f64::MAX, f64::min), depths().fold(f64::MIN, f64::max)];
        assert!(far - near < 0.01, "{} lies between {near} and {far} m", piece.id);
    }
}

#[test]
fn legs_start_on_their_own_side() {
    let garment = garment(Model::Trousers);
    let x = place(&body(), &garment, &Bend::default()).expect("all roles are known");
    for piece in &garment.pieces {
        let side = if piece.id.ends_with("right") { 1.0 } else { -1.0 };
        assert!(piece.vertices.clone().all(|v| x[v].x * side > 0.0), "{}", piece.id);
    }
}

#[test]
fn legs_that_are_too_long_begin_clear_of_the_feet() {
    let short = body::build(&Measurements::of(Sex::Male, 1.5)).expect("a body");
    let surface = Surface::new(&short.mesh).expect("a closed body");
    let garment = garment(Model::Trousers);
    let x = place(&short, &garment, &Bend::default()).expect("all roles are known");
    let lowest = x.iter().map(|p| p.z).fold(f64::MAX, f64::min);
    assert!(lowest < 0.02, "they reach down to {lowest} m");
    let middles = garment.triangles.iter().map(|t| t.iter().map(|v| x[*v]).sum::<V3>() / 3.0);
    let deepest = middles.filter(|p| p.z < 0.3).map(|p| surface.signed_distance(&p)).fold(f64::MAX, f64::min);
    assert!(deepest > 0.0, "a triangle lies {deepest} m within a foot");
}

fn gored_dress([front, back, gores]: [Role; 3]) -> Garment {
    let top = [[-24.0, 0.0], [-8.0, 0.0], [8.0, 0.0], [24.0, 0.0], [24.0, 40.0], [-24.0, 40.0]];
    let gore = [[-16.0, -50.0], [16.0, -50.0], [8.0, 0.0], [-8.0, 0.0]];
    // Behind, the same as seen from outside.
    let mirrored = |corners: &[[f64; 2]]| -> Vec<[f64; 2]> { corners.iter().map(|[x, y]| [-x, *y]).collect() };
    let mut panels =
        json!({ "front": panel(&top, [0.0, 20.0], &[]), "back": panel(&mirrored(&top), [0.0, -20.0], &[]) });
    let mut stitches = vec![stitch(("front", 3), ("back", 5)), stitch(("front", 5), ("back", 3))];
    for k in 0..6 {
        let (name, place) = (format!("panel_{k}"), 16.0 * (k % 3) as f64 - 16.0);
        let side = if k < 3 { "front" } else { "back" };
        panels[&name] =
            if k < 3 { panel(&gore, [place, 20.0], &[]) } else { panel(&mirrored(&gore), [-place, -20.0], &[]) };
        stitches.push(stitch((&name, 2), (side, k % 3)));
        stitches.push(stitch((&name, 1), (&format!("panel_{}", (k + 1) % 6), 3)));
    }
    sewn(&panels, &stitches, |id| match id {
        "front" => front,
        "back" => back,
        _ => gores,
    })
}

#[test]
fn gores_go_round_as_one() {
    let check = |roles: [Role; 3]| {
        let garment = gored_dress(roles);
        let x = place(&body(), &garment, &Bend::default()).expect("it goes round");
        let gap = |seam: &SeamMesh| gaps(seam, &x).into_iter().fold(0.0, f64::max);
        let piece = |v: usize| garment.pieces.iter().find(|piece| piece.vertices.contains(&v)).expect("a piece's");
        let is_gore = |v: &usize| piece(*v).role == roles[2];
        let between = garment.seams.iter().filter(|seam| seam.pairs[0].iter().all(is_gore));
        let open = between.filter(|seam| gap(seam) > 0.01).count();
        assert_eq!(open, 1, "{roles:?}: all seams of the gores begin closed, but for one");
        let above = (0..x.len()).filter(|v| !is_gore(v)).map(|v| x[v].z).fold(f64::MAX, f64::min);
        let below = (0..x.len()).filter(is_gore).map(|v| x[v].z).fold(f64::MIN, f64::max);
        assert!((above - below).abs() < 0.02, "{roles:?}: the gores begin at {below} m, what is above ends at {above}");
    };
    check([Role::BodiceFront, Role::BodiceBack, Role::Other]);
    check([Role::Waistband, Role::Waistband, Role::BodiceFront]);
}

fn gaps(seam: &SeamMesh, x: &[V3]) -> Vec<f64> {
    seam.pairs.iter().map(|[a, b]| (x[*a] - x[*b]).norm()).collect()
}

#[test]
fn what_is_gathered_often_goes_round_as_one() {
    let check = |ratio: f64, is_round: bool| {
        let band = [[0.0, 0.0], [42.0, 0.0], [42.0, 9.0], [0.0, 9.0]];
        let strip = [[0.0, 0.0], [42.0 * ratio, 0.0], [42.0 * ratio, 45.0], [0.0, 45.0]];
        let panels = json!({
            "front": panel(&strip, [0.0, 20.0], &[]),
            "back": panel(&strip, [0.0, -20.0], &[]),
            "waist_front": panel(&band, [0.0, 20.0], &[]),
            "waist_back": panel(&band, [0.0, -20.0], &[])
        });
        let around = |a: &'static str, b: &'static str| [stitch((a, 1), (b, 3)), stitch((a, 3), (b, 1))];
        let gathered = [stitch(("waist_front", 0), ("front", 2)), stitch(("waist_back", 0), ("back", 2))];
        let stitches = [around("front", "back"), around("waist_front", "waist_back"), gathered].concat();
        let role = |id: &str| if id.starts_with("waist") { Role::Waistband } else { skirt_role(id) };
        let garment = sewn(&panels, &stitches, role);
        let x = place(&body(), &garment, &Bend::default()).expect("a skirt");
        let axis = Form::of(&body()).trunk_axis();
        let skirt =
            garment.pieces.iter().filter(|piece| piece.role != Role::Waistband).flat_map(|p| p.vertices.clone());
        let skirt = Vec::from_iter(skirt);
        let upper = skirt.iter().filter(|&&v| garment.rest[v].y > 0.45 - 1e-6);
        let radii = Vec::from_iter(upper.map(|&v| axis.coordinates(&x[v]).radius));
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        assert!(mean < 0.3, "gathered {ratio}: its waist lies {mean} m from the axis, on its own it would 0.56");
        let sides = garment.seams.iter().filter(|seam| seam.pairs.iter().flatten().all(|v| skirt.contains(v)));
        let closed = sides.filter(|seam| gaps(seam, &x).into_iter().fold(0.0, f64::max) < 1e-6).count();
        assert_eq!(closed == 1, is_round, "gathered {ratio}: {closed} of its sides begin closed");
    };
    check(1.5, false);
    check(4.0, true);
}

#[test]
fn a_flounce_of_half_circles_goes_round_as_one() {
    let straight = [[-28.0, 0.0], [28.0, 0.0], [28.0, 40.0], [-28.0, 40.0]];
    let (inner, outer) = (36.0, 60.0);
    let half = [[-outer, 0.0], [outer, 0.0], [inner, 0.0], [-inner, 0.0]];
    let arc = |radius: f64, sweep: u8| json!({ "type": "circle", "params": [radius, 0, sweep] });
    let half = panel(&half, [0.0, 0.0], &[(0, arc(outer, 1)), (2, arc(inner, 0))]);
    let panels = json!({
        "front": panel(&straight, [0.0, 20.0], &[]),
        "back": panel(&straight, [0.0, -20.0], &[]),
        "flounce_a": half.clone(),
        "flounce_b": half,
    });
    let stitches = [
        stitch(("front", 1), ("back", 3)),
        stitch(("front", 3), ("back", 1)),
        stitch(("front", 0), ("flounce_a", 2)),
        stitch(("back", 0), ("flounce_b", 2)),
        stitch(("flounce_a", 1), ("flounce_b", 3)),
        stitch(("flounce_a", 3), ("flounce_b", 1)),
    ];
    let role = |id: &str| if id.starts_with("flounce") { Role::Other } else { skirt_role(id) };
    let garment = sewn(&panels, &stitches, role);
    let body = body();
    let x = place(&body, &garment, &Bend::default()).expect("it goes round");
    let surface = Surface::new(&body.mesh).expect("a closed body");
    let of_flounce = |v: usize| {
        let piece = garment.pieces.iter().find(|piece| piece.vertices.contains(&v)).expect("a piece's");
        piece.role == Role::Other
    };
    assert!((0..x.len()).all(|v| !of_flounce(v) || surface.signed_distance(&x[v]) > 0.0), "inside the body");
    for seam in garment.seams.iter().filter(|seam| seam.pairs[0].iter().any(|&v| of_flounce(v))) {
        let gaps = gaps(seam, &x);
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        // Of its sides one begins open.
        assert!(mean < 0.15, "{}: {mean} m open", seam.name);
    }
}

#[test]
fn a_godet_is_folded_outwards_from_its_slit() {
    // As tall as its slit; much wider than tall, its sides as long as the slit's.
    for (half_width, height) in [(12.0, 30.0), (28.3, 10.0)] {
        check_godet(half_width, height);
    }
}

fn check_godet(half_width: f64, height: f64) {
    let slit = [[-30.0, 0.0], [-1.0, 0.0], [0.0, 30.0], [1.0, 0.0], [30.0, 0.0], [25.0, 60.0], [-25.0, 60.0]];
    let whole = [[-30.0, 0.0], [30.0, 0.0], [25.0, 60.0], [-25.0, 60.0]];
    let godet = [[-half_width, 0.0], [half_width, 0.0], [0.0, height]];
    let panels = json!({
        "front": panel(&slit, [0.0, 20.0], &[]),
        "back": panel(&whole, [0.0, -20.0], &[]),
        "front_godet": panel(&godet, [0.0, 40.0], &[])
    });
    let stitches = [
        stitch(("front", 4), ("back", 3)),
        stitch(("front", 6), ("back", 1)),
        stitch(("front_godet", 1), ("front", 2)),
        stitch(("front_godet", 2), ("front", 1)),
    ];
    let garment = sewn(&panels, &stitches, skirt_role);
    let piece = |name: &str| garment.pieces.iter().position(|piece| piece.id == name).expect("a piece");
    let joins = Joins::of(&garment);
    let in_slits: Vec<bool> =
        ["front", "back", "front_godet"].map(|name| attachment::is_in_a_slit(&joins, piece(name))).to_vec();
    assert_eq!(in_slits, [false, false, true]);
    let body = body();
    let x = place(&body, &garment, &Bend::default()).expect("a skirt");
    let is_godet = |v: usize| joins.piece_of[v] == piece("front_godet");
    let sides: Vec<[usize; 2]> = garment.seams.iter().flat_map(|seam| seam.pairs.clone()).collect();
    let own = sides.iter().filter(|pair| pair.iter().any(|&v| is_godet(v)));
    let widest = own.map(|[a, b]| (x[*a] - x[*b]).norm()).fold(0.0, f64::max);
    // It lies half way up.
    assert!(widest < 0.05 + 0.5e-2 * (30.0 - height), "its seams begin {widest} m open");
    let axis = Form::of(&body).trunk_axis();
    let hem = garment.pieces[piece("front_godet")].vertices.clone().filter(|&v| garment.rest[v].y < 1e-6);
    let [near, far] = interval::bounds(hem.map(|v| axis.coordinates(&x[v]).radius));
    assert!(far - near > 0.9e-2 * half_width, "its hem lies from {near} to {far} m");
}

#[test]
fn the_halves_of_a_skirt_are_no_godets() {
    // About as wide as the sides of a skirt are long, no turn takes one half's sides nearer to the other's than another
    // does.
    for half_width in [20.0, 24.0, 25.0, 26.0, 30.0] {
        let half = [[-half_width, 0.0], [half_width - 2.0, 1.0], [half_width, 86.0], [1.0 - half_width, 86.0]];
        let mirrored: Vec<[f64; 2]> = half.iter().rev().map(|[x, y]| [-x, *y]).collect();
        let panels = json!({ "front": panel(&half, [0.0, 20.0], &[]), "back": panel(&mirrored, [0.0, -20.0], &[]) });
        let stitches = [stitch(("front", 1), ("back", 1)), stitch(("front", 3), ("back", 3))];
        let garment = sewn(&panels, &stitches, skirt_role);
        let joins = Joins::of(&garment);
        assert_eq!([0, 1].map(|piece| attachment::is_in_a_slit(&joins, piece)), [false, false], "{half_width}");
        let x = place(&body(), &garment, &Bend::default()).expect("a skirt");
        let gap = garment.seams.iter().flat_map(|seam| gaps(seam, &x)).fold(0.0, f64::max);
        assert!(gap < 0.3, "{half_width}: its sides begin {gap} m open");
    }
}

#[test]
fn halves_that_follow_stay_beside_each_other() {
    // Two flaps on a skirt's waist, as the halves of a hood stand on a neck, each with a wing that would reach into the
    // other.
    let half = [[-30.0, 0.0], [30.0, 0.0], [25.0, 60.0], [0.0, 60.0], [-25.0, 60.0]];
    let flap = [[-25.0, 0.0], [0.0, 0.0], [25.0, 0.0], [25.0, 20.0], [-65.0, 20.0], [-65.0, 0.0]];
    let panels = json!({
        "front": panel(&half, [0.0, 20.0], &[]),
        "back": panel(&half, [0.0, -20.0], &[]),
        "flap_left": panel(&flap, [40.0, 0.0], &[]),
        "flap_right": panel(&flap, [-40.0, 0.0], &[])
    });
    let stitches = [
        stitch(("front", 1), ("back", 4)),
        stitch(("front", 4), ("back", 1)),
        stitch(("flap_left", 0), ("front", 2)),
        stitch(("flap_left", 1), ("back", 3)),
        stitch(("flap_right", 0), ("back", 2)),
        stitch(("flap_right", 1), ("front", 3)),
        stitch(("flap_left", 4), ("flap_right", 2)),
    ];
    let role = |id: &str| if id.starts_with("flap") { Role::Other } else { skirt_role(id) };
    let garment = sewn(&panels, &stitches, role);
    let body = body();
    let x = place(&body, &garment, &Bend::default()).expect("a skirt with flaps");
    let axis = Form::of(&body).trunk_axis();
    for (id, side) in [("flap_left", 1.0), ("flap_right", -1.0)] {
        let flap = garment.pieces.iter().find(|piece| piece.id == id).expect("a piece");
        let [low, high] = interval::bounds(flap.vertices.clone().map(|v| side * axis.coordinates(&x[v]).angle));
        assert!(low > -0.1 && high < PI + 0.1, "{id} goes from {low} to {high} rad");
    }
}

#[test]
fn tiers_of_circles_hang_within_each_other() {
    let body = body();
    let surface = Surface::new(&body.mesh).expect("a closed body");
    let check = |radii: &[f64]| {
        let garment = tiered(radii);
        let x = place(&body, &garment, &Bend::default()).expect("it goes round");
        assert!(x.iter().all(|p| surface.signed_distance(p) > 0.0), "{radii:?}: inside the body");
        let tier = |v: usize| {
            let piece = garment.pieces.iter().find(|piece| piece.vertices.contains(&v)).expect("a piece's");
            piece.id.rsplit('_').next().map(str::to_owned)
        };
        for seam in &garment.seams {
            let gaps = gaps(seam, &x);
            let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
            let [a, b] = seam.pairs[0];
            let is_between = tier(a) != tier(b);
            // Of the sides of a tier one begins open.
            assert!(mean < if is_between { 0.05 } else { 0.3 }, "{radii:?}, {}: {mean} m open", seam.name);
        }
    };
    check(&[15.0, 45.0]);
    check(&[15.0, 55.0, 100.0]);
}

#[test]
fn a_piece_without_a_role_follows_its_seams() {
    let body = body();
    let mut garment = garment(Model::Teetop);
    let known = place(&body, &garment, &Bend::default()).expect("all roles are known");
    let sleeve = garment.pieces.iter().position(|piece| piece.id == "sleeve_right").expect("it has sleeves");
    garment.pieces[sleeve].role = Role::Other;
    let followed = place(&body, &garment, &Bend::default()).expect("it is sewn to known ones");
    let vertices = garment.pieces[sleeve].vertices.clone();
    let mean = |x: &[V3]| x[vertices.clone()].iter().sum::<V3>() / vertices.len() as f64;
    assert!((mean(&known) - mean(&followed)).norm() < 0.25, "{} {}", mean(&known), mean(&followed));
    garment.seams.retain(|seam| !seam.pairs.iter().flatten().any(|v| vertices.contains(v)));
    let error = place(&body, &garment, &Bend::default()).expect_err("nothing holds it").to_string();
    assert!(error.contains("sleeve_right") && error.contains("cannot place role"), "{error}");
}

#[test]
fn what_is_folded_begins_turned_up_and_nothing_else_does() {
    assert!(Folded::of(&garment(Model::Tshirt)).is_none());
    assert!(Folded::of(&lapelled(0.03, false)).is_none());
    let garment = lapelled(0.03, true);
    let folded = Folded::of(&garment).expect("lapels and a collar");
    let ids: Vec<&str> = folded.pieces.iter().map(|&piece| garment.pieces[piece].id.as_str()).collect();
    assert_eq!(ids, ["collar", "lapel_left", "lapel_right"]);

    let mut x = place(&body(), &garment, &Bend::default()).expect("all are placed");
    let before = x.clone();
    folded.turn_up(&garment, &mut x);
    let piece = |id: &str| garment.pieces.iter().find(|piece| piece.id == id).expect("it has one");
    // In the V of the front: nearer to the middle than the edge that it is sewn to, and no deeper.
    let lapel = piece("lapel_left").vertices.clone();
    let seam = garment.seams.iter().find(|seam| seam.name == "lapel_left.low").expect("it is sewn");
    let middle = |v: &mut dyn Iterator<Item = usize>| {
        let (sum, n) = v.fold((V3::zeros(), 0.0), |(sum, n), v| (sum + x[v], n + 1.0));
        sum / n
    };
    let [lapel, edge] = [middle(&mut lapel.clone()), middle(&mut seam.pairs.iter().map(|pair| pair[1]))];
    assert!(lapel.x.abs() < edge.x.abs() - 0.005 && (lapel.y - edge.y).abs() < 0.03, "{lapel} beside {edge}");
    for seam in garment.seams.iter().filter(|seam| seam.name.ends_with(".low")) {
        assert!(gaps(seam, &x).into_iter().fold(0.0, f64::max) < 0.04, "{}", seam.name);
    }
    assert!(piece("front").vertices.clone().all(|v| x[v] == before[v]));
}

#[test]
fn what_was_asked_for_is_not_bent_otherwise() {
    let bent = Bend::default().otherwise().expect("nothing was asked for");
    assert!(bent.bend_angle_rad.is_some() && bent.otherwise().is_none());
    assert!(Bend { offset_mu: Some(1.0), ..Bend::default() }.otherwise().is_none());
}
