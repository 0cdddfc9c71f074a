//! Cholesky factor of a sparse matrix of 6x6 blocks: the stiffness between the patches of the coarse space.
//!
//! It is computed in double precision and kept in single. Rounding the factor is harmless where rounding the matrix
//! would not be: `(L + dL)(L + dL)^T` stays positive definite, and the relative error of the softest mode is `eps`
//! times the *square root* of the condition number.
//!
//! The factor is `L D L^T` with identity blocks on the diagonal of `L`. In a substitution each column waits for those
//! before it, but not for a product with a diagonal block: `D` is applied in between, to all rows at once. A solve is
//! one pass through memory in each direction, over blocks that fill vector registers (`packed`).

mod packed;

use std::collections::BTreeSet;

use wide::f64x4;

use super::quad::Quad;
use super::simd::{self, Kernel, Simd, each};
use packed::{Blockwise, Packed};

/// Degrees of freedom of a patch.
pub const SIZE: usize = 6;

/// Block by columns.
pub type Dense = [[f64; SIZE]; SIZE];
/// Forces and moments on a patch, or its translation and rotation.
pub type Row = [f32; SIZE];

/// Order of elimination and sparsity pattern, valid for all matrices with the same pattern.
pub struct Symbolic {
    /// Position of each row in the order of elimination.
    place: Vec<usize>,
    /// Index of each column's first block below the diagonal, then the number of blocks.
    starts: Vec<usize>,
    /// Rows of these blocks, ascending in each column.
    rows: Vec<usize>,
    entries: Vec<Entry>,
}

/// Block of the factor to which a pair of the matrix is added.
#[derive(Clone, Copy)]
struct Entry {
    column: usize,
    /// Index of the block below the diagonal. `None` on the diagonal.
    below: Option<usize>,
    /// True if the pair's first row is eliminated later. Its block is then added as it is, otherwise transposed.
    is_upright: bool,
}

pub struct Numeric {
    /// Inverses of the blocks of `D`.
    pivots: Vec<Packed>,
    /// Blocks of `L` below the diagonal.
    below: Vec<Packed>,
}

impl Symbolic {
    /// Analyses a symmetric matrix of `count` block rows with blocks at `pairs`, the diagonal included, the smaller row
    /// first.
    pub fn new(count: usize, pairs: &[[usize; 2]]) -> Self {
        let (place, columns) = eliminate(count, pairs);
        let mut starts = vec![0];
        let mut rows: Vec<usize> = Vec::new();
        for column in &columns {
            let from = rows.len();
            rows.extend(column.iter().map(|&row| place[row]));
            rows[from..].sort_unstable();
            starts.push(rows.len());
        }
        let mut symbolic = Self { place, starts, rows, entries: Vec::new() };
        symbolic.entries = pairs.iter().map(|&pair| symbolic.entry(pair)).collect();
        symbolic
    }

    fn entry(&self, [a, b]: [usize; 2]) -> Entry {
        let [p, q] = [self.place[a], self.place[b]];
        let column = p.min(q);
        Entry { column, below: (p != q).then(|| self.below(column, p.max(q))), is_upright: p > q }
    }

    fn columns(&self) -> impl DoubleEndedIterator<Item = (usize, std::ops::Range<usize>)> + ExactSizeIterator {
        self.starts.windows(2).map(|ends| ends[0]..ends[1]).enumerate()
    }

    fn below(&self, column: usize, row: usize) -> usize {
        let rows = &self.rows[self.starts[column]..self.starts[column + 1]];
        self.starts[column] + rows.binary_search(&row).expect("elimination has filled it in")
    }

    /// The block at `[a, b]` is that in the rows of `a`. `None` if the matrix is not positive definite.
    pub fn factorise(&self, blocks: &[Dense]) -> Option<Numeric> {
        simd::dispatch(Factorisation { symbolic: self, blocks })
    }

    /// Solves in place. `x` is in the order of the matrix.
    #[inline(always)]
    pub fn solve<S: Simd>(&self, simd: S, numeric: &Numeric, x: &mut [Row]) {
        let blockwise = Blockwise(simd);
        let mut solved = vec![blockwise.parts(Row::default()); x.len()];
        for (row, place) in x.iter().zip(&self.place) {
            solved[*place] = blockwise.parts(*row);
        }
        for (column, own) in self.columns() {
            let y = blockwise.row(&solved[column]);
            let factors = blockwise.factors(each!(k of 6 => -y[k]));
            for (row, below) in self.rows[own.clone()].iter().zip(&numeric.below[own]) {
                blockwise.add_times(&mut solved[*row], below, &factors);
            }
        }
        for (row, pivot) in solved.iter_mut().zip(&numeric.pivots) {
            let mut sums = blockwise.parts(Row::default());
            blockwise.add_times(&mut sums, pivot, &blockwise.factors(blockwise.row(row)));
            *row = sums;
        }
        for (column, own) in self.columns().rev() {
            let mut sums = blockwise.nothing();
            for (row, below) in self.rows[own.clone()].iter().zip(&numeric.below[own]) {
                blockwise.add_products(&mut sums, below, &solved[*row]);
            }
            let (y, known) = (blockwise.row(&solved[column]), blockwise.totals(&sums));
            solved[column] = blockwise.repeated(each!(k of 6 => y[k] - known[k]));
        }
        for (row, place) in x.iter_mut().zip(&self.place) {
            *row = blockwise.first(&solved[*place]);
        }
    }
}

