//! The stiffness of a cloth as a linear operator.
//!
//! Membrane and bending stiffness are invariant under translation: the blocks of a row sum to zero. They are therefore
//! kept as one block per *pair* of vertices and applied to differences, `y_i += A_ij (x_j - x_i)`. That halves memory,
//! needs no diagonal, and a uniform translation is annihilated exactly, however the blocks were rounded.

use nalgebra::Matrix3;

use crate::geom::V3;

/// Pairs of vertices `i < j`, sorted, that some element couples.
#[derive(Clone, Debug, Default)]
pub struct PairList {
    pairs: Vec<[usize; 2]>,
}

impl PairList {
    /// Collects the distinct unordered pairs.
    #[must_use]
    pub fn new(pairs: impl IntoIterator<Item = [usize; 2]>) -> Self {
        let mut pairs: Vec<[usize; 2]> = pairs.into_iter().map(|[i, j]| [i.min(j), i.max(j)]).collect();
        pairs.sort_unstable();
        pairs.dedup();
        Self { pairs }
    }

    /// Position of the pair `{i, j}` in the list.
    #[must_use]
    pub fn slot(&self, i: usize, j: usize) -> Option<usize> {
        self.pairs.binary_search(&[i.min(j), i.max(j)]).ok()
    }

    /// The pairs.
    #[must_use]
    pub fn pairs(&self) -> &[[usize; 2]] {
        &self.pairs
    }
}

/// Coupling of four vertices along one direction: the stiffness `k a a^T` with `a = (w_0 n, ..., w_3 n)`.
#[derive(Clone, Copy, Debug)]
pub struct Contact4 {
    /// Vertices.
    pub vertices: [usize; 4],
    /// Weight of each vertex; they sum to zero between layers of cloth, and to one on the body.
    pub weights: [f64; 4],
    /// Unit direction.
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

/// A symmetric positive semidefinite stiffness, assembled anew each step.
pub struct Operator<'a> {
    /// Diagonal blocks: inertia, body contact, friction. N/m.
    pub diagonal: Vec<Matrix3<f64>>,
    /// Pairs coupled by the membrane.
    pub membrane_pairs: &'a PairList,
    /// Their off-diagonal blocks `K_ij` for `i < j`, N/m.
    pub membrane: Vec<Matrix3<f64>>,
    /// Pairs coupled by bending.
    pub bending_pairs: &'a PairList,
    /// Their off-diagonal entries, N/m, the same in x, y and z.
    pub bending: &'a [f64],
    /// Springs between two vertices: stiffness, N/m.
    pub springs: Vec<([usize; 2], f64)>,
    /// Contacts of the cloth with itself, and of points between vertices with the body.
    pub contacts: Vec<Contact4>,
}

/// `block v`, written out: most of a simulation's time is spent here, and the general product is not inlined.
pub(super) fn times(block: &Matrix3<f64>, v: &V3) -> V3 {
    let [a, b, c] = block.data.0;
    V3::new(
        a[0] * v.x + b[0] * v.y + c[0] * v.z,
        a[1] * v.x + b[1] * v.y + c[1] * v.z,
        a[2] * v.x + b[2] * v.y + c[2] * v.z,
    )
}

/// `block^T v`.
fn times_transposed(block: &Matrix3<f64>, v: &V3) -> V3 {
    let along = |column: [f64; 3]| column[0] * v.x + column[1] * v.y + column[2] * v.z;
    let [a, b, c] = block.data.0;
    V3::new(along(a), along(b), along(c))
}

impl Operator<'_> {
    /// `y = K x`.
    pub fn apply(&self, x: &[V3], y: &mut [V3]) {
        for ((y, d), x) in y.iter_mut().zip(&self.diagonal).zip(x) {
            *y = times(d, x);
        }
        for (&[i, j], block) in self.membrane_pairs.pairs().iter().zip(&self.membrane) {
            let difference = x[j] - x[i];
            y[i] += times(block, &difference);
            y[j] -= times_transposed(block, &difference);
        }
        for (&[i, j], entry) in self.bending_pairs.pairs().iter().zip(self.bending) {
            let pull = (x[j] - x[i]) * *entry;
            y[i] += pull;
            y[j] -= pull;
        }
        for &([i, j], stiffness) in &self.springs {
            let pull = (x[i] - x[j]) * stiffness;
            y[i] += pull;
            y[j] -= pull;
        }
        for contact in &self.contacts {
            contact.apply(x, y);
        }
    }

    /// The 3x3 blocks on the diagonal of `K`, for a block-Jacobi preconditioner.
    #[must_use]
    pub fn diagonal_blocks(&self) -> Vec<Matrix3<f64>> {
        let mut blocks = self.diagonal.clone();
        for (&[i, j], block) in self.membrane_pairs.pairs().iter().zip(&self.membrane) {
            blocks[i] -= block;
            blocks[j] -= block.transpose();
        }
        for (&[i, j], entry) in self.bending_pairs.pairs().iter().zip(self.bending) {
            for v in [i, j] {
                blocks[v] -= Matrix3::identity() * *entry;
            }
        }
        for &([i, j], stiffness) in &self.springs {
            for v in [i, j] {
                blocks[v] += Matrix3::identity() * stiffness;
            }
        }
        for (block, contact) in blocks.iter_mut().zip(self.contact_blocks()) {
            *block += contact;
        }
        blocks
    }

    /// What the contacts of the cloth with itself add to the diagonal blocks.
    #[must_use]
    pub fn contact_blocks(&self) -> Vec<Matrix3<f64>> {
        let mut blocks = vec![Matrix3::zeros(); self.diagonal.len()];
        for contact in &self.contacts {
            let outer = contact.normal * contact.normal.transpose() * contact.stiffness;
            for k in 0..4 {
                blocks[contact.vertices[k]] += outer * (contact.weights[k] * contact.weights[k]);
            }
        }
        blocks
    }
}
