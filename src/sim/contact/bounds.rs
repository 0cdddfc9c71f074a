//! Axis-aligned bounding boxes in vector registers. The search for near cloth compares a hundred thousand of them.

use wide::f32x4;

use geom::V3;

/// Axis-aligned box in single precision, rounded outwards. The fourth component is zero.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    low: f32x4,
    high: f32x4,
}

geom::constants! {
    "contact.bounds",
    /// Relative widening that covers the rounding of coordinates and of itself.
    const ROUNDING: f32 = 2.0 * f32::EPSILON;
}

#[inline(always)]
pub fn rounded(p: &V3) -> f32x4 {
    f32x4::from([p.x as f32, p.y as f32, p.z as f32, 0.0])
}

impl Bounds {
    /// Box of no points; it overlaps no other.
    pub const NOTHING: Self = Self {
        low: f32x4::new([f32::MAX, f32::MAX, f32::MAX, 0.0]),
        high: f32x4::new([f32::MIN, f32::MIN, f32::MIN, 0.0]),
    };

    pub fn new(low: &V3, high: &V3) -> Self {
        Self { low: rounded(low), high: rounded(high) }.widened(0.0)
    }

    #[inline(always)]
    pub fn around<const N: usize>(points: [f32x4; N], reach_m: f32) -> Self {
        let (mut low, mut high) = (points[0], points[0]);
        for p in &points[1..] {
            (low, high) = (low.fast_min(*p), high.fast_max(*p));
        }
        Self { low, high }.widened(reach_m)
    }

    #[inline(always)]
    pub fn widened(&self, reach_m: f32) -> Self {
        let reach = f32x4::from([reach_m, reach_m, reach_m, 0.0]);
        let rounding = f32x4::splat(ROUNDING);
        let (low, high) = (self.low - reach, self.high + reach);
        Self { low: low - (low.abs() + reach) * rounding, high: high + (high.abs() + reach) * rounding }
    }

    pub fn with(&self, other: &Self) -> Self {
        Self { low: self.low.fast_min(other.low), high: self.high.fast_max(other.high) }
    }

    pub fn corners(&self) -> [V3; 2] {
        [self.low, self.high].map(|corner| {
            let [x, y, z, _] = corner.to_array().map(f64::from);
            V3::new(x, y, z)
        })
    }

    /// Half of the longest side.
    pub fn half_m(&self) -> f64 {
        let [low, high] = self.corners();
        0.5 * (high - low).max()
    }

    /// 0 where the boxes overlap.
    pub fn apart_m(&self, other: &Self) -> f64 {
        let between = (self.low - other.high).fast_max(other.low - self.high).fast_max(f32x4::ZERO);
        between.to_array().iter().map(|d| f64::from(*d) * f64::from(*d)).sum::<f64>().sqrt()
    }

    #[inline(always)]
    pub fn meets(&self, other: &Self) -> bool {
        (self.low.simd_le(other.high) & other.low.simd_le(self.high)).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::sheets::noise;

    #[test]
    fn boxes_hold_what_they_bound_and_know_how_far_apart_they_are() {
        let numbers = noise(600, 5);
        let points: Vec<V3> = numbers.chunks(3).map(|c| V3::new(c[0], 3.0 * c[1], 0.01 * c[2])).collect();
        for (k, two) in points.windows(2).enumerate() {
            let reach_m = 1e-3 * k as f64;
            let bounds = Bounds::around([rounded(&two[0]), rounded(&two[1])], reach_m as f32);
            let [low, high] = bounds.corners();
            let reach = V3::repeat(reach_m);
            let slack = [two[0].inf(&two[1]) - reach - low, high - two[0].sup(&two[1]) - reach];
            assert!(slack.iter().all(|s| s.min() >= 0.0 && s.max() < 3e-6), "{two:?} in {bounds:?}");
        }
        let unit_box = |x: f64, y: f64| Bounds::new(&V3::new(x, y, 0.0), &V3::new(x + 1.0, y + 1.0, 1.0));
        for (x, y, expect) in [(0.5, 0.5, 0.0), (1.0, 0.0, 0.0), (4.0, 0.0, 3.0), (-4.0, 5.0, 5.0)] {
            let (first, second) = (unit_box(0.0, 0.0), unit_box(x, y));
            assert!((first.apart_m(&second) - expect).abs() < 1e-5, "{x}, {y}");
            assert!(first.meets(&second) == (expect == 0.0), "{x}, {y}");
            assert!(Bounds::NOTHING.with(&second).meets(&first) == (expect == 0.0));
        }
        assert!(!Bounds::NOTHING.meets(&unit_box(0.0, 0.0)));
    }
}
