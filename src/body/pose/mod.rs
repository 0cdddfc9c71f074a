//! Other poses of a body, by turning limbs about their joints: arms raised or lowered and legs spread in the frontal
//! plane, arms swung forward and legs in a step in the sagittal plane.
//!
//! Every vertex turns about the joint by a share of the angle of the limb. For one joint that is dual quaternion
//! skinning [Kavan 2008]: no point comes nearer to the axis, so the skin does not collapse as in linear blending. The
//! shares rise smoothly from the trunk into the limb, and are zero at the girth levels of the trunk.

use std::fmt;
use std::str::FromStr;

use crate::{Body, BodyError, Joint, Landmarks};
use geom::section::{Outline, Plane, section};
use geom::{TriMesh, V3, hull};

/// Angles of the limbs, degrees. `None` leaves a limb as it is. Written `arms_45`, `legs_10`, `arms_15+forward_40` or
/// `step_15`.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Pose {
    /// Angle of both arms from the vertical in the frontal plane, shoulder to elbow.
    pub arm_deg: Option<f64>,
    /// Angle of both legs from the vertical in the frontal plane, hip to knee.
    pub leg_deg: Option<f64>,
    /// Angle by which both arms swing forward from `arm_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub forward_deg: Option<f64>,
    /// Angle by which the right leg swings forward and the left one back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_deg: Option<f64>,
}

impl fmt::Display for Pose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let limbs =
            [("arms", self.arm_deg), ("legs", self.leg_deg), ("forward", self.forward_deg), ("step", self.step_deg)];
        let named = limbs.iter().filter_map(|(limb, degrees)| Some(format!("{limb}_{}", (*degrees)?)));
        f.write_str(&named.collect::<Vec<_>>().join("+"))
    }
}

impl FromStr for Pose {
    type Err = BodyError;

    fn from_str(text: &str) -> Result<Self, BodyError> {
        let mut pose = Self::default();
        for part in text.split('+') {
            let (limb, accepted) = match part.split_once('_') {
                Some(("arms", _)) => (&mut pose.arm_deg, ARM_DEG),
                Some(("legs", _)) => (&mut pose.leg_deg, LEG_DEG),
                Some(("forward", _)) => (&mut pose.forward_deg, FORWARD_DEG),
                Some(("step", _)) => (&mut pose.step_deg, STEP_DEG),
                _ => (&mut None, [0.0; 2]),
            };
            let degrees = part.split_once('_').and_then(|(_, degrees)| degrees.parse::<f64>().ok());
            *limb = degrees.filter(|degrees| (accepted[0]..=accepted[1]).contains(degrees) && accepted[1] > 0.0);
            if limb.is_none() {
                let ranges = [("arms", ARM_DEG), ("legs", LEG_DEG), ("forward", FORWARD_DEG), ("step", STEP_DEG)];
                let ranges = ranges.map(|(limb, [least, most])| format!("{limb}_{least} to {limb}_{most}"));
                let problem = format!("pose `{text}`; accepted: {}, or several: arms_45+legs_10", ranges.join(", "));
                return Err(BodyError::Pose { problem });
            }
        }
        Ok(pose)
    }
}

impl Pose {
    /// Limbs that `to` does not name stay as they are.
    pub fn then(self, to: Self) -> Self {
        Self {
            arm_deg: to.arm_deg.or(self.arm_deg),
            leg_deg: to.leg_deg.or(self.leg_deg),
            forward_deg: to.forward_deg.or(self.forward_deg),
            step_deg: to.step_deg.or(self.step_deg),
        }
    }
}

/// Coordinate axes of the planes in which limbs turn.
const FRONTAL: [usize; 2] = [0, 2];
const SAGITTAL: [usize; 2] = [1, 2];

