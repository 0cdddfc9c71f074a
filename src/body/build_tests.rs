use super::*;
use crate::body::{Joint, Layer, RING};
use crate::geom::V2;

/// The study's subjects (thesis tables 6-1 to 6-4): stature, mass, chest, waist, hip, across shoulder, neck; cm and kg.
const SUBJECTS: [(Sex, [f64; 7]); 12] = [
    (Sex::Male, [169.0, 62.0, 93.1, 89.0, 97.5, 42.4, 38.2]),
    (Sex::Male, [169.0, 53.0, 86.3, 78.2, 91.4, 42.9, 37.8]),
    (Sex::Male, [170.0, 67.0, 90.8, 86.2, 98.4, 41.6, 36.2]),
    (Sex::Male, [176.0, 68.0, 95.3, 83.6, 89.6, 47.5, 42.1]),
    (Sex::Male, [182.0, 70.0, 95.6, 86.7, 102.4, 45.8, 38.1]),
    (Sex::Male, [185.0, 81.0, 102.0, 87.3, 103.2, 45.5, 38.7]),
    (Sex::Female, [163.0, 47.0, 83.4, 67.8, 92.8, 41.2, 32.5]),
    (Sex::Female, [157.0, 54.0, 87.7, 72.9, 93.5, 38.0, 33.5]),
    (Sex::Female, [165.0, 54.0, 91.9, 77.9, 97.3, 45.3, 35.5]),
    (Sex::Female, [168.0, 57.0, 89.8, 73.6, 96.6, 41.6, 37.2]),
    (Sex::Female, [165.0, 73.0, 103.2, 89.3, 104.0, 42.5, 36.6]),
    (Sex::Female, [172.0, 56.0, 88.3, 72.0, 96.2, 41.0, 30.4]),
];

fn subject(sex: Sex, [stature, mass, chest, waist, hip, across, neck]: [f64; 7]) -> Measurements {
    let metres = |cm: f64| Some(cm / 100.0);
    Measurements {
        sex,
        stature_m: stature / 100.0,
        weight_kg: Some(mass),
        chest_girth_m: metres(chest),
        waist_girth_m: metres(waist),
        hip_girth_m: metres(hip),
        neck_girth_m: metres(neck),
        across_shoulder_m: metres(across),
    }
}

#[test]
fn the_study_subjects_measure_as_asked() {
    for (i, (sex, numbers)) in SUBJECTS.into_iter().enumerate() {
        let body = build(&subject(sex, numbers)).expect("a subject");
        let girths = &body.girths;
        let [stature, _, chest, waist, hip, across, neck] = numbers.map(|cm| cm * 10.0);
        let pairs = [
            ("stature", stature, girths.stature_mm, 2.0),
            ("chest", chest, girths.chest_girth_mm, 2.0),
            ("waist", waist, girths.waist_girth_mm, 2.0),
            ("hip", hip, girths.hip_girth_mm, 2.0),
            ("neck", neck, girths.neck_girth_mm, 2.0),
            ("across shoulder", across, girths.across_shoulder_mm, 5.0),
        ];
        let errors = pairs.map(|(_, asked, read, _)| read - asked);
        eprintln!("subject {i} {} triangles {:.1} l: {errors:.2?}", body.mesh.triangles.len(), girths.volume_l);
        for (name, asked, read, tolerance) in pairs {
            assert!((read - asked).abs() <= tolerance, "subject {i} {name}: asked {asked}, tape reads {read:.2} mm");
        }
    }
}

/// Bodies far from the mean, and bodies of which little is known: thin, heavy, short, tall.
#[test]
fn unusual_bodies_can_be_built() {
    let sexes = [Sex::Male, Sex::Female];
    let mut state = 1_u64;
    let mut share = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 31) as f64
    };
    for i in 0..UNUSUAL {
        let sex = sexes[i % 2];
        let stature_m = 1.45 + 0.6 * share();
        let index = 16.5 + 17.0 * share();
        let asked = Measurements { weight_kg: Some(index * stature_m * stature_m), ..only_stature(sex, stature_m) };
        let body = build(&asked).unwrap_or_else(|error| panic!("{asked:?}: {error}"));
        assert!(body.mesh.is_closed_manifold(), "{asked:?}");
        assert!((body.girths.stature_mm - stature_m * 1e3).abs() < 0.1, "{asked:?}");
        let found = measure::measure(&body.mesh, Some(sex)).unwrap_or_else(|error| panic!("{asked:?}: {error}"));
        let pairs = [
            ("neck", body.girths.neck_girth_mm, found.neck_girth_mm, 1.5),
            ("chest", body.girths.chest_girth_mm, found.chest_girth_mm, 12.0),
            ("waist", body.girths.waist_girth_mm, found.waist_girth_mm, 0.5),
            ("hip", body.girths.hip_girth_mm, found.hip_girth_mm, 12.0),
        ];
        let errors = pairs.map(|(_, built, found, _)| found - built);
        eprintln!(
            "{sex:?} {stature_m:.3} m, {index:.1} kg/m2: measured minus built {errors:.1?}, volume {:.1} l for {:.1} kg",
            found.volume_l,
            index * stature_m * stature_m
        );
        for (name, built, found, tolerance) in pairs {
            assert!((built - found).abs() < tolerance, "{asked:?} {name}: built {built:.1}, found {found:.1}");
        }
    }
}

