//! Uniform grid of bounding boxes. It is filled by a counting sort, so that its order does not depend on a hash.

use super::bounds::Bounds;
use geom::V3;
use linalg::rows::sorted_by_row;

pub struct BoxGrid {
    cell_m: f64,
    low: V3,
    size: [usize; 3],
    half_m: f64,
    /// First box of each cell, then the number of boxes.
    starts: Vec<u32>,
    /// In the order of the cells, so that a search reads memory sequentially.
    boxes: Vec<(Bounds, u32)>,
}

geom::constants! {
    "contact.grid",
    /// Greatest number of cells. Where there would be more, the cells are larger.
    const MOST_CELLS: f64 = 1e6;
    /// Factor on [`BoxGrid::half_m`] that covers rounding.
    const ROUNDED: f64 = 1.0 + 1e-5;
}

impl BoxGrid {
    pub fn new<const N: usize>(x: &[V3], sets: &[[usize; N]], reach_m: f64, cell_m: f64) -> Self {
        let reach = V3::repeat(reach_m);
        let corners = |set: &[usize; N]| {
            let corner = x[set[0]];
            let (low, high) = set[1..].iter().fold((corner, corner), |(l, h), v| (l.inf(&x[*v]), h.sup(&x[*v])));
            (low - reach, high + reach)
        };
        let corners: Vec<(V3, V3)> = sets.iter().map(corners).collect();
        let middles: Vec<V3> = corners.iter().map(|(low, high)| (low + high) / 2.0).collect();
        let half_m = corners.iter().map(|(low, high)| (high - low).max()).fold(0.0, f64::max) / 2.0 * ROUNDED;
        let first = middles.first().copied().unwrap_or_default();
        let (low, high) = middles.iter().fold((first, first), |(l, h), m| (l.inf(m), h.sup(m)));
        let wanted = (high - low).iter().map(|extent| extent / cell_m + 1.0).product::<f64>();
        let cell_m = cell_m * (wanted / MOST_CELLS).max(1.0).cbrt();
        let size = [0, 1, 2].map(|k| ((high - low)[k] / cell_m) as usize + 1);
        let mut grid = Self { cell_m, low, size, half_m, starts: Vec::new(), boxes: Vec::new() };
        let cells: Vec<(usize, u32)> = middles.iter().map(|m| grid.number(grid.cell(m))).zip(0..).collect();
        let (starts, order) = sorted_by_row(size.iter().product(), &cells, |(cell, _)| *cell, |(_, which)| *which);
        grid.starts = starts;
        grid.boxes =
            order.into_iter().map(|k| (Bounds::new(&corners[k as usize].0, &corners[k as usize].1), k)).collect();
        grid
    }

    /// Sets whose boxes overlap that of the points, ascending. Rounding may add a few others.
    pub fn near<'f, const N: usize>(&self, points: [&V3; N], found: &'f mut Vec<usize>) -> &'f [usize] {
        let (low, high) = points.iter().fold((*points[0], *points[0]), |(low, high), p| (low.inf(p), high.sup(p)));
        let half = V3::repeat(self.half_m);
        let wanted = Bounds::new(&low, &high);
        let (from, to) = (self.cell(&(low - half)), self.cell(&(high + half)));
        found.clear();
        for k in from[2]..=to[2] {
            for j in from[1]..=to[1] {
                // Cells along x are contiguous.
                let row = [from[0], to[0]].map(|i| self.number([i, j, k]));
                let boxes = &self.boxes[self.starts[row[0]] as usize..self.starts[row[1] + 1] as usize];
                let met = boxes.iter().filter(|(bounds, _)| bounds.meets(&wanted));
                found.extend(met.map(|(_, which)| *which as usize));
            }
        }
        found.sort_unstable();
        found
    }

    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.size[0] * (j + self.size[1] * k)
    }

    fn cell(&self, p: &V3) -> [usize; 3] {
        let local = (p - self.low) / self.cell_m;
        let index = |l: f64, n: usize| (l as usize).min(n - 1);
        [index(local.x, self.size[0]), index(local.y, self.size[1]), index(local.z, self.size[2])]
    }
}
