//! Whole simulations: left and right, and a garment that is too small.

use super::carry::{Motion, Worn};
use super::*;
use crate::cloth::Cloth;
use crate::sewing;
use crate::testing::{self, lapelled};
use crate::{Silent, fabric};
use body::Dimension;
use body::{self, Joint, Landmarks, Measurements, Sex, Skeleton};
use geom::TriMesh;
use geom::units::GRAVITY;
use pattern::draft::Model;
use pattern::{Role, Style};

fn flipped(p: &V3) -> V3 {
    V3::new(-p.x, p.y, p.z)
}

fn turned(triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

fn lopsided() -> Body {
    let mut body = body::build(&Measurements::of(Sex::Male, 1.75)).expect("a body");
    let bend = |p: &V3| V3::new(p.x * (1.0 + 0.04 * (3.0 * p.x).tanh()) + 0.02 * (p.z - 1.0).powi(2), p.y, p.z);
    body.mesh.positions.iter_mut().for_each(|p| *p = bend(p));
    body.skeleton.joints.iter_mut().for_each(|p| *p = bend(p));
    let Landmarks { side_neck, shoulder, back_neck, front_neck, armpit, bust, crotch } = &mut body.landmarks;
    for p in [side_neck, shoulder, armpit, bust].into_iter().flatten().chain([back_neck, front_neck, crotch]) {
        *p = bend(p);
    }
    body
}

fn mirrored_body(body: &Body) -> Body {
    let mesh = TriMesh {
        positions: body.mesh.positions.iter().map(flipped).collect(),
        triangles: turned(&body.mesh.triangles),
    };
    let mut joints = body.skeleton.joints.map(|p| flipped(&p));
    for [first_right, first_left] in [[Joint::ShoulderRight, Joint::ShoulderLeft], [Joint::HipRight, Joint::HipLeft]] {
        (0..3).for_each(|k| joints.swap(first_right as usize + k, first_left as usize + k));
    }
    let pair = |[right, left]: [V3; 2]| [flipped(&left), flipped(&right)];
    let marks = &body.landmarks;
    let landmarks = Landmarks {
        side_neck: pair(marks.side_neck),
        shoulder: pair(marks.shoulder),
        back_neck: flipped(&marks.back_neck),
        front_neck: flipped(&marks.front_neck),
        armpit: pair(marks.armpit),
        bust: pair(marks.bust),
        crotch: flipped(&marks.crotch),
    };
    Body { mesh, skeleton: Skeleton { joints }, landmarks, ..body.clone() }
}

fn mirrored_garment(garment: &Garment) -> Garment {
    let mut garment = garment.clone();
    garment.rest.iter_mut().for_each(|p| p.x = -p.x);
    garment.triangles = turned(&garment.triangles);
    for piece in &mut garment.pieces {
        piece.grain.x = -piece.grain.x;
        piece.role = match piece.role {
            Role::SleeveRight => Role::SleeveLeft,
            Role::SleeveLeft => Role::SleeveRight,
            Role::LegFrontRight => Role::LegFrontLeft,
            Role::LegFrontLeft => Role::LegFrontRight,
            Role::LegBackRight => Role::LegBackLeft,
            Role::LegBackLeft => Role::LegBackRight,
            role => role,
        };
    }
    garment
}

fn apart_mm(x: &[V3], mirrored: &[V3]) -> f64 {
    1e3 * x.iter().zip(mirrored).map(|(p, q)| (flipped(p) - q).norm()).fold(0.0, f64::max)
}

fn levels(model: Model, edge_m: f64) -> Vec<Garment> {
    let style = Style::read(&model.drafts()[0].pieces, model.seams(), "seams").expect("a style");
    level_edges(edge_m).into_iter().map(|edge| style.mesh(edge).expect("a mesh")).collect()
}

fn placed<'a>(wearer: Wearer<'a>, layer: Layer<'a>, start: &'a [V3]) -> Placed<'a> {
    Placed { dressing: Dressing { wearer, skin: None, layer }, hands: None, start, force: 1.0 }
}

