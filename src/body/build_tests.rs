use super::*;
use crate::body::{Joint, Layer, RING, write_obj};

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
        let started = std::time::Instant::now();
        let body = build(&subject(sex, numbers)).expect("a subject");
        let took = started.elapsed();
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
        eprintln!(
            "subject {i} {took:?} {} triangles {:.1} l: {errors:.2?}",
            body.mesh.triangles.len(),
            girths.volume_l
        );
        if let Ok(folder) = std::env::var("TOILE_BODIES") {
            std::fs::write(format!("{folder}/b{i}.obj"), write_obj(&body.mesh)).expect("a folder");
            let triangles =
                body.control.faces.iter().flat_map(|f| (2..f.len()).map(|k| [f[0], f[k - 1], f[k]])).collect();
            let control = TriMesh { positions: body.control.positions.clone(), triangles };
            std::fs::write(format!("{folder}/c{i}.obj"), write_obj(&control)).expect("a folder");
            eprintln!("{:.3?}", body.landmarks);
        }
        for (name, asked, read, tolerance) in pairs {
            assert!((read - asked).abs() <= tolerance, "subject {i} {name}: asked {asked}, tape reads {read:.2} mm");
        }
    }
}

#[test]
fn skin_and_control_mesh_are_closed() {
    for (sex, numbers) in [SUBJECTS[1], SUBJECTS[10]] {
        let body = build(&subject(sex, numbers)).expect("a subject");
        assert!(body.mesh.is_closed_manifold());
        let triangles = body.control.faces.iter().flat_map(|f| (2..f.len()).map(|k| [f[0], f[k - 1], f[k]])).collect();
        let control = TriMesh { positions: body.control.positions.clone(), triangles };
        assert!(control.is_closed_manifold());
        assert!(control.volume() > 0.9 * body.mesh.volume(), "{} of {}", control.volume(), body.mesh.volume());
        assert_eq!(body.control.ring(Layer::WristLeft).len(), RING);
        let elbow = body.skeleton.at(Joint::ElbowRight);
        assert!(
            elbow.x > body.skeleton.at(Joint::ShoulderRight).x && elbow.z < body.skeleton.at(Joint::ShoulderRight).z
        );
    }
}

#[test]
fn the_same_measurements_give_the_same_body() {
    let asked = subject(SUBJECTS[0].0, SUBJECTS[0].1);
    assert_eq!(build(&asked).expect("a subject"), build(&asked).expect("a subject"));
}