struct Factorisation<'a> {
    symbolic: &'a Symbolic,
    blocks: &'a [Dense],
}

impl Kernel for Factorisation<'_> {
    type Output = Option<Numeric>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Option<Numeric> {
        let symbolic = self.symbolic;
        let mut diagonal = vec![Padded::default(); symbolic.place.len()];
        let mut below = vec![Padded::default(); symbolic.rows.len()];
        for (&Entry { column, below: slot, is_upright }, block) in symbolic.entries.iter().zip(self.blocks) {
            match slot {
                None => diagonal[column] = Padded::new(block),
                Some(slot) => below[slot] = Padded::new(&if is_upright { *block } else { transposed(block) }),
            }
        }
        // Right-looking elimination with `A = L L^T`. The inverses of the diagonal blocks of `L` are stored in place of
        // these.
        for (column, own) in symbolic.columns() {
            let root = Padded::new(&inverse_root(&diagonal[column].dense())?);
            diagonal[column] = root;
            let (known, rest) = below.split_at_mut(own.end);
            for block in &mut known[own.clone()] {
                *block = product(simd, block, &root);
            }
            for k in own.clone() {
                let (row, factor) = (symbolic.rows[k], &known[k]);
                diagonal[row].subtract_product(simd, factor, factor);
                let mut target = symbolic.starts[row];
                for l in k + 1..own.end {
                    while symbolic.rows[target] < symbolic.rows[l] {
                        target += 1;
                    }
                    rest[target - own.end].subtract_product(simd, &known[l], factor);
                }
            }
        }
        for (column, own) in symbolic.columns() {
            let root = Padded::new(&transposed(&diagonal[column].dense()));
            for block in &mut below[own] {
                *block = product(simd, block, &root);
            }
            diagonal[column] = product(simd, &root, &root);
        }
        let packed = |block: &Padded| Packed::new(&block.dense());
        Some(Numeric { pivots: diagonal.iter().map(packed).collect(), below: below.iter().map(packed).collect() })
    }
}

/// Block by columns, each padded with zeros to two registers of four.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
struct Padded([[f64; 8]; SIZE]);

impl Padded {
    #[inline(always)]
    fn new(block: &Dense) -> Self {
        Self(block.map(|[a, b, c, d, e, f]| [a, b, c, d, e, f, 0.0, 0.0]))
    }

    #[inline(always)]
    fn dense(&self) -> Dense {
        self.0.map(|[a, b, c, d, e, f, ..]| [a, b, c, d, e, f])
    }

    #[inline(always)]
    fn column(&self, c: usize) -> [f64x4; 2] {
        let [a, b, c, d, e, f, g, h] = self.0[c];
        [f64x4::from([a, b, c, d]), f64x4::from([e, f, g, h])]
    }

    /// Subtracts `a b^T`.
    #[inline(always)]
    fn subtract_product<S: Simd>(&mut self, simd: S, a: &Self, b: &Self) {
        let columns = each!(k of 6 => a.column(k));
        for c in 0..SIZE {
            let [mut head, mut tail] = self.column(c);
            for (k, column) in columns.iter().enumerate() {
                let factor = f64x4::splat(b.0[k][c]);
                head = column[0].neg_mul_add_on(factor, head, simd);
                tail = column[1].neg_mul_add_on(factor, tail, simd);
            }
            self.set_column(c, [head, tail]);
        }
    }

    #[inline(always)]
    fn set_column(&mut self, c: usize, [head, tail]: [f64x4; 2]) {
        let ([a, b, c_, d], [e, f, g, h]) = (head.to_array(), tail.to_array());
        self.0[c] = [a, b, c_, d, e, f, g, h];
    }
}

/// `a b^T`.
#[inline(always)]
fn product<S: Simd>(simd: S, a: &Padded, b: &Padded) -> Padded {
    let mut negative = Padded::default();
    negative.subtract_product(simd, a, b);
    for c in 0..SIZE {
        let [head, tail] = negative.column(c);
        negative.set_column(c, [-head, -tail]);
    }
    negative
}

/// Eliminates in the order of minimum degree. Returns the position of each row, and for each position the rows that its
/// elimination couples.
fn eliminate(count: usize, pairs: &[[usize; 2]]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut neighbours = vec![BTreeSet::new(); count];
    for &[a, b] in pairs.iter().filter(|[a, b]| a != b) {
        neighbours[a].insert(b);
        neighbours[b].insert(a);
    }
    let mut queue: BTreeSet<(usize, usize)> = neighbours.iter().enumerate().map(|(v, n)| (n.len(), v)).collect();
    let mut place = vec![0; count];
    let mut columns = Vec::with_capacity(count);
    while let Some((_, row)) = queue.pop_first() {
        place[row] = columns.len();
        let coupled: Vec<usize> = std::mem::take(&mut neighbours[row]).into_iter().collect();
        for &v in &coupled {
            queue.remove(&(neighbours[v].len(), v));
            neighbours[v].remove(&row);
            neighbours[v].extend(coupled.iter().filter(|w| **w != v));
            queue.insert((neighbours[v].len(), v));
        }
        columns.push(coupled);
    }
    (place, columns)
}

