//! Clusters of a cloth, and normal cones that exclude pairs of them from the collision search.
//!
//! Nearly flat cloth does not collide with itself. Consider two connected clusters and those between them: if all their
//! normals are within a narrow cone, no part of one can touch a part of the other [Volino & Magnenat-Thalmann 1994].
//! That holds for nearly all of a drape, so only folds and layers are searched. At the rim of the cloth flat parts
//! could still meet within their plane, as the two sides of a slit do. There nothing is left out.

use geom::V3;
use linalg::PairList;

geom::constants! {
    "contact.normal_cones",
    /// Least distance between the centres of clusters, in edges.
    const APART: usize = 3;
    /// Half angle of the cone in which the normals of flat cloth must lie when it is searched. Until the next search
    /// they may lie in that of `STILL_FLAT_RAD`.
    const FLAT_RAD: f64 = 0.8;
    const STILL_FLAT_RAD: f64 = 1.2;
}

pub struct Clusters {
    pub members: Vec<Members>,
    around: Vec<Vec<usize>>,
    is_at_rim: Vec<bool>,
    /// Clusters that an edge joins, or two edges by way of another cluster, and each with itself.
    joined: PairList,
    between: Vec<Vec<usize>>,
    is_flat: Vec<bool>,
}

#[derive(Clone, Debug, Default)]
pub struct Members {
    pub vertices: Vec<usize>,
    /// First vertex is in the cluster.
    pub triangles: Vec<usize>,
    /// First vertex is in the cluster.
    pub edges: Vec<usize>,
    /// Vertices of all these, ascending.
    pub corners: Vec<usize>,
}

/// Mean displacement of each cluster and the greatest deviation from it.
pub struct Motion {
    means: Vec<V3>,
    strays_m: Vec<f64>,
    pub farthest_m: f64,
}

impl Motion {
    /// Greatest approach of any part of one cluster to any of another. Their common motion does not count.
    pub fn closing_m(&self, [p, q]: [usize; 2]) -> f64 {
        (self.means[p] - self.means[q]).norm() + self.strays_m[p] + self.strays_m[q]
    }
}

#[derive(Clone, Copy)]
struct Cone {
    axis: V3,
    /// Least cosine of the angle between its axis and that of another for both to be flat together.
    nearest: f64,
}

impl Cone {
    fn is_flat_with(&self, other: &Self) -> bool {
        self.axis.dot(&other.axis) >= self.nearest.max(other.nearest)
    }
}

impl Clusters {
    pub fn new(vertices: usize, triangles: &[[usize; 3]], edges: &PairList) -> Self {
        let (cluster_of, count) = edges.divide(vertices, APART);
        let mut members = vec![Members::default(); count];
        let mut around = vec![Vec::new(); count];
        (0..vertices).for_each(|v| members[cluster_of[v]].vertices.push(v));
        let mut sides = vec![0_u32; edges.pairs().len()];
        for (t, &[a, b, c]) in triangles.iter().enumerate() {
            members[cluster_of[a]].triangles.push(t);
            let mut touched = [a, b, c].map(|v| cluster_of[v]);
            touched.sort_unstable();
            for k in 0..3 {
                if k == 0 || touched[k] != touched[k - 1] {
                    around[touched[k]].push(t);
                }
            }
            for [i, j] in [[a, b], [b, c], [c, a]] {
                sides[edges.slot(i, j).expect("an edge of the cloth")] += 1;
            }
        }
        let mut is_at_rim = vec![false; count];
        for (e, &[i, j]) in edges.pairs().iter().enumerate() {
            members[cluster_of[i]].edges.push(e);
            if sides[e] != 2 {
                is_at_rim[cluster_of[i]] = true;
                is_at_rim[cluster_of[j]] = true;
            }
        }
        for members in &mut members {
            let mut corners = members.vertices.clone();
            corners.extend(members.edges.iter().flat_map(|&e| edges.pairs()[e]));
            corners.extend(members.triangles.iter().flat_map(|&t| triangles[t]));
            corners.sort_unstable();
            corners.dedup();
            members.corners = corners;
        }
        let (joined, between) = hanging_together(count, edges.pairs().iter().map(|pair| pair.map(|v| cluster_of[v])));
        Self { members, around, is_at_rim, is_flat: vec![false; between.len()], joined, between }
    }

