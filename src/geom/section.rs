//! Plane sections of triangle meshes.

use super::{TriMesh, V2, V3};

/// Plane with a frame. Its points are `origin + p.x u + p.y v`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    pub origin: V3,
    /// Unit vector.
    pub u: V3,
    /// Unit vector at right angles to `u`.
    pub v: V3,
}

impl Plane {
    pub fn horizontal(z: f64) -> Self {
        Self { origin: V3::new(0.0, 0.0, z), u: V3::x(), v: V3::y() }
    }

    /// Plane through `origin` with the unit vector `normal`. The first axis is horizontal.
    pub fn normal_to(origin: V3, normal: V3) -> Self {
        let horizontal = V3::new(normal.y, -normal.x, 0.0).try_normalize(1e-9).unwrap_or_else(V3::x);
        let u = if horizontal.x < 0.0 { -horizontal } else { horizontal };
        Self { origin, u, v: normal.cross(&u) }
    }

    /// Unit normal: `u` cross `v`.
    pub fn normal(&self) -> V3 {
        self.u.cross(&self.v)
    }

    /// Signed distance, m, positive on the side of the normal.
    pub fn distance(&self, point: V3) -> f64 {
        (point - self.origin).dot(&self.normal())
    }

    pub fn project(&self, point: V3) -> V2 {
        let offset = point - self.origin;
        V2::new(offset.dot(&self.u), offset.dot(&self.v))
    }

    pub fn lift(&self, p: V2) -> V3 {
        self.origin + self.u * p.x + self.v * p.y
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Plane coordinates; the first point is not repeated.
    pub points: Vec<V2>,
    /// An open outline ends at a hole of the mesh.
    pub closed: bool,
}

impl Outline {
    pub fn bounds(&self) -> (V2, V2) {
        let first = self.points.first().copied().unwrap_or_else(V2::zeros);
        self.points.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
    }

    /// Even-odd rule. An open outline is closed by a chord.
    pub fn contains(&self, point: V2) -> bool {
        let next = self.points.iter().cycle().skip(1);
        let crossings = self.points.iter().zip(next).filter(|(a, b)| {
            (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
        });
        crossings.count() % 2 == 1
    }
}

/// Mesh edge that the plane cuts, the lesser vertex first.
type CutEdge = (usize, usize);

/// A vertex in the plane counts as above it. Every triangle therefore gives one segment or none, and all outlines of a
/// closed manifold close.
pub fn section(mesh: &TriMesh, plane: &Plane) -> Vec<Outline> {
    let normal = plane.normal();
    let heights: Vec<f64> = mesh.positions.iter().map(|p| (p - plane.origin).dot(&normal)).collect();
    cut(&mesh.positions, &mesh.triangles, plane, |vertex| heights[vertex])
}

pub fn section_of(positions: &[V3], triangles: &[[usize; 3]], plane: &Plane) -> Vec<Outline> {
    let normal = plane.normal();
    cut(positions, triangles, plane, |vertex| (positions[vertex] - plane.origin).dot(&normal))
}

/// `height` is the signed distance of a vertex from the plane.
fn cut(positions: &[V3], triangles: &[[usize; 3]], plane: &Plane, height: impl Fn(usize) -> f64) -> Vec<Outline> {
    let mut links: Vec<(CutEdge, CutEdge)> = Vec::new();
    for &[a, b, c] in triangles {
        let above = [height(a) >= 0.0, height(b) >= 0.0, height(c) >= 0.0];
        if above[0] == above[1] && above[1] == above[2] {
            continue;
        }
        let mut link = ((0, 0), (0, 0));
        for (from, to, up, down) in [(a, b, above[0], above[1]), (b, c, above[1], above[2]), (c, a, above[2], above[0])]
        {
            let edge = (from.min(to), from.max(to));
            match (up, down) {
                (true, false) => link.0 = edge,
                (false, true) => link.1 = edge,
                _ => {}
            }
        }
        links.push(link);
    }
    let place = |&(a, b): &CutEdge| {
        let (low, high) = (height(a), height(b));
        plane.project(positions[a] + (positions[b] - positions[a]) * (low / (low - high)))
    };
    chain(links)
        .into_iter()
        .map(|(edges, closed)| Outline { points: edges.iter().map(place).collect(), closed })
        .collect()
}

/// Connects cut edges by links. Returns chains, open ones first, with true for a closed chain.
fn chain(mut links: Vec<(CutEdge, CutEdge)>) -> Vec<(Vec<CutEdge>, bool)> {
    links.sort_unstable();
    // Where sheets of a mesh meet in an edge, the edge is cut twice, and the last link counts.
    links.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 = next.1;
        }
        same
    });
    let number = |edge: &CutEdge| links.binary_search_by_key(edge, |link| link.0).ok();
    let next: Vec<Option<usize>> = links.iter().map(|(_, to)| number(to)).collect();
    let mut is_head = vec![true; links.len()];
    for &to in next.iter().flatten() {
        is_head[to] = false;
    }
    let mut used = vec![false; links.len()];
    let heads = (0..links.len()).filter(|&i| is_head[i]);
    let mut chains = Vec::new();
    for start in heads.chain(0..links.len()) {
        if used[start] {
            continue;
        }
        let mut edges = vec![links[start].0];
        let mut at = start;
        let closed = loop {
            used[at] = true;
            match next[at] {
                Some(to) if to == start => break true,
                Some(to) if !used[to] => {
                    edges.push(links[to].0);
                    at = to;
                }
                _ => {
                    edges.push(links[at].1);
                    break false;
                }
            }
        };
        chains.push((edges, closed));
    }
    chains
}

#[cfg(test)]
mod tests {
    use super::*;

    fn octahedron() -> TriMesh {
        let positions = vec![V3::x(), V3::y(), -V3::x(), -V3::y(), V3::z(), -V3::z()];
        let triangles = (0..4).flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]]).collect();
        TriMesh { positions, triangles }
    }

    #[test]
    fn an_octahedron_is_cut_in_squares() {
        let check = |z: f64, half_diagonal: f64| {
            let outlines = section(&octahedron(), &Plane::horizontal(z));
            assert_eq!(outlines.len(), 1, "z = {z}");
            assert!(outlines[0].closed);
            let girth = crate::hull::tape_girth(&outlines[0].points);
            assert!((girth - 4.0 * half_diagonal * 2.0_f64.sqrt()).abs() < 1e-12, "z = {z}: {girth}");
        };
        check(0.0, 1.0);
        check(0.25, 0.75);
        check(-0.5, 0.5);
    }

    #[test]
    fn a_missing_triangle_leaves_an_open_outline() {
        let mut mesh = octahedron();
        mesh.triangles.remove(0);
        let outlines = section(&mesh, &Plane::horizontal(0.5));
        assert_eq!(outlines.len(), 1);
        assert!(!outlines[0].closed);
        assert_eq!(outlines[0].points.len(), 4);
    }

    #[test]
    fn a_plane_keeps_its_frame() {
        let normal = V3::new(0.0, 0.3, 0.9).normalize();
        let plane = Plane::normal_to(V3::new(0.1, 0.2, 0.3), normal);
        assert!((plane.normal() - normal).norm() < 1e-12);
        let point = plane.lift(V2::new(0.4, -0.2));
        assert!(plane.distance(point).abs() < 1e-12);
        assert!((plane.project(point) - V2::new(0.4, -0.2)).norm() < 1e-12);
        assert!(plane.u.z.abs() < 1e-12);
    }
}
