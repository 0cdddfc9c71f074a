//! Things by place: a uniform grid, filled by counting, so that its order never depends on a hash.

use super::bounds::Bounds;
use crate::geom::V3;

/// Boxes by the grid cells they touch.
pub struct BoxGrid {
    cell_m: f64,
    low: V3,
    size: [usize; 3],
    /// Where each cell's boxes begin, and one more.
    starts: Vec<u32>,
    /// By cells, so that a search reads on through memory.
    boxes: Vec<(Bounds, u32)>,
}

/// Most cells: beyond that they grow.
const MOST_CELLS: f64 = 1e6;

impl BoxGrid {
    /// Sorts the boxes of point sets, each widened by `reach_m`, into cells of `cell_m` or more, for searches about boxes
    /// that extend no farther than `half_m` from their middles.
    #[must_use]
    pub fn new<const N: usize>(x: &[V3], sets: &[[usize; N]], reach_m: f64, half_m: f64, cell_m: f64) -> Self {
        let (reach, half) = (V3::repeat(reach_m), V3::repeat(half_m));
        let mut bounds = Vec::with_capacity(sets.len());
        let (mut lowest, mut highest) = (V3::repeat(f64::MAX), V3::repeat(f64::MIN));
        for set in sets {
            let (mut low, mut high) = (x[set[0]], x[set[0]]);
            for v in &set[1..] {
                (low, high) = (low.inf(&x[*v]), high.sup(&x[*v]));
            }
            (low, high) = (low - reach, high + reach);
            (lowest, highest) = (lowest.inf(&(low - half)), highest.sup(&(high + half)));
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
        let ranges: Vec<_> =
            bounds.iter().map(|(low, high)| (grid.cell(&(low - half)), grid.cell(&(high + half)))).collect();
        for range in &ranges {
            grid.each(range, |grid, cell| grid.starts[cell + 1] += 1);
        }
        for cell in 1..grid.starts.len() {
            grid.starts[cell] += grid.starts[cell - 1];
        }
        let mut next = grid.starts.clone();
        grid.boxes = vec![(Bounds::NOTHING, 0); next[next.len() - 1] as usize];
        for (index, (range, (low, high))) in ranges.iter().zip(&bounds).enumerate() {
            let entry = (Bounds::new(low, high), index as u32);
            grid.each(range, |grid, cell| {
                grid.boxes[next[cell] as usize] = entry;
                next[cell] += 1;
            });
        }
        grid
    }

    /// Sets within reach of the box of some points, in increasing order: all of them, and few others.
    pub fn near<const N: usize>(&self, points: [&V3; N]) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = points.iter().fold((*points[0], *points[0]), |(low, high), p| (low.inf(p), high.sup(p)));
        let middle = (low + high) / 2.0;
        let local = (middle - self.low) / self.cell_m;
        let is_inside = (0..3).all(|k| local[k] >= 0.0 && local[k] < self.size[k] as f64);
        let range = if is_inside {
            let cell = self.number(self.cell(&middle));
            self.starts[cell] as usize..self.starts[cell + 1] as usize
        } else {
            0..0
        };
        let wanted = Bounds::new(&low, &high);
        self.boxes[range].iter().filter(move |(bounds, _)| bounds.meets(&wanted)).map(|(_, index)| *index as usize)
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
