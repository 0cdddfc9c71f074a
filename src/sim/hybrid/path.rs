//! Approximate geodesics on a coarse surface (5.2.2): shortest paths over its vertices and points set evenly on its
//! edges.
//!
//! Within a face a path runs straight from any side to any other, so that even a coarse mesh has nearly geodesic paths.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

use geom::{TriMesh, V3};

/// Triangle mesh whose edges carry extra nodes. Nodes are numbered: vertices first, then the points of each edge.
pub struct PathGraph<'a> {
    mesh: &'a TriMesh,
    /// Points on each edge [T: subdivision level].
    points: usize,
    edges: Vec<[usize; 2]>,
    /// Edge from corner k to corner k + 1 of each face.
    sides: Vec<[usize; 3]>,
    faces_of_edge: Vec<Vec<usize>>,
    faces_of_vertex: Vec<Vec<usize>>,
}

/// Nodes of earlier paths and their chords through faces, as obstacles. Paths that divide a surface into patches meet
/// in their ends only.
#[derive(Clone, Debug, Default)]
pub struct Taken {
    nodes: BTreeSet<usize>,
    chords: BTreeMap<usize, Vec<[usize; 2]>>,
}

impl Taken {
    pub fn add_node(&mut self, node: usize) {
        self.nodes.insert(node);
    }

    pub fn add(&mut self, graph: &PathGraph, path: &[usize]) {
        self.nodes.extend(path);
        for ends in path.windows(2) {
            if graph.common_edge(ends[0], ends[1]).is_none() {
                let face = graph.faces(ends[0]).iter().find(|f| graph.faces(ends[1]).contains(f));
                self.chords.entry(face.copied().unwrap_or(usize::MAX)).or_default().push([ends[0], ends[1]]);
            }
        }
    }

