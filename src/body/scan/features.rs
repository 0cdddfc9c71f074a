//! Body from a scan: landmarks found on the skin alone, and the control mesh cut by sections of the scan.
//!
//! Left and right are found separately, the left side as the right side of the mirrored mesh.

use crate::measure::arm::Arm;
use crate::measure::sites::{self, Sites};
use crate::measure::{landmarks, lengths, neck_base};
use crate::model::control::{ControlMesh, Layer};
use crate::model::control_cut::{Cuts, control_mesh};
use crate::repair::feet::Feet;
use crate::shape::atlas::Atlas;
use crate::{Body, BodyError, Landmarks, Sex};
use geom::section::Plane;
use geom::{TriMesh, V3};

pub(super) fn describe(sex: Sex, mesh: TriMesh) -> Result<Body, BodyError> {
    let (sites, _) = sites::find_sites(&mesh, Some(sex), Feet::BOTH)?;
    let mut girths = sites::girths_at(&mesh, &sites)?;
    lengths::add_limbs(&mesh, &sites, sex, &mut girths);
    let right = Half::find(&mesh, &sites, sites.shoulder[0])?;
    let mirrored = landmarks::mirrored(&mesh, 0.0);
    let left = Half::find(&mirrored, &sites, mirror(sites.shoulder[1]))?;
    let landmarks = landmarks(&mesh, sex, &sites, &right, &left)?;
    let mut control = control_mesh(&mesh, &cuts(&mesh, sex, &sites, &landmarks, &right))?;
    let of_left = control_mesh(&mirrored, &cuts(&mirrored, sex, &sites, &landmarks, &left))?;
    take_left(&mut control, &of_left);
    control.snap(&landmarks);
    let levels = sites.levels();
    let skeleton = control.skeleton();
    Ok(Body { sex, mesh, skeleton, landmarks, levels, control, girths })
}

/// Landmarks of one side, found as the right side of a mesh.
struct Half {
    shoulder: V3,
    side_neck: V3,
    armpit: V3,
    arm: Arm,
}

impl Half {
    fn find(mesh: &TriMesh, sites: &Sites, shoulder: V3) -> Result<Self, BodyError> {
        let stature = sites.crown - sites.floor;
        let armpit = landmarks::armpit(mesh, sites.waist, shoulder.z, 0.0)
            .or_else(|| landmarks::armpit_of_spread(mesh, shoulder, stature))
            .ok_or_else(|| missing("armpit", sites.chest))?;
        let arm = Arm::trace(mesh, shoulder, armpit, stature).ok_or_else(|| missing("arm", armpit.z))?;
        let side_neck = neck_base::side_neck(mesh, sites, shoulder).ok_or_else(|| missing("neck base", shoulder.z))?;
        Ok(Self { shoulder, side_neck, armpit, arm })
    }
}

fn missing(part: &'static str, z: f64) -> BodyError {
    BodyError::MissingPart { part, height_m: z }
}

fn mirror(p: V3) -> V3 {
    V3::new(-p.x, p.y, p.z)
}

/// Replaces the left limbs by those of `of_left`, cut as right limbs from the mirrored body and mirrored back.
fn take_left(control: &mut ControlMesh, of_left: &ControlMesh) {
    use Layer::*;
    let layers = [
        FootLeft,
        AnkleLeft,
        CalfLeft,
        KneeLeft,
        MidThighLeft,
        ThighLeft,
        ArmscyeLeft,
        UpperArmLeft,
        ElbowLeft,
        ForearmLeft,
        WristLeft,
    ];
    let rings = layers.into_iter().flat_map(|layer| of_left.ring(layer));
    for vertex in rings.chain([ControlMesh::end(1), ControlMesh::end(4)]) {
        control.positions[vertex] = of_left.positions[vertex];
    }
}

fn landmarks(mesh: &TriMesh, sex: Sex, sites: &Sites, right: &Half, left: &Half) -> Result<Landmarks, BodyError> {
    let stature = sites.crown - sites.floor;
    let bust = |sign: f64| {
        landmarks::usual_bust_point(mesh, sites.chest, sign, [0.0, stature], sex)
            .ok_or_else(|| missing("bust", sites.chest))
    };
    Ok(Landmarks {
        side_neck: [right.side_neck, mirror(left.side_neck)],
        shoulder: [right.shoulder, mirror(left.shoulder)],
        back_neck: sites.back_neck,
        front_neck: neck_base::front_neck(mesh, sites).ok_or_else(|| missing("front neck", 0.82 * stature))?,
        armpit: [right.armpit, mirror(left.armpit)],
        bust: [bust(1.0)?, bust(-1.0)?],
        crotch: landmarks::crotch_point(mesh, sites.crotch).ok_or_else(|| missing("crotch", sites.crotch))?,
    })
}

/// Planes of the limbs are for the right side.
fn cuts(mesh: &TriMesh, sex: Sex, sites: &Sites, landmarks: &Landmarks, half: &Half) -> Cuts {
    let (atlas, h) = (Atlas::of(sex), sites.crown - sites.floor);
    let (shoulder, armpit, arm) = (half.shoulder, half.armpit, &half.arm);
    // The armscye passes through the shoulder point and just outside the armpit.
    let up = V3::new(shoulder.x - armpit.x - 0.012, 0.0, shoulder.z - armpit.z).normalize();
    let armscye = Plane {
        origin: V3::new(
            (shoulder.x + armpit.x) / 2.0 + 0.006,
            (shoulder.y + armpit.y) / 2.0,
            (shoulder.z + armpit.z) / 2.0,
        ),
        u: V3::y(),
        v: up,
    };
    let (elbow, wrist) = (arm.elbow(), arm.wrist());
    let base = (landmarks.back_neck - landmarks.front_neck).normalize();
    let armpits = landmarks.armpit[0].z.min(landmarks.armpit[1].z);
    Cuts {
        leg: [0.012 * h, 0.072 * h, atlas.calf * h, atlas.knee * h, 0.80 * sites.crotch, sites.crotch - 0.02],
        trunk: [
            sites.hip,
            (sites.hip + sites.waist) / 2.0,
            sites.waist,
            sites.underbust,
            sites.chest,
            (armpits - 0.008).max(sites.chest + 0.004),
        ],
        neck: [
            Plane { origin: (landmarks.front_neck + landmarks.back_neck) / 2.0, u: V3::x(), v: -base },
            Plane::normal_to(sites.neck.centre, sites.neck.along()),
        ],
        head: [h * (1.0 - 0.76 * atlas.head_height), h * (1.0 - 0.35 * atlas.head_height)],
        arm: [
            armscye,
            arm.across(0.58 * elbow),
            arm.across(elbow),
            arm.across(elbow + 0.2 * (wrist - elbow)),
            arm.across(wrist),
        ],
        crown: mesh.positions.iter().copied().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap_or_else(V3::zeros),
        hand: arm.tip,
    }
}
