//! Mannequin from measurements: figure, skin, fit of the girths, landmarks and control mesh.

use super::control_cut::{Cuts, control_mesh};
use super::fit::{self, Fit};
use crate::measure::landmarks::{self, Side};
use crate::measure::sites::Sites;
use crate::measure::tape;
use crate::people::figures::TRAITS;
use crate::people::profile::Profile;
use crate::shape::figure::Figure;
use crate::shape::limbs::UPPER_ARM;
use crate::{Body, BodyError, Landmarks, Measurements};
use geom::section::Plane;
use geom::units::mm;
use geom::{TriMesh, V3};

/// Builds a closed, measured mannequin.
///
/// Missing measurements are estimated from the ANSUR II survey [Gordon 2014]. The figure is fitted until the tape reads
/// every given measurement on the fine mesh. All bodies of a sex have the same mesh topology.
///
/// # Examples
/// ```
/// use body::{Measurements, Sex};
///
/// let body = body::build(&Measurements::of(Sex::Female, 1.65))?;
/// assert!(body.levels.hip_m < body.levels.waist_m && body.levels.waist_m < body.levels.chest_m);
/// # Ok::<(), body::BodyError>(())
/// ```
pub fn build(known: &Measurements) -> Result<Body, BodyError> {
    let profile = Profile::new(known)?;
    fit::fit(&profile, [0.0; TRAITS]).and_then(describe).map_err(unformed)
}

/// Error of a body that cannot be formed, in place of that of a mesh without a part.
pub(super) fn unformed(error: BodyError) -> BodyError {
    match error {
        BodyError::MissingPart { part, height_m } => {
            BodyError::Inconsistent { reason: format!("no {part} can be formed at a height of {:.0} mm", mm(height_m)) }
        }
        other => other,
    }
}

pub(super) fn describe(fit: Fit<'_>) -> Result<Body, BodyError> {
    let Fit { figure, mesh, sites, girths } = fit;
    let landmarks = find_landmarks(&mesh, &figure, &sites)?;
    let mut control = control_mesh(&mesh, &cuts(&mesh, &figure, &sites, &landmarks))?;
    control.snap(&landmarks);
    let levels = sites.levels();
    let skeleton = control.skeleton();
    Ok(Body { sex: figure.profile.sex, mesh, skeleton, landmarks, levels, control, girths })
}

fn find_landmarks(mesh: &TriMesh, figure: &Figure, sites: &Sites) -> Result<Landmarks, BodyError> {
    let h = figure.stature();
    let missing = |part: &'static str, z: f64| BodyError::MissingPart { part, height_m: z };
    let front_height = figure.front_neck_height();
    let side_height = figure.side_neck_height();
    let base = tape::trunk_outline(mesh, side_height, 0.0).ok_or_else(|| missing("neck base", side_height))?;
    let side = |sign: f64| base.points.iter().max_by(|a, b| (sign * a.x).total_cmp(&(sign * b.x)));
    let side_neck = [1.0, -1.0].map(|sign| side(sign).map_or_else(V3::zeros, |p| V3::new(p.x, p.y, side_height)));
    let armpit =
        landmarks::armpit(mesh, sites.waist, sites.shoulder[0].z, 0.0).ok_or_else(|| missing("armpit", sites.chest))?;
    let bust =
        |sign: f64| landmarks::bust_point(mesh, sites.chest, sign, h).ok_or_else(|| missing("bust", sites.chest));
    Ok(Landmarks {
        side_neck,
        shoulder: sites.shoulder,
        back_neck: sites.back_neck,
        front_neck: landmarks::median_point(mesh, front_height, 0.0, Side::Front)
            .ok_or_else(|| missing("front neck", front_height))?,
        armpit: [armpit, V3::new(-armpit.x, armpit.y, armpit.z)],
        bust: [bust(1.0)?, bust(-1.0)?],
        crotch: landmarks::crotch_point(mesh, sites.crotch).ok_or_else(|| missing("crotch", sites.crotch))?,
    })
}

fn cuts(mesh: &TriMesh, figure: &Figure, sites: &Sites, landmarks: &Landmarks) -> Cuts {
    let (atlas, h) = (figure.atlas, figure.stature());
    let [elbow, wrist, tip] = figure.arm_lengths();
    let [outward, forward, along] = figure.arm_axes();
    let joint = figure.shoulder_joint();
    let [knee, calf] = figure.knee_and_calf();
    let across_arm = |t: f64| Plane { origin: joint + along * t, u: forward, v: outward };
    let (shoulder, armpit) = (landmarks.shoulder[0], landmarks.armpit[0]);
    // The armscye passes through the shoulder point and just outside the armpit.
    let up = V3::new(shoulder.x - armpit.x - 0.012, 0.0, shoulder.z - armpit.z).normalize();
    let armscye = Plane {
        origin: V3::new((shoulder.x + armpit.x) / 2.0 + 0.006, joint.y, (shoulder.z + armpit.z) / 2.0),
        u: V3::y(),
        v: up,
    };
    let (front, back) = (landmarks.front_neck, landmarks.back_neck);
    let base = (back - front).normalize();
    let middle_of = |z: f64| {
        tape::trunk_outline(mesh, z, 0.0).map_or(0.0, |outline| {
            let (front, back) = tape::depth_range(&outline);
            (front + back) / 2.0
        })
    };
    Cuts {
        leg: [0.012 * h, 0.072 * h, calf, knee, 0.80 * sites.crotch, sites.crotch - 0.02],
        trunk: [
            sites.hip,
            (sites.hip + sites.waist) / 2.0,
            sites.waist,
            sites.underbust,
            sites.chest,
            armpit.z - 0.008,
        ],
        neck: [
            Plane { origin: (front + back) / 2.0, u: V3::x(), v: -base },
            Plane::normal_to(V3::new(0.0, middle_of(sites.neck.height), sites.neck.height), sites.neck.along()),
        ],
        head: [h * (1.0 - 0.76 * atlas.head_height), h * (1.0 - 0.35 * atlas.head_height)],
        arm: [
            armscye,
            across_arm(UPPER_ARM * elbow),
            across_arm(elbow),
            across_arm(elbow + 0.2 * (wrist - elbow)),
            across_arm(wrist),
        ],
        crown: highest(mesh),
        hand: farthest_along(mesh, joint, along, tip),
    }
}

fn highest(mesh: &TriMesh) -> V3 {
    mesh.positions.iter().copied().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap_or_else(V3::zeros)
}

fn farthest_along(mesh: &TriMesh, joint: V3, along: V3, tip: f64) -> V3 {
    let near_axis = |p: &&V3| {
        let t = (*p - joint).dot(&along);
        t > 0.8 * tip && (*p - joint - along * t).norm() < 0.06
    };
    let reach = |p: &V3| (p - joint).dot(&along);
    mesh.positions
        .iter()
        .filter(near_axis)
        .copied()
        .max_by(|a, b| reach(a).total_cmp(&reach(b)))
        .unwrap_or(joint + along * tip)
}

#[cfg(test)]
#[path = "build_tests.rs"]
mod tests;
