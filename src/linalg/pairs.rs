//! Sparsity pattern of a symmetric block matrix: the pairs of vertices that it couples.

use std::ops::Range;

use super::rows::sorted_by_row;

/// Pairs of vertices `i < j` that some element couples, sorted.
#[derive(Clone, Debug, Default)]
pub struct PairList {
    pairs: Vec<[usize; 2]>,
    upper: Upper,
}

impl PairList {
    pub const EMPTY: &'static Self = &Self { pairs: Vec::new(), upper: Upper::EMPTY };

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

    /// Index of the pair `{i, j}`. `None` if it is not coupled.
    pub fn slot(&self, i: usize, j: usize) -> Option<usize> {
        self.upper.slot(i.min(j), i.max(j))
    }

    /// Rows are the smaller vertices.
    pub fn upper(&self) -> &Upper {
        &self.upper
    }

    /// Divides into patches. Centres are at least `apart` edges (pairs) from each other, and each vertex belongs to the
    /// nearest one. Returns the patch of each vertex, and the number of patches.
    pub fn divide(&self, vertices: usize, apart: usize) -> (Vec<usize>, usize) {
        let mut neighbours = vec![Vec::new(); vertices];
        for &[i, j] in &self.pairs {
            neighbours[i].push(j);
            neighbours[j].push(i);
        }
        let mut distance = vec![usize::MAX; vertices];
        let mut patch_of = vec![0; vertices];
        let mut count = 0;
        let mut queue = std::collections::VecDeque::new();
        for seed in 0..vertices {
            if distance[seed] < apart {
                continue;
            }
            (distance[seed], patch_of[seed]) = (0, count);
            queue.push_back(seed);
            while let Some(v) = queue.pop_front() {
                for &w in &neighbours[v] {
                    if distance[v] + 1 < distance[w] {
                        (distance[w], patch_of[w]) = (distance[v] + 1, count);
                        queue.push_back(w);
                    }
                }
            }
            count += 1;
        }
        (patch_of, count)
    }

    pub fn pairs(&self) -> &[[usize; 2]] {
        &self.pairs
    }
}

/// Strict upper triangle of a sparsity pattern in compressed rows.
#[derive(Clone, Debug, Default)]
pub struct Upper {
    /// Index of the first coupling of each vertex, then their number. Vertices beyond the greatest smaller vertex of a
    /// pair have no entry.
    starts: Vec<u32>,
    /// Larger vertex of each coupling.
    others: Vec<u32>,
}

impl Upper {
    pub const EMPTY: Self = Self { starts: Vec::new(), others: Vec::new() };

    /// Pairs are distinct and sorted, the smaller vertex first.
    pub fn new(pairs: &[[usize; 2]]) -> Self {
        let count = pairs.last().map_or(0, |pair| pair[0] + 1);
        let (starts, others) = sorted_by_row(count, pairs, |pair| pair[0], |pair| pair[1] as u32);
        Self { starts, others }
    }

    /// Index of the coupling of `v` with the larger vertex `other`. `None` if the two are not coupled.
    pub fn slot(&self, v: usize, other: usize) -> Option<usize> {
        let row = self.row(v);
        let at = self.others[row.clone()].binary_search(&(other as u32)).ok()?;
        Some(row.start + at)
    }

    #[inline(always)]
    fn row(&self, v: usize) -> Range<usize> {
        match self.starts.get(v..v + 2) {
            Some(&[from, to]) => from as usize..to as usize,
            _ => 0..0,
        }
    }

    /// Larger vertices that `v` is coupled to, each with its entry in `values`.
    #[inline(always)]
    pub fn couplings<'a, T>(&'a self, v: usize, values: &'a [T]) -> impl Iterator<Item = (usize, &'a T)> {
        let row = self.row(v);
        self.others[row.clone()].iter().map(|other| *other as usize).zip(&values[row])
    }
}

/// Cursor over the rows in the order of vertices, so that no row has to be searched for.
pub struct RowCursor<'a, T> {
    starts: &'a [u32],
    others: &'a [u32],
    values: &'a [T],
}

impl<'a, T> RowCursor<'a, T> {
    #[inline(always)]
    pub fn new(upper: &'a Upper, values: &'a [T]) -> Self {
        Self { starts: &upper.starts, others: &upper.others, values }
    }

    #[inline(always)]
    pub fn next_row(&mut self) -> impl Iterator<Item = (usize, &'a T)> {
        let mut count = 0;
        if let [from, to, ..] = *self.starts {
            count = (to - from) as usize;
            self.starts = &self.starts[1..];
        }
        let ((others, values), rest);
        ((others, rest), (values, self.values)) = (self.others.split_at(count), self.values.split_at(count));
        self.others = rest;
        others.iter().map(|other| *other as usize).zip(values)
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
        let (patch_of, count) = line.divide(100, 4);
        let sizes: Vec<usize> = (0..count).map(|a| patch_of.iter().filter(|b| **b == a).count()).collect();
        assert!(sizes.iter().all(|n| (2..=5).contains(n)), "{sizes:?}");
        // Cloth in two pieces, and a vertex of no pair.
        assert_eq!(PairList::new([[0, 1]]).divide(4, 4), (vec![0, 0, 1, 2], 3));
    }
}