    fn crosses(&self, graph: &PathGraph, face: usize, a: usize, b: usize) -> bool {
        let Some(chords) = self.chords.get(&face) else { return false };
        let ring = graph.ring(face);
        let place = |n: usize| ring.iter().position(|&m| m == n).unwrap_or(0);
        let (from, to) = (place(a).min(place(b)), place(a).max(place(b)));
        let between = |n: usize| (from + 1..to).contains(&place(n));
        chords.iter().any(|&[c, d]| ![c, d].contains(&a) && ![c, d].contains(&b) && between(c) != between(d))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Vertex(usize),
    /// Number of the edge, and which of its points.
    Edge(usize, usize),
}

impl<'a> PathGraph<'a> {
    pub fn new(mesh: &'a TriMesh, points: usize) -> Self {
        let mut number = BTreeMap::new();
        let mut edges = Vec::new();
        let mut faces_of_edge: Vec<Vec<usize>> = Vec::new();
        let mut faces_of_vertex = vec![Vec::new(); mesh.positions.len()];
        let mut sides = Vec::with_capacity(mesh.triangles.len());
        for (face, t) in mesh.triangles.iter().enumerate() {
            sides.push([0, 1, 2].map(|k| {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                faces_of_vertex[a].push(face);
                let edge = *number.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    edges.push([a.min(b), a.max(b)]);
                    faces_of_edge.push(Vec::new());
                    edges.len() - 1
                });
                faces_of_edge[edge].push(face);
                edge
            }));
        }
        Self { mesh, points, edges, sides, faces_of_edge, faces_of_vertex }
    }

    pub fn len(&self) -> usize {
        self.mesh.positions.len() + self.edges.len() * self.points
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub fn mesh(&self) -> &TriMesh {
        self.mesh
    }

    pub fn place(&self, node: usize) -> Place {
        match node.checked_sub(self.mesh.positions.len()) {
            None => Place::Vertex(node),
            Some(k) => Place::Edge(k / self.points, k % self.points),
        }
    }

    pub fn position(&self, node: usize) -> V3 {
        match self.place(node) {
            Place::Vertex(v) => self.mesh.positions[v],
            Place::Edge(edge, k) => {
                let [a, b] = self.edges[edge].map(|v| self.mesh.positions[v]);
                a.lerp(&b, (k + 1) as f64 / (self.points + 1) as f64)
            }
        }
    }

    pub fn faces(&self, node: usize) -> &[usize] {
        match self.place(node) {
            Place::Vertex(v) => &self.faces_of_vertex[v],
            Place::Edge(edge, _) => &self.faces_of_edge[edge],
        }
    }

    /// In order from corner `from`, both ends included.
    pub(super) fn edge_nodes(&self, edge: usize, from: usize) -> Vec<usize> {
        let [a, b] = self.edges[edge];
        let first = self.mesh.positions.len() + edge * self.points;
        let mut nodes = vec![a];
        nodes.extend(first..first + self.points);
        nodes.push(b);
        if a != from {
            nodes.reverse();
        }
        nodes
    }

    /// Nodes round a face, counter-clockwise from its first corner.
    pub fn ring(&self, face: usize) -> Vec<usize> {
        let t = self.mesh.triangles[face];
        (0..3)
            .flat_map(|k| {
                let mut nodes = self.edge_nodes(self.sides[face][k], t[k]);
                nodes.pop();
                nodes
            })
            .collect()
    }

    /// Node of the given faces nearest to a point; `None` without faces.
    pub fn nearest(&self, point: &V3, faces: impl Fn(usize) -> bool) -> Option<usize> {
        let distance = |node: usize| (self.position(node) - point).norm_squared();
        let candidates = (0..self.len()).filter(|&node| self.faces(node).iter().any(|&f| faces(f)));
        candidates.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }

    /// Full search [T Algorithm 5.2]: Dijkstra over every face, until `to` is reached.
    pub fn shortest(&self, from: usize, to: usize) -> Option<Vec<usize>> {
        self.search(from, to, |_| true, |_| 0.0, &Taken::default())
    }

    /// Fast, oriented search (5.2.2): A* over the faces that the piece can touch, clear of taken paths, with the
    /// straight distance to the goal as lower bound.
    pub fn shortest_within(
        &self,
        from: usize,
        to: usize,
        faces: impl Fn(usize) -> bool,
        taken: &Taken,
    ) -> Option<Vec<usize>> {
        let goal = self.position(to);
        self.search(from, to, faces, |node| (self.position(node) - goal).norm(), taken)
    }

    fn search(
        &self,
        from: usize,
        to: usize,
        allowed: impl Fn(usize) -> bool,
        bound: impl Fn(usize) -> f64,
        taken: &Taken,
    ) -> Option<Vec<usize>> {
        let mut length = vec![f64::INFINITY; self.len()];
        let mut parent = vec![usize::MAX; self.len()];
        let mut done = vec![false; self.len()];
        let mut queue = BinaryHeap::new();
        length[from] = 0.0;
        // Lengths are not negative, so their bits sort in the same order.
        queue.push(Reverse((bound(from).to_bits(), from)));
        while let Some(Reverse((_, node))) = queue.pop() {
            if node == to {
                let mut path = vec![to];
                while let Some(&last) = path.last()
                    && last != from
                {
                    path.push(parent[last]);
                }
                path.reverse();
                return Some(path);
            }
            if std::mem::replace(&mut done[node], true) {
                continue;
            }
            let here = self.position(node);
            for &face in self.faces(node).iter().filter(|&&f| allowed(f)) {
                self.for_neighbours(face, node, |next| {
                    if done[next] || (next != to && taken.nodes.contains(&next)) {
                        return;
                    }
                    let through = length[node] + (self.position(next) - here).norm();
                    if through < length[next] && !taken.crosses(self, face, node, next) {
                        length[next] = through;
                        parent[next] = node;
                        queue.push(Reverse(((through + bound(next)).to_bits(), next)));
                    }
                });
            }
        }
        None
    }

    /// Visits the nodes that a path can go to from `node` within a face: the next ones along its own sides, all on the
    /// others.
    fn for_neighbours(&self, face: usize, node: usize, mut visit: impl FnMut(usize)) {
        let vertices = self.mesh.positions.len();
        let t = self.mesh.triangles[face];
        for k in 0..3 {
            let edge = self.sides[face][k];
            let first = vertices + edge * self.points;
            let [a, b] = self.edges[edge];
            let on_edge = match self.place(node) {
                Place::Vertex(v) => v == a || v == b,
                Place::Edge(e, _) => e == edge,
            };
            if !on_edge {
                (first..first + self.points).for_each(&mut visit);
                continue;
            }
            let index = if node == a {
                0
            } else if node == b {
                self.points + 1
            } else {
                node - first + 1
            };
            let nth = |i: usize| match i {
                0 => a,
                i if i == self.points + 1 => b,
                i => first + i - 1,
            };
            if index > 0 {
                visit(nth(index - 1));
            }
            if index < self.points + 1 {
                visit(nth(index + 1));
            }
        }
        if let Place::Edge(edge, _) = self.place(node) {
            // The opposite corner.
            t.into_iter().filter(|v| !self.edges[edge].contains(v)).for_each(visit);
        }
    }

    pub fn length(&self, path: &[usize]) -> f64 {
        path.windows(2).map(|ends| (self.position(ends[1]) - self.position(ends[0])).norm()).sum()
    }

    pub(super) fn common_edge(&self, a: usize, b: usize) -> Option<usize> {
        let on = |node: usize, edge: usize| match self.place(node) {
            Place::Vertex(v) => self.edges[edge].contains(&v),
            Place::Edge(e, _) => e == edge,
        };
        let sides = self.faces(a).iter().flat_map(|&face| self.sides[face]);
        sides.into_iter().find(|&edge| on(a, edge) && on(b, edge))
    }
}