/// Accepted angles of arms and legs. Judgement.
const ARM_DEG: [f64; 2] = [5.0, 90.0];
const LEG_DEG: [f64; 2] = [0.0, 30.0];
const FORWARD_DEG: [f64; 2] = [0.0, 60.0];
const STEP_DEG: [f64; 2] = [0.0, 25.0];

/// Distances from the armscye / stature over which the arm's rotation fades into the shoulder and is whole. Judgement.
const ARM_REACH: [f64; 2] = [0.030, 0.085];

/// Rotation of the leg, as shares of stature: depth below the hip level at which it begins, depth below the crotch at
/// which it is complete, distance from the lowest point of the crotch over which it fades. Judgement.
const LEG_BEGINS: f64 = 0.006;
const LEG_COMPLETE: f64 = 0.10;
const BETWEEN_LEGS: f64 = 0.075;

/// Least distance beyond the armscye of skin of the arm, m. Nearer skin may be the trunk's below the armpit.
const APART: f64 = 0.008;

/// Distance past [`APART`] over which the skin of the arm below the armpit begins to move with the arm, m. Judgement.
const PARTING: f64 = 0.03;

/// Clearance between the girth levels of the trunk and the skin that moves, m, so that the girths stay.
const KEPT: f64 = 0.004;

/// Moves fine mesh, control mesh, joints and landmarks alike, and sets the feet on the floor.
pub fn pose(body: &Body, pose: Pose) -> Result<Body, BodyError> {
    let mut posed = body.clone();
    for side in [1.0, -1.0] {
        if let Some(asked) = pose.arm_deg {
            let turn = turn("arms", asked, ARM_DEG, arm_angle(body, side))?;
            let arm = Arm::new(body, side);
            apply(body, &mut posed, arm.joint, Turn { plane: FRONTAL, angle: -side * turn }, |mesh| arm.shares(mesh));
        }
        if let Some(asked) = pose.leg_deg {
            let turn = turn("legs", asked, LEG_DEG, leg_angle(body, side))?;
            let leg = Leg::new(body, side);
            apply(body, &mut posed, leg.joint, Turn { plane: FRONTAL, angle: -side * turn }, |mesh| leg.shares(mesh));
        }
    }
    posed.skeleton = posed.control.skeleton();
    let upright = posed.clone();
    for side in [1.0, -1.0] {
        if let Some(asked) = pose.forward_deg {
            let turn = turn("forward", asked, FORWARD_DEG, 0.0)?;
            let arm = Arm::new(&upright, side);
            apply(&upright, &mut posed, arm.joint, Turn { plane: SAGITTAL, angle: -turn }, |mesh| arm.shares(mesh));
        }
        if let Some(asked) = pose.step_deg {
            let turn = turn("step", asked, STEP_DEG, 0.0)?;
            let leg = Leg::new(&upright, side);
            apply(&upright, &mut posed, leg.joint, Turn { plane: SAGITTAL, angle: -side * turn }, |mesh| {
                leg.shares(mesh)
            });
        }
    }
    check(&posed)?;
    stand(&mut posed);
    posed.skeleton = posed.control.skeleton();
    Ok(posed)
}

/// Bodies on the way from one pose to another, the first pose included, with limbs that turn by at most `step_deg` at a
/// time. Limbs that only `from` names stay as in `from`, limbs that neither names stay as they are.
pub fn way(body: &Body, from: Pose, to: Pose, step_deg: f64) -> Result<Vec<Body>, BodyError> {
    let mean = |angle: fn(&Body, f64) -> f64| f64::midpoint(angle(body, 1.0), angle(body, -1.0)).to_degrees();
    let limbs = |pose: &Pose| [pose.arm_deg, pose.leg_deg, pose.forward_deg, pose.step_deg];
    let as_it_is = [mean(arm_angle), mean(leg_angle), 0.0, 0.0];
    let turns: Vec<Option<[f64; 2]>> = limbs(&from)
        .into_iter()
        .zip(limbs(&from.then(to)))
        .zip(as_it_is)
        .map(|((from, to), is)| Some([from.unwrap_or(is), to?]))
        .collect();
    let greatest = turns.iter().flatten().map(|[from, to]| (to - from).abs()).fold(0.0, f64::max);
    let steps = (greatest / step_deg).ceil().max(1.0) as u32;
    let pose_at = |step: u32| {
        let share = f64::from(step) / f64::from(steps);
        let angle = |limb: usize| turns[limb].map(|[from, to]| from + (to - from) * share);
        Pose { arm_deg: angle(0), leg_deg: angle(1), forward_deg: angle(2), step_deg: angle(3) }
    };
    let first = pose(body, from);
    std::iter::once(first).chain((1..=steps).map(|step| pose(body, pose_at(step)))).collect()
}

