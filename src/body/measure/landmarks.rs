//! Landmarks of a body mesh that its sections alone show.

use super::slices::{Sliced, Slices, steps};
use super::tape;
use crate::Sex;
use geom::section::{Outline, Plane, section};
use geom::{TriMesh, V3};

/// Least girth of an outline across the median plane that belongs to the trunk, m. Judgement.
const LEAST_TRUNK: f64 = 0.03;

/// Height of the crotch: the lowest height at which an outline crosses the median plane, by bisection.
pub(crate) fn crotch(mesh: &TriMesh, mut below: f64, mut above: f64, middle: f64) -> Option<f64> {
    let lower = Slices::new(mesh, below, above);
    let joined =
        |z: f64| tape::trunk_outline(&lower, z, middle).is_some_and(|outline| tape::girth(&outline) > LEAST_TRUNK);
    if joined(below) || !joined(above) {
        return None;
    }
    while above - below > 1e-4 {
        let z = (below + above) / 2.0;
        if joined(z) { above = z } else { below = z }
    }
    Some(above)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Front,
    Back,
}

pub(crate) fn median_point(mesh: &impl Sliced, z: f64, middle: f64, side: Side) -> Option<V3> {
    let outline = tape::trunk_outline(mesh, z, middle)?;
    let next = outline.points.iter().cycle().skip(1);
    let crossings = outline.points.iter().zip(next).filter(|(a, b)| (a.x > middle) != (b.x > middle));
    let places = crossings.map(|(a, b)| a.y + (b.y - a.y) * (middle - a.x) / (b.x - a.x));
    let y = match side {
        Side::Front => places.max_by(f64::total_cmp),
        Side::Back => places.min_by(f64::total_cmp),
    };
    y.map(|y| V3::new(middle, y, z))
}

/// Highest point of the shoulder at the signed distance `x` from the median plane, below the height `ceiling`.
pub(crate) fn shoulder_top(mesh: &TriMesh, x: f64, ceiling: f64) -> Option<V3> {
    let plane = Plane { origin: V3::new(x, 0.0, 0.0), u: V3::y(), v: V3::z() };
    let points = section(mesh, &plane).into_iter().flat_map(|outline| outline.points).filter(|p| p.y < ceiling);
    points.max_by(|a, b| a.y.total_cmp(&b.y)).map(|p| plane.lift(p))
}

/// Highest point of the gap between the right arm and the trunk, by bisection between heights at which the arm is free
/// and at which it is joined to the trunk.
pub(crate) fn armpit(mesh: &TriMesh, mut free: f64, mut joined: f64, middle: f64) -> Option<V3> {
    let around = Slices::new(mesh, free, joined);
    let gap = |z: f64| {
        let trunk = tape::trunk_outline(&around, z, middle)?;
        let limbs = tape::right_limbs(&around, z, middle);
        let arm = limbs.iter().max_by(|a, b| a.bounds().1.x.total_cmp(&b.bounds().1.x))?;
        let outermost = trunk.points.iter().max_by(|a, b| a.x.total_cmp(&b.x))?;
        let innermost = arm.points.iter().min_by(|a, b| a.x.total_cmp(&b.x))?;
        Some((outermost + innermost) / 2.0)
    };
    let mut apex = gap(free).map(|p| V3::new(p.x, p.y, free))?;
    while joined - free > 1e-5 {
        let z = (free + joined) / 2.0;
        match gap(z) {
            Some(p) => {
                free = z;
                apex = V3::new(p.x, p.y, z);
            }
            None => joined = z,
        }
    }
    Some(apex)
}

/// Greatest height of an arm in a section parallel to the median plane, as a share of stature. Judgement.
const SPREAD_ARM: f64 = 0.10;

/// Armpit of a right arm that is spread so wide that no horizontal plane passes between arm and trunk: the underside of
/// the arm where, going inwards, sections parallel to the median plane become higher than an arm.
pub(crate) fn armpit_of_spread(mesh: &TriMesh, shoulder: V3, stature: f64) -> Option<V3> {
    let underside = |x: f64| {
        let plane = Plane { origin: V3::new(x, 0.0, 0.0), u: V3::y(), v: V3::z() };
        let outlines = section(mesh, &plane);
        let arm = outlines.iter().max_by(|a, b| a.bounds().1.y.total_cmp(&b.bounds().1.y))?;
        let lowest = arm.points.iter().min_by(|a, b| a.y.total_cmp(&b.y))?;
        (arm.bounds().1.y - lowest.y < SPREAD_ARM * stature).then(|| plane.lift(*lowest))
    };
    let (mut free, mut joined) = (shoulder.x + 0.08 * stature, shoulder.x - 0.06 * stature);
    let mut apex = underside(free)?;
    while free - joined > 1e-4 {
        let x = (free + joined) / 2.0;
        match underside(x) {
            Some(point) => (free, apex) = (x, point),
            None => joined = x,
        }
    }
    Some(apex)
}

