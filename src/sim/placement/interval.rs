//! Intervals along a ring: their bounds, middles, and the front of the ring.

/// Front of a ring: the mean of its front pieces' middles, or the middle of all where there are none.
pub fn front(middles: &[f64], of_all: f64) -> f64 {
    if middles.is_empty() { of_all } else { middles.iter().sum::<f64>() / middles.len() as f64 }
}

/// Mean of the least and the greatest.
pub fn middle(values: impl Iterator<Item = f64>) -> f64 {
    let [low, high] = bounds(values);
    0.5 * (low + high)
}

pub fn bounds(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::MAX, f64::MIN], |[low, high], value| [low.min(value), high.max(value)])
}