/// Difference between the requested and the present angle of a limb, radians.
fn turn(limb: &'static str, asked: f64, [least, greatest]: [f64; 2], has: f64) -> Result<f64, BodyError> {
    if (least..=greatest).contains(&asked) {
        return Ok(asked.to_radians() - has);
    }
    let problem = format!("{limb} at {asked} degrees; accepted: {least} to {greatest}");
    Err(BodyError::Pose { problem })
}

/// Angle of a bone from the vertical in the frontal plane, radians, positive outwards.
fn angle(from: V3, to: V3, side: f64) -> f64 {
    (side * (to.x - from.x)).atan2(from.z - to.z)
}

fn joints(side: f64, right: [Joint; 2], left: [Joint; 2]) -> [Joint; 2] {
    if side > 0.0 { right } else { left }
}

fn arm_angle(body: &Body, side: f64) -> f64 {
    let joints = joints(side, [Joint::ShoulderRight, Joint::ElbowRight], [Joint::ShoulderLeft, Joint::ElbowLeft]);
    let [shoulder, elbow] = joints.map(|joint| body.skeleton.at(joint));
    angle(shoulder, elbow, side)
}

fn leg_angle(body: &Body, side: f64) -> f64 {
    let joints = joints(side, [Joint::HipRight, Joint::KneeRight], [Joint::HipLeft, Joint::KneeLeft]);
    let [hip, knee] = joints.map(|joint| body.skeleton.at(joint));
    angle(hip, knee, side)
}

/// Quintic smooth step from 0 to 1, with zero first and second derivatives at both ends.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

struct Arm {
    joint: V3,
    /// Unit normal of the armscye, outwards. The plane of the armscye passes through the joint.
    outward: V3,
    hand: V3,
    reach: [f64; 2],
    /// Heights between which the skin beside the arm begins to move.
    skin: [f64; 2],
}

impl Arm {
    fn new(body: &Body, side: f64) -> Self {
        let i = usize::from(side < 0.0);
        let (shoulder, armpit) = (body.landmarks.shoulder[i], body.landmarks.armpit[i]);
        let [joint, wrist] =
            joints(side, [Joint::ShoulderRight, Joint::WristRight], [Joint::ShoulderLeft, Joint::WristLeft])
                .map(|joint| body.skeleton.at(joint));
        let stature = crown(body);
        let up = V3::new(shoulder.x - armpit.x, 0.0, shoulder.z - armpit.z).normalize();
        Self {
            joint,
            outward: V3::new(up.z, 0.0, -up.x) * side,
            hand: wrist,
            reach: ARM_REACH.map(|share| share * stature),
            skin: [body.levels.chest_m + KEPT, armpit.z - KEPT],
        }
    }

    /// Signed distance beyond the armscye, metres.
    fn beyond(&self, p: &V3) -> f64 {
        (p - self.joint).dot(&self.outward)
    }

    /// Share of the rotation for every vertex.
    fn shares(&self, mesh: &TriMesh) -> Vec<f64> {
        let own = self.own(mesh);
        let [inside, outside] = self.reach;
        let share = |(p, own): (&V3, bool)| {
            let across = smooth((self.beyond(p) + inside) / (inside + outside));
            let [from, to] = self.skin;
            let beside = smooth((p.z - from) / (to - from).max(KEPT));
            let within = if own { smooth((self.beyond(p) - APART) / PARTING) } else { 0.0 };
            across * beside.max(within)
        };
        mesh.positions.iter().zip(own).map(share).collect()
    }