/// Lowest point of the skin between the thighs, in the median plane just above the height of the crotch.
pub(crate) fn crotch_point(mesh: &TriMesh, crotch: f64) -> Option<V3> {
    let outline = tape::trunk_outline(mesh, crotch, 0.0)?;
    let next = outline.points.iter().cycle().skip(1);
    let crossings = outline.points.iter().zip(next).filter(|(a, b)| (a.x > 0.0) != (b.x > 0.0));
    let places: Vec<f64> = crossings.map(|(a, b)| a.y + (b.y - a.y) * (-a.x) / (b.x - a.x)).collect();
    (!places.is_empty()).then(|| V3::new(0.0, places.iter().sum::<f64>() / places.len() as f64, crotch))
}

/// Distance below the crotch at which the middle of the thighs is read, m: that of the thigh girth.
const THIGHS: f64 = 0.02;

/// Point of the skin between the legs in the median plane above the middle of the thighs, where the inseams of trousers
/// meet. The lowest point lies anywhere along a skin that is nearly level; the thighs do not.
pub(crate) fn fork(mesh: &TriMesh, crotch: f64, middle: f64) -> Option<V3> {
    let level = Plane::horizontal(crotch - THIGHS);
    let outlines = section(mesh, &level);
    // Of the outlines on a side, the legs lie inside the hands.
    let depth = |side: f64| {
        let inner = |outline: &Outline| {
            let (low, high) = outline.bounds();
            (side * (low.x - middle)).min(side * (high.x - middle))
        };
        let limbs = outlines.iter().filter(|outline| inner(outline) > 0.0 && tape::is_limb(outline));
        let leg = limbs.min_by(|a, b| inner(a).total_cmp(&inner(b)))?;
        Some((leg.bounds().0.y + leg.bounds().1.y) / 2.0)
    };
    let y = (depth(1.0)? + depth(-1.0)?) / 2.0;
    let plane = Plane { origin: V3::new(middle, 0.0, 0.0), u: V3::y(), v: V3::z() };
    let outlines = section(mesh, &plane);
    let edges = outlines.iter().flat_map(|outline| outline.points.iter().zip(outline.points.iter().cycle().skip(1)));
    let crossings =
        edges.filter(|(a, b)| (a.x > y) != (b.x > y)).map(|(a, b)| a.y + (b.y - a.y) * (y - a.x) / (b.x - a.x));
    let lowest = crossings.filter(|z| *z > crotch - THIGHS).min_by(f64::total_cmp)?;
    Some(V3::new(middle, y, lowest))
}

/// Foremost point of one side of the chest at height `z`, or on a flat chest the usual place of the nipple.
pub(crate) fn bust_point(mesh: &TriMesh, z: f64, sign: f64, stature: f64) -> Option<V3> {
    /// Usual distance of the nipple from the median plane, and searched range, as shares of stature. Judgement.
    const USUAL: f64 = 0.054;
    const RANGE: [f64; 2] = [0.040, 0.075];
    let outline = tape::trunk_outline(mesh, z, 0.0)?;
    let front = |x: f64| {
        let next = outline.points.iter().cycle().skip(1);
        let crossings = outline.points.iter().zip(next).filter(|(a, b)| (a.x > x) != (b.x > x));
        crossings
            .map(|(a, b)| a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x))
            .max_by(f64::total_cmp)
            .map(|y| V3::new(x, y, z))
    };
    let candidates = steps(sign * RANGE[0] * stature, sign * RANGE[1] * stature, 35).filter_map(front);
    let foremost = candidates.max_by(|a, b| a.y.total_cmp(&b.y))?;
    let at_edge = (foremost.x.abs() - RANGE[0] * stature).abs() < 1e-9;
    if at_edge { front(sign * USUAL * stature) } else { Some(foremost) }
}

/// Distance of the nipples from the median plane / stature: intercept, slope with chest girth / stature, and addition
/// for women. Least squares for 199 model bodies, residual 8 mm.
const NIPPLES_OUT: [f64; 3] = [0.0065, 0.0836, 0.0092];

/// Bust point of one side of a bare mesh at height `z`: on the front of the chest, at the distance that the chest girth
/// gives. `frame` is the position of the median plane and the stature, m.
pub(crate) fn usual_bust_point(mesh: &TriMesh, z: f64, sign: f64, frame: [f64; 2], sex: Sex) -> Option<V3> {
    let [middle, stature] = frame;
    let outline = tape::trunk_outline(mesh, z, middle)?;
    let [constant, girth, woman] = NIPPLES_OUT;
    let woman = if sex == Sex::Female { woman } else { 0.0 };
    let x = middle + sign * ((constant + woman) * stature + girth * tape::girth(&outline));
    Some(V3::new(x, tape::edge(&outline, x, 1.0)?, z))
}

/// Mirrors a mesh at the plane `x = middle`, so that the left side can be measured as a right side.
pub(crate) fn mirrored(mesh: &TriMesh, middle: f64) -> TriMesh {
    let positions = mesh.positions.iter().map(|p| V3::new(2.0 * middle - p.x, p.y, p.z)).collect();
    TriMesh { positions, triangles: mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect() }
}
