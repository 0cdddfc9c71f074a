//! Rasterisation of triangles on a grid of samples.

/// Margin by which a triangle covers samples beyond its edges, as a share of its height: closes pinholes from rounding.
pub(super) const RIM: f32 = 1e-4;

/// Calls `plot(sample, depth)` for every sample whose centre a triangle covers. Samples are numbered row by row,
/// `width` in each.
///
/// Corners are `[x, y, depth]` in samples, in either orientation. Samples on a shared edge may be covered twice, which
/// a depth test absorbs.
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
    // Barycentric weights of b and c: their change from one sample to the next, and at a sample.
    let (wb_x, wc_x) = ((c[1] - a[1]) / area, (a[1] - b[1]) / area);
    let (wb_y, wc_y) = ((a[0] - c[0]) / area, (b[0] - a[0]) / area);
    let (dx, (slope_b, slope_c)) = (left as f32 + 0.5 - a[0], (b[2] - a[2], c[2] - a[2]));
    for y in top..bottom {
        let dy = y as f32 + 0.5 - a[1];
        let (mut wb, mut wc) = (dx * wb_x + dy * wb_y, dx * wc_x + dy * wc_y);
        for x in left..right {
            if wb >= -RIM && wc >= -RIM && wb + wc <= 1.0 + RIM {
                plot(y * width + x, a[2] + wb * slope_b + wc * slope_c);
            }
            wb += wb_x;
            wc += wc_x;
        }
    }
}

/// Barycentric weights of the three corners at a point of the picture, clamped to the triangle.
pub(super) fn weights(corners: [[f32; 3]; 3], x: f32, y: f32) -> [f32; 3] {
    let [a, b, c] = corners;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let (dx, dy) = (x - a[0], y - a[1]);
    let wb = ((dx * (c[1] - a[1]) - dy * (c[0] - a[0])) / area).clamp(0.0, 1.0);
    let wc = ((dy * (b[0] - a[0]) - dx * (b[1] - a[1])) / area).clamp(0.0, 1.0 - wb);
    [1.0 - wb - wc, wb, wc]
}

/// Index that means no triangle, or no supersampled pixel.
pub(super) const NOTHING: u32 = u32::MAX;