/// How many unusual bodies are built.
const UNUSUAL: usize = 4;

fn only_stature(sex: Sex, stature_m: f64) -> Measurements {
    Measurements {
        sex,
        stature_m,
        weight_kg: None,
        chest_girth_m: None,
        waist_girth_m: None,
        hip_girth_m: None,
        neck_girth_m: None,
        across_shoulder_m: None,
    }
}

#[test]
fn the_same_measurements_give_the_same_body() {
    let asked = subject(SUBJECTS[0].0, SUBJECTS[0].1);
    assert_eq!(build(&asked).expect("a subject"), build(&asked).expect("a subject"));
}

fn check_meshes(body: &Body) {
    assert!(body.mesh.is_closed_manifold());
    let control = body.control.triangulated();
    assert!(control.is_closed_manifold());
    assert!(control.volume() > 0.9 * body.mesh.volume(), "{} of {}", control.volume(), body.mesh.volume());
    assert_eq!(body.control.faces.len(), body.control.regions.len());
    assert_eq!(body.control.ring(Layer::WristLeft).len(), RING);
    let elbow = body.skeleton.at(Joint::ElbowRight);
    assert!(elbow.x > body.skeleton.at(Joint::ShoulderRight).x && elbow.z < body.skeleton.at(Joint::ShoulderRight).z);
}

/// Distance of a point from the outlines of the horizontal section through it, metres.
fn off_skin(mesh: &TriMesh, point: V3) -> f64 {
    let outlines = crate::geom::section::section(mesh, &Plane::horizontal(point.z));
    let sides = outlines.iter().flat_map(|outline| outline.points.iter().zip(outline.points.iter().cycle().skip(1)));
    let distance = |(a, b): (&V2, &V2)| {
        let (side, from_a) = (b - a, point.xy() - a);
        let share = (from_a.dot(&side) / side.norm_squared().max(1e-18)).clamp(0.0, 1.0);
        (from_a - side * share).norm()
    };
    sides.map(distance).fold(f64::INFINITY, f64::min)
}

#[test]
fn meshes_are_closed_and_landmarks_lie_on_the_skin() {
    for (sex, numbers) in [SUBJECTS[3], SUBJECTS[6]] {
        let body = build(&subject(sex, numbers)).expect("a subject");
        check_meshes(&body);
        let tapes = body.tapes();
        for (z, girth_mm) in
            [(body.levels.waist_m, body.girths.waist_girth_mm), (body.levels.hip_m, body.girths.hip_girth_mm)]
        {
            let band: Vec<V2> = tapes.positions.iter().filter(|p| (p.z - z).abs() < 5e-3).map(|p| p.xy()).collect();
            let off_mm = crate::geom::hull::tape_girth(&band) * 1e3 - girth_mm;
            assert!((10.0..25.0).contains(&off_mm), "a tape 3 mm off the skin is {off_mm:.1} mm longer");
        }
        let marks = &body.landmarks;
        let points = [
            ("side neck", marks.side_neck[0]),
            ("shoulder", marks.shoulder[0]),
            ("left shoulder", marks.shoulder[1]),
            ("back neck", marks.back_neck),
            ("front neck", marks.front_neck),
            ("armpit", marks.armpit[0]),
            ("bust", marks.bust[0]),
            ("left bust", marks.bust[1]),
        ];
        for (name, point) in points {
            let off = off_skin(&body.mesh, point);
            assert!(off < 1e-3, "{name} {point:?} is {:.2} mm off the skin", off * 1e3);
        }
        assert!(marks.back_neck.z > marks.side_neck[0].z && marks.side_neck[0].z > marks.shoulder[0].z);
        assert!(marks.shoulder[0].z > marks.front_neck.z - 0.05 && marks.armpit[0].z > body.levels.chest_m);
        let slope = (marks.side_neck[0].z - marks.shoulder[0].z).atan2(marks.shoulder[0].x - marks.side_neck[0].x);
        assert!((12.0..28.0).contains(&slope.to_degrees()), "shoulders slope by {:.1} degrees", slope.to_degrees());
        for (feature, vertex) in body.control.feature_points() {
            assert!(body.control.positions[vertex].iter().all(|c| c.is_finite()), "{feature}");
        }
    }
}
