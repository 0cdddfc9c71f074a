//! Centre line of an arm, traced by cross-sections of a skin whose skeleton is unknown.

use super::{AxisPoint, tape};
use crate::repair::clean;
use geom::section::{Outline, Plane, section};
use geom::{TriMesh, V2, V3};

/// Step along the arm, and greatest distance of the middle of a section from the extrapolated line, as shares of
/// stature. Judgement: another outline is another part.
const STEP: f64 = 0.012;
const OFF: f64 = 0.03;

/// Distance outside the armpit of the first section of an arm that is spread wide, as a share of stature. Judgement.
const SPREAD: f64 = 0.05;

/// Range of the girths of sections of an arm, as shares of stature. Judgement.
const ARM_GIRTHS: std::ops::Range<f64> = 0.03..0.36;

const MOST_STEPS: usize = 50;

/// Position of the elbow as a share of the line from the shoulder joint to the finger tips: mean of 200 model bodies,
/// residual 15 mm. Then the range of shares in which the narrowest section of the wrist is sought.
const ELBOW: f64 = 0.364;
const WRIST: [f64; 2] = [0.66, 0.82];

/// Regression of the share of the line at the wrist joint on that at the narrowest section: intercept and slope. Fitted
/// to model bodies, residual 10 mm.
const WRIST_JOINT: [f64; 2] = [0.317, 0.573];

#[derive(Clone, Copy, Debug)]
struct Station {
    centre: V3,
    /// Distance from the shoulder joint along the line, m.
    at: f64,
    /// Tape girth, m.
    girth: f64,
}

/// The right arm of a body.
#[derive(Clone, Debug)]
pub(crate) struct Arm {
    stations: Vec<Station>,
    pub tip: V3,
    length: f64,
}

impl Arm {
    /// Traces the right arm from the shoulder joint, taken half way between shoulder point and armpit, to the finger
    /// tips. `None` if the skin below the armpit is not an arm.
    pub fn trace(mesh: &TriMesh, shoulder: V3, armpit: V3, stature: f64) -> Option<Self> {
        let joint = (shoulder + armpit) / 2.0;
        let mesh = &beyond(mesh, armpit.x - 0.06 * stature);
        let below = armpit.z - 0.03 * stature;
        let limbs = tape::right_limbs(mesh, below, armpit.x - 0.02 * stature);
        let start = match limbs.iter().max_by(|a, b| a.bounds().1.x.total_cmp(&b.bounds().1.x)) {
            Some(first) => Plane::horizontal(below).lift(middle(first)),
            // No part of an arm that is spread wide is below the armpit.
            None => {
                let plane = Plane::normal_to(V3::new(armpit.x + SPREAD * stature, joint.y, joint.z), V3::x());
                plane.lift(middle(&nearest(mesh, &plane, stature)?))
            }
        };
        let mut along = (start - joint).try_normalize(1e-6)?;
        let mut stations = vec![Station { centre: joint, at: 0.0, girth: f64::NAN }];
        let mut at = (start - joint).norm();
        let mut predicted = start;
        let step = STEP * stature;
        while stations.len() < MOST_STEPS {
            let plane = Plane::normal_to(predicted, along);
            let Some(outline) = nearest(mesh, &plane, stature) else { break };
            let centre = plane.lift(middle(&outline));
            stations.push(Station { centre, at, girth: tape::girth(&outline) });
            // The direction of the last four steps. Over a single step, muscles would change it.
            let back = stations[stations.len().saturating_sub(5)].centre;
            along = (centre - back).try_normalize(1e-6)?;
            predicted = centre + along * step;
            at += step;
        }
        let last = stations.last().filter(|_| stations.len() > 8)?;
        let tip = farthest(mesh, last.centre, along, step);
        let length = last.at + (tip - last.centre).dot(&along).max(0.0);
        Some(Self { stations, tip, length })
    }

    pub fn at(&self, share: f64) -> AxisPoint {
        let at = share * self.length;
        let count = self.stations.len();
        let next = self.stations.partition_point(|station| station.at < at).clamp(1, count - 1);
        let (a, b) = (self.stations[next - 1], self.stations[next]);
        let place = a.centre.lerp(&b.centre, ((at - a.at) / (b.at - a.at)).clamp(0.0, 1.0));
        let (from, to) = (self.stations[next.saturating_sub(3)], self.stations[(next + 2).min(count - 1)]);
        AxisPoint { place, along: (to.centre - from.centre).normalize() }
    }

    /// Share of the line at the elbow.
    pub fn elbow(&self) -> f64 {
        ELBOW
    }

    /// Share of the line at the narrowest section of the wrist.
    pub fn wrist(&self) -> f64 {
        let within = |station: &&Station| (WRIST[0]..WRIST[1]).contains(&(station.at / self.length));
        let narrowest = self.stations.iter().filter(within).min_by(|a, b| a.girth.total_cmp(&b.girth));
        narrowest.map_or((WRIST[0] + WRIST[1]) / 2.0, |station| station.at / self.length)
    }

    /// Share of the line at the wrist joint, where the arm length ends.
    pub fn wrist_joint(&self) -> f64 {
        WRIST_JOINT[0] + WRIST_JOINT[1] * self.wrist()
    }

    /// Plane across the arm at a share of the line. The first axis points forward, the second outward and up.
    pub fn across(&self, share: f64) -> Plane {
        let AxisPoint { place: origin, along } = self.at(share);
        let forward = (V3::y() - along * along.y).normalize();
        Plane { origin, u: forward, v: along.cross(&forward) }
    }
}

fn beyond(mesh: &TriMesh, x: f64) -> TriMesh {
    let reaches = |triangle: &&[usize; 3]| triangle.iter().any(|&i| mesh.positions[i].x > x);
    let triangles: Vec<[usize; 3]> = mesh.triangles.iter().filter(reaches).copied().collect();
    clean::used_part(mesh, &triangles)
}

fn middle(outline: &Outline) -> V2 {
    let (low, high) = outline.bounds();
    (low + high) / 2.0
}

/// Outline with the girth of an arm and its middle nearest to the origin of the plane. `None` without such an outline.
fn nearest(mesh: &TriMesh, plane: &Plane, stature: f64) -> Option<Outline> {
    let off = |outline: &Outline| middle(outline).norm();
    let fits =
        |outline: &Outline| ARM_GIRTHS.contains(&(tape::girth(outline) / stature)) && off(outline) < OFF * stature;
    section(mesh, plane).into_iter().filter(fits).min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Farthest vertex along the line through `from`, of the vertices near the line and within three steps.
fn farthest(mesh: &TriMesh, from: V3, along: V3, step: f64) -> V3 {
    let reach = |p: &V3| (p - from).dot(&along);
    let near = |p: &&V3| (0.0..3.0 * step).contains(&reach(p)) && (*p - from - along * reach(p)).norm() < 4.0 * step;
    let found = mesh.positions.iter().filter(near).max_by(|a, b| reach(a).total_cmp(&reach(b)));
    found.copied().unwrap_or(from + along * step)
}
