//! Self-intersections of a triangle mesh.

use super::{TriMesh, V3};

/// Pairs of triangles that intersect each other without sharing an edge, the lesser index first, sorted. Triangles that
/// only touch do not count.
///
/// Sweeps over the heights of the triangles, and compares each triangle only with those of overlapping height.
pub fn self_crossings(mesh: &TriMesh) -> Vec<[usize; 2]> {
    let boxes: Vec<(V3, V3)> = mesh.triangles.iter().map(|triangle| bounds(mesh, triangle)).collect();
    let mut upward: Vec<usize> = (0..boxes.len()).collect();
    upward.sort_by(|&a, &b| boxes[a].0.z.total_cmp(&boxes[b].0.z));
    let apart = |a: usize, b: usize| (0..3).any(|k| boxes[a].1[k] < boxes[b].0[k] || boxes[b].1[k] < boxes[a].0[k]);
    let mut found = Vec::new();
    for (i, &a) in upward.iter().enumerate() {
        let beside = upward[i + 1..].iter().take_while(|&&b| boxes[b].0.z <= boxes[a].1.z);
        found.extend(beside.filter(|&&b| !apart(a, b) && cross(mesh, a, b)).map(|&b| [a.min(b), a.max(b)]));
    }
    found.sort_unstable();
    found
}

fn bounds(mesh: &TriMesh, triangle: &[usize; 3]) -> (V3, V3) {
    let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex]);
    (a.inf(&b).inf(&c), a.sup(&b).sup(&c))
}

/// True if an edge of one triangle pierces the other, apart from edges that end in a corner of the other.
fn cross(mesh: &TriMesh, a: usize, b: usize) -> bool {
    let (first, second) = (mesh.triangles[a], mesh.triangles[b]);
    if first.iter().filter(|vertex| second.contains(vertex)).count() > 1 {
        return false;
    }
    let pierces = |edges: [usize; 3], face: [usize; 3]| {
        (0..3).map(|k| [edges[k], edges[(k + 1) % 3]]).any(|edge| {
            let apart = edge.iter().all(|vertex| !face.contains(vertex));
            apart && segment_hits(edge.map(|v| mesh.positions[v]), face.map(|v| mesh.positions[v]))
        })
    };
    pierces(first, second) || pierces(second, first)
}

/// Tests the interior of the triangle, by the signs of the volumes of the tetrahedra that both span.
fn segment_hits([p, q]: [V3; 2], [a, b, c]: [V3; 3]) -> bool {
    let volume = |u: V3, v: V3, w: V3, z: V3| (v - u).cross(&(w - u)).dot(&(z - u));
    if volume(a, b, c, p) * volume(a, b, c, q) >= 0.0 {
        return false;
    }
    let sides = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn a_spike_through_the_far_side_crosses_it() {
        let mut ball = shapes::sphere(1.0, 8);
        assert_eq!(self_crossings(&ball), Vec::<[usize; 2]>::new());
        let count = ball.positions.len();
        ball.positions[count / 2] *= -1.4;
        assert!(!self_crossings(&ball).is_empty());
    }
}