fn is_faultless(drape: &Drape) -> bool {
    faults(drape, false).are_none(&CRITERIA)
}

#[test]
fn mirrored_input_gives_the_mirrored_result_and_the_same_input_the_same_bits() {
    let body = lopsided();
    let other = mirrored_body(&body);
    let [field, other_field] = [&body, &other].map(|b| DistanceField::build(&b.mesh, 0.01).expect("a closed body"));
    let cotton = fabric::library().into_iter().find(|f| f.name == "cotton_shirting_light").expect("in the library");
    let params = Params::default();
    let check = |model: Model, edge_m: f64| {
        let garments = levels(model, edge_m);
        let others: Vec<Garment> = garments.iter().map(mirrored_garment).collect();
        let drape = |body: &Body, field: &DistanceField, garments: &[Garment]| {
            simulate(body, field, garments, &cotton, &params, &mut Silent).expect("it drapes").positions
        };
        let draped = drape(&body, &field, &garments);
        let apart = apart_mm(&draped, &drape(&other, &other_field, &others));
        assert!(apart < 0.1, "{}: mirrored by up to {apart} mm elsewhere", garments[0].name);
        assert!(draped == drape(&body, &field, &garments), "{}: draped again it lies elsewhere", garments[0].name);
        // The garment is not symmetric itself.
        let own = apart_mm(&draped, &draped);
        assert!(own > 100.0, "{own}");
    };
    // Fine enough that vertices that come to rest late are stepped by themselves.
    check(Model::Tshirt, 0.03);
    check(Model::Trousers, 0.06);
}

#[test]
fn a_garment_stretched_too_far_is_told_or_ends_the_simulation() {
    let big = Measurements::of(Sex::Male, 1.75).with(Dimension::ChestGirth, 1.30).with(Dimension::WaistGirth, 1.25);
    let cotton = fabric::library().into_iter().find(|f| f.name == "cotton_shirting_light").expect("in the library");
    let garments = levels(Model::Tshirt, 0.06);
    let drape = |measurements: &Measurements, params: &Params| {
        let body = body::build(measurements).expect("a body");
        let field = DistanceField::build(&body.mesh, 0.01).expect("a closed body");
        simulate(&body, &field, &garments, &cotton, params, &mut Silent)
    };
    let stretch = |drape: &Drape| Distortion::of(&garments[0], &drape.positions).expect("a sound mesh").stretch;
    let tight = stretch(&drape(&big, &Params::default()).expect("stretched or not, it is a result"));
    let loose = stretch(&drape(&Measurements::of(Sex::Male, 1.65), &Params::default()).expect("it drapes"));
    assert!(tight > Params::default().distortion_limit, "tight {tight}, loose {loose}");
    assert!(loose < 0.5 * tight, "tight {tight}, loose {loose}");
    let strict = Params { distortion_stops: true, ..Params::default() };
    assert!(drape(&Measurements::of(Sex::Male, 1.65), &strict).is_ok(), "a loose garment goes on");
    let error = drape(&big, &strict).expect_err("it is too small").to_string();
    assert!(error.contains("1 % of the cloth is stretched by more than"), "{error}");
    assert!(garments[0].pieces.iter().any(|piece| error.contains(&piece.id)), "{error}");
}

