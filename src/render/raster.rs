//! The z-buffer.

/// Calls `plot(sample, depth)` for every sample (row by row, `width` a row) whose centre a triangle covers.
///
/// Corners are `[x, y, depth]` in samples; both windings count. Samples on a shared edge may be covered twice, which a
/// depth test absorbs.
pub(super) fn cover(corners: [[f32; 3]; 3], width: usize, height: usize, mut plot: impl FnMut(usize, f32)) {
    let [a, b, c] = corners;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0.0 {
        return;
    }
    let range = |axis: usize, limit: usize| {
        let low = a[axis].min(b[axis]).min(c[axis]) - 0.5;
        let high = a[axis].max(b[axis]).max(c[axis]) - 0.5;
        (low.ceil().max(0.0) as usize, (high.floor() + 1.0).clamp(0.0, limit as f32) as usize)
    };
    let ((left, right), (top, bottom)) = (range(0, width), range(1, height));
    // Weights of b and c at a sample, and their change from one sample to the next to the right.
    let (wb_x, wc_x) = ((c[1] - a[1]) / area, (a[1] - b[1]) / area);
    for y in top..bottom {
        let (dx, dy) = (left as f32 + 0.5 - a[0], y as f32 + 0.5 - a[1]);
        let mut wb = (dx * (c[1] - a[1]) - dy * (c[0] - a[0])) / area;
        let mut wc = (dy * (b[0] - a[0]) - dx * (b[1] - a[1])) / area;
        for x in left..right {
            if wb >= 0.0 && wc >= 0.0 && wb + wc <= 1.0 {
                plot(y * width + x, a[2] + wb * (b[2] - a[2]) + wc * (c[2] - a[2]));
            }
            wb += wb_x;
            wc += wc_x;
        }
    }
}

/// Weights of the three corners at a point of the picture, clamped to the triangle.
pub(super) fn weights(corners: [[f32; 3]; 3], x: f32, y: f32) -> [f32; 3] {
    let [a, b, c] = corners;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let (dx, dy) = (x - a[0], y - a[1]);
    let wb = ((dx * (c[1] - a[1]) - dy * (c[0] - a[0])) / area).clamp(0.0, 1.0);
    let wc = ((dy * (b[0] - a[0]) - dx * (b[1] - a[1])) / area).clamp(0.0, 1.0 - wb);
    [1.0 - wb - wc, wb, wc]
}

/// Nearest surface at each sample.
pub(super) struct Visible {
    /// Samples in a row.
    pub width: usize,
    /// Distance behind the centre plane, m; infinite where there is nothing.
    pub depth: Vec<f32>,
    /// Triangle, `NOTHING` where there is none.
    pub triangle: Vec<u32>,
}

/// No triangle.
pub(super) const NOTHING: u32 = u32::MAX;

impl Visible {
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, depth: vec![f32::INFINITY; width * height], triangle: vec![NOTHING; width * height] }
    }

    pub fn draw(&mut self, triangle: usize, corners: [[f32; 3]; 3]) {
        let height = self.depth.len() / self.width;
        let (depths, triangles) = (&mut self.depth, &mut self.triangle);
        cover(corners, self.width, height, |sample, depth| {
            if depth < depths[sample] {
                depths[sample] = depth;
                triangles[sample] = triangle as u32;
            }
        });
    }
}
