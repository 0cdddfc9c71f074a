//! Broad phase of the collision detection: the search for pairs of primitives of a cloth that are near each other and
//! share no vertex. A pair is a vertex and a triangle, or two edges.

use std::ops::Range;

use wide::f32x4;

use super::bounds::{Bounds, rounded};
use super::distance::{ClosestPoints, Primitives};
use super::grid::BoxGrid;
use super::intersections::edges_of;
use super::normal_cones::{Clusters, Motion};
use geom::V3;
use geom::triangle::sorted;
use linalg::PairList;

/// Search structure of a cloth. Pairs of clusters of primitives remember how far apart their unknown pairs of
/// primitives are at least.
pub struct BroadPhase<'a> {
    triangles: &'a [[usize; 3]],
    edges: PairList,
    clusters: Clusters,
    /// Representative of the vertices that each is sewn to.
    joined: Vec<usize>,
    seen: Vec<f32x4>,
    extents: Vec<Bounds>,
    /// Clusters near each other at the last look, except flat ones, ascending.
    near: Vec<Near>,
    /// Distance below which clusters are near.
    horizon_m: f64,
    pairs: Vec<Pair>,
}

/// Two primitives that share no vertex.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub primitives: Primitives,
    pub distance_m: f64,
}

pub struct Within {
    /// Pairs known up to it are not searched again.
    pub at_least_m: f64,
    /// Distance up to which they are searched otherwise.
    pub at_best_m: f64,
}

struct Near {
    /// Ascending; both the same for a cluster with itself.
    clusters: [usize; 2],
    apart_m: f64,
    /// Distance up to which pairs of primitives are known.
    known_m: f64,
    pairs: Range<usize>,
}

impl Near {
    fn unknown_m(&self) -> f64 {
        self.apart_m.max(self.known_m)
    }
}

impl<'a> BroadPhase<'a> {
    pub fn new(triangles: &'a [[usize; 3]], vertices: usize) -> Self {
        let edges = edges_of(triangles);
        let clusters = Clusters::new(vertices, triangles, &edges);
        let (seen, extents) = (Vec::new(), Vec::new());
        Self {
            triangles,
            edges,
            clusters,
            joined: (0..vertices).collect(),
            seen,
            extents,
            near: Vec::new(),
            horizon_m: 0.0,
            pairs: Vec::new(),
        }
    }

    pub fn join(&mut self, sewn: impl Iterator<Item = [usize; 2]>) {
        for [a, b] in sewn {
            let (kept, gone) = (self.joined[a], self.joined[b]);
            self.joined.iter_mut().filter(|v| **v == gone).for_each(|v| *v = kept);
        }
    }

    pub fn edges(&self) -> &[[usize; 2]] {
        self.edges.pairs()
    }

