//! Sparse Cholesky factor of the stiffness of a cloth, kept over several steps as a preconditioner.
//!
//! Block-Jacobi needs hundreds of iterations, because cloth is a million times softer in bending than in its plane. A
//! factor of the present stiffness needs one or two, and that of a few steps ago still few.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{MatMut, Par, Side};
use nalgebra::Matrix3;
use wide::f64x4;

use super::operator::Operator;
use super::pairs::PairList;
use super::quad::{self, Quad};

pub struct Factor {
    /// Lower triangle by columns, with three rows and columns per vertex.
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicLlt<usize>,
    numeric: Option<Llt<usize, f64>>,
    pairs: PairList,
    /// Index of the block of each membrane pair, bending pair and spring.
    slots: [Vec<usize>; 3],
    /// Rank of the block of each pair among those of its smaller vertex.
    rank: Vec<usize>,
    values: Vec<f64>,
}

impl Factor {
    /// # Panics
    /// If the memory is exhausted.
    pub fn new(operator: &Operator) -> Self {
        // Other threads run other simulations, so this one stays single. Its sums then do not depend on the number of
        // threads.
        faer::set_global_parallelism(Par::Seq);
        let n = operator.diagonal.len();
        let springs: Vec<[usize; 2]> = operator.springs.iter().map(|s| s.0).collect();
        let lists = [operator.membrane_pairs.pairs(), operator.bending_pairs.pairs(), &springs];
        let pairs = PairList::new(lists.iter().flat_map(|list| list.iter().copied()));
        let slot = |&[i, j]: &[usize; 2]| pairs.slot(i, j).expect("the pair was just collected");
        let slots = lists.map(|list| list.iter().map(slot).collect());
        let mut starts = vec![0; n + 1];
        for pair in pairs.pairs() {
            starts[pair[0] + 1] += 1;
        }
        for v in 0..n {
            starts[v + 1] += starts[v];
        }
        let rank = pairs.pairs().iter().enumerate().map(|(k, pair)| k - starts[pair[0]]).collect();
        let mut columns = vec![0];
        let mut rows = Vec::with_capacity(6 * n + 9 * pairs.pairs().len());
        for v in 0..n {
            for c in 0..3 {
                rows.extend((c..3).map(|r| 3 * v + r));
                rows.extend(pairs.pairs()[starts[v]..starts[v + 1]].iter().flat_map(|p| (0..3).map(|r| 3 * p[1] + r)));
                columns.push(rows.len());
            }
        }
        let values = vec![0.0; rows.len()];
        let pattern = SymbolicSparseColMat::new_checked(3 * n, 3 * n, columns, None, rows);
        let symbolic = SymbolicLlt::try_new(pattern.as_ref(), Side::Lower).expect("a checked pattern has a factor");
        Self { pattern, symbolic, numeric: None, pairs, slots, rank, values }
    }

    /// Contacts of the cloth with itself come and go, so only their diagonal blocks are included.
    pub fn refresh(&mut self, operator: &Operator) {
        self.values.fill(0.0);
        for (v, block) in operator.own_blocks().iter().enumerate() {
            self.add_diagonal(v, block);
        }
        let [membrane, bending, springs] = std::mem::take(&mut self.slots);
        for (&slot, block) in membrane.iter().zip(&operator.membrane) {
            self.add_pair(slot, &quad::matrix(block));
        }
        for (&slot, entry) in bending.iter().zip(operator.bending) {
            self.add_pair(slot, &Matrix3::from_diagonal_element(*entry));
        }
        for (&slot, spring) in springs.iter().zip(&operator.springs) {
            self.add_pair(slot, &Matrix3::from_diagonal_element(-spring.1));
        }
        self.slots = [membrane, bending, springs];
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), &self.values);
        self.numeric = Llt::try_new_with_symbolic(self.symbolic.clone(), matrix, Side::Lower).ok();
    }

    /// Adds the off-diagonal block `K_ij`, `i < j`, and subtracts it from both diagonal blocks, because rows sum to
    /// zero.
    fn add_pair(&mut self, slot: usize, block: &Matrix3<f64>) {
        let [i, j] = self.pairs.pairs()[slot];
        for c in 0..3 {
            let start = self.pattern.col_ptr()[3 * i + c] + 3 - c + 3 * self.rank[slot];
            for r in 0..3 {
                self.values[start + r] += block[(c, r)];
            }
        }
        self.add_diagonal(i, &-block);
        self.add_diagonal(j, &-block);
    }

    /// Stores the lower triangle.
    fn add_diagonal(&mut self, v: usize, block: &Matrix3<f64>) {
        for c in 0..3 {
            let start = self.pattern.col_ptr()[3 * v + c];
            for r in c..3 {
                // A single membrane block may be asymmetric. The sum of all is symmetric.
                self.values[start + r - c] += 0.5 * (block[(r, c)] + block[(c, r)]);
            }
        }
    }

    /// Uses the stiffness of the last [`Factor::refresh`]; `z = r` before the first.
    pub fn solve(&self, r: &[f64x4], z: &mut [f64x4]) {
        let mut flat: Vec<f64> = r.iter().flat_map(|v| <[f64; 3]>::from(v.vector())).collect();
        if let Some(factor) = &self.numeric {
            let rows = flat.len();
            factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut flat, rows, 1));
        }
        for (z, v) in z.iter_mut().zip(flat.chunks_exact(3)) {
            *z = f64x4::from([v[0], v[1], v[2], 0.0]);
        }
    }
}
