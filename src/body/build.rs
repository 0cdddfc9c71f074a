//! From measurements to a mannequin: figure, skin, the fit of its girths, and what is known of it.

use super::anthropometry::Profile;
use super::control_cut::{Cuts, control_mesh};
use super::figure::Figure;
use super::landmarks::{self, Side};
use super::measure::{self, Girths, Sites};
use super::surface::Skin;
use super::tape;
use super::{Body, BodyError, Landmarks, Levels, Measurements, Sex};
use crate::geom::contour::Grid;
use crate::geom::section::Plane;
use crate::geom::{TriMesh, V3};
use crate::units::from_mm;

/// Grid spacing of the skin, as a share of stature: of the body, and of arms (sideways) and feet (in height).
const SPACING: f64 = 0.0095;
const FINE_SPACING: f64 = 0.0070;

/// Height of the ankles over stature.
const ANKLE: f64 = 0.045;

/// Most rounds of the fit, and the error at which it stops, metres.
const ROUNDS: usize = 8;
const FITTED: f64 = 3e-4;

/// Greatest accepted difference of a girth and of the across-shoulder length from what was asked, metres.
const GIRTH_TOLERANCE: f64 = 2e-3;
const SHOULDER_TOLERANCE: f64 = 5e-3;

/// Builds a closed, measured mannequin.
///
/// Missing measurements are estimated from the ANSUR II survey [Gordon 2014]. Neck, chest, waist and hip girth and the
/// across-shoulder length are fitted until the tape reads them on the fine mesh.
///
/// # Errors
/// [`BodyError::OutOfRange`] for measurements that no adult has, [`BodyError::Inconsistent`] for those that are not of one
/// body.
pub fn build(known: &Measurements) -> Result<Body, BodyError> {
    let profile = Profile::new(known)?;
    fit(known.sex, &profile).map_err(|error| match error {
        BodyError::MissingPart { part, height_mm } => {
            BodyError::Inconsistent { reason: format!("no {part} can be formed at a height of {height_mm:.0} mm") }
        }
        other => other,
    })
}

/// Makes the skin of a profile and fits it to the tape.
fn fit(sex: Sex, profile: &Profile) -> Result<Body, BodyError> {
    let mut figure = Figure::new(profile);
    let mut skin = Skin::new(&figure.parts(), &grid(&figure));
    let mut mesh = skin.triangles(profile.stature);
    for _ in 0..ROUNDS {
        let errors = errors(profile, &measure::girths_at(&mesh, &sites(&mesh, &figure)?)?);
        if errors.iter().all(|error| error.off().abs() < FITTED) {
            break;
        }
        figure.adjust(errors.map(|error| error.asked / error.read));
        skin.follow(&figure.parts());
        mesh = skin.triangles(profile.stature);
    }
    if !mesh.is_closed_manifold() {
        return Err(BodyError::Inconsistent { reason: "the skin does not close".to_owned() });
    }
    let body = describe(sex, mesh, &figure)?;
    let unmet = errors(profile, &body.girths).into_iter().find(|error| error.off().abs() > error.tolerance);
    unmet.map_or(Ok(body), |error| Err(error.refusal()))
}

/// A fitted measurement: asked for, and read by the tape; metres.
struct Fitted {
    name: &'static str,
    asked: f64,
    read: f64,
    tolerance: f64,
}

impl Fitted {
    fn off(&self) -> f64 {
        self.read - self.asked
    }

    fn refusal(&self) -> BodyError {
        let Self { name, asked, read, .. } = self;
        BodyError::Inconsistent { reason: format!("{name} of {asked:.3} m was asked, {read:.3} m is reached") }
    }
}

/// Neck, chest, waist and hip girth and the across-shoulder length, asked and read.
fn errors(asked: &Profile, read: &Girths) -> [Fitted; 5] {
    let fitted = |name, asked, read_mm, tolerance| Fitted { name, asked, read: from_mm(read_mm), tolerance };
    [
        fitted("neck girth", asked.neck, read.neck_girth_mm, GIRTH_TOLERANCE),
        fitted("chest girth", asked.chest, read.chest_girth_mm, GIRTH_TOLERANCE),
        fitted("waist girth", asked.waist, read.waist_girth_mm, GIRTH_TOLERANCE),
        fitted("hip girth", asked.hip, read.hip_girth_mm, GIRTH_TOLERANCE),
        fitted("across shoulder", asked.across_shoulder, read.across_shoulder_mm, SHOULDER_TOLERANCE),
    ]
}

/// The grid on which the skin of a figure is polygonised: finer beyond the shoulders and below the ankles.
fn grid(figure: &Figure) -> Grid {
    let stature = figure.profile.stature;
    let walk = |from: f64, to: f64, spacing: &dyn Fn(f64) -> f64| {
        let mut nodes = vec![from];
        let mut at = from;
        while at < to {
            at += spacing(at) * stature;
            nodes.push(at);
        }
        nodes
    };
    let (low, high) = figure.extent();
    let sideways = |x: f64| if x > figure.targets.shoulder_x { FINE_SPACING } else { SPACING };
    let upward = |z: f64| if z < ANKLE * stature { FINE_SPACING } else { SPACING };
    let right = walk(SPACING * stature / 2.0, high.x, &sideways);
    let x: Vec<f64> = right.iter().rev().map(|x| -x).chain(right.iter().copied()).collect();
    let y = walk(low.y, high.y, &|_| SPACING);
    let z = walk(low.z, high.z, &upward);
    Grid { axes: [x, y, z] }
}

