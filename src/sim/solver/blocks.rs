//! Cholesky factor of a sparse matrix of 6x6 blocks: the stiffness between patches.
//!
//! It is made in double precision and kept in single. The rounding of the factor is harmless where that of the matrix would
//! not be: `(L + dL)(L + dL)^T` stays positive definite, and the softest mode is off by `eps` times the square *root* of the
//! condition number. A solve is one run through memory each way, over blocks that fill vector registers ([`super::packed`]).

use std::collections::BTreeSet;

use super::packed::{Lanes, Packed};

/// Degrees of freedom of a block.
pub const SIZE: usize = 6;

/// A block by columns.
pub type Dense = [[f64; SIZE]; SIZE];
/// Forces on a block row, or its motion.
pub type Row = [f32; SIZE];

/// The order of elimination and the pattern of the factor, which last as long as the pattern of the matrix.
pub struct Symbolic {
    /// Place of each row in the order of elimination.
    place: Vec<usize>,
    /// Where the blocks below the diagonal of each column begin; one longer than there are columns.
    starts: Vec<usize>,
    /// Their rows, ascending.
    rows: Vec<usize>,
    /// Where each pair of the matrix stands: its column, its block below the diagonal or `None` on it, and whether its first row is the
    /// one eliminated later, so that it stands there as it is and not transposed.
    entries: Vec<(usize, Option<usize>, bool)>,
}

/// The numbers of a factor.
pub struct Numeric {
    /// Inverses of the diagonal blocks.
    diagonal: Vec<Packed>,
    below: Vec<Packed>,
}

impl Symbolic {
    /// Of a symmetric matrix of `count` block rows with blocks at `pairs`, the smaller row first, the diagonal among them.
    #[must_use]
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

    fn entry(&self, [a, b]: [usize; 2]) -> (usize, Option<usize>, bool) {
        let [p, q] = [self.place[a], self.place[b]];
        let column = p.min(q);
        (column, (p != q).then(|| self.below(column, p.max(q))), p > q)
    }

    /// The blocks below the diagonal of each column, column by column.
    fn columns(&self) -> impl DoubleEndedIterator<Item = (usize, std::ops::Range<usize>)> + ExactSizeIterator {
        self.starts.windows(2).map(|ends| ends[0]..ends[1]).enumerate()
    }

    /// Number of a block below the diagonal.
    fn below(&self, column: usize, row: usize) -> usize {
        let rows = &self.rows[self.starts[column]..self.starts[column + 1]];
        self.starts[column] + rows.binary_search(&row).expect("elimination has filled it in")
    }

    /// Factorises the matrix with `blocks` at the pairs, that of `[a, b]` in the rows of `a`; `None` when it is not positive
    /// definite.
    #[must_use]
    pub fn factorise(&self, blocks: &[Dense]) -> Option<Numeric> {
        let mut diagonal = vec![[[0.0; SIZE]; SIZE]; self.place.len()];
        let mut below = vec![[[0.0; SIZE]; SIZE]; self.rows.len()];
        for (&(column, slot, is_below), block) in self.entries.iter().zip(blocks) {
            match slot {
                None => diagonal[column] = *block,
                Some(slot) => below[slot] = if is_below { *block } else { transposed(block) },
            }
        }
        for column in 0..diagonal.len() {
            let inverse = inverse_factor(&diagonal[column])?;
            diagonal[column] = inverse;
            let own = self.starts[column]..self.starts[column + 1];
            for block in &mut below[own.clone()] {
                *block = times_transposed(block, &inverse);
            }
            self.update(own, &mut diagonal, &mut below);
        }
        Some(Numeric {
            diagonal: diagonal.iter().map(Packed::new).collect(),
            below: below.iter().map(Packed::new).collect(),
        })
    }

    /// Takes the products of a column's blocks from the columns that it reaches.
    fn update(&self, own: std::ops::Range<usize>, diagonal: &mut [Dense], below: &mut [Dense]) {
        for k in own.clone() {
            let (column, factor) = (self.rows[k], below[k]);
            subtract_product(&mut diagonal[column], &factor, &factor);
            let mut target = self.starts[column];
            for l in k + 1..own.end {
                while self.rows[target] < self.rows[l] {
                    target += 1;
                }
                let other = below[l];
                subtract_product(&mut below[target], &other, &factor);
            }
        }
    }

    /// Solves in place, `x` by block rows of the matrix.
    pub fn solve(&self, numeric: &Numeric, x: &mut [Row]) {
        let mut solved = vec![Lanes::default(); x.len()];
        for (row, place) in x.iter().zip(&self.place) {
            solved[*place] = Lanes::of(row);
        }
        for (column, own) in self.columns() {
            let y = numeric.diagonal[column].times(&solved[column].row());
            let factors = Packed::factors(&y);
            for (row, below) in self.rows[own.clone()].iter().zip(&numeric.below[own]) {
                solved[*row].subtract(below.products(&factors));
            }
            solved[column] = Lanes::of(&y);
        }
        for (column, own) in self.columns().rev() {
            let mut sums = Packed::default();
            for (row, below) in self.rows[own.clone()].iter().zip(&numeric.below[own]) {
                sums.add_products(below, &solved[*row]);
            }
            let (y, known) = (solved[column].row(), sums.totals());
            let mut sums = Packed::default();
            sums.add_products(&numeric.diagonal[column], &Lanes::doubled(&std::array::from_fn(|k| y[k] - known[k])));
            solved[column] = Lanes::doubled(&sums.totals());
        }
        for (row, place) in x.iter_mut().zip(&self.place) {
            *row = solved[*place].first();
        }
    }
}

/// Eliminates rows in order of least degree: the place of each, and for each place the rows that its elimination couples.
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

/// `L^-1` of `A = L L^T`.
fn inverse_factor(a: &Dense) -> Option<Dense> {
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

/// `a b^T`.
fn times_transposed(a: &Dense, b: &Dense) -> Dense {
    let mut product = [[0.0; SIZE]; SIZE];
    for k in 0..SIZE {
        for c in 0..SIZE {
            for r in 0..SIZE {
                product[c][r] += a[k][r] * b[k][c];
            }
        }
    }
    product
}

/// `target -= a b^T`.
fn subtract_product(target: &mut Dense, a: &Dense, b: &Dense) {
    for c in 0..SIZE {
        let mut column = target[c];
        for k in 0..SIZE {
            for r in 0..SIZE {
                column[r] -= a[k][r] * b[k][c];
            }
        }
        target[c] = column;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::laboratory::sheets::noise;

    /// A positive definite matrix over pairs.
    fn matrix(pairs: &[[usize; 2]]) -> Vec<Dense> {
        let draw = noise(pairs.len() * 36, 7);
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
        let blocks = matrix(&pairs);
        let symbolic = Symbolic::new(count, &pairs);
        let numeric = symbolic.factorise(&blocks).expect("positive definite");
        let expect: Vec<Row> = (0..count).map(|a| std::array::from_fn(|k| ((7 * a + k) as f32).sin())).collect();
        let forces = times(&pairs, &blocks, &expect);
        let mut x: Vec<Row> = forces.iter().map(|f| f.map(|f| f as f32)).collect();
        symbolic.solve(&numeric, &mut x);
        for (found, expect) in x.iter().flatten().zip(expect.iter().flatten()) {
            assert!((found - expect).abs() < 1e-4, "{found} for {expect}");
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
