//! Segmentation (5.2.2): the patch of a surface inside a closed loop of paths, cut out along them.

use std::collections::{BTreeMap, BTreeSet};

use super::path::PathGraph;
use geom::{TriMesh, V3};

pub struct Patch {
    /// Along a cut each side has its own copy of the vertices.
    pub mesh: TriMesh,
    /// In the order of the loop that cut it out.
    pub boundary: Vec<usize>,
    pub face_of: Vec<usize>,
}

/// Cuts out the patch on the left of a closed loop of nodes, seen from outside. A loop may run along a stretch twice,
/// forth and back, which cuts a tube open. Fails where the loop crosses itself or does not bound a disc.
pub fn cut(graph: &PathGraph, nodes: &[usize]) -> Result<Patch, &'static str> {
    let barriers: BTreeSet<[usize; 2]> = steps(nodes).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    let (triangles, face_of) = conforming(graph, &barriers)?;
    let mut across: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for (index, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            across.insert([t[k], t[(k + 1) % 3]], index);
        }
    }
    let inside = flood(&triangles, &across, &barriers, steps(nodes).filter_map(|step| across.get(&step).copied()));
    let opened = Opened::new(graph, &triangles, &across, &barriers, &inside);
    let boundary = opened.walk(nodes, &triangles, &across, &barriers)?;
    let kept = (0..triangles.len()).filter(|&t| inside[t]);
    let mesh = TriMesh { positions: opened.positions, triangles: kept.clone().map(|t| opened.corners[t]).collect() };
    let euler = mesh.positions.len() + mesh.triangles.len();
    if euler != mesh.edges().len() + 1 {
        return Err("its outline does not bound a disc of the body's surface");
    }
    Ok(Patch { mesh, boundary, face_of: kept.map(|t| face_of[t]).collect() })
}

fn steps(nodes: &[usize]) -> impl Iterator<Item = [usize; 2]> + '_ {
    (0..nodes.len()).map(|i| [nodes[i], nodes[(i + 1) % nodes.len()]])
}

/// Triangles over nodes, and their faces. Faces that barriers cross are divided so that every barrier is an edge.
type Conforming = (Vec<[usize; 3]>, Vec<usize>);

fn conforming(graph: &PathGraph, barriers: &BTreeSet<[usize; 2]>) -> Result<Conforming, &'static str> {
    let used: BTreeSet<usize> = barriers.iter().flatten().copied().collect();
    let mut chords: BTreeMap<usize, Vec<[usize; 2]>> = BTreeMap::new();
    for &[a, b] in barriers {
        if graph.common_edge(a, b).is_none() {
            let face = graph.faces(a).iter().find(|f| graph.faces(b).contains(f));
            let face = face.ok_or("its outline leaves the surface")?;
            chords.entry(*face).or_default().push([a, b]);
        }
    }
    let mut triangles = Vec::new();
    let mut face_of = Vec::new();
    for (face, corners) in graph.mesh().triangles.iter().enumerate() {
        let ring: Vec<usize> =
            graph.ring(face).into_iter().filter(|n| corners.contains(n) || used.contains(n)).collect();
        let parts = divide(ring, chords.get(&face).map_or(&[][..], Vec::as_slice))?;
        for part in parts {
            let filled = fill(graph, part);
            face_of.extend(filled.iter().map(|_| face));
            triangles.extend(filled);
        }
    }
    Ok((triangles, face_of))
}

fn divide(ring: Vec<usize>, chords: &[[usize; 2]]) -> Result<Vec<Vec<usize>>, &'static str> {
    let Some((&[a, b], rest)) = chords.split_first() else { return Ok(vec![ring]) };
    let place = |n: usize| ring.iter().position(|&m| m == n);
    let (Some(i), Some(j)) = (place(a), place(b)) else { return Err("its outline crosses itself") };
    let (i, j) = (i.min(j), i.max(j));
    let halves = [ring[i..=j].to_vec(), [&ring[j..], &ring[..=i]].concat()];
    let mut parts = Vec::new();
    let mut placed = 0;
    for half in halves {
        let own: Vec<_> = rest.iter().filter(|c| c.iter().all(|n| half.contains(n))).copied().collect();
        placed += own.len();
        parts.extend(divide(half, &own)?);
    }
    if placed < rest.len() { Err("its outline crosses itself") } else { Ok(parts) }
}

