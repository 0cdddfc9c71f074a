use super::*;
use crate::Dimension;
use crate::testing::{Noise, ascii_ply, binary_ply, binary_stl, in_mm, pierce, placed, roughen};
use crate::{Joint, Measurements, build, lengths, measure, write_obj};
use geom::{Surface, TriMesh};

fn built(sex: Sex, stature_m: f64, weight_kg: f64) -> Body {
    let asked = Measurements::of(sex, stature_m).with(Dimension::Weight, weight_kg);
    build(&asked).expect("an ordinary body")
}

fn ordinary() -> TriMesh {
    built(Sex::Female, 1.66, 64.0).mesh
}

fn spoil(mesh: &mut TriMesh) {
    let mut state = 7_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
    };
    mesh.triangles.retain(|t| {
        let z = t.iter().map(|&i| mesh.positions[i].z).fold(0.0, f64::max);
        z > 0.006 && z < 1.655
    });
    mesh.positions.iter_mut().for_each(|p| *p += V3::new(noise(), noise(), noise()) * 0.003);
    let first = mesh.positions.len();
    let floor = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    mesh.positions.extend(floor.map(|(x, y)| V3::new(x, y, -0.003)));
    mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    mesh.positions.extend([V3::new(0.4, 0.3, 1.2), V3::new(0.41, 0.3, 1.2), V3::new(0.4, 0.31, 1.9)]);
    mesh.triangles.push([first + 4, first + 5, first + 6]);
}

#[test]
fn a_spoilt_turned_scan_measures_as_the_body() {
    let clean = ordinary();
    let truth = measure(&clean, Some(Sex::Female)).expect("a standing body");
    let check = |place: &dyn Fn(V3) -> V3| {
        let mut mesh = clean.clone();
        spoil(&mut mesh);
        mesh.positions.iter_mut().for_each(|p| *p = place(*p));
        let scan = from_scan(write_obj(&mesh).as_bytes(), None, Some(Sex::Female)).expect("a scan of a body");
        let found = &scan.girths;
        // The patches over the holes in the soles bulge: what stands on them reads up to 9 mm high.
        let pairs = [
            ("stature", in_mm(&truth, "stature_mm"), in_mm(found, "stature_mm"), 8.0),
            ("neck", in_mm(&truth, "neck_girth_mm"), in_mm(found, "neck_girth_mm"), 4.0),
            ("chest", in_mm(&truth, "chest_girth_mm"), in_mm(found, "chest_girth_mm"), 9.0),
            ("waist", in_mm(&truth, "waist_girth_mm"), in_mm(found, "waist_girth_mm"), 5.0),
            ("hip", in_mm(&truth, "hip_girth_mm"), in_mm(found, "hip_girth_mm"), 9.0),
            ("inseam", in_mm(&truth, "inseam_mm"), in_mm(found, "inseam_mm"), 10.0),
        ];
        for (name, known, found, tolerance) in pairs {
            assert!((known - found).abs() < tolerance, "{name}: {found:.1} for {known:.1}; {:?}", scan.imported.notes);
        }
        assert!(scan.imported.mesh.is_closed_manifold());
    };
    let turned = |degrees: f64, p: V3| nalgebra::Rotation3::from_axis_angle(&V3::z_axis(), degrees.to_radians()) * p;
    check(&|p| turned(40.0, p) * 1000.0 + V3::new(300.0, -200.0, 50.0));
    check(&|p| turned(175.0, p) * 100.0);
    check(&|p| turned(-75.0, p));
    check(&|p| V3::new(p.y, p.z, p.x) * 1000.0);
    check(&|p| V3::new(p.z, p.x, p.y) * 100.0);
    check(&|p| V3::new(p.x, -p.y, -p.z));
}

