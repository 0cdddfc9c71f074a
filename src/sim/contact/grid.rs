//! Things by place: a uniform grid, filled by counting, so that its order never depends on a hash.

use crate::geom::V3;

/// Boxes by the grid cells they touch.
pub struct BoxGrid {
    cell_m: f64,
    low: V3,
    size: [usize; 3],
    /// Where each cell's boxes begin, and one more.
    starts: Vec<u32>,
    boxes: Vec<u32>,
}

/// Most cells: beyond that they grow.
const MOST_CELLS: f64 = 1e6;

impl BoxGrid {
    /// Sorts the boxes of point sets, each widened by `reach_m`, into cells of `cell_m` or more.
    #[must_use]
    pub fn new<const N: usize>(x: &[V3], sets: &[[usize; N]], reach_m: f64, cell_m: f64) -> Self {
        let reach = V3::repeat(reach_m);
        let mut bounds = Vec::with_capacity(sets.len());
        let (mut lowest, mut highest) = (V3::repeat(f64::MAX), V3::repeat(f64::MIN));
        for set in sets {
            let (mut low, mut high) = (x[set[0]], x[set[0]]);
            for v in &set[1..] {
                (low, high) = (low.inf(&x[*v]), high.sup(&x[*v]));
            }
            (low, high) = (low - reach, high + reach);
            (lowest, highest) = (lowest.inf(&low), highest.sup(&high));
            bounds.push((low, high));
        }
        if sets.is_empty() {
            (lowest, highest) = (V3::zeros(), V3::zeros());
        }
        let extent = highest - lowest;
        let wanted = extent.iter().map(|e| e / cell_m + 1.0).product::<f64>();
        let cell_m = cell_m * (wanted / MOST_CELLS).max(1.0).cbrt();
        let count = |e: f64| (e / cell_m) as usize + 1;
        let size = [count(extent.x), count(extent.y), count(extent.z)];
        let mut grid =
            Self { cell_m, low: lowest, size, starts: vec![0; size.iter().product::<usize>() + 1], boxes: Vec::new() };
        let ranges: Vec<_> = bounds.iter().map(|(low, high)| (grid.cell(low), grid.cell(high))).collect();
        for range in &ranges {
            grid.each(range, |grid, cell| grid.starts[cell + 1] += 1);
        }
        for cell in 1..grid.starts.len() {
            grid.starts[cell] += grid.starts[cell - 1];
        }
        let mut next = grid.starts.clone();
        grid.boxes = vec![0; next[next.len() - 1] as usize];
        for (index, range) in ranges.iter().enumerate() {
            grid.each(range, |grid, cell| {
                grid.boxes[next[cell] as usize] = index as u32;
                next[cell] += 1;
            });
        }
        grid
    }

    /// Boxes that may hold a point, in increasing order.
    pub fn near(&self, p: &V3) -> impl Iterator<Item = usize> + '_ {
        let local = (p - self.low) / self.cell_m;
        let is_inside = (0..3).all(|k| local[k] >= 0.0 && local[k] < self.size[k] as f64);
        let range = if is_inside {
            let cell = self.number(self.cell(p));
            self.starts[cell] as usize..self.starts[cell + 1] as usize
        } else {
            0..0
        };
        self.boxes[range].iter().map(|index| *index as usize)
    }

    fn each(&mut self, (low, high): &([usize; 3], [usize; 3]), mut act: impl FnMut(&mut Self, usize)) {
        for k in low[2]..=high[2] {
            for j in low[1]..=high[1] {
                for i in low[0]..=high[0] {
                    let cell = self.number([i, j, k]);
                    act(self, cell);
                }
            }
        }
    }

    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.size[0] * (j + self.size[1] * k)
    }

    fn cell(&self, p: &V3) -> [usize; 3] {
        let local = (p - self.low) / self.cell_m;
        let at = |l: f64, n: usize| (l as usize).min(n - 1);
        [at(local.x, self.size[0]), at(local.y, self.size[1]), at(local.z, self.size[2])]
    }
}