#[test]
fn what_cannot_be_drawn_on_is_given_up() {
    let big = Measurements::of(Sex::Male, 1.75).with(Dimension::ChestGirth, 1.30).with(Dimension::WaistGirth, 1.25);
    let body = body::build(&big).expect("a body");
    let field = DistanceField::build(&body.mesh, 0.012).expect("a closed body");
    let cotton = fabric::library().into_iter().find(|f| f.name == "cotton_shirting_light").expect("in the library");
    let style = Style::read(&Model::Trousers.drafts()[0].pieces, Model::Trousers.seams(), "seams").expect("drafted");
    let trousers = style.mesh(0.06).expect("it meshes");
    let check = |size: f64, expect: &[&str]| {
        let mut garment = trousers.clone();
        garment.rest.iter_mut().for_each(|p| *p *= size);
        let drape = simulate(&body, &field, &[garment], &cotton, &Params::default(), &mut Silent);
        let error = drape.err().map(|error| error.to_string()).unwrap_or_default();
        assert!(expect.iter().all(|part| error.contains(part)), "at {size} of its size: {error:?}");
    };
    check(0.45, &["much too small for this body: 1 % of the cloth is stretched by more than 1", "most of it in leg_"]);
    check(0.35, &["do not close on this body: \"leg_", "mm apart"]);
}

/// Trousers with `more` at the end of their seam file, and a soft, slippery knit.
fn slippery(more: &str) -> (Garment, Fabric) {
    let seams = [Model::Trousers.seams(), more.as_bytes()].concat();
    let style = Style::read(&Model::Trousers.drafts()[1].pieces, &seams, "seams");
    let knit = fabric::library().into_iter().find(|f| f.name == "interlock_tshirt").expect("in the library");
    (style.expect("drafted").mesh(0.04).expect("it meshes"), Fabric { friction_body: 0.05, ..knit })
}

fn slippery_trousers(more: &str) -> Result<Drape, SimError> {
    let measurements = Measurements::of(Sex::Male, 1.75)
        .with(Dimension::ChestGirth, 0.94)
        .with(Dimension::WaistGirth, 0.8)
        .with(Dimension::HipGirth, 0.95);
    let body = body::build(&measurements).expect("a body");
    let field = DistanceField::build(&body.mesh, 0.012).expect("a closed body");
    let (garment, slippery) = slippery(more);
    simulate(&body, &field, &[garment], &slippery, &Params::default(), &mut Silent)
}

#[test]
fn what_nothing_holds_up_hangs_from_its_top_edge_and_a_waistband_holds_it() {
    let drape = slippery_trousers("").expect("held up");
    let (garment, knit) = slippery("");
    let weight_n =
        Cloth::new(&garment, &knit, sewing::welded(&garment)).expect("sound").masses.iter().sum::<f64>() * GRAVITY;
    let braced_n = drape.braced_n.expect("it would slide off");
    assert!(drape.converged && (0.2 * weight_n..1.1 * weight_n).contains(&braced_n), "{braced_n} N of {weight_n}");
    let waist = r#"
        [[reinforce]]
        edges = ["leg_front_left.waist", "leg_front_right.waist", "leg_back_right.waist", "leg_back_left.waist"]
        kind = "waistband"
        stiffness_n = 200.0
        length_factor = 0.95
    "#;
    let drape = slippery_trousers(waist).map_err(|e| e.to_string());
    assert!(drape.is_ok_and(|drape| drape.converged && drape.braced_n.is_none()));
}

#[test]
fn a_garment_that_its_seams_squeeze_off_the_body_is_sewn_again_with_friction_or_given_up() {
    let measurements = Measurements::of(Sex::Female, 1.95).with(Dimension::Weight, 150.0);
    let body = body::build(&measurements).expect("a body");
    let field = DistanceField::build(&body.mesh, 0.01).expect("a closed body");
    let cotton = fabric::library().into_iter().find(|f| f.name == "cotton_shirting_light").expect("in the library");
    let garments = levels(Model::Teetop, 0.06);
    let params = Params::default();
    let start = placement::place(&body, &garments[0], &params.bend).expect("all roles are known");
    let skin = Skin::new(&body.mesh).expect("a closed body");
    let layer = Layer { garments: &garments, fabric: &cotton };
    let mut placed = placed(Wearer { body: &body, field: &field }, layer, &start);
    placed.dressing.skin = Some(&skin);
    let once = placed.dress(Grip::AtTheEnd, &mut Simulation::new(&params, &mut Silent, 0)).expect("it comes to rest");
    let rise_m = |worn: &[V3]| top_m(&garments[0], worn) - top_m(&garments[0], &start);
    assert!(rise_m(&once.positions) > MOST_RISE_M, "without friction it stays on, and shows nothing");
    let worn = |fabric: &Fabric| simulate(&body, &field, &garments, fabric, &params, &mut Silent);
    let drape = worn(&cotton).expect("friction holds it");
    assert!(rise_m(&drape.positions) <= MOST_RISE_M, "it has come off over the head");
    assert!(is_faultless(&drape), "{} mm inside, {} crossings", 1e3 * drape.penetration_max_m, drape.self_crossings);
    let slippery = Fabric { friction_body: 0.0, ..cotton.clone() };
    let error = worn(&slippery).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(error.contains("comes off this body upwards: as its seams close it rises by"), "{error}");
}

