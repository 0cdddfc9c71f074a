//! Point location: the triangle of a plane mesh that contains a point.

use geom::V2;

pub struct Locator<'a> {
    points: &'a [V2],
    triangles: &'a [[usize; 3]],
    low: V2,
    cell: f64,
    count: [usize; 2],
    buckets: Vec<Vec<usize>>,
}

impl<'a> Locator<'a> {
    pub fn new(points: &'a [V2], triangles: &'a [[usize; 3]]) -> Self {
        let low = points.iter().fold(V2::repeat(f64::MAX), |a, b| a.inf(b));
        let high = points.iter().fold(V2::repeat(f64::MIN), |a, b| a.sup(b));
        let cell = ((high - low).product() / triangles.len().max(1) as f64).sqrt().max(1e-9);
        let count = [high.x - low.x, high.y - low.y].map(|extent| (extent / cell) as usize + 1);
        let mut locator = Self { points, triangles, low, cell, count, buckets: vec![Vec::new(); count[0] * count[1]] };
        for (index, t) in triangles.iter().enumerate() {
            let [a, b, c] = t.map(|v| points[v]);
            let (from, to) = (locator.bucket(a.inf(&b).inf(&c)), locator.bucket(a.sup(&b).sup(&c)));
            for row in from[1]..=to[1] {
                for column in from[0]..=to[0] {
                    locator.buckets[row * count[0] + column].push(index);
                }
            }
        }
        locator
    }

    fn bucket(&self, p: V2) -> [usize; 2] {
        [0, 1].map(|k| (((p[k] - self.low[k]) / self.cell).max(0.0) as usize).min(self.count[k] - 1))
    }

    /// Triangle that contains a point, or the nearest of those about it, with barycentric weights clamped to be not
    /// negative.
    pub fn locate(&self, p: V2) -> Option<(usize, [f64; 3])> {
        let [column, row] = self.bucket(p);
        let most = self.count[0].max(self.count[1]);
        for ring in 0..most {
            let rows = row.saturating_sub(ring)..=(row + ring).min(self.count[1] - 1);
            let near = rows.flat_map(|r| {
                let columns = column.saturating_sub(ring)..=(column + ring).min(self.count[0] - 1);
                columns.flat_map(move |c| &self.buckets[r * self.count[0] + c])
            });
            let weighed = near.map(|&t| (t, self.weights(t, p)));
            let least = |w: &[f64; 3]| w.iter().copied().fold(f64::MAX, f64::min);
            let best = weighed.max_by(|a, b| least(&a.1).total_cmp(&least(&b.1)));
            if let Some((t, weights)) = best
                && (least(&weights) > -1e-9 || ring > 1)
            {
                let clamped = weights.map(|w| w.max(0.0));
                let sum: f64 = clamped.iter().sum();
                return Some((t, clamped.map(|w| w / sum)));
            }
        }
        None
    }

    fn weights(&self, triangle: usize, p: V2) -> [f64; 3] {
        let [a, b, c] = self.triangles[triangle].map(|v| self.points[v]);
        let area = (b - a).perp(&(c - a));
        let wb = (p - a).perp(&(c - a)) / area;
        let wc = (b - a).perp(&(p - a)) / area;
        [1.0 - wb - wc, wb, wc]
    }
}
