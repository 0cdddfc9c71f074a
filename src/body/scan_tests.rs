use super::*;
use crate::body::{Measurements, build, write_obj};
use crate::geom::{TriMesh, V3};

fn ordinary() -> TriMesh {
    let asked = Measurements { weight_kg: Some(64.0), ..Measurements::of(Sex::Female, 1.66) };
    build(&asked).expect("an ordinary woman").mesh
}

/// Noise, a floor, strays and holes in crown and soles, as booth scanners leave them.
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
    let truth = measure::measure(&clean, Some(Sex::Female)).expect("a standing body");
    let check = |place: &dyn Fn(V3) -> V3| {
        let mut mesh = clean.clone();
        spoil(&mut mesh);
        mesh.positions.iter_mut().for_each(|p| *p = place(*p));
        let scan = from_scan(write_obj(&mesh).as_bytes(), None, Some(Sex::Female)).expect("a scan of a body");
        let found = &scan.girths;
        let pairs = [
            ("stature", truth.stature_mm, found.stature_mm, 6.0),
            ("neck", truth.neck_girth_mm, found.neck_girth_mm, 4.0),
            ("chest", truth.chest_girth_mm, found.chest_girth_mm, 9.0),
            ("waist", truth.waist_girth_mm, found.waist_girth_mm, 5.0),
            ("hip", truth.hip_girth_mm, found.hip_girth_mm, 9.0),
            ("inseam", truth.inseam_mm, found.inseam_mm, 8.0),
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
