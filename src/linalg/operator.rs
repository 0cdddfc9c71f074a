//! The stiffness of a cloth as a linear operator.
//!
//! Membrane and bending stiffness are invariant under translation: the blocks of a row sum to zero. They are therefore
//! assembled as one block per *pair* of vertices and applied to differences, `y_i += A_ij (x_j - x_i)`: that needs no
//! diagonal, and a uniform translation is annihilated exactly, however the blocks were rounded. The linear solves take the
//! pairs by rows ([`super::csr`]).

use nalgebra::Matrix3;
use wide::f32x4;

use super::csr::Upper;
use super::quad::{self, Block};
use super::rows::sorted_by_row;
use super::stencil::Stencils;
use geom::V3;

/// Pairs of vertices `i < j`, sorted, that some element couples.
#[derive(Clone, Debug, Default)]
pub struct PairList {
    pairs: Vec<[usize; 2]>,
    upper: Upper,
}

impl PairList {
    /// The list without pairs.
    pub const EMPTY: &'static Self = &Self { pairs: Vec::new(), upper: Upper::EMPTY };

    /// Collects the distinct unordered pairs.
    #[must_use]
    pub fn new(pairs: impl IntoIterator<Item = [usize; 2]>) -> Self {
        let given: Vec<[usize; 2]> = pairs.into_iter().map(|[i, j]| [i.min(j), i.max(j)]).collect();
        let rows = given.iter().map(|[i, _]| i + 1).max().unwrap_or(0);
        let (starts, mut others) = sorted_by_row(rows, &given, |[i, _]| *i, |[_, j]| *j);
        let mut pairs: Vec<[usize; 2]> = Vec::with_capacity(given.len());
        for (i, ends) in starts.windows(2).enumerate() {
            let row = &mut others[ends[0] as usize..ends[1] as usize];
            row.sort_unstable();
            for (k, j) in row.iter().enumerate() {
                if k == 0 || row[k - 1] != *j {
                    pairs.push([i, *j]);
                }
            }
        }
        pairs.shrink_to_fit();
        let upper = Upper::new(&pairs);
        Self { pairs, upper }
    }

    /// Position of the pair `{i, j}` in the list.
    #[must_use]
    pub fn slot(&self, i: usize, j: usize) -> Option<usize> {
        self.upper.slot(i.min(j), i.max(j))
    }

    /// The pairs by their smaller vertex.
    #[must_use]
    pub fn upper(&self) -> &Upper {
        &self.upper
    }

    /// Divides vertices that the pairs couple into patches: the patch of each, and their number. Each goes to the nearest of
    /// middles that are at least `apart` pairs from each other.
    #[must_use]
    pub fn divide(&self, vertices: usize, apart: usize) -> (Vec<usize>, usize) {
        let mut neighbours = vec![Vec::new(); vertices];
        for &[i, j] in &self.pairs {
            neighbours[i].push(j);
            neighbours[j].push(i);
        }
        let mut distance = vec![usize::MAX; vertices];
        let mut of = vec![0; vertices];
        let mut count = 0;
        let mut queue = std::collections::VecDeque::new();
        for seed in 0..vertices {
            if distance[seed] < apart {
                continue;
            }
            (distance[seed], of[seed]) = (0, count);
            queue.push_back(seed);
            while let Some(v) = queue.pop_front() {
                for &w in &neighbours[v] {
                    if distance[v] + 1 < distance[w] {
                        (distance[w], of[w]) = (distance[v] + 1, count);
                        queue.push_back(w);
                    }
                }
            }
            count += 1;
        }
        (of, count)
    }

    /// The pairs, sorted.
    #[must_use]
    pub fn pairs(&self) -> &[[usize; 2]] {
        &self.pairs
    }
}

/// Coupling of four vertices along one direction: the stiffness `k a a^T` with `a = (w_0 n, ..., w_3 n)`.
#[derive(Clone, Copy, Debug)]
pub struct Contact4 {
    /// The four vertices; those of weight zero may repeat others.
    pub vertices: [usize; 4],
    /// Weight of each vertex; they sum to zero between layers of cloth, and to one on the body.
    pub weights: [f64; 4],
    /// Unit direction along which it resists.
    pub normal: V3,
    /// Stiffness, N/m.
    pub stiffness: f64,
}

impl Contact4 {
    fn apply(&self, x: &[V3], y: &mut [V3]) {
        let along: f64 = (0..4).map(|k| self.weights[k] * self.normal.dot(&x[self.vertices[k]])).sum();
        for k in 0..4 {
            y[self.vertices[k]] += self.normal * (self.stiffness * along * self.weights[k]);
        }
    }
}

/// Stiffness of triangles' sides that are arcs, beyond that of their chords, which the membrane's blocks hold.
#[derive(Clone, Debug)]
pub struct ArcStiffness<'a> {
    /// Pairs of vertices that are sides.
    pub pairs: &'a PairList,
    /// What the curvature along each side is told by.
    pub stencils: &'a Stencils,
    /// Sides of each triangle.
    pub triangles: &'a [[u32; 3]],
    /// From the first vertex of each side to the second, m.
    pub chords: Vec<V3>,
    /// What a unit of curvature along each side adds to half of its square, m.
    pub slopes: Vec<V3>,
    /// Stiffness against curvature itself of sides that are drawn, N/m.
    pub drawn: Vec<f64>,
    /// Of each triangle, what half of a squared side adds to the tension of a side, N/m3: of each with itself, and of (0, 1), (1, 2), (2, 0).
    pub couplings: Vec<[f32; 6]>,
}

