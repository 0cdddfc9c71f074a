use super::*;
use crate::people::survey::Survey;
use crate::testing::in_mm;
use crate::{ControlMesh, Dimension, Joint, Layer, RING, Sex};
use geom::{V2, crossing, winding};
use std::sync::LazyLock;

/// The subjects of the study [T, tables 6-1 to 6-4]: stature, mass, chest, waist, hip, across shoulder, neck; cm and
/// kg.
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
    Measurements::of(sex, stature / 100.0)
        .with(Dimension::Weight, mass)
        .with(Dimension::ChestGirth, metres(chest))
        .with(Dimension::WaistGirth, metres(waist))
        .with(Dimension::HipGirth, metres(hip))
        .with(Dimension::NeckGirth, metres(neck))
        .with(Dimension::AcrossShoulder, metres(across))
}

#[test]
fn the_study_subjects_measure_as_asked() {
    for (i, (sex, numbers)) in SUBJECTS.into_iter().enumerate() {
        let body = build(&subject(sex, numbers)).expect("a subject");
        let girths = &body.girths;
        let [stature, _, chest, waist, hip, across, neck] = numbers.map(|cm| cm * 10.0);
        let pairs = [
            ("stature", stature, in_mm(girths, "stature_mm"), 2.0),
            ("chest", chest, in_mm(girths, "chest_girth_mm"), 2.0),
            ("waist", waist, in_mm(girths, "waist_girth_mm"), 2.0),
            ("hip", hip, in_mm(girths, "hip_girth_mm"), 2.0),
            ("neck", neck, in_mm(girths, "neck_girth_mm"), 2.0),
            ("across shoulder", across, in_mm(girths, "across_shoulder_mm"), 5.0),
        ];
        let errors = pairs.map(|(_, asked, read, _)| read - asked);
        eprintln!("subject {i} {} triangles {:.1} l: {errors:.2?}", body.mesh.triangles.len(), girths.volume_l());
        for (name, asked, read, tolerance) in pairs {
            assert!((read - asked).abs() <= tolerance, "subject {i} {name}: asked {asked}, tape reads {read:.2} mm");
        }
    }
}

fn share(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) as f64 / (1_u64 << 31) as f64
}

/// Random adult: stature, mass index, sometimes more, each up to two standard deviations from the survey's expectation.
fn anybody(state: &mut u64) -> Measurements {
    let mut share = || share(state);
    let sex = if share() < 0.5 { Sex::Male } else { Sex::Female };
    let stature_m = 1.45 + 0.6 * share();
    let weight_kg = (16.5 + 23.5 * share()) * stature_m * stature_m;
    let mut known = Measurements::of(sex, stature_m).with(Dimension::Weight, weight_kg);
    let chance = [0.0, 0.3, 0.9][(3.0 * share()) as usize];
    for dimension in Dimension::ALL.into_iter().skip(2) {
        let (wanted, score) = (share() < chance, 4.0 * share() - 2.0);
        if wanted {
            let given: Vec<(Dimension, f64)> = known.known().collect();
            known.set(dimension, Survey::of(sex).expect(&[dimension], &given)[0].at(score));
        }
    }
    known
}

/// Person who is not refused at once but whom hardly anybody resembles, such as one of large waist over small hips.
fn an_odd_body(state: &mut u64) -> Measurements {
    const GIRTHS: [Dimension; 6] = [
        Dimension::ChestGirth,
        Dimension::WaistGirth,
        Dimension::HipGirth,
        Dimension::NeckGirth,
        Dimension::ThighGirth,
        Dimension::UpperArmGirth,
    ];
    loop {
        let sex = if share(state) < 0.5 { Sex::Male } else { Sex::Female };
        let mut known = Measurements::of(sex, 1.45 + 0.6 * share(state));
        for _ in 0..2 {
            let dimension = GIRTHS[(6.0 * share(state)) as usize];
            let alike = Survey::of(sex).expect(&[dimension], &[(Dimension::Stature, known.stature_m())])[0];
            known.set(dimension, alike.at(8.0 * share(state) - 4.0));
        }
        if Profile::new(&known).is_ok() {
            return known;
        }
    }
}