    /// True for the vertices that are connected to the hand by others beyond the armscye.
    fn own(&self, mesh: &TriMesh) -> Vec<bool> {
        let mut around = vec![Vec::new(); mesh.positions.len()];
        for [a, b] in mesh.edges() {
            around[a].push(b);
            around[b].push(a);
        }
        let off = |i: &usize| (mesh.positions[*i] - self.hand).norm_squared();
        let mut own = vec![false; mesh.positions.len()];
        let Some(first) = (0..own.len()).min_by(|a, b| off(a).total_cmp(&off(b))) else { return own };
        let mut open = vec![first];
        own[first] = true;
        while let Some(vertex) = open.pop() {
            for &next in &around[vertex] {
                if !own[next] && self.beyond(&mesh.positions[next]) > APART {
                    own[next] = true;
                    open.push(next);
                }
            }
        }
        own
    }
}

struct Leg {
    side: f64,
    joint: V3,
    /// Heights at which the rotation is complete and at which it begins.
    heights: [f64; 2],
    crotch: f64,
    between: f64,
}

impl Leg {
    fn new(body: &Body, side: f64) -> Self {
        let stature = crown(body);
        let joint = if side > 0.0 { Joint::HipRight } else { Joint::HipLeft };
        let crotch = body.levels.crotch_m;
        Self {
            side,
            joint: body.skeleton.at(joint),
            heights: [crotch - LEG_COMPLETE * stature, body.levels.hip_m - LEG_BEGINS * stature - KEPT],
            crotch,
            between: BETWEEN_LEGS * stature,
        }
    }

    fn shares(&self, mesh: &TriMesh) -> Vec<f64> {
        mesh.positions.iter().map(|p| self.share(p)).collect()
    }

    fn share(&self, p: &V3) -> f64 {
        let [low, high] = self.heights;
        // Hands that hang beside the thighs would move, too, because they are farther out than any thigh.
        let out = self.side * p.x;
        if out <= 0.0 || p.z >= high {
            return 0.0;
        }
        let below = (self.crotch - p.z).max(0.0);
        smooth((high - p.z) / (high - low)) * smooth(out.hypot(below) / self.between)
    }
}

fn crown(body: &Body) -> f64 {
    body.mesh.bounds().map_or(0.0, |(_, high)| high.z)
}

/// Rotation in the plane of two coordinate axes by an angle, radians, that takes the second axis towards the first.
#[derive(Clone, Copy)]
struct Turn {
    plane: [usize; 2],
    angle: f64,
}

fn apply(
    from: &Body,
    posed: &mut Body,
    joint: V3,
    Turn { plane: [across, up], angle }: Turn,
    shares: impl Fn(&TriMesh) -> Vec<f64>,
) {
    let shares = shares(&from.mesh);
    let turned = |mut p: V3, share: f64| {
        let (sin, cos) = (angle * share).sin_cos();
        let r = p - joint;
        p[across] = joint[across] + r[across] * cos + r[up] * sin;
        p[up] = joint[up] - r[across] * sin + r[up] * cos;
        p
    };
    let volume = posed.mesh.volume();
    for (p, &share) in posed.mesh.positions.iter_mut().zip(&shares).filter(|(_, share)| **share > 0.0) {
        *p = turned(*p, share);
    }
    keep_volume(&mut posed.mesh, volume, &shares);
    let nearest = |p: &V3| {
        let off = |q: &V3| (q - p).norm_squared();
        let found = from.mesh.positions.iter().zip(&shares).min_by(|a, b| off(a.0).total_cmp(&off(b.0)));
        found.map_or(0.0, |(_, share)| *share)
    };
    for (p, before) in posed.control.positions.iter_mut().zip(&from.control.positions) {
        *p = turned(*p, nearest(before));
    }
    for (p, before) in points(&mut posed.landmarks).into_iter().zip(points(&mut from.landmarks.clone())) {
        *p = turned(*p, nearest(before));
    }
}

