//! A cloth in small clusters, and which of them need not be held against each other.
//!
//! Cloth that is nearly flat comes nowhere near itself: where all normals of two clusters that hang together lie within a narrow
//! cone, no part of one can touch a part of the other [Volino & Magnenat-Thalmann 1994]. That is nearly all of a drape, so
//! what is left to be searched are folds and layers. At the cloth's rim flat parts could yet meet within their plane, as the two
//! sides of a slit do: there nothing is left out.

use crate::geom::V3;
use crate::sim::solver::PairList;

/// Least distance, in edges, between the middles of clusters.
const APART: usize = 3;
/// Half the angle of the cone within which normals of flat cloth lie when it is searched, rad; and until it is searched again.
const FLAT_RAD: f64 = 0.8;
const STILL_FLAT_RAD: f64 = 1.2;

/// The clusters of a cloth.
pub struct Clusters {
    /// Those of a cluster: vertices, triangles and edges, each in one cluster only.
    pub members: Vec<Members>,
    /// Triangles at a cluster's vertices.
    around: Vec<Vec<usize>>,
    is_at_rim: Vec<bool>,
    /// Pairs of clusters that an edge joins, and each with itself.
    joined: Vec<[usize; 2]>,
    /// Of those, what was flat when the cloth was searched last.
    flat: Vec<[usize; 2]>,
}

/// What belongs to a cluster.
#[derive(Clone, Debug, Default)]
pub struct Members {
    /// Vertices.
    pub vertices: Vec<usize>,
    /// Triangles, by their first vertex.
    pub triangles: Vec<usize>,
    /// Edges, by their first vertex.
    pub edges: Vec<usize>,
    /// All vertices of these, sorted.
    pub corners: Vec<usize>,
}

/// How the clusters of a cloth have moved, or are to.
pub struct Motion {
    /// Mean displacement of a cluster's corners, m.
    means: Vec<V3>,
    /// How far anything in it strays from that at most, m.
    strays_m: Vec<f64>,
    /// Longest displacement of a vertex, m.
    pub farthest_m: f64,
}

impl Motion {
    /// How much nearer any part of one cluster may come to any of another, m: what they have in common brings them no nearer.
    #[must_use]
    pub fn closing_m(&self, [p, q]: [usize; 2]) -> f64 {
        (self.means[p] - self.means[q]).norm() + self.strays_m[p] + self.strays_m[q]
    }
}

/// The normals of a cluster.
#[derive(Clone, Copy)]
struct Cone {
    axis: V3,
    /// Greatest angle of a normal to the axis, rad.
    half_rad: f64,
}

impl Clusters {
    /// Of a cloth of so many vertices.
    #[must_use]
    pub fn new(vertices: usize, triangles: &[[usize; 3]], edges: &PairList) -> Self {
        let (of, count) = edges.divide(vertices, APART);
        let mut members = vec![Members::default(); count];
        let mut around = vec![Vec::new(); count];
        (0..vertices).for_each(|v| members[of[v]].vertices.push(v));
        let mut sides = vec![0_u32; edges.pairs().len()];
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            members[of[a]].triangles.push(t);
            let mut at = [of[a], of[b], of[c]];
            at.sort_unstable();
            for k in 0..3 {
                if k == 0 || at[k] != at[k - 1] {
                    around[at[k]].push(t);
                }
            }
            for [i, j] in [[a, b], [b, c], [c, a]] {
                sides[edges.slot(i, j).expect("an edge of the cloth")] += 1;
            }
        }
        let mut is_at_rim = vec![false; count];
        let mut joined: Vec<[usize; 2]> = (0..count).map(|c| [c, c]).collect();
        for (e, &[i, j]) in edges.pairs().iter().enumerate() {
            members[of[i]].edges.push(e);
            joined.push([of[i].min(of[j]), of[i].max(of[j])]);
            if sides[e] != 2 {
                is_at_rim[of[i]] = true;
                is_at_rim[of[j]] = true;
            }
        }
        joined.sort_unstable();
        joined.dedup();
        for members in &mut members {
            let mut corners = members.vertices.clone();
            corners.extend(members.edges.iter().flat_map(|&e| edges.pairs()[e]));
            corners.extend(members.triangles.iter().flat_map(|&t| triangles[t]));
            corners.sort_unstable();
            corners.dedup();
            members.corners = corners;
        }
        Self { members, around, is_at_rim, joined, flat: Vec::new() }
    }

    /// Looks which clusters that hang together are flat.
    pub fn look(&mut self, x: &[V3], triangles: &[[usize; 3]]) {
        let cones = self.cones(x, triangles);
        let is_flat = |&&[a, b]: &&[usize; 2]| {
            !(self.is_at_rim[a] && self.is_at_rim[b]) && spread_rad(&cones[a], &cones[b]) < FLAT_RAD
        };
        self.flat = self.joined.iter().filter(is_flat).copied().collect();
    }

    /// Whether two clusters, the first no later than the second, were flat together.
    #[must_use]
    pub fn are_flat(&self, pair: [usize; 2]) -> bool {
        self.flat.binary_search(&pair).is_ok()
    }

    /// Whether all that was flat is so still.
    #[must_use]
    pub fn stay_flat(&self, x: &[V3], triangles: &[[usize; 3]]) -> bool {
        let cones = self.cones(x, triangles);
        self.flat.iter().all(|&[a, b]| spread_rad(&cones[a], &cones[b]) < STILL_FLAT_RAD)
    }

    /// How the clusters move where vertices are displaced like this.
    #[must_use]
    pub fn motion(&self, displacements: &[V3]) -> Motion {
        let mean = |members: &Members| {
            members.corners.iter().map(|&v| displacements[v]).sum::<V3>() / members.corners.len() as f64
        };
        let means: Vec<V3> = self.members.iter().map(mean).collect();
        let stray = |(members, mean): (&Members, &V3)| {
            members.corners.iter().map(|&v| (displacements[v] - mean).norm_squared()).fold(0.0, f64::max).sqrt()
        };
        let strays_m = self.members.iter().zip(&means).map(stray).collect();
        Motion { means, strays_m, farthest_m: longest_m(displacements) }
    }

    fn cones(&self, x: &[V3], triangles: &[[usize; 3]]) -> Vec<Cone> {
        let normal =
            |&[a, b, c]: &[usize; 3]| (x[b] - x[a]).cross(&(x[c] - x[a])).try_normalize(0.0).unwrap_or_default();
        let normals: Vec<V3> = triangles.iter().map(normal).collect();
        let cone = |around: &Vec<usize>| {
            let axis = around.iter().map(|&t| normals[t]).sum::<V3>().try_normalize(0.0).unwrap_or_default();
            let least = around.iter().map(|&t| axis.dot(&normals[t])).fold(1.0, f64::min);
            Cone { axis, half_rad: least.clamp(-1.0, 1.0).acos() }
        };
        self.around.iter().map(cone).collect()
    }
}

/// Length of the longest vector, m.
#[must_use]
pub fn longest_m(vectors: &[V3]) -> f64 {
    vectors.iter().map(V3::norm_squared).fold(0.0, f64::max).sqrt()
}

/// Half the angle of the cone about the normals of two clusters, rad.
fn spread_rad(a: &Cone, b: &Cone) -> f64 {
    let apart = a.axis.dot(&b.axis).clamp(-1.0, 1.0).acos();
    0.5 * apart + a.half_rad.max(b.half_rad)
}