#[test]
fn lapels_are_sewn_onto_the_closed_garment_and_cross_nothing() {
    let body = body::build(&Measurements::of(Sex::Male, 1.75)).expect("a body");
    let field = DistanceField::build(&body.mesh, 0.01).expect("a closed body");
    let cotton = fabric::library().into_iter().find(|f| f.name == "cotton_shirting_light").expect("in the library");
    let garments = [0.06, 0.03].map(|edge_m| lapelled(edge_m, true));
    let drape = simulate(&body, &field, &garments, &cotton, &Params::default(), &mut Silent).expect("it drapes");
    assert!(is_faultless(&drape), "{} mm inside, {} crossings", 1e3 * drape.penetration_max_m, drape.self_crossings);
    // In the first run: a second would say that the first had a fault.
    assert!(drape.history.windows(2).filter(|two| two[1].level < two[0].level).count() == 0);
}

fn ended(converged: bool, (depth_m, crossings): (f64, usize)) -> Drape {
    Drape { converged, penetration_max_m: depth_m, self_crossings: crossings, ..testing::drape() }
}

#[test]
fn what_ends_with_a_fault_is_put_on_otherwise() {
    let body = body::build(&Measurements::of(Sex::Male, 1.75)).expect("a body");
    let field = DistanceField::build(&body.mesh, 0.01).expect("a closed body");
    let cotton = fabric::library().into_iter().find(|f| f.name == "cotton_shirting_light").expect("in the library");
    let (garments, params) = (levels(Model::Tshirt, 0.06), Params::default());
    let start = placement::place(&body, &garments[0], &params.bend).expect("all roles are known");
    let layer = Layer { garments: &garments, fabric: &cotton };
    let placed = placed(Wearer { body: &body, field: &field }, layer, &start);
    let flat =
        |stretch: f64| -> Vec<V3> { garments[0].rest.iter().map(|p| V3::new(p.x, stretch * p.y, 0.0)).collect() };
    let check =
        |what: &str, grip: Grip, fault: (f64, usize), stretch: f64, came_off: bool, expect: &[(Grip, f64, bool)]| {
            let drape = Drape { positions: flat(stretch), ..ended(what != "restless", fault) };
            let ways = other_ways(&placed, grip, &drape, came_off, &params).expect("it can be placed");
            let found: Vec<_> =
                ways.iter().map(|way| (way.grip, way.start.force, way.start.positions == start)).collect();
            assert!(found == expect, "{what}: {} ways", found.len());
        };
    let (late, early) = (Grip::AtTheEnd, Grip::Throughout);
    let resewn = |grip| RESEWN.map(|force| (grip, force, true));
    check("faultless", late, (1e-4, 0), 1.0, false, &[]);
    for (what, fault) in [("deep", (2e-3, 0)), ("deep and crossed", (2e-3, 4)), ("crossed", (1e-4, 4))] {
        check(what, late, fault, 1.0, false, &[&[(late, 1.0, false)][..], &resewn(late)].concat());
    }
    check("tight and crossed", late, (1e-4, 4), 1.5, false, &[&[(early, 1.0, true)][..], &resewn(late)].concat());
    check("crossed with friction", early, (1e-4, 4), 1.5, false, &resewn(early));
    check("restless", late, (1e-4, 4), 1.5, false, &[&[(early, 1.0, true)][..], &resewn(late)].concat());
    check("come off", late, (1e-4, 4), 1.0, true, &[(early, 1.0, true)]);
    check("come off with friction", early, (1e-4, 4), 1.0, true, &[]);
}

