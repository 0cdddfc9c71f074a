//! Sparse matrix of short rows, such as finite difference stencils, and its transpose.

use super::quad::Quad;
use super::rows::sorted_by_row;
use super::simd::Simd;
use geom::V3;

/// Four terms of a sum, padded with weights of zero.
#[derive(Clone, Copy, Debug)]
struct Terms<I, W> {
    at: [I; 4],
    weights: [W; 4],
}

/// Sparse matrix of scalars that multiplies vectors of space, and its transpose.
#[derive(Clone, Debug, Default)]
pub struct Stencils {
    /// First four terms of each row, then the number of fours.
    starts: Vec<u32>,
    terms: Vec<Terms<u32, f64>>,
    single: Vec<Terms<u32, f32>>,
    column_starts: Vec<u32>,
    columns: Vec<Terms<u32, f32>>,
}

impl Stencils {
    /// Rows of (column, weight).
    pub fn new(rows: &[Vec<(usize, f64)>], columns: usize) -> Self {
        let rounded = |four: &Terms<u32, f64>| Terms { at: four.at, weights: four.weights.map(|w| w as f32) };
        let single = |terms: &[Terms<u32, f64>]| terms.iter().map(rounded).collect();
        let (starts, terms) = filled_up(rows.iter().map(Vec::as_slice));
        let of_columns: Vec<(usize, (usize, f64))> =
            rows.iter().enumerate().flat_map(|(row, terms)| terms.iter().map(move |(c, w)| (*c, (row, *w)))).collect();
        let (ends, sorted) = sorted_by_row(columns, &of_columns, |(c, _)| *c, |(_, term)| *term);
        let (column_starts, turned) = filled_up(ends.windows(2).map(|e| &sorted[e[0] as usize..e[1] as usize]));
        Self { single: single(&terms), columns: single(&turned), starts, terms, column_starts }
    }

    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let terms = &self.terms[self.starts[row] as usize..self.starts[row + 1] as usize];
        terms
            .iter()
            .flat_map(|Terms { at, weights: w }| (0..4).map(|k| (at[k] as usize, w[k])))
            .filter(|(_, w)| *w != 0.0)
    }

    #[inline(always)]
    pub fn sum(&self, row: usize, x: &[V3]) -> V3 {
        let mut sums = [V3::zeros(); 2];
        for Terms { at, weights: w } in &self.terms[self.starts[row] as usize..self.starts[row + 1] as usize] {
            sums[0] += x[at[0] as usize] * w[0] + x[at[2] as usize] * w[2];
            sums[1] += x[at[1] as usize] * w[1] + x[at[3] as usize] * w[3];
        }
        sums[0] + sums[1]
    }

    /// Multiplies the first vectors of `states`.
    #[inline(always)]
    pub fn sum_of<Q: Quad, S: Simd>(&self, simd: S, row: usize, states: &[[Q; 2]]) -> Q {
        let mut sums = [Q::ZERO; 4];
        for Terms { at, weights: w } in &self.single[self.starts[row] as usize..self.starts[row + 1] as usize] {
            for k in 0..4 {
                sums[k] = states[at[k] as usize][0].mul_add_on(Q::spread_single(w[k]), sums[k], simd);
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }

    #[inline(always)]
    pub fn column_sum<Q: Quad, S: Simd>(&self, simd: S, column: usize, of_rows: &[Q]) -> Q {
        let mut sums = [Q::ZERO; 4];
        for Terms { at, weights: w } in
            &self.columns[self.column_starts[column] as usize..self.column_starts[column + 1] as usize]
        {
            for k in 0..4 {
                sums[k] = of_rows[at[k] as usize].mul_add_on(Q::spread_single(w[k]), sums[k], simd);
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}

/// Pads lists of (index, weight) to fours. Returns the first four of each list, then their number, and the terms.
fn filled_up<'a>(lists: impl Iterator<Item = &'a [(usize, f64)]>) -> (Vec<u32>, Vec<Terms<u32, f64>>) {
    let (mut starts, mut terms) = (vec![0], Vec::new());
    for list in lists {
        for four in list.chunks(4) {
            let (mut at, mut weights) = ([four[0].0 as u32; 4], [0.0; 4]);
            for (k, (i, weight)) in four.iter().enumerate() {
                (at[k], weights[k]) = (*i as u32, *weight);
            }
            terms.push(Terms { at, weights });
        }
        starts.push(terms.len() as u32);
    }
    (starts, terms)
}