fn transposed(block: &Dense) -> Dense {
    std::array::from_fn(|c| std::array::from_fn(|r| block[r][c]))
}

/// `L^-1` of `A = L L^T`. `None` if `A` is not positive definite.
fn inverse_root(a: &Dense) -> Option<Dense> {
    let mut l = [[0.0; SIZE]; SIZE];
    for c in 0..SIZE {
        let pivot = a[c][c] - (0..c).map(|k| l[k][c] * l[k][c]).sum::<f64>();
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        l[c][c] = pivot.sqrt();
        for r in c + 1..SIZE {
            l[c][r] = (a[c][r] - (0..c).map(|k| l[k][r] * l[k][c]).sum::<f64>()) / l[c][c];
        }
    }
    let mut inverse = [[0.0; SIZE]; SIZE];
    for c in 0..SIZE {
        for r in c..SIZE {
            let known: f64 = (c..r).map(|k| l[k][r] * inverse[c][k]).sum();
            inverse[c][r] = (f64::from(u8::from(r == c)) - known) / l[r][r];
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Plain;

    fn matrix(pairs: &[[usize; 2]]) -> Vec<Dense> {
        let draw: Vec<f64> = (0..pairs.len() * 36).map(|k| (37.0 * k as f64).sin()).collect();
        let degree = |a: usize| pairs.iter().filter(|p| p.contains(&a)).count() as f64;
        pairs
            .iter()
            .enumerate()
            .map(|(k, &[a, b])| {
                std::array::from_fn(|c| {
                    std::array::from_fn(|r| {
                        let (low, high) = (c.min(r), c.max(r));
                        let symmetric = draw[36 * k + 6 * low + high];
                        match (a == b, c == r) {
                            (true, true) => 20.0 * degree(a),
                            (true, false) => symmetric,
                            (false, _) => draw[36 * k + 6 * c + r],
                        }
                    })
                })
            })
            .collect()
    }

    fn times(pairs: &[[usize; 2]], blocks: &[Dense], x: &[Row]) -> Vec<[f64; SIZE]> {
        let mut y = vec![[0.0; SIZE]; x.len()];
        for (&[a, b], block) in pairs.iter().zip(blocks) {
            for c in 0..SIZE {
                for r in 0..SIZE {
                    y[a][r] += block[c][r] * f64::from(x[b][c]);
                    if a != b {
                        y[b][c] += block[c][r] * f64::from(x[a][r]);
                    }
                }
            }
        }
        y
    }

    fn check(count: usize, mut pairs: Vec<[usize; 2]>) {
        pairs.extend((0..count).map(|a| [a, a]));
        pairs.sort_unstable();
        let solves = Solves { count, blocks: matrix(&pairs), pairs };
        simd::dispatch(&solves);
        Plain.run(&solves);
    }

    struct Solves {
        count: usize,
        pairs: Vec<[usize; 2]>,
        blocks: Vec<Dense>,
    }

    impl Kernel for &Solves {
        type Output = ();

        fn run<S: Simd>(self, simd: S) {
            let Solves { count, pairs, blocks } = self;
            let symbolic = Symbolic::new(*count, pairs);
            let numeric = Factorisation { symbolic: &symbolic, blocks }.run(simd).expect("positive definite");
            let expect: Vec<Row> = (0..*count).map(|a| std::array::from_fn(|k| ((7 * a + k) as f32).sin())).collect();
            let forces = times(pairs, blocks, &expect);
            let mut x: Vec<Row> = forces.iter().map(|f| f.map(|f| f as f32)).collect();
            symbolic.solve(simd, &numeric, &mut x);
            for (found, expect) in x.iter().flatten().zip(expect.iter().flatten()) {
                assert!((found - expect).abs() < 1e-4, "{found} for {expect}");
            }
        }
    }

    #[test]
    fn a_factor_solves() {
        check(1, vec![]);
        check(4, vec![[0, 1], [1, 2], [2, 3], [0, 3]]);
        let grid = |w: usize, h: usize| {
            let across = (0..w * h).filter(move |v| v % w + 1 < w).map(|v| [v, v + 1]);
            let down = (0..w * (h - 1)).map(move |v| [v, v + w]);
            across.chain(down).collect::<Vec<_>>()
        };
        check(35, grid(7, 5));
        check(120, grid(10, 12));
    }

    #[test]
    fn what_is_not_positive_definite_has_none() {
        let symbolic = Symbolic::new(1, &[[0, 0]]);
        assert!(symbolic.factorise(&[[[0.0; SIZE]; SIZE]]).is_none());
        let negative: Dense = std::array::from_fn(|c| std::array::from_fn(|r| if c == r { -1.0 } else { 0.0 }));
        assert!(symbolic.factorise(&[negative]).is_none());
    }
}
