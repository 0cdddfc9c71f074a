//! Alignment of a body of any orientation with the world frame: upright, facing `y`, median plane at `x = 0`.

use crate::measure::tape;
use crate::repair::clean::principal_axes;
use geom::section::{Plane, section};
use geom::{TriMesh, V2, V3, hull};
use nalgebra::{Rotation2, UnitQuaternion};
use std::borrow::Cow;

/// Angle between the long axis and an axis of the file below which the body stands along that axis, radians. Judgement.
const SNAP: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// Least lean that is corrected, radians: from the upright axis of the file, or if there is none. Then the greatest
/// lean that righting by the soles may leave: beyond, a body does not stand on its soles (raised heels). Judgement.
const LEANING: [f64; 2] = [2.5 * std::f64::consts::PI / 180.0, 0.2 * std::f64::consts::PI / 180.0];
const SOLES: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// Length difference of the legs from which one of them counts as cut off, as a share of stature. Judgement.
const UNEVEN: f64 = 0.02;

/// Height of the zone of the soles above the lowest point, as a share of stature. Judgement.
const SOLE_ZONE: f64 = 0.025;

/// Number of slabs that measure the symmetry, and of directions of their support functions: every half degree.
const SLABS: usize = 24;
const DIRECTIONS: usize = 720;

/// Least turn (radians) and shift (share of stature) that is corrected. Judgement.
const TURNED: f64 = 1.5 * std::f64::consts::PI / 180.0;
const SHIFTED: f64 = 0.004;

/// Greatest root mean square difference between left and right of a symmetric body, as a share of stature. Judgement.
const SYMMETRIC: f64 = 0.02;

/// Turns the long axis up, with the legs below. Returns true if the body stands along an axis of its file.
pub(super) fn stand_up(mesh: &mut TriMesh, notes: &mut Vec<String>) -> bool {
    let Some((_, [long, ..])) = principal_axes(mesh, &mesh.triangles) else { return true };
    let leaning = |axis: &V3| long.dot(axis).abs().clamp(0.0, 1.0).acos();
    let frame = [V3::z(), V3::y(), V3::x()];
    let nearest = frame.iter().position(|axis| leaning(axis) < SNAP);
    match nearest {
        Some(0) => {}
        // In most animation software z points to the front and x to the subject's left.
        Some(1) => {
            turn_all(mesh, |p| V3::new(-p.x, p.z, p.y));
            notes.push("taken as y up, z to the front (the greatest extent is along y)".to_owned());
        }
        Some(_) => {
            turn_all(mesh, |p| V3::new(p.y, p.z, p.x));
            notes.push("taken as x up (the greatest extent is along x)".to_owned());
        }
        None => {
            let up = if long.z < 0.0 { -long } else { long };
            if let Some(turn) = UnitQuaternion::rotation_between(&up, &V3::z()) {
                turn_all(mesh, |p| turn * p);
            }
            notes.push("stood up: its long axis leant from every axis of the file".to_owned());
        }
    }
    if stands_on_head(mesh) {
        turn_all(mesh, |p| V3::new(-p.x, p.y, -p.z));
        notes.push("turned upside down: the legs were above".to_owned());
    }
    nearest.is_some()
}

/// Rights a body that faces front or back: its long axis must not lean sideways, and its soles must be level.
pub(super) fn straighten(mesh: &mut TriMesh, along_axis: bool, notes: &mut Vec<String>) {
    let Some((_, [long, ..])) = principal_axes(mesh, &on_both_sides(mesh)) else { return };
    let long = if long.z < 0.0 { -long } else { long };
    let sideways = long.x.atan2(long.z);
    let about_y = UnitQuaternion::from_axis_angle(&V3::y_axis(), -sideways);
    let upright = TriMesh { positions: mesh.positions.iter().map(|p| about_y * p).collect(), triangles: Vec::new() };
    let forwards = sole_slope(&upright).unwrap_or(0.0);
    let about_x = UnitQuaternion::from_axis_angle(&V3::x_axis(), -forwards);
    let righted = about_x * about_y;
    let lean = (righted * long).z.clamp(-1.0, 1.0).acos();
    let turn = if lean < SOLES { righted } else { about_y };
    if turn.angle() > LEANING[usize::from(!along_axis)] {
        turn_all(mesh, |p| turn * p);
        notes.push(format!("righted by {:.1} degrees: it leant", turn.angle().to_degrees()));
    }
}