#[test]
fn a_scan_becomes_a_body_with_the_features_of_the_built_one() {
    let known = built(Sex::Male, 1.78, 76.0);
    let turned = nalgebra::Rotation3::from_euler_angles(1.1, 0.4, -2.0);
    let mesh = placed(&known.mesh, |p| turned * p * 1000.0);
    let scan = from_scan(&binary_ply(&mesh), None, Some(Sex::Male)).expect("a scan of a body");
    let body = scan.into_body().expect("free arms and legs");
    assert!(body.control.triangulated().is_closed_manifold());
    assert_eq!(body.control.faces, known.control.faces);
    let surface = Surface::new(&body.mesh).expect("a closed scan");
    assert!(body.skeleton.joints.iter().all(|joint| surface.signed_distance(joint) < 0.0));
    let pairs = [
        ("shoulder", body.landmarks.shoulder[0], known.landmarks.shoulder[0]),
        ("left armpit", body.landmarks.armpit[1], known.landmarks.armpit[1]),
        ("side neck", body.landmarks.side_neck[0], known.landmarks.side_neck[0]),
        ("front neck", body.landmarks.front_neck, known.landmarks.front_neck),
        ("back neck", body.landmarks.back_neck, known.landmarks.back_neck),
        ("crotch", body.landmarks.crotch, known.landmarks.crotch),
    ];
    for (name, found, truth) in pairs {
        assert!((found - truth).norm() < 0.035, "{name}: {found:?} for {truth:?}");
    }
    for (i, (found, truth)) in body.skeleton.joints.iter().zip(&known.skeleton.joints).enumerate() {
        assert!((found - truth).norm() < 0.04, "joint {i}: {found:?} for {truth:?}");
    }
}

#[test]
fn a_scan_keeps_all_that_is_measured_on_it() {
    for (sex, stature_m, weight_kg) in [(Sex::Male, 1.78, 80.0), (Sex::Female, 1.65, 58.0)] {
        let bytes = write_obj(&built(sex, stature_m, weight_kg).mesh);
        let scan = from_scan(bytes.as_bytes(), None, Some(sex)).expect("a scan of a body");
        let measured = lengths(&scan.imported.mesh, Some(sex), scan.girths.clone()).expect("a standing body").girths;
        let of_subject = scan.girths.measurements(sex);
        let body = scan.into_body().expect("a body that wears garments");
        let check = |dimension: Dimension| {
            let known = measured.get(dimension).expect("it is read");
            let off = |found: Option<f64>| found.map_or(f64::INFINITY, |found| (found - known).abs());
            assert!(off(body.girths.get(dimension)) < 1e-9, "{dimension:?} of the body");
            assert!(off(of_subject.get(dimension)) < 5.1e-5, "{dimension:?} of the subject");
        };
        use Dimension::*;
        [Stature, NeckGirth, ChestGirth, UnderbustGirth, WaistGirth, HipGirth, ThighGirth].into_iter().for_each(check);
        [UpperArmGirth, ForearmGirth, WristGirth, ArmLength, AcrossShoulder, Inseam].into_iter().for_each(check);
        [KneeGirth, CalfGirth, AnkleGirth].into_iter().for_each(check);
    }
}

