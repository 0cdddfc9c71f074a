//! The tape measure: girths of plane sections of a body mesh.

use super::slices::{Sliced, Slices};
use geom::section::{Outline, Plane, section};
use geom::{TriMesh, V2, V3, hull};

/// Least length of an outline that is a body part, m. Shorter outlines are jewellery, navels and folds.
const SMALLEST_PART: f64 = 0.10;

/// Outline of the trunk (or neck, or head) at height `z`: the longest outline across the plane `x = middle`.
pub(crate) fn trunk_outline(mesh: &impl Sliced, z: f64, middle: f64) -> Option<Outline> {
    trunk_among(mesh.slice(z), middle)
}

pub(super) fn trunk_among(outlines: Vec<Outline>, middle: f64) -> Option<Outline> {
    let across = |outline: &Outline| {
        let (low, high) = outline.bounds();
        low.x < middle && high.x > middle
    };
    let mut trunks: Vec<Outline> = outlines.into_iter().filter(across).collect();
    if trunks.len() < 2 { trunks.pop() } else { trunks.into_iter().max_by(|a, b| girth(a).total_cmp(&girth(b))) }
}

/// Tape girth of an outline, m.
pub(crate) fn girth(outline: &Outline) -> f64 {
    hull::tape_girth(&outline.points)
}

pub(crate) fn trunk_girth(mesh: &impl Sliced, z: f64, middle: f64) -> Option<f64> {
    trunk_outline(mesh, z, middle).map(|outline| girth(&outline))
}

pub(crate) fn right_limbs(mesh: &impl Sliced, z: f64, x: f64) -> Vec<Outline> {
    mesh.slice(z).into_iter().filter(|outline| is_right_limb(outline, x)).collect()
}

/// Girth of the right leg at a height.
pub(crate) fn leg_girth(mesh: &impl Sliced, z: f64, middle: f64) -> Option<f64> {
    let legs = right_limbs(mesh, z, middle);
    legs.iter().min_by(|a, b| a.bounds().0.x.total_cmp(&b.bounds().0.x)).map(girth)
}

/// Foremost (`side` 1) or hindmost (-1) coordinate of an outline at `x`. `None` if the outline does not reach `x`.
pub(super) fn edge(outline: &Outline, x: f64, side: f64) -> Option<f64> {
    let next = outline.points.iter().cycle().skip(1);
    let crossings = outline.points.iter().zip(next).filter(|(a, b)| (a.x > x) != (b.x > x));
    let places = crossings.map(|(a, b)| a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x));
    places.max_by(|a, b| (side * a).total_cmp(&(side * b)))
}

pub(super) fn is_right_limb(outline: &Outline, x: f64) -> bool {
    outline.bounds().0.x > x && is_limb(outline)
}

pub(super) fn is_limb(outline: &Outline) -> bool {
    hull::perimeter(&outline.points) > SMALLEST_PART
}

/// Girth of the outline round `point` in the plane through `point` normal to `normal`, m. Of several outlines the
/// largest counts: inner ones are the throat and other cavities.
pub(crate) fn girth_round(mesh: &TriMesh, point: V3, normal: V3) -> Option<f64> {
    outline_round(mesh, &Plane::normal_to(point, normal)).map(|outline| girth(&outline))
}

fn outline_round(mesh: &TriMesh, plane: &Plane) -> Option<Outline> {
    let holds = |outline: &Outline| outline.contains(V2::zeros());
    section(mesh, plane).into_iter().filter(holds).max_by(|a, b| girth(a).total_cmp(&girth(b)))
}

/// Length of the taut tape from `start` over `middle` to `end`, m: of the part of the convex hull of the section
/// through the three points that lies on the side of `middle`.
pub(super) fn tape_over(mesh: &TriMesh, start: V3, middle: V3, end: V3) -> Option<f64> {
    let normal = (middle - start).cross(&(end - start)).try_normalize(1e-9)?;
    let along = (end - start).normalize();
    let plane = Plane { origin: start, u: along, v: normal.cross(&along) };
    let reach = plane.project(end).x;
    let top = plane.project(middle).y;
    // The plane may also cut parts past the middle point, such as the head behind the nape. The tape does not go there.
    let between = |p: &V2| p.x > 0.0 && p.x < reach && p.y * top > 0.0 && p.y.abs() <= top.abs();
    let mut points: Vec<V2> =
        section(mesh, &plane).into_iter().flat_map(|outline| outline.points).filter(between).collect();
    points.extend([V2::zeros(), V2::new(reach, 0.0), plane.project(middle)]);
    Some(hull::tape_girth(&points) - reach)
}

/// Narrowest girth of the neck, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neck {
    pub girth: f64,
    pub centre: V3,
    /// Height at the spine.
    pub height: f64,
    /// Forward lean of the neck from the vertical, radians.
    pub lean: f64,
}

impl Neck {
    /// Unit direction of the neck, upward: the normal of the tape's plane.
    pub fn along(&self) -> V3 {
        V3::new(0.0, self.lean.sin(), self.lean.cos())
    }
}