/// Triangles without the part of one leg below the end of the other: a leg that is cut off makes the body lean.
fn on_both_sides(mesh: &TriMesh) -> Cow<'_, [[usize; 3]]> {
    let Some((low, high)) = mesh.bounds() else { return Cow::Borrowed(&mesh.triangles) };
    let middle = (low.x + high.x) / 2.0;
    let end = |side: f64| {
        let leg = mesh.positions.iter().filter(|p| side * (p.x - middle) > 0.0);
        leg.map(|p| p.z).fold(f64::INFINITY, f64::min)
    };
    let upper = end(1.0).max(end(-1.0));
    if upper - low.z < UNEVEN * (high.z - low.z) {
        return Cow::Borrowed(&mesh.triangles);
    }
    let is_above = |triangle: &&[usize; 3]| triangle.iter().all(|&i| mesh.positions[i].z > upper);
    Cow::Owned(mesh.triangles.iter().filter(is_above).copied().collect())
}

/// Slope of the soles from back to front, radians: that of the lower edge of the hull below the middle of the feet.
fn sole_slope(mesh: &TriMesh) -> Option<f64> {
    let (low, high) = mesh.bounds()?;
    let ceiling = low.z + SOLE_ZONE * (high.z - low.z);
    let soles: Vec<V2> = mesh.positions.iter().filter(|p| p.z < ceiling).map(|p| V2::new(p.y, p.z)).collect();
    let hull = hull::convex_hull(&soles);
    let (from, to) = soles.iter().fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(p.x), b.max(p.x)));
    let middle = (from + to) / 2.0;
    // In a counter-clockwise hull the lower edges run forwards.
    let next = hull.iter().cycle().skip(1);
    let edge = hull.iter().zip(next).find(|(a, b)| a.x <= middle && b.x > middle)?;
    Some((edge.1.y - edge.0.y).atan2(edge.1.x - edge.0.x))
}

fn turn_all(mesh: &mut TriMesh, turn: impl Fn(&V3) -> V3) {
    mesh.positions.iter_mut().for_each(|p| *p = turn(p));
}

fn stands_on_head(mesh: &TriMesh) -> bool {
    let Some((low, high)) = mesh.bounds() else { return false };
    let stature = high.z - low.z;
    let parts = |share: f64| {
        let outlines = section(mesh, &Plane::horizontal(low.z + share * stature));
        outlines.iter().filter(|outline| tape::girth(outline) > 0.08 * stature).count()
    };
    let legs = |shares: [f64; 3]| shares.iter().filter(|&&share| parts(share) >= 2).count() >= 2;
    legs([0.78, 0.82, 0.86]) && !legs([0.14, 0.18, 0.22])
}

/// Turns an upright mesh about the vertical so that its plane of symmetry, if there is one, becomes the median plane.
pub(super) fn face_front(mesh: &mut TriMesh, notes: &mut Vec<String>) {
    let Some((low, high)) = mesh.bounds() else { return };
    let stature = high.z - low.z;
    let Some(symmetry) = Symmetry::find(mesh, low.z, stature) else { return };
    if symmetry.difference > SYMMETRIC * stature {
        return;
    }
    // The plane has two directions. The smaller turn is taken, and the feet decide later.
    let turn = symmetry.front.rem_euclid(std::f64::consts::PI) - std::f64::consts::FRAC_PI_2;
    let turned = turn.abs() > TURNED;
    let rotation = Rotation2::new(if turned { -turn } else { 0.0 });
    let centre = if turned { rotation * symmetry.point } else { symmetry.point };
    let shift_y = if turned { centre.y } else { 0.0 };
    if !turned && centre.x.abs() < SHIFTED * stature {
        return;
    }
    turn_all(mesh, |p| {
        let q = rotation * p.xy();
        V3::new(q.x - centre.x, q.y - shift_y, p.z)
    });
    if turned {
        notes.push(format!("turned by {:.1} degrees about the vertical into its median plane", -turn.to_degrees()));
    } else {
        notes.push("shifted into its median plane".to_owned());
    }
}

struct Symmetry {
    /// Direction of the trace of the plane, radians from `x`.
    front: f64,
    point: V2,
    /// Root mean square difference between both sides, in the unit of the mesh.
    difference: f64,
}

