//! Orientable manifold from what a scanner joined wrongly: inverted, duplicate and branching triangles, and touching
//! vertices.

use geom::TriMesh;

/// Makes a mesh a manifold: every edge has at most two triangles, which traverse it in opposite directions, and the
/// triangles round every vertex form one fan. Returns the number of triangles that were dropped.
pub(super) fn make_manifold(mesh: &mut TriMesh) -> usize {
    let before = mesh.triangles.len();
    drop_doubles(mesh);
    drop_branches(mesh);
    orient(mesh);
    drop_twisted(mesh);
    part_fans(mesh);
    before - mesh.triangles.len()
}

/// Undirected edges with their triangles, sorted.
fn edges(mesh: &TriMesh) -> Vec<([usize; 2], usize)> {
    let sides =
        |(i, &[a, b, c]): (usize, &[usize; 3])| [[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], i));
    let mut edges: Vec<_> = mesh.triangles.iter().enumerate().flat_map(sides).collect();
    edges.sort_unstable();
    edges
}

fn keep(mesh: &mut TriMesh, kept: &[bool]) {
    let mut flags = kept.iter();
    mesh.triangles.retain(|_| flags.next().copied().unwrap_or(true));
}

fn drop_doubles(mesh: &mut TriMesh) {
    let corners = |mut triangle: [usize; 3]| {
        triangle.sort_unstable();
        triangle
    };
    let mut all: Vec<([usize; 3], usize)> = mesh.triangles.iter().enumerate().map(|(i, t)| (corners(*t), i)).collect();
    all.sort_unstable();
    let mut kept = vec![true; all.len()];
    all.windows(2).filter(|pair| pair[0].0 == pair[1].0).for_each(|pair| kept[pair[1].1] = false);
    all.iter().filter(|([a, b, c], _)| a == b || b == c).for_each(|(_, i)| kept[*i] = false);
    keep(mesh, &kept);
}

/// Drops the triangles at edges where more than two meet. The resulting holes are closed as others are.
fn drop_branches(mesh: &mut TriMesh) {
    let mut kept = vec![true; mesh.triangles.len()];
    for group in edges(mesh).chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 2) {
        group.iter().for_each(|(_, triangle)| kept[*triangle] = false);
    }
    keep(mesh, &kept);
}

/// Orients the triangles of each piece in the way of the majority.
fn orient(mesh: &mut TriMesh) {
    let mut joined: Vec<Vec<(usize, bool)>> = vec![Vec::new(); mesh.triangles.len()];
    let runs = |triangle: usize, [a, b]: [usize; 2]| {
        let [p, q, r] = mesh.triangles[triangle];
        [[p, q], [q, r], [r, p]].contains(&[a, b])
    };
    for pair in edges(mesh).windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        let [(edge, a), (_, b)] = [pair[0], pair[1]];
        let alike = runs(a, edge) != runs(b, edge);
        joined[a].push((b, alike));
        joined[b].push((a, alike));
    }
    let mut turned: Vec<Option<bool>> = vec![None; mesh.triangles.len()];
    for start in 0..turned.len() {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let mut piece = vec![start];
        let mut next = 0;
        while next < piece.len() {
            let at = piece[next];
            next += 1;
            for &(other, alike) in &joined[at] {
                if turned[other].is_none() {
                    turned[other] = turned[at].map(|turned| turned == alike);
                    piece.push(other);
                }
            }
        }
        let most = 2 * piece.iter().filter(|&&i| turned[i] == Some(true)).count() > piece.len();
        piece.iter().filter(|&&i| turned[i] == Some(!most)).for_each(|&i| mesh.triangles[i].reverse());
    }
}

/// Drops triangles of one-sided pieces: those that still traverse an edge in the same direction as another triangle.
fn drop_twisted(mesh: &mut TriMesh) {
    let sides = |(i, &[a, b, c]): (usize, &[usize; 3])| [([a, b], i), ([b, c], i), ([c, a], i)];
    let mut directed: Vec<([usize; 2], usize)> = mesh.triangles.iter().enumerate().flat_map(sides).collect();
    directed.sort_unstable();
    let mut kept = vec![true; mesh.triangles.len()];
    directed.windows(2).filter(|pair| pair[0].0 == pair[1].0).for_each(|pair| kept[pair[1].1] = false);
    keep(mesh, &kept);
}

/// Gives every fan of triangles its own vertex where several fans touch.
fn part_fans(mesh: &mut TriMesh) {
    let mut around: Vec<Vec<usize>> = vec![Vec::new(); mesh.positions.len()];
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        triangle.iter().for_each(|&vertex| around[vertex].push(i));
    }
    for (vertex, triangles) in around.into_iter().enumerate() {
        let mut left = triangles;
        let mut first = true;
        while let Some(start) = left.pop() {
            let mut fan = vec![start];
            let mut next = 0;
            while next < fan.len() {
                let corners = mesh.triangles[fan[next]];
                next += 1;
                let shares = |other: &[usize; 3]| other.iter().any(|v| *v != vertex && corners.contains(v));
                let (joined, apart) = left.iter().partition(|&&i| shares(&mesh.triangles[i]));
                fan.extend::<Vec<usize>>(joined);
                left = apart;
            }
            if !first {
                let fresh = mesh.positions.len();
                mesh.positions.push(mesh.positions[vertex]);
                for i in fan {
                    mesh.triangles[i].iter_mut().filter(|corner| **corner == vertex).for_each(|corner| *corner = fresh);
                }
            }
            first = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::shapes;

    #[test]
    fn a_spoilt_sphere_becomes_one_surface() {
        let clean = shapes::sphere(1.0, 12);
        let check = |spoil: &dyn Fn(&mut TriMesh), dropped: usize| {
            let mut mesh = clean.clone();
            spoil(&mut mesh);
            assert_eq!(make_manifold(&mut mesh), dropped);
            let mut directed: Vec<[usize; 2]> =
                mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
            directed.sort_unstable();
            assert!(directed.windows(2).all(|pair| pair[0] != pair[1]));
            assert!(mesh.volume() > 0.9 * clean.volume());
        };
        check(&|_| {}, 0);
        check(&|mesh| mesh.triangles[7].reverse(), 0);
        check(&|mesh| mesh.triangles.push(mesh.triangles[3]), 1);
        check(&|mesh| mesh.triangles.push([5, 5, 6]), 1);
        // A fin on an edge: it goes, with the two triangles that the edge had.
        check(
            &|mesh| {
                let [a, b, _] = mesh.triangles[20];
                mesh.positions.push(mesh.positions[a] * 1.2);
                mesh.triangles.push([a, b, mesh.positions.len() - 1]);
            },
            3,
        );
    }

    #[test]
    fn two_pieces_that_touch_in_a_vertex_are_parted() {
        let mut mesh = shapes::sphere(1.0, 6);
        let (count, triangles) = (mesh.positions.len(), mesh.triangles.clone());
        let shift = mesh.positions[0] * 2.0;
        mesh.positions.extend(mesh.positions.clone().iter().map(|p| shift - p));
        mesh.triangles.extend(triangles.iter().map(|t| t.map(|i| if i == 0 { 0 } else { i + count })));
        assert_eq!(make_manifold(&mut mesh), 0);
        assert_eq!(mesh.positions.len(), 2 * count + 1);
        assert!(mesh.is_closed_manifold());
    }
}
