//! Stiffness of a cloth as a linear operator.
//!
//! Membrane and bending stiffness are invariant under translation: the blocks of a row sum to zero. They are therefore
//! assembled as one block per *pair* of vertices and applied to differences, `y_i += A_ij (x_j - x_i)`. That needs no
//! diagonal, and a uniform translation gives exactly zero, however the blocks were rounded. The linear solves store the
//! pairs in compressed rows ([`super::csr`]).

use nalgebra::Matrix3;
use wide::f32x4;

use super::pairs::PairList;
use super::quad::{self, Block};
use super::stencil::Stencils;
use geom::V3;

/// Rank-one stiffness `k a a^T` with `a = (w_0 n, ..., w_3 n)`.
#[derive(Clone, Copy, Debug)]
pub struct Contact4 {
    /// A vertex of weight zero may repeat another.
    pub vertices: [usize; 4],
    /// They sum to zero between layers of cloth, and to one on the body.
    pub weights: [f64; 4],
    /// Unit direction of the contact force.
    pub normal: V3,
    /// N/m.
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

/// Stiffness of triangle sides that are arcs (`sim::cloth::arcs`), in addition to that of their chords in the
/// membrane's blocks.
#[derive(Clone, Debug)]
pub struct ArcStiffness<'a> {
    pub pairs: &'a PairList,
    /// Curvature along each side as a weighted sum of positions.
    pub stencils: &'a Stencils,
    pub triangles: &'a [[u32; 3]],
    /// From the first vertex of each side to the second.
    pub chords: Vec<V3>,
    /// Derivative of half of each squared arc length with respect to the sum of the stencil, m.
    pub slopes: Vec<V3>,
    /// Geometric stiffness against curvature that the tension of each side causes, N/m.
    pub drawn: Vec<f64>,
    /// Stiffness of each triangle between half squared lengths and tensions of its sides, N/m3: each side with itself,
    /// then sides (0, 1), (1, 2), (2, 0).
    pub couplings: Vec<[f32; 6]>,
}

/// Symmetric positive semidefinite stiffness, assembled anew in each step.
pub struct Operator<'a> {
    /// Inertia, body contact, friction. N/m.
    pub diagonal: Vec<Matrix3<f64>>,
    pub membrane_pairs: &'a PairList,
    /// Off-diagonal blocks `K_ij`, `i < j`, N/m, with the bending stiffness of the pairs.
    pub membrane: Vec<Block<f32x4>>,
    /// Pairs coupled by bending and not by the membrane.
    pub bending_pairs: &'a PairList,
    /// Off-diagonal entries, the same for x, y and z, N/m.
    pub bending: &'a [f64],
    /// Two vertices and the stiffness, N/m.
    pub springs: Vec<([usize; 2], f64)>,
    pub contacts: Vec<Contact4>,
    /// `None` if all sides are straight.
    pub arcs: Option<ArcStiffness<'a>>,
}

impl Operator<'_> {
    /// Product of diagonal and contacts, without the rest, with a displacement `x`.
    pub fn contact_forces(&self, x: &[V3]) -> Vec<V3> {
        let mut y: Vec<V3> = self.diagonal.iter().zip(x).map(|(block, x)| block * x).collect();
        for contact in &self.contacts {
            contact.apply(x, &mut y);
        }
        y
    }

    pub fn diagonal_blocks(&self) -> Vec<Matrix3<f64>> {
        let mut blocks = self.own_blocks();
        for &([i, j], stiffness) in &self.springs {
            for v in [i, j] {
                blocks[v] += Matrix3::identity() * stiffness;
            }
        }
        // Sums of the rows and columns of the couplings. Rows of the stiffness sum to zero, so the diagonal is minus
        // these. Once a vertex is reached, all smaller vertices have been visited, and its column is complete.
        let mut columns = vec![[f32x4::ZERO; 3]; blocks.len()];
        let mut alike = vec![0.0; blocks.len()];
        for (i, block) in blocks.iter_mut().enumerate() {
            let mut rows = [f32x4::ZERO; 3];
            for (j, coupling) in self.membrane_pairs.upper().couplings(i, &self.membrane) {
                for (k, row) in coupling.iter().enumerate() {
                    rows[k] += *row;
                    columns[j][k] += *row;
                }
            }
            for (j, entry) in self.bending_pairs.upper().couplings(i, self.bending) {
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

    /// Diagonal blocks without the parts due to couplings and springs.
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