/// Distance of the spine, where the height of a leaning tape is read, behind the neck's middle / its depth. Judgement.
const SPINE: f64 = 0.14;

/// Greatest lean of the neck that is tried, radians, and numbers of heights and leans of the coarse grid. Judgement.
const GREATEST_LEAN: f64 = 30.0 * std::f64::consts::PI / 180.0;
const HEIGHTS: usize = 13;
const LEANS: usize = 7;

const HALVINGS: usize = 3;

/// Finds the narrowest girth between `low` and `high`, up to [`GREATEST_LEAN`], by a coarse grid and a pattern search.
pub(crate) fn neck(mesh: &TriMesh, low: f64, high: f64, middle: f64) -> Option<Neck> {
    let upper = mesh.part(|p| p.z > low - 0.12 && p.z < high + 0.12);
    let slices = Slices::new(&upper, low, high);
    let centre = |height: f64| {
        let (front, back) = depth_range(&trunk_outline(&slices, height, middle)?);
        Some(V3::new(middle, (front + back) / 2.0, height))
    };
    let plane = |centre: V3, lean: f64| Plane::normal_to(centre, V3::new(0.0, lean.sin(), lean.cos()));
    let tried = |centre: V3, lean: f64| {
        let girth = girth(&outline_round(&upper, &plane(centre, lean))?);
        Some(Tried { centre, lean, girth })
    };
    let row = |height: f64, leans: &[f64]| {
        let centre = centre(height);
        leans.iter().filter_map(|&lean| tried(centre?, lean)).collect::<Vec<_>>()
    };
    let least = |a: &Tried, b: &Tried| a.girth.total_cmp(&b.girth);
    let mut step = [(high - low) / (HEIGHTS - 1) as f64, GREATEST_LEAN / (LEANS - 1) as f64];
    let leans: [f64; LEANS] = std::array::from_fn(|i| step[1] * i as f64);
    let mut best = (0..HEIGHTS).flat_map(|i| row(low + step[0] * i as f64, &leans)).min_by(least)?;
    for _ in 0..HALVINGS {
        step = step.map(|step| step / 2.0);
        let around = [-1.0, 0.0, 1.0].map(|side| (best.centre.z + side * step[0]).clamp(low, high));
        let around_lean = [best.lean - step[1], best.lean, best.lean + step[1]];
        let around_lean = around_lean.map(|lean| lean.clamp(0.0, GREATEST_LEAN));
        best = around.into_iter().flat_map(|height| row(height, &around_lean)).chain([best]).min_by(least)?;
    }
    // The search uses the middle of the horizontal outline, which extends under the chin. The centre of the tape lies
    // farther back.
    let plane = plane(best.centre, best.lean);
    let (low, high) = outline_round(&upper, &plane)?.bounds();
    let centre = plane.lift((low + high) / 2.0);
    let spine = centre - plane.v * (SPINE * (high.y - low.y));
    Some(Neck { girth: best.girth, centre, height: spine.z, lean: best.lean })
}

#[derive(Clone, Copy)]
struct Tried {
    centre: V3,
    lean: f64,
    girth: f64,
}

/// Half breadth of a drawn tape, and distance of the tape from the skin, m. Only for pictures.
const TAPE: [f64; 2] = [0.004, 0.003];

pub(crate) fn bands(mesh: &TriMesh, heights: &[f64], middle: f64) -> TriMesh {
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

/// Adds bands that show a line on the skin, in two planes through the line.
pub(crate) fn draw(bands: &mut TriMesh, path: &[V3]) {
    let [half, _] = TAPE;
    for pair in path.windows(2) {
        let Some(along) = (pair[1] - pair[0]).try_normalize(1e-6) else { continue };
        let level = V3::new(along.y, -along.x, 0.0).try_normalize(0.3).unwrap_or_else(V3::x);
        let across = along.cross(&level).normalize();
        let first = bands.positions.len();
        for sides in [across, level] {
            let shift = sides * half * 0.6;
            bands.positions.extend([pair[0] - shift, pair[1] - shift, pair[1] + shift, pair[0] + shift]);
        }
        bands
            .triangles
            .extend([0, 4].map(|face| first + face).into_iter().flat_map(|a| [[a, a + 1, a + 2], [a, a + 2, a + 3]]));
    }
}

/// Greatest and least extent of an outline, to the front and to the back.
pub(crate) fn depth_range(outline: &Outline) -> (f64, f64) {
    let (low, high) = outline.bounds();
    (high.y, low.y)
}

/// Sections above `z` are those of the whole mesh.
pub(crate) fn above(mesh: &TriMesh, z: f64) -> TriMesh {
    let reaches = |triangle: &&[usize; 3]| triangle.iter().any(|&vertex| mesh.positions[vertex].z > z);
    TriMesh { positions: mesh.positions.clone(), triangles: mesh.triangles.iter().filter(reaches).copied().collect() }
}