#[test]
fn a_raised_arm_draws_cuff_and_hem_as_far_as_the_sleeve_is_short() {
    let upright = body::build(&Measurements::of(Sex::Male, 1.76).with(Dimension::ChestGirth, 0.98)).expect("a body");
    let arms = |deg: f64| body::Pose { arm_deg: Some(deg), ..body::Pose::default() };
    let dressed = body::pose(&upright, arms(15.0)).expect("a pose");
    let field = DistanceField::build(&dressed.mesh, 0.01).expect("a field");
    let (garments, cloth, params) = (levels(Model::Tshirt, 0.04), &fabric::library()[0], Params::default());
    let garment = &garments[garments.len() - 1];
    let drape = simulate(&dressed, &field, &garments, cloth, &params, &mut Silent).expect("a drape");
    let carried = |deg: f64| {
        let bodies = body::way(&upright, arms(15.0), arms(deg), 5.0).expect("a way");
        let motion = Motion { bodies: &bodies, spacing_m: 0.01 };
        let worn = Worn { garment, fabric: cloth, drape: &drape };
        carry::carry(motion, worn, &params, &mut Silent).expect("it goes along")
    };
    // Without a movement it stays.
    let still = carried(15.0);
    let ways = still.positions.iter().zip(&drape.positions).map(|(a, b)| (a - b).norm());
    let moved_m = ways.sum::<f64>() / drape.positions.len() as f64;
    assert!(still.converged && moved_m < 1e-3, "{moved_m}");
    let kept = still.kept.expect("it was carried");
    assert!(kept.iter().zip(&drape.positions).all(|(kept, lay)| (kept - lay).norm() < 1e-9), "the skin does not move");

    let raised = carried(85.0);
    assert!(raised.converged && raised.self_crossings == 0 && raised.penetration_max_m < FAULTLESS_DEPTH_M);
    let sleeve = garment.pieces.iter().find(|piece| piece.id == "sleeve_right").expect("a sleeve");
    let seam = &sleeve.edges["underarm_front"];
    let is_cuff = |v: usize| sleeve.edges["opening"].contains(&v);
    let [armpit, cuff] =
        if is_cuff(seam[0]) { [seam[seam.len() - 1], seam[0]] } else { [seam[0], seam[seam.len() - 1]] };
    // The underarm stays at the trunk, the cuff turns about the shoulder joint.
    let joint = dressed.skeleton.at(Joint::ShoulderRight);
    let r = drape.positions[cuff] - joint;
    let (sin, cos) = 70.0_f64.to_radians().sin_cos();
    let turned = joint + V3::new(r.x * cos - r.z * sin, r.y, r.x * sin + r.z * cos);
    let underarm_m = garment.measurements.iter().find(|m| m.name == "Sleeve Length").expect("it is measured").l2d_m;
    let short_m = (turned - drape.positions[armpit]).norm() - underarm_m;
    let kept = raised.kept.expect("it was carried");
    let along = (drape.positions[armpit] - kept[cuff]).normalize();
    let drawn_m = (raised.positions[cuff] - kept[cuff]).dot(&along);
    let up_m = (drape.positions[armpit] - raised.positions[armpit]).dot(&along);
    assert!(short_m > 0.06 && drawn_m > 0.02 && up_m > 0.01, "{short_m}, {drawn_m}, {up_m}");
    assert!((drawn_m + up_m - short_m).abs() < 0.02, "{drawn_m} and {up_m} for {short_m}");
}