/// Restores the volume from before the rotation, by moving partly rotated skin along its normals.
fn keep_volume(mesh: &mut TriMesh, volume: f64, shares: &[f64]) {
    let bent: Vec<f64> = shares.iter().map(|share| 4.0 * share * (1.0 - share)).collect();
    let areas = mesh.triangle_normals();
    let areas = mesh.triangles.iter().zip(&areas);
    let area: f64 = areas.map(|(t, n)| n.norm() / 6.0 * t.iter().map(|&v| bent[v]).sum::<f64>()).sum();
    if area <= 0.0 {
        return;
    }
    let off = (volume - mesh.volume()) / area;
    let normals = mesh.vertex_normals();
    for ((p, normal), bent) in mesh.positions.iter_mut().zip(normals).zip(bent).filter(|(_, bent)| *bent > 0.0) {
        *p += normal * (off * bent);
    }
}

fn points(landmarks: &mut Landmarks) -> Vec<&mut V3> {
    let Landmarks { side_neck, shoulder, back_neck, front_neck, armpit, bust, crotch } = landmarks;
    let pairs = side_neck.iter_mut().chain(shoulder).chain(armpit).chain(bust);
    pairs.chain([back_neck, front_neck, crotch]).collect()
}

/// Refuses limbs that touch the trunk or each other in horizontal sections.
fn check(body: &Body) -> Result<(), BodyError> {
    let levels = &body.levels;
    let refuse = |what: &str| Err(BodyError::Pose { problem: format!("{what} would touch; accepted: limbs apart") });
    let outlines = |z: f64| section(&body.mesh, &Plane::horizontal(z));
    let large = |outline: &Outline| hull::perimeter(&outline.points) > 0.1;
    for share in [0.15, 0.3, 0.45, 0.6, 0.75] {
        let z = levels.crotch_m * share;
        let crosses = |outline: &Outline| outline.bounds().0.x < 0.0 && outline.bounds().1.x > 0.0;
        if outlines(z).iter().any(|outline| large(outline) && crosses(outline)) {
            return refuse("the legs");
        }
    }
    for level in [levels.hip_m, levels.waist_m, (levels.waist_m + levels.chest_m) / 2.0] {
        let all: Vec<Outline> = outlines(level).into_iter().filter(large).collect();
        let Some(trunk) = all.iter().max_by(|a, b| hull::perimeter(&a.points).total_cmp(&hull::perimeter(&b.points)))
        else {
            continue;
        };
        let (low, high) = trunk.bounds();
        let meets = |outline: &Outline| {
            let (a, b) = outline.bounds();
            a.x < high.x && b.x > low.x && a.y < high.y && b.y > low.y
        };
        if all.iter().filter(|outline| meets(outline)).count() > 1 {
            return refuse("arms and trunk");
        }
    }
    Ok(())
}

fn stand(body: &mut Body) {
    let Some((low, _)) = body.mesh.bounds() else { return };
    let down = low.z;
    let mut lower = |p: &mut V3| p.z -= down;
    body.mesh.positions.iter_mut().for_each(&mut lower);
    body.control.positions.iter_mut().for_each(&mut lower);
    points(&mut body.landmarks).into_iter().for_each(&mut lower);
    let levels = &mut body.levels;
    for level in [
        &mut levels.chest_m,
        &mut levels.underbust_m,
        &mut levels.waist_m,
        &mut levels.hip_m,
        &mut levels.crotch_m,
        &mut levels.neck_m,
    ] {
        *level -= down;
    }
    body.girths.lower(down);
}

#[cfg(test)]
mod tests;
