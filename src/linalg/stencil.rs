//! Many short weighted sums of the same numbers, one a row, and the same turned about.

use super::quad::Quad;
use super::rows::sorted_by_row;
use super::simd::Simd;
use geom::V3;

/// Four terms of a sum: sums are filled up with terms of no weight, so that four of them run side by side.
type Terms<I, W> = ([I; 4], [W; 4]);

/// A sparse matrix of numbers that multiplies vectors in space: row by row, and its transpose.
#[derive(Clone, Debug, Default)]
pub struct Stencils {
    /// Where the terms of each row begin, and one more.
    starts: Vec<u32>,
    terms: Vec<Terms<u32, f64>>,
    single: Vec<Terms<u32, f32>>,
    /// Where the terms of each column begin, and one more.
    column_starts: Vec<u32>,
    columns: Vec<Terms<u32, f32>>,
}

impl Stencils {
    /// Rows of (column, weight), over so many columns.
    #[must_use]
    pub fn new(rows: &[Vec<(usize, f64)>], columns: usize) -> Self {
        let single = |terms: &[Terms<u32, f64>]| terms.iter().map(|(at, w)| (*at, w.map(|w| w as f32))).collect();
        let (starts, terms) = filled_up(rows.iter().map(Vec::as_slice));
        let of_columns: Vec<(usize, (usize, f64))> =
            rows.iter().enumerate().flat_map(|(row, terms)| terms.iter().map(move |(c, w)| (*c, (row, *w)))).collect();
        let (ends, sorted) = sorted_by_row(columns, &of_columns, |(c, _)| *c, |(_, term)| *term);
        let (column_starts, turned) = filled_up(ends.windows(2).map(|e| &sorted[e[0] as usize..e[1] as usize]));
        Self { single: single(&terms), columns: single(&turned), starts, terms, column_starts }
    }

    /// The terms of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let terms = &self.terms[self.starts[row] as usize..self.starts[row + 1] as usize];
        terms.iter().flat_map(|(at, w)| (0..4).map(|k| (at[k] as usize, w[k]))).filter(|(_, w)| *w != 0.0)
    }

    /// The sum of a row over these vectors.
    #[inline(always)]
    #[must_use]
    pub fn sum(&self, row: usize, x: &[V3]) -> V3 {
        let mut sums = [V3::zeros(); 2];
        for (at, w) in &self.terms[self.starts[row] as usize..self.starts[row + 1] as usize] {
            sums[0] += x[at[0] as usize] * w[0] + x[at[2] as usize] * w[2];
            sums[1] += x[at[1] as usize] * w[1] + x[at[3] as usize] * w[3];
        }
        sums[0] + sums[1]
    }

    /// The sum of a row over the first of these states.
    #[inline(always)]
    pub fn sum_of<Q: Quad, S: Simd>(&self, simd: S, row: usize, states: &[[Q; 2]]) -> Q {
        let mut sums = [Q::ZERO; 4];
        for (at, w) in &self.single[self.starts[row] as usize..self.starts[row + 1] as usize] {
            for k in 0..4 {
                sums[k] = states[at[k] as usize][0].mul_add_on(Q::spread_single(w[k]), sums[k], simd);
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }

    /// The sum of a column over what rows have.
    #[inline(always)]
    pub fn column_sum<Q: Quad, S: Simd>(&self, simd: S, column: usize, of_rows: &[Q]) -> Q {
        let mut sums = [Q::ZERO; 4];
        for (at, w) in &self.columns[self.column_starts[column] as usize..self.column_starts[column + 1] as usize] {
            for k in 0..4 {
                sums[k] = of_rows[at[k] as usize].mul_add_on(Q::spread_single(w[k]), sums[k], simd);
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}

/// Where the terms of each list begin, and these in fours.
fn filled_up<'a>(lists: impl Iterator<Item = &'a [(usize, f64)]>) -> (Vec<u32>, Vec<Terms<u32, f64>>) {
    let (mut starts, mut terms) = (vec![0], Vec::new());
    for list in lists {
        for four in list.chunks(4) {
            let (mut at, mut weights) = ([four[0].0 as u32; 4], [0.0; 4]);
            for (k, (i, weight)) in four.iter().enumerate() {
                (at[k], weights[k]) = (*i as u32, *weight);
            }
            terms.push((at, weights));
        }
        starts.push(terms.len() as u32);
    }
    (starts, terms)
}
