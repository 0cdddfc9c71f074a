//! The tape measure: girths of plane sections of a body mesh.

use crate::geom::section::{Outline, Plane, section};
use crate::geom::{TriMesh, V2, V3, hull};

/// Outlines shorter than this are jewellery, navels and folds, metres.
const SMALLEST_PART: f64 = 0.10;

/// The outline of the trunk (or neck, or head) at height `z`: the longest across the plane `x = middle`.
pub(super) fn trunk_outline(mesh: &TriMesh, z: f64, middle: f64) -> Option<Outline> {
    let across = |outline: &Outline| {
        let (low, high) = outline.bounds();
        low.x < middle && high.x > middle
    };
    section(mesh, &Plane::horizontal(z)).into_iter().filter(across).max_by(|a, b| girth(a).total_cmp(&girth(b)))
}

/// Tape girth of an outline, metres.
pub(super) fn girth(outline: &Outline) -> f64 {
    hull::tape_girth(&outline.points)
}

/// Tape girth of the trunk at height `z`, metres.
pub(super) fn trunk_girth(mesh: &TriMesh, z: f64, middle: f64) -> Option<f64> {
    trunk_outline(mesh, z, middle).map(|outline| girth(&outline))
}

/// The outlines of limb size at height `z` whose middle lies to the right of `x`.
pub(super) fn right_limbs(mesh: &TriMesh, z: f64, x: f64) -> Vec<Outline> {
    let right = |outline: &Outline| {
        let (low, high) = outline.bounds();
        low.x > x && hull::perimeter(&outline.points) > SMALLEST_PART && (low.x + high.x) / 2.0 > x
    };
    section(mesh, &Plane::horizontal(z)).into_iter().filter(right).collect()
}

/// Girth of the outline round `point` in the plane through it with `normal`, metres: the largest outline that holds
/// the point (inner ones are throats and other cavities).
pub(super) fn girth_round(mesh: &TriMesh, point: V3, normal: V3) -> Option<f64> {
    outline_round(mesh, &Plane::normal_to(point, normal)).map(|outline| girth(&outline))
}

/// The largest outline that holds the origin of the plane.
fn outline_round(mesh: &TriMesh, plane: &Plane) -> Option<Outline> {
    let holds = |outline: &Outline| outline.contains(V2::zeros());
    section(mesh, plane).into_iter().filter(holds).max_by(|a, b| girth(a).total_cmp(&girth(b)))
}

/// The taut tape from `start` over `middle` to `end`, along the convex hull of the section through the three points:
/// the part of the hull on the side of `middle`, metres.
pub(super) fn tape_over(mesh: &TriMesh, start: V3, middle: V3, end: V3) -> Option<f64> {
    let normal = (middle - start).cross(&(end - start)).try_normalize(1e-9)?;
    let along = (end - start).normalize();
    let plane = Plane { origin: start, u: along, v: normal.cross(&along) };
    let reach = plane.project(end).x;
    let top = plane.project(middle).y;
    // Beyond the middle point the plane may cut other parts (the head behind the nape): the tape does not go there.
    let between = |p: &V2| p.x > 0.0 && p.x < reach && p.y * top > 0.0 && p.y.abs() <= top.abs();
    let mut points: Vec<V2> =
        section(mesh, &plane).into_iter().flat_map(|outline| outline.points).filter(between).collect();
    points.extend([V2::zeros(), V2::new(reach, 0.0), plane.project(middle)]);
    Some(hull::tape_girth(&points) - reach)
}

/// The narrowest girth round the neck.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Neck {
    /// Girth, metres.
    pub girth: f64,
    /// Middle of the tape, metres.
    pub centre: V3,
    /// Height of the tape at the spine, metres.
    pub height: f64,
    /// Lean of the neck forward from the vertical, radians.
    pub lean: f64,
}

/// How far behind the middle of the neck the spine runs, as a share of its depth: the height of a leaning tape is read there.
const SPINE: f64 = 0.14;