impl Symmetry {
    /// Compares the support functions of horizontal slabs with their mirror images for every direction of the plane,
    /// and interpolates the best direction by a parabola.
    fn find(mesh: &TriMesh, floor: f64, stature: f64) -> Option<Self> {
        let centre = mesh.positions.iter().map(V3::xy).sum::<V2>() / mesh.positions.len().max(1) as f64;
        let slabs: Vec<Vec<f64>> =
            (0..SLABS).filter_map(|i| support(mesh, floor, stature / SLABS as f64, i, centre)).collect();
        if slabs.len() < SLABS / 2 {
            return None;
        }
        let tried: Vec<Asymmetry> = (0..DIRECTIONS / 2).map(|front| asymmetry(&slabs, front)).collect();
        let wide = |i: usize| {
            let side = (i + DIRECTIONS / 4) % DIRECTIONS;
            slabs.iter().map(|slab| slab[side] + slab[(side + DIRECTIONS / 2) % DIRECTIONS]).sum::<f64>()
        };
        // A body is also nearly symmetric from front to back. Of the two planes, the one across which the body is wide
        // is the median plane.
        let least = (0..tried.len())
            .min_by(|&i, &j| (tried[i].difference / wide(i)).total_cmp(&(tried[j].difference / wide(j))))?;
        let squared = |i: usize| tried[i % tried.len()].difference.powi(2);
        let (before, here, after) = (squared(least + tried.len() - 1), squared(least), squared(least + 1));
        let bend = before - 2.0 * here + after;
        let offset = if bend > 0.0 { ((before - after) / (2.0 * bend)).clamp(-0.5, 0.5) } else { 0.0 };
        let front = (least as f64 + offset) / DIRECTIONS as f64 * std::f64::consts::TAU;
        let side = V2::new(front.sin(), -front.cos());
        Some(Self { front, point: centre + side * tried[least].offset, difference: tried[least].difference })
    }
}

/// Distance of the tangent in every direction about `centre`. `None` for a slab with too few vertices.
fn support(mesh: &TriMesh, floor: f64, height: f64, slab: usize, centre: V2) -> Option<Vec<f64>> {
    let within = |p: &&V3| ((p.z - floor) / height).floor() as usize == slab;
    let points: Vec<V2> = mesh.positions.iter().filter(within).map(|p| p.xy() - centre).collect();
    let hull = hull::convex_hull(&points);
    let tangent = |i: usize| {
        let angle = i as f64 / DIRECTIONS as f64 * std::f64::consts::TAU;
        let direction = V2::new(angle.cos(), angle.sin());
        hull.iter().map(|p| p.dot(&direction)).fold(f64::NEG_INFINITY, f64::max)
    };
    (hull.len() >= 3).then(|| (0..DIRECTIONS).map(tangent).collect())
}

struct Asymmetry {
    difference: f64,
    /// Offset of the plane to the right of its direction.
    offset: f64,
}

fn asymmetry(slabs: &[Vec<f64>], front: usize) -> Asymmetry {
    const STEP: usize = 8;
    let turns = (STEP..DIRECTIONS / 2).step_by(STEP);
    let odd = |slab: &[f64], turn: usize| {
        let right = slab[(front + DIRECTIONS - turn) % DIRECTIONS];
        let left = slab[(front + turn) % DIRECTIONS];
        (right - left) / 2.0
    };
    let sine = |turn: usize| (turn as f64 / DIRECTIONS as f64 * std::f64::consts::TAU).sin();
    let both = || slabs.iter().flat_map(|slab| turns.clone().map(move |turn| (odd(slab, turn), sine(turn))));
    let offset = both().map(|(odd, sine)| odd * sine).sum::<f64>() / both().map(|(_, sine)| sine * sine).sum::<f64>();
    let squares = both().map(|(odd, sine)| (odd - offset * sine).powi(2));
    Asymmetry { difference: (squares.sum::<f64>() / both().count() as f64).sqrt(), offset }
}

/// True if the feet point backwards: their middle is behind that of the ankles.
pub(super) fn looks_back(mesh: &TriMesh) -> bool {
    let Some((low, high)) = mesh.bounds() else { return false };
    let stature = high.z - low.z;
    let middle = |from: f64, to: f64| {
        let band = mesh.positions.iter().filter(|p| (from..to).contains(&((p.z - low.z) / stature))).map(|p| p.y);
        let (least, most) = band.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
        (least <= most).then_some((least + most) / 2.0)
    };
    let (feet, ankles) = (middle(-0.001, 0.04), middle(0.06, 0.12));
    feet.zip(ankles).is_some_and(|(feet, ankles)| feet < ankles - 0.01 * stature)
}