    pub fn triangles(&self) -> &'a [[usize; 3]] {
        self.triangles
    }

    pub fn stay_flat(&self, x: &[V3]) -> bool {
        self.clusters.stay_flat(x, self.triangles)
    }

    pub fn motion(&self, displacements: &[V3]) -> Motion {
        self.clusters.motion(displacements)
    }

    pub fn rest(&self) -> Motion {
        self.clusters.rest()
    }

    /// Near pairs of primitives at `x`, where the cloth has `made` a motion since the last look. They are known up to
    /// the distance that `within` asks for their clusters, if it is below `horizon_m`. Pairs within flat cloth are left
    /// out.
    pub fn find_pairs(
        &mut self,
        x: &[V3],
        horizon_m: f64,
        made: Option<&Motion>,
        within: impl Fn([usize; 2]) -> Within,
    ) -> &[Pair] {
        self.look(x, horizon_m, made);
        let (mut near, known) = (std::mem::take(&mut self.near), std::mem::take(&mut self.pairs));
        let mut boxes: Vec<Option<Boxes>> = self.clusters.members.iter().map(|_| None).collect();
        let mut scratch = [Vec::new(), Vec::new()];
        let mut pairs: Vec<Pair> = Vec::with_capacity(known.len());
        for near in &mut near {
            let Within { at_least_m, at_best_m } = within(near.clusters);
            let start = pairs.len();
            let is_known = near.known_m >= at_least_m;
            near.known_m = if is_known { near.known_m } else { at_best_m };
            let mut take = |primitives| {
                let distance_m = ClosestPoints::of(x, primitives).gap.norm();
                if distance_m < near.known_m {
                    pairs.push(Pair { primitives, distance_m });
                }
            };
            if is_known {
                known[near.pairs.clone()].iter().for_each(|pair| take(pair.primitives));
            } else if near.apart_m < near.known_m {
                for c in near.clusters {
                    boxes[c].get_or_insert_with(|| Boxes::new(self, c));
                }
                if let [Some(one), Some(other)] = near.clusters.map(|c| boxes[c].as_ref()) {
                    let is_one = near.clusters[0] == near.clusters[1];
                    self.between([one, other], is_one, near.known_m, &mut scratch, &mut take);
                }
            }
            near.pairs = start..pairs.len();
        }
        (self.near, self.pairs) = (near, pairs);
        &self.pairs
    }

    /// Finds the flat clusters, and which others are within `horizon_m` of each other. The distance up to which pairs
    /// are known shrinks by the greatest approach of the clusters in the motion `made`.
    fn look(&mut self, x: &[V3], horizon_m: f64, made: Option<&Motion>) {
        self.clusters.look(x, self.triangles);
        self.seen = x.iter().map(rounded).collect();
        let extent = |corners: &Vec<usize>| {
            corners.iter().map(|&v| Bounds::around([self.seen[v]], 0.0)).fold(Bounds::NOTHING, |sum, b| sum.with(&b))
        };
        self.extents = self.clusters.members.iter().map(|members| extent(&members.corners)).collect();
        let extents = &self.extents;
        let corners: Vec<V3> = extents.iter().flat_map(Bounds::corners).collect();
        let sets: Vec<[usize; 2]> = (0..extents.len()).map(|c| [2 * c, 2 * c + 1]).collect();
        let half = extents.iter().map(Bounds::half_m).fold(0.0, f64::max);
        let grid = BoxGrid::new(&corners, &sets, horizon_m, (2.0 * half + horizon_m).max(CELL_M));
        let mut around = Vec::new();
        self.horizon_m = horizon_m;
        // All lists are in ascending order of the two clusters, and are merged.
        let mut before = std::mem::take(&mut self.near).into_iter().peekable();
        let mut flat = self.clusters.flat().peekable();
        for p in 0..extents.len() {
            let found = grid.near([&corners[2 * p], &corners[2 * p + 1]], &mut around);
            for q in found.iter().copied().filter(|&q| q >= p) {
                let (clusters, apart_m) = ([p, q], extents[p].apart_m(&extents[q]));
                while flat.next_if(|flat| *flat < clusters).is_some() {}
                if apart_m >= horizon_m || flat.peek() == Some(&clusters) {
                    continue;
                }
                while before.next_if(|near| near.clusters < clusters).is_some() {}
                let known = before.next_if(|near| near.clusters == clusters).zip(made);
                let (known_m, pairs) =
                    known.map_or((0.0, 0..0), |(near, made)| (near.unknown_m() - made.closing_m(clusters), near.pairs));
                self.near.push(Near { clusters, apart_m, known_m, pairs });
            }
        }
    }

    /// Greatest further approach of two primitives before an unknown pair can meet. Since the last look the cloth has
    /// made each of `motions` a number of times.
    pub fn room_m<const N: usize>(&self, motions: [(&Motion, f64); N]) -> f64 {
        let used = |approach: &dyn Fn(&Motion) -> f64| {
            motions.iter().map(|(motion, times)| approach(motion) * times).sum::<f64>()
        };
        let far = self.horizon_m - 2.0 * used(&|motion| motion.farthest_m);
        let left = |near: &Near| near.unknown_m() - used(&|motion| motion.closing_m(near.clusters));
        self.near.iter().map(left).fold(far, f64::min)
    }

    /// Share of `next` that can be made after `made` before an unknown pair can meet.
    pub fn free_share(&self, made: &Motion, next: &Motion) -> f64 {
        let far = (self.horizon_m - 2.0 * made.farthest_m) / (2.0 * next.farthest_m);
        let share = |near: &Near| (near.unknown_m() - made.closing_m(near.clusters)) / next.closing_m(near.clusters);
        self.near.iter().map(share).fold(far, f64::min)
    }

    fn between(
        &self,
        [one, other]: [&Boxes; 2],
        is_one: bool,
        within_m: f64,
        [these, those]: &mut [Vec<Boxed>; 2],
        take: &mut impl FnMut(Primitives),
    ) {
        let half_m = 0.5 * within_m as f32;
        for [of_vertices, of_triangles] in [[one, other], [other, one]].into_iter().take(if is_one { 1 } else { 2 }) {
            let vertices = near(&of_vertices.vertices, &of_triangles.all, half_m, these);
            let triangles = near(&of_triangles.triangles, &of_vertices.all, half_m, those);
            for (v, of_vertex) in vertices {
                for (t, _) in triangles.iter().filter(|(_, of_triangle)| of_triangle.meets(of_vertex)) {
                    let triangle = self.triangles[*t as usize];
                    if self.are_apart(&[*v as usize], &triangle) {
                        let [a, b, c] = sorted(triangle);
                        take(Primitives::VertexTriangle([*v as usize, a, b, c]));
                    }
                }
            }
        }
        let pairs = self.edges.pairs();
        let edges = near(&one.edges, &other.all, half_m, these);
        let others = near(&other.edges, &one.all, half_m, those);
        for (e, of_edge) in edges {
            for (f, _) in others.iter().filter(|(f, of_other)| (!is_one || f > e) && of_other.meets(of_edge)) {
                let ([a, b], [c, d]) = (pairs[*e.min(f) as usize], pairs[*e.max(f) as usize]);
                if self.are_apart(&[a, b], &[c, d]) {
                    take(Primitives::EdgeEdge([a, b, c, d]));
                }
            }
        }
    }

    /// True if two sets share no vertex, nor any sewn together.
    pub fn are_apart(&self, one: &[usize], other: &[usize]) -> bool {
        one.iter().all(|&v| other.iter().all(|&w| self.joined[v] != self.joined[w]))
    }
}