/// Finds the narrowest girth round the neck, over heights between `low` and `high` and leans of up to 30 degrees.
pub(super) fn neck(mesh: &TriMesh, low: f64, high: f64, middle: f64) -> Option<Neck> {
    let upper = above(mesh, low - 0.12);
    let plane = |height: f64, lean: f64| {
        let (front, back) = depth_range(&trunk_outline(&upper, height, middle)?);
        let centre = V3::new(middle, (front + back) / 2.0, height);
        Some(Plane::normal_to(centre, V3::new(0.0, lean.sin(), lean.cos())))
    };
    let least = |candidates: &mut dyn Iterator<Item = (f64, f64)>| {
        let at = |(height, lean)| Some((height, lean, girth(&outline_round(&upper, &plane(height, lean)?)?)));
        candidates.filter_map(at).min_by(|a, b| a.2.total_cmp(&b.2))
    };
    let coarse_step = (high - low) / 12.0;
    let lean_step = 5_f64.to_radians();
    let mut coarse =
        (0..=12).flat_map(|i| (0..=6).map(move |j| (low + coarse_step * f64::from(i), lean_step * f64::from(j))));
    let best = least(&mut coarse)?;
    let offsets = |i: i32, step: f64| f64::from(i) * step / 3.0;
    let mut fine = (-3..=3).flat_map(|i| {
        (-3..=3).map(move |j| (best.0 + offsets(i, coarse_step), (best.1 + offsets(j, lean_step)).max(0.0)))
    });
    let (height, lean, girth) = least(&mut fine)?;
    // The horizontal outline, by which the search goes, reaches under the chin: the tape's own middle lies farther back.
    let plane = plane(height, lean)?;
    let (low, high) = outline_round(&upper, &plane)?.bounds();
    let centre = plane.lift((low + high) / 2.0);
    let spine = centre - plane.v * (SPINE * (high.y - low.y));
    Some(Neck { girth, centre, height: spine.z, lean })
}

/// Half of a drawn tape's breadth and how far it lies off the skin, metres.
const TAPE: [f64; 2] = [0.004, 0.003];

/// Taut tapes round the trunk at some heights, as bands to be drawn.
pub(super) fn bands(mesh: &TriMesh, heights: &[f64], middle: f64) -> TriMesh {
    let [half, off] = TAPE;
    let mut bands = TriMesh::default();
    for &z in heights {
        let Some(outline) = trunk_outline(mesh, z, middle) else { continue };
        let hull = hull::convex_hull(&outline.points);
        let centre = hull.iter().sum::<V2>() / hull.len().max(1) as f64;
        let first = bands.positions.len();
        for p in &hull {
            let out = p + (p - centre).try_normalize(1e-9).unwrap_or_else(V2::zeros) * off;
            bands.positions.extend([z - half, z + half].map(|z| V3::new(out.x, out.y, z)));
        }
        let count = hull.len();
        let corner = |i: usize, up: usize| first + 2 * (i % count) + up;
        bands.triangles.extend((0..count).flat_map(|i| {
            [[corner(i, 0), corner(i + 1, 0), corner(i + 1, 1)], [corner(i, 0), corner(i + 1, 1), corner(i, 1)]]
        }));
    }
    bands
}

/// Front and back extent of an outline.
pub(super) fn depth_range(outline: &Outline) -> (f64, f64) {
    let (low, high) = outline.bounds();
    (high.y, low.y)
}

/// The triangles that reach above the height `z`: sections above it are those of the whole mesh.
pub(super) fn above(mesh: &TriMesh, z: f64) -> TriMesh {
    let reaches = |triangle: &&[usize; 3]| triangle.iter().any(|&vertex| mesh.positions[vertex].z > z);
    TriMesh { positions: mesh.positions.clone(), triangles: mesh.triangles.iter().filter(reaches).copied().collect() }
}

/// The triangles that reach into the heights between `low` and `high`.
pub(super) fn between(mesh: &TriMesh, low: f64, high: f64) -> TriMesh {
    let height = |vertex: usize| mesh.positions[vertex].z;
    let reaches = |triangle: &&[usize; 3]| {
        triangle.iter().any(|&v| height(v) >= low) && triangle.iter().any(|&v| height(v) <= high)
    };
    TriMesh { positions: mesh.positions.clone(), triangles: mesh.triangles.iter().filter(reaches).copied().collect() }
}