#[test]
fn any_format_unit_turn_noise_and_hole_measures_as_the_body() {
    let mut noise = Noise(5);
    let mut off: std::collections::BTreeMap<&str, Vec<f64>> = std::collections::BTreeMap::new();
    let people =
        [(Sex::Male, 1.70, 88.0), (Sex::Female, 1.58, 50.0), (Sex::Female, 1.72, 84.0), (Sex::Male, 1.88, 80.0)];
    for (i, (sex, stature, weight)) in people.into_iter().enumerate() {
        let known = built(sex, stature, weight);
        let truth = measure(&known.mesh, Some(sex)).expect("a standing body");
        let mut mesh = known.mesh.clone();
        roughen(&mut mesh, 0.002, &mut noise);
        let scaled = |x: f64, y: f64, z: f64| V3::new(x, y, z) * stature;
        pierce(
            &mut mesh,
            &[scaled(0.0, 0.0, 1.0), known.landmarks.armpit[0], scaled(0.05, -0.03, 0.0)],
            0.012 * stature,
        );
        let turn = nalgebra::Rotation3::from_euler_angles(noise.next() * 6.0, noise.next() * 3.0, noise.next() * 6.0);
        let unit = [1000.0, 100.0, 1.0, 1000.0][i];
        let mesh = placed(&mesh, |p| (turn * p + V3::new(0.4, 0.2, -0.6)) * unit);
        let bytes = match i {
            0 => ascii_ply(&mesh),
            1 => binary_ply(&mesh),
            2 => binary_stl(&mesh),
            _ => write_obj(&mesh).into_bytes(),
        };
        let found = from_scan(&bytes, None, Some(sex)).expect("a scan of a body").girths;
        let pairs = [
            ("stature", in_mm(&found, "stature_mm") - in_mm(&truth, "stature_mm")),
            ("neck", in_mm(&found, "neck_girth_mm") - in_mm(&truth, "neck_girth_mm")),
            ("chest", in_mm(&found, "chest_girth_mm") - in_mm(&truth, "chest_girth_mm")),
            ("waist", in_mm(&found, "waist_girth_mm") - in_mm(&truth, "waist_girth_mm")),
            ("hip", in_mm(&found, "hip_girth_mm") - in_mm(&truth, "hip_girth_mm")),
            ("chest level", in_mm(&found, "chest_level_mm") - in_mm(&truth, "chest_level_mm")),
            ("neck level", in_mm(&found, "neck_level_mm") - in_mm(&truth, "neck_level_mm")),
            ("crotch level", in_mm(&found, "crotch_level_mm") - in_mm(&truth, "crotch_level_mm")),
        ];
        pairs.into_iter().for_each(|(name, error)| off.entry(name).or_default().push(error));
    }
    for (name, errors) in off {
        let mean = errors.iter().map(|error| error.abs()).sum::<f64>() / errors.len() as f64;
        let limit = if ["chest", "waist", "hip"].contains(&name) { 9.0 } else { 4.0 };
        assert!(mean < limit, "{name}: {errors:.1?} mm");
    }
}

#[test]
fn meshes_that_are_no_body_are_refused_with_the_reason() {
    let whole = ordinary();
    let part = |keep: &dyn Fn(&V3) -> bool| {
        let mut mesh = whole.clone();
        mesh.triangles.retain(|triangle| triangle.iter().all(|&i| keep(&whole.positions[i])));
        mesh
    };
    let check = |mesh: &TriMesh, unit: Option<LengthUnit>, needle: &str| {
        let error = from_scan(write_obj(mesh).as_bytes(), unit, None).expect_err(needle).to_string();
        assert!(error.contains(needle), "{error}");
    };
    check(&placed(&whole, |p| p * 1000.0), Some(LengthUnit::Metre), "1660.0 m high");
    check(&part(&|p| p.x > 0.0), None, "half a body");
    check(&part(&|p| p.z > 0.8 && p.x.abs() < 0.3), Some(LengthUnit::Metre), "no adult");
    let mut two = whole.clone();
    let count = two.positions.len();
    two.positions.extend(whole.positions.iter().map(|p| p + V3::new(1.2, 0.3, 0.0)));
    two.triangles.extend(whole.triangles.iter().map(|triangle| triangle.map(|i| i + count)));
    check(&two, None, "several bodies");
    let many = format!("ply\nformat ascii 1.0\nelement vertex 3\nelement face {}\nend_header\n", 5_000_000);
    let error = from_scan(many.as_bytes(), None, None).expect_err("too many faces").to_string();
    assert!(error.contains("5000000 faces"), "{error}");
}

