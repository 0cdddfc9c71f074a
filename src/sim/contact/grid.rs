//! Things by place: a uniform grid kept as one sorted list, so that its order never depends on a hash.

use crate::geom::V3;

/// Boxes by the grid cells they touch.
pub struct BoxGrid {
    cell_m: f64,
    /// (cell, box), sorted.
    entries: Vec<([i32; 3], usize)>,
    /// First entry of each run of equal cells, with that cell.
    cells: Vec<([i32; 3], usize)>,
}

impl BoxGrid {
    /// Sorts the boxes of point sets, each widened by `reach_m`, into cells of `cell_m`.
    #[must_use]
    pub fn new<const N: usize>(x: &[V3], sets: &[[usize; N]], reach_m: f64, cell_m: f64) -> Self {
        let reach = V3::repeat(reach_m);
        let mut entries = Vec::with_capacity(4 * sets.len());
        for (index, set) in sets.iter().enumerate() {
            let low = set.iter().fold(V3::repeat(f64::MAX), |low, &v| low.inf(&x[v])) - reach;
            let high = set.iter().fold(V3::repeat(f64::MIN), |high, &v| high.sup(&x[v])) + reach;
            let (low, high) = (cell_of(&low, cell_m), cell_of(&high, cell_m));
            for i in low[0]..=high[0] {
                for j in low[1]..=high[1] {
                    for k in low[2]..=high[2] {
                        entries.push(([i, j, k], index));
                    }
                }
            }
        }
        entries.sort_unstable();
        let starts = |i: &usize| *i == 0 || entries[*i].0 != entries[*i - 1].0;
        let cells = (0..entries.len()).filter(starts).map(|i| (entries[i].0, i)).collect();
        Self { cell_m, entries, cells }
    }

    /// Boxes that may hold a point, in increasing order.
    pub fn near(&self, p: &V3) -> impl Iterator<Item = usize> + '_ {
        let cell = cell_of(p, self.cell_m);
        let found = self.cells.binary_search_by_key(&cell, |c| c.0);
        let range = found.map_or(0..0, |i| {
            let end = self.cells.get(i + 1).map_or(self.entries.len(), |next| next.1);
            self.cells[i].1..end
        });
        self.entries[range].iter().map(|e| e.1)
    }
}

fn cell_of(p: &V3, cell_m: f64) -> [i32; 3] {
    [0, 1, 2].map(|k| (p[k] / cell_m).floor() as i32)
}