/// Triangulates a convex polygon, which may have corners of 180 degrees, by ear clipping, the best ear first.
fn fill(graph: &PathGraph, mut ring: Vec<usize>) -> Vec<[usize; 3]> {
    let area = |t: [usize; 3]| {
        let [a, b, c] = t.map(|n| graph.position(n));
        (b - a).cross(&(c - a)).norm()
    };
    let quality = |t: [usize; 3]| {
        let [a, b, c] = t.map(|n| graph.position(n));
        area(t) / ((b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared())
    };
    let total = |ring: &[usize]| (2..ring.len()).map(|k| area([ring[0], ring[k - 1], ring[k]])).sum::<f64>();
    let mut triangles = Vec::with_capacity(ring.len());
    while ring.len() > 3 {
        let whole = total(&ring);
        let n = ring.len();
        let ear = |i: usize| [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]];
        // An ear must not leave a polygon without area.
        let worth = |i: &usize| if whole - area(ear(*i)) > 1e-9 * whole { quality(ear(*i)) } else { -1.0 };
        let best = (0..n).max_by(|i, j| worth(i).total_cmp(&worth(j))).unwrap_or(0);
        triangles.push(ear(best));
        ring.remove(best);
    }
    triangles.push([ring[0], ring[1], ring[2]]);
    triangles
}

fn flood(
    triangles: &[[usize; 3]],
    across: &BTreeMap<[usize; 2], usize>,
    barriers: &BTreeSet<[usize; 2]>,
    seeds: impl Iterator<Item = usize>,
) -> Vec<bool> {
    let mut inside = vec![false; triangles.len()];
    let mut open: Vec<usize> = seeds.collect();
    while let Some(t) = open.pop() {
        if std::mem::replace(&mut inside[t], true) {
            continue;
        }
        for k in 0..3 {
            let (a, b) = (triangles[t][k], triangles[t][(k + 1) % 3]);
            if !barriers.contains(&[a.min(b), a.max(b)])
                && let Some(&next) = across.get(&[b, a])
            {
                open.push(next);
            }
        }
    }
    inside
}

/// Triangles inside, with vertices doubled along the barriers.
struct Opened {
    positions: Vec<V3>,
    corners: Vec<[usize; 3]>,
}

impl Opened {
    fn new(
        graph: &PathGraph,
        triangles: &[[usize; 3]],
        across: &BTreeMap<[usize; 2], usize>,
        barriers: &BTreeSet<[usize; 2]>,
        inside: &[bool],
    ) -> Self {
        let mut opened = Self { positions: Vec::new(), corners: vec![[usize::MAX; 3]; triangles.len()] };
        for t in (0..triangles.len()).filter(|&t| inside[t]) {
            for k in 0..3 {
                if opened.corners[t][k] != usize::MAX {
                    continue;
                }
                let node = triangles[t][k];
                let vertex = opened.positions.len();
                opened.positions.push(graph.position(node));
                // Every triangle of the fan round the node, up to the barriers.
                let mut open = vec![t];
                while let Some(t) = open.pop() {
                    let corner = triangles[t].iter().position(|&n| n == node);
                    let Some(corner) = corner.filter(|&c| opened.corners[t][c] == usize::MAX) else { continue };
                    opened.corners[t][corner] = vertex;
                    let (next, last) = (triangles[t][(corner + 1) % 3], triangles[t][(corner + 2) % 3]);
                    for (edge, other) in [([next, node], next), ([node, last], last)] {
                        if !barriers.contains(&[node.min(other), node.max(other)])
                            && let Some(&beyond) = across.get(&edge)
                        {
                            open.push(beyond);
                        }
                    }
                }
            }
        }
        opened
    }

    /// New vertices along the loop: each step is a side of exactly one triangle inside, on its left.
    fn walk(
        &self,
        nodes: &[usize],
        triangles: &[[usize; 3]],
        across: &BTreeMap<[usize; 2], usize>,
        barriers: &BTreeSet<[usize; 2]>,
    ) -> Result<Vec<usize>, &'static str> {
        let boundary: Option<Vec<usize>> = steps(nodes)
            .map(|step| {
                let t = *across.get(&step)?;
                let k = triangles[t].iter().position(|&n| n == step[0])?;
                Some(self.corners[t][k])
            })
            .collect();
        let boundary = boundary.ok_or("its outline runs along the surface's edge")?;
        let distinct: BTreeSet<usize> = boundary.iter().copied().collect();
        let sides = barriers.len();
        if distinct.len() < boundary.len() || sides > nodes.len() {
            return Err("its outline touches itself");
        }
        Ok(boundary)
    }
}