/// Where the tape is laid on a figure's skin. Chest and hip are found on the mesh, as on anybody's, so that whoever
/// measures the mesh reads what was fitted; shoulder and waist are known from the figure.
fn sites(mesh: &TriMesh, figure: &Figure) -> Result<Sites, BodyError> {
    let (atlas, h) = (figure.atlas, figure.profile.stature);
    let missing = |part, share: f64| BodyError::MissingPart { part, height_mm: share * h * 1e3 };
    let upper = tape::above(mesh, 0.7 * h);
    let crotch = landmarks::crotch(mesh, 0.40 * h, 0.52 * h, 0.0).ok_or_else(|| missing("crotch", atlas.crotch))?;
    let neck = tape::neck(&upper, 0.845 * h, 0.885 * h, 0.0).ok_or_else(|| missing("neck", 0.87))?;
    let back_neck = landmarks::median_point(&upper, figure.back_neck_height(), 0.0, Side::Back);
    let chest = measure::chest_level(mesh, 0.0, h, crotch, 0.0).unwrap_or(atlas.chest * h);
    let shoulder = |sign: f64| landmarks::shoulder_top(&upper, sign * figure.targets.shoulder_x, 0.86 * h);
    let right = shoulder(1.0).ok_or_else(|| missing("shoulder", atlas.shoulder))?;
    let along = figure.arm_axes()[2];
    Ok(Sites {
        floor: 0.0,
        crown: h,
        middle: 0.0,
        crotch,
        hip: measure::hip_level(mesh, crotch, h, 0.0).unwrap_or(atlas.hip * h),
        waist: atlas.waist * h,
        underbust: measure::underbust_level(mesh, chest, h, 0.0),
        chest,
        neck,
        shoulder: [right, shoulder(-1.0).ok_or_else(|| missing("shoulder", atlas.shoulder))?],
        back_neck: back_neck.ok_or_else(|| missing("nape", 0.86))?,
        upper_arm: Some((figure.shoulder_joint() + along * 0.088 * h, along)),
    })
}

/// Puts together what is known of a finished skin.
fn describe(sex: Sex, mesh: TriMesh, figure: &Figure) -> Result<Body, BodyError> {
    let sites = sites(&mesh, figure)?;
    let girths = measure::girths_at(&mesh, &sites)?;
    let landmarks = find_landmarks(&mesh, figure, &sites)?;
    let mut control = control_mesh(&mesh, &cuts(&mesh, figure, &sites, &landmarks))?;
    control.snap(&landmarks);
    let levels = Levels {
        chest_m: sites.chest,
        underbust_m: sites.underbust,
        waist_m: sites.waist,
        hip_m: sites.hip,
        crotch_m: sites.crotch,
        neck_m: sites.neck.height,
    };
    let skeleton = control.skeleton();
    Ok(Body { sex, mesh, skeleton, landmarks, levels, control, girths })
}

fn find_landmarks(mesh: &TriMesh, figure: &Figure, sites: &Sites) -> Result<Landmarks, BodyError> {
    let h = figure.profile.stature;
    let missing = |part: &'static str, z: f64| BodyError::MissingPart { part, height_mm: z * 1e3 };
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

/// The planes of the control mesh.
fn cuts(mesh: &TriMesh, figure: &Figure, sites: &Sites, landmarks: &Landmarks) -> Cuts {
    let (atlas, h) = (figure.atlas, figure.profile.stature);
    let [elbow, wrist, tip] = figure.arm_lengths();
    let [outward, forward, along] = figure.arm_axes();
    let joint = figure.shoulder_joint();
    let across_arm = |t: f64| Plane { origin: joint + along * t, u: forward, v: outward };
    let (shoulder, armpit) = (landmarks.shoulder[0], landmarks.armpit[0]);
    // The armscye: through the shoulder point, passing outside the armpit.
    let up = V3::new(shoulder.x - armpit.x - 0.012, 0.0, shoulder.z - armpit.z).normalize();
    let armscye = Plane {
        origin: V3::new((shoulder.x + armpit.x) / 2.0 + 0.006, joint.y, (shoulder.z + armpit.z) / 2.0),
        u: V3::y(),
        v: up,
    };
    let (front, back) = (landmarks.front_neck, landmarks.back_neck);
    let base = (back - front).normalize();
    let neck_lean = V3::new(0.0, sites.neck.lean.sin(), sites.neck.lean.cos());
    let middle_of = |z: f64| {
        tape::trunk_outline(mesh, z, 0.0).map_or(0.0, |outline| {
            let (front, back) = tape::depth_range(&outline);
            (front + back) / 2.0
        })
    };
    Cuts {
        leg: [0.012 * h, 0.072 * h, atlas.calf * h, atlas.knee * h, 0.80 * sites.crotch, sites.crotch - 0.02],
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
            Plane::normal_to(V3::new(0.0, middle_of(sites.neck.height), sites.neck.height), neck_lean),
        ],
        head: [h * (1.0 - 0.76 * atlas.head_height), h * (1.0 - 0.35 * atlas.head_height)],
        arm: [
            armscye,
            across_arm(0.58 * elbow),
            across_arm(elbow),
            across_arm(elbow + 0.2 * (wrist - elbow)),
            across_arm(wrist),
        ],
        crown: highest(mesh),
        hand: farthest_along(mesh, joint, along, tip),
    }
}

/// The highest vertex.
fn highest(mesh: &TriMesh) -> V3 {
    mesh.positions.iter().copied().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap_or_else(V3::zeros)
}

/// The vertex of the right hand that reaches farthest along the arm.
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