/// Every body is closed, in one piece without handles and without self-intersections, contains its joints, has the same
/// topology, and measures as requested.
#[test]
fn anybody_can_be_built() {
    let mut state = 1_u64;
    let people: Vec<Measurements> = (0..200).map(|_| anybody(&mut state)).collect();
    let wrong: Vec<String> = of_all(&people, |asked| match build(asked) {
        Ok(body) => faults(asked, &body),
        Err(error) => vec![error.to_string()],
    });
    assert!(wrong.is_empty(), "{} faults\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn odd_people_are_whole_or_refused() {
    let mut state = 2_u64;
    let people: Vec<Measurements> = (0..ODD).map(|_| an_odd_body(&mut state)).collect();
    let refused = std::sync::atomic::AtomicUsize::new(0);
    let wrong = of_all(&people, |asked| match build(asked) {
        Ok(body) => faults(asked, &body),
        Err(BodyError::Inconsistent { .. }) => {
            refused.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            Vec::new()
        }
        Err(error) => vec![error.to_string()],
    });
    assert!(wrong.is_empty(), "{} faults\n{}", wrong.len(), wrong.join("\n"));
    let refused = refused.into_inner();
    assert!(refused < ODD / 4, "{refused} of {ODD} refused");
}

const ODD: usize = 40;

fn of_all(people: &[Measurements], check: impl Fn(&Measurements) -> Vec<String> + Sync) -> Vec<String> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let complaints = |(number, asked): (usize, &Measurements)| {
        check(asked).into_iter().map(|fault| format!("{number}: {fault}: {asked:?}")).collect::<Vec<_>>()
    };
    std::thread::scope(|scope| {
        let share =
            |first: usize| people.iter().enumerate().skip(first).step_by(threads).flat_map(complaints).collect();
        let running: Vec<_> = (0..threads).map(|first| scope.spawn(move || -> Vec<String> { share(first) })).collect();
        running.into_iter().flat_map(|thread| thread.join().expect("a check does not panic")).collect()
    })
}

fn faults(asked: &Measurements, body: &Body) -> Vec<String> {
    let mesh = &body.mesh;
    let mut faults = Vec::new();
    static USUAL: LazyLock<ControlMesh> =
        LazyLock::new(|| build(&Measurements::of(Sex::Female, 1.6)).expect("an ordinary woman").control);
    if (&body.control.faces, &body.control.regions) != (&USUAL.faces, &USUAL.regions) {
        faults.push("a control mesh of its own".to_owned());
    }
    let euler = (mesh.positions.len() + mesh.triangles.len()) as isize - mesh.edges().len() as isize;
    if !mesh.is_closed_manifold() || euler != 2 {
        faults.push(format!("not a closed manifold without handles: Euler characteristic {euler}"));
    }
    let crossings = crossing::self_crossings(mesh);
    if let Some(&[triangle, _]) = crossings.first() {
        let place = mesh.triangles[triangle].iter().map(|&vertex| mesh.positions[vertex]).sum::<V3>() / 3.0;
        faults.push(format!("{} crossings, one at {place:.3?}", crossings.len()));
    }
    let (low, high) = mesh.bounds().expect("vertices");
    if low.z.abs() > 1e-6 || (high.z - asked.stature_m()).abs() > 1e-6 {
        faults.push(format!("reaches from {} to {} m", low.z, high.z));
    }
    for (number, joint) in body.skeleton.joints.iter().enumerate() {
        if (winding::winding_number(mesh, *joint) - 1.0).abs() > 1e-6 {
            faults.push(format!("joint {number} at {joint:.3?} is not inside"));
        }
    }
    for (dimension, asked) in asked.known() {
        let Some(read) = body.girths.get(dimension) else { continue };
        let off_mm = (read - asked) * 1e3;
        if off_mm.abs() > if dimension == Dimension::AcrossShoulder { 5.0 } else { 2.0 } {
            faults.push(format!("{dimension:?} is off by {off_mm:.1} mm"));
        }
    }
    faults
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

fn off_skin(mesh: &TriMesh, point: V3) -> f64 {
    let outlines = geom::section::section(mesh, &Plane::horizontal(point.z));
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
        for (z, girth) in [(body.levels.waist_m, Dimension::WaistGirth), (body.levels.hip_m, Dimension::HipGirth)] {
            let band: Vec<V2> = tapes.positions.iter().filter(|p| (p.z - z).abs() < 5e-3).map(|p| p.xy()).collect();
            let off_mm = (geom::hull::tape_girth(&band) - body.girths.get(girth).expect("read")) * 1e3;
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
