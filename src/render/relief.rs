//! Relief shading from the depth buffer: hollows are darkened and crests lightened a little, so that folds are visible
//! even in flat light.
//! Each pixel is compared with pairs of opposite neighbours. The mean depth of a pair cancels any slope, so only
//! curvature remains. A pair with a neighbour on another surface does not count, so edges have no halo.

/// Distance of the neighbours, m, and share of the light that a full hollow takes: for wrinkles, and for folds.
/// Distances shorter than the edges of a usual mesh would show its facets.
const RINGS: [(f32, f32); 2] = [(0.016, 0.20), (0.030, 0.30)];
/// Pairs of opposite neighbours on each ring.
const PAIRS: usize = 12;
/// Depth of a hollow with half of the full effect, divided by the distance of the neighbours.
const FULL: f32 = 0.2;
/// Difference in depth above which a neighbour belongs to another surface, divided by the distance of the neighbours.
const REACH: f32 = 3.0;

/// Factor for the light of each pixel, around 1. `depth` in m, infinite without a surface, `per_m` in pixels per m.
pub(super) fn relief(depth: &[f32], width: usize, per_m: f32) -> Vec<f32> {
    let mut gain = vec![1.0_f32; depth.len()];
    for (distance, strength) in RINGS {
        let ring = Ring::new(depth, width, distance, per_m);
        for (pixel, g) in gain.iter_mut().enumerate() {
            if depth[pixel].is_finite() {
                let hollow = ring.hollow(pixel);
                *g *= 1.0 - strength * if hollow > 0.0 { hollow } else { 0.3 * hollow };
            }
        }
    }
    gain
}

struct Ring<'a> {
    depth: &'a [f32],
    width: usize,
    /// Distance of the neighbours, m.
    distance: f32,
    /// Offsets of half of the neighbours, pixels; the other half is opposite.
    offsets: [(isize, isize); PAIRS],
    /// Distance from the picture's border within which some neighbours lie outside, pixels.
    border: usize,
}

impl<'a> Ring<'a> {
    fn new(depth: &'a [f32], width: usize, distance: f32, per_m: f32) -> Self {
        let radius = (distance * per_m).max(1.0);
        let offsets = std::array::from_fn(|k| {
            let (sin, cos) = (std::f32::consts::PI * (k as f32 + 0.5) / PAIRS as f32).sin_cos();
            ((radius * cos).round() as isize, (radius * sin).round() as isize)
        });
        // Where a pixel is larger than the distance, neighbours are one pixel away.
        Self { depth, width, distance: distance.max(1.0 / per_m), offsets, border: radius.ceil() as usize }
    }

    /// Depth of a pixel below its neighbours, from -1 (a crest) to 1 (a hollow).
    fn hollow(&self, pixel: usize) -> f32 {
        let (x, y, height) = (pixel % self.width, pixel / self.width, self.depth.len() / self.width);
        let is_inner = |place: usize, size: usize| place >= self.border && place + self.border < size;
        let sum: f32 = if is_inner(x, self.width) && is_inner(y, height) {
            let pair = |&(dx, dy): &(isize, isize)| {
                let offset = dy * self.width as isize + dx;
                let [a, b] = [pixel.wrapping_add_signed(offset), pixel.wrapping_add_signed(-offset)];
                self.pair(pixel, self.depth[a], self.depth[b])
            };
            self.offsets.iter().map(pair).sum()
        } else {
            let depth_at = |dx: isize, dy: isize| {
                let place = (x.checked_add_signed(dx), y.checked_add_signed(dy));
                match place {
                    (Some(x), Some(y)) if x < self.width && y < height => self.depth[y * self.width + x],
                    _ => f32::INFINITY,
                }
            };
            self.offsets.iter().map(|&(dx, dy)| self.pair(pixel, depth_at(dx, dy), depth_at(-dx, -dy))).sum()
        };
        let mean = sum / PAIRS as f32;
        mean / (1.0 + mean.abs())
    }

    fn pair(&self, pixel: usize, a: f32, b: f32) -> f32 {
        let (a, b) = (a - self.depth[pixel], b - self.depth[pixel]);
        let apart = a.abs().max(b.abs()) / (REACH * self.distance);
        if apart < 1.0 { weight_of(apart) * -0.5 * (a + b) / (FULL * self.distance) } else { 0.0 }
    }
}

/// Weight of a pair at a share of the reach. It falls to 0 over the second half, so that no line appears.
fn weight_of(apart: f32) -> f32 {
    (2.0 - 2.0 * apart).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 64;
    const PER_M: f32 = 400.0;

    fn gains(depth: impl Fn(f32, f32) -> f32) -> (f32, f32) {
        let place = |k: usize| (k as f32 - SIDE as f32 / 2.0) / PER_M;
        let depths: Vec<f32> = (0..SIDE * SIDE).map(|k| depth(place(k % SIDE), place(k / SIDE))).collect();
        let gain = relief(&depths, SIDE, PER_M);
        let middle = |k: &usize| (12..SIDE - 12).contains(&(k % SIDE)) && (12..SIDE - 12).contains(&(k / SIDE));
        (0..gain.len()).filter(middle).fold((9.0, 0.0), |(l, h), k| (gain[k].min(l), gain[k].max(h)))
    }

    #[test]
    fn slopes_and_edges_leave_no_mark() {
        let even = |depth: fn(f32, f32) -> f32| {
            let (low, high) = gains(depth);
            assert!(low > 0.999 && high < 1.001, "{low} {high}");
        };
        even(|_, _| 0.3);
        even(|x, y| 0.8 * x + 0.4 * y);
        // An arm before a shirt: two flat surfaces 15 cm apart, and a silhouette.
        even(|x, _| if x < 0.0 { 0.0 } else { 0.15 });
        even(|x, _| if x < 0.0 { 0.0 } else { f32::INFINITY });
    }

    #[test]
    fn folds_darken_in_their_hollows_and_lighten_on_their_crests() {
        let (low, high) = gains(|x, _| 0.008 * (x * 2.0 * std::f32::consts::PI / 0.06).sin());
        assert!(low < 0.9 && high > 1.02, "{low} {high}");
    }
}