#[test]
fn doubled_turned_and_branching_triangles_do_not_stop_a_scan() {
    let whole = ordinary();
    let truth = measure(&whole, Some(Sex::Female)).expect("a standing body");
    let mut mesh = whole.clone();
    for i in (0..mesh.triangles.len()).step_by(61) {
        let [a, b, c] = mesh.triangles[i];
        match i % 3 {
            0 => mesh.triangles[i] = [a, c, b],
            1 => mesh.triangles.push([b, c, a]),
            _ => {
                mesh.positions.push(whole.positions[a] * 1.01);
                mesh.triangles.push([a, b, mesh.positions.len() - 1]);
            }
        }
    }
    let scan = from_scan(&ascii_ply(&mesh), None, Some(Sex::Female)).expect("a body");
    assert!((in_mm(&scan.girths, "waist_girth_mm") - in_mm(&truth, "waist_girth_mm")).abs() < 3.0);
    assert!((in_mm(&scan.girths, "hip_girth_mm") - in_mm(&truth, "hip_girth_mm")).abs() < 3.0);
    scan.into_body().expect("a closed surface");
}

/// Part of a mesh above a plane across the legs, on the sides that are cut: right, left.
fn cut_off(mesh: &TriMesh, height: f64, cut: [bool; 2]) -> TriMesh {
    let mut rest = mesh.clone();
    let is_off = |p: &V3| p.z < height && cut[usize::from(p.x < 0.0)];
    rest.triangles.retain(|triangle| !triangle.iter().any(|&i| is_off(&mesh.positions[i])));
    rest
}

/// Keys that are known without feet.
const TRUNK: [&str; 5] = ["neck_girth_mm", "chest_girth_mm", "underbust_girth_mm", "hip_girth_mm", "thigh_girth_mm"];
/// Keys of limbs that do not depend on the floor.
const LIMBS: [&str; 3] = ["forearm_girth_mm", "elbow_girth_mm", "wrist_girth_mm"];

fn measured(mesh: &TriMesh, sex: Sex) -> (serde_json::Value, String, Scan) {
    let scan = from_scan(&binary_ply(mesh), None, Some(sex)).expect("a scan of a body");
    let written = serde_json::to_value(scan.measured().expect("a standing body")).expect("numbers");
    let said =
        scan.imported.notes.iter().filter(|note| note.contains("missing")).cloned().collect::<Vec<_>>().join("; ");
    (written, said, scan)
}

fn check_footless(name: &str, whole: &TriMesh, sex: Sex) {
    let (truth, said, _) = measured(whole, sex);
    assert_eq!(said, "", "{name} is whole");
    let read = |of: &serde_json::Value, key: &str| of[key].as_f64().unwrap_or_else(|| panic!("{name}: {key}"));
    for height in [0.04, 0.06, 0.12, 0.25] {
        let (found, said, scan) = measured(&cut_off(whole, height, [true; 2]), sex);
        let place = format!("{name} cut at {height}");
        assert!(said.starts_with("the feet are missing"), "{place}: {said} {:?}", scan.imported.notes);
        for key in TRUNK {
            let off = read(&found, key) - read(&truth, key);
            assert!(off.abs() < 0.012 * read(&truth, key), "{place}: {key} is off by {off:.1} mm");
        }
        for (key, value) in found.as_object().expect("a map").iter().filter(|(_, value)| !value.is_object()) {
            let gone = !TRUNK.iter().chain(&LIMBS).any(|known| known == key);
            assert_eq!(value.is_null(), gone, "{place}: {key} is {value}");
            assert!(!gone || found["confidence"][key].is_null(), "{place}: {key} has a deviation");
        }
        let refused = scan.into_body().expect_err("no feet").to_string();
        assert!(refused.contains("a foot is missing") && refused.contains("stature"), "{refused}");
        let behind = placed(&cut_off(whole, height, [true; 2]), |p| V3::new(-p.x, -p.y, p.z));
        let (found, ..) = measured(&behind, sex);
        for key in TRUNK {
            let off = read(&found, key) - read(&truth, key);
            assert!(off.abs() < 0.012 * read(&truth, key), "{place}, facing back: {key} is off by {off:.1} mm");
        }
        // Without a shin a scan stands askew, and is refused.
        let one_foot = [([true, false], "right"), ([false, true], "left")];
        for (cut, side) in one_foot.into_iter().filter(|_| height < 0.25) {
            let (found, said, _) = measured(&cut_off(whole, height, cut), sex);
            assert!(said.starts_with(&format!("the {side} foot is missing")), "{place}: {said}");
            let off = read(&found, "stature_mm") - read(&truth, "stature_mm");
            assert!(off.abs() < 2.0, "{place}, {side}: stature is off by {off:.1} mm");
            assert_eq!(found["ankle_girth_mm"].is_null(), side == "right", "{place}, {side}");
        }
    }
    // Booth scanners do not see the soles.
    for height in [0.003, 0.006, 0.010] {
        let (found, said, _) = measured(&cut_off(whole, height, [true; 2]), sex);
        assert_eq!(said, "", "{name} without soles to {height}");
        assert!((read(&found, "stature_mm") - read(&truth, "stature_mm")).abs() < 11.0, "{name} without soles");
    }
    let mut pierced = whole.clone();
    pierce(&mut pierced, &[V3::new(0.1, 0.02, 0.0), V3::new(-0.1, 0.06, 0.0)], 0.03);
    assert_eq!(measured(&pierced, sex).1, "", "{name} with holes in its soles");
}

