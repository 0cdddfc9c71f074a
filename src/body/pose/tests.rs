use super::*;
use crate::Dimension;
use crate::measure::tape;
use crate::{Measurements, Sex, build};

fn bodies() -> Vec<Body> {
    let asked = |sex, stature_m, weight_kg| Measurements::of(sex, stature_m).with(Dimension::Weight, weight_kg);
    let all = [asked(Sex::Male, 1.78, 75.0), asked(Sex::Female, 1.62, 82.0)];
    all.iter().map(|known| build(known).expect("an ordinary body")).collect()
}

fn flipped(mesh: &TriMesh) -> usize {
    let normals = mesh.vertex_normals();
    let against =
        |(triangle, normal): (&[usize; 3], &V3)| triangle.iter().map(|&v| normals[v]).sum::<V3>().dot(normal) <= 0.0;
    mesh.triangles.iter().zip(&mesh.triangle_normals()).filter(|(t, n)| against((t, n))).count()
}

#[test]
fn limbs_turn_without_collapse_creases_or_a_changed_trunk() {
    for body in bodies() {
        let before = flipped(&body.mesh);
        let check = |asked: Pose| {
            let posed = pose(&body, asked).expect("a pose of an ordinary body");
            let volume = posed.mesh.volume() / body.mesh.volume();
            assert!((volume - 1.0).abs() < 0.02, "{asked:?}: volume {volume}");
            // An arm raised beyond what clothes need folds the armpit a little.
            let folded = if asked.arm_deg.is_some_and(|degrees| degrees > 60.0) { 4 } else { 0 };
            assert!(flipped(&posed.mesh) <= before + folded, "{asked:?}: {} flipped", flipped(&posed.mesh));
            let pairs = [
                (body.levels.chest_m, posed.levels.chest_m),
                (body.levels.underbust_m, posed.levels.underbust_m),
                (body.levels.waist_m, posed.levels.waist_m),
                (body.levels.hip_m, posed.levels.hip_m),
            ];
            for (was, is) in pairs {
                let girth = |mesh: &TriMesh, z| tape::trunk_girth(mesh, z, 0.0).expect("a trunk");
                let change = girth(&posed.mesh, is) - girth(&body.mesh, was);
                assert!(change.abs() < 1e-3, "{asked:?}: girth at {was:.3} changed by {change}");
            }
            assert!(posed.mesh.bounds().expect("vertices").0.z.abs() < 1e-9);
            let turned = |[from, to]: [Joint; 2]| {
                let along = |body: &Body| body.skeleton.at(to) - body.skeleton.at(from);
                let angle = |way: V3| way.y.atan2(-way.z).to_degrees();
                angle(along(&posed)) - angle(along(&body))
            };
            let is_frontal = asked.forward_deg.is_none();
            let sagittal = [
                (turned([Joint::ShoulderLeft, Joint::ElbowLeft]), asked.forward_deg.unwrap_or(0.0)),
                (turned([Joint::HipRight, Joint::KneeRight]), asked.step_deg.unwrap_or(0.0)),
                (turned([Joint::HipLeft, Joint::KneeLeft]), -asked.step_deg.unwrap_or(0.0)),
            ];
            for (found, asked_deg) in sagittal {
                assert!((found - asked_deg).abs() < 5.0, "{asked:?}: {found:.1} for {asked_deg} forward");
            }
            for (angle, asked) in [(arm_angle(&posed, 1.0), asked.arm_deg), (leg_angle(&posed, -1.0), asked.leg_deg)] {
                // An arm that has swung forward is nearer to the horizontal.
                if let Some(asked) = asked.filter(|_| is_frontal) {
                    assert!((angle.to_degrees() - asked).abs() < 4.0, "{:.1} for {asked}", angle.to_degrees());
                }
            }
        };
        check(Pose { arm_deg: Some(25.0), ..Pose::default() });
        check(Pose { arm_deg: Some(60.0), leg_deg: Some(12.0), ..Pose::default() });
        check(Pose { arm_deg: Some(85.0), leg_deg: Some(18.0), ..Pose::default() });
        check(Pose { arm_deg: Some(25.0), forward_deg: Some(40.0), ..Pose::default() });
        check(Pose { step_deg: Some(15.0), ..Pose::default() });
    }
}

#[test]
fn impossible_poses_are_refused() {
    let body = bodies().swap_remove(1);
    let check = |asked: Pose, needle: &str| {
        let error = pose(&body, asked).expect_err("no such pose").to_string();
        assert!(error.contains(needle), "{error}");
    };
    check(Pose { arm_deg: Some(120.0), ..Pose::default() }, "5 to 90");
    check(Pose { leg_deg: Some(f64::NAN), ..Pose::default() }, "0 to 30");
    check(Pose { forward_deg: Some(90.0), ..Pose::default() }, "0 to 60");
    check(Pose { step_deg: Some(-5.0), ..Pose::default() }, "0 to 25");
    check(Pose { arm_deg: Some(5.0), ..Pose::default() }, "arms and trunk would touch");
}

#[test]
fn a_body_goes_from_one_pose_to_another_by_small_turns_of_one_mesh() {
    let body = bodies().swap_remove(0);
    let check = |from: &str, to: &str, turns: usize| {
        let [from, to] =
            [from, to].map(|name| if name.is_empty() { Pose::default() } else { name.parse().expect("a pose") });
        let all = way(&body, from, to, 5.0).expect("it can stand so");
        assert_eq!(all.len(), turns + 1);
        assert!(all[0] == pose(&body, from).expect("a pose"));
        let last = pose(&body, from.then(to)).expect("a pose");
        let off = all[turns].mesh.positions.iter().zip(&last.mesh.positions).map(|(a, b)| (a - b).norm());
        assert!(off.fold(0.0, f64::max) < 1e-9);
        for pair in all.windows(2) {
            assert_eq!(pair[0].mesh.triangles, pair[1].mesh.triangles);
            let moved = pair[0].mesh.positions.iter().zip(&pair[1].mesh.positions).map(|(a, b)| (a - b).norm());
            // Five degrees of an arm of 0.8 m.
            assert!(moved.fold(0.0, f64::max) < 0.08);
        }
    };
    check("arms_25", "arms_60", 7);
    check("arms_25+legs_8", "forward_12", 3);
    check("", "step_15", 3);
    check("arms_40", "arms_40", 1);
}