geom::constants! {
    "contact.broad_phase",
    /// Least cell size of the grid. In smaller cells each cluster would be found many times.
    const CELL_M: f64 = 0.02;
}

type Boxed = (u32, Bounds);

struct Boxes {
    vertices: Vec<Boxed>,
    triangles: Vec<Boxed>,
    edges: Vec<Boxed>,
    all: Bounds,
}

impl Boxes {
    fn new(broad_phase: &BroadPhase, cluster: usize) -> Self {
        let seen = &broad_phase.seen;
        let members = &broad_phase.clusters.members[cluster];
        let vertex = |&v: &usize| (v as u32, Bounds::around([seen[v]], 0.0));
        let triangle = |&t: &usize| (t as u32, Bounds::around(broad_phase.triangles[t].map(|v| seen[v]), 0.0));
        let edge = |&e: &usize| (e as u32, Bounds::around(broad_phase.edges()[e].map(|v| seen[v]), 0.0));
        Self {
            vertices: members.vertices.iter().map(vertex).collect(),
            triangles: members.triangles.iter().map(triangle).collect(),
            edges: members.edges.iter().map(edge).collect(),
            all: broad_phase.extents[cluster],
        }
    }
}

fn near<'s>(boxed: &[Boxed], into: &Bounds, half_m: f32, scratch: &'s mut Vec<Boxed>) -> &'s [Boxed] {
    let into = into.widened(half_m);
    let widened = boxed.iter().map(|(which, bounds)| (*which, bounds.widened(half_m)));
    scratch.clear();
    scratch.extend(widened.filter(|(_, bounds)| bounds.meets(&into)));
    scratch
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::distance::ClosestPoints;
    use crate::laboratory::sheets::{shaken, sheet};
    use geom::V2;

    const EDGE_M: f64 = 0.01;

    /// `true` for a pair of edges.
    type Tagged = ([usize; 4], bool);

    fn tagged(primitives: Primitives) -> Tagged {
        (primitives.vertices(), matches!(primitives, Primitives::EdgeEdge(_)))
    }

    fn all_within(x: &[V3], triangles: &[[usize; 3]], reach: f64) -> Vec<(Tagged, f64)> {
        let edges = edges_of(triangles);
        let edge_pairs = edges.pairs().iter().enumerate().flat_map(|(e, &[a, b])| {
            edges.pairs()[e + 1..].iter().map(move |&[c, d]| Primitives::EdgeEdge([a, b, c, d]))
        });
        let corners = (0..x.len()).flat_map(|v| triangles.iter().map(move |t| (v, sorted(*t))));
        let pairs = corners.map(|(v, [a, b, c])| Primitives::VertexTriangle([v, a, b, c])).chain(edge_pairs);
        let apart = |p: &Primitives| match p.vertices() {
            [a, b, c, d] if matches!(p, Primitives::EdgeEdge(_)) => a != c && a != d && b != c && b != d,
            [v, a, b, c] => v != a && v != b && v != c,
        };
        let with_distance = |p: Primitives| (tagged(p), ClosestPoints::of(x, p).gap.norm());
        pairs.filter(apart).map(with_distance).filter(|(_, distance)| *distance < reach).collect()
    }

    #[test]
    fn only_pairs_within_flat_cloth_are_left_out() {
        let (rest, triangles) = sheet(24, 8, EDGE_M);
        let reach = 0.9 * EDGE_M;
        // Rolled up, so that layers are 6 mm apart; with a sharp crease; and flat.
        let rolled = |p: &V2| {
            let angle = (2.0 * p.x / 9e-4).sqrt();
            V3::new(9e-4 * angle * angle.cos(), p.y, 9e-4 * angle * angle.sin())
        };
        let creased = |p: &V2| V3::new((p.x - 0.12).abs(), p.y, if p.x > 0.12 { 2e-3 } else { 0.0 });
        let check = |place: &dyn Fn(&V2) -> V3, reach_m: &dyn Fn([usize; 2]) -> f64, must_find: bool| {
            let mut x = shaken(&rest.iter().map(place).collect::<Vec<_>>(), 2e-4, 3);
            let mut broad_phase = BroadPhase::new(&triangles, x.len());
            let mut made = None;
            // Searched everywhere, then only where too much has become unknown.
            for at_least_m in [reach, 0.8 * reach] {
                let within = |clusters| Within { at_least_m, at_best_m: reach_m(clusters) };
                let pairs = broad_phase.find_pairs(&x, 2.0 * reach, made.as_ref(), within);
                let mut found: Vec<Tagged> = pairs.iter().map(|pair| tagged(pair.primitives)).collect();
                let room = broad_phase.room_m([]);
                assert!(room >= 0.6 * reach, "{room}");
                found.sort_unstable();
                assert!(found.windows(2).all(|two| two[0] != two[1]), "a pair is found twice");
                let mut layers = 0;
                for (pair, distance) in all_within(&x, &triangles, reach) {
                    let [first, .., last] = pair.0.map(|v| rest[v]);
                    let is_layer = (first - last).norm() > 6.0 * EDGE_M;
                    layers += usize::from(is_layer);
                    if found.binary_search(&pair).is_err() {
                        let is_flat = !is_layer && distance > 0.4 * EDGE_M;
                        assert!(is_flat || distance >= room, "{pair:?} at {distance} is missing");
                    }
                }
                assert_eq!(layers > 0, must_find);
                let next = shaken(&x, 4e-4, 5);
                let displacements: Vec<V3> = next.iter().zip(&x).map(|(p, q)| p - q).collect();
                (made, x) = (Some(broad_phase.motion(&displacements)), next);
            }
        };
        // Some pairs of clusters are searched less far than others.
        let mixed = |[p, q]: [usize; 2]| if (p + q) % 3 == 0 { reach } else { 0.7 * reach };
        for reach_m in [&|_| reach, &mixed as &dyn Fn([usize; 2]) -> f64] {
            check(&rolled, reach_m, true);
            check(&creased, reach_m, true);
            check(&|p| V3::new(p.x, p.y, 0.0), reach_m, false);
        }
    }

    #[test]
    fn the_sides_of_a_slit_are_held_against_each_other() {
        let (mut rest, mut triangles) = sheet(24, 8, EDGE_M);
        let beside = |p: &V2| p.x > 0.12 + 1e-9;
        let is_cut = |p: &V2| (p.x - 0.12).abs() < 1e-9 && p.y < 0.05 - 1e-9;
        let cut: Vec<usize> = (0..rest.len()).filter(|&v| is_cut(&rest[v])).collect();
        let first = rest.len();
        rest.extend(cut.iter().map(|&v| rest[v]).collect::<Vec<_>>());
        for triangle in triangles.iter_mut().filter(|t| t.iter().any(|&v| beside(&rest[v]))) {
            *triangle = triangle.map(|v| cut.iter().position(|&w| w == v).map_or(v, |k| first + k));
        }
        let x: Vec<V3> = rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
        let mut broad_phase = BroadPhase::new(&triangles, x.len());
        let pairs = broad_phase
            .find_pairs(&x, 2.0 * EDGE_M, None, |_| Within { at_least_m: 0.5 * EDGE_M, at_best_m: 0.5 * EDGE_M });
        let found: Vec<[usize; 2]> = pairs.iter().flat_map(|pair| pair.primitives.across()).collect();
        assert_eq!(cut.len(), 5);
        for (k, &v) in cut.iter().enumerate() {
            assert!(found.iter().any(|pair| *pair == [v, first + k] || *pair == [first + k, v]), "at {:?}", rest[v]);
        }
    }

    #[test]
    fn cloth_that_folds_is_searched_again() {
        let (rest, triangles) = sheet(24, 24, EDGE_M);
        let flat: Vec<V3> = rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
        let mut broad_phase = BroadPhase::new(&triangles, flat.len());
        broad_phase.look(&flat, EDGE_M, None);
        assert!(broad_phase.stay_flat(&shaken(&flat, 5e-4, 1)));
        let folded: Vec<V3> = flat.iter().map(|p| V3::new((p.x - 0.12).abs(), p.y, p.z)).collect();
        assert!(!broad_phase.stay_flat(&folded));
    }
}
