//! Removal of stray pieces and of the floor from a scan.

use geom::{TriMesh, V3};
use nalgebra::{Matrix3, SymmetricEigen};

/// Share of the body's area below which a piece is noise. Judgement: a greater one drops a separate head.
const LEAST_SHARE: f64 = 0.05;

/// Area of a second piece as a share of the body's, above which it is another body. Judgement.
const SECOND_BODY: f64 = 0.5;

/// Least / greatest standard deviation below which a piece is flat: a floor or a wall. Judgement.
const FLAT: f64 = 0.02;

/// Greatest sine of the tilt of a floor triangle, and thickness of a floor / stature. Judgement.
const FLOOR_TILT: f64 = 0.2;
const FLOOR_THICKNESS: f64 = 0.008;

/// Least area of a floor, divided by squared stature. Two soles have less.
const FLOOR_AREA: f64 = 0.025;

/// Keeps the piece of greatest area that is not flat, and other large pieces that are not flat, such as a head that a
/// gap separates from its trunk. Notes what was left out.
pub(crate) fn keep_body(mesh: &TriMesh, notes: &mut Vec<String>) -> TriMesh {
    let pieces = pieces(mesh);
    if pieces.len() == 1 {
        return used_part(mesh, &mesh.triangles);
    }
    let areas: Vec<f64> = pieces.iter().map(|piece| area(mesh, piece)).collect();
    let flat: Vec<bool> = pieces.iter().map(|piece| is_flat(mesh, piece)).collect();
    let body = areas.iter().zip(&flat).filter(|(_, flat)| !**flat).map(|(area, _)| *area).fold(0.0, f64::max);
    let kept = |i: &usize| body == 0.0 || !flat[*i] && areas[*i] >= LEAST_SHARE * body;
    let triangles: Vec<[usize; 3]> = (0..pieces.len()).filter(kept).flat_map(|i| pieces[i].iter().copied()).collect();
    let dropped = (0..pieces.len()).filter(|i| !kept(i)).count();
    if dropped > 0 {
        notes.push(format!("{dropped} pieces apart from the body were left out (strays, floor)"));
    }
    used_part(mesh, &triangles)
}

/// True if a mesh has a second piece of nearly the size of the body that is not flat.
pub(crate) fn several(mesh: &TriMesh) -> bool {
    let mut areas: Vec<f64> =
        pieces(mesh).iter().filter(|piece| !is_flat(mesh, piece)).map(|piece| area(mesh, piece)).collect();
    areas.sort_by(|a, b| b.total_cmp(a));
    areas.get(1).is_some_and(|second| *second > SECOND_BODY * areas[0])
}

/// Removes the floor that is joined to the feet of an upright body. `None` without a floor.
pub(crate) fn drop_floor(mesh: &TriMesh, notes: &mut Vec<String>) -> Option<TriMesh> {
    let (low, high) = mesh.bounds()?;
    let stature = high.z - low.z;
    let is_ground = |triangle: &[usize; 3]| {
        let [a, b, c] = triangle.map(|i| mesh.positions[i]);
        let normal = (b - a).cross(&(c - a));
        let level = a.z.max(b.z).max(c.z) - low.z;
        level < FLOOR_THICKNESS * stature && normal.xy().norm() < FLOOR_TILT * normal.norm()
    };
    let ground: Vec<[usize; 3]> = mesh.triangles.iter().filter(|t| is_ground(t)).copied().collect();
    if area(mesh, &ground) < FLOOR_AREA * stature * stature {
        return None;
    }
    notes.push("the floor under the feet was cut off".to_owned());
    let rest: Vec<[usize; 3]> = mesh.triangles.iter().filter(|t| !is_ground(t)).copied().collect();
    Some(keep_body(&used_part(mesh, &rest), notes))
}

/// Triangles of a mesh by connected piece, in the order of their first vertices.
fn pieces(mesh: &TriMesh) -> Vec<Vec<[usize; 3]>> {
    let mut parent: Vec<usize> = (0..mesh.positions.len()).collect();
    for &[a, b, c] in &mesh.triangles {
        for other in [b, c] {
            let (x, y) = (root(&mut parent, a), root(&mut parent, other));
            parent[x.max(y)] = x.min(y);
        }
    }
    let mut number = vec![usize::MAX; mesh.positions.len()];
    let mut pieces: Vec<Vec<[usize; 3]>> = Vec::new();
    for triangle in &mesh.triangles {
        let root = root(&mut parent, triangle[0]);
        if number[root] == usize::MAX {
            number[root] = pieces.len();
            pieces.push(Vec::new());
        }
        pieces[number[root]].push(*triangle);
    }
    pieces
}

/// Root of a vertex in the disjoint-set forest, with path halving.
fn root(parent: &mut [usize], mut vertex: usize) -> usize {
    while parent[vertex] != vertex {
        parent[vertex] = parent[parent[vertex]];
        vertex = parent[vertex];
    }
    vertex
}

fn area(mesh: &TriMesh, triangles: &[[usize; 3]]) -> f64 {
    triangles.iter().map(|&[a, b, c]| corner_cross(mesh, a, b, c).norm() / 2.0).sum()
}

fn corner_cross(mesh: &TriMesh, a: usize, b: usize, c: usize) -> V3 {
    (mesh.positions[b] - mesh.positions[a]).cross(&(mesh.positions[c] - mesh.positions[a]))
}

fn is_flat(mesh: &TriMesh, triangles: &[[usize; 3]]) -> bool {
    let spread = principal_axes(mesh, triangles).map(|(variances, _)| variances.map(f64::sqrt));
    spread.is_none_or(|spread| spread[2] < FLAT * spread[0])
}

/// Variances of a surface along its principal axes, the greatest first, and these axes, weighted by area.
pub(crate) fn principal_axes(mesh: &TriMesh, triangles: &[[usize; 3]]) -> Option<([f64; 3], [V3; 3])> {
    let weighted: Vec<(f64, V3)> = triangles
        .iter()
        .map(|&[a, b, c]| {
            let centre = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3.0;
            (corner_cross(mesh, a, b, c).norm(), centre)
        })
        .collect();
    let weight: f64 = weighted.iter().map(|(w, _)| w).sum();
    if weight.is_nan() || weight <= 0.0 {
        return None;
    }
    let mean = weighted.iter().map(|(w, p)| p * *w).sum::<V3>() / weight;
    let covariance =
        weighted.iter().map(|(w, p)| (p - mean) * (p - mean).transpose() * *w).sum::<Matrix3<f64>>() / weight;
    let eigen = SymmetricEigen::new(covariance);
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    let axis = |i: usize| V3::from(eigen.eigenvectors.column(i));
    Some((order.map(|i| eigen.eigenvalues[i].max(0.0)), order.map(axis)))
}

pub(crate) fn used_part(mesh: &TriMesh, triangles: &[[usize; 3]]) -> TriMesh {
    let mut number = vec![usize::MAX; mesh.positions.len()];
    let mut part = TriMesh::default();
    for triangle in triangles {
        let renamed = triangle.map(|vertex| {
            if number[vertex] == usize::MAX {
                number[vertex] = part.positions.len();
                part.positions.push(mesh.positions[vertex]);
            }
            number[vertex]
        });
        part.triangles.push(renamed);
    }
    part
}