/// A symmetric positive semidefinite stiffness, assembled anew each step.
pub struct Operator<'a> {
    /// Diagonal blocks: inertia, body contact, friction. N/m.
    pub diagonal: Vec<Matrix3<f64>>,
    /// Pairs coupled by the membrane.
    pub membrane_pairs: &'a PairList,
    /// Their off-diagonal blocks `K_ij` for `i < j`, one a pair, N/m, with what bending has there.
    pub membrane: Vec<Block<f32x4>>,
    /// Pairs coupled by bending alone.
    pub bending_pairs: &'a PairList,
    /// Their off-diagonal entries, one a pair, N/m, the same in x, y and z.
    pub bending: &'a [f64],
    /// Springs between two vertices: stiffness, N/m.
    pub springs: Vec<([usize; 2], f64)>,
    /// Contacts of the cloth with itself, and of points between vertices with the body.
    pub contacts: Vec<Contact4>,
    /// Sides that are arcs, where any are.
    pub arcs: Option<ArcStiffness<'a>>,
}

impl Operator<'_> {
    /// What the diagonal and the contacts alone make of a displacement.
    #[must_use]
    pub fn contact_forces(&self, x: &[V3]) -> Vec<V3> {
        let mut y: Vec<V3> = self.diagonal.iter().zip(x).map(|(block, x)| block * x).collect();
        for contact in &self.contacts {
            contact.apply(x, &mut y);
        }
        y
    }

    /// The 3x3 blocks on the diagonal of `K`, for a block-Jacobi preconditioner.
    #[must_use]
    pub fn diagonal_blocks(&self) -> Vec<Matrix3<f64>> {
        let mut blocks = self.own_blocks();
        for &([i, j], stiffness) in &self.springs {
            for v in [i, j] {
                blocks[v] += Matrix3::identity() * stiffness;
            }
        }
        // CsrMatrix and columns of couplings summed by themselves: what the diagonal lacks for both to come to nothing. Once a vertex is
        // met, all smaller ones have been, and its column is whole.
        let mut columns = vec![[f32x4::ZERO; 3]; blocks.len()];
        let mut alike = vec![0.0; blocks.len()];
        for (i, block) in blocks.iter_mut().enumerate() {
            let mut rows = [f32x4::ZERO; 3];
            for (j, coupling) in self.membrane_pairs.upper().of(i, &self.membrane) {
                for (k, row) in coupling.iter().enumerate() {
                    rows[k] += *row;
                    columns[j][k] += *row;
                }
            }
            for (j, entry) in self.bending_pairs.upper().of(i, self.bending) {
                alike[i] += entry;
                alike[j] += entry;
            }
            let lacking = quad::matrix(&rows) + quad::matrix(&columns[i]).transpose();
            *block -= lacking + Matrix3::from_diagonal_element(alike[i]);
        }
        if let Some(arcs) = &self.arcs {
            arcs.add_diagonal(&mut blocks);
        }
        blocks
    }

    /// The diagonal blocks without what couplings of pairs and springs have there.
    #[must_use]
    pub fn own_blocks(&self) -> Vec<Matrix3<f64>> {
        let mut blocks = self.diagonal.clone();
        for contact in &self.contacts {
            let outer = contact.normal * contact.normal.transpose() * contact.stiffness;
            for k in 0..4 {
                blocks[contact.vertices[k]] += outer * (contact.weights[k] * contact.weights[k]);
            }
        }
        blocks
    }
}

impl ArcStiffness<'_> {
    /// Adds what curvature alone has on the diagonal.
    fn add_diagonal(&self, blocks: &mut [Matrix3<f64>]) {
        let mut own = vec![0.0; self.slopes.len()];
        for (sides, couplings) in self.triangles.iter().zip(&self.couplings) {
            for k in 0..3 {
                own[sides[k] as usize] += f64::from(couplings[k]);
            }
        }
        for (side, slope) in self.slopes.iter().enumerate() {
            let block = slope * slope.transpose() * own[side] + Matrix3::identity() * self.drawn[side];
            for (v, weight) in self.stencils.row(side) {
                blocks[v] += block * (weight * weight);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_kept_once_and_found_either_way_round() {
        let list = PairList::new([[3, 1], [0, 2], [1, 3], [5, 5], [0, 1], [2, 0]]);
        assert_eq!(list.pairs(), [[0, 1], [0, 2], [1, 3], [5, 5]]);
        let check = |i: usize, j: usize, expect: Option<usize>| assert_eq!(list.slot(i, j), expect, "{i}, {j}");
        check(2, 0, Some(1));
        check(3, 1, Some(2));
        check(5, 5, Some(3));
        check(1, 2, None);
        check(4, 6, None);
        assert!(PairList::new([]).pairs().is_empty());
    }

    #[test]
    fn every_vertex_is_in_a_patch_near_its_middle() {
        let line = PairList::new((0..99).map(|v| [v, v + 1]));
        let (of, count) = line.divide(100, 4);
        let sizes: Vec<usize> = (0..count).map(|a| of.iter().filter(|b| **b == a).count()).collect();
        assert!(sizes.iter().all(|n| (2..=5).contains(n)), "{sizes:?}");
        // Cloth in two pieces, and a vertex of no pair.
        assert_eq!(PairList::new([[0, 1]]).divide(4, 4), (vec![0, 0, 1, 2], 3));
    }
}