    pub fn look(&mut self, x: &[V3], triangles: &[[usize; 3]]) {
        let cones = self.cones(x, triangles, FLAT_RAD);
        let is_flat = |(&[a, b], between): (&[usize; 2], &Vec<usize>)| {
            !(self.is_at_rim[a] && self.is_at_rim[b]) && are_flat(&cones, [a, b], between)
        };
        self.is_flat = self.joined.pairs().iter().zip(&self.between).map(is_flat).collect();
    }

    pub fn flat(&self) -> impl Iterator<Item = [usize; 2]> {
        self.joined.pairs().iter().zip(&self.is_flat).filter(|(_, is_flat)| **is_flat).map(|(pair, _)| *pair)
    }

    pub fn stay_flat(&self, x: &[V3], triangles: &[[usize; 3]]) -> bool {
        let cones = self.cones(x, triangles, STILL_FLAT_RAD);
        let mut pairs = self.joined.pairs().iter().zip(&self.between).zip(&self.is_flat);
        pairs.all(|((&pair, between), was_flat)| !was_flat || are_flat(&cones, pair, between))
    }

    pub fn rest(&self) -> Motion {
        let count = self.members.len();
        Motion { means: vec![V3::zeros(); count], strays_m: vec![0.0; count], farthest_m: 0.0 }
    }

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

    fn cones(&self, x: &[V3], triangles: &[[usize; 3]], half_rad: f64) -> Vec<Cone> {
        let normal =
            |&[a, b, c]: &[usize; 3]| (x[b] - x[a]).cross(&(x[c] - x[a])).try_normalize(0.0).unwrap_or_default();
        let normals: Vec<V3> = triangles.iter().map(normal).collect();
        let cone = |around: &Vec<usize>| {
            let axis = around.iter().map(|&t| normals[t]).sum::<V3>().try_normalize(0.0).unwrap_or_default();
            let least = around.iter().map(|&t| axis.dot(&normals[t])).fold(1.0, f64::min);
            let left_rad = half_rad - least.clamp(-1.0, 1.0).acos();
            // A cluster that is not flat itself is flat with no other.
            let nearest = if left_rad > 0.0 { (2.0 * left_rad).cos() } else { f64::MAX };
            Cone { axis, nearest }
        };
        self.around.iter().map(cone).collect()
    }
}

fn are_flat(cones: &[Cone], [a, b]: [usize; 2], between: &[usize]) -> bool {
    let [one, other] = [&cones[a], &cones[b]];
    one.is_flat_with(other) && between.iter().all(|&c| one.is_flat_with(&cones[c]) && cones[c].is_flat_with(other))
}

/// Pairs that `links` join, directly, by way of a third, or each with itself. Then, for those that no link joins, the
/// clusters between.
fn hanging_together(count: usize, links: impl Iterator<Item = [usize; 2]>) -> (PairList, Vec<Vec<usize>>) {
    let links = PairList::new(links.chain((0..count).map(|c| [c, c])));
    let mut next_to = vec![Vec::new(); count];
    for &[a, b] in links.pairs().iter().filter(|[a, b]| a != b) {
        next_to[a].push(b);
        next_to[b].push(a);
    }
    let by_way = next_to.iter().flat_map(|around| around.iter().flat_map(|&a| around.iter().map(move |&b| [a, b])));
    let joined = PairList::new(links.pairs().iter().copied().chain(by_way));
    let mut between = vec![Vec::new(); joined.pairs().len()];
    for (c, around) in next_to.iter().enumerate() {
        for (k, &a) in around.iter().enumerate() {
            for &b in around[k + 1..].iter().filter(|b| links.slot(a, **b).is_none()) {
                between[joined.slot(a, b).expect("both are next to it")].push(c);
            }
        }
    }
    (joined, between)
}

pub fn longest_m(vectors: &[V3]) -> f64 {
    vectors.iter().map(V3::norm_squared).fold(0.0, f64::max).sqrt()
}