#[test]
fn feet_that_are_missing_are_said_and_what_hangs_on_them_is_left_out() {
    let women = [(1.52, 46.0), (1.60, 85.0), (1.78, 66.0)].map(|(h, w)| (Sex::Female, h, w));
    let men = [(1.64, 60.0), (1.78, 80.0), (1.94, 112.0)].map(|(h, w)| (Sex::Male, h, w));
    for (sex, stature, weight) in women.into_iter().chain(men) {
        check_footless(&format!("{sex:?} of {stature} m"), &built(sex, stature, weight).mesh, sex);
    }
}

#[test]
fn feet_of_the_reference_bodies_are_seen_and_missed() {
    let Some(folder) = crate::testing::reference_bodies() else {
        eprintln!("skipped: no reference bodies beside the project");
        return;
    };
    let files =
        ["meshes/s01.obj", "meshes/s02.obj", "meshes/s03.obj", "meshes/s04.obj", "meshes/s05.ply", "meshes/s06.obj"];
    for (i, file) in files.into_iter().enumerate() {
        let sex = if i < 3 { Sex::Male } else { Sex::Female };
        let whole = from_scan(&std::fs::read(folder.join(file)).expect("bytes"), None, Some(sex)).expect("a body");
        check_footless(file, &whole.imported.mesh, sex);
    }
    for (file, sex) in [("scans/s02_scan.ply", Sex::Male), ("scans/s05_scan.ply", Sex::Female)] {
        let scan = from_scan(&std::fs::read(folder.join(file)).expect("bytes"), None, Some(sex)).expect("a body");
        assert!(!scan.imported.notes.iter().any(|note| note.contains("missing")), "{file}: {:?}", scan.imported.notes);
    }
}

#[test]
fn arms_spread_to_the_horizontal_find_their_armpits() {
    let known = built(Sex::Female, 1.68, 62.0);
    let spread = crate::pose(&known, crate::Pose { arm_deg: Some(85.0), ..crate::Pose::default() }).expect("free arms");
    let scan = from_scan(&binary_ply(&spread.mesh), None, Some(Sex::Female)).expect("a scan of a body");
    let body = scan.into_body().expect("arms apart from the trunk");
    for side in [0, 1] {
        let (found, truth) = (body.landmarks.armpit[side], known.landmarks.armpit[side]);
        assert!((found - truth).norm() < 0.05, "armpit {side}: {found:?} for {truth:?}");
    }
    for joint in [Joint::ElbowRight, Joint::WristLeft] {
        let (found, truth) = (body.skeleton.at(joint), spread.skeleton.at(joint));
        assert!((found - truth).norm() < 0.05, "{joint:?}: {found:?} for {truth:?}");
    }
    assert!(body.control.triangulated().is_closed_manifold());
}
