//! Hollows and ridges from the depth buffer: a fold's bottom darkens and its crest lightens a little, so that cloth reads
//! even in flat light.
//!
//! Each pixel is compared with pairs of opposite neighbours. A pair's mean depth cancels any slope and leaves curvature
//! alone; a pair that reaches over an edge to another surface says nothing about this one and does not count, so nothing
//! in front or behind leaves a halo.

/// (distance of the neighbours, share of the light a full hollow takes): wrinkles and folds, m. None is shorter than the
/// edges of a usual mesh, whose facets would show.
const RINGS: [(f32, f32); 2] = [(0.016, 0.20), (0.030, 0.30)];
/// Pairs a ring.
const PAIRS: usize = 12;
/// Depth of a hollow that takes half of what a full one takes, in distances of the neighbours.
const FULL: f32 = 0.2;
/// Neighbours further off in depth than this many distances belong to another surface.
const REACH: f32 = 3.0;

/// Light gain of each pixel, around 1. `depth` in metres, infinite where there is nothing; `per_m` pixels a metre.
pub(super) fn relief(depth: &[f32], width: usize, per_m: f32) -> Vec<f32> {
    let mut gain = vec![1.0_f32; depth.len()];
    for (distance, strength) in RINGS {
        let offsets = ring((distance * per_m).max(1.0));
        // Where pixels are coarser than the ring, the neighbours are further off than asked.
        let distance = distance.max(1.0 / per_m);
        for (pixel, g) in gain.iter_mut().enumerate() {
            if depth[pixel].is_finite() {
                let hollow = hollow(depth, width, pixel, &offsets, distance);
                *g *= 1.0 - strength * if hollow > 0.0 { hollow } else { 0.3 * hollow };
            }
        }
    }
    gain
}

/// Half of the neighbours around a pixel, in pixels; the other half lies opposite.
fn ring(radius: f32) -> [(isize, isize); PAIRS] {
    std::array::from_fn(|k| {
        let (sin, cos) = (std::f32::consts::PI * (k as f32 + 0.5) / PAIRS as f32).sin_cos();
        ((radius * cos).round() as isize, (radius * sin).round() as isize)
    })
}

/// How deep a pixel lies below its neighbours, from -1 (a crest) to 1 (a hollow).
fn hollow(depth: &[f32], width: usize, pixel: usize, offsets: &[(isize, isize)], distance: f32) -> f32 {
    let (x, y, here) = ((pixel % width) as isize, (pixel / width) as isize, depth[pixel]);
    let height = (depth.len() / width) as isize;
    let at = |x: isize, y: isize| {
        let inside = x >= 0 && y >= 0 && x < width as isize && y < height;
        if inside { depth[y as usize * width + x as usize] } else { f32::INFINITY }
    };
    let pair = |&(dx, dy): &(isize, isize)| {
        let (a, b) = (at(x + dx, y + dy) - here, at(x - dx, y - dy) - here);
        let apart = a.abs().max(b.abs()) / (REACH * distance);
        if apart >= 1.0 {
            return 0.0;
        }
        weight_of(apart) * -0.5 * (a + b) / (FULL * distance)
    };
    let mean = offsets.iter().map(pair).sum::<f32>() / offsets.len() as f32;
    mean / (1.0 + mean.abs())
}

/// Weight of a pair whose neighbours are this share of the reach off: it falls over the second half, so that no line is
/// drawn where pairs stop to count.
fn weight_of(apart: f32) -> f32 {
    (2.0 - 2.0 * apart).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 64;
    const PER_M: f32 = 400.0;

    /// Least and greatest gain over the middle of a picture of the given depths.
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
