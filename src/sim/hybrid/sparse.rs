//! Sparse symmetric positive definite systems, factorised once and solved often.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side};

/// Cholesky factor `L L^T`, on one thread.
pub struct Factor {
    /// Lower triangle; the first entry of each column is on the diagonal.
    matrix: SparseColMat<usize, f64>,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    scratch: MemBuffer,
}

impl Factor {
    /// Factorises the `n` x `n` matrix whose lower triangle is the sum of `entries` (row, column, value). `None` when
    /// it is not positive definite.
    pub fn new(n: usize, entries: &[(usize, usize, f64)]) -> Option<Self> {
        let lower = entries.iter().filter(|(i, j, _)| i >= j);
        let triplets: Vec<_> = lower.map(|&(row, col, val)| Triplet { row, col, val }).collect();
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &triplets).ok()?;
        let params = CholeskySymbolicParams::default();
        let symbolic =
            factorize_symbolic_cholesky(matrix.symbolic(), Side::Lower, SymmetricOrdering::Amd, params).ok()?;
        let values = numeric(&symbolic, &matrix)?;
        let scratch = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(3, Par::Seq));
        Some(Self { matrix, symbolic, values, scratch })
    }

    /// Adds to the diagonal and factorises again in the same order of elimination. Changes nothing when the matrix
    /// would not be positive definite any more, and returns `false`.
    pub fn add_to_diagonal(&mut self, added: &[f64]) -> bool {
        let starts: Vec<usize> = self.matrix.symbolic().col_ptr()[..added.len()].to_vec();
        let mut matrix = self.matrix.clone();
        for (start, by) in starts.iter().zip(added) {
            matrix.val_mut()[*start] += by;
        }
        let Some(values) = numeric(&self.symbolic, &matrix) else { return false };
        self.values = values;
        self.matrix = matrix;
        true
    }

    /// Solves for up to three right-hand sides, given one after the other in `columns`, in place.
    ///
    /// # Panics
    /// When `columns` is not one, two or three columns of the matrix's size.
    pub fn solve(&mut self, columns: &mut [f64]) {
        let n = self.symbolic.nrows();
        let count = columns.len() / n.max(1);
        assert!(count <= 3 && columns.len() == count * n, "{} numbers for {n} unknowns", columns.len());
        let rhs = MatMut::from_column_major_slice_mut(columns, n, count);
        let factor = LltRef::new(&self.symbolic, &self.values);
        factor.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, MemStack::new(&mut self.scratch));
    }
}

fn numeric(symbolic: &SymbolicCholesky<usize>, matrix: &SparseColMat<usize, f64>) -> Option<Vec<f64>> {
    let mut values = vec![0.0; symbolic.len_val()];
    let mut buffer = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()));
    symbolic
        .factorize_numeric_llt(
            &mut values,
            matrix.as_ref(),
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut buffer),
            Default::default(),
        )
        .ok()?;
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_solved() {
        // The second difference of a string fixed at both ends; x = (1, 2, 3) needs b = (0, 0, 4).
        let entries = [(0, 0, 2.0), (1, 1, 2.0), (2, 2, 2.0), (1, 0, -1.0), (2, 1, -1.0), (0, 1, 99.0)];
        let mut factor = Factor::new(3, &entries).expect("positive definite");
        let mut x = vec![0.0, 0.0, 4.0, 1.0, 0.0, 1.0];
        factor.solve(&mut x);
        for (found, expected) in x.iter().zip([1.0, 2.0, 3.0, 1.0, 1.0, 1.0]) {
            assert!((found - expected).abs() < 1e-12, "{x:?}");
        }
        assert!(factor.add_to_diagonal(&[0.0, 0.0, 1.0]));
        let mut x = vec![0.0, 0.0, 7.0];
        factor.solve(&mut x);
        assert!((x[0] - 1.0).abs() + (x[1] - 2.0).abs() + (x[2] - 3.0).abs() < 1e-12, "{x:?}");
        assert!(!factor.add_to_diagonal(&[-9.0, 0.0, 0.0]));
        assert!(Factor::new(2, &[(0, 0, 1.0), (1, 1, 1.0), (1, 0, 2.0)]).is_none(), "indefinite");
    }
}
