//! A cloth in small clusters, and which of them need not be held against each other.
//!
//! Cloth that is nearly flat comes nowhere near itself. Where all normals of two clusters that hang together, and of
//! those that lie between them, are within a narrow cone, no part of one can touch a part of the other [Volino &
//! Magnenat-Thalmann 1994]. That is nearly all of a drape, so what is left to be searched are folds and layers. At the
//! cloth's rim flat parts could yet meet within their plane, as the two sides of a slit do: there nothing is left out.

use geom::V3;
use linalg::PairList;

geom::constants! {
    "contact.normal_cones",
    /// Least distance, in edges, between the middles of clusters.
    const APART: usize = 3;
    /// Half the angle of the cone within which normals of flat cloth lie when it is searched, rad; and until it is searched again.
    const FLAT_RAD: f64 = 0.8;
    const STILL_FLAT_RAD: f64 = 1.2;
}

/// The clusters of a cloth.
pub struct Clusters {
    /// Those of a cluster: vertices, triangles and edges, each in one cluster only.
    pub members: Vec<Members>,
    /// Triangles at a cluster's vertices.
    around: Vec<Vec<usize>>,
    is_at_rim: Vec<bool>,
    /// Pairs of clusters that hang together: that an edge joins, or two edges by way of others between them, and each with itself.
    joined: PairList,
    /// Of each pair, the clusters between.
    between: Vec<Vec<usize>>,
    /// Of each pair, whether it was flat when the cloth was searched last.
    is_flat: Vec<bool>,
}

/// What belongs to a cluster.
#[derive(Clone, Debug, Default)]
pub struct Members {
    /// Vertices that belong to no other cluster.
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

/// The normals of a cluster, as far as it takes to tell which others are flat with it.
#[derive(Clone, Copy)]
struct Cone {
    axis: V3,
    /// Least cosine of the angle between its axis and that of another.
    nearest: f64,
}

impl Cone {
    /// Whether the normals of both lie within a cone of the angle that they were made for.
    fn is_flat_with(&self, other: &Self) -> bool {
        self.axis.dot(&other.axis) >= self.nearest.max(other.nearest)
    }
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
        for (e, &[i, j]) in edges.pairs().iter().enumerate() {
            members[of[i]].edges.push(e);
            if sides[e] != 2 {
                is_at_rim[of[i]] = true;
                is_at_rim[of[j]] = true;
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
        let (joined, between) = hanging_together(count, edges.pairs().iter().map(|pair| pair.map(|v| of[v])));
        Self { members, around, is_at_rim, is_flat: vec![false; between.len()], joined, between }
    }

    /// Looks which clusters that hang together are flat.
    pub fn look(&mut self, x: &[V3], triangles: &[[usize; 3]]) {
        let cones = self.cones(x, triangles, FLAT_RAD);
        let is_flat = |(&[a, b], between): (&[usize; 2], &Vec<usize>)| {
            !(self.is_at_rim[a] && self.is_at_rim[b]) && are_flat(&cones, [a, b], between)
        };
        self.is_flat = self.joined.pairs().iter().zip(&self.between).map(is_flat).collect();
    }

    /// Pairs of clusters that were flat together, in rising order.
    pub fn flat(&self) -> impl Iterator<Item = [usize; 2]> {
        self.joined.pairs().iter().zip(&self.is_flat).filter(|(_, is_flat)| **is_flat).map(|(pair, _)| *pair)
    }

    /// Whether all that was flat is so still.
    #[must_use]
    pub fn stay_flat(&self, x: &[V3], triangles: &[[usize; 3]]) -> bool {
        let cones = self.cones(x, triangles, STILL_FLAT_RAD);
        let mut pairs = self.joined.pairs().iter().zip(&self.between).zip(&self.is_flat);
        pairs.all(|((&pair, between), was_flat)| !was_flat || are_flat(&cones, pair, between))
    }

    /// Of clusters that stay where they are.
    #[must_use]
    pub fn rest(&self) -> Motion {
        let count = self.members.len();
        Motion { means: vec![V3::zeros(); count], strays_m: vec![0.0; count], farthest_m: 0.0 }
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

    /// The cones of all clusters, for those flat within `half_rad`.
    fn cones(&self, x: &[V3], triangles: &[[usize; 3]], half_rad: f64) -> Vec<Cone> {
        let normal =
            |&[a, b, c]: &[usize; 3]| (x[b] - x[a]).cross(&(x[c] - x[a])).try_normalize(0.0).unwrap_or_default();
        let normals: Vec<V3> = triangles.iter().map(normal).collect();
        let cone = |around: &Vec<usize>| {
            let axis = around.iter().map(|&t| normals[t]).sum::<V3>().try_normalize(0.0).unwrap_or_default();
            let least = around.iter().map(|&t| axis.dot(&normals[t])).fold(1.0, f64::min);
            let left_rad = half_rad - least.clamp(-1.0, 1.0).acos();
            // Nothing is flat with what is not so itself.
            let nearest = if left_rad > 0.0 { (2.0 * left_rad).cos() } else { f64::MAX };
            Cone { axis, nearest }
        };
        self.around.iter().map(cone).collect()
    }
}

/// Whether two clusters are flat with each other and with all between them.
fn are_flat(cones: &[Cone], [a, b]: [usize; 2], between: &[usize]) -> bool {
    let [one, other] = [&cones[a], &cones[b]];
    one.is_flat_with(other) && between.iter().all(|&c| one.is_flat_with(&cones[c]) && cones[c].is_flat_with(other))
}

/// Of `count` clusters that `links` join: the pairs that are joined, also by way of others, or one twice, and the clusters between
/// those that no link joins.
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

/// Length of the longest vector, m.
#[must_use]
pub fn longest_m(vectors: &[V3]) -> f64 {
    vectors.iter().map(V3::norm_squared).fold(0.0, f64::max).sqrt()
}
